"""`pipeline/campaign`: arguments, messages, exit codes."""
import os
import shlex
import sys
from pathlib import Path

from .table import read_campaign
from .carry_out import carry_out, exit_code
from .tables import run_rows, write_csv
from ..command_line import Parser, guarded, positive
from ..errors import RockbreakError
from ..live import doing
from ..run.run_directory import check_ours
from .plan import make_plan
from .snakemake import tables_command, write_snakemake


def add_campaign_arguments(parser):
    parser.add_argument("--out", type=Path, required=True, help="directory of the campaign")
    parser.add_argument("-j", "--jobs", type=positive, default=1, metavar="N", help="local processes (default 1)")
    parser.add_argument("--threads", type=positive, help="threads of dem and of xfem in each process (default with "
                        "-j N: the N-th part of the processors)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="overrides",
                        help="a key of the scene for all runs")
    parser.add_argument("--dry-run", action="store_true", help="print what would run, and run nothing")


MARKS = ("campaign.jsonl", "plan.json")  # one of them stands in every directory of a campaign


def threads_each(options):
    """Threads of each process: several at a time must not crowd each other out. Results do not depend on it."""
    if options.threads is None and getattr(options, "snakemake", False):
        return 1
    if options.threads is None and options.jobs > 1:
        return max(1, len(os.sched_getaffinity(0)) // options.jobs)
    return options.threads


def campaign(arguments=None):
    parser = Parser(prog="pipeline/campaign", description="A table of runs, each one command in its own directory. "
                    "Finished runs are kept, interrupted ones go on, changed tables run only what is new. The path of "
                    "campaign.html is all that it writes to stdout.")
    parser.add_argument("campaign", type=Path, help="for example configs/campaign_nonbreakable.yaml")
    add_campaign_arguments(parser)
    parser.add_argument("--snakemake", action="store_true", help="write DIR/Snakefile, whose path goes to stdout, and "
                        "run nothing: for Snakemake, on this machine or on a cluster")
    options = parser.parse_args(arguments)

    def work():
        table = read_campaign(options.campaign, options.overrides)
        plan = make_plan(table, options.out, threads_each(options))
        if options.snakemake and not options.dry_run:
            check_ours(plan.out, parser.prog, MARKS)
            print(write_snakemake(plan, tables_command(options.campaign, options.out, options.overrides)))
            return
        finish(plan, options, parser.prog, lambda seconds: pages(table, plan, seconds))

    return guarded(parser.prog, work, go_on="the same command")


def finish(plan, options, program, write_pages):
    """Carries out a plan, or prints it for a dry run; prints the path that `write_pages` (user seconds of samples by
    hash) returns; then raises the error that a failed run stands for."""
    if options.dry_run:
        print_plan(plan)
        return
    check_ours(plan.out, program, MARKS)
    seconds = carry_out(plan, program, options.jobs)
    with doing("tables and pages"):
        page = write_pages(seconds)
    print(page)
    raise_failures(plan)


def pages(table, plan, seconds):
    """Tables and pages; the path of campaign.html."""
    from .report import write_campaign_report  # matplotlib is slow to load
    write_csv(plan.out / "campaign.csv", run_rows(table, plan, seconds))
    finished = [run.out for run in plan.runs if run.summary]
    if table.compare == "paper" and finished:
        from ..paper.table import write
        write(finished, plan.out)
    return write_campaign_report(table, plan, seconds)


def raise_failures(plan):
    failed = [run for run in plan.runs if run.failure]
    if failed:
        lines = "\n".join(f"  {run.name} (exit code {run.code}): {run.failure}" for run in failed)
        raise RockbreakError(exit_code(plan), f"{len(failed)} of {len(plan.runs)} runs failed; the same command tries "
                             f"them again:\n{lines}")


def print_plan(plan):
    """One line per process: what it is, whether it is there, its command."""
    for sample in plan.samples():
        print(f"{'kept' if sample.is_finished() else 'new'}\tsample\t{shlex.join(sample.command)}")
    for run in plan.runs:
        print(f"{'kept' if run.is_finished() else 'new'}\trun\t{shlex.join(run.command)}")
    sys.stdout.flush()
