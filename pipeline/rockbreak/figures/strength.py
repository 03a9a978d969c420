"""Anisotropies and the friction that follows from them, against strain and pressure (Figs. 12, 13, 20 to 22)."""
from functools import lru_cache

import numpy as np
from matplotlib.figure import Figure

from .assemblies import WIDTH
from .curves import add_band, add_rows, band_of, finish, scale_of_ticks, smooth_friction
from .drawn import Columns, Drawn
from .selection import KIND_COLORS, KIND_LINES, KIND_MARKERS, KINDS
from ..style import GREEN, INK, LINES, ORANGE, PURPLE, curve_figure

FITTED_FRAMES = 60  # at most, of one curve
MARKS = 25          # of Eq. 10 beside a line
ANISOTROPIES = (("a", "$a$", "contact orientation"), ("a_n", "$a_n$", "normal forces"),
                ("a_t", "$a_t$", "shear forces"), ("total", "$a + a_n + a_t$", "total"))


@lru_cache(maxsize=256)
def fabric_table(run):
    """Axial strain, a, a_n, a_t, their sum, Eq. 10 and Eq. 11 at up to FITTED_FRAMES frames; None without contacts."""
    picked = np.unique(np.linspace(0, len(run.frames) - 1, FITTED_FRAMES).round().astype(int))
    rows = []
    for i in picked:
        fit = run.anisotropies(run.frames[i]["frame"])
        if fit:
            rows.append((run.frames[i]["axial_strain"], fit.a, fit.a_n, fit.a_t, fit.sum, fit.sin_phi,
                         fit.sin_phi_simplified))
    names = ("axial_strain", "a", "a_n", "a_t", "total", "eq_10", "eq_11")
    return dict(zip(names, np.array(rows).T)) if len(rows) > 1 else None


def of_fabric(name):
    def values(run):
        table = fabric_table(run)
        return None if table is None else (table["axial_strain"], table[name])
    return values


def panels(count, height=2.9):
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    return figure, figure.subplots(1, count, squeeze=False)[0]


def anisotropies(selection):
    """Fig. 12: one panel each; of one run a line each."""
    part = selection.reference
    if selection.is_single:
        figure, axes = curve_figure(ylabel="anisotropy [-]")
        shown = [axes] * 4
    else:
        figure, shown = panels(4)
    data = Columns()
    for index, ((name, symbol, title), axes) in enumerate(zip(ANISOTROPIES, shown)):
        for condition in part.conditions:
            band = band_of(condition, of_fabric(name), FITTED_FRAMES)
            if band is None:
                return None
            style = ({"color": (GREEN, PURPLE, ORANGE, INK)[index], "linestyle": LINES[index]} if selection.is_single
                     else condition.line)
            add_band(axes, band, style, f"{title} {symbol}" if selection.is_single else condition.label)
            add_rows(data, condition, band, "value", anisotropy=name)
        if not selection.is_single:
            axes.set(title=f"{title} {symbol}", xlabel="axial strain [%]")
    for index, axes in enumerate(shown):
        finish(axes, part, legend=index == 0 and len(part.conditions) > 1, bottom=0)
    if selection.is_single:
        axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    return Drawn(figure, data, wide=not selection.is_single)


MICRO = (("eq_10", "anisotropies, Eq. 10", GREEN, "-."), ("eq_11", "simplified, Eq. 11", PURPLE, (0, (1, 1.2))))


def stress_and_fabric(selection):
    """Fig. 13: a panel for each condition, with the friction from stresses, from Eq. 10 and from Eq. 11."""
    part = selection.reference
    conditions = part.conditions
    if len(conditions) == 1:
        figure, axes = curve_figure(ylabel="$\\sin\\varphi$ [-]")
        shown = [axes]
    else:
        figure, shown = panels(len(conditions), 3.4)
        shown[0].set_ylabel("$\\sin\\varphi$ [-]")
    data = Columns()
    for condition, axes in zip(conditions, shown):
        bands = [band_of(condition, smooth_friction),
                 *(band_of(condition, of_fabric(name), FITTED_FRAMES) for name, _, _, _ in MICRO)]
        if any(band is None for band in bands):
            return None
        add_band(axes, bands[0], {**condition.line, "linestyle": "-"}, "stresses, Eq. 12")
        add_rows(data, condition, bands[0], "sin_phi", source="stresses")
        for band, (name, label, color, line) in zip(bands[1:], MICRO):
            add_band(axes, band, {"color": color, "linestyle": line}, label)
            add_rows(data, condition, band, "sin_phi", source=name)
        if len(conditions) > 1:
            axes.set(title=condition.label, xlabel="axial strain [%]")
    same_height(shown)
    for axes in shown:
        finish(axes, part, legend=axes is shown[0], bottom=0)
    return Drawn(figure, data, wide=len(conditions) > 1)


def same_height(shown):
    top = max(axes.get_ylim()[1] for axes in shown)
    for axes in shown:
        axes.set_ylim(0, top)


