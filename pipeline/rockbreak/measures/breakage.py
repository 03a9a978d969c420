"""Breakages of a run, one row for each broken particle; families and generations of fragments in one frame.

A split's breakages are those that `xfem` found in the frame of the same number; the next frame holds their fragments.
The final frame is analysed too, but its split is never applied: `Breakages.applied` tells.
"""
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np

from .frame import opened, read_frame, read_split
from .stresses import frame_stresses, line_angle, principal_stresses

AXIS = np.pi / 2  # the loading axis y, from x


@dataclass(frozen=True)
class Breakages:
    """M breakages in the order of frames. Directions are those of lines: in [0, pi), from x, world axes [rad]."""
    frame: np.ndarray            # M numbers
    axial_strain: np.ndarray     # M
    particle: np.ndarray         # M ids
    root: np.ndarray             # M ids of their originals
    generation: np.ndarray       # M; of the broken particle, 0: an original
    position: np.ndarray         # M x 2 centroids [m]
    area: np.ndarray             # M [m^2]
    pieces: np.ndarray           # M x 2 areas of the two fragments [m^2], the smaller one first
    ends: np.ndarray             # M x 2 x 2 of the breakage lines, world [m]
    mode: np.ndarray             # M; 0 none, 1 tension, 2 shear: where the crack began
    stress: np.ndarray           # M x 3 mean of the particle (xx, yy, xy) [Pa]
    applied: np.ndarray          # M bool; False in the final frame

    def __len__(self):
        return len(self.particle)

    @property
    def size_ratio(self):
        """M shares of the smaller fragment in the particle's area, at most 1/2."""
        return self.pieces[:, 0] / self.area

    @property
    def direction(self):
        """M directions of the breakage lines."""
        return line_direction(self.ends[:, 1] - self.ends[:, 0])

    @property
    def stress_direction(self):
        """M directions of the particles' major principal stress."""
        return principal_stresses(self.stress)[2]

    @property
    def angle_to_stress(self):
        """M angles between the breakage line and the particle's major stress [rad], 0 to pi/2."""
        return angle_between(self.direction, self.stress_direction)

    @property
    def angle_to_axis(self):
        """M angles between the breakage line and the loading axis y [rad], 0 to pi/2."""
        return angle_between(self.direction, AXIS)

    def chosen(self, mask):
        """Those of a mask or of rows."""
        return Breakages(*(getattr(self, field.name)[mask] for field in fields(self)))


def line_direction(vector):
    """Directions of lines along M x 2 vectors, in [0, pi) [rad]."""
    return line_angle(np.arctan2(vector[:, 1], vector[:, 0]))


def angle_between(one, other):
    """Angles between lines of two directions [rad], 0 to pi/2."""
    return np.abs((one - other + np.pi / 2) % np.pi - np.pi / 2)


def in_world(points, position, angle):
    """Points (M x 2) in the body axes of M particles at `position` (M x 2), turned by `angle` (M): world axes [m]."""
    c, s = np.cos(angle), np.sin(angle)
    return position + np.column_stack([c * points[:, 0] - s * points[:, 1], s * points[:, 0] + c * points[:, 1]])


def polygon_areas(vertices, offset):
    """N areas [m^2] of counter-clockwise outlines (V x 2, first rows N + 1)."""
    following = np.arange(1, len(vertices) + 1)
    following[offset[1:] - 1] = offset[:-1]
    x, y = vertices.T
    cross = x * y[following] - x[following] * y
    return 0.5 * np.add.reduceat(cross, offset[:-1]) if len(offset) > 1 else np.zeros(0)


def breakages_of(frame, split, final=False):
    """Breakages of one Split in the Frame that it answers."""
    row = frame.rows(split.broken)
    if (row < 0).any():
        raise ValueError(f"split {split.number} breaks particle {split.broken[row < 0][0]}, which frame {frame.number} "
                         "does not have; expected the split of this frame")
    of = np.searchsorted(split.id, split.broken)
    areas = polygon_areas(split.fragment_vertices, split.fragment_offset).reshape(-1, 2)
    stress = split.stress[of]
    unknown = ~np.isfinite(stress).all(axis=1)
    if unknown.any():
        stress[unknown] = frame_stresses(frame)[row[unknown]]
    position, angle = np.repeat(frame.position[row], 2, axis=0), np.repeat(frame.angle[row], 2)
    return Breakages(
        frame=np.full(len(row), frame.number), axial_strain=np.full(len(row), frame.axial_strain),
        particle=split.broken, root=frame.root[row], generation=frame.generation[row], position=frame.position[row],
        area=frame.area[row], pieces=np.sort(areas, axis=1),
        ends=in_world(split.path.reshape(-1, 2), position, angle).reshape(-1, 2, 2), mode=split.failure_mode[of],
        stress=stress, applied=np.full(len(row), not final))


