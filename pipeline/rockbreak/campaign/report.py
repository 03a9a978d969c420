"""campaign.html and campaign.md: what a campaign found, one look over all of its runs."""
import os
import shlex

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from . import biaxial_test as kind
from .tables import condition_table, conditions_of, markdown_table, mean, run_table
from ..run.history import running_mean, shear_rows, sin_phi
from ..report.page import render
from ..run.results import Results
from ..run.run_directory import RunDirectory, write_text
from ..style import CYCLE, LINES, curve_figure, svg_text, thinned
from ..run.summary import SMOOTHING_WINDOW

MOST_CURVES = 12  # conditions that one figure can show apart
LOG_RATIO = 5     # of the largest to the smallest value of an axis, from which it is drawn logarithmically
MARKERS = "osD^vP"


def write_campaign_report(campaign, plan, sample_seconds):
    """Returns the path of the page."""
    title = campaign.file.stem
    conditions, runs = condition_table(plan), run_table(plan)
    failed = [run for run in plan.runs if run.failure]
    commands = [shlex.join(run.command) for run in plan.runs]
    seconds = {"runs": sum(run.summary.get("cpu_seconds") or 0 for run in plan.runs if run.summary),
               "samples": sum(sample_seconds.values())}
    paper = [name for name in ("paper_table.md", "paper_table.html", "paper_table.csv") if (plan.out / name).exists()]
    write_text(plan.out / "campaign.md", markdown(title, plan, conditions, runs, failed, commands, seconds))
    page = {
        "title": title, "plan": plan, "conditions": conditions, "runs": runs, "failed": failed, "commands": commands,
        "seconds": seconds, "done": sum(run.summary is not None for run in plan.runs), "paper": paper,
        "reports": {run.name: os.path.relpath(RunDirectory(run.out).report_file, plan.out) for run in plan.runs
                    if RunDirectory(run.out).report_file.exists()},
        "figures": figures(plan)}
    write_text(plan.out / "campaign.html", render("campaign.html.j2", page))
    return plan.out / "campaign.html"


def markdown(title, plan, conditions, runs, failed, commands, seconds):
    done = sum(run.summary is not None for run in plan.runs)
    parts = [f"# {title}", f"{done} of {len(plan.runs)} runs done, {len(failed)} failed. User seconds of dem and xfem: "
             f"{seconds['runs']:.0f} for the runs, {seconds['samples']:.0f} for the prepared samples. All numbers: "
             "`campaign.csv`."]
    if failed:
        parts += ["## Failed", "\n".join(f"- `{run.name}` (exit code {run.code}): {run.failure}" for run in failed)]
    parts += ["## Conditions", "Mean ± standard deviation over the seeds.", markdown_table(*conditions),
              "## Runs", markdown_table(*runs), "## Commands", "Each run by itself, once its sample is there:",
              "```\n" + "\n".join(commands) + "\n```"]
    return "\n\n".join(parts) + "\n"


def figures(plan):
    found = []
    conditions = [condition for condition in conditions_of(plan) if any(run.summary for run in condition.runs)]
    if 0 < len(conditions) <= MOST_CURVES:
        for name, title, caption, draw in (
                ("response", "Mobilized friction", "Running mean over 0.2 % strain; a line per run.", friction_rows),
                ("void_ratio", "Void ratio", "In the scenes' definition; a line per run.", void_ratio_rows)):
            figure = response(conditions, draw, title)
            if figure:
                found.append({"title": title, "wide": False, "caption": caption, "svg": svg_text(figure, name)})
    for axis in numeric_axes(conditions):
        figure = trends(conditions, axis)
        found.append({"title": f"Against {axis.replace('_', ' ')}", "wide": True,
                      "caption": "A mark per run; lines join the means.", "svg": svg_text(figure, f"trend-{axis}")})
    return found


def friction_rows(history):
    if "stress_yy" not in history or len(history["stress_yy"]) < 2:
        return None
    rows = shear_rows(history)
    return rows["axial_strain"], running_mean(rows["axial_strain"], sin_phi(rows), SMOOTHING_WINDOW)


def void_ratio_rows(history):
    return (history["axial_strain"], history["void_ratio"]) if "void_ratio" in history else None


def response(conditions, rows_of, ylabel):
    figure, axes = curve_figure(ylabel=ylabel.replace("Mobilized friction", "$\\sin\\varphi$ [-]"))
    drawn = False
    for index, condition in enumerate(conditions):
        label = condition.label
        for run in condition.runs:
            rows = rows_of(Results(RunDirectory(run.out)).history) if run.summary else None
            if rows is None:
                continue
            axes.plot(*thinned(100 * np.asarray(rows[0]), np.asarray(rows[1]), 400), color=CYCLE[index % len(CYCLE)],
                      linestyle=LINES[index // len(CYCLE) % len(LINES)], linewidth=1.0, label=label)
            label, drawn = None, True
    axes.margins(x=0.01)
    axes.set_xlim(left=0)
    if len(conditions) > 1 and drawn:
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)
    return figure if drawn else None


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return None


def numeric_axes(conditions):
    """Axes, the seed aside, on which at least two conditions stand at different numbers."""
    names = dict.fromkeys(axis for condition in conditions for axis in condition.labels)
    return [axis for axis in names if len({as_number(condition.labels[axis]) for condition in conditions
                                           if axis in condition.labels}) > 1
            and all(as_number(condition.labels[axis]) is not None for condition in conditions
                    if axis in condition.labels)]


def trends(conditions, axis):
    """The measures of TRENDS against one axis; what stands on the other axes tells lines apart."""
    lines = {}
    for condition in conditions:
        if axis in condition.labels:
            others = ", ".join(label for name, label in condition.labels.items() if name != axis)
            lines.setdefault(others, []).append((as_number(condition.labels[axis]), condition))
    figure = Figure(figsize=(2.7 * len(kind.TRENDS), 3.0), layout="constrained")
    for panel, (title, key) in zip(figure.subplots(1, len(kind.TRENDS)), kind.TRENDS):
        ticks = set()
        for index, (others, points) in enumerate(lines.items()):
            color, marker = CYCLE[index % len(CYCLE)], MARKERS[index % len(MARKERS)]
            points = [(x, condition.values(key)) for x, condition in sorted(points, key=lambda point: point[0])
                      if condition.values(key)]
            panel.plot([x for x, _ in points], [mean(values) for _, values in points], color=color,
                       linestyle=LINES[index % len(LINES)], label=others or None)
            for x, values in points:
                panel.plot([x] * len(values), values, marker, color=color, markersize=3.5, alpha=0.7)
                ticks.add(x)
        if ticks and min(ticks) > 0 and max(ticks) >= LOG_RATIO * min(ticks):
            panel.set_xscale("log")
            panel.xaxis.set_minor_locator(NullLocator())
            panel.xaxis.set_minor_formatter(NullFormatter())
        panel.set_xticks(sorted(ticks), [f"{x:g}" for x in sorted(ticks)], rotation=30, fontsize=8)
        panel.set_xlabel(axis.rpartition(".")[2].replace("_", " "))
        panel.set_title(title)
        if len(lines) > 1 and panel is figure.axes[0]:
            panel.legend(loc="best")
    return figure
