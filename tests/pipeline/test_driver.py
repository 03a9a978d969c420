"""The driver's protocol, with children that only pretend: who is called in which order, in both modes, after every
kind of end. What the real executables compute is the business of test_coupled.py."""
import fcntl
import json
import os
import signal
import subprocess
import time

import pytest
import yaml

import fake_children
from conftest import REPOSITORY
from patience import patience
from rockbreak.campaign.cases import explained
from rockbreak.errors import RockbreakError
from rockbreak.run.ledger import read_ledger
from rockbreak.run.payload_hash import xxh3_128
from rockbreak.run.run_directory import RunDirectory, attributes
from synthetic import CASE


@pytest.fixture
def work(tmp_path):
    return Workplace(tmp_path)


class Workplace:
    """A folder with fake executables, a scene, and a blank in the name of the run directory."""

    def __init__(self, path):
        self.path = path
        self.out = path / "a run"
        self.directory = RunDirectory(self.out)
        fake_children.install(path / "bin")
        self.log_file = path / "calls.log"

    def scene(self, frames=4, breakable=True, **fake):
        case = {**CASE, "shear": {**CASE["shear"], "frames": frames}, "fake": fake}
        if not breakable:
            case["effects"] = [effect for effect in case["effects"] if effect != "breakage"]
        (self.path / "scene.yaml").write_text(yaml.safe_dump(case))

    def start(self, *arguments):
        environment = {**os.environ, "ROCKBREAK_BIN": str(self.path / "bin"), "FAKE_LOG": str(self.log_file)}
        return subprocess.Popen([REPOSITORY / "pipeline" / "run", self.path / "scene.yaml", "--out", self.out,
                                 "--no-report", *arguments], env=environment, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def run(self, *arguments):
        process = self.start(*arguments)
        process.out, process.err = process.communicate(timeout=patience(60))
        return process

    def calls(self):
        lines = self.log_file.read_text().splitlines()
        self.log_file.unlink()
        return lines

    def events(self, kind):
        return [event for event in read_ledger(self.directory.ledger_file) if event["event"] == kind]

    def payloads(self):
        return {f"{file.parent.name}/{file.name}": attributes(file)["payload_hash"]
                for folder in ("frames", "splits") for file in sorted((self.out / folder).glob("*.h5"))}


def test_resident_mode_calls_in_the_order_of_the_protocol(work):
    work.scene(frames=3)
    assert work.run().returncode == 0
    assert work.calls() == [
        "dem --resume --serve",
        "xfem serve", "xfem < solve 000000 -", "dem < resume splits/000000.h5",
        "xfem < solve 000001 000000", "dem < resume splits/000001.h5",
        "xfem < solve 000002 000001", "dem < resume -"]


def test_oneshot_mode_starts_one_process_per_frame_and_split(work):
    work.scene(frames=3)
    assert work.run("--mode", "oneshot", "--threads", "2").returncode == 0
    assert work.calls() == [
        "dem --resume --threads --until-frame 0", "xfem solve 000000 -",
        "dem --resume --threads --until-frame 1", "xfem solve 000001 000000",
        "dem --resume --threads --until-frame 2", "xfem solve 000002 000001"]


def test_both_modes_leave_the_same_files_and_events(work):
    work.scene()
    assert work.run().returncode == 0
    resident = work.payloads()
    events = [(e["event"], e["payload_hash"]) for e in work.events("frame") + work.events("split")]
    work.out = work.path / "other"
    work.directory = RunDirectory(work.out)
    assert work.run("--mode", "oneshot").returncode == 0
    assert work.payloads() == resident and len(resident) == 8
    assert events == [(e["event"], e["payload_hash"]) for e in work.events("frame") + work.events("split")]


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
def test_a_scene_without_breakage_never_starts_xfem(work, mode):
    work.scene(breakable=False)
    assert work.run("--mode", mode).returncode == 0
    assert not any("xfem" in call for call in work.calls())
    assert not (work.out / "splits").exists()
    assert len(work.events("frame")) == 4


@pytest.mark.parametrize("mode, times", [("resident", 1), ("oneshot", 4)])
def test_what_the_programs_measured_is_summed_in_the_ledger_and_the_summary(work, mode, times):
    """The fakes claim 0.75 s of work of dem and 0.125 s of xfem per process, whatever they took."""
    work.scene()
    assert work.run("--mode", mode).returncode == 0
    (end,) = work.events("end")
    phases = end["phases"]
    assert phases["dem"]["shear"] == times * 0.5 and phases["xfem"]["analysis"] == times * 0.125
    assert 0 < phases["wall"] < 60
    summary = json.loads(work.directory.summary_file.read_text())
    assert summary["coupling_overhead"] == pytest.approx(1 - times * 0.875 / phases["wall"], abs=1e-4)


def test_the_ledger_of_a_frame_is_written_before_its_split_stands_and_of_a_split_before_the_next_frame(work):
    work.scene(xfem_error_at=2)
    assert work.run().returncode == 3
    assert [(e["event"], e["frame"]) for e in read_ledger(work.directory.ledger_file) if e["event"] in (
        "frame", "split")] == [("frame", 0), ("split", 0), ("frame", 1), ("split", 1), ("frame", 2)]


def test_stdout_names_the_result_alone_and_stderr_is_json_lines(work):
    work.scene()
    process = work.run()
    assert process.out == f"{work.directory.summary_file}\n"
    events = [json.loads(line) for line in process.err.splitlines()]
    frames = [event for event in events if event["event"] == "frame"]
    assert [event["broken"] for event in frames] == [0, 1, 2, 3]
    assert {"axial_strain", "contacts", "particles", "target_strain", "seconds_left"} <= set(frames[0])
    assert any(event.get("source") == "dem" and event["event"] == "progress" for event in events)


def test_the_final_split_is_counted_but_not_applied(work):
    work.scene(frames=4)
    work.run()
    summary = json.loads(work.directory.summary_file.read_text())
    assert (summary["particles_initial"], summary["particles_final"], summary["broken_total"]) == (48, 51, 4)


def test_refusals_become_warnings_of_the_ledger(work):
    work.scene()
    work.run()
    (warning,) = work.events("warning")
    assert warning["source"] == "xfem" and warning["particle"] == 5 and "the mesh is too coarse" in warning["text"]


def test_refusals_are_counted(work):
    work.scene()
    work.run()
    assert json.loads(work.directory.summary_file.read_text())["refused_total"] == 1


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
@pytest.mark.parametrize("fake, reason", [({"dem_dies_at": 2}, "dem: error: particle 7, frame 3: flew off"),
                                          ({"xfem_error_at": 2}, "particle 3: singular matrix")])
def test_a_childs_failure_comes_through_with_code_and_reason(work, mode, fake, reason):
    work.scene(**fake)
    process = work.run("--mode", mode)
    assert process.returncode == 3 and reason in process.err
    (end,) = work.events("end")
    assert end["code"] == 3 and reason in end["reason"]


def test_the_ledger_states_size_and_hashes_of_every_file(work):
    work.scene()
    work.run()
    for event in work.events("frame") + work.events("split"):
        file = work.out / event["path"]
        assert event["bytes"] == file.stat().st_size
        assert event["payload_hash"] == attributes(file)["payload_hash"]
        assert event["file_hash"] == xxh3_128(file.read_bytes())


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
@pytest.mark.parametrize("lost, first_solve", [("splits/000002.h5", "000002"), ("frames/000002.h5", "000002"),
                                               ("frames/000001.h5", "000003"), (None, "000003")])
def test_resume_goes_on_from_the_newest_frame_whatever_is_missing(work, mode, lost, first_solve):
    """Lost: the newest split; the newest frame, whose split must not be believed; a frame in between, which is made
    anew; nothing."""
    work.scene(frames=5)
    work.run()
    whole = work.payloads()
    for k in (3, 4):
        work.directory.frame_file(k).unlink()
        work.directory.split_file(k).unlink()
    if lost:
        (work.out / lost).unlink()
    work.calls()
    assert work.run("--mode", mode, "--resume").returncode == 0
    assert work.payloads() == whole
    solves = [call for call in work.calls() if "solve" in call]
    assert first_solve in solves[0]


def test_resume_does_not_believe_damaged_files(work):
    work.scene(frames=5)
    work.run()
    whole = work.payloads()
    for k in (3, 4):
        work.directory.split_file(k).unlink()
    newest = work.directory.frame_file(4)
    newest.write_bytes(newest.read_bytes()[:2000])
    split = work.directory.split_file(2)
    split.write_bytes(split.read_bytes()[:2000])
    (work.out / "frames" / "000009.h5.tmp").write_text("half")
    assert work.run("--resume").returncode == 0
    assert work.payloads() == whole
    assert not (work.out / "frames" / "000009.h5.tmp").exists()


@pytest.mark.parametrize("damage", [lambda content: b"", lambda content: bytes(len(content)),
                                    lambda content: content[:200]], ids=["empty", "zeros", "cut"])
def test_resume_makes_anew_what_lies_between_whole_files(work, damage):
    work.scene(frames=5)
    work.run()
    whole = work.payloads()
    for file in (work.directory.frame_file(0), work.directory.frame_file(1), work.directory.split_file(2),
                 work.directory.case_file):
        file.write_bytes(damage(file.read_bytes()))
    known = len(work.events("frame")), len(work.events("split"))
    process = work.run("--resume")
    assert process.returncode == 0, process.err
    assert work.payloads() == whole
    assert (len(work.events("frame")), len(work.events("split"))) == (known[0] + 2, known[1] + 1)
    assert [event["text"] for event in work.events("warning") if "made anew" in event["text"]] == [
        f"frames/{k:06d}.h5 is lost or damaged; it is made anew" for k in (0, 1)]
    assert not work.directory.restoring.exists()


@pytest.mark.parametrize("kind, k", [("frame", 1), ("split", 2)])
def test_what_another_program_makes_anew_otherwise_is_refused(work, kind, k):
    work.scene(frames=5)
    work.run()
    lost = work.out / f"{kind}s" / f"{k:06d}.h5"
    lost.unlink()
    ledger = work.directory.ledger_file.read_text()
    payload = next(event["payload_hash"] for event in work.events(kind) if event["frame"] == k)
    work.directory.ledger_file.write_text(ledger.replace(payload, "0" * 32))
    process = work.run("--resume")
    assert process.returncode == 2 and f"{kind}s/{k:06d}.h5 is lost" in process.err and "nother version" in process.err
    assert not lost.exists() and not work.directory.restoring.exists()


def test_the_ledger_goes_on_where_a_machine_left_zeros(work):
    work.scene(frames=5)
    work.run()
    work.directory.frame_file(4).unlink()
    content = work.directory.ledger_file.read_bytes()
    cut = content.index(b'"frame": 3') + 3
    work.directory.ledger_file.write_bytes(content[:cut] + bytes(5000) + content[cut + 300:])
    assert work.run("--resume").returncode == 0
    assert [event["frame"] for event in work.events("frame")] == [0, 1, 2, 3, 4]
    assert [event["frame"] for event in work.events("split")] == [0, 1, 2, 3, 4]


def test_resume_of_a_finished_run_ends_at_once(work):
    work.scene()
    work.run()
    work.calls()
    process = work.run("--resume")
    assert process.returncode == 0 and process.out == f"{work.directory.summary_file}\n"
    assert not work.log_file.exists()


def test_resume_with_another_scene_is_remarked_upon(work):
    work.scene()
    work.run()
    work.directory.frame_file(3).unlink()
    assert work.run("--resume", "--set", "seed=2").returncode == 0
    assert "stays in force" in work.events("warning")[-1]["text"]


def test_resume_without_a_frame_starts_anew(work):
    work.scene()
    assert work.run("--resume").returncode == 0
    assert len(work.events("frame")) == 4


def test_a_directory_in_use_is_refused_without_resume(work):
    work.scene()
    work.out.mkdir()
    (work.out / "notes.txt").write_text("mine")
    process = work.run()
    assert process.returncode == 2 and "--resume" in process.err


def test_a_locked_directory_is_refused(work):
    work.scene()
    work.out.mkdir()
    with open(work.out / ".lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        process = work.run()
    assert process.returncode == 2 and "another pipeline/run" in process.err


def test_a_second_driver_is_refused_and_the_first_goes_on_undisturbed(work):
    work.scene(frames=40, slow=0.02)
    first = work.start()
    wait_for(work.directory.split_file(0))
    second = work.run("--resume")
    assert second.returncode == 2 and "another pipeline/run" in second.err
    _, err = first.communicate(timeout=patience(60))
    assert first.returncode == 0, err
    assert len(work.events("frame")) == 40 and len(work.events("start")) == 1


@pytest.mark.parametrize("left", ["", "4194303\n"], ids=["empty", "with_a_number"])
def test_a_stale_lock_holds_nobody_up(work, left):
    """Of a driver that was killed, or of a copy of its directory: the file is there, nobody holds it."""
    work.scene()
    work.out.mkdir()
    (work.out / ".lock").write_text(left)
    assert work.run().returncode == 0
    assert len(work.events("frame")) == 4


@pytest.mark.parametrize("ending, code", [("exit 4", 4), ("exit 3", 3), ("kill -9 $$", 137)])
def test_the_exit_code_of_explain_passes_through(work, monkeypatch, ending, code):
    work.out.mkdir()
    (work.out / "dem").write_text(f"#!/bin/sh\necho 'dem: error: the reason' >&2\n{ending}\n")
    (work.out / "dem").chmod(0o755)
    monkeypatch.setenv("ROCKBREAK_BIN", str(work.out))
    with pytest.raises(RockbreakError, match="row 3: the reason") as failure:
        explained("dem", "scene.yaml", {}, "row 3")
    assert failure.value.code == code


def test_a_missing_scene_is_bad_input(work):
    process = work.run()
    assert process.returncode == 2 and "scene.yaml: no such file" in process.err


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
def test_when_dem_fails_its_message_and_exit_code_come_through(work, mode):
    work.scene(dem_dies_at=2)
    process = work.run("--mode", mode)
    assert process.returncode == 3 and process.err.count("particle 7, frame 3: flew off") == 1
    assert work.events("end")[-1]["code"] == 3


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
def test_when_xfem_fails_its_message_and_exit_code_come_through(work, mode):
    work.scene(xfem_error_at=2)
    process = work.run("--mode", mode)
    assert process.returncode == 3 and process.err.count("particle 3: singular matrix") == 1


@pytest.mark.parametrize("signum, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("mode", ["resident", "oneshot"])
def test_a_signal_ends_the_run_and_its_children(work, mode, signum, code):
    work.scene(frames=200, slow=0.02)
    process = work.start("--mode", mode)
    wait_for(work.directory.split_file(1))
    process.send_signal(signum)
    _, err = process.communicate(timeout=patience(30))
    assert process.returncode == code and "go on with --resume" in err
    assert processes_of(work.out) == []
    assert work.events("end")[-1]["code"] == code


def test_a_killed_driver_leaves_no_child_and_resumes_to_the_same_files(work):
    work.scene(frames=6)
    work.run()
    whole = work.payloads()
    work.out = work.path / "killed"
    work.directory = RunDirectory(work.out)
    work.scene(frames=6, slow=0.1)
    process = work.start()
    wait_for(work.directory.split_file(1))
    process.kill()
    process.communicate()
    assert work.run("--resume").returncode == 0
    assert work.payloads() == whole


def wait_for(path, seconds=30):
    end = time.monotonic() + patience(seconds)
    while not path.exists():
        assert time.monotonic() < end, f"{path} never came"
        time.sleep(0.01)


def processes_of(folder):
    found = []
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                with open(f"/proc/{entry}/cmdline", "rb") as file:
                    if str(folder).encode() in file.read():
                        found.append(entry)
            except OSError:
                pass
    return found
