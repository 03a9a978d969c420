"""run.jsonl: one JSON object per line and event, appended and flushed at once.

Events are `start`, `frame`, `split`, `warning`, `end`, `summary` and `report`; each has `event` and `time` (Unix
seconds).
"""
import contextlib
import json
import os
import re
import threading
import time

from ..errors import BAD_INPUT, RockbreakError, cannot


class Ledger:
    """Appends events. A line that a killed run left half written is cut off before the first append, with all from the
    first zero byte on, which a machine leaves that goes down; one that the disk had no room for at once."""

    def __init__(self, path):
        self.path = path
        self._lock = threading.Lock()  # children's warnings arrive on threads of their own
        try:
            _drop_half_line(path)
            self._file = open(path, "ab", buffering=0)
        except OSError as error:
            raise cannot("write", path, error) from error

    def write(self, event, **fields):
        line = json.dumps({"event": event, "time": round(time.time(), 3), **fields}) + "\n"
        with self._lock:
            end = os.fstat(self._file.fileno()).st_size
            try:
                rest = line.encode("utf-8")
                while rest:
                    rest = rest[self._file.write(rest):]
            except OSError as error:
                with contextlib.suppress(OSError):
                    os.ftruncate(self._file.fileno(), end)
                raise cannot("write", self.path, error) from error

    def close(self):
        self._file.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _drop_half_line(path):
    try:
        with open(path, "rb+") as file:
            content = file.read()
            whole = content.split(b"\0", 1)[0].rfind(b"\n") + 1
            if whole < len(content):
                file.truncate(whole)
    except FileNotFoundError:
        pass


def read_ledger(path):
    """All complete events in order; a truncated last line is left out, a missing file gives none."""
    try:
        content = path.read_bytes()
    except FileNotFoundError:
        return []
    except OSError as error:
        raise cannot("read", path, error) from error
    events = []
    lines = content.split(b"\n")
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            event = json.loads(line.decode("utf-8"))
            event["event"]
        except (ValueError, KeyError, TypeError) as error:
            if number == len(lines):
                break
            raise RockbreakError(BAD_INPUT, f"{path}:{number}: not a JSON object with `event`: {error}") from error
        events.append(event)
    return events


def kind_of(text):
    """What warnings that differ by their numbers alone have in common."""
    return re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", text)


def seconds_per_phase(events):
    """Wall seconds of dem, xfem and handover, summed over the whole history of a run, resumptions included.

    A frame or split that was made again after an interruption counts each time: that time was spent.
    """
    seconds = {"dem": 0.0, "xfem": 0.0, "handover": 0.0, "report": 0.0}
    for event in events:
        for phase, value in event.get("seconds", {}).items():
            if phase in seconds:
                seconds[phase] += value
    seconds["total"] = sum(seconds.values())
    return seconds


WORK_OF_DEM = ("preparation", "shear")
FILES_OF_XFEM = ("read", "write", "total")


def coupling_overhead(events):
    """Share of the coupled loop's wall time that is neither stepping in dem nor solving in xfem: files, checks, hashes,
    messages, starting and waiting. Over all starts that came to their end; None if there is none.

        1 - (preparation + shear of dem + every phase of xfem but read and write) / wall
    """
    ends = [event["phases"] for event in events if event["event"] == "end" and event.get("phases", {}).get("wall")]
    wall = sum(phases["wall"] for phases in ends)
    work = sum(phases.get("dem", {}).get(phase, 0.0) for phases in ends for phase in WORK_OF_DEM)
    work += sum(seconds for phases in ends for phase, seconds in phases.get("xfem", {}).items()
                if phase not in FILES_OF_XFEM)
    return 1 - work / wall if wall else None
