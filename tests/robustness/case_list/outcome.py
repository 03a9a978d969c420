"""Runs one case: its commands or its tests, and the verdict."""
import math
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field

from patience import patience
from rockbreak.run.child import binaries, executable

from . import REPOSITORY
from .case_file import one_line
from .numbers import NoNumber, value_of


@dataclass
class Outcome:
    case: object
    reasons: list = field(default_factory=list)   # why it is red
    measured: dict = field(default_factory=dict)  # label: number
    said: list = field(default_factory=list)      # of an expected failure: exit code and message

    green = property(lambda self: not self.reasons)

    def text(self):
        """What came out, as it stands in the table: each number with its bounds."""
        bounds = {label: f" ({interval(least, most)})" for label, least, most in self.case.bounds}
        numbers = [f"{label} {shown(value)}{bounds.get(label, '')}" for label, value in self.measured.items()]
        return ", ".join(self.said + numbers)


def shown(value):
    """Four significant digits; counts in full."""
    if math.isfinite(value) and value == int(value) and abs(value) < 1e6:
        return str(int(value))
    return f"{value:.4g}"


def run_case(case, folder):
    """Runs a case in a fresh folder of its own below `folder`."""
    out = folder / case.part / case.folder
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    outcome = Outcome(case)
    try:
        if case.tests:
            run_tests(case, outcome)
        else:
            run_commands(case, out, outcome)
    except subprocess.TimeoutExpired as error:
        outcome.reasons.append(f"not done after {error.timeout:.0f} s")
    return outcome


def run_commands(case, out, outcome):
    run = out / "run"
    for number, command in enumerate(case.commands):
        words = [word.replace("{out}", str(run)) for word in command.split()]
        process = call([program(words[0]), *words[1:]], case.timeout)
        (out / f"{number}.stdout").write_text(process.stdout)
        (out / f"{number}.stderr").write_text(process.stderr)
        last = number == len(case.commands) - 1
        expected = case.exit if last else 0
        if process.returncode != expected:
            said = process.stderr.strip().splitlines() or ["nothing on stderr"]
            outcome.reasons.append(f"`{words[0]}` exit code {process.returncode}, expected {expected}: {said[-1][:300]}")
            if not last:
                return
    if case.exit:
        outcome.said.append(f"exit code {process.returncode}")
    if case.stderr is not None:
        found = re.search(case.stderr, process.stderr)
        outcome.said.append(f"\u201c{one_line(found.group())}\u201d" if found else "no such message")
        if not found:
            said = process.stderr.strip().splitlines() or ["nothing"]
            outcome.reasons.append(f"stderr does not match `{case.stderr}`: {said[-1][:300]}")
    measure(case, run, process.stdout, outcome)


def measure(case, run, stdout, outcome):
    for label, path in case.measure.items():
        try:
            outcome.measured[label] = value_of(path, run, stdout)
        except NoNumber as error:
            outcome.reasons.append(f"{label}: {error}")
    for label, least, most in case.bounds:
        value = outcome.measured.get(label)
        if value is None:
            continue
        # Written so that a value that is not a number is outside.
        if not ((least is None or value >= least) and (most is None or value <= most)):
            outcome.reasons.append(f"{label} {shown(value)}, expected {interval(least, most)}")


def interval(least, most):
    if least is None:
        return f"at most {exactly(most)}"
    if most is None:
        return f"at least {exactly(least)}"
    return exactly(least) if least == most else f"{exactly(least)} to {exactly(most)}"


def exactly(bound):
    """As few digits as give the very number: four would make 1 of 0.999999."""
    return shown(bound) if float(shown(bound)) == bound else repr(bound)


def program(word):
    return executable(word) if word in ("dem", "xfem") else str(REPOSITORY / word)


def call(words, timeout):
    return subprocess.run(words, cwd=REPOSITORY, capture_output=True, text=True, errors="replace",
                          timeout=patience(timeout), check=False, stdin=subprocess.DEVNULL)


def run_tests(case, outcome):
    passed = 0
    for runner, name in case.tests:
        reason = run_pytest(name, case.timeout) if runner == "pytest" else run_catch(runner, name, case.timeout)
        if reason:
            outcome.reasons.append(f"{name}: {reason}")
        else:
            passed += 1
    outcome.measured["tests passed"] = passed


def run_catch(runner, name, timeout):
    """Why a Catch2 test is not passed, or None."""
    path = binaries() / "tests" / runner
    if not path.exists():
        return f"{path} is not built"
    # A pattern that no test has exits 0, too; and these characters have a meaning in patterns.
    pattern = re.sub(r'([,\[\]\\"*~])', r"\\\1", name)
    listed = call([str(path), "--list-test-names-only", pattern], timeout).stdout.splitlines()
    if name not in [line.strip() for line in listed]:
        return f"{runner} has no test of this name"
    process = call([str(path), pattern], timeout)
    return None if process.returncode == 0 else f"failed: {process.stdout.strip()[-300:]}"


def run_pytest(name, timeout):
    """Why a pytest node is not passed, or None."""
    process = call([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", name], timeout)
    if process.returncode == 0:
        return None
    return "no such test" if process.returncode in (4, 5) else f"failed: {process.stdout.strip()[-300:]}"
