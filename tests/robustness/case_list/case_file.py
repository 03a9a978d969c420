"""The cases of tests/robustness/cases/{dem,xfem,coupling}.yaml, checked; the format stands in tests/robustness/README.md."""
import re
from dataclasses import dataclass, field

import yaml

from . import FOLDER, PARTS

REQUIRED = {"name": "a text", "why": "a text", "expected": "a text"}
OPTIONAL = {"run", "tests", "check", "measure", "quick", "timeout"}
CHECKS = {"exit", "stderr", "bounds"}
PROGRAMS = ("tests_common", "tests_dem", "tests_xfem", "tests_geometry")


class CaseError(Exception):
    """A case file that does not follow the format; the message names file and case, what was found and expected."""


@dataclass
class Case:
    part: str
    name: str
    why: str
    expected: str
    commands: list = field(default_factory=list)  # shell words each, {out} not yet replaced
    tests: list = field(default_factory=list)     # (program or "pytest", name)
    exit: int = 0
    stderr: str = None
    measure: dict = field(default_factory=dict)   # label: path of a number
    bounds: list = field(default_factory=list)    # (label, smallest, largest), None for no bound
    quick: bool = True
    timeout: float = 60.0

    folder = property(lambda self: re.sub(r"[^a-z0-9]+", "_", self.name.lower()).strip("_"))


def read_cases(folder=FOLDER / "cases"):
    """Every case, in the order of parts and files. Raises CaseError."""
    cases = []
    for part in PARTS:
        file = folder / f"{part}.yaml"
        if file.exists():
            cases += read_part(file, part)
    taken = {}
    for case in cases:
        if case.folder in taken:
            raise CaseError(f"{case.part}.yaml: case '{case.name}': {taken[case.folder]} has it as well, "
                            "expected a name of its own")
        taken[case.folder] = f"{case.part}.yaml"
    return cases


def read_part(file, part):
    try:
        entries = yaml.safe_load(file.read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise CaseError(f"{file}: {error}") from error
    if not isinstance(entries, list):
        raise CaseError(f"{file}: found {kind(entries)}, expected a list of cases")
    return [read_case(entry, part, Where(file, number)) for number, entry in enumerate(entries, 1)]


class Where:
    """Names a case in messages."""

    def __init__(self, file, number):
        self.file, self.name = file, f"number {number}"

    def fail(self, text):
        raise CaseError(f"{self.file}: case {self.name}: {text}")

    def require(self, good, key, found, expected):
        if not good:
            self.fail(f"{key}: found {found!r}, expected {expected}")


def read_case(entry, part, where):
    where.require(isinstance(entry, dict), "the case", entry, "keys and values")
    if isinstance(entry.get("name"), str):
        where.name = f"'{entry['name']}'"
    for key, expected in REQUIRED.items():
        where.require(isinstance(entry.get(key), str) and entry[key].strip(), key, entry.get(key), expected)
    for key in entry:
        where.require(key in REQUIRED or key in OPTIONAL, "key", key,
                      "one of " + ", ".join([*REQUIRED, *sorted(OPTIONAL)]))
    where.require(("run" in entry) != ("tests" in entry), "run, tests", [k for k in ("run", "tests") if k in entry],
                  "one of the two")
    case = Case(part, entry["name"].strip(), one_line(entry["why"]), one_line(entry["expected"]))
    case.quick, case.timeout = entry.get("quick", True), entry.get("timeout", 60.0)
    where.require(isinstance(case.quick, bool), "quick", case.quick, "true or false")
    where.require(number_of(case.timeout) is not None, "timeout", case.timeout, "seconds")
    if "tests" in entry:
        for key in ("check", "measure"):
            where.require(key not in entry, key, entry.get(key), "none: tests check themselves")
        case.tests = read_tests(entry["tests"], where)
    else:
        case.commands = read_commands(entry["run"], where)
        read_checks(case, entry, where)
    return case


def read_commands(run, where):
    commands = [run] if isinstance(run, str) else run
    good = isinstance(commands, list) and commands and all(isinstance(c, str) and c.strip() for c in commands)
    where.require(good, "run", run, "a command or a list of commands")
    return [one_line(command) for command in commands]


def read_tests(tests, where):
    """Pairs (program, name): `tests_dem: sentence` or `pytest: tests/pipeline/file.py::name`."""
    where.require(isinstance(tests, list) and tests, "tests", tests, "a list of `program: name`")
    pairs = []
    for test in tests:
        good = isinstance(test, dict) and len(test) == 1 and all(isinstance(t, str) for t in test.values())
        where.require(good, "tests", test, "`program: name`")
        (program, name), = test.items()
        where.require(program in (*PROGRAMS, "pytest"), "tests", program, "one of " + ", ".join((*PROGRAMS, "pytest")))
        pairs.append((program, name))
    return pairs


def read_checks(case, entry, where):
    measure = entry.get("measure", {})
    good = isinstance(measure, dict) and all(isinstance(path, str) for path in measure.values())
    where.require(good, "measure", measure, "`label: path of a number`")
    case.measure = measure
    check = entry.get("check")
    where.require(isinstance(check, dict) and check, "check", check, "exit, stderr or bounds")
    for key in check:
        where.require(key in CHECKS, "check", key, "one of " + ", ".join(sorted(CHECKS)))
    case.exit = check.get("exit", 0)
    where.require(isinstance(case.exit, int) and 0 <= case.exit < 256, "check.exit", case.exit, "an exit code")
    case.stderr = check.get("stderr")
    if case.stderr is not None:
        try:
            re.compile(case.stderr)
        except (re.error, TypeError):
            where.require(False, "check.stderr", case.stderr, "a regular expression")
    bounds = check.get("bounds", [])
    where.require(isinstance(bounds, list), "check.bounds", bounds, "a list of [label, smallest, largest]")
    for bound in bounds:
        where.require(isinstance(bound, list) and len(bound) == 3, "check.bounds", bound, "[label, smallest, largest]")
        label, *ends = bound
        where.require(label in measure, "check.bounds", label, "a label of `measure`: " + ", ".join(measure))
        numbers = [number_of(end) for end in ends]
        good = all((n is None) == (end is None) for n, end in zip(numbers, ends)) and numbers != [None, None]
        where.require(good, "check.bounds", bound, "two numbers, or null for one of them")
        case.bounds.append((label, *numbers))
    bare = case.exit == 0 and not case.bounds
    where.require(not bare, "check", check, "bounds: an exit code 0 alone shows nothing of what came out")


def number_of(value):
    """A number, also as YAML's 1e-3, which PyYAML takes for a text; None if it is none."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return None
    try:
        return float(value)
    except ValueError:
        return None


def one_line(text):
    return " ".join(text.split())


def kind(value):
    return "nothing" if value is None else type(value).__name__
