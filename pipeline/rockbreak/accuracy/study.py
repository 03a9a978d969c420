"""A study of what accuracy costs: ladders of one knob at a time over one base, each on several seeds or specimens.

  base: biaxial_2MPa_nonbreakable.yaml          # a scene or a laboratory test, relative to this file's folder
  set: {assembly.particles: 600, shear.axial_strain: 0.08}
  seeds: [1, 2]                                 # values of the key `seed`
  shared_sample: [time_step.safety]             # as in a campaign: sheared from one prepared sample
  knobs:
    time step:
      key: time_step.safety
      rungs: [0.05, 0.1, 0.25]                  # the first is the reference, the finest
      rounding_only: false                      # true: the rungs differ by rounding alone, and show how it grows
    contact law:
      rungs:                                    # or labels with the keys of each
        potential: {contact.law: potential}
        area: {contact.law: area}
  measures: {peak: peak_sin_phi, contacts: contacts_peak / particles_initial}  # numbers of summary.json, or ratios
  tolerances: {peak: 0.01}                      # errors that are good enough; without one, the scatter is

A study of several bases, all of one kind, names them; each knob climbs its ladder over each of them:

  subjects:
    disc:
      base: lab/brazilian.yaml
      set: {mesh.nodes: 150}
      specimens:                                # or labels with keys; x0.94 is that part of the rung's or base's value
        as it is: {}
        coarser: {mesh.nodes: x0.94}
    particle: {base: lab/multi_contact.yaml, seeds: [1, 2, 3], measures: ..., tolerances: ...}
  knobs:
    initiation radius:
      key: breakage.initiation_radius
      subjects: [particle]                      # all, if none is named
      rungs: [0.2, 0.1, 0.05]
      reference: {mesh.nodes: 2400}             # each rung is compared with itself under these keys, not with the
                                                # first; or for some subjects alone: {particle: {mesh.nodes: 2400}}
"""
import re
from dataclasses import dataclass, field
from pathlib import Path

from .measures import number_measure
from ..campaign.table import Campaign, Variation, axis_values, base_of, common_keys, parsed, shared_sample
from ..campaign.cases import value_at
from ..text_yaml import Section, read_mapping

OF_SUBJECT = ("base", "set", "seeds", "specimens", "shared_sample", "measures", "tolerances")
KEYS = (*OF_SUBJECT, "knobs")
KEYS_OF_SEVERAL = ("subjects", "knobs")
MEASURE = re.compile(r"([\w.]+)(?: */ *([\w.]+))?")
FACTOR = re.compile(r"x([0-9.]+)")


@dataclass
class Knob:
    """The ladder of one knob over one subject."""
    name: str
    rungs: list          # of labels
    variations: dict     # (label, specimen) -> Variation
    references: dict     # (label, specimen) -> Variation that it is compared with
    rounding_only: bool = False
    against_itself: str = ""  # the keys that make the reference of each rung, as text; else the first rung is

    def is_reference(self, label):
        return not self.against_itself and label == self.rungs[0]


@dataclass
class Subject:
    """One base with its specimens and the ladders over it."""
    name: str
    campaign: Campaign   # every run of it
    specimens: dict      # label -> keys
    measures: list
    tolerances: dict     # name of a measure -> error
    base: dict           # specimen -> Variation
    knobs: list = field(default_factory=list)


@dataclass
class Study:
    file: Path
    subjects: list
    knobs: list  # names, in the order of the file

    kind = property(lambda self: self.subjects[0].campaign.kind)


def read_study(path, overrides=()):
    file = Section(path, read_mapping(path))
    several = "subjects" in file.content
    file.only(*(KEYS_OF_SEVERAL if several else KEYS))
    named = file.mapping("subjects")
    subjects = [read_subject(named.mapping(name), name, overrides) for name in named.content] if several else \
        [read_subject(Section(path, {key: file.content[key] for key in file.content if key != "knobs"}), "", overrides)]
    if not subjects:
        file.fail("subjects", "found none, expected at least one with its base")
    if len({subject.campaign.kind for subject in subjects}) > 1:
        file.fail("subjects", "found scenes and laboratory tests, expected one kind of base")
    section = file.mapping("knobs")
    if not section.content:
        section.fail("", "found none, expected at least one knob with its rungs")
    for name in section.content:
        knob = section.mapping(name)
        knob.only("key", "rungs", "reference", "rounding_only", *(["subjects"] if several else []))
        for subject in subjects_of(knob, subjects):
            subject.knobs.append(read_knob(knob, name, subject, subjects))
    for subject in subjects:
        gather_runs(subject, file, overrides)
    return Study(path, subjects, list(section.content))


def read_subject(section, name, overrides):
    section.only(*OF_SUBJECT)
    base, common = base_of(section), common_keys(section, overrides)
    specimens = read_specimens(section)
    for keys in specimens.values():
        for key in keys:
            if key in common and not FACTOR.fullmatch(keys[key]):
                section.fail("set", f"found {key}, expected it under {specimen_word(section)}")
    campaign = Campaign(section.path, base, common, [], ["subject", "specimen"] if name else [],
                        shared_sample(section), report=False)
    measures = read_measures(section, campaign.kind)
    subject = Subject(name, campaign, specimens, measures, read_tolerances(section, measures), {})
    title = f"{name}_base" if name else "base"
    for specimen, keys in specimens.items():
        word = f"seed-{specimen}" if "seed" in keys else specimen
        subject.base[specimen] = Variation(labels_of(subject, specimen), keys_of(subject, {}, specimen),
                                           f"{title}_{word}")
    return subject


