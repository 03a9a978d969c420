"""Pictures of an assembly: particles with force chains, and particles coloured by displacement."""
import matplotlib
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from ..sealed import open_sealed
from ..style import GREY, INK

# Weak forces must still be seen on white: the pale end of the map is left out.
FORCE_COLORS = ListedColormap(matplotlib.colormaps["inferno_r"](np.linspace(0.15, 0.95, 256)))
DISPLACEMENT_COLORS = ListedColormap(matplotlib.colormaps["viridis_r"](np.linspace(0.0, 0.85, 256)))


class Picture:
    """What a picture needs of one frame."""

    def __init__(self, path):
        with open_sealed(path) as file:
            self.strain = float(file.attrs["axial_strain"])
            particles, contacts = file["particles"], file["contacts"]
            self.position = particles["position"][:]
            self.boundary = particles["boundary"][:].astype(bool)
            self.fragment = particles["parent"][:] >= 0
            self.displacement = np.linalg.norm(particles["displacement"][:], axis=1)
            self.outlines = world_outlines(particles)
            index = {int(i): row for row, i in enumerate(particles["id"][:])}
            self.a = np.array([index[int(i)] for i in contacts["a"][:]], dtype=int)
            self.b = np.array([index[int(i)] for i in contacts["b"][:]], dtype=int)
            self.point = contacts["point"][:]
            self.normal_force = contacts["normal_force"][:]


def world_outlines(particles):
    """List of outlines (n x 2) [m]: position + R(angle) vertices."""
    offset = particles["vertex_offset"][:]
    vertices = particles["vertices"][:]
    position, angle = particles["position"][:], particles["angle"][:]
    count = np.diff(offset)
    c, s = np.repeat(np.cos(angle), count), np.repeat(np.sin(angle), count)
    x, y = vertices.T
    world = np.column_stack([c * x - s * y, s * x + c * y]) + np.repeat(position, count, axis=0)
    return [world[begin:end] for begin, end in zip(offset[:-1], offset[1:])]


def extent(pictures):
    """Common limits of several pictures, with a small margin."""
    points = np.vstack([outline for picture in pictures for outline in picture.outlines])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.02 * (high - low).max()
    return (low[0] - margin, high[0] + margin), (low[1] - margin, high[1] + margin)


def canvas(limits):
    (x0, x1), (y0, y1) = limits
    width = 3.9
    figure = Figure(figsize=(width, width * min(1.35, (y1 - y0) / (x1 - x0)) + 0.65), layout="constrained")
    axes = figure.add_subplot()
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal")
    axes.axis("off")
    return figure, axes


def force_chains(picture, limits, scale):
    """Lines from centroid to centroid over the contact point; width and colour by normal force, `scale` [N] the
    strongest shade."""
    figure, axes = canvas(limits)
    shades = np.where(picture.boundary[:, None], [[0.80, 0.83, 0.86]], [[0.93, 0.94, 0.95]])
    axes.add_collection(PolyCollection(picture.outlines, facecolors=shades, edgecolors="white", linewidths=0.3))
    order = np.argsort(picture.normal_force)
    order = order[picture.normal_force[order] > 0]
    lines = np.stack([picture.position[picture.a], picture.point, picture.position[picture.b]], axis=1)[order]
    force = picture.normal_force[order]
    # A line as wide as a third of a particle stands for the strongest force.
    points_per_metre = 72 * figure.get_size_inches()[0] / (limits[0][1] - limits[0][0])
    widest = 0.14 * points_per_metre
    chains = LineCollection(lines, linewidths=widest * np.clip(force / scale, 0.04, 1.5), array=force,
                            cmap=FORCE_COLORS, norm=Normalize(0, scale), capstyle="round", joinstyle="round")
    axes.add_collection(chains)
    color_bar(figure, axes, chains, "normal force [MN]", 1e-6)
    return figure


def displacements(picture, limits, scale):
    """Particles by the length of their displacement since the start of shear, `scale` [m] the darkest; fragments are
    black."""
    figure, axes = canvas(limits)
    particles = PolyCollection(picture.outlines, array=picture.displacement, cmap=DISPLACEMENT_COLORS,
                               norm=Normalize(0, max(scale, 1e-9)), edgecolors="white", linewidths=0.3)
    axes.add_collection(particles)
    fragments = [outline for outline, one in zip(picture.outlines, picture.fragment) if one]
    if fragments:
        axes.add_collection(PolyCollection(fragments, facecolors="black", edgecolors="white", linewidths=0.3))
    color_bar(figure, axes, particles, "displacement [m]" + (f"; {len(fragments)} fragments in black"
                                                             if fragments else ""), 1.0)
    return figure


def color_bar(figure, axes, mappable, label, factor):
    bar = figure.colorbar(mappable, ax=axes, orientation="horizontal", fraction=0.035, pad=0.02, aspect=35,
                          format=lambda value, _: f"{value * factor:.3g}")
    bar.outline.set_visible(False)
    bar.set_label(label, color=INK)
    bar.ax.tick_params(color=GREY)
