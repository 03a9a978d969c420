"""One table of many runs beside the paper: every number of its tables and every sentence that states a trend, ours
(mean and scatter over seeds), verdict and reason.

write(directories, out) makes out/paper_table.md, .csv and .html.
"""
import csv
import io
from dataclasses import dataclass, field
from pathlib import Path
from statistics import mean, stdev
from typing import Optional

from . import numbers as paper
from ..measures.classes import HELD
from .causes import cause_of
from .class_limits import limits_table
from .rows import LABELS, paper_rows
from .evidence import ASSEMBLY, Samples
from .observations import observe
from .readings import finding, other_readings
from .sentences_pressure import SENTENCES
from .verdicts import NOT_REPRODUCED, REPRODUCED, TOLERANCES_IN_WORDS, UNDECIDABLE, WITHIN_SCATTER, verdict
from ..report.page import render
from ..run.results import Results
from ..run.run_directory import RunDirectory, write_text
from ..text_yaml import flat

# What may differ between the runs of one group: the seed, and what follows from where a run was made.
FREE_KEYS = ("seed", "output.", "preparation.from")
KINDS = (REPRODUCED, WITHIN_SCATTER, NOT_REPRODUCED, UNDECIDABLE)
LATERAL_STRESS_ERROR = 0.05  # rms; a run beyond it is no test at its pressure


@dataclass
class Group:
    """Runs of one pressure and assembly that differ by their seeds alone."""
    pressure: float  # [Pa]
    breakable: bool
    variant: str     # keys that tell it from other groups of this pressure and assembly, or ""
    runs: list = field(default_factory=list)
    rows: list = field(default_factory=list)

    @property
    def title(self):
        text = f"{1e-6 * self.pressure:g} MPa, {ASSEMBLY[self.breakable]}"
        return f"{text}; {self.variant}" if self.variant else text

    @property
    def seeds(self):
        return [run.case.get("seed") for run in self.runs]


@dataclass(frozen=True)
class Found:
    """A sentence of the paper beside our runs."""
    where: str
    says: str
    paper: str
    ours: str
    verdict: str
    reason: str
    others: str = ""  # readings that give another verdict


def depends_on_limits(quantity):
    """Counts of classes whose limits the paper does not state."""
    return quantity.removesuffix(HELD).endswith(("_forces", "_stresses"))


@dataclass
class TableRow:
    table: str
    quantity: str
    column: str
    paper: Optional[float]
    values: list            # of the runs that have it
    verdict: str = ""
    reason: str = ""

    mean = property(lambda self: mean(self.values) if self.values else None)
    deviation = property(lambda self: stdev(self.values) if len(self.values) > 1 else None)
    label = property(lambda self: LABELS[self.quantity] + (" †" if depends_on_limits(self.quantity) else ""))

    @property
    def difference(self):
        return None if self.paper is None or self.mean is None else self.mean - self.paper


def write(directories, out):
    """Writes the table of the run directories that are the paper's assembly at one of its pressures into `out`.

    Returns the path of the page; None, and writes nothing, if there is no such run. Runs without frames are an error
    (RockbreakError), unfinished ones only lack what they have not reached; runs whose lateral stress was not held are
    named and left out.
    """
    runs = [Results(RunDirectory(path)) for path in directories]
    left_out = [run.name for run in runs if paper.pressure_of(run.case) is None]
    runs = [run for run in runs if paper.pressure_of(run.case) is not None]
    if not runs:
        return None
    adrift = [(run.name, run.summary["lateral_stress_error_rms"]) for run in runs if is_adrift(run)]
    runs = [run for run in runs if not is_adrift(run)]
    groups = grouped(runs)
    sentences = found_sentences(samples_of(groups))
    out = Path(out)
    out.mkdir(parents=True, exist_ok=True)
    page = {
        "groups": groups, "left_out": left_out, "adrift": adrift, "limits": limits_table(runs),
        "sentences": sentences,
        "tally_of_sentences": [(kind, sum(one.verdict == kind for one in sentences)) for kind in KINDS],
        "by_reading": sum(one.verdict == REPRODUCED and bool(one.others) for one in sentences),
        "incomplete": [run.name for run in runs if not run.summary["complete"]],
        "repeated": [group.title for group in groups if len(set(group.seeds)) < len(group.seeds)],
        "tolerances": TOLERANCES_IN_WORDS, "tally": tally(groups),
        "verdict_classes": dict(zip(KINDS, ("good", "unknown", "bad", "unknown"))),
        "value": value_text, "ours": ours_text, "difference": difference_text,
        "megapascal": lambda pair: " / ".join(f"{1e-6 * limit:.1f}" for limit in pair),
    }
    target = out / "paper_table.html"
    write_text(out / "paper_table.csv", csv_text(groups, sentences))
    write_text(out / "paper_table.md", render("paper_table.md.j2", page))
    write_text(target, render("paper_table.html.j2", page))
    return target


