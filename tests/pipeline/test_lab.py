"""pipeline/lab with the real `xfem lab` on coarse meshes: what a sweep becomes, the table, failures, interruption."""
import csv
import json
import os
import signal
import subprocess
import time

import pytest

from conftest import REPOSITORY
from patience import patience
from rockbreak.lab import table as lab_table
from rockbreak.errors import RockbreakError
from rockbreak.lab.table import table_rows, text_table
from rockbreak.lab.tests import LabRun, plan_tests

BLOCK = "test: confined\nspecimen: {width: 0.25, height: 0.5}\nmesh: {nodes: 75}\nloading: {largest: 1}\n"


def write(folder, name, text):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text)
    return folder / name


def start(*arguments, **options):
    return subprocess.Popen([REPOSITORY / "pipeline" / "lab", *arguments], stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE, text=True, **options)


def run(*arguments, **options):
    process = start(*arguments, **options)
    process.out, process.err = process.communicate(timeout=patience(120))
    return process


def rows_of(out):
    with open(out / "lab.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


# -- planning

def test_a_sweep_becomes_all_combinations_and_an_overridden_key_none(tmp_path):
    file = write(tmp_path, "c.yaml",
                 BLOCK + "sweep: {loading.confining_stress: [0.0, 4.0e+6], mesh.nodes: [75, 150]}\n")
    runs = plan_tests([file], tmp_path / "out", [])
    assert [run.name for run in runs] == [f"c confining_stress-{s} nodes-{n}" for s in ("0.0", "4.0e+6")
                                          for n in (75, 150)]
    assert runs[3].keys == (("loading.confining_stress", "4.0e+6"), ("mesh.nodes", "150"))
    assert runs[3].out == tmp_path / "out" / "c" / "confining_stress-4.0e+6_nodes-150"
    fixed = plan_tests([file], tmp_path / "out", ["mesh.nodes=300"])
    assert [run.name for run in fixed] == ["c confining_stress-0.0", "c confining_stress-4.0e+6"]


def test_a_swept_rock_is_sought_from_the_tests_folder_and_labels_may_set_several_keys(tmp_path):
    write(tmp_path / "rocks", "soft.yaml", "sigma_ci: 50e6\n")
    file = write(tmp_path / "lab", "c.yaml", BLOCK + "sweep:\n  material.rock: [../rocks/soft.yaml]\n"
                 "  size: {small: {specimen.width: 0.1, specimen.height: 0.2}}\n")
    (run,) = plan_tests([file], tmp_path / "out", [])
    assert run.name == "c rock-soft size-small"
    assert dict(run.keys) == {"material.rock": str(tmp_path / "rocks" / "soft.yaml"), "specimen.width": "0.1",
                              "specimen.height": "0.2"}


@pytest.mark.parametrize("make, message", [
    (lambda path: [path / "none.yaml"], "no such file or folder"),
    (lambda path: [path], r"found no \*.yaml"),
    (lambda path: [write(path, "a.yaml", "seed: 1\n")], "test: found nothing"),
    (lambda path: [write(path, "a.yaml", "test: tension\nsweep: {mesh.nodes: 75}\n")], "expected a list of values"),
    (lambda path: [write(path / "one", "a.yaml", BLOCK), write(path / "two", "a.yaml", BLOCK)], "same directory"),
])
def test_what_cannot_be_planned_is_refused_with_its_place(tmp_path, make, message):
    with pytest.raises(RockbreakError, match=message) as error:
        plan_tests(make(tmp_path), tmp_path / "out", [])
    assert error.value.code == 2


# -- the table

def lab_run(tmp_path, nodes, first, analytical=None, estimate=None):
    summary = {"test": "point_load", "status": "broken", "rock": {"name": "x"}, "mesh": {"nodes": nodes},
               "analytical": analytical, "reference": estimate, "first_failure_load": first, "breakage_load": 2 * first,
               "failure_mode": "tension", "fracture_angle_deg": 1.0, "initiation_angle_deg": 1.0, "fragments": [{}, {}],
               "growth_steps": 3, "seconds": 0.1}
    return LabRun(f"p nodes-{nodes}", tmp_path / "p.yaml", (("mesh.nodes", str(nodes)),), (), tmp_path, summary=summary)


def test_the_reference_is_theory_else_the_finest_mesh_else_an_estimate(tmp_path):
    theory = {"breakage_load": 100.0, "fracture_angle_deg": 15.0}
    (row,) = table_rows([lab_run(tmp_path, 75, 110.0, theory)])
    assert (row["reference"], row["reference_angle_deg"]) == ("theory", 15.0)
    assert row["error_first_failure"] == pytest.approx(0.1) and row["error_breakage"] == pytest.approx(1.2)
    coarse, fine = table_rows([lab_run(tmp_path, 75, 120.0), lab_run(tmp_path, 300, 100.0)])
    assert (coarse["reference"], fine["reference"]) == ("finest mesh", "finest mesh")
    assert coarse["error_first_failure"] == pytest.approx(0.2) and fine["error_first_failure"] == 0
    (alone,) = table_rows([lab_run(tmp_path, 75, 120.0, estimate={"breakage_load": 60.0})])
    assert alone["reference"] == "estimate" and alone["error_first_failure"] == pytest.approx(1.0)
    assert "+100.00 %" in text_table([alone])


# -- with xfem

def test_one_table_a_figure_per_test_and_a_failure_that_stops_no_other(tmp_path):
    tests = tmp_path / "tests"
    write(tests, "confined.yaml", BLOCK + "sweep: {loading.confining_stress: [0.0, 30.0e+6]}\n")
    write(tests, "broken.yaml", "test: tension\nspecimen: {widht: 0.1}\n")
    write(tests, "rockless.yaml", "test: tension\nmaterial: {rock: nowhere.yaml}\n")
    write(tests, "tension.yaml", "test: tension\nmesh: {nodes: 75}\nloading: {largest: 1}\n")
    out = tmp_path / "out"
    process = run(tests, "--out", out, "-j", "2")
    assert process.returncode == 2
    assert "2 of 5 tests failed" in process.err
    assert 'unknown key "widht" in specimen; did you mean "width"?' in process.err
    assert "nowhere.yaml: the file does not exist" in process.err
    rows = {row["test"]: row for row in rows_of(out)}
    assert rows["broken"]["status"] == "failed" and rows["broken"]["exit_code"] == "2"
    for name, strength in (("confined confining_stress-0.0", 150e6), ("confined confining_stress-30.0e+6", 397.42e6)):
        assert float(rows[name]["first_failure_load"]) == pytest.approx(0.25 * strength, rel=1e-5)
        assert abs(float(rows[name]["error_first_failure"])) < 1e-9
        assert rows[name]["failure_mode"] == "shear"
    assert rows["tension"]["failure_mode"] == "tension"
    for folder in ("tension", "confined/confining_stress-0.0"):
        files = {entry.name for entry in (out / folder).iterdir()}
        assert files >= {"summary.json", "result.h5", "specimen.svg", "case.yaml"}
    page = (out / "lab.html").read_text()
    assert page.count("data:image/svg+xml") == 3 and "http://" not in page.replace("http://www.w3.org", "")
    assert process.out.splitlines()[-1] == str(out / "lab.html")
    assert len(process.out.splitlines()) == 1 + 5 + 1  # head, a row per test, the page


def test_a_rock_for_all_tests_and_the_directory_of_an_earlier_call(tmp_path):
    file = write(tmp_path, "t.yaml", "test: tension\nmesh: {nodes: 75}\nloading: {largest: 1}\n")
    out = tmp_path / "out"
    rock = REPOSITORY / "configs" / "rocks" / "granite.yaml"
    assert run(file, "--out", out, "--set", f"material.rock={rock}").returncode == 0
    summary = json.loads((out / "t" / "summary.json").read_text())
    assert summary["rock"]["name"] == "granite" and summary["rock"]["m_i"] == 32
    assert run(file, "--out", out).returncode == 0  # again: replaced
    assert json.loads((out / "t" / "summary.json").read_text())["rock"]["m_i"] == 25
    other = tmp_path / "other"
    write(other, "note.txt", "mine")
    refused = run(file, "--out", other)
    assert refused.returncode == 2 and "directory of something else" in refused.err


def test_an_interruption_leaves_what_was_finished_with_its_table(tmp_path):
    """The second test hangs: a fake xfem that sleeps on it."""
    real = os.environ.get("ROCKBREAK_BIN") or REPOSITORY / "build" / "release"
    fake = write(tmp_path / "bin", "xfem",
                 f'#!/bin/sh\ncase "$2" in *slow.yaml) sleep 60;; esac\nexec {real}/xfem "$@"\n')
    fake.chmod(0o755)
    write(tmp_path / "tests", "fast.yaml", BLOCK)
    write(tmp_path / "tests", "slow.yaml", BLOCK)
    out = tmp_path / "out"
    process = start(tmp_path / "tests", "--out", out, env={**os.environ, "ROCKBREAK_BIN": str(tmp_path / "bin")})
    deadline = time.monotonic() + patience(60)
    while not (out / "fast" / "summary.json").exists() or '"slow", "state": "running"' not in read(out, process):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=patience(60))
    assert process.returncode == 130
    assert [row["status"] for row in rows_of(out)] == ["broken", "not run"]
    assert (out / "lab.html").exists()


def read(out, process):
    """What the driver said so far, without waiting for more."""
    os.set_blocking(process.stderr.fileno(), False)
    said = getattr(process, "said", "") + (process.stderr.buffer.read() or b"").decode()
    process.said = said
    return said


def test_an_error_that_rounds_to_nothing_has_no_sign():
    assert [lab_table.percent(share) for share in (-1e-13, 0.0, 1e-13, -0.0123, 0.5, None)] == \
        ["0.00 %", "0.00 %", "0.00 %", "-1.23 %", "+50.00 %", "–"]