def specimen_word(section):
    return "seeds" if "seeds" in section.content else "specimens"


def read_specimens(section):
    if "specimens" in section.content:
        if "seeds" in section.content:
            section.fail("specimens", "found beside seeds, expected one of them")
        specimens = section.mapping("specimens")
        if not specimens.content:
            section.fail("specimens", "found none, expected labels with the keys of each")
        return {label: specimens.mapping(label).scene_keys() for label in specimens.content}
    if "seeds" not in section.content:
        section.expected("seeds", None, "a list of seeds, or specimens")
    return {label: dict(keys) for label, keys in axis_values(section, "seeds", "seed")}


def labels_of(subject, specimen, *more):
    """What tells a run from the others; the specimen under `seed` where that is its key."""
    axis = "seed" if "seed" in subject.specimens[specimen] else "specimen"
    return (*((("subject", subject.name),) if subject.name else ()), *more, (axis, specimen))


def keys_of(subject, keys, specimen):
    """Keys of a rung and of a specimen; a factor of the specimen's multiplies what the rung or the base has."""
    campaign, found = subject.campaign, dict(keys)
    for key, text in subject.specimens[specimen].items():
        factor = FACTOR.fullmatch(text)
        if factor:
            before = found.get(key, campaign.common.get(key)) or value_at(read_mapping(campaign.base), key)
            text = scaled(before, float(factor[1]), Section(campaign.file, {}, f"specimens.{specimen}"), key)
        found[key] = text
    return tuple(found.items())


def scaled(text, factor, section, key):
    try:
        return str(round(int(text) * factor))
    except (TypeError, ValueError):
        pass
    try:
        return f"{float(text) * factor:.12g}"
    except (TypeError, ValueError):
        return section.expected(key, text, "a number to multiply, given by the base or the rung")


def subjects_of(knob, subjects):
    names = knob.list("subjects", [subject.name for subject in subjects])
    for name in names:
        if name not in [subject.name for subject in subjects]:
            knob.expected("subjects", name, "a name under subjects")
    return [subject for subject in subjects if subject.name in names]


def read_knob(knob, name, subject, subjects):
    rungs = knob.content.get("rungs")
    if isinstance(rungs, list):
        key = knob.text("key")
        points = axis_values(knob, "rungs", key)
    elif isinstance(rungs, dict):
        key = name
        points = axis_values(knob, "rungs")
    else:
        knob.expected("rungs", rungs, "a list of values of `key`, or labels with the keys of each")
    finer = reference_keys(knob, subject, subjects)
    if len(points) < 2:
        knob.fail("rungs", f"found {len(points)}, expected at least the reference and one more")
    variations, references = {}, {}
    for label, keys in points:
        for specimen, own in subject.specimens.items():
            for given in dict(keys):
                if given in own and not FACTOR.fullmatch(own[given]):
                    knob.fail("rungs", f"found {given}, expected it under seeds or specimens of the study")
            variations[label, specimen] = Variation(labels_of(subject, specimen, (key, label)),
                                                    keys_of(subject, keys, specimen))
            references[label, specimen] = variations[points[0][0], specimen]
            if finer:
                references[label, specimen] = Variation(
                    labels_of(subject, specimen, (key, label), ("reference", "reference")),
                    keys_of(subject, dict(keys) | finer, specimen))
    return Knob(name, [label for label, _ in points], variations, references, knob.flag("rounding_only", False),
                ", ".join(f"{key}: {value}" for key, value in finer.items()))


def reference_keys(knob, subject, subjects):
    """The keys that make the reference of a rung, for this subject."""
    reference = knob.mapping("reference")
    if set(reference.content) & {one.name for one in subjects}:
        reference.only(*(one.name for one in subjects))
        return reference.mapping(subject.name).scene_keys()
    return reference.scene_keys()


def gather_runs(subject, file, overrides):
    """Every run of the subject into its campaign; no knob may vary what is set for all."""
    variations = list(subject.base.values())
    for knob in subject.knobs:
        variations += [*knob.variations.values(), *knob.references.values()]
    subject.campaign.variations[:] = dict.fromkeys(variations)
    for variation in subject.campaign.variations:
        for key in dict(parsed(overrides)):
            if key in dict(variation.keys):
                file.fail("knobs", f"--set {key}: found a key that a knob varies, expected one that all runs share")


def read_measures(section, kind):
    given = section.mapping("measures").content or kind.MEASURES
    found = []
    for label, text in given.items():
        match = MEASURE.fullmatch(text) if isinstance(text, str) else None
        if not match:
            section.expected(f"measures.{label}", text, "a number of summary.json, or two as in contacts_final / "
                             "particles_final" + "".join(f", or {name}" for name in kind.ERRORS))
        found.append(kind.error_measure(label, text) if text in kind.ERRORS else number_measure(label, *match.groups()))
    return found


def read_tolerances(section, measures):
    found = {}
    for label, text in section.mapping("tolerances").content.items():
        if label not in [measure.name for measure in measures]:
            section.fail(f"tolerances.{label}", f"found no such measure, expected one of "
                         f"{', '.join(measure.name for measure in measures)}")
        try:
            found[label] = float(text)
        except (TypeError, ValueError):
            section.expected(f"tolerances.{label}", text, "a number")
    return found
