"""Which frames are shown, and the frames themselves, read once."""
from functools import lru_cache

import numpy as np

from ..measures.frame import read_frame
from ..run.results import nearest

PAPER_STRAINS = (0.0, 0.07, 0.10)  # beside the end: those of the paper's Figs. 3 to 7
SHOWN_STRAINS = 4

cached_frame = lru_cache(maxsize=64)(read_frame)


def frame_of(run, k):
    return cached_frame(run.directory.frame_file(k))


def shown_strains(runs):
    """Axial strains of the pictures: 0, 7 and 10 % and the end, as in the paper, for tests that go on past them; else
    four at even distances."""
    end = min(run.frames[-1]["axial_strain"] for run in runs)
    if end > 1.1 * PAPER_STRAINS[-1]:
        return (*PAPER_STRAINS, end)
    return tuple(np.linspace(0.0, end, SHOWN_STRAINS))


def frame_at(run, strain):
    """Number of the frame nearest to an axial strain."""
    return run.frames[nearest(run.frames, strain)]["frame"]


def percent(strain):
    return f"{100 * strain:.3g} %"