def read_breakages(directory):
    """Breakages of a whole run: of `frames` and `splits` in a run directory (path). Empty without splits.

    Frames whose split breaks nothing are not read; splits whose frame is gone (an interrupted run) are left out.
    """
    directory = Path(directory)
    found = []
    for path in sorted((directory / "splits").glob("*.h5")):
        if not (directory / "frames" / path.name).exists():
            continue
        with opened(path) as file:
            split = read_split(file) if len(file["broken/parent"]) else None
        if split is not None:
            with opened(directory / "frames" / path.name) as file:
                found.append(breakages_of(read_frame(file), split, final=bool(file.attrs.get("final", 0))))
    if not found:
        shape = {"position": (0, 2), "pieces": (0, 2), "ends": (0, 2, 2), "stress": (0, 3)}
        whole = {"frame", "particle", "root", "generation", "mode", "applied"}
        return Breakages(**{field.name: np.zeros(shape.get(field.name, 0), dtype=int if field.name in whole else float)
                            for field in fields(Breakages)})
    return Breakages(*(np.concatenate([getattr(part, field.name) for part in found]) for field in fields(Breakages)))


def breakages_by_strain(breakages, edges):
    """Numbers of breakages between K + 1 axial strains, K; the last bin holds its upper edge."""
    return np.histogram(breakages.axial_strain, bins=edges)[0]


def direction_rose(direction, bins=18):
    """(edges [rad] from 0 to pi, share of the lines in each bin), `bins` + 1 and `bins`; to draw to both sides."""
    edges = np.linspace(0, np.pi, bins + 1)
    count = np.histogram(direction, bins=edges)[0]
    return edges, count / max(count.sum(), 1)


@dataclass(frozen=True)
class Generation:
    generation: int  # 0: unbroken originals
    particles: int
    area: float      # [m^2]
    area_share: float
    mean_size: float  # mean equivalent diameter [m]


def generations(frame):
    """List of Generation, every one from 0 to the latest in a Frame."""
    last = int(frame.generation.max(initial=0))
    count = np.bincount(frame.generation, minlength=last + 1)
    area = np.bincount(frame.generation, frame.area, minlength=last + 1)
    size = np.bincount(frame.generation, np.sqrt(4 * frame.area / np.pi), minlength=last + 1)
    return [Generation(k, int(count[k]), float(area[k]), float(area[k] / area.sum()),
                       float(size[k] / count[k]) if count[k] else np.nan) for k in range(last + 1)]


@dataclass(frozen=True)
class Families:
    """R originals and what became of them, by ascending id."""
    root: np.ndarray        # R ids
    members: np.ndarray     # R; 1: unbroken
    area: np.ndarray        # R [m^2] of all members
    largest: np.ndarray     # R [m^2] of the largest member
    generation: np.ndarray  # R; the latest in the family
    of: np.ndarray          # N rows in here: the family of each particle of the frame

    @property
    def broken(self):
        """R bool."""
        return self.members > 1

    @property
    def largest_share(self):
        """R shares of the original's area that the largest member has."""
        return self.largest / self.area


def families(frame):
    """Families of a Frame."""
    root, of = np.unique(frame.root, return_inverse=True)
    largest, latest = np.zeros(len(root)), np.zeros(len(root), dtype=int)
    np.maximum.at(largest, of, frame.area)
    np.maximum.at(latest, of, frame.generation)
    return Families(root, np.bincount(of), np.bincount(of, frame.area), largest, latest, of)


@dataclass(frozen=True)
class Cracks:
    """K cracks that have arrested within particles (or wait to grow), of one split."""
    particle: np.ndarray   # K rows of the Frame
    ends: np.ndarray       # K x 2 x 2 first and last point, world [m]
    length: np.ndarray     # K along the polyline [m]
    mode: np.ndarray       # K, as in Breakages
    direction: np.ndarray  # K of the chord, as in Breakages
    angle_to_stress: np.ndarray  # K


def arrested_cracks(frame, split):
    """Cracks of a Split in its Frame, without those that belong to its new fragments."""
    row = frame.rows(split.cracked)
    kept = np.flatnonzero(row >= 0)
    row, first, last = row[kept], split.crack_offset[kept], split.crack_offset[kept + 1] - 1
    step = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(split.crack_points, axis=0), axis=1))])
    ends = np.stack([in_world(split.crack_points[k], frame.position[row], frame.angle[row]) for k in (first, last)],
                    axis=1)
    of = np.searchsorted(split.id, frame.id[row])
    direction = line_direction(ends[:, 1] - ends[:, 0])
    return Cracks(row, ends, step[last] - step[first], split.failure_mode[of], direction,
                  angle_between(direction, principal_stresses(split.stress[of])[2]))
