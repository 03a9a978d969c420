"""How much has broken: gradations, breakage indices against strain and against pressure, generations of fragments."""
from functools import lru_cache

import numpy as np

from . import frames
from .curves import add_band, add_rows, band_of, finish
from .drawn import Columns, Drawn
from .energy import bars
from .selection import KIND_COLORS, KIND_MARKERS
from .strength import panels, pressure_axis
from ..measures.breakage import generations
from ..measures.gradation import frame_gradation, hardin, marsal, smallest_piece, standard_sieves
from ..style import GENERATION_COLORS, LINES, curve_figure, sequence

INDEXED_FRAMES = 40  # at most, of one curve


def gradations(selection):
    """Of one condition at the shown strains; of several, all at the end."""
    figure, axes = curve_figure(xlabel="equivalent diameter $\\sqrt{4A/\\pi}$ [m]", ylabel="finer by mass [%]")
    data = Columns()
    if not selection.breakable:
        return None
    if len(selection.conditions) == 1:
        run = selection.conditions[0].first
        strains = frames.shown_strains([run])
        shown = [(f"{frames.percent(strain)} strain", run, frames.frame_at(run, strain),
                  {"color": color, "linestyle": line})
                 for strain, color, line in zip(strains, sequence(len(strains)), LINES)]
    else:
        shown = [(one.label, one.first, one.first.stage_frame("end"), one.line) for one in selection.breakable]
        start = selection.breakable[0].first
        shown.insert(0, ("before shear", start, start.frames[0]["frame"], {"color": "black", "linestyle": ":"}))
    for label, run, k, style in shown:
        curve = frame_gradation(frames.frame_of(run, k))
        axes.step(curve.size, 100 * curve.passing, where="post", label=label, **style)
        data.add(curve=label, size_m=curve.size, finer_by_mass=curve.passing)
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    ticks = [tick for tick in (0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.7, 1.0) if low <= tick <= high]
    axes.minorticks_off()
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_ylim(0, 101)
    axes.legend(loc="upper left", fontsize=7.5 if len(shown) > 5 else 8.5)
    return Drawn(figure, data)


@lru_cache(maxsize=256)
def breakage_table(run):
    """Axial strain, Marsal's and Hardin's indices, share of mass in fragments, at up to INDEXED_FRAMES frames."""
    limit = smallest_piece(run.case) if "minimum_area" in (run.case.get("breakage") or {}) else None
    before = frame_gradation(frames.frame_of(run, run.frames[0]["frame"]))
    sieves = standard_sieves(limit or before.size[0] / 3, before.size[-1])
    rows = []
    for i in np.unique(np.linspace(0, len(run.frames) - 1, INDEXED_FRAMES).round().astype(int)):
        frame = frames.frame_of(run, run.frames[i]["frame"])
        after = frame_gradation(frame)
        rows.append((run.frames[i]["axial_strain"], marsal(before, after, sieves),
                     hardin(before, after, limit or before.size[0] / 3),
                     frame.area[frame.generation > 0].sum() / frame.area.sum()))
    return dict(zip(("axial_strain", "marsal", "hardin", "fragments"), np.array(rows).T))


INDICES = (("fragments", "mass in fragments [%]", 100), ("marsal", "Marsal's $B_g$ [%]", 100),
           ("hardin", "Hardin's $B_r$ [%]", 100))


def breakage_against_strain(selection):
    if not selection.breakable:
        return None
    figure, shown = panels(len(INDICES))
    data = Columns()
    for (name, label, scale), axes in zip(INDICES, shown):
        for condition in selection.breakable:
            band = band_of(condition, lambda run: (breakage_table(run)["axial_strain"], breakage_table(run)[name]),
                           INDEXED_FRAMES)
            if band is None:
                return None
            add_band(axes, band, condition.line, condition.label, scale)
            add_rows(data, condition, band, "value", measure=name)
        axes.set(xlabel="axial strain [%]", ylabel=label)
        finish(axes, selection, legend=axes is shown[0] and len(selection.breakable) > 1, bottom=0)
    return Drawn(figure, data, wide=True)


def breakage_by_pressure(selection):
    """What had broken at the end of each run, a mark for each, and the lines of their means."""
    if len({one.pressure for one in selection.breakable}) < 2:
        return None
    measures = [("broken", "breakages / particles [%]", 100)] + list(INDICES)
    figure, shown = panels(len(measures))
    data = Columns()
    for (name, label, scale), axes in zip(measures, shown):
        points = [(one.pressure, np.array([at_end(run, name) for run in one.runs])) for one in selection.breakable]
        x = 1e-6 * np.array([pressure for pressure, _ in points])
        mean = np.array([values.mean() for _, values in points])
        axes.plot(x, scale * mean, color=KIND_COLORS[True], linestyle="-")
        for pressure, values in points:
            axes.plot([1e-6 * pressure] * len(values), scale * values, KIND_MARKERS[True], color=KIND_COLORS[True],
                      markersize=4.5, markerfacecolor="white" if len(values) > 1 else KIND_COLORS[True])
            data.add(measure=name, pressure_Pa=pressure, value=values)
        pressure_axis(axes, selection)
        axes.set(xlabel="confining pressure [MPa]", ylabel=label)
        axes.set_ylim(bottom=0)
    return Drawn(figure, data, wide=True)


def at_end(run, name):
    if name == "broken":
        return run.summary["broken_total"] / run.summary["particles_initial"]
    return breakage_table(run)[name][-1]


def fragments_by_generation(selection):
    """Number and mass of the fragments at the end, by how often they have broken."""
    if not selection.breakable:
        return None
    conditions = selection.breakable
    figure, axes = bars(conditions, "share of the mass [%]")
    data, left = Columns(), np.zeros(len(conditions))
    found = [generations(frames.frame_of(one.first, one.first.stage_frame("end"))) for one in conditions]
    last = max(len(one) for one in found)
    for k in range(last):
        shares = np.array([one[k].area_share if k < len(one) else 0.0 for one in found])
        counts = [one[k].particles if k < len(one) else 0 for one in found]
        label = ("unbroken" if k == 0 else f"generation {k}") + (f": {counts[0]}" if len(conditions) == 1 else "")
        axes.barh(range(len(conditions)), 100 * shares, left=100 * left, height=0.62, label=label,
                  color=GENERATION_COLORS[min(k, len(GENERATION_COLORS) - 1)], edgecolor="white", linewidth=0.5)
        data.add(condition=[one.label for one in conditions], generation=k, particles=counts, share_of_mass=shares)
        left += shares
    axes.set_xlim(0, 100)
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return Drawn(figure, data)
