"""`pipeline/run` and `pipeline/report`: arguments, messages, exit codes."""
import argparse
import sys
import time
from pathlib import Path

from .errors import BAD_INPUT, IO_FAILURE, Interrupted, RockbreakError
from .live import doing
from .run.driver import Options, drive
from .run.ledger import Ledger, read_ledger
from .run.progress import make_progress
from .run.results import Results
from .run.run_directory import RunDirectory
from .run.summary import wall_seconds, write_summary
from .run.xdmf import write_xdmf


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        self.exit(BAD_INPUT, f"{self.prog}: {message}\n")


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"found {text}, expected a number of at least 1")
    return number


def guarded(program, work, go_on="--resume"):
    """Exit code of `work`; what goes wrong becomes a message for people."""
    try:
        work()
    except RockbreakError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return error.code
    except Interrupted as interrupt:
        print(f"{program}: interrupted; go on with {go_on}", file=sys.stderr)
        return interrupt.code
    except KeyboardInterrupt:
        return 130
    except OSError as error:
        print(f"{program}: {error.filename or 'a file'}: {error.strerror or error}", file=sys.stderr)
        return IO_FAILURE
    return 0


def run(arguments=None):
    parser = Parser(prog="pipeline/run", description="The coupled DEM + XFEM loop: runs a scene, summarizes and "
                    "reports it. The path of the report is all that it writes to stdout.")
    parser.add_argument("case", type=Path, help="scene, for example configs/demo.yaml")
    parser.add_argument("--out", type=Path, required=True, help="run directory")
    parser.add_argument("--mode", choices=("resident", "oneshot"), default="resident",
                        help="two processes that stay (default), or one per frame and split; the results are equal")
    parser.add_argument("--resume", action="store_true", help="go on from the newest valid frame in --out")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", dest="overrides",
                        help="override a key of the scene, for example --set seed=2")
    parser.add_argument("--threads", type=positive, help="threads of dem and of xfem")
    parser.add_argument("--no-report", action="store_true",
                        help="write summary.json only, no report.html and no run.xdmf")
    options = parser.parse_args(arguments)

    def work():
        progress = make_progress()
        directory = drive(Options(options.case, options.out, options.mode, options.resume, options.overrides,
                                  options.threads), progress)
        if not is_concluded(directory, with_report=not options.no_report):
            with progress:
                progress.stage("summary" if options.no_report else "report")
                conclude(directory, with_report=not options.no_report)
        print(directory.summary_file if options.no_report else directory.report_file)

    return guarded(parser.prog, work)


def is_concluded(directory, with_report):
    """Whether summary (and report) are of the files that stand here now: by the ledger, as clocks can jump."""
    kinds = [event["event"] for event in read_ledger(directory.ledger_file)]
    changed = max((at for at, kind in enumerate(kinds) if kind in ("frame", "split")), default=-1)
    concluded = kinds[changed + 1:]
    return (directory.summary() is not None and ("summary" in concluded or "report" in concluded)
            if not with_report else directory.report_file.exists() and "report" in concluded)


def conclude(directory, with_report):
    """Summary of one finished run, with its report and run.xdmf, whose time goes into both ledger and summary."""
    results = Results(directory)
    directory.bring_results_to_disk()  # whoever finds a summary need not look for what it was made from
    write_summary(directory, results.summary)
    if not with_report:
        with Ledger(directory.ledger_file) as ledger:
            ledger.write("summary", path=directory.summary_file.name)
        return
    from .report.page import write_report  # matplotlib is slow to load: only where figures are made
    begin = time.perf_counter()
    write_xdmf(directory)
    write_report([results], directory.report_file)
    with Ledger(directory.ledger_file) as ledger:
        ledger.write("report", path=directory.report_file.name,
                     seconds={"report": round(time.perf_counter() - begin, 3)})
    results.summary["wall_seconds"] = wall_seconds(results.ledger())
    write_summary(directory, results.summary)


def report(arguments=None):
    parser = Parser(prog="pipeline/report", description="Figures, tables and one self-contained report.html of a run; "
                    "of several runs, a comparison; run.xdmf of each for ParaView. The path of the report is all that "
                    "it writes to stdout.")
    parser.add_argument("directories", type=Path, nargs="+", metavar="DIR", help="run directories")
    parser.add_argument("--out", type=Path, help="file to write (default: report.html in DIR; comparison.html in the "
                        "first DIR if there are several)")
    parser.add_argument("--figures", type=Path, metavar="FOLDER",
                        help="every figure as SVG, PNG and CSV into a folder too")
    options = parser.parse_args(arguments)

    def work():
        from .report.page import write_report
        runs = [Results(RunDirectory(path)) for path in options.directories]
        first = runs[0].directory
        target = options.out or (first.report_file if len(runs) == 1 else first.path / "comparison.html")
        with doing(f"report of {len(runs)} runs" if len(runs) > 1 else "report"):
            for one in runs:
                write_summary(one.directory, one.summary)
                write_xdmf(one.directory)
            write_report(runs, target, options.figures)
        print(target)

    return guarded(parser.prog, work)
