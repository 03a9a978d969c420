"""The real executables on a small scene in which particles break: both modes, any number of threads, killed and
resumed at every kind of place, give the same payloads."""
import json
import shutil
import signal
import subprocess
import time

import pytest

from conftest import REPOSITORY
from patience import patience
from rockbreak.run.child import executable
from rockbreak.run.ledger import read_ledger
from rockbreak.run.run_directory import RunDirectory, attributes

SCENE = REPOSITORY / "configs" / "demo.yaml"
SMALL = ["assembly.particles=120", "material.sigma_ci=80e6", "shear.axial_strain=0.02", "breakage.interval=0.002",
         "breakage.nodes=75"]


def command(out, *arguments):
    overrides = [word for override in SMALL for word in ("--set", override)]
    return [REPOSITORY / "pipeline" / "run", SCENE, "--out", out, "--no-report", *overrides, *arguments]


def run(out, *arguments):
    process = subprocess.run(command(out, *arguments), capture_output=True, text=True, check=False,
                             timeout=patience(300))
    assert process.returncode == 0, process.stderr[-3000:]
    return RunDirectory(out)


def kill_when(out, is_time):
    """Starts a run and kills the driver, without warning, as soon as `is_time`."""
    process = subprocess.Popen(command(out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not is_time():
        assert process.poll() is None, "the run ended before it could be killed"
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()


def payloads(directory):
    return {f"{file.parent.name}/{file.name}": attributes(file)["payload_hash"]
            for folder in ("frames", "splits") for file in sorted((directory.path / folder).glob("*.h5"))}


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    return run(tmp_path_factory.mktemp("coupled") / "reference", "--threads", "1")


@pytest.fixture(scope="module")
def summary(reference):
    return json.loads(reference.summary_file.read_text())


def cut_short(reference, out, newest, with_split):
    """A copy that holds frames up to `newest`, and its split or not: what a kill at that moment leaves."""
    shutil.copytree(reference.path, out)
    directory = RunDirectory(out)
    for k in reference.frame_numbers():
        if k > newest:
            directory.frame_file(k).unlink()
        if k > newest or (k == newest and not with_split):
            directory.split_file(k).unlink()
    return directory


def test_particles_break_and_nothing_is_lost(summary):
    assert summary["complete"] and summary["broken_total"] >= 10
    assert summary["particles_final"] > summary["particles_initial"] >= 60
    assert summary["solid_area_error"] <= 1e-12
    assert summary["momentum_error"] <= 1e-9


def test_both_programs_tell_where_their_time_went(reference, summary):
    """Phases are disjoint: none is negative, together they are no longer than the loop."""
    (end,) = [event for event in read_ledger(reference.ledger_file) if event["event"] == "end"]
    dem, xfem, wall = (end["phases"][name] for name in ("dem", "xfem", "wall"))
    assert set(dem) == {"preparation", "shear", "write", "apply", "exchange"} and min(dem.values()) > 0
    assert {"read", "screening", "analysis", "write", "total"} <= set(xfem) and min(xfem.values()) >= 0
    assert 0.5 * wall < sum(dem.values()) <= wall
    assert sum(xfem.values()) - xfem["total"] <= xfem["total"] <= dem["exchange"]
    assert 0 < summary["coupling_overhead"] < 0.5


def test_one_shot_processes_and_more_threads_give_the_same_payloads(reference, tmp_path):
    other = run(tmp_path / "oneshot", "--mode", "oneshot", "--threads", "2")
    assert payloads(other) == payloads(reference)


def test_killed_during_preparation(reference, tmp_path):
    out = tmp_path / "run"
    kill_when(out, lambda: any((out / "prepared").glob("*.h5")))
    assert not any((out / "frames").glob("*.h5"))
    assert payloads(run(out, "--resume")) == payloads(reference)


def test_killed_at_any_moment_of_the_shear_stage(reference, tmp_path):
    out = tmp_path / "run"
    kill_when(out, (out / "frames" / "000003.h5").exists)
    assert payloads(run(out, "--resume")) == payloads(reference)


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
@pytest.mark.parametrize("with_split", [False, True], ids=["before_a_split", "after_a_split"])
def test_resumed(reference, tmp_path, with_split, mode):
    directory = cut_short(reference, tmp_path / "run", len(reference.frame_numbers()) - 3, with_split)
    run(directory.path, "--resume", "--mode", mode)
    assert payloads(directory) == payloads(reference)


def test_a_saved_frame_analysed_alone_gives_the_same_split(reference, tmp_path):
    k = reference.frame_numbers()[-2]
    out = tmp_path / "split.h5"
    subprocess.run([executable("xfem"), "solve", reference.frame_file(k), "--config", reference.case_file,
                    "--previous", reference.split_file(k - 1), "--out", out], check=True, capture_output=True)
    assert attributes(out)["payload_hash"] == attributes(reference.split_file(k))["payload_hash"]


def test_a_scene_without_breakage_runs_through(tmp_path):
    directory = run(tmp_path / "run", "--set", "effects=[friction, local_damping, energy_ledger]", "--set",
                    "shear.frame_interval=0.01")
    assert len(directory.frame_numbers()) == 3 and directory.split_numbers() == []


def test_a_misspelt_key_is_bad_input(tmp_path):
    process = subprocess.run(command(tmp_path / "run", "--set", "contact.fricton=0.4"), capture_output=True, text=True,
                             check=False)
    assert process.returncode == 2 and "friction" in process.stderr and "Traceback" not in process.stderr
    assert "run.jsonl" in [file.name for file in (tmp_path / "run").iterdir()]
    assert RunDirectory(tmp_path / "run").is_empty(), "the corrected command starts without --resume"
