"""campaign.html and campaign.md: what a campaign found, one look over all of its runs. First conditions, what became of
the paper's numbers and sentences, and trends against the campaign's axes; then the catalogue's figures of all finished
runs (the paper's among them) and the paper's table."""
import csv
import os
import re
import shlex
from collections import Counter

from matplotlib.figure import Figure

from . import biaxial_test as kind
from .tables import condition_table, conditions_of, markdown_table, mean, run_table
from ..figures.curves import scale_of_ticks
from ..figures.drawn import Columns, Drawn
from ..figures.selection import KIND_COLORS, KIND_LINES, KIND_MARKERS, KINDS, select
from ..report.data_links import table
from ..report.page import contents, drawing, figure_sections, render
from ..run.results import Results
from ..run.run_directory import RunDirectory, write_text
from ..style import CYCLE, LINES, MARKERS

MOST_CURVES = 16  # conditions that one figure can show apart
KIND_STYLES = {name: (KIND_COLORS[one], KIND_LINES[one], KIND_MARKERS[one]) for one, name in KINDS.items()}


def write_campaign_report(campaign, plan, sample_seconds):
    """Returns the path of the page."""
    title = campaign.file.stem
    conditions, runs = condition_table(plan), run_table(plan)
    failed = [run for run in plan.runs if run.failure]
    commands = [shlex.join(run.command) for run in plan.runs]
    seconds = {"runs": sum(run.summary.get("cpu_seconds") or 0 for run in plan.runs if run.summary),
               "samples": sum(sample_seconds.values())}
    findings, versions = paper_findings(plan.out), versions_text(plan)
    write_text(plan.out / "campaign.md", markdown(title, plan, conditions, runs, failed, commands, seconds, findings,
                                                    versions))
    sections, paper = all_sections(plan), paper_section(plan.out)
    page = {
        "title": title, "plan": plan, "failed": failed, "commands": commands, "seconds": seconds,
        "done": sum(run.summary is not None for run in plan.runs), "sections": sections, "paper": paper,
        "findings": findings, "versions": versions,
        "contents": contents(sections, (("conditions", "Conditions"),), (
            *((("paper", "Beside the paper"),) if paper else ()), ("runs", "Runs"), ("commands", "Commands"))),
        "conditions": table("conditions", *conditions), "runs": table("runs", *runs),
        "reports": {run.name: os.path.relpath(RunDirectory(run.out).report_file, plan.out) for run in plan.runs
                    if RunDirectory(run.out).report_file.exists()}}
    write_text(plan.out / "campaign.html", render("campaign.html.j2", page))
    return plan.out / "campaign.html"


def versions_text(plan):
    """A warning if not all runs were begun by the same version of `dem`, else nothing: no hash covers the code."""
    found = Counter(kind.made_by(run.out) or "unknown" for run in plan.runs if run.summary)
    return "" if len(found) < 2 else "Not all runs were made by the same version of dem: " + ", ".join(
        f"{version} ({count} runs)" for version, count in found.most_common())


def paper_section(out):
    """What stands in paper_table.html, headings two levels down; None if the campaign has none."""
    if not (out / "paper_table.html").exists():
        return None
    text = (out / "paper_table.html").read_text(encoding="utf-8")
    text = re.sub(r"<header>.*?</header>", "", re.search(r"<main>(.*)</main>", text, re.DOTALL)[1], flags=re.DOTALL)
    return re.sub(r"<(/?)h2>", r"<\1h3>", text)


def paper_findings(out):
    """Lines that say how many of the paper's numbers and sentences are reproduced; none if the campaign has no
    paper_table.csv. There a number has the pressure of its runs, a sentence none."""
    file = out / "paper_table.csv"
    if not file.exists():
        return []
    found = {"numbers": Counter(), "sentences": Counter()}
    with open(file, encoding="utf-8", newline="") as content:
        for row in csv.DictReader(content):
            found["numbers" if row["confining_pressure"] else "sentences"][row["verdict"]] += 1
    return [f"{sum(counts.values())} {what} of the paper: " + ", ".join(
        f"{count} {verdict}" for verdict, count in counts.most_common()) for what, counts in found.items() if counts]


def markdown(title, plan, conditions, runs, failed, commands, seconds, findings, versions):
    done = sum(run.summary is not None for run in plan.runs)
    parts = [f"# {title}", f"{done} of {len(plan.runs)} runs done, {len(failed)} failed. User seconds of dem and xfem: "
             f"{seconds['runs']:.0f} for the runs, {seconds['samples']:.0f} for the prepared samples. All numbers: "
             "`campaign.csv`."]
    if findings:
        parts.append("\n".join(f"- {finding}" for finding in findings))
    if versions:
        parts.append(f"**{versions}**")
    if failed:
        parts += ["## Failed", "\n".join(f"- `{run.name}` (exit code {run.code}): {run.failure}" for run in failed)]
    parts += ["## Conditions", "Mean ± standard deviation over the seeds.", markdown_table(*conditions),
              "## Runs", markdown_table(*runs), "## Commands", "Each run by itself, once its sample is there:",
              "```\n" + "\n".join(commands) + "\n```"]
    return "\n\n".join(parts) + "\n"


def all_sections(plan):
    """A figure for each numeric axis, then the catalogue's figures."""
    conditions = [condition for condition in conditions_of(plan) if any(run.summary for run in condition.runs)]
    finished = [Results(RunDirectory(run.out)) for run in plan.runs if run.summary]
    sections = figure_sections(select(finished)) if 0 < len(conditions) <= MOST_CURVES else []
    drawn = [drawing(f"trend-{axis}", f"Against {axis.rpartition('.')[2].replace('_', ' ')}",
                     "A mark per run; lines join the means.", trends(conditions, axis))
             for axis in numeric_axes(conditions)]
    return ([{"name": "trends", "title": "Trends", "figures": drawn}] if drawn else []) + sections


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
    lines, data = {}, Columns()
    name, scale = axis.rpartition(".")[2].replace("_", " "), 1.0
    if name.endswith("pressure"):
        name, scale = f"{name} [MPa]", 1e-6
    for condition in conditions:
        if axis in condition.labels:
            others = ", ".join(label for other, label in condition.labels.items() if other != axis)
            lines.setdefault(others, []).append((scale * as_number(condition.labels[axis]), condition))
    figure = Figure(figsize=(2.7 * len(kind.TRENDS), 3.0), layout="constrained")
    for panel, (title, key) in zip(figure.subplots(1, len(kind.TRENDS)), kind.TRENDS):
        ticks = set()
        for index, (others, points) in enumerate(lines.items()):
            color, line, marker = KIND_STYLES.get(others) or (
                CYCLE[index % len(CYCLE)], LINES[index % len(LINES)], MARKERS[index % len(MARKERS)])
            points = [(x, condition.values(key)) for x, condition in sorted(points, key=lambda point: point[0])
                      if condition.values(key)]
            panel.plot([x for x, _ in points], [mean(values) for _, values in points], color=color,
                       linestyle=line, label=others or None)
            for x, values in points:
                panel.plot([x] * len(values), values, marker, color=color, markersize=3.5, alpha=0.7)
                data.add(measure=title, others=others, **{name: x}, value=values)
                ticks.add(x)
        scale_of_ticks(panel, sorted(ticks))
        panel.set_xlabel(name)
        panel.set_title(title)
        if len(lines) > 1 and panel is figure.axes[0]:
            panel.legend(loc="best")
    return Drawn(figure, data, wide=True)
