"""The list of hard cases: every quick one is green, and the table in tests/robustness/README.md is that of the case
files and of what is measured now."""
import re
import subprocess
import sys

import pytest

from conftest import REPOSITORY

sys.path.insert(0, str(REPOSITORY / "tests" / "robustness"))

from case_list import table  # noqa: E402
from case_list.case_file import CaseError, read_cases  # noqa: E402
from case_list.numbers import NoNumber, value_of  # noqa: E402
from case_list.outcome import run_case  # noqa: E402

CASES = read_cases()
GOOD = {"name": "a name", "why": "a reason", "expected": "an outcome", "run": "dem check configs/demo.yaml",
        "measure": "{n: 'summary.json:a'}", "check": "{bounds: [[n, 0, 1]]}"}


def test_the_table_lists_exactly_the_cases():
    assert list(table.written_rows()) == [table.cell(case.name) for case in CASES], "tests/robustness/run --write"


@pytest.mark.parametrize("case", [
    pytest.param(case, id=f"{case.part}-{case.folder}", marks=[pytest.mark.repeats] if case.tests else [])
    for case in CASES if case.quick])
def test_case(case, tmp_path):
    outcome = run_case(case, tmp_path)
    assert outcome.green, "\n".join(outcome.reasons)
    assert table.written_rows().get(table.cell(case.name)) == table.row(outcome), "tests/robustness/run --write"


def test_the_table_says_what_the_case_files_say():
    for case in CASES:
        row = table.written_rows().get(table.cell(case.name), "")
        assert row.startswith(table.row_head(case)), f"{case.name}: tests/robustness/run --write"
        assert case.quick or "**red**" not in row, case.name


def write_case(folder, **changes):
    entry = {key: value for key, value in {**GOOD, **changes}.items() if value is not None}
    text = "".join(f"{'- ' if n == 0 else '  '}{key}: {value}\n" for n, (key, value) in enumerate(entry.items()))
    (folder / "dem.yaml").write_text(text)
    return read_cases(folder)


def test_a_case_file_is_read(tmp_path):
    case, = write_case(tmp_path, measure="{n: 'summary.json:a / 2'}", check="{exit: 3, bounds: [[n, 1e-3, null]]}")
    assert (case.part, case.exit, case.bounds) == ("dem", 3, [("n", 1e-3, None)])


@pytest.mark.parametrize("changes, text", [
    ({"why": None}, "why: found None, expected a text"),
    ({"runs": "x"}, "key: found 'runs', expected one of name, why, expected, check"),
    ({"tests": "[{tests_dem: a}]"}, "run, tests: found ['run', 'tests'], expected one of the two"),
    ({"run": "[]"}, "run: found [], expected a command or a list of commands"),
    ({"check": "{bounds: [[m, 0, 1]]}"}, "check.bounds: found 'm', expected a label of `measure`: n"),
    ({"check": "{bounds: [[n, low, 1]]}"}, "check.bounds: found ['n', 'low', 1], expected two numbers"),
    ({"check": "{exit: three}"}, "check.exit: found 'three', expected an exit code"),
    ({"check": "{stderr: '('}"}, "check.stderr: found '(', expected a regular expression"),
    ({"check": "{exit: 0}"}, "expected bounds: an exit code 0 alone shows nothing"),
    ({"run": None, "measure": None, "check": None, "tests": "[{tests_foo: a}]"}, "tests: found 'tests_foo', expected"),
])
def test_a_wrong_case_is_refused_with_file_case_and_key(tmp_path, changes, text):
    with pytest.raises(CaseError, match=re.escape(text)) as error:
        write_case(tmp_path, **changes)
    assert "dem.yaml: case 'a name'" in str(error.value)


def test_a_wrong_case_file_ends_the_command_with_2(tmp_path):
    (tmp_path / "dem.yaml").write_text("- name: a name\n")
    process = subprocess.run([REPOSITORY / "tests/robustness/run", "--cases", tmp_path], capture_output=True, text=True,
                             check=False)
    assert process.returncode == 2 and "case 'a name': why" in process.stderr and "Traceback" not in process.stderr


@pytest.mark.parametrize("changes, reason", [
    ({"run": "tests/robustness/run nothing", "check": "{exit: 3}", "measure": None}, "exit code 2, expected 3"),
    ({"check": "{stderr: wrong scene, exit: 0, bounds: [[n, 0, 1]]}"}, "stderr does not match"),
    ({}, "n: summary.json:a: FileNotFoundError"),
    ({"measure": "{n: 1.5 / 1}"}, "n 1.5, expected 0 to 1"),
    ({"measure": "{n: 1 / 0}"}, "n nan, expected 0 to 1"),
    ({"run": None, "measure": None, "check": None, "tests": "[{tests_dem: no such test}]"}, "has no test of this name"),
    ({"run": None, "measure": None, "check": None, "tests": "[{pytest: tests/pipeline/conftest.py}]"}, "no such test"),
])
def test_a_case_that_does_not_meet_its_check_is_red_and_says_why(tmp_path, changes, reason):
    case, = write_case(tmp_path, **changes)
    outcome = run_case(case, tmp_path)
    assert not outcome.green and reason in "\n".join(outcome.reasons)


def test_numbers_are_read_by_their_paths(tmp_path):
    (tmp_path / "summary.json").write_text('{"a": {"b": [1, -4]}}')
    assert value_of("summary.json:a.b", tmp_path, "") == -4
    assert value_of("summary.json:a.b:max_abs - 1 / 3", tmp_path, "") == 1
    assert value_of("summary.json:a.b:count=1", tmp_path, "") == 1
    assert value_of("summary.json:a.b:at=1", tmp_path, "") == -4
    with pytest.raises(NoNumber, match="has 2 numbers"):
        value_of("summary.json:a.b:at=2", tmp_path, "")
    assert value_of("stdout:x", tmp_path, '{"x": 2.5}') == 2.5
    with pytest.raises(NoNumber, match="expected first, last"):
        value_of("summary.json:a.b:median", tmp_path, "")
