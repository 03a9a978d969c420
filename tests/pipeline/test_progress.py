"""What is shown while runs and campaigns work: stages, the time left, and one line that a terminal has room for."""
import io
import json
import os
import pty
import subprocess
import time
from pathlib import Path

import pytest

import fake_children
from conftest import REPOSITORY
from rockbreak.campaign.jobs import SHEARED, Job
from rockbreak.campaign.progress import JsonCampaignProgress, Tally, TerminalCampaignProgress
from rockbreak.live import time_text
from rockbreak.run.ledger import read_ledger
from patience import patience
from synthetic import CASE


class Clock:
    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


def job(name, state, fraction=0.0, effort=1.0, started=100.0, began_at=0.0, **more):
    return Job(name, [], Path("log"), state=state, fraction=fraction, effort=effort, started=started,
               began_at=began_at, **more)


def seconds_left(jobs, elapsed, runs=None):
    clock = Clock()
    tally = Tally(jobs, jobs if runs is None else runs, 0, clock)
    clock.now += elapsed
    return tally.seconds_left()


def test_the_time_left_is_that_of_the_work_left_at_the_pace_so_far():
    """By hand: in 30 s an effort of 3 was done, 5 are left: 50 s."""
    jobs = [job("long", "done", 1.0, effort=2.0), job("half", "running", 0.5, effort=2.0, started=100.0),
            job("other", "waiting", effort=4.0)]
    assert seconds_left(jobs, 30.0) == pytest.approx(50.0)


def test_a_run_that_went_on_from_its_frames_counts_by_what_it_added():
    """From 0.8 to 0.9 in 10 s: 10 s are left, not 10 / 9 s."""
    assert seconds_left([job("one", "running", 0.9, began_at=0.8)], 10.0) == pytest.approx(10.0)


def test_samples_take_time_too():
    sample, run = job("sample", "running", effort=1.0), job("run", "waiting", effort=3.0)
    assert seconds_left([sample, run], 5.0, [run]) is None, "nothing is done yet"
    sample.state, sample.fraction = "done", 1.0
    assert seconds_left([sample, run], 5.0, [run]) == pytest.approx(15.0)


def test_the_last_long_run_is_waited_for():
    """Ten short ones took 10 s side by side; the long one, begun with them, is at a tenth: 90 s."""
    jobs = [job(str(i), "done", 1.0, effort=1.0) for i in range(10)] + [job("long", "running", 0.1, effort=1.0)]
    assert seconds_left(jobs, 10.0) == pytest.approx(90.0)


def test_failed_runs_are_neither_done_nor_left():
    bad = job("bad", "failed", 0.2, effort=50.0)
    assert seconds_left([bad, job("good", "running", 0.5)], 4.0) == pytest.approx(4.0)
    assert seconds_left([bad], 4.0) is None


def frame(strain):
    return {"event": "frame", "axial_strain": strain, "target_strain": 0.2}


def test_a_run_is_not_at_its_end_before_its_report():
    one = job("run", "running")
    one.child_event("run", frame(0.0))
    assert (one.stage, one.fraction, one.began_at) == ("shear", 0.0, 0.0)
    one.child_event("run", frame(0.1))
    assert one.fraction == pytest.approx(SHEARED / 2) and one.began_at == 0.0
    one.child_event("run", frame(0.2))
    one.child_event("run", {"event": "progress", "stage": "report"})
    assert one.stage == "report" and one.fraction == SHEARED < 1.0
    again = job("run", "running")
    again.child_event("run", frame(0.15))  # what `pipeline/run --resume` says of the newest frame
    assert again.began_at == again.fraction == pytest.approx(0.75 * SHEARED)


def test_json_lines_of_a_campaign_tell_counts_and_time():
    stream, jobs = io.StringIO(), [job("a", "done", 1.0, user_seconds=2.0), job("b", "running", 0.5)]
    with JsonCampaignProgress(Tally(jobs, jobs, 3), stream) as progress:
        progress.changed(jobs[0])
        progress.changed(None)  # too soon after the line before
    first, second = map(json.loads, stream.getvalue().splitlines())
    assert first == {"event": "job", "name": "a", "state": "done", "user_seconds": 2.0}
    assert second["runs"] == 5 and second["kept"] == 3 and second["done"] == 1 and second["running"] == 1


