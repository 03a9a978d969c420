"""tests/robustness/run: see there."""
import argparse
import fnmatch
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from . import FOLDER, PARTS, REPOSITORY

sys.path.insert(0, str(REPOSITORY / "pipeline"))
sys.path.insert(0, str(REPOSITORY / "tests"))

from . import table  # noqa: E402
from .case_file import CaseError, read_cases  # noqa: E402
from .outcome import run_case  # noqa: E402


def main(arguments):
    parser = argparse.ArgumentParser(prog="tests/robustness/run", description="Runs the hard cases.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="a case, a part or a pattern; all without one")
    parser.add_argument("--write", action="store_true", help="put the table into tests/robustness/README.md")
    parser.add_argument("--jobs", type=int, default=2, metavar="N", help="cases at a time (default 2)")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build", metavar="DIR")
    parser.add_argument("--cases", type=Path, default=FOLDER / "cases", metavar="DIR", help="folder of the case files")
    options = parser.parse_args(arguments)
    try:
        everything = read_cases(options.cases)
        cases = chosen(everything, options.names)
    except CaseError as error:
        print(f"robustness: error: {error}", file=sys.stderr)
        return 2
    if options.write and len(cases) < len(everything):
        print("robustness: error: --write takes no NAME: the table holds every case", file=sys.stderr)
        return 2

    outcomes = []
    with ThreadPoolExecutor(max(1, options.jobs)) as pool:
        for outcome in pool.map(lambda case: run_case(case, options.out.resolve() / "robustness"), cases):
            outcomes.append(outcome)
            print(line(outcome), flush=True)
    write_json(outcomes, options.out / "robustness.json")
    if options.write:
        table.write(outcomes)
    red = sum(not outcome.green for outcome in outcomes)
    print(f"{len(outcomes) - red} green, {red} red")
    return 1 if red else 0


def chosen(cases, names):
    """The cases that the names mean, in the order of the files."""
    for name in names:
        if not any(means(name, case) for case in cases):
            raise CaseError(f"{name}: no case has this name, expected a part ({', '.join(PARTS)}), a pattern or one of: "
                            + "; ".join(case.name for case in cases))
    return [case for case in cases if not names or any(means(name, case) for name in names)]


def means(name, case):
    return name == case.part or fnmatch.fnmatchcase(case.name, name)


def line(outcome):
    text = f"{'green' if outcome.green else 'RED  '} {outcome.case.part}: {outcome.case.name}: {outcome.text()}"
    return text if outcome.green else text + "".join(f"\n      {reason}" for reason in outcome.reasons)


def write_json(outcomes, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = [{"part": o.case.part, "name": o.case.name, "expected": o.case.expected, "green": o.green,
             "reasons": o.reasons, "measured": o.measured} for o in outcomes]
    path.write_text(json.dumps({"schema": "robustness/1", "cases": rows}, indent=2) + "\n", encoding="utf-8")
