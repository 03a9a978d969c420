"""run.xdmf: what Debian's ParaView makes of it, value by value, against numpy's reading of the frames."""
import json
import os
import shutil
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
import yaml

import fake_children
from conftest import REPOSITORY
from patience import patience
from rockbreak.run import xdmf
from rockbreak.run.run_directory import RunDirectory
from rockbreak.run.xdmf import write_xdmf
from synthetic import CASE, edited, write_run

HERE = Path(__file__).resolve().parent
needs_paraview = pytest.mark.skipif(not shutil.which("pvpython"), reason="needs pvpython: apt-get install paraview "
                                    "python3-paraview (pipeline/setup --with-tests)")
READERS = ("XDMF Reader", "Xdmf3 Reader S", "Xdmf3 Reader T", "by itself")


def paraview(file, cwd):
    """What ParaView sees, started elsewhere than in the run directory."""
    process = subprocess.run(["pvpython", HERE / "paraview_dump.py", file], cwd=cwd, capture_output=True, text=True,
                             timeout=patience(120))
    assert process.returncode == 0, process.stderr
    return json.loads(process.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def breakable(tmp_path_factory):
    """A run of five frames that breaks particles, its folder with a blank in its name, and what ParaView sees of it."""
    path = write_run(tmp_path_factory.mktemp("paraview") / "a run", frames=5, breaks=lambda k: (0, 1, 3, 2, 1)[k])
    write_xdmf(RunDirectory(path))
    return path, paraview(path / "run.xdmf", path.parent) if shutil.which("pvpython") else None


def frames_of(path):
    return [h5py.File(file, "r") for file in sorted((path / "frames").glob("*.h5"))]


def world_outline(frame, i):
    """Corners of particle i, by complex numbers."""
    first, last = frame["particles/vertex_offset"][i:i + 2]
    corners = frame["particles/vertices"][first:last] @ [1, 1j]
    place = frame["particles/position"][i] @ [1, 1j] + np.exp(1j * frame["particles/angle"][i]) * corners
    return np.column_stack([place.real, place.imag])


@needs_paraview
@pytest.mark.parametrize("reader", READERS)
def test_the_times_in_paraview_are_those_of_the_frames(breakable, reader):
    path, seen = breakable
    times = [frame.attrs["time"] for frame in frames_of(path)]
    assert seen[reader]["times"] == pytest.approx(times, abs=1e-12) and len(set(times)) == 5


@needs_paraview
def test_blocks_keep_their_names_over_time_so_that_one_can_be_picked(breakable):
    """Of the readers of ParaView 5.11 the XDMF Reader alone tells names; two others put everything into one block."""
    assert breakable[1]["XDMF Reader"]["names"] == [["particles", "contacts", "force_chains"]] * 5
    assert [len(names) for names in breakable[1]["Xdmf3 Reader T"]["names"]] == [3] * 5


@needs_paraview
@pytest.mark.parametrize("reader", READERS)
def test_every_frame_shows_its_own_particles_where_they_are(breakable, reader):
    path, seen = breakable
    counts = []
    for frame, step in zip(frames_of(path), seen[reader]["steps"]):
        polygons = step[0]
        assert polygons["types"] == ["vtkPolygon"]
        counts.append(len(polygons["cells"]))
        assert counts[-1] == len(frame["particles/id"])
        for i, corners in enumerate(polygons["cells"]):
            assert np.allclose(corners, world_outline(frame, i), rtol=0, atol=1e-6)
    assert counts == [48, 48, 49, 52, 54]


@needs_paraview
@pytest.mark.parametrize("reader", READERS)
def test_particles_carry_what_the_frame_and_its_split_say_of_them(breakable, reader):
    path, seen = breakable
    for k, (frame, step) in enumerate(zip(frames_of(path), seen[reader]["steps"])):
        arrays = {name: np.array(values) for name, values in step[0]["arrays"].items()}
        for name in ("id", "root", "generation", "boundary", "area"):
            assert np.array_equal(arrays[name][:, 0], frame[f"particles/{name}"][:]), name
        assert np.allclose(arrays["displacement"][:, :2], frame["particles/displacement"][:], rtol=1e-6, atol=0)
        assert not arrays["displacement"][:, 2].any()
        with h5py.File(path / "splits" / f"{k:06d}.h5") as split:
            stress = split["particles/mean_stress"][:]
            assert np.array_equal(arrays["status"][:, 0], split["particles/status"][:])
        for i, name in enumerate(("xx", "yy", "xy")):
            assert np.allclose(arrays[f"stress_{name}"][:, 0], stress[:, i], rtol=1e-6, atol=0)


@needs_paraview
@pytest.mark.parametrize("reader", READERS)
def test_contacts_are_points_and_lines_between_centroids_with_their_forces(breakable, reader):
    path, seen = breakable
    for frame, step in zip(frames_of(path), seen[reader]["steps"]):
        points, lines = step[1:]
        contacts, particles = frame["contacts"], frame["particles"]
        assert points["types"] in (["vtkVertex"], ["vtkPolyVertex"])
        assert np.allclose(np.array(points["cells"])[:, 0], contacts["point"][:], rtol=0, atol=1e-12)
        where = {particle: place for particle, place in zip(particles["id"][:], particles["position"][:])}
        ends = np.array([[where[a], where[b]] for a, b in zip(contacts["a"][:], contacts["b"][:])])
        assert np.allclose(lines["cells"], ends, rtol=0, atol=1e-12)
        for grid in (points, lines):
            arrays = {name: np.array(values) for name, values in grid["arrays"].items()}
            assert np.array_equal(arrays["normal_force"][:, 0], contacts["normal_force"][:])
            assert np.array_equal(arrays["shear_force"][:, 0], contacts["shear_force"][:])
            assert np.allclose(arrays["force"][:, :2], contacts["force"][:], rtol=1e-6, atol=0)


@needs_paraview
def test_without_breakage_stress_is_that_of_the_contact_forces_and_no_contacts_are_no_trouble(tmp_path):
    """By hand: two forces of 1 MN press on particle 1 from either side, 0.2 m from its centroid: 0.4 MN m / area."""
    path = write_run(tmp_path / "run", frames=2, breakable=False)
    with edited(path / "frames" / "000000.h5") as frame:
        for name in list(frame["contacts"]):
            width = frame["contacts"][name].shape[1:]
            kind = frame["contacts"][name].dtype
            del frame["contacts"][name]
            frame["contacts"].create_dataset(name, data=np.zeros((0, *width), dtype=kind))
    with edited(path / "frames" / "000001.h5") as frame:
        position, area = frame["particles/position"][1], frame["particles/area"][1]
        hand = {"a": [0, 1], "b": [1, 2], "point": [position - [0.2, 0], position + [0.2, 0]],
                "force": [[1e6, 0.0], [1e6, 0.0]], "normal_force": [1e6, 1e6], "shear_force": [0.0, 0.0]}
        for name, values in hand.items():
            kind = frame["contacts"][name].dtype
            del frame["contacts"][name]
            frame["contacts"][name] = np.array(values, dtype=kind)
    write_xdmf(RunDirectory(path))
    for name, seen in paraview(path / "run.xdmf", tmp_path).items():
        empty, loaded = seen["steps"]
        assert len(empty[0]["cells"]) == 48 and not any(one["cells"] for one in empty[1:]), name
        assert not np.any(empty[0]["arrays"]["stress_xx"]), name
        assert loaded[0]["arrays"]["stress_xx"][1][0] == pytest.approx(0.4e6 / area, rel=1e-6), name
        assert loaded[0]["arrays"]["stress_yy"][1][0] == 0 and "status" not in loaded[0]["arrays"], name


def test_only_what_is_new_is_written_again(tmp_path, monkeypatch):
    path = write_run(tmp_path / "run", frames=4)
    directory = RunDirectory(path)
    write_xdmf(directory)
    before = {file.name: file.read_bytes() for file in (path / "paraview").iterdir()}
    assert sorted(before) == [f"{k:06d}.h5" for k in range(4)]
    made = []
    monkeypatch.setattr(xdmf, "arrays_of", lambda *of: made.append(of[0].attrs["frame"]) or real(*of))
    write_xdmf(directory)
    assert made == []
    with edited(path / "frames" / "000002.h5") as frame:
        frame["particles/angle"][5] = 0.1
    (path / "paraview" / "000001.h5").write_bytes(b"damaged")
    (path / "frames" / "000003.h5").unlink()
    write_xdmf(directory)
    assert made == [1, 2] and not (path / "paraview" / "000003.h5").exists()
    after = {file.name: file.read_bytes() for file in (path / "paraview").iterdir()}
    assert after["000000.h5"] == before["000000.h5"] and after["000001.h5"] == before["000001.h5"]
    assert after["000002.h5"] != before["000002.h5"]
    assert "frames/000003.h5" not in (path / "run.xdmf").read_text()


real = xdmf.arrays_of


def test_a_run_and_a_report_write_it_and_without_a_report_nobody_does(tmp_path):
    fake_children.install(tmp_path / "bin")
    scene = tmp_path / "scene.yaml"
    scene.write_text(yaml.safe_dump({**CASE, "shear": {**CASE["shear"], "frames": 3}}))
    out = tmp_path / "run"

    def call(*command):
        subprocess.run([REPOSITORY / "pipeline" / command[0], *command[1:]], check=True, capture_output=True,
                       timeout=patience(120),
                       env={**os.environ, "ROCKBREAK_BIN": str(tmp_path / "bin"), "FAKE_LOG": str(tmp_path / "log")})

    call("run", scene, "--out", out, "--no-report")
    assert not (out / "run.xdmf").exists() and not (out / "paraview").exists()
    call("run", scene, "--out", out, "--resume")
    first = (out / "run.xdmf").read_text()
    assert [f"frames/{k:06d}.h5:/particles/id" in first for k in range(4)] == [True, True, True, False]
    (out / "run.xdmf").unlink()
    call("report", out)
    assert (out / "run.xdmf").read_text() == first