@pytest.mark.parametrize("columns, room", [(80, 35), (120, 70)])
def test_lines_of_a_terminal_show_as_much_of_a_name_as_fits(columns, room, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    long, short = job("a" * 60 + "_0123456789", "running", 0.5), job("short", "running", 0.25)
    for one in (long, short):
        one.stage, one.started = "densification", time.monotonic() - 3600 * 11.5
    progress = TerminalCampaignProgress(Tally([long, short], [long, short], 0))
    with progress._console.capture() as printed:
        progress.changed(None)
        progress._console.print(progress._live.renderable)
    first, second, last = printed.get().splitlines()
    assert len(first) <= columns and len(second) <= columns and "0 of 2 runs done" in last
    assert first.endswith(" densification 11 h 30 min") and second.endswith(" densification 11 h 30 min")
    assert first.index("━") == second.index("━") >= room and "_0123456789 " in first


def test_a_run_without_its_sample_repeats_no_message(monkeypatch):
    monkeypatch.setenv("COLUMNS", "200")
    sample = job("samples/s", "failed", code=3, reason="dem: error: flew off")
    sample.child = object()
    run = job("run", "failed", code=3, reason="its sample could not be prepared: dem: error: flew off", after=sample)
    progress = TerminalCampaignProgress(Tally([sample, run], [run], 0))
    with progress._console.capture() as printed:
        progress.changed(sample)
        progress.changed(run)
    assert printed.get().count("flew off") == 1 and "run: not started" in printed.get()


@pytest.mark.parametrize("seconds, text", [(None, "?"), (0.4, "0 s"), (59.6, "1 min 00 s"), (3599.7, "1 h 00 min"),
                                           (7260, "2 h 01 min")])
def test_times_are_told_as_people_tell_them(seconds, text):
    assert time_text(seconds) == text


# -- the commands themselves

def scene(tmp_path):
    fake_children.install(tmp_path / "bin")
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps({**CASE, "shear": {**CASE["shear"], "frames": 3}}))
    return file, {**os.environ, "ROCKBREAK_BIN": str(tmp_path / "bin"), "FAKE_LOG": str(tmp_path / "log")}


def events(process):
    return [json.loads(line) for line in process.stderr.splitlines() if line.startswith("{")]


def test_a_run_says_that_it_sums_up_and_where_it_goes_on(tmp_path):
    file, environment = scene(tmp_path)

    def call(*more):
        return subprocess.run([REPOSITORY / "pipeline" / "run", file, "--out", tmp_path / "run", *more],
                              env=environment, capture_output=True, text=True, timeout=patience(120), check=True)

    first = events(call("--no-report"))
    assert [event["frame"] for event in first if event["event"] == "frame"] == [0, 1, 2]
    assert first[-1] == {"source": "driver", "event": "progress", "stage": "summary"}
    (tmp_path / "run" / "frames" / "000002.h5").unlink()
    again = events(call("--resume", "--no-report"))
    frames = [event for event in again if event["event"] == "frame"]
    assert [event["frame"] for event in frames] == [1, 2], "the newest one first"
    splits = [event for event in read_ledger(tmp_path / "run" / "run.jsonl") if event["event"] == "split"]
    assert frames[0]["broken"] == sum(split["broken"] for split in splits[:2]) > 0


def test_on_a_terminal_nothing_is_left_but_messages_and_the_path_of_the_report(tmp_path):
    """The terminal's control sequences are carried out here: returns, lines up, lines cleared."""
    file, environment = scene(tmp_path)
    ours, theirs = pty.openpty()
    process = subprocess.Popen([REPOSITORY / "pipeline" / "run", file, "--out", tmp_path / "run"], stdin=theirs,
                               stdout=theirs, stderr=theirs,
                               env={**environment, "TERM": "xterm-256color", "COLUMNS": "80"})
    os.close(theirs)
    said = b""
    while True:
        try:
            part = os.read(ours, 65536)
        except OSError:
            break
        if not part:
            break
        said += part
    assert process.wait(patience(60)) == 0
    assert b"report" in said and b"particles" in said
    assert screen(said.decode()) == ["xfem: warning: frame 1: particle 5: analysis refused: the mesh is too coarse",
                                     str(tmp_path / "run" / "report.html")]


def screen(text):
    """Lines that stay on an endlessly wide terminal."""
    lines, row, column, at = [""], 0, 0, 0
    while at < len(text):
        one = text[at]
        if one == "\x1b":
            end = at + 2
            while not text[end].isalpha():
                end += 1
            number, kind = text[at + 2:end], text[end]
            if kind == "A":
                row = max(0, row - int(number or 1))
            elif kind == "K":
                lines[row] = "" if number == "2" else lines[row][:column]
            at = end
        elif one == "\r":
            column = 0
        elif one == "\n":
            row += 1
            lines += [""] * (row + 1 - len(lines))
        else:
            lines[row] = lines[row][:column].ljust(column) + one + lines[row][column + 1:]
            column += 1
        at += 1
    return [line.rstrip() for line in lines if line.strip()]
