"""The real executables on slabs 1:170, whose fragments no mesh can stand for: the coupled run stops and says where,
what it leaves is refused alone, and it goes on when told to."""
import json
import subprocess

import h5py

from conftest import REPOSITORY
from patience import patience
from rockbreak.run.child import executable
from rockbreak.run.ledger import read_ledger
from rockbreak.run.run_directory import RunDirectory, refusals_in

SLAB = "[[0,0],[1,0],[1,0.006],[0,0.006]]"
STONE = "[[1,0],[0.309,0.951],[-0.809,0.588],[-0.809,-0.588],[0.309,-0.951]]"
SCENE = ["effects=[friction,local_damping,energy_ledger,breakage]", "breakage.nodes=75", "breakage.minimum_area=1e-7",
         "material.sigma_ci=900e6", f"assembly.shapes=[{SLAB},{STONE}]", "shear.axial_strain=0.001",
         "guards.overlap=2"]  # slabs thinner than the contacts of stones are deep


def run(out, *overrides):
    words = [word for override in (*SCENE, *overrides) for word in ("--set", override)]
    return subprocess.run([REPOSITORY / "pipeline" / "run", REPOSITORY / "tests/robustness/scenes/slivers.yaml",
                           "--out", out, "--no-report", "--resume", *words],
                          capture_output=True, text=True, check=False, timeout=patience(300))


def test_a_refused_particle_stops_the_coupled_run_until_told_otherwise(tmp_path):
    directory = RunDirectory(tmp_path / "run")
    first = run(directory.path)
    assert first.returncode == 3, first.stderr[-3000:]
    frame = directory.newest_valid_frame()
    refused = refusals_in(directory.split_file(frame))
    particle, reason = refused[0]
    errors = [line for line in first.stderr.splitlines() if line.startswith("dem: error:")]
    assert len(errors) == 1 and f"frame {frame} was refused for particle {particle}: {reason}" in errors[0]
    file = directory.path / "failure" / f"frame_{frame:06d}_particle_{particle}.h5"
    assert str(file) in first.stderr and errors[0].removeprefix("dem: error: ") in read_ledger(
        directory.ledger_file)[-1]["reason"]

    alone = tmp_path / "alone.h5"
    solved = subprocess.run([executable("xfem"), "solve", file, "--config", directory.case_file, "--out", alone],
                            capture_output=True, text=True, check=False)
    assert solved.returncode == 0 and reason in solved.stderr
    assert refusals_in(alone) == [(particle, reason)]
    with h5py.File(file, "r") as content:
        assert len(content["particles/id"]) < 20

    again = run(directory.path)
    assert again.returncode == 3 and errors[0] in again.stderr
    on = run(directory.path, "guards.refusals=continue")
    assert on.returncode == 0, on.stderr[-3000:]
    summary = json.loads(directory.summary_file.read_text())
    assert summary["complete"] and summary["refused_total"] >= len(refused)
    assert file.exists() and not (directory.path / "failure" / "failure.json").exists()
    warnings = [event for event in read_ledger(directory.ledger_file) if event["event"] == "warning"]
    assert any(event.get("particle") == particle and reason in event["text"] for event in warnings)