def is_adrift(run):
    return (run.summary["lateral_stress_error_rms"] or 0.0) > LATERAL_STRESS_ERROR


def grouped(runs):
    """Groups by pressure, assembly and whatever else differs between their scenes; with their rows."""
    cells = {}
    for run in runs:
        cells.setdefault((paper.pressure_of(run.case), run.breakable), []).append(run)
    groups = []
    for (pressure, breakable), members in sorted(cells.items()):
        scenes = [flat(run.case) for run in members]
        varied = [key for key in sorted(set().union(*scenes)) if not key.startswith(FREE_KEYS)
                  and len({str(scene.get(key)) for scene in scenes}) > 1]
        variants = {}
        for run, scene in zip(members, scenes):
            name = ", ".join(f"{key} = {scene.get(key)}" for key in varied)
            variants.setdefault(name, Group(pressure, breakable, name)).runs.append(run)
        groups += variants.values()
    for group in groups:
        group.rows = rows_of(group)
    return groups


def rows_of(group):
    rows = {}
    for run in group.runs:
        for one in paper_rows(run):
            row = rows.setdefault(one[:3], TableRow(*one[:4], values=[]))
            if one.ours is not None:
                row.values.append(one.ours)
    starts = {row.quantity: row.mean for row in rows.values() if row.column == "start"}
    starts["paper"] = paper.INITIAL_VOID_RATIO
    for row in rows.values():
        row.verdict, row.reason = verdict(row.quantity, row.column, row.paper, row.mean, row.deviation, starts)
        if row.verdict == NOT_REPRODUCED and (cause := cause_of(row.quantity, row.column)):
            row.reason += f": {cause}"
    return list(rows.values())


def samples_of(groups):
    """For the sentences; of several variants of one pressure and assembly, the first."""
    values = {}
    for group in groups:
        values.setdefault((group.pressure, group.breakable), {run.case.get("seed"): observe(run) for run in group.runs})
    return Samples(values)


def found_sentences(samples):
    """Every sentence of the paper with what the samples say of it."""
    found = []
    for sentence in SENTENCES:
        ours, kind, reason = finding(sentence.parts, samples) if sentence.parts else ("–", UNDECIDABLE, "")
        if sentence.cause and kind != REPRODUCED and (ours != "–" or not sentence.parts):
            reason = f"{reason}: {sentence.cause}" if reason else sentence.cause
        others = "; ".join(f"{words}: {verdict_there} ({why})" for words, verdict_there, why in other_readings(
            sentence.parts, samples))
        found.append(Found(sentence.where, sentence.says, sentence.paper, ours, kind,
                           f"{reason}; {others}" if others else reason, others))
    return found


def tally(groups):
    """(title, seeds, how many of the paper's numbers have each verdict) of every group; each number counts once."""
    return [(group.title, ", ".join(map(str, group.seeds)),
             [sum(row.verdict == kind for row in group.rows if counts_once(row, group.pressure)) for kind in KINDS])
            for group in groups]


def counts_once(row, pressure):
    """False for the further readings of one number: stresses with two contacts held, void ratios but e4, the peak's
    numbers at 10 % strain; and for what Table 3 repeats of Table 2."""
    return not (row.quantity.endswith((HELD, "_e1", "_e2")) or (row.table == "Table 3" and (
        row.column == "10 %" or pressure == 2e6)))


def is_count(row):
    return isinstance(row.paper, int)


def value_text(row, value):
    if value is None:
        return "–"
    return f"{value:.0f}" if is_count(row) else f"{value:.3f}"


def ours_text(row):
    if row.mean is None:
        return "–"
    if row.deviation is None:
        return f"{value_text(row, row.mean)} ({len(row.values)})"
    deviation = f"{row.deviation:.1f}" if is_count(row) else f"{row.deviation:.3f}"
    return f"{value_text(row, row.mean)} ± {deviation} ({len(row.values)})"


def difference_text(row):
    if row.difference is None:
        return "–"
    return f"{row.difference:+.0f}" if is_count(row) else f"{row.difference:+.3f}"


def csv_text(groups, sentences):
    stream = io.StringIO()
    table = csv.writer(stream, lineterminator="\n")
    table.writerow(["confining_pressure", "assembly", "variant", "table", "row", "column", "paper", "mean",
                    "standard_deviation", "n", "difference", "verdict", "reason", "ours"])
    for group in groups:
        for row in group.rows:
            table.writerow([f"{group.pressure:g}", ASSEMBLY[group.breakable], group.variant, row.table, row.quantity,
                            row.column, *("" if value is None else f"{value:.6g}" for value in (
                                row.paper, row.mean, row.deviation)), len(row.values),
                            "" if row.difference is None else f"{row.difference:.6g}", row.verdict, row.reason,
                            ours_text(row)])
    for one in sentences:
        table.writerow(["", "", "", one.where, one.says, "", one.paper, "", "", "", "", one.verdict, one.reason,
                        one.ours])
    return stream.getvalue()
