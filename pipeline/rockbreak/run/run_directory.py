"""A run directory: where its files stand, which frames are valid, and its lock.

DIR/case.yaml, run.jsonl, frames/000000.h5, splits/000000.h5, summary.json, report.html, figures/*, run.xdmf,
paraview/000000.h5; for a while .restoring/
"""
import fcntl
import json
import os
import shutil
from contextlib import contextmanager
from pathlib import Path

import h5py
import yaml

from ..errors import BAD_INPUT, IO_FAILURE, RockbreakError, cannot
from .payload_hash import payload_hash, xxh3_128
from ..sealed import open_sealed, sealed_content

DRIVER_FILES = {".lock", "run.jsonl"}  # all that a run leaves which failed before it began


class RunDirectory:
    def __init__(self, path):
        self.path = Path(path)

    case_file = property(lambda self: self.path / "case.yaml")
    ledger_file = property(lambda self: self.path / "run.jsonl")
    summary_file = property(lambda self: self.path / "summary.json")
    report_file = property(lambda self: self.path / "report.html")
    figures = property(lambda self: self.path / "figures")
    xdmf_file = property(lambda self: self.path / "run.xdmf")
    restoring = property(lambda self: self.path / ".restoring")  # where a lost frame is made anew

    def frame_file(self, k):
        return self.path / "frames" / f"{k:06d}.h5"

    def split_file(self, k):
        return self.path / "splits" / f"{k:06d}.h5"

    def _numbers(self, folder):
        files = (self.path / folder).glob("*.h5")
        return sorted(int(file.stem) for file in files if file.stem.isdigit())

    def frame_numbers(self):
        return self._numbers("frames")

    def split_numbers(self):
        return self._numbers("splits")

    def is_empty(self):
        return not self.path.is_dir() or all(entry.name in DRIVER_FILES for entry in self.path.iterdir())

    def case(self):
        """The resolved configuration."""
        try:
            with open(self.case_file, encoding="utf-8") as file:
                case = yaml.safe_load(file)
        except FileNotFoundError:
            raise RockbreakError(BAD_INPUT, f"{self.case_file}: no such file; a run directory has one") from None
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise RockbreakError(BAD_INPUT, f"{self.case_file}: {error}") from error
        if not isinstance(case, dict):
            raise RockbreakError(BAD_INPUT, f"{self.case_file}: found no mapping of keys")
        return case

    def has_case(self):
        """Whether case.yaml stands, down to its last section."""
        try:
            return "output" in self.case()
        except RockbreakError:
            return False

    def bring_results_to_disk(self):
        """Frames and splits survive whatever happens to the machine from now on."""
        for folder in ("frames", "splits"):
            files = sorted((self.path / folder).glob("*.h5"))
            for path in [*files, *([self.path / folder] if files else [])]:
                bring_to_disk(path)

    def summary(self):
        """The numbers in summary.json; None without a whole one."""
        try:
            return json.loads(self.summary_file.read_text(encoding="utf-8"))
        except (FileNotFoundError, ValueError):
            return None

    def breaks_particles(self):
        return "breakage" in (self.case().get("effects") or [])

    def newest_valid_frame(self):
        """Number of the newest frame that reads without error and has the payload that it claims; None without one."""
        for k in reversed(self.frame_numbers()):
            if is_valid(self.frame_file(k)):
                return k
        return None

    def frame_hash(self, k):
        """Payload hash that frame k states; None if it does not stand."""
        try:
            return attributes(self.frame_file(k)).get("payload_hash")
        except RockbreakError:
            return None

    def answer(self, k):
        """(payload hash of the frame that split k answers, number of particles that it breaks); (None, 0) if the split
        does not stand."""
        try:
            with open_sealed(self.split_file(k)) as split:
                return plain(split.attrs.get("frame_hash")), len(split["broken/parent"])
        except (OSError, KeyError, RockbreakError):
            return None, 0

    def clear_after(self, k):
        """Removes splits that answer no frame up to k, half-written files, and what an interrupted restoring left."""
        for number in self.split_numbers():
            if k is None or number > k:
                self.split_file(number).unlink()
        for folder in (".", "frames", "splits", "prepared", "figures", "paraview"):
            for leftover in (self.path / folder).glob("*.tmp"):
                leftover.unlink()
        shutil.rmtree(self.restoring, ignore_errors=True)

    def lock(self):
        return lock_directory(self.path, "pipeline/run", holders="pipeline/run or dem")


