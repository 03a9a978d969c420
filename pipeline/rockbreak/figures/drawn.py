"""A drawn figure with the numbers in it, and the columns that these numbers are kept in."""
import csv
import io
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure


class Columns:
    """Rows of a CSV file, added in blocks: each block is one value or one array per column."""

    def __init__(self):
        self._blocks = []

    def add(self, **block):
        arrays = np.broadcast_arrays(*(np.atleast_1d(value) for value in block.values()))
        self._blocks.append(dict(zip(block, arrays)))

    def __len__(self):
        return sum(len(next(iter(block.values()))) for block in self._blocks)

    def text(self):
        """As CSV, numbers with six digits; a column that a block lacks is left empty in its rows."""
        names = list(dict.fromkeys(name for block in self._blocks for name in block))
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(names)
        for block in self._blocks:
            columns = [[cell(value) for value in block[name].tolist()] if name in block else None for name in names]
            length = len(next(iter(block.values())))
            writer.writerows(zip(*(column if column is not None else [""] * length for column in columns)))
        return out.getvalue()


def cell(value):
    if isinstance(value, float):
        return "" if value != value else f"{value:.6g}"
    return str(int(value)) if isinstance(value, bool) else str(value)


@dataclass
class Drawn:
    figure: Figure
    data: Columns
    wide: bool = False  # takes the width of the page
