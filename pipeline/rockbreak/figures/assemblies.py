"""Pictures of assemblies side by side: displacements, force chains and particle stresses in classes (Figs. 3 to 6
against strain, Figs. 14 to 16 against pressure). A row for each condition, on one scale; of seeds the lowest."""
import matplotlib
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator

from . import frames
from .drawn import Columns, Drawn
from .selection import KINDS
from ..measures.classes import STRESS_LIMITS, STRONG_FORCE, WEAK_FORCE
from ..measures.stresses import class_of, frame_stresses
from ..style import CLASS_COLORS, GREY, INK, SOFT

SHADES = 20  # at most, of a displacement: particles of one shade are one path, so that ten thousand are a small file
MOST_ROWS = 4  # of a figure
WIDTH = 11.0   # [in]
CLASS_WIDTHS = (0.35, 1.0, 2.0)  # lines of weak, moderate and strong forces, against the usual width


class Panel:
    def __init__(self, row, column, run, k):
        self.row, self.column, self.run, self.k = row, column, run, k

    @property
    def frame(self):
        return frames.frame_of(self.run, self.k)


def against_strain(selection):
    """Panels at the shown strains, a row for each condition at the reference pressure."""
    conditions = selection.reference.conditions[:MOST_ROWS]
    panels = []
    for condition in conditions:
        for strain in frames.shown_strains([one.first for one in conditions]):
            panels.append(Panel(condition.label, f"{frames.percent(strain)} axial strain", condition.first,
                                frames.frame_at(condition.first, strain)))
    return panels


def against_pressure(selection, stage):
    """Panels at rising pressures, a row for each kind, at a stage of each run."""
    panels = []
    for kind in selection.kinds:
        for pressure in selection.pressures:
            condition = selection.at(pressure, kind)
            if condition:
                panels.append(Panel(KINDS[kind], f"{1e-6 * pressure:g} MPa", condition.first,
                                    condition.first.stage_frame(stage)))
    return panels


def displacements(panels):
    data, largest = Columns(), max(lengths(panel.frame).max() for panel in panels)
    limits = MaxNLocator(SHADES, steps=(1, 2, 5, 10)).tick_values(0, largest or 1.0)
    norm = BoundaryNorm(limits, len(limits) - 1)
    shades = ListedColormap(matplotlib.colormaps["viridis_r"](np.linspace(0.0, 0.9, len(limits) - 1)))

    def draw(axes, panel):
        s = panel.frame
        length, fragment = lengths(s), s.generation > 0
        shade = np.where(fragment, shades.N, np.clip(norm(length), 0, shades.N - 1))
        add_particles(axes, s, shade, [*shades.colors, "black"])
        data.add(**place(panel), particle=s.id, x_m=s.position[:, 0], y_m=s.position[:, 1],
                 displacement_m=length, generation=s.generation)
        return f"up to {length.max():.2f} m" + (f"; {fragment.sum()} fragments" if fragment.any() else "")

    figure = grid(panels, draw)
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm, shades), ax=figure.axes, aspect=60, ticks=limits[::2],
                          location="bottom", fraction=0.03, pad=0.02, shrink=0.5)
    bar.outline.set_visible(False)
    bar.ax.tick_params(color=GREY, labelsize=8.5)
    bar.minorticks_off()
    bar.set_label("displacement since the start of shear [m]" + (
        "; fragments are black" if any((panel.frame.generation > 0).any() for panel in panels) else ""), color=INK)
    return Drawn(figure, data, wide=True)


def force_chains(panels):
    data = Columns()

    def draw(axes, panel):
        s = panel.frame
        add_particles(axes, s, s.boundary.astype(int), ("#f3f4f6", "#dfe3e8"))
        loaded = s.normal_force > 0
        kind = class_of(s.normal_force, WEAK_FORCE, STRONG_FORCE)
        lines = np.stack([s.position[s.a], s.point, s.position[s.b]], axis=1)
        usual = points_per_metre(axes) * 0.05
        for level in range(3):
            axes.add_artist(PathPatch(joined(lines[loaded & (kind == level)], closed=False), fill=False,
                                     edgecolor=CLASS_COLORS[level], linewidth=usual * CLASS_WIDTHS[level],
                                     capstyle="round", joinstyle="round", clip_on=False))
        data.add(**place(panel), particle_a=s.id[s.a], particle_b=s.id[s.b], x_m=s.point[:, 0], y_m=s.point[:, 1],
                 normal_force_N=s.normal_force, force_class=kind)
        return tally(kind[loaded])

    figure = grid(panels, draw)
    weak, strong = 1e-6 * WEAK_FORCE, 1e-6 * STRONG_FORCE
    labels = (f"weak, below {weak:g} MN", f"moderate, {weak:g} to {strong:g} MN", f"strong, above {strong:g} MN")
    legend(figure, [Line2D([], [], color=color, linewidth=3 * width, label=label)
                    for color, width, label in zip(CLASS_COLORS, CLASS_WIDTHS, labels)])
    return Drawn(figure, data, wide=True)


