"""Run directories that fill up, cannot be written, vanish or have strange names: each failure names its file and ends
with exit code 4, nothing half stands under a final name, and the resumed run is the uninterrupted one."""
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from conftest import REPOSITORY
from patience import patience
from rockbreak.run.child import executable
from rockbreak.errors import IO_FAILURE
from rockbreak.run.run_directory import RunDirectory, is_valid

sys.path.insert(0, str(REPOSITORY / "tests" / "robustness" / "lost"))
from lost_runs import command, differences, immutable_files, processes_in, results, temporary_files  # noqa: E402

SCENE = REPOSITORY / "tests" / "robustness" / "golden" / "scene.yaml"
OVERRIDES = ["shear.axial_strain=0.008"]
LAST_KEPT = 2  # frame of a run that is to go on

# $0 is a file system of its own, of $1 bytes; what follows runs twice: as long as it is full or read-only ($2), and
# after that. Its messages and exit codes go to $3.first and $3.second, the run of $0 to $3.run at the end.
ON_ITS_OWN_DISK = """
set -e; disk=$0; size=$1; state=$2; said=$3; from=$4; shift 4
mount -t tmpfs -o size=$size none "$disk"
if [ -d "$from" ]; then cp -r "$from" "$disk/run"; fi
mount -o remount,$state "$disk"
code=0; "$@" > /dev/null 2> "$said.first" || code=$?; echo $code > "$said.first_code"
cp -r "$disk/run" "$said.between" 2> /dev/null || true
mount -o remount,rw,size=64m "$disk"
code=0; "$@" --resume > /dev/null 2> "$said.second" || code=$?; echo $code > "$said.second_code"
cp -r "$disk/run" "$said.run"
"""


