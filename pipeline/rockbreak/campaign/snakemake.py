"""A plan for Snakemake, for campaigns that outgrow one machine: DIR/plan.json, beside it the Snakefile that reads it.

Every sample and every run is a rule whose command is the one that `pipeline/campaign` itself would start; what a rule
makes is what `pipeline/campaign` takes for finished. The last rule is `pipeline/campaign` itself, which then finds all
runs done and writes tables and pages.
"""
import json
import os
import shlex
from pathlib import Path

from ..run.child import REPOSITORY
from ..run.run_directory import make_folder, write_text

SNAKEFILE = Path(__file__).resolve().with_name("Snakefile")


def write_snakemake(plan, tables_command):
    """Writes DIR/Snakefile and DIR/plan.json; returns the Snakefile's path. The commands start where this process did,
    so that relative names mean what they meant."""
    make_folder(plan.out / "logs")
    content = {"jobs": planned_jobs(plan), "tables": started_here(tables_command)}
    write_text(plan.out / "plan.json", json.dumps(content, indent=1) + "\n")
    write_text(plan.out / "Snakefile", SNAKEFILE.read_text(encoding="utf-8"))
    return plan.out / "Snakefile"


def planned_jobs(plan):
    """A dictionary per rule, paths relative to DIR. Rules with a long way to go have a high priority."""
    jobs, longest = [], {}
    for run in plan.runs:
        needs = run.kind.sample_results(run.sample.out) if run.sample else []
        jobs.append(rule(plan, run.name, needs, run.kind.results(run.out, run.report), run.command, run.effort))
        if run.sample:
            longest[run.sample.hash] = max(longest.get(run.sample.hash, 0.0), run.effort)
    for sample in plan.samples():
        jobs.append(rule(plan, f"sample_{sample.out.name}", [], sample.kind.sample_results(sample.out), sample.command,
                         sample.effort + longest[sample.hash]))
    ranks = sorted({job["priority"] for job in jobs})
    return [{**job, "priority": ranks.index(job["priority"]) + 1} for job in jobs]


def rule(plan, name, needs, makes, command, effort):
    threads = int(command[command.index("--threads") + 1]) if "--threads" in command else 1

    def relative(paths):
        return [os.path.relpath(path, plan.out) for path in paths]

    return {"name": name, "needs": relative(needs), "makes": relative(makes), "log": f"logs/{name}.log",
            "command": started_here(command), "priority": effort, "threads": threads}


def started_here(command):
    """A shell command. Snakemake's own log is relative to DIR, so only the command itself changes its folder."""
    return f"(cd {shlex.quote(os.getcwd())} && exec {shlex.join(command)})"


def tables_command(campaign, out, overrides):
    words = [word for override in overrides for word in ("--set", override)]
    return [str(REPOSITORY / "pipeline" / "campaign"), str(campaign), "--out", str(out), *words]
