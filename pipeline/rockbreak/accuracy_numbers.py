"""Errors, scatter and cost of the rungs of a ladder.

Of a measure m, on rung r and seed s, the error is sqrt(mean over s of (m(r, s) - m(reference, s))^2): paired, so that
what a seed does to all rungs cancels. Beside it stands the scatter between seeds, sqrt(mean over r of var over s of
m(r, s)), which any single test has anyway.
"""
import math
from dataclasses import dataclass, field

from .campaign_tables import mean, numbers_of, scatter


@dataclass
class Cell:
    """One measure on one rung."""
    mean: float | None = None
    difference: float | None = None  # mean over the seeds
    error: float | None = None       # root mean square over the seeds
    pairs: int = 0


@dataclass
class Rung:
    label: str
    is_reference: bool
    is_base: bool
    runs: list
    cells: dict = field(default_factory=dict)  # measure -> Cell
    cpu_seconds: float | None = None           # means over the seeds
    preparation_seconds: float | None = None
    contact_steps: float | None = None

    @property
    def failures(self):
        return list(dict.fromkeys(run.failure for run in self.runs if run.failure))


@dataclass
class Ladder:
    knob: object
    rungs: list
    scatter: dict  # measure -> scatter between seeds, None with one seed

    reference = property(lambda self: self.rungs[0])
    base = property(lambda self: next((rung for rung in self.rungs if rung.is_base), None))


def measured(run, measure):
    numbers = numbers_of(run.summary) if run.summary else {}
    key, divisor = measure
    value = numbers.get(key)
    if value is None or divisor is None:
        return value
    return value / numbers[divisor] if numbers.get(divisor) else None


def ladder_of(knob, study, plan, sample_seconds):
    rungs, spreads = [], {measure: [] for measure in study.measures}
    base_runs = [plan.row_runs[variation] for variation in study.base.values()]
    reference = [plan.row_runs[knob.variations[knob.rungs[0], seed]] for seed in study.seeds]
    for number, label in enumerate(knob.rungs):
        runs = [plan.row_runs[knob.variations[label, seed]] for seed in study.seeds]
        rung = Rung(label, number == 0, runs == base_runs, runs)
        for name, measure in study.measures.items():
            rung.cells[name] = compared([measured(run, measure) for run in runs],
                                        [measured(run, measure) for run in reference])
            spread = scatter([value for value in (measured(run, measure) for run in runs) if value is not None])
            if spread is not None:
                spreads[name].append(spread ** 2)
        rung.cpu_seconds = mean_number(runs, "cpu_seconds")
        rung.contact_steps = mean_number(runs, "contact_steps")
        prepared = [sample_seconds.get(run.sample.hash) for run in runs if run.sample]
        rung.preparation_seconds = mean(prepared) if prepared and None not in prepared else None
        rungs.append(rung)
    return Ladder(knob, rungs, {name: math.sqrt(mean(found)) if found else None for name, found in spreads.items()})


def compared(values, reference):
    pairs = [(value, other) for value, other in zip(values, reference) if value is not None and other is not None]
    known = [value for value in values if value is not None]
    cell = Cell(mean=mean(known) if known else None, pairs=len(pairs))
    if pairs:
        cell.difference = mean([value - other for value, other in pairs])
        cell.error = math.sqrt(mean([(value - other) ** 2 for value, other in pairs]))
    return cell


def mean_number(runs, key):
    found = [numbers_of(run.summary).get(key) for run in runs if run.summary]
    found = [value for value in found if value is not None]
    return mean(found) if found else None


def floors_of(ladders):
    """Measure -> the largest error that rounding alone makes, from the ladders that change nothing else."""
    found = {}
    for ladder in ladders:
        if ladder.knob.rounding_only:
            for rung in ladder.rungs:
                for name, cell in rung.cells.items():
                    if cell.error is not None:
                        found[name] = max(found.get(name, 0.0), cell.error)
    return found


def beyond(rung, ladder, floors):
    """Measures whose error stands out of what two equally good runs differ by."""
    found = []
    for name, cell in rung.cells.items():
        allowed = max(ladder.scatter[name] or 0.0, floors.get(name, 0.0))
        if cell.error is None or cell.error > allowed:
            found.append(name)
    return found


def is_whole(rung):
    return all(run.summary for run in rung.runs)


def cheapest_good(ladder, floors):
    """The rung of least CPU time whose errors all stay within the scatter."""
    good = [rung for rung in ladder.rungs if is_whole(rung) and not beyond(rung, ladder, floors)]
    return min(good, key=lambda rung: rung.cpu_seconds, default=None)