def lock_directory(path, program, holders=None):
    """Takes a directory for `program`, which it may share with no other of its `holders` (default: itself); the
    returned file holds the lock until it and all its heirs are closed."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        file = open(path / ".lock", "w", encoding="utf-8")
    except OSError as error:
        raise RockbreakError(IO_FAILURE, f"{path}: cannot be used as a directory of {program}: "
                             f"{error.filename}: {error.strerror}") from error
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.close()
        raise RockbreakError(BAD_INPUT, f"{path}: another {holders or program} is at work in this directory; "
                             "wait for it, or choose another --out") from None
    os.set_inheritable(file.fileno(), True)
    return file


def check_ours(out, program, marks):
    """Refuses to mix results of `program` with something else: a directory of its own holds one of `marks`."""
    if out.is_file():
        raise RockbreakError(BAD_INPUT, f"{out}: found a file, expected a directory")
    if out.is_dir() and any(entry.name != ".lock" for entry in out.iterdir()) and not any(
            (out / mark).exists() for mark in marks):
        raise RockbreakError(BAD_INPUT, f"{out}: found a directory of something else (no {' or '.join(marks)} in it), "
                             f"expected a new one or that of an earlier {program}")


def write_text(path, text):
    write_whole(path, text.encode("utf-8"))


def write_whole(path, content, durable=True):
    """A file that is either the old one or the new one, whole; if durable, also after a power cut."""
    temporary = path.with_name(path.name + ".tmp")
    try:
        temporary.write_bytes(content)
        if durable:
            bring_to_disk(temporary)
        os.replace(temporary, path)
        if durable:
            bring_to_disk(path.parent)
    except OSError as error:
        temporary.unlink(missing_ok=True)
        raise cannot("write", path, error) from error


def bring_to_disk(path):
    """fsync of a file or folder. Raises OSError with its name."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        os.close(descriptor)


def make_folder(path):
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot("create", path, error) from error


def attributes(path):
    """Root attributes of an HDF5 file as plain Python values."""
    with open_sealed(path) as file:
        return {key: plain(value) for key, value in file.attrs.items()}


def state_of(k, frame):
    """Where a run stood at frame k, an open file."""
    return {"frame": k, "step": int(frame.attrs["step"]), "axial_strain": float(frame.attrs["axial_strain"]),
            "particles": len(frame["particles/id"]), "contacts": len(frame["contacts/a"])}


def plain(value):
    if isinstance(value, bytes):
        return value.decode()
    return value.item() if hasattr(value, "item") and getattr(value, "ndim", 0) == 0 else value


def is_valid(path):
    """True if the file has the bytes that were written and the payload has the hash that it states."""
    try:
        with open_sealed(path) as file:
            return payload_hash(file) == plain(file.attrs.get("payload_hash"))
    except (OSError, RockbreakError, KeyError, ValueError):
        return False


@contextmanager
def open_written(path, kind):
    """(open file, what the ledger keeps of it: name in its folder, size, payload hash, hash of the whole file) of a
    frame or split that has just been written; it is read once."""
    content = sealed_content(path)
    try:
        with h5py.File(path, "r") as file:
            yield file, {"path": f"{path.parent.name}/{path.name}", "bytes": len(content),
                         "payload_hash": plain(file.attrs.get("payload_hash")), "file_hash": xxh3_128(content)}
    except (OSError, KeyError) as error:
        raise RockbreakError(IO_FAILURE, f"{path}: not a readable {kind}: {error}") from error


def broken_in(split_file):
    """Number of particles that a split breaks; 0 if it does not exist."""
    return _read(split_file, lambda split: len(split["broken/parent"]), 0)


def refusals_in(split_file):
    """(particle, reason) of every analysis that a split refused; none if it does not exist."""
    return _read(split_file, refusals_of, [])


def _read(split_file, content, otherwise):
    if not split_file.exists():
        return otherwise
    try:
        with open_sealed(split_file) as split:
            return content(split)
    except (OSError, KeyError) as error:
        raise RockbreakError(IO_FAILURE, f"{split_file}: not a readable split: {error}") from error


def refusals_of(split):
    """As refusals_in, of an open file."""
    particles = [int(particle) for particle in split["refusals/particle"][:]] if "refusals" in split else []
    return list(zip(particles, map(str, split["refusals/reason"].asstr()[:]))) if particles else []
