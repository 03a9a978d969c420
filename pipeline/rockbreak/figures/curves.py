"""Curves of one or of several runs against axial strain. Each function returns a figure, None without its data.

`runs` is a list of Results; a single run may show more (components, the paper's numbers) than a comparison.
"""
import numpy as np
from matplotlib.figure import Figure

from ..paper import numbers as paper
from ..run.history import running_mean, shear_rows, sin_phi
from ..sealed import open_sealed
from ..style import CYCLE, GREY, INK, LIGHT, LINES, ORANGE, SKY, curve_figure, thinned
from ..run.summary import SMOOTHING_WINDOW

FABRIC_FRAMES = 40  # frames at which anisotropies are fitted for a curve


def plot(axes, strain, values, **style):
    axes.plot(*thinned(100 * np.asarray(strain), np.asarray(values)), **style)


def finish(figure, axes, runs, legend=None, place="best"):
    axes.margins(x=0.01)
    axes.set_xlim(left=0)
    if legend or (legend is None and len(runs) > 1):
        axes.legend(loc=place)
    return figure


def each(runs):
    """Every run with the style of its line."""
    for index, run in enumerate(runs):
        yield run, {"color": CYCLE[index % len(CYCLE)], "linestyle": LINES[index % len(LINES)], "label": run.name}


def has(runs, *columns):
    return all(column in run.history and len(run.history[column]) > 1 for run in runs for column in columns)


def history_curve(runs, ylabel, column, scale=1.0):
    if not has(runs, column):
        return None
    figure, axes = curve_figure(ylabel=ylabel)
    for run, style in each(runs):
        plot(axes, run.history["axial_strain"], scale * run.history[column], **style)
    return finish(figure, axes, runs)


def deviator(runs):
    if not has(runs, "stress_yy", "stress_xx"):
        return None
    figure, axes = curve_figure(ylabel="deviator $\\sigma_{yy} - \\sigma_{xx}$ [MPa]")
    for run, style in each(runs):
        rows = run.history
        plot(axes, rows["axial_strain"], 1e-6 * (rows["stress_yy"] - rows["stress_xx"]), **style)
    axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
    return finish(figure, axes, runs)


def volumetric_strain(runs):
    figure = history_curve(runs, "volumetric strain [%]\n(compression positive)", "volumetric_strain", 100)
    if figure:
        figure.axes[0].axhline(0, color=GREY, linewidth=0.8)
    return figure


def friction_angle(runs):
    """sin(phi) of Eq. 12 as a running mean; for one run also the raw rows and Eq. 10 from the fabric of its frames."""
    if not has(runs, "stress_yy", "stress_xx"):
        return None
    figure, axes = curve_figure(ylabel="$\\sin\\varphi$ [-]")
    for run, style in each(runs):
        rows = shear_rows(run.history)
        strain, ratio = rows["axial_strain"], sin_phi(rows)
        if len(runs) == 1:
            plot(axes, strain, ratio, color=SKY, linewidth=0.7, alpha=0.7)
            style["label"] = "stresses (Eq. 12)"
        plot(axes, strain, running_mean(strain, ratio, SMOOTHING_WINDOW), **style)
        if len(runs) == 1:
            table = fabric_table(run)
            axes.plot(100 * table["axial_strain"], table["sin_phi"], "o", color=ORANGE, markersize=3.5,
                      label="anisotropies (Eq. 10)")
    axes.set_ylim(bottom=0)
    return finish(figure, axes, runs, legend=True)


def fabric_table(run):
    """Axial strain, a, a_n, a_t and Eq. 10 at up to FABRIC_FRAMES frames."""
    picked = np.unique(np.linspace(0, len(run.frames) - 1, FABRIC_FRAMES).round().astype(int))
    rows = [(run.frames[i]["axial_strain"], run.anisotropies(run.frames[i]["frame"])) for i in picked]
    rows = [(strain, f.a, f.a_n, f.a_t, f.sin_phi) for strain, f in rows if f]
    return dict(zip(("axial_strain", "a", "a_n", "a_t", "sin_phi"), np.array(rows).reshape(-1, 5).T))


