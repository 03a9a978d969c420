"""Results are what they were: for one and two threads, in both modes, and those of the laboratory tests."""
import json
import os
import re
import subprocess
import sys

import pytest

from conftest import REPOSITORY

sys.path.insert(0, str(REPOSITORY / "tests" / "robustness" / "golden"))
import golden  # noqa: E402
from rockbreak.run.child import binaries, executable  # noqa: E402


@pytest.fixture(scope="module")
def expected():
    return json.loads(golden.GOLDEN.read_text())


@pytest.mark.parametrize("mode, threads", [("resident", 1), ("resident", 2), ("oneshot", 1)])
def test_a_coupled_run_gives_the_golden_hashes(expected, tmp_path, mode, threads):
    assert golden.differences(golden.coupled(binaries(), tmp_path, mode, threads), expected["coupled"]) == []


@pytest.mark.parametrize("name", [path.stem for path in golden.laboratory_tests()])
def test_a_laboratory_test_gives_the_golden_hashes(expected, tmp_path, name):
    found = golden.laboratory(binaries(), tmp_path, golden.LABORATORY / f"{name}.yaml")
    assert expected["lab"][name] and golden.differences(found, expected["lab"][name]) == []


@pytest.mark.parametrize("name", ["dem", "xfem"])
def test_the_compiler_fuses_no_products_with_alternating_sums(name):
    """gcc 12 does so in spite of -ffp-contract=off; debug and release then disagree."""
    code = subprocess.run(["objdump", "-d", "--no-show-raw-insn", executable(name)], capture_output=True, text=True,
                          check=True)
    assert re.findall(r"\bvfm(?:addsub|subadd)\w+", code.stdout) == []


def test_another_result_is_told_by_its_dataset_another_key_is_none(expected):
    found = json.loads(json.dumps(expected))
    found["coupled"]["frames"]["history/new_column"] = "0"
    assert golden.differences(found, expected) == []
    found["coupled"]["frames"]["particles/position"] = "0"
    del found["coupled"]["splits"]["broken/parent"]
    assert golden.differences(found, expected) == ["coupled/frames/particles/position", "coupled/splits/broken/parent"]


def test_the_executables_of_a_relative_folder_are_found_from_elsewhere(monkeypatch):
    monkeypatch.setenv("ROCKBREAK_BIN", os.path.relpath(binaries()))
    assert executable("xfem").startswith("/"), "xfem is started in another folder"
