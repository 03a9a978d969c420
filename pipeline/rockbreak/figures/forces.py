"""Probability densities of the normal contact forces (Fig. 7)."""
import numpy as np

from . import frames
from .drawn import Columns, Drawn
from .strength import panels
from ..measures.forces import force_distribution

BINS = 30


def force_pdf(selection):
    """A panel for each shown strain, on common bins and scales; of several seeds the mean density."""
    part = selection.reference
    strains = frames.shown_strains(part.runs)
    shown = {(condition, strain): [frames.frame_of(run, frames.frame_at(run, strain)).normal_force
                                   for run in condition.runs] for condition in part.conditions for strain in strains}
    forces = np.concatenate([one[one > 0] for runs in shown.values() for one in runs])
    if not len(forces):
        return None
    edges = np.linspace(0, 1e-6 * np.quantile(forces, 0.9995), BINS + 1)
    centres = 0.5 * (edges[1:] + edges[:-1])
    figure, grid = panels(len(strains), 3.0)
    data = Columns()
    for axes, strain in zip(grid, strains):
        for condition in part.conditions:
            density = np.mean([force_distribution(one, edges, scale=1e6).density for one in shown[condition, strain]],
                              axis=0)
            axes.stairs(density, edges, color=condition.style["color"], linestyle=condition.style["linestyle"],
                        linewidth=1.4, label=condition.label)
            data.add(condition=condition.label, axial_strain=strain, normal_force_MN=centres, density_per_MN=density)
        axes.set(title=f"{frames.percent(strain)} axial strain", xlabel="normal force [MN]", yscale="log",
                 xlim=(0, edges[-1]))
    low = min(axes.get_ylim()[0] for axes in grid)
    high = max(axes.get_ylim()[1] for axes in grid)
    for axes in grid:
        axes.set_ylim(low, high)
    grid[0].set_ylabel("probability density [1/MN]")
    if len(part.conditions) > 1:
        grid[0].legend(loc="upper right")
    return Drawn(figure, data, wide=True)