def anisotropies(runs):
    figure, axes = curve_figure(ylabel="anisotropy [-]")
    names = (("a", "contact orientation $a$"), ("a_n", "normal force $a_n$"), ("a_t", "shear force $a_t$"))
    for index, run in enumerate(runs):
        table = fabric_table(run)
        for (key, label), color in zip(names, CYCLE):
            suffix = f", {run.name}" if len(runs) > 1 else ""
            axes.plot(100 * table["axial_strain"], table[key], color=color, linestyle=LINES[index % len(LINES)],
                      label=label + suffix)
    axes.set_ylim(bottom=0)
    finish(figure, axes, runs, legend=False)
    axes.legend(fontsize=7 if len(runs) > 1 else 8.5, ncol=1 if len(runs) == 1 else 2)
    return figure


def orientations(runs):
    """Polar histograms of the contact normals: of one run at its stages, of several at their peaks."""
    shown = ([(name, runs[0], k) for name, k in runs[0].stages] if len(runs) == 1
             else [(f"{run.name}, peak", run, run.stage_frame("peak")) for run in runs])
    figure = Figure(figsize=(5.4, 3.5), layout="constrained")
    axes = figure.add_subplot(projection="polar")
    edges = np.linspace(0, 2 * np.pi, 25)
    fine = np.linspace(0, 2 * np.pi, 361)
    for (label, run, k), color, line in zip(shown, CYCLE, LINES):
        with open_sealed(run.directory.frame_file(k)) as file:
            x, y = file["contacts/normal"][:][file["contacts/normal_force"][:] > 0].T
        fit = run.anisotropies(k)
        if fit is None:
            continue
        theta = np.arctan2(y, x)
        counts, _ = np.histogram(np.concatenate([theta, theta + np.pi]) % (2 * np.pi), bins=edges)
        share = counts / counts.mean()
        axes.plot(np.append(edges[:-1], edges[-1]), np.append(share, share[0]), drawstyle="steps-post", color=color,
                  linestyle=line, linewidth=1.1, label=label)
        axes.plot(fine, 1 + fit.a * np.cos(2 * (fine - fit.theta_0)), color=color, linewidth=0.8)
    axes.set_ylim(bottom=0)
    axes.set_rticks([0.5, 1.0, 1.5] if axes.get_ylim()[1] < 2 else [1.0, 2.0, 3.0])
    axes.set_rlabel_position(22)
    axes.legend(loc="center left", bbox_to_anchor=(1.1, 0.5))
    return figure


def paper_markers(axes, numbers, label, marker="D"):
    axes.plot([100 * s for s in numbers], list(numbers.values()), marker, color=INK, markerfacecolor="white",
              markersize=6, label=label, zorder=5, clip_on=False)


def particles(runs):
    """Number of particles; for one run also the particles that break in each percent of strain."""
    if not any(run.breakable for run in runs):
        return None
    figure, axes = curve_figure(ylabel="number of particles")
    for run, style in each(runs):
        strain = [row["axial_strain"] for row in run.frames]
        if len(runs) == 1:
            style["label"] = "this run"
            breakages(axes, run)
        axes.step(100 * np.array(strain), [row["particles"] for row in run.frames], where="post", **style)
    if any(run.breakable and paper.applies_to(run.case) for run in runs):
        paper_markers(axes, paper.PARTICLES_2MPA_BREAKABLE, "Raisianzadeh et al. (2019)")
    axes.ticklabel_format(style="plain", useOffset=False)
    return finish(figure, axes, runs, legend=True)


def breakages(axes, run):
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


def contacts(runs):
    figure, axes = curve_figure(ylabel="number of contacts")
    for run, style in each(runs):
        if len(runs) == 1:
            style["label"] = "this run"
        axes.plot([100 * row["axial_strain"] for row in run.frames], [row["contacts"] for row in run.frames], **style)
    shown = [run for run in runs if paper.applies_to(run.case)]
    for breakable in sorted({run.breakable for run in shown}):
        paper_markers(axes, paper.CONTACTS_2MPA[breakable],
                      "Raisianzadeh et al., " + ("breakable" if breakable else "non-breakable"),
                      "D" if breakable else "o")
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + (0.3 if shown or len(runs) > 1 else 0.0) * (high - low))  # room for the legend
    return finish(figure, axes, runs, legend=len(runs) > 1 or bool(shown), place="upper left")


