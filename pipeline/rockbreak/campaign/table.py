"""A campaign: a table of runs over a base scene. Axes span the table, explicit runs are added to it.

  base: biaxial_2MPa_nonbreakable.yaml              # relative to the campaign's folder
  set: {shear.axial_strain: 0.10}                   # keys of all runs
  axes:
    preparation.confining_pressure: [0.5e6, 1e6]    # any key of a scene, with its values
    seed: [1, 2, 3]
    variant:                                        # or a name of its own: label -> keys
      breakable: {effects: [friction, local_damping, energy_ledger, breakage]}
      solid: {effects: [friction, local_damping, energy_ledger]}
  runs:                                             # further runs: keys, and a name if wanted
    - {name: stiff, contact.normal_stiffness: 1.0e10}
  shared_sample: [time_step.safety]                 # keys whose values are sheared from one prepared sample
  report: true                                      # report.html of each run
  compare: paper                                    # table beside the paper's Tables 2 to 4
"""
import itertools
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from . import biaxial_test
from .kinds import kind_of
from ..text_yaml import Section, flow_text, read_mapping

KEYS = ("base", "set", "axes", "runs", "shared_sample", "report", "compare")


@dataclass(frozen=True)
class Variation:
    """One row of the table: what tells it from the others, and the keys of the scene that it sets."""
    labels: tuple  # of (axis, label); labels of an axis that is a key are its values as written
    keys: tuple    # of (key of the scene, text)
    title: str = ""

    @property
    def name(self):
        """Readable, and fit for a file name."""
        words = [self.title] if self.title else [
            f"{axis.rpartition('.')[2]}-{label}" if axis in dict(self.keys) else label for axis, label in self.labels]
        return "_".join(file_name(word) for word in words) or "base"


def file_name(text):
    return re.sub(r"[^A-Za-z0-9._+-]+", "-", text).strip("-.")


@dataclass
class Campaign:
    file: Path
    base: Path
    common: dict            # keys of all runs
    variations: list        # of Variation
    axes: list              # names in the order of the table's columns
    shared_sample: tuple = ()
    report: bool = True
    compare: str = "none"

    @cached_property
    def kind(self):
        """The module of its kind of run."""
        return kind_of(self.base)


def read_campaign(path, overrides=()):
    """`overrides`: KEY=VALUE for all runs, beside the file's own `set`."""
    file = Section(path, read_mapping(path))
    file.only(*KEYS)
    base = base_of(file)
    common = common_keys(file, overrides)
    axes = file.mapping("axes")
    spans = [axis_values(axes, name) for name in axes.content]
    variations = [Variation(tuple((name, label) for name, (label, _) in zip(axes.content, point)),
                            merged(axes, [keys for _, keys in point]))
                  for point in itertools.product(*spans)] if spans else []
    variations += extra_runs(file)
    if not variations:
        variations = [Variation((), ())]
    for variation in variations:
        for key, _ in variation.keys:
            if key in dict(parsed(overrides)):
                file.fail("axes", f"--set {key}: found a key that the table varies, expected one that all runs share")
    campaign = Campaign(path, base, common, variations, list(axes.content), shared_sample(file),
                        file.flag("report", True), file.choice("compare", ("none", "paper"), "none"))
    if campaign.kind is not biaxial_test:
        file.fail("base", f"found {file.content['base']}, a laboratory test, expected a scene; pipeline/lab sweeps "
                  "tests")
    return campaign


def base_of(file):
    base = file.path.parent / file.text("base")
    if not base.is_file():
        file.fail("base", f"found {file.content['base']}, expected a scene (YAML) relative to {file.path.parent}")
    return base


def common_keys(file, overrides):
    return file.mapping("set").scene_keys() | dict(parsed(overrides))


def parsed(overrides):
    return [tuple(override.partition("=")[::2]) for override in overrides]


def shared_sample(file):
    keys = file.list("shared_sample")
    for key in keys:
        if not isinstance(key, str):
            file.expected("shared_sample", key, "keys of a scene")
    return tuple(keys)


def axis_values(axes, name, key=None):
    """(label, keys) of each point of an axis, whose values are those of `key` (the axis's name, unless given)."""
    content = axes.content[name]
    if isinstance(content, dict) and content:
        variants = axes.mapping(name)
        points = []
        for label, keys in content.items():
            if not isinstance(keys, dict):
                variants.expected(label, keys, "the keys of this variant, as in {contact.law: area}")
            points.append((label, tuple(variants.mapping(label).scene_keys().items())))
        return points
    if not isinstance(content, list) or not content:
        axes.expected(name, content, "a list of values, or a mapping of variants, each with its keys")
    values = [flow_text(value) if isinstance(value, (str, list)) else axes.expected(name, value, "a value")
              for value in content]
    if len(set(values)) < len(values):
        axes.fail(name, f"found {', '.join(values)}, expected each value once")
    return [(value.strip("[]"), ((key or name, value),)) for value in values]


def merged(axes, parts):
    """The keys of several axes as one set; no key may be varied twice."""
    keys = {}
    for key, value in itertools.chain(*parts):
        if key in keys:
            axes.fail(key, "found in two axes, expected it in one")
        keys[key] = value
    return tuple(keys.items())


def extra_runs(file):
    found = []
    for number, content in enumerate(file.list("runs"), start=1):
        if not isinstance(content, dict):
            file.expected(f"runs[{number}]", content, "the keys of a run, as in {name: stiff, seed: 2}")
        one = Section(file.path, {key: value for key, value in content.items() if key != "name"}, f"runs[{number}]")
        keys = one.scene_keys()
        title = Section(file.path, content, one.where).text("name") if "name" in content else ""
        found.append(Variation(tuple((key, value.strip("[]")) for key, value in keys.items()), tuple(keys.items()),
                               title))
    return found
