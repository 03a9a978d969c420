"""Energy by kind, and how quasi-static and well controlled a test was."""
import numpy as np

from .curves import add_band, add_rows, band_of, column, curve, finish
from .drawn import Columns, Drawn
from ..measures.energy import energies
from ..run.history import shear_rows
from ..style import CYCLE, GREY, INK, LINES, ORANGE, curve_figure

LABELS = {"friction": "friction", "elastic": "elastic, change", "damping": "damping",
          "released_by_breakage": "released by breakage", "contact_law_work": "contact law",
          "kinetic": "kinetic, change", "contact_damping": "contact damping", "rolling": "rolling"}
HATCHES = ("", "///", "...", "xx", "\\\\", "++", "oo", "--")


def energy(selection):
    """The ledger of one run: what was put in, and where it went."""
    condition, found = selection.conditions[0], energies(selection.runs[0].history)
    if not selection.is_single or found is None or len(found.axial_strain) < 2:
        return None
    figure, axes = curve_figure(ylabel="energy since the start of shear [MJ]")
    data = Columns()
    shown = [(kind.replace("_", " "), values, {"color": INK, "linestyle": line, "linewidth": 2.2})
             for (kind, values), line in zip(found.inputs.items(), LINES)]
    shown += [(label, found.spent[kind], {"color": CYCLE[i % len(CYCLE)], "linestyle": LINES[i % len(LINES)]})
              for i, (kind, label) in enumerate(LABELS.items()) if kind in found.spent]
    shown += [("residual", found.residual, {"color": GREY, "linestyle": "-", "linewidth": 1.0})]
    for label, values, style in shown:
        band = band_of(condition, lambda run: (found.axial_strain, values))
        add_band(axes, band, style, label, 1e-6)
        add_rows(data, condition, band, "energy_J", kind=label)
    finish(axes, selection, legend=True)
    return Drawn(figure, data)


def energy_shares(selection):
    """Several conditions: where the energy had gone at the end, a bar each."""
    found = {run: energies(run.history) for run in selection.runs}
    if selection.is_single or None in found.values() or any(one.input[-1] == 0 for one in found.values()):
        return None
    shares = {run: one.normalised() for run, one in found.items()}
    figure, axes = bars(selection.conditions, "share of the work done on the assembly [%]")
    data, left = Columns(), np.zeros(len(selection.conditions))
    for i, (kind, label) in enumerate(LABELS.items()):
        values = np.array([np.mean([shares[run].spent[kind][-1] if kind in shares[run].spent else 0.0
                                    for run in one.runs]) for one in selection.conditions])
        if np.abs(values).max() < 1e-4:
            continue
        axes.barh(range(len(values)), 100 * values, left=100 * left, height=0.62, color=CYCLE[i % len(CYCLE)],
                  hatch=HATCHES[i], edgecolor="white", linewidth=0.5, label=label)
        data.add(condition=[one.label for one in selection.conditions], kind=label, share=values)
        left += values
    axes.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return Drawn(figure, data)


def bars(conditions, xlabel):
    """Axes with a horizontal bar for each condition."""
    figure, axes = curve_figure(xlabel=xlabel)
    figure.set_size_inches(5.4, max(2.0, 1.5 + 0.34 * len(conditions)))
    axes.set_yticks(range(len(conditions)), [one.label for one in conditions])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    return figure, axes


def servo_error(selection):
    def values(run):
        if "stress_xx" not in run.history or not run.summary["confining_pressure"]:
            return None
        rows = shear_rows(run.history)
        return rows["axial_strain"], rows["stress_xx"] / run.summary["confining_pressure"] - 1
    return curve(selection, "lateral stress error [%]", "lateral_stress_error", values, 100, zero_line=True)


def unrest(selection):
    """Unbalanced force ratio, and for one run the inertial number beside it."""
    drawn = curve(selection, "unbalanced force ratio [-]", "unbalanced_force", column("unbalanced_force"))
    if drawn is None:
        return None
    axes = drawn.figure.axes[0]
    rows = selection.runs[0].history
    if selection.is_single and "inertial_number" in rows:
        condition = selection.conditions[0]
        band = band_of(condition, lambda run: (rows["axial_strain"][1:], rows["inertial_number"][1:]))
        axes.lines[0].set_label("unbalanced force")
        add_band(axes, band, {"color": ORANGE, "linestyle": "-"}, "inertial number")
        add_rows(drawn.data, condition, band, "inertial_number")
        axes.set_ylabel("ratio [-]")
        axes.legend()
    axes.set_yscale("log")
    return drawn


def phases(selection):
    """Wall time per phase, one bar for each condition (the mean over its seeds)."""
    conditions = selection.conditions
    figure, axes = bars(conditions, "wall time [s]")
    left, data = np.zeros(len(conditions)), Columns()
    for phase, color, hatch in zip(("dem", "xfem", "handover", "report"), CYCLE, HATCHES):
        seconds = np.array([np.mean([run.summary["wall_seconds"][phase] for run in one.runs]) for one in conditions])
        axes.barh(range(len(conditions)), seconds, left=left, color=color, hatch=hatch, height=0.62, edgecolor="white",
                  linewidth=0.5, label=f"{phase} {seconds[0]:.1f} s" if len(conditions) == 1 else phase)
        data.add(condition=[one.label for one in conditions], phase=phase, wall_seconds=seconds)
        left += seconds
    axes.legend(ncols=4 if len(conditions) > 1 else 2, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    return Drawn(figure, data)
