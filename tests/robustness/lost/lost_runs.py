"""The coupled run that is interrupted: how it is started, what stands in its directory, what its results are."""
import fcntl
import hashlib
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
SCENE = HERE / "scene.yaml"
sys.path.insert(0, str(REPOSITORY / "pipeline"))
sys.path.insert(0, str(REPOSITORY / "tests"))
from patience import patience  # noqa: E402
from rockbreak.run.run_directory import RunDirectory, attributes  # noqa: E402

WITH_TIMES = ("wall_seconds", "cpu_seconds", "coupling_overhead")  # of summary.json
TIMED_FIGURE = "phases.png"


def command(out, mode="resident", resume=False, report=True, overrides=(), threads=1):
    return [str(REPOSITORY / "pipeline" / "run"), str(SCENE), "--out", str(out), "--mode", mode, "--threads",
            str(threads), *(["--resume"] if resume else []), *([] if report else ["--no-report"]),
            *(word for override in overrides for word in ("--set", override))]


class Started:
    """A driver in a process group of its own; what it and its children say on stderr goes to a file."""

    def __init__(self, arguments, log, environment=None):
        self.log = log
        with open(log, "w", encoding="utf-8") as file:
            self.process = subprocess.Popen(arguments, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                            stderr=file, start_new_session=True,
                                            env={**os.environ, **(environment or {})})
        self.pid = self.process.pid

    def children(self):
        """Name -> process number of dem and xfem, those that run now."""
        try:
            numbers = Path(f"/proc/{self.pid}/task/{self.pid}/children").read_text(encoding="ascii").split()
            found = {Path(f"/proc/{n}/comm").read_text(encoding="ascii").strip(): int(n) for n in numbers}
        except OSError:
            return {}
        return {name: number for name, number in found.items() if name in ("dem", "xfem")}

    def first_progress(self):
        """The first event of dem's progress, None if it came to none."""
        for line in self.log.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("{") and '"progress"' in line:
                try:
                    event = json.loads(line)
                except json.JSONDecodeError:
                    continue
                if event.get("source") == "dem":
                    return event
        return None


def seconds_until_free(out, longest=30.0):
    """How long until no process holds the directory: the driver, and every heir of its lock. None: never."""
    begin = time.monotonic()
    while time.monotonic() - begin < patience(longest):
        if not (out / ".lock").exists():
            return 0.0
        with open(out / ".lock", encoding="utf-8") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return time.monotonic() - begin
            except BlockingIOError:
                time.sleep(0.002)
    return None


def processes_in(out):
    """Processes of ours that work in a run directory or name it: none, once nobody holds its lock."""
    found = []
    for entry in os.listdir("/proc"):
        if not entry.isdigit() or int(entry) == os.getpid():
            continue
        try:
            words = Path(f"/proc/{entry}/cmdline").read_bytes().split(b"\0")
            if str(out).encode() in words or os.readlink(f"/proc/{entry}/cwd") == str(out):
                found.append(b" ".join(words).decode(errors="replace"))
        except OSError:
            pass
    return found


def hash_of(path):
    return hashlib.blake2b(path.read_bytes(), digest_size=16).hexdigest()


def immutable_files(out):
    """Name -> hash of every frame and split."""
    return {f"{folder}/{file.name}": hash_of(file)
            for folder in ("frames", "splits") for file in sorted((out / folder).glob("*.h5"))}


def temporary_files(out):
    return sorted(str(file.relative_to(out)) for file in out.rglob("*.tmp"))


def phase_of(out):
    """What a run was doing when it was killed, told by the files that it left."""
    frames, splits = (len(list((out / folder).glob("*.h5"))) for folder in ("frames", "splits"))
    if temporary_files(out):
        return "while a file was written"
    if not frames:
        if not any((out / "prepared").glob("*.h5")):
            return "before the first checkpoint"
        return "in preparation"
    if frames > splits:
        return "in xfem, frame without split"
    if RunDirectory(out).frame_file(frames - 1).exists() and attributes(RunDirectory(out).frame_file(frames - 1))["final"]:
        return "after the last split: summary, report"
    return "in dem, between frames"


def results(out):
    """All that a run yields but its times: payloads, summary, the tables and figures of the report."""
    directory = RunDirectory(out)
    found = {name: attributes(out / name)["payload_hash"] for name in immutable_files(out)}
    if not directory.summary_file.exists():
        return found
    summary = json.loads(directory.summary_file.read_text(encoding="utf-8"))
    found["summary.json"] = {key: value for key, value in summary.items() if key not in WITH_TIMES}
    if directory.report_file.exists():
        found["tables"] = re.findall(r"<table>.*?</table>", directory.report_file.read_text(encoding="utf-8"), re.S)
        found |= {f"figures/{file.name}": hash_of(file) for file in sorted(directory.figures.glob("*.png"))
                  if file.name != TIMED_FIGURE}
    return found


def differences(found, expected):
    """What two results disagree in."""
    return sorted(name for name in found.keys() | expected.keys() if found.get(name) != expected.get(name))


def step_of_newest_checkpoint(out):
    """Step of the newest checkpoint of the preparation; 0 without one."""
    files = sorted((out / "prepared").glob("[0-9]*.h5"))
    return int(attributes(files[-1])["step"]) if files else 0
