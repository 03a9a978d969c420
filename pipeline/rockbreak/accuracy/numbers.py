"""Errors, scatter and cost of the rungs of a ladder.

Of a measure m, on rung r and specimen s (a seed, say), the error is sqrt(mean over s of d(r, s)^2). d is the difference
from the reference's run of the same specimen: paired, so that what a specimen does to all rungs cancels; or from theory
where the measure has one. Beside it stands the scatter between specimens, sqrt(mean over r of var over s of m(r, s)),
which any single test has anyway.
"""
import math
from dataclasses import dataclass, field

from ..campaign.tables import mean, numbers_of, scatter

NOTICEABLE = 0.7  # part of a cost; times on a busy machine differ by less for no reason


@dataclass
class Cell:
    """One measure on one rung."""
    mean: float | None = None
    difference: float | None = None  # mean over the specimens
    error: float | None = None       # root mean square over the specimens; of a share their mean
    pairs: int = 0


@dataclass
class Rung:
    label: str
    is_reference: bool
    is_base: bool
    runs: list
    cells: dict = field(default_factory=dict)  # name of a measure -> Cell
    costs: dict = field(default_factory=dict)  # number of the summary -> mean over the specimens
    preparation_seconds: float | None = None
    cost: float | None = None                  # the first of the costs: what errors are held against

    @property
    def failures(self):
        return list(dict.fromkeys(run.failure for run in self.runs if run.failure))


@dataclass
class Ladder:
    knob: object
    subject: object
    rungs: list
    scatter: dict  # name of a measure -> scatter between specimens, None with one specimen

    reference = property(lambda self: next((rung for rung in self.rungs if rung.is_reference), None))
    base = property(lambda self: next((rung for rung in self.rungs if rung.is_base), None))

    def allowed(self, measure, floors):
        """The error that is good enough: the tolerance of the study; without one, what two equally good runs differ
        by."""
        if measure in self.subject.tolerances:
            return self.subject.tolerances[measure]
        return max(self.scatter[measure] or 0.0, floors.get(measure, 0.0))


def ladder_of(knob, subject, kind, plan, sample_seconds):
    rungs, spreads = [], {measure.name: [] for measure in subject.measures}
    base_runs = [plan.row_runs[variation] for variation in subject.base.values()]
    for label in knob.rungs:
        runs = [plan.row_runs[knob.variations[label, specimen]] for specimen in subject.specimens]
        references = [plan.row_runs[knob.references[label, specimen]] for specimen in subject.specimens]
        rung = Rung(label, knob.is_reference(label), runs == base_runs, runs)
        for measure in subject.measures:
            values = [measure.value(run) for run in runs if run.summary]
            rung.cells[measure.name] = cell_of(values, [
                measure.difference(run, reference) for run, reference in zip(runs, references)
                if run.summary and reference.summary], measure.is_share)
            spread = scatter([value for value in values if value is not None])
            if spread is not None and not measure.is_share:
                size = abs(rung.cells[measure.name].mean) if measure.relative else 1.0
                spreads[measure.name].append((spread / size) ** 2)
        rung.costs = {key: mean_number(runs, key) for _, _, key, _ in kind.COSTS}
        rung.cost = next(iter(rung.costs.values()))
        prepared = [sample_seconds.get(run.sample.hash) for run in runs if run.sample]
        rung.preparation_seconds = mean(prepared) if prepared and None not in prepared else None
        rungs.append(rung)
    return Ladder(knob, subject, rungs,
                  {name: math.sqrt(mean(found)) if found else None for name, found in spreads.items()})


def cell_of(values, differences, is_share):
    values, differences = ([number for number in numbers if number is not None] for numbers in (values, differences))
    cell = Cell(mean=mean(values) if values else None, pairs=len(differences))
    if differences:
        cell.difference = mean(differences)
        cell.error = cell.difference if is_share else math.sqrt(mean([number ** 2 for number in differences]))
    return cell


def mean_number(runs, key):
    found = [numbers_of(run.summary).get(key) for run in runs if run.summary]
    found = [value for value in found if value is not None]
    return mean(found) if found else None


def floors_of(ladders):
    """Measure -> the largest change of the error by rounding alone, from the ladders that change nothing else."""
    found = {}
    for ladder in ladders:
        if ladder.knob.rounding_only:
            first = ladder.rungs[0].cells
            for rung in ladder.rungs:
                for name, cell in rung.cells.items():
                    if cell.error is not None and first[name].error is not None:
                        found[name] = max(found.get(name, 0.0), abs(cell.error - first[name].error))
    return found


def beyond(rung, ladder, floors):
    """Measures whose error is unknown, or larger than what is good enough."""
    return [name for name, cell in rung.cells.items()
            if cell.error is None or cell.error > ladder.allowed(name, floors)]


def is_whole(rung):
    return all(run.summary for run in rung.runs)


def cheapest_good(ladder, floors):
    """The rung of least cost whose errors are all good enough; the base, if no other is noticeably cheaper."""
    good = [rung for rung in ladder.rungs if is_whole(rung) and not beyond(rung, ladder, floors)]
    cheapest = min(good, key=lambda rung: rung.cost, default=None)
    base = ladder.base
    return base if base in good and cheapest.cost > NOTICEABLE * base.cost else cheapest
