"""From the rows of a table to runs and prepared samples, each with its directory, named after its configuration.

DIR/runs/NAME_HASH      one run; HASH covers its resolved configuration and that of its sample
DIR/samples/NAME_HASH   one prepared sample, shared by all runs whose preparation sees the same
A directory is found again by its hash, so a row may be renamed, and a changed table runs only what is new.
"""
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType

from .cases import hash_of, value_at
from ..errors import BAD_INPUT, RockbreakError

HASH_DIGITS = 10


@dataclass
class Sample:
    hash: str
    out: Path
    command: list
    kind: ModuleType
    effort: float  # relative time, as that of a run

    def is_finished(self):
        return self.kind.sample_is_finished(self.out)


@dataclass
class PlannedRun:
    variations: list  # the rows that mean this very run; the first names it
    case: dict        # resolved
    hash: str
    out: Path
    sample: Sample | None
    command: list
    report: bool
    kind: ModuleType
    failure: str | None = None
    code: int = 0
    summary: dict | None = field(default=None)

    name = property(lambda self: self.out.name)
    effort = property(lambda self: self.kind.effort(self.case))

    def is_finished(self):
        return self.kind.is_finished(self.out, self.report)


@dataclass
class Plan:
    out: Path
    runs: list     # each once, in the order of the table
    row_runs: dict  # Variation -> PlannedRun

    def samples(self):
        return list({run.sample.hash: run.sample for run in self.runs if run.sample}.values())


def joined(out, plans):
    """Several plans of one directory as one."""
    return Plan(out, [run for plan in plans for run in plan.runs],
                {variation: run for plan in plans for variation, run in plan.row_runs.items()})


def make_plan(campaign, out, threads=None):
    """Resolves every row (which validates it); starts nothing, writes nothing."""
    kind = campaign.kind
    base_case = kind.resolve(campaign.base, campaign.common, f"{campaign.file}: base, set")
    check_shared(campaign, base_case)
    plan = Plan(out, [], {})
    by_hash, samples = {}, {}
    for variation in campaign.variations:
        keys = campaign.common | dict(variation.keys)
        case = kind.resolve(campaign.base, keys, f"{campaign.file}: run {variation.name}") if variation.keys \
            else base_case
        sample = None
        sample_hash = kind.prepared_elsewhere(case)
        if sample_hash is None:
            sample_hash = hash_of(kind.sample_case(case, base_case, campaign.shared_sample))
            if sample_hash not in samples:
                samples[sample_hash] = plan_sample(campaign, variation, keys, case, sample_hash, out, threads)
            sample = samples[sample_hash]
        value = kind.identity(case, sample_hash)
        if value not in by_hash:
            by_hash[value] = plan_run(campaign, variation, keys, case, value, out, sample, threads)
            plan.runs.append(by_hash[value])
        else:
            by_hash[value].variations.append(variation)
        plan.row_runs[variation] = by_hash[value]
    return plan


def check_shared(campaign, base_case):
    for key in campaign.shared_sample:
        if value_at(base_case, key) is None:
            raise RockbreakError(BAD_INPUT, f'{campaign.file}: shared_sample: found "{key}", expected a key of the '
                                 "scene that has a value")


def directory_of(folder, name, value):
    """The directory that has this hash already, whatever its name; else a new one."""
    short = value[:HASH_DIGITS]
    there = sorted(folder.glob(f"*_{short}"))
    return there[0] if there else folder / f"{name}_{short}"


def plan_sample(campaign, variation, keys, case, value, out, threads):
    kind = campaign.kind
    seen = [(axis, label) for axis, label in variation.labels
            if kind.seen_by_preparation(axis) and axis not in campaign.shared_sample and axis in dict(variation.keys)
            and axis != "effects"]
    name = type(variation)(tuple(seen), variation.keys).name if seen else "sample"
    directory = directory_of(out / "samples", name, value)
    return Sample(value, directory, kind.sample_command(campaign.base, keys, case, campaign.shared_sample, directory,
                                                        threads), kind, kind.sample_effort(case))


def plan_run(campaign, variation, keys, case, value, out, sample, threads):
    directory = directory_of(out / "runs", variation.name, value)
    if sample:
        keys = keys | {campaign.kind.FROM: str(campaign.kind.sample_file(sample.out))}
    return PlannedRun([variation], case, value, directory, sample,
                      campaign.kind.run_command(campaign.base, keys, directory, campaign.report, threads),
                      campaign.report, campaign.kind)