def anisotropies_by_pressure(selection):
    """Fig. 20: a row for each kind, a column for each anisotropy, a line for each pressure."""
    kinds = selection.kinds
    figure = Figure(figsize=(WIDTH, 2.6 * len(kinds) + 0.2), layout="constrained")
    grid = figure.subplots(len(kinds), 4, squeeze=False, sharex=True, sharey="col")
    data = Columns()
    for axes, (_, symbol, title) in zip(grid[0], ANISOTROPIES):
        axes.set_title(f"{title} {symbol}")
    for axes in grid[-1]:
        axes.set_xlabel("axial strain [%]")
    for row, kind in zip(grid, kinds):
        for axes, (name, _, _) in zip(row, ANISOTROPIES):
            for pressure in selection.pressures:
                condition = selection.at(pressure, kind)
                band = condition and band_of(condition, of_fabric(name), FITTED_FRAMES)
                if band:
                    style = {"color": condition.style["color"],
                             "linestyle": LINES[selection.pressures.index(pressure) % len(LINES)]}
                    add_band(axes, band, style, f"{1e-6 * pressure:g} MPa")
                    add_rows(data, condition, band, "value", anisotropy=name)
            axes.margins(x=0.01)
            axes.set_ylim(bottom=0)
            axes.set_xlim(left=0)
        row[0].set_ylabel(KINDS[kind])
    grid[0][0].legend(loc="lower right", fontsize=7.5, ncols=2)
    return Drawn(figure, data, wide=True)


def stress_and_fabric_by_pressure(selection):
    """Fig. 21: a panel for each pressure; lines from stresses, marks from Eq. 10."""
    pressures = selection.pressures
    figure, shown = panels(len(pressures), 3.1)
    data = Columns()
    for axes, pressure in zip(shown, pressures):
        for kind in selection.kinds:
            condition = selection.at(pressure, kind)
            if condition is None:
                continue
            color = KIND_COLORS[kind]
            stress, micro = band_of(condition, smooth_friction), band_of(condition, of_fabric("eq_10"), MARKS)
            if stress is None or micro is None:
                return None
            add_band(axes, stress, {"color": color, "linestyle": KIND_LINES[kind]}, f"{KINDS[kind]}, stresses")
            axes.plot(100 * micro[0], micro[1], KIND_MARKERS[kind], color=color, markersize=3.2,
                      markerfacecolor="white", markeredgewidth=0.9, linestyle="none", label=f"{KINDS[kind]}, Eq. 10")
            add_rows(data, condition, stress, "sin_phi", source="stresses")
            add_rows(data, condition, micro, "sin_phi", source="eq_10")
        axes.set(title=f"{1e-6 * pressure:g} MPa", xlabel="axial strain [%]")
    same_height(shown)
    for axes in shown:
        axes.margins(x=0.01)
        axes.set_xlim(left=0)
    shown[0].set_ylabel("$\\sin\\varphi$ [-]")
    shown[0].legend(loc="lower right", fontsize=7.5)
    return Drawn(figure, data, wide=True)


def peak_friction(selection):
    """Fig. 22: the peak friction angle against pressure, from stresses and from Eq. 10."""
    figure, axes = curve_figure(xlabel="confining pressure [MPa]", ylabel="peak friction angle $\\varphi$ [°]")
    data = Columns()
    for kind in selection.kinds:
        conditions = [one for one in selection.conditions if one.breakable == kind and one.pressure is not None]
        for key, label, hollow, line in (("peak_sin_phi", "stresses", False, KIND_LINES[kind]),
                                         ("sin_phi_micro_peak", "Eq. 10", True, ":")):
            points = [(one, np.degrees(np.arcsin([run.summary[key] for run in one.runs])))
                      for one in conditions if all(run.summary[key] is not None for run in one.runs)]
            if not points:
                continue
            x = np.array([1e-6 * one.pressure for one, _ in points])
            mean = np.array([values.mean() for _, values in points])
            spread = np.array([values.std(ddof=1) if len(values) > 1 else np.nan for _, values in points])
            axes.errorbar(x, mean, np.nan_to_num(spread) if selection.has_seeds else None, color=KIND_COLORS[kind],
                          linestyle=line, marker=KIND_MARKERS[kind], markersize=5.5, capsize=3, linewidth=1.3,
                          markerfacecolor="white" if hollow else KIND_COLORS[kind], label=f"{KINDS[kind]}, {label}")
            data.add(kind=KINDS[kind], source=label, pressure_Pa=1e6 * x, peak_friction_angle_degrees=mean,
                     deviation=spread, runs=[len(values) for _, values in points])
    pressure_axis(axes, selection)
    axes.legend(loc="best")
    return Drawn(figure, data) if len(data) else None


def pressure_axis(axes, selection):
    """A tick at each pressure [MPa]."""
    scale_of_ticks(axes, [1e-6 * pressure for pressure in selection.pressures])
