"""A study of what accuracy costs: ladders of one knob at a time over one base, each on several seeds.

  base: biaxial_2MPa_nonbreakable.yaml
  set: {assembly.particles: 600, shear.axial_strain: 0.08}
  seeds: [1, 2]
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
"""
import re
from dataclasses import dataclass

from . import biaxial_test as kind
from .campaign import Campaign, Variation, axis_values, base_of, common_keys, parsed, shared_sample
from .text_yaml import Section, read_mapping

KEYS = ("base", "set", "seeds", "shared_sample", "knobs", "measures")
MEASURE = re.compile(r"([\w.]+)(?: */ *([\w.]+))?")


@dataclass
class Knob:
    name: str
    rungs: list          # of labels; the first is the reference
    variations: dict     # (label, seed) -> Variation
    rounding_only: bool


@dataclass
class Study:
    campaign: Campaign   # every run of the study
    seeds: list
    knobs: list
    measures: dict       # label -> (number of the summary, number that divides it or None)
    base: dict           # seed -> Variation


def read_study(path, overrides=()):
    file = Section(path, read_mapping(path))
    file.only(*KEYS)
    scene, common = base_of(file), common_keys(file, overrides)
    if "seed" in common:
        file.fail("set", "found seed, expected it under seeds")
    seeds = [label for label, _ in axis_values(file, "seeds")] if "seeds" in file.content else \
        file.expected("seeds", None, "a list of seeds")
    base = {seed: Variation((("seed", seed),), (("seed", seed),), f"base_seed-{seed}") for seed in seeds}
    section = file.mapping("knobs")
    if not section.content:
        section.fail("", "found none, expected at least one knob with its rungs")
    knobs = [read_knob(section, name, seeds) for name in section.content]
    variations = list(base.values()) + [variation for knob in knobs for variation in knob.variations.values()]
    for variation in variations:
        for key in dict(parsed(overrides)):
            if key in dict(variation.keys):
                file.fail("knobs", f"--set {key}: found a key that a knob varies, expected one that all runs share")
    return Study(Campaign(path, scene, common, variations, [], shared_sample(file), report=False), seeds, knobs,
                 read_measures(file), base)


def read_knob(section, name, seeds):
    knob = section.mapping(name)
    knob.only("key", "rungs", "rounding_only")
    rungs = knob.content.get("rungs")
    if isinstance(rungs, list):
        key = knob.text("key")
        points = axis_values(Section(knob.path, {key: rungs}, f"{knob.where}.rungs"), key)
    elif isinstance(rungs, dict):
        key = name
        points = axis_values(knob, "rungs")
    else:
        knob.expected("rungs", rungs, "a list of values of `key`, or labels with the keys of each")
    if len(points) < 2:
        knob.fail("rungs", f"found {len(points)}, expected at least the reference and one more")
    variations = {}
    for label, keys in points:
        if "seed" in dict(keys):
            knob.fail("rungs", "found seed, expected it under seeds of the study")
        for seed in seeds:
            variations[label, seed] = Variation(((key, label), ("seed", seed)), (*keys, ("seed", seed)))
    return Knob(name, [label for label, _ in points], variations, knob.flag("rounding_only", False))


def read_measures(file):
    measures = file.mapping("measures").content or kind.MEASURES
    found = {}
    for label, text in measures.items():
        match = MEASURE.fullmatch(text) if isinstance(text, str) else None
        if not match:
            file.expected(f"measures.{label}", text, "a number of summary.json, or two as in contacts_final / "
                          "particles_final")
        found[label] = match.groups()
    return found
