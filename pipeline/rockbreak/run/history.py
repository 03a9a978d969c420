"""The history of a run: the rows of all frames as one table of columns (history/* of frame/1)."""
import numpy as np

from ..errors import BAD_INPUT, RockbreakError
from ..sealed import open_sealed


def read_history(directory):
    """The history of all frames (see `joined`)."""
    parts = []
    for k in directory.frame_numbers():
        path = directory.frame_file(k)
        try:
            with open_sealed(path) as file:
                parts.append(rows_of(file))
        except (OSError, KeyError) as error:
            raise RockbreakError(BAD_INPUT, f"{path}: no readable history: {error}") from error
    return joined(parts)


def rows_of(frame):
    """Column -> rows since the frame before, of an open file."""
    return {name: column[:] for name, column in frame["history"].items()}


def joined(parts):
    """Columns from the prepared state on: the last row of the first frame (axial strain 0), every row of later ones.

    A column that only some frames have is left out.
    """
    parts = [{name: values[-1:] for name, values in part.items()} for part in parts[:1]] + parts[1:]
    common = set.intersection(*(set(part) for part in parts)) if parts else set()
    return {name: np.concatenate([part[name] for part in parts]) for name in sorted(common)}


def shear_rows(history):
    """The rows after the prepared state."""
    return {name: values[1:] for name, values in history.items()}


def running_mean(x, y, window):
    """Mean of y over all points within half a window of x on either side; fewer at the ends. x ascends."""
    low = np.searchsorted(x, x - window / 2, side="left")
    high = np.searchsorted(x, x + window / 2, side="right")
    total = np.concatenate([[0.0], np.cumsum(y)])
    return (total[high] - total[low]) / (high - low)


def sin_phi(rows):
    """Eq. 12 of the paper, the axes taken as principal: (s_yy - s_xx) / (s_yy + s_xx)."""
    return (rows["stress_yy"] - rows["stress_xx"]) / (rows["stress_yy"] + rows["stress_xx"])
