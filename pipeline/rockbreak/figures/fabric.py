"""Directions of contacts and forces (Figs. 9 to 11 against strain, Figs. 17 to 19 against pressure): polar histograms
with the fits of Eqs. 7 to 9. Of several seeds, histogram and fit are the means."""
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from . import frames
from .assemblies import MOST_ROWS, WIDTH
from .drawn import Columns, Drawn
from .selection import KINDS
from ..measures.fabric import polar_histogram
from ..style import GREY, INK, SOFT

BINS = 36  # of 10 degrees


class Rose:
    """One polar panel: a condition at one stage of its runs."""

    def __init__(self, row, column, condition, stage, color):
        self.row, self.column, self.color = row, column, color
        numbers = [run.stage_frame(stage) for run in condition.runs]
        self.fits = [run.anisotropies(k) for run, k in zip(condition.runs, numbers)]
        self.histograms = []
        for run, k in zip(condition.runs, numbers):
            frame = frames.frame_of(run, k)
            self.histograms.append(polar_histogram(frame.normal, frame.normal_force, frame.shear_force, BINS))

    def mean(self, name):
        """Mean over the runs of a number of the fit."""
        return float(np.mean([getattr(fit, name) for fit in self.fits]))


def at_stages(selection):
    """A row for each condition at the reference pressure, at the start, the peak and the end of its runs."""
    return [Rose(condition.label, stage, condition, stage, condition.style["color"])
            for condition in selection.reference.conditions[:MOST_ROWS] for stage in ("start", "peak", "end")]


def at_peak(selection):
    """A row for each kind, at rising pressures."""
    return [Rose(KINDS[kind], f"{1e-6 * pressure:g} MPa", selection.at(pressure, kind), "peak",
                 selection.at(pressure, kind).style["color"])
            for kind in selection.kinds for pressure in selection.pressures if selection.at(pressure, kind)]


def contact_orientation(roses):
    """Numbers of contacts; a contact counts in both its directions."""
    return polar_grid(roses, "contacts", lambda one: one.contacts.astype(float),
                      lambda fit, one, theta: one.contacts.sum() / BINS * 2 * np.pi * fit.orientation(theta), "a",
                      "{:g}")


def normal_forces(roses):
    return polar_grid(roses, "mean_normal_force_N", lambda one: one.mean_normal_force,
                      lambda fit, one, theta: fit.normal(theta), "a_n", "{:g} MN", 1e-6)


def shear_forces(roses):
    """Sizes of the mean shear forces; their signs alternate from quadrant to quadrant."""
    return polar_grid(roses, "mean_shear_force_N", lambda one: one.mean_shear_force,
                      lambda fit, one, theta: fit.shear(theta), "a_t", "{:g} MN", 1e-6)


def polar_grid(roses, name, bars_of, fit_of, anisotropy, unit, scale=1.0):
    """Panels on one scale: bars in the colour of the condition, the line of the fit, its anisotropy below."""
    if any(fit is None for rose in roses for fit in rose.fits):
        return None
    rows = list(dict.fromkeys(rose.row for rose in roses))
    columns = list(dict.fromkeys(rose.column for rose in roses))
    side = min(WIDTH / len(columns), 3.0)
    figure = Figure(figsize=(side * len(columns), (side + 0.2) * len(rows)), layout="constrained")
    figure.get_layout_engine().set(h_pad=0.09)
    grid = figure.subplots(len(rows), len(columns), squeeze=False, subplot_kw={"projection": "polar"})
    fine, data, top = np.linspace(0, 2 * np.pi, 361), Columns(), 0.0
    for panel in grid.ravel():
        panel.set_visible(False)
    for rose in roses:
        panel = grid[rows.index(rose.row), columns.index(rose.column)]
        panel.set_visible(True)
        centres = rose.histograms[0].centres
        bars = np.mean([np.nan_to_num(bars_of(one)) for one in rose.histograms], axis=0)
        line, at_bars = (np.mean([fit_of(fit, one, theta) for fit, one in zip(rose.fits, rose.histograms)], axis=0)
                         for theta in (fine, centres))
        panel.bar(centres, scale * np.abs(bars), width=2 * np.pi / BINS, color=rose.color, alpha=0.45,
                  edgecolor="white", linewidth=0.5)
        panel.plot(fine, scale * np.abs(line), color=INK, linewidth=1.2)
        top = max(top, scale * np.abs(bars).max(), scale * np.abs(line).max())
        symbol = anisotropy
        panel.set_xlabel(f"${symbol}$ = {rose.mean(anisotropy):.3f}", fontsize=9, color=SOFT, labelpad=2)
        if rows[0] == rose.row:
            panel.set_title(rose.column, pad=8)
        if columns[0] == rose.column and len(rows) > 1:
            panel.set_ylabel(rose.row, labelpad=24)
        data.add(row=rose.row, column=rose.column, direction_degrees=np.degrees(centres), **{name: bars},
                 **{f"{name}_fit": at_bars})
    ticks = [tick for tick in MaxNLocator(3).tick_values(0, top) if 0 < tick <= top * 1.02]
    for panel in grid.ravel():
        panel.set(ylim=(0, 1.05 * top or 1.0))
        panel.set_rticks(ticks, [""] * len(ticks))
        for tick in ticks:  # labels of an axis would lie below the bars
            panel.text(np.radians(22), tick, unit.format(tick), fontsize=7.5, color=INK, ha="center", va="center",
                       path_effects=[withStroke(linewidth=2, foreground="white")])
        panel.set_xticks(np.radians([0, 45, 90, 135, 180, 225, 270, 315]),
                         ["0°", "", "90°", "", "", "", "", ""], fontsize=7.5, color=GREY)
        panel.tick_params(axis="x", pad=-2)
        panel.spines["polar"].set_visible(False)
    return Drawn(figure, data, wide=True)