def void_ratio(runs):
    kinds = [kind for kind in ("e1", "e2", "e4") if has(runs, f"void_ratio_{kind}")]
    if len(runs) > 1 or not kinds:
        return history_curve(runs, "void ratio [-]", "void_ratio")
    figure, axes = curve_figure(ylabel="void ratio [-]")
    for kind, color, line in zip(kinds, CYCLE, LINES):
        plot(axes, runs[0].history["axial_strain"], runs[0].history[f"void_ratio_{kind}"], color=color, linestyle=line,
             label=f"$e_{kind[1]}$")
    return finish(figure, axes, runs, legend=True)


def servo_error(runs):
    if not has(runs, "stress_xx"):
        return None
    figure, axes = curve_figure(ylabel="lateral stress error [%]")
    for run, style in each(runs):
        rows = shear_rows(run.history)
        pressure = run.summary["confining_pressure"]
        if pressure:
            plot(axes, rows["axial_strain"], 100 * (rows["stress_xx"] / pressure - 1), **{**style, "linewidth": 1.0})
    axes.axhline(0, color=GREY, linewidth=0.8)
    return finish(figure, axes, runs)


def unrest(runs):
    """Unbalanced force ratio, and for one run the inertial number beside it."""
    if not has(runs, "unbalanced_force"):
        return None
    figure, axes = curve_figure(ylabel="ratio [-]")
    for run, style in each(runs):
        rows = run.history
        if len(runs) == 1:
            style["label"] = "unbalanced force"
        plot(axes, rows["axial_strain"], rows["unbalanced_force"], **{**style, "linewidth": 1.0})
        if len(runs) == 1 and "inertial_number" in rows:
            plot(axes, rows["axial_strain"][1:], rows["inertial_number"][1:], color=ORANGE, linewidth=1.0,
                 label="inertial number")
    axes.set_yscale("log")
    return finish(figure, axes, runs, legend=True)


ENERGIES = (("friction_dissipation", "friction"), ("elastic_energy", "elastic, change"),
            ("damping_dissipation", "damping"), ("released_by_breakage", "released by breakage"),
            ("contact_law_work", "contact law"), ("kinetic_energy", "kinetic"))


def energy(runs):
    """The ledger of one run: boundary work against the sum of where it went."""
    run = runs[0]
    if len(runs) > 1 or not has(runs, "boundary_work"):
        return None
    figure, axes = curve_figure(ylabel="energy since the start of shear [MJ]")
    rows = run.history
    strain = rows["axial_strain"]
    plot(axes, strain, 1e-6 * rows["boundary_work"], color=INK, linewidth=2.2, label="boundary work")
    for (column, label), color, line in zip(ENERGIES, CYCLE, LINES):
        if column in rows:
            offset = rows[column][0] if column == "elastic_energy" else 0.0
            plot(axes, strain, 1e-6 * (rows[column] - offset), color=color, linestyle=line, label=label)
    if "energy_residual" in rows:
        plot(axes, strain, 1e-6 * rows["energy_residual"], color=GREY, linewidth=1.0, label="residual")
    finish(figure, axes, runs, legend=True)
    return figure


def phases(runs):
    """Wall time per phase, one bar for each run."""
    figure, axes = curve_figure(xlabel="wall time [s]")
    figure.set_size_inches(5.4, 1.6 + 0.5 * len(runs))
    left = np.zeros(len(runs))
    for phase, color in zip(("dem", "xfem", "handover", "report"), CYCLE):
        seconds = np.array([run.summary["wall_seconds"][phase] for run in runs])
        axes.barh(range(len(runs)), seconds, left=left, color=color, height=0.55,
                  label=f"{phase} {seconds[0]:.1f} s" if len(runs) == 1 else phase)
        left += seconds
    axes.set_yticks(range(len(runs)), [run.name for run in runs])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.legend(ncol=2 if len(runs) == 1 else 4, loc="upper center",
                bbox_to_anchor=(0.5, -0.3 if len(runs) > 2 else -0.45))
    return figure
