"""Directions of the lines along which particles broke."""
from functools import lru_cache

import numpy as np
from matplotlib.figure import Figure

from .assemblies import legend
from .drawn import Columns, Drawn
from ..measures.breakage import direction_rose, read_breakages
from ..measures.frame import MODES
from ..style import GREEN, GREY, PURPLE, SOFT

BINS = 18  # of 10 degrees, in half a circle
SHOWN_MODES = (("tension", GREEN, ""), ("shear", PURPLE, "////"), ("none", GREY, ""))


@lru_cache(maxsize=256)
def breakages_of(run):
    return read_breakages(run.directory.path)


def crack_rose(selection):
    """A panel for each condition that breaks: shares of its breakages by direction, by the mode in which they began."""
    shown = [(one, [breakages_of(run) for run in one.runs]) for one in selection.breakable]
    shown = [(one, runs) for one, runs in shown if any(len(run) for run in runs)]
    if not shown:
        return None
    columns = min(4, len(shown))
    rows = -(-len(shown) // columns)
    side = 3.4 if len(shown) == 1 else 2.75
    figure = Figure(figsize=(max(5.4, side * columns), side * rows + 0.35), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False, subplot_kw={"projection": "polar"}).ravel()
    data, top = Columns(), 0.0
    for (condition, runs), axes in zip(shown, grid):
        direction, mode = (np.concatenate([getattr(run, name) for run in runs]) for name in ("direction", "mode"))
        base = np.zeros(2 * BINS)
        for name, color, hatch in SHOWN_MODES:
            chosen = direction[mode == MODES.index(name)]
            if name == "none" and not len(chosen):
                continue
            edges, share = direction_rose(chosen, BINS)
            share = np.tile(share * len(chosen) / len(direction), 2)
            centres = np.concatenate([0.5 * (edges[1:] + edges[:-1])] * 2) + np.repeat([0, np.pi], BINS)
            axes.bar(centres, 100 * share, width=np.pi / BINS, bottom=100 * base, color=color, hatch=hatch,
                     edgecolor="white", linewidth=0.5, label="not known" if name == "none" else name)
            base += share
            data.add(condition=condition.label, mode=name, direction_degrees=np.degrees(centres[:BINS]),
                     share_of_breakages=share[:BINS])
        top = max(top, 100 * base.max())
        axes.set_title(f"{condition.label}\n" * (len(shown) > 1) + f"{len(direction)} breakages", pad=8)
    for axes in grid[len(shown):]:
        axes.set_visible(False)
    ticks = [tick for tick in (1, 2, 5, 10, 20, 50) if tick <= top][-2:]
    for axes in grid:
        axes.set_ylim(0, 1.05 * top)
        axes.set_rticks(ticks, [f"{tick} %" for tick in ticks], fontsize=7.5, color=SOFT)
        axes.set_rlabel_position(22)
        axes.set_xticks(np.radians(range(0, 360, 45)), ["0°", "", "90°", "", "", "", "", ""], fontsize=7.5,
                        color=GREY)
        axes.tick_params(axis="x", pad=-2)
        axes.spines["polar"].set_visible(False)
    legend(figure, grid[0].get_legend_handles_labels()[0])
    return Drawn(figure, data, wide=len(shown) > 1)
