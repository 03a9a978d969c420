"""Curves against axial strain: a line for each condition, of several seeds their mean with a band of one standard
deviation to either side. A single run may show more (components, the paper's numbers)."""
import numpy as np

from .drawn import Columns, Drawn
from .selection import KINDS
from ..paper import numbers as paper
from ..run.history import running_mean, shear_rows, sin_phi
from ..run.summary import SMOOTHING_WINDOW
from ..style import CYCLE, GREY, INK, LIGHT, LINES, SKY, curve_figure

POINTS = 400  # of a line
LOG_RATIO = 4  # of the largest to the smallest value of an axis, from which it is drawn logarithmically


def common_strains(runs, points):
    return np.linspace(0.0, min(run.frames[-1]["axial_strain"] for run in runs), points)


def band_of(condition, values_of, points=POINTS):
    """Axial strain, mean, standard deviation (None of one run); None if a run lacks the data.

    `values_of(run)` gives strains and values, or None.
    """
    found = [values_of(run) for run in condition.runs]
    if any(one is None or len(one[0]) < 2 for one in found):
        return None
    strain = common_strains(condition.runs, points)
    values = np.array([np.interp(strain, *one) for one in found])
    return strain, values.mean(axis=0), values.std(axis=0, ddof=1) if len(found) > 1 else None


def add_band(axes, band, style, label=None, scale=1.0):
    strain, mean, deviation = band
    axes.plot(100 * strain, scale * mean, label=label, **style)
    if deviation is not None:
        axes.fill_between(100 * strain, scale * (mean - deviation), scale * (mean + deviation), color=style["color"],
                          alpha=0.15, linewidth=0)


def add_rows(data, condition, band, name, **more):
    strain, mean, deviation = band
    data.add(condition=condition.label, **more, axial_strain=strain, **{name: mean},
             **({f"{name}_deviation": deviation} if deviation is not None else {}))


FEW = 4  # conditions whose legend finds a place between the curves


def finish(axes, selection, legend=None, bottom=None):
    axes.margins(x=0.01)
    axes.set_xlim(left=0)
    if bottom is not None:
        axes.set_ylim(bottom=bottom)
    if legend or (legend is None and len(selection.conditions) > 1):
        entries = len(axes.get_legend_handles_labels()[0])
        if entries > FEW:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), fontsize=7.5, ncols=min(4, -(-entries // 2)),
                        columnspacing=1.2, handlelength=2.2)
        else:
            axes.legend(loc="best", handlelength=2.4)


def scale_of_ticks(axes, ticks):
    """A tick at each value of an axis that has a few; logarithmic where they span a wide range."""
    if ticks and ticks[0] > 0 and ticks[-1] >= LOG_RATIO * ticks[0]:
        axes.set_xscale("log")
        axes.minorticks_off()
    slanted = {"rotation": 30, "fontsize": 8} if len(ticks) > 5 or any(len(f"{tick:g}") > 4 for tick in ticks) else {}
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks], **slanted)


def curve(selection, ylabel, name, values_of, scale=1.0, bottom=None, zero_line=False):
    """One line per condition; None if any lacks its data."""
    bands = [band_of(condition, values_of) for condition in selection.conditions]
    if any(band is None for band in bands):
        return None
    figure, axes = curve_figure(ylabel=ylabel)
    data = Columns()
    for condition, band in zip(selection.conditions, bands):
        add_band(axes, band, condition.line, condition.label, scale)
        add_rows(data, condition, band, name)
    if zero_line:
        axes.axhline(0, color=GREY, linewidth=0.8)
    finish(axes, selection, bottom=bottom)
    return Drawn(figure, data)


def column(name, scale=1.0):
    return lambda run: ((run.history["axial_strain"], scale * run.history[name]) if name in run.history else None)


def deviator(selection):
    def values(run):
        rows = run.history
        return (rows["axial_strain"], rows["stress_yy"] - rows["stress_xx"]) if "stress_yy" in rows else None
    return curve(selection, "deviator $\\sigma_{yy} - \\sigma_{xx}$ [MPa]", "deviator_Pa", values, 1e-6, bottom=0)


def volumetric_strain(selection):
    return curve(selection, "volumetric strain [%]", "volumetric_strain", column("volumetric_strain"), 100,
                 zero_line=True)


def smooth_friction(run):
    """sin(phi) of Eq. 12 as a running mean."""
    if "stress_yy" not in run.history or len(run.history["stress_yy"]) < 3:
        return None
    rows = shear_rows(run.history)
    return rows["axial_strain"], running_mean(rows["axial_strain"], sin_phi(rows), SMOOTHING_WINDOW)


