"""`pipeline/lab`: arguments, messages, exit codes."""
import json
from pathlib import Path

from ..campaign.progress import Tally, make_campaign_progress
from ..run.child import executable
from ..command_line import Parser, guarded, positive
from ..run.driver import catch_signals
from ..errors import RockbreakError
from ..campaign.jobs import Job, run_jobs
from .table import table_rows, text_table, write_table
from .tests import plan_tests
from ..run.run_directory import check_ours, lock_directory

TABLE = "lab.csv"


def lab(arguments=None):
    parser = Parser(prog="pipeline/lab", description="Laboratory tests of single specimens against theory. Writes "
                    "lab.csv, lab.html, lab.md and, per test, summary.json, result.h5, specimen.svg, case.yaml; prints "
                    "the table. All tests run anew; in an --out of its own it replaces those that it runs. A test that "
                    "fails stops no other, and what was finished when it is interrupted stays, with its table.")
    parser.add_argument("tests", type=Path, nargs="+", metavar="DIR_OR_FILE", help="for example configs/lab")
    parser.add_argument("--out", type=Path, required=True, help="directory of the results")
    parser.add_argument("-j", "--jobs", type=positive, default=1, metavar="N", help="local processes (default 1)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="overrides",
                        help="a key for all tests, for example mesh.nodes=300; it is swept no more")
    options = parser.parse_args(arguments)

    def work():
        runs = plan_tests(options.tests, options.out, options.overrides)
        check_ours(options.out, parser.prog, [TABLE])
        try:
            carry_out(runs, options, parser.prog)
        finally:
            rows = table_rows(runs)
            if any(run.summary or run.failure for run in runs):
                from .report import write_page
                write_table(options.out / TABLE, rows)
                page = write_page(options.out, runs, rows)
                print(text_table(rows), page, sep="\n", flush=True)
        raise_failures(runs)

    return guarded(parser.prog, work, go_on="the same command")


def carry_out(runs, options, program):
    """Fills in summary, or failure and exit code, of every run that ended."""
    xfem = executable("xfem")
    with lock_directory(options.out, program) as lock:
        catch_signals()
        if not (options.out / TABLE).exists():
            (options.out / TABLE).touch()  # the mark of a directory of ours, also when interrupted
        jobs = {}
        for run in runs:
            (run.out / "summary.json").unlink(missing_ok=True)
            words = [f"{key}={value}" for key, value in run.keys] + options.overrides
            run.command = [xfem, "lab", str(run.file), "--out", str(run.out),
                           *(word for override in words for word in ("--set", override))]
            jobs[run.name] = Job(run.name, run.command, options.out / "lab.log")
        waiting = list(jobs.values())
        try:
            with make_campaign_progress(Tally(waiting, waiting, 0)) as progress:
                run_jobs(waiting, options.jobs, lock, progress.changed)
        finally:
            for run in runs:
                conclude(run, jobs[run.name])


def conclude(run, job):
    if job.state == "failed":
        run.failure, run.code = job.reason, job.code
    elif job.state == "done":
        run.summary = json.loads((run.out / "summary.json").read_text(encoding="utf-8"))


def raise_failures(runs):
    failed = [run for run in runs if run.failure]
    if failed:
        lines = "\n".join(f"  {run.name} (exit code {run.code}): {run.failure}" for run in failed)
        raise RockbreakError(failed[0].code, f"{len(failed)} of {len(runs)} tests failed:\n{lines}")
