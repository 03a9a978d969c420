"""Everything that is read from a run, each thing once and only when somebody asks for it."""
from functools import cached_property

import numpy as np

from ..errors import BAD_INPUT, RockbreakError
from ..measures.fabric import frame_anisotropies
from .history import joined, rows_of
from .ledger import read_ledger
from .run_directory import broken_in, refusals_in, state_of
from ..sealed import open_sealed


class Results:
    def __init__(self, directory):
        self.directory = directory
        self._anisotropies = {}

    @cached_property
    def name(self):
        return self.directory.path.resolve().name

    @cached_property
    def case(self):
        return self.directory.case()

    @cached_property
    def breakable(self):
        return self.directory.breaks_particles()

    @cached_property
    def _frames_and_history(self):
        return read_frames(self.directory)

    @property
    def frames(self):
        """A row per frame: number, step, axial strain, particles, contacts, solid area [m^2] and the final flag."""
        return self._frames_and_history[0]

    @property
    def history(self):
        return self._frames_and_history[1]

    @cached_property
    def broken(self):
        """Frame number -> particles that its split breaks."""
        if not self.breakable:
            return {}
        return {row["frame"]: broken_in(self.directory.split_file(row["frame"])) for row in self.frames}

    @cached_property
    def refused(self):
        """Number of analyses that the splits refused."""
        return sum(len(refusals_in(self.directory.split_file(k))) for k in self.broken)

    @cached_property
    def summary(self):
        from .summary import summarize
        return summarize(self)

    @cached_property
    def _stages(self):
        peak = nearest(self.frames, self.summary["peak_strain"] or 0.0)
        return {stage: self.frames[row]["frame"] for stage, row in (("start", 0), ("peak", peak), ("end", -1))}

    def stage_frame(self, stage):
        """Frame number at the "start", the "peak" or the "end" of shear; they may coincide."""
        return self._stages[stage]

    def ledger(self):
        """Read anew each time: it grows while a report is made."""
        return read_ledger(self.directory.ledger_file)

    def anisotropies(self, k):
        if k not in self._anisotropies:
            with open_sealed(self.directory.frame_file(k)) as file:
                self._anisotropies[k] = frame_anisotropies(file)
        return self._anisotropies[k]


def read_frames(directory):
    """The table and the history of all frames, each file opened once."""
    if not directory.path.is_dir():
        raise RockbreakError(BAD_INPUT, f"{directory.path}: no such directory; expected a run directory")
    numbers = directory.frame_numbers()
    if not numbers:
        raise RockbreakError(BAD_INPUT, f"{directory.path}: found no frames/*.h5; expected a run directory with at "
                             "least one frame")
    table, history = [], []
    for k in numbers:
        path = directory.frame_file(k)
        try:
            with open_sealed(path) as file:
                table.append({**state_of(k, file), "final": bool(file.attrs["final"]),
                              "solid_area": float(np.sum(file["particles/area"][:]))})
                history.append(rows_of(file))
        except (KeyError, OSError) as error:
            raise RockbreakError(BAD_INPUT, f"{path}: not a complete frame: {error}") from error
    return table, joined(history)


def nearest(frames, strain):
    """Row of the frame nearest to an axial strain."""
    return min(range(len(frames)), key=lambda i: abs(frames[i]["axial_strain"] - strain))