def friction_angle(selection):
    drawn = curve(selection, "mobilized friction $\\sin\\varphi$ [-]", "sin_phi", smooth_friction, bottom=0)
    if drawn and selection.is_single:
        rows = shear_rows(selection.runs[0].history)
        axes = drawn.figure.axes[0]
        stride = max(1, len(rows["axial_strain"]) // 1500)
        axes.plot(100 * rows["axial_strain"][::stride], sin_phi(rows)[::stride], color=SKY, linewidth=0.6, alpha=0.7,
                  zorder=1, label="rows of the history")
        axes.lines[0].set_label("running mean over 0.2 %")
        axes.legend(loc="lower right")
    return drawn


def void_ratio(selection):
    run = selection.runs[0]
    kinds = [kind for kind in ("e1", "e2", "e4") if f"void_ratio_{kind}" in run.history]
    if not selection.is_single or not kinds:
        return curve(selection, "void ratio [-]", "void_ratio", column("void_ratio"))
    if len(run.frames) < 2:
        return None
    figure, axes = curve_figure(ylabel="void ratio [-]")
    data = Columns()
    for kind, color, line in zip(kinds, CYCLE, LINES):
        band = band_of(selection.conditions[0], column(f"void_ratio_{kind}"))
        if band:
            add_band(axes, band, {"color": color, "linestyle": line}, f"$e_{kind[1]}$")
            add_rows(data, selection.conditions[0], band, "void_ratio", definition=kind)
    finish(axes, selection, legend=True)
    return Drawn(figure, data)


def of_frames(key):
    return lambda run: (np.array([row["axial_strain"] for row in run.frames]),
                        np.array([row[key] for row in run.frames], dtype=float))


def paper_markers(axes, numbers, label, marker):
    axes.plot([100 * s for s in numbers], list(numbers.values()), marker, color=INK, markerfacecolor="white",
              markersize=5.5, linestyle="none", label=label, zorder=5, clip_on=False)


def contacts(selection):
    drawn = curve(selection, "number of contacts", "contacts", of_frames("contacts"))
    if drawn:
        axes = drawn.figure.axes[0]
        shown = {one.breakable for one in selection.conditions if paper.applies_to(one.first.case)}
        for kind in sorted(shown):
            paper_markers(axes, paper.CONTACTS_2MPA[kind], f"paper, {KINDS[kind]}", "D" if kind else "o")
        room_above(axes, 0.25 if shown or len(selection.conditions) > 1 else 0)
        finish(axes, selection, legend=len(selection.conditions) > 1 or bool(shown))
    return drawn


def room_above(axes, share):
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + share * (high - low))


def particles(selection):
    """Number of particles; for one run also the particles that break in each percent of strain."""
    bands = [(condition, band_of(condition, of_frames("particles"))) for condition in selection.breakable]
    if not bands or any(band is None for _, band in bands):
        return None
    figure, axes = curve_figure(ylabel="number of particles")
    data = Columns()
    for condition, band in bands:
        add_band(axes, band, condition.line, "this run" if selection.is_single else condition.label)
        add_rows(data, condition, band, "particles")
    if selection.is_single:
        breakages(axes, selection.runs[0])
    if any(paper.applies_to(one.first.case) for one in selection.breakable):
        paper_markers(axes, paper.PARTICLES_2MPA_BREAKABLE, "paper, breakable", "D")
    axes.ticklabel_format(style="plain", useOffset=False)
    finish(axes, selection, legend=True)
    return Drawn(figure, data)


def breakages(axes, run):
    """Bars behind the line: breakages in each percent of strain."""
    second = axes.twinx()
    strain = np.array([100 * row["axial_strain"] for row in run.frames])
    edges = np.arange(0, max(1, np.ceil(strain[-1] - 0.05)) + 1)
    counts, _ = np.histogram(np.minimum(strain, edges[-1]), bins=edges,
                             weights=[run.broken.get(row["frame"], 0) for row in run.frames])
    second.bar(edges[:-1] + 0.5, counts, width=0.8, color=LIGHT, zorder=0)
    second.set_ylabel("breakages per 1 % strain", color=GREY)
    second.set_ylim(0, max(4, 2.5 * counts.max()))
    second.grid(False)
    second.spines["right"].set_visible(False)
    axes.set_zorder(second.get_zorder() + 1)
    axes.patch.set_visible(False)