def run_command(out, resume=False, mode="resident"):
    words = command(out, mode, resume, report=False, overrides=OVERRIDES)
    words[1] = str(SCENE)
    return words


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The uninterrupted run."""
    out = tmp_path_factory.mktemp("whole") / "run"
    subprocess.run(run_command(out), check=True, capture_output=True)
    return out


def cut(whole, out):
    """A copy of a run, as if it had been ended after a frame."""
    shutil.copytree(whole, out)
    directory = RunDirectory(out)
    for k in directory.frame_numbers():
        if k > LAST_KEPT:
            directory.frame_file(k).unlink()
            directory.split_file(k).unlink()
    directory.summary_file.unlink()
    return out


def failed_rightly(code, said, reason, run):
    """Exit code, one line with a file and the reason, nothing half."""
    assert code == IO_FAILURE, said
    assert any(reason in line and (str(run) in line or ".h5" in line) for line in said.splitlines()), said
    assert "Traceback" not in said
    if run.exists():
        assert_whole_files(run)


def assert_whole_files(run):
    assert [name for name in immutable_files(run) if not is_valid(run / name)] == [] and temporary_files(run) == []


class OwnDisk:
    """Runs a command where the disk is small or read-only, and once more where it is not."""

    def __init__(self, tmp_path):
        self.disk, self.said = tmp_path / "disk", tmp_path / "said"
        self.disk.mkdir()
        self.run = self.disk / "run"

    def go(self, words, size="64m", state="rw", start=None):
        space = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"])]
        process = subprocess.run([*space, "sh", "-c", ON_ITS_OWN_DISK, self.disk, size, state, self.said, start or "",
                                  *words], capture_output=True, text=True, check=False)
        if process.returncode != 0 and ("not permitted" in process.stderr or "denied" in process.stderr):
            pytest.skip("the system lets nobody mount a file system of his own; the failing calls of test_lost.py and "
                        "the limit on sizes below check what a full one does")
        assert process.returncode == 0, process.stderr

    def text(self, name):
        return self.said.with_name(f"said.{name}").read_text()

    def folder(self, name):
        return self.said.with_name(f"said.{name}")


@pytest.mark.parametrize("size", ["8k", "250k", "700k"])
def test_a_full_disk_ends_the_run_and_the_run_goes_on_when_there_is_room(whole, tmp_path, size):
    disk = OwnDisk(tmp_path)
    disk.go(run_command(disk.run), size=size)
    failed_rightly(int(disk.text("first_code")), disk.text("first"), "No space left on device", disk.run)
    assert_whole_files(disk.folder("between"))
    assert int(disk.text("second_code")) == 0, disk.text("second")
    assert differences(results(disk.folder("run")), results(whole)) == []


@pytest.mark.parametrize("begun", [False, True], ids=["from_the_start", "half_way"])
def test_a_read_only_disk_is_refused_and_the_run_goes_on_when_it_is_writable(whole, tmp_path, begun):
    disk = OwnDisk(tmp_path)
    start = cut(whole, tmp_path / "begun") if begun else None
    disk.go(run_command(disk.run), state="ro", start=start)
    failed_rightly(int(disk.text("first_code")), disk.text("first"), "Read-only file system", disk.run)
    if begun:
        assert results(disk.folder("between")) == results(start)
    assert int(disk.text("second_code")) == 0, disk.text("second")
    assert differences(results(disk.folder("run")), results(whole)) == []


@pytest.mark.parametrize("program", ["dem", "xfem", "report"])
def test_a_program_alone_names_the_file_that_it_cannot_write_on_a_read_only_disk(whole, tmp_path, program):
    disk = OwnDisk(tmp_path)
    run = RunDirectory(disk.run)
    words = {"dem": [executable("dem"), "run", SCENE, "--out", run.path, "--resume", "--set", *OVERRIDES],
             "xfem": [executable("xfem"), "solve", run.frame_file(LAST_KEPT), "--config", run.case_file, "--previous",
                      run.split_file(LAST_KEPT - 1), "--out", run.path / "other.h5"],
             "report": [REPOSITORY / "pipeline" / "report", run.path]}[program]
    disk.go(words, state="ro", start=whole if program == "report" else cut(whole, tmp_path / "begun"))
    said = disk.text("first")
    assert int(disk.text("first_code")) == IO_FAILURE, said
    assert "Read-only file system" in said and str(run.path) in said and "Traceback" not in said


def test_a_file_larger_than_allowed_ends_the_run_and_the_run_goes_on_without_the_limit(whole, tmp_path):
    """Also what a quota of the system does: the limit sends SIGXFSZ, whose default ends a process without a word."""
    out = tmp_path / "run"
    limited = subprocess.run(["sh", "-c", 'ulimit -f 40; exec "$@"', "sh", *run_command(out)], capture_output=True,
                             text=True, check=False)
    failed_rightly(limited.returncode, limited.stderr, "File too large", out)
    subprocess.run(run_command(out, resume=True), check=True, capture_output=True)
    assert differences(results(out), results(whole)) == []


@pytest.mark.parametrize("mode", ["resident", "oneshot"])
def test_a_directory_that_vanishes_ends_the_run_and_it_can_begin_anew(whole, tmp_path, mode):
    out = tmp_path / "run"
    with subprocess.Popen(run_command(out, mode=mode), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL,
                          text=True) as process:
        wait_for(process, RunDirectory(out).split_file(1))
        out.rename(tmp_path / "gone")
        shutil.rmtree(tmp_path / "gone", ignore_errors=True)
        said = process.communicate(timeout=patience(60))[1]
    failed_rightly(process.returncode, said, "No such file or directory", out)
    assert processes_in(out) == []
    subprocess.run(run_command(out, resume=True), check=True, capture_output=True)
    assert differences(results(out), results(whole)) == []


@pytest.mark.parametrize("lines", [2, 30, 60, 75])
@pytest.mark.parametrize("frames", [True, False], ids=["frames", "only_a_sample"])
def test_the_head_of_a_case_is_no_case(whole, tmp_path, frames, lines):
    """It would read as a scene with defaults for what is gone."""
    out = cut(whole, tmp_path / "run")
    case = RunDirectory(out).case_file
    text = case.read_text()
    case.write_text("".join(text.splitlines(keepends=True)[:lines]))
    if not frames:
        shutil.rmtree(out / "frames")
        shutil.rmtree(out / "splits")
    subprocess.run(run_command(out, resume=True), check=True, capture_output=True)
    assert differences(results(out), results(whole)) == [] and case.read_text() == text


def test_a_lost_frame_is_made_anew_with_the_guards_of_the_command_on_another_disk_than_its_folder(whole, tmp_path):
    out = tmp_path / "run"
    shutil.copytree(whole, out)
    with tempfile.TemporaryDirectory(dir="/dev/shm") as elsewhere:
        shutil.move(out / "frames", elsewhere)
        (out / "frames").symlink_to(Path(elsewhere) / "frames")
        RunDirectory(out).frame_file(LAST_KEPT).unlink()
        resume = run_command(out, resume=True)
        strict = subprocess.run([*resume, "--set", "guards.overlap=1e-9"], capture_output=True, text=True, check=False)
        assert strict.returncode == 3, strict.stderr
        subprocess.run([*resume, "--set", "guards.overlap=0.5"], check=True, capture_output=True)
        assert differences(results(out), results(whole)) == []


def test_a_directory_may_have_blanks_quotes_and_any_letters_in_its_name(whole, tmp_path):
    out = tmp_path / "ein Lauf 'mit' \"Zeichen\"" / "ü 岩石 $HOME;%d\\"
    out.parent.mkdir()
    subprocess.run(run_command(out), check=True, capture_output=True, env={**os.environ, "LC_ALL": "C"})
    expected = results(whole)
    expected["summary.json"]["case"] = out.name
    assert differences(results(out), expected) == []
    for k in RunDirectory(out).frame_numbers()[LAST_KEPT:]:
        RunDirectory(out).frame_file(k).unlink()
    subprocess.run(run_command(out, resume=True, mode="oneshot"), check=True, capture_output=True)
    assert differences(results(out), expected) == []


@pytest.mark.parametrize("name, signum, code", [("dem", signal.SIGTERM, 143), ("xfem", signal.SIGINT, 130)])
def test_a_signal_to_a_child_ends_the_run_and_it_goes_on(whole, tmp_path, name, signum, code):
    out = tmp_path / "run"
    with subprocess.Popen(run_command(out), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True) as process:
        wait_for(process, RunDirectory(out).split_file(1))
        os.kill(children(process.pid)[name], signum)
        said = process.communicate(timeout=patience(60))[1]
    assert process.returncode == code, said
    assert_whole_files(out)
    subprocess.run(run_command(out, resume=True), check=True, capture_output=True)
    assert differences(results(out), results(whole)) == []


def children(pid):
    """Name -> number of the processes that a process started."""
    found = {}
    for task in os.listdir(f"/proc/{pid}/task"):
        with open(f"/proc/{pid}/task/{task}/children", encoding="ascii") as numbers:
            for number in numbers.read().split():
                with open(f"/proc/{number}/comm", encoding="utf-8") as comm:
                    found[comm.read().strip()] = int(number)
    return found


def wait_for(process, path, seconds=60):
    end = time.monotonic() + patience(seconds)
    while not path.exists():
        assert process.poll() is None and time.monotonic() < end, f"{path} never came"
        time.sleep(0.002)
