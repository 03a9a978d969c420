"""The numbers of a campaign: one row per run with all of its summary (campaign.csv), and conditions, which are rows
that differ by their seed alone, with mean and scatter (the overview)."""
import csv
import io
import math
import os
from dataclasses import dataclass

from . import biaxial_test as kind
from .cases import value_at
from ..run.run_directory import write_text


def numbers_of(summary, prefix=""):
    """Every number of a summary by its dotted name."""
    found = {}
    for key, value in summary.items():
        if isinstance(value, dict):
            found |= numbers_of(value, f"{prefix}{key}.")
        elif isinstance(value, (int, float)) and not isinstance(value, bool):
            found[prefix + key] = value
    return found


def varied_keys(plan):
    """Scene keys that some row sets, in order of appearance."""
    return list(dict.fromkeys(key for run in plan.runs for variation in run.variations for key, _ in variation.keys))


def plain_text(value):
    return "+".join(str(item) for item in value) if isinstance(value, list) else "" if value is None else str(value)


def run_rows(campaign, plan, sample_seconds):
    """A dictionary per run; `sample_seconds`: user seconds by sample hash. What is not known is left out."""
    names = [axis for axis in campaign.axes if axis not in varied_keys(plan)]
    rows = []
    for run in plan.runs:
        labels = dict(run.variations[0].labels)
        row = {"name": run.name, "state": "done" if run.summary else "failed" if run.failure else "not run",
               "exit_code": run.code, "failure": run.failure or "", "directory": os.path.relpath(run.out, plan.out),
               "hash": run.hash}
        row |= {name: labels.get(name, "") for name in names}
        row |= {key: plain_text(value_at(run.case, key)) for key in varied_keys(plan)}
        row["sample"] = run.sample.out.name if run.sample else ""
        row["sample_cpu_seconds"] = sample_seconds.get(run.sample.hash, "") if run.sample else ""
        rows.append(row | (numbers_of(run.summary) if run.summary else {}))
    return rows


def write_csv(path, rows):
    columns = list(dict.fromkeys(column for row in rows for column in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())


@dataclass
class Condition:
    """Runs that differ by their seed alone."""
    label: str
    labels: dict
    runs: list

    def values(self, key):
        found = [numbers_of(run.summary).get(key) for run in self.runs if run.summary]
        return [value for value in found if value is not None]


def axis_text(axis, label):
    """What one key of a row is set to, in words; a pressure as in the figures."""
    if axis.endswith("confining_pressure"):
        return f"{1e-6 * float(label):g} MPa"
    return f"{axis.rpartition('.')[2].replace('_', ' ')} {label}"


def conditions_of(plan):
    found = {}
    for run in plan.runs:
        variation = run.variations[0]
        labels = {axis: label for axis, label in variation.labels if axis != "seed"}
        words = [variation.title] if variation.title else [
            axis_text(axis, label) if axis in dict(variation.keys) else label for axis, label in labels.items()]
        label = ", ".join(words) or "base"
        found.setdefault(label, Condition(label, labels, [])).runs.append(run)
    return list(found.values())


def mean(values):
    return math.fsum(values) / len(values)


def scatter(values):
    """Standard deviation of the sample; None of fewer than two values."""
    if len(values) < 2:
        return None
    middle = mean(values)
    return math.sqrt(math.fsum((value - middle) ** 2 for value in values) / (len(values) - 1))


def with_scatter(values, form):
    if not values:
        return "–"
    spread = scatter(values)
    return form.format(mean(values)) + (f" ± {form.format(spread)}" if spread is not None else "")


def shown_columns(plan):
    """Of the overview's columns those that some run has a number for."""
    known = set().union(*(numbers_of(run.summary) for run in plan.runs if run.summary)) if plan.runs else set()
    return [column for column in kind.OVERVIEW if column[1] in known]


def condition_table(plan):
    """Heading cells, then rows of text: mean and scatter over the seeds."""
    columns = shown_columns(plan)
    return (["condition", "runs", *(heading for heading, _, _ in columns)],
            [[condition.label, f"{sum(run.summary is not None for run in condition.runs)} of {len(condition.runs)}",
              *(with_scatter(condition.values(key), form) for _, key, form in columns)]
             for condition in conditions_of(plan)])


def run_table(plan):
    columns = shown_columns(plan)
    rows = []
    for run in plan.runs:
        numbers = numbers_of(run.summary) if run.summary else {}
        rows.append([run.name, "done" if run.summary else "failed" if run.failure else "not run",
                     *(form.format(numbers[key]) if key in numbers else "–" for _, key, form in columns)])
    return ["run", "state", *(heading for heading, _, _ in columns)], rows


def markdown_table(head, rows):
    def line(cells):
        return "| " + " | ".join(str(cell).replace("|", "\\|") for cell in cells) + " |"
    return "\n".join([line(head), line(["---"] + ["---:"] * (len(head) - 1)), *(line(row) for row in rows)])