def stresses(panels, component):
    """Mean particle stresses in three classes; component 1 is vertical, 0 horizontal."""
    low, high = STRESS_LIMITS["virial"]
    data = Columns()

    def draw(axes, panel):
        s = panel.frame
        stress = frame_stresses(s)[:, component]
        kind = class_of(stress, low, high)
        add_particles(axes, s, kind, CLASS_COLORS)
        data.add(**place(panel), particle=s.id, x_m=s.position[:, 0], y_m=s.position[:, 1], stress_Pa=stress,
                 stress_class=kind)
        return tally(kind)

    figure = grid(panels, draw)
    low, high = 1e-6 * low, 1e-6 * high
    labels = (f"low, below {low:g} MPa", f"medium, {low:g} to {high:g} MPa", f"high, above {high:g} MPa")
    legend(figure, [Patch(facecolor=color, label=label) for color, label in zip(CLASS_COLORS, labels)])
    return Drawn(figure, data, wide=True)


def vertical_stresses(panels):
    return stresses(panels, 1)


def horizontal_stresses(panels):
    return stresses(panels, 0)


# -- panels

def place(panel):
    return {"row": panel.row, "column": panel.column, "frame": panel.k, "axial_strain": panel.frame.axial_strain}


def lengths(frame):
    """Displacement of each particle since the start of shear [m]."""
    return np.linalg.norm(frame.displacement, axis=1)


def tally(kind):
    """How many there are of each class."""
    return " / ".join(str(count) for count in np.bincount(kind, minlength=3))


def extent(shown):
    """Common limits of several pictures, with a small margin."""
    points = np.vstack([one.vertices for one in shown])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.015 * (high - low).max()
    return (low[0] - margin, high[0] + margin), (low[1] - margin, high[1] + margin)


def grid(panels, draw):
    """A figure with a panel each; `draw(axes, panel)` fills it and returns the line of text below."""
    rows = list(dict.fromkeys(panel.row for panel in panels))
    columns = list(dict.fromkeys(panel.column for panel in panels))
    (x0, x1), (y0, y1) = limits = extent([panel.frame for panel in panels])
    side = WIDTH / max(3, len(columns))
    figure = Figure(figsize=(side * len(columns), len(rows) * (side * (y1 - y0) / (x1 - x0) + 0.25) + 0.75),
                    layout="constrained")
    figure.get_layout_engine().set(w_pad=0.02, h_pad=0.02, wspace=0.0, hspace=0.01)
    for axes in figure.subplots(len(rows), len(columns), squeeze=False).ravel():
        axes.set(xlim=limits[0], ylim=limits[1], aspect="equal", xticks=[], yticks=[])
        axes.grid(False)
        axes.spines[:].set_visible(False)
    for panel in panels:
        row, column = rows.index(panel.row), columns.index(panel.column)
        axes = figure.axes[row * len(columns) + column]
        below = draw(axes, panel)
        axes.set_xlabel(below, fontsize=8, color=SOFT, labelpad=1)
        if row == 0:
            axes.set_title(panel.column, fontsize=9.5, pad=4)
        if column == 0 and len(rows) > 1:
            axes.set_ylabel(panel.row, fontsize=10)
    return figure


def add_particles(axes, s, kind, colors):
    """Outlines filled with the colour of their kind, 0, 1, ... (add_patch would walk along each path for its limits)"""
    outlines = s.outlines
    for level in np.unique(kind):
        axes.add_artist(PathPatch(joined([outlines[i] for i in np.flatnonzero(kind == level)], closed=True),
                                 facecolor=colors[level], edgecolor="white", linewidth=0.2, clip_on=False))


def joined(lines, closed):
    """One path of many polygons or polylines (n x 2)."""
    if not len(lines):
        return Path(np.zeros((0, 2)))
    vertices, codes = [], []
    for line in lines:
        vertices += [line, line[:1]] if closed else [line]
        codes += [Path.MOVETO] + [Path.LINETO] * (len(line) - 1) + [Path.CLOSEPOLY] * closed
    return Path(np.concatenate(vertices), codes)


def points_per_metre(axes):
    low, high = axes.get_xlim()
    columns = axes.get_subplotspec().get_gridspec().ncols
    return 72 * axes.figure.get_size_inches()[0] / columns / (high - low)


def legend(figure, handles):
    """Below all panels."""
    room = 0.32 / figure.get_size_inches()[1]
    figure.get_layout_engine().set(rect=(0, room, 1, 1 - room))
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), fontsize=9, handlelength=1.6)
