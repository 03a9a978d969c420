"""Frames and splits as plain arrays: what the other modules of this folder take.

    frame = read_frame("runs/demo/frames/000040.h5")
    frame.position, frame.normal_force, frame.a       # N x 2 [m], C [N], C rows of the contacts' first particles

Contacts name their particles by row, not by id: `frame.position[frame.b] - frame.position[frame.a]` are branch vectors.
Stress is positive in compression throughout, forces are those on particle b, outlines are in world axes.
"""
from contextlib import nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import h5py
import numpy as np

from ..errors import BAD_INPUT, RockbreakError
from ..sealed import open_sealed

STATUS = ("screened", "intact", "arrested", "broken", "not_breakable", "refused")  # of a particle in a split, by number
MODES = ("none", "tension", "shear")                                               # failure_mode, by number


@dataclass(frozen=True)
class Frame:
    """One frame/1: N particles with V vertices, C contacts, a ring of B boundary particles. SI units."""
    number: int
    axial_strain: float
    id: np.ndarray            # N, ascending
    parent: np.ndarray        # N ids; -1: an original
    root: np.ndarray          # N ids of the originals
    generation: np.ndarray    # N; breakages since the original
    position: np.ndarray      # N x 2 centroids [m]
    angle: np.ndarray         # N [rad]; a fragment goes on with its parent's
    displacement: np.ndarray  # N x 2 since the start of shear [m]
    area: np.ndarray          # N [m^2]; mass is proportional to it
    boundary: np.ndarray      # N bool
    offset: np.ndarray        # N + 1; first row of each outline in `body_vertices` and `vertices`
    body_vertices: np.ndarray  # V x 2, body axes, counter-clockwise, centroid at the origin [m]
    a: np.ndarray             # C rows of the particles
    b: np.ndarray
    point: np.ndarray         # C x 2 application points, world [m]
    normal: np.ndarray        # C x 2 unit normals from a to b
    force: np.ndarray         # C x 2 on b [N]
    normal_force: np.ndarray  # C [N] >= 0
    shear_force: np.ndarray   # C [N]; force . (-n_y, n_x)
    overlap_area: np.ndarray  # C [m^2]
    ring: np.ndarray          # B rows of the boundary particles, counter-clockwise around the assembly

    def __len__(self):
        """Number of particles."""
        return len(self.id)

    @property
    def branch(self):
        """C x 2 vectors from centroid to centroid, a to b [m]: l of Eq. 13."""
        return self.position[self.b] - self.position[self.a]

    @cached_property
    def owner(self):
        """V rows: the particle that each vertex belongs to."""
        return np.repeat(np.arange(len(self)), np.diff(self.offset))

    @cached_property
    def vertices(self):
        """V x 2 outlines, world axes [m]: position + R(angle) vertex."""
        c, s = np.cos(self.angle)[self.owner], np.sin(self.angle)[self.owner]
        x, y = self.body_vertices.T
        return self.position[self.owner] + np.column_stack([c * x - s * y, s * x + c * y])

    @property
    def outlines(self):
        """List of N arrays of vertices, world axes [m], to draw."""
        return np.split(self.vertices, self.offset[1:-1])

    @cached_property
    def assembly_area(self):
        """Area of the polygon that joins the ring centroids [m^2]: A of Eq. 13."""
        x, y = (self.position[self.ring] - self.position[self.ring[:1]].sum(axis=0)).T
        return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

    def rows(self, ids):
        """Rows of particle ids; -1 where there is no such particle (any more)."""
        ids = np.asarray(ids)
        if not len(self):
            return np.full(ids.shape, -1)
        row = np.minimum(np.searchsorted(self.id, ids), len(self) - 1)
        return np.where(self.id[row] == ids, row, -1)


@dataclass(frozen=True)
class Split:
    """One split/1: what xfem found in the N particles of a frame. Lines and cracks stand in a particle's body axes."""
    number: int
    id: np.ndarray                 # N
    status: np.ndarray             # N, see STATUS
    stress: np.ndarray             # N x 3 mean (xx, yy, xy) [Pa]: average of the finite elements where they were solved
    min_safety_factor: np.ndarray  # N
    failure_mode: np.ndarray       # N, see MODES
    broken: np.ndarray             # M ids of the broken particles
    path: np.ndarray               # M x 2 x 2 ends of their breakage lines [m]
    fragment: np.ndarray           # 2 M ids, left of the path first
    fragment_parent: np.ndarray    # 2 M ids
    fragment_offset: np.ndarray    # 2 M + 1
    fragment_vertices: np.ndarray  # axes of the parent [m]
    cracked: np.ndarray            # K ids: the particle of each crack that goes on existing
    crack_offset: np.ndarray       # K + 1
    crack_points: np.ndarray       # polylines [m]


def opened(source):
    """A context with an open file: `source` is a path, or a file that is already open (and stays so)."""
    return nullcontext(source) if isinstance(source, h5py.File) else open_sealed(Path(source))


def _reader(file):
    def read(name, default=None):
        if name not in file:
            if default is not None:
                return default
            raise RockbreakError(BAD_INPUT, f"{file.filename}: found no dataset {name}; expected one, as in all "
                                 "frames or splits")
        return file[name][:]
    return read


def read_frame(source):
    """Frame of a file (path, or open h5py.File). Raises RockbreakError if it is unreadable or lacks a dataset.

    A contact state of another program may leave out history of breakage, displacement, overlap and ring.
    """
    with opened(source) as file:
        read = _reader(file)
        ids = read("particles/id")
        position = read("particles/position")
        a, b = (np.searchsorted(ids, read(f"contacts/{end}")) for end in "ab")
        return Frame(
            number=int(file.attrs.get("frame", 0)), axial_strain=float(file.attrs.get("axial_strain", 0.0)), id=ids,
            parent=read("particles/parent", np.full(len(ids), -1)), root=read("particles/root", ids),
            generation=read("particles/generation", np.zeros(len(ids), dtype=np.int32)), position=position,
            angle=read("particles/angle"), displacement=read("particles/displacement", np.zeros_like(position)),
            area=read("particles/area"), boundary=read("particles/boundary").astype(bool),
            offset=read("particles/vertex_offset"), body_vertices=read("particles/vertices"), a=a, b=b,
            point=read("contacts/point"), normal=read("contacts/normal"), force=read("contacts/force"),
            normal_force=read("contacts/normal_force"), shear_force=read("contacts/shear_force"),
            overlap_area=read("contacts/overlap_area", np.zeros(len(a))),
            ring=np.searchsorted(ids, read("boundary/ring", np.zeros(0, dtype=np.int64))))


def read_split(source):
    """Split of a file (path, or open h5py.File). Raises RockbreakError if it is unreadable or lacks a dataset."""
    with opened(source) as file:
        read = _reader(file)
        ids, none, numbers = read("particles/id"), np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
        return Split(
            number=int(file.attrs["frame"]), id=ids, status=read("particles/status"),
            stress=read("particles/mean_stress", np.full((len(ids), 3), np.nan)),
            min_safety_factor=read("particles/min_safety_factor", np.full(len(ids), np.nan)),
            failure_mode=read("particles/failure_mode", np.zeros(len(ids), dtype=np.int32)),
            broken=read("broken/parent"), path=read("broken/path"), fragment=read("fragments/id"),
            fragment_parent=read("fragments/parent"), fragment_offset=read("fragments/vertex_offset"),
            fragment_vertices=read("fragments/vertices"), cracked=read("cracks/particle", none),
            crack_offset=read("cracks/point_offset", numbers), crack_points=read("cracks/points", np.zeros((0, 2))))
