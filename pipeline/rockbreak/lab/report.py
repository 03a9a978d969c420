"""lab.html: the table and the figure of every laboratory test, in one file. lab.md: the tables alone."""
import base64

from ..campaign.tables import markdown_table
from .table import HEAD, cells, percent
from ..report.page import render
from ..run.run_directory import write_text


def write_page(out, runs, rows):
    """Returns the path of the page."""
    groups = {}
    for run, row in zip(runs, rows):
        groups.setdefault(run.file.stem, []).append({"run": run, "cells": cells(row), "figure": figure_of(run)})
    page = {"head": HEAD, "groups": groups, "runs": runs, "done": sum(run.summary is not None for run in runs),
            "failed": [run for run in runs if run.failure],
            "seconds": sum(run.summary["seconds"] for run in runs if run.summary),
            "worst": {name: worst([row for run, row in zip(runs, rows) if run.file.stem == name]) for name in groups}}
    write_text(out / "lab.md", "\n\n".join(
        f"## {name}\n\n{page['worst'][name]}\n\n{markdown_table(HEAD, [item['cells'] for item in items])}"
        for name, items in groups.items()) + "\n")
    path = out / "lab.html"
    write_text(path, render("lab.html.j2", page))
    return path


def figure_of(run):
    """As an image of its own, so that nothing in it can meet the page or another figure."""
    path = run.out / "specimen.svg"
    if not run.summary or not path.exists():
        return None
    return "data:image/svg+xml;base64," + base64.b64encode(path.read_bytes()).decode()


def worst(rows):
    """The largest errors of one file's tests, as text."""
    parts = []
    for key, name in (("error_first_failure", "first failure"), ("error_breakage", "breakage")):
        errors = [row[key] for row in rows if row[key] is not None]
        if errors:
            parts.append(f"{name} {percent(max(errors, key=abs), 1)}")
    kinds = {row["reference"] for row in rows if row["reference"]}
    return f"largest error against {' and '.join(sorted(kinds))}: {', '.join(parts)}" if parts else "no reference"
