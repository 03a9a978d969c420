"""Displacements: classes (Figs. 3, 14), the affine part, rotations and local strain.

A gradient G is 2 x 2 with u_i = G_ij x_j. Strain is positive in compression, (xx, yy, xy) = -sym G; rotation
is counter-clockwise, (G_yx - G_xy) / 2.
"""
from dataclasses import dataclass

import numpy as np


def displacement_class(displacement, limits):
    """N class numbers by the length of displacements (N x 2) [m]: 0 up to the first of ascending `limits` [m], 1 up to
    the second, ..."""
    return np.searchsorted(limits, np.linalg.norm(displacement, axis=1), side="left")


@dataclass(frozen=True)
class Motion:
    """N displacements as an affine motion and a rest: u = translation + gradient x + rest."""
    translation: np.ndarray  # 2 [m], at x = 0
    gradient: np.ndarray     # 2 x 2
    rest: np.ndarray         # N x 2 non-affine part [m]
    share: float             # of the rest in the sum of squares of u

    @property
    def strain(self):
        """3 (xx, yy, xy), compression positive."""
        return strain_of(self.gradient)

    @property
    def rotation(self):
        """[rad], counter-clockwise, small."""
        return float(rotation_of(self.gradient))


def strain_of(gradient):
    """(..., 3) (xx, yy, xy), compression positive, of gradients (..., 2, 2)."""
    return -np.stack([gradient[..., 0, 0], gradient[..., 1, 1], 0.5 * (gradient[..., 0, 1] + gradient[..., 1, 0])], -1)


def rotation_of(gradient):
    """(...) counter-clockwise rotation [rad] of gradients (..., 2, 2)."""
    return 0.5 * (gradient[..., 1, 0] - gradient[..., 0, 1])


def affine_motion(reference, displacement, weight=None):
    """Motion that fits N displacements at reference positions (N x 2) [m] best: least squares with weights (N)."""
    root = np.sqrt(np.ones(len(reference)) if weight is None else weight)[:, None]
    basis = np.column_stack([np.ones(len(reference)), reference])
    solution, *_ = np.linalg.lstsq(basis * root, displacement * root, rcond=None)
    rest = displacement - basis @ solution
    whole = np.sum((root * displacement) ** 2)
    return Motion(solution[0], solution[1:].T, rest, float(np.sum((root * rest) ** 2) / whole) if whole else 0.0)


def frame_motion(frame):
    """affine_motion of a Frame since the start of shear, in the positions of that time, weighted by area.

    A fragment takes over its parent's displacement: its reference is off by what a turn of the parent moved it.
    """
    return affine_motion(frame.position - frame.displacement, frame.displacement, frame.area)


def ancestors(frame, earlier):
    """N rows of an earlier Frame: each particle itself, or what it broke from; -1 if several generations lie between
    and neither parent nor original is there."""
    row = earlier.rows(frame.id)
    for ids in (frame.parent, frame.root):
        row = np.where(row < 0, earlier.rows(ids), row)
    return row


def _since(values, earlier, row):
    change = values - earlier[row]
    change[row < 0] = np.nan
    return change


def displacements_since(frame, earlier):
    """N x 2 displacements [m] since an earlier Frame of the run; nan where no ancestor is known."""
    return _since(frame.displacement, earlier.displacement, ancestors(frame, earlier))


def rotations_since(frame, earlier):
    """N rotations [rad] since an earlier Frame of the run, counter-clockwise, full turns included; nan where no
    ancestor is known."""
    return _since(frame.angle, earlier.angle, ancestors(frame, earlier))


def pairs_within(points, radius):
    """(i, j) of all pairs of points (N x 2) nearer than `radius`, each in both orders, without (i, i)."""
    cell = np.floor((points - points.min(axis=0)) / radius).astype(np.int64) + 1
    stride = int(cell[:, 1].max()) + 2
    key = cell[:, 0] * stride + cell[:, 1]
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    found = []
    for column in (-1, 0, 1):  # three cells of a column are neighbours in `ordered`
        low = np.searchsorted(ordered, key + column * stride - 1, side="left")
        number = np.searchsorted(ordered, key + column * stride + 1, side="right") - low
        i = np.repeat(np.arange(len(points)), number)
        within = np.arange(number.sum()) - np.repeat(np.cumsum(number) - number, number)
        j = order[low[i] + within]
        near = (np.sum((points[i] - points[j]) ** 2, axis=1) < radius ** 2) & (i != j)
        found.append((i[near], j[near]))
    return tuple(np.concatenate(part) for part in zip(*found))


def local_gradients(reference, displacement, radius):
    """N x 2 x 2 gradients: around each particle, by least squares over its differences to neighbours within `radius`.

    Exact for affine motion. nan with fewer than two neighbours, or all on one line. Falk and Langer (1998); a radius of
    1.5 to 3 diameters [m] is usual.
    """
    i, j = pairs_within(reference, radius)
    x, u = reference[j] - reference[i], displacement[j] - displacement[i]
    count = len(reference)

    def sums(left, right):
        return np.stack([np.stack([np.bincount(i, left[:, k] * right[:, m], count) for m in (0, 1)], -1)
                         for k in (0, 1)], -2)

    xx, ux = sums(x, x), sums(u, x)
    determinant = xx[:, 0, 0] * xx[:, 1, 1] - xx[:, 0, 1] ** 2
    lost = determinant <= 1e-10 * np.square(np.trace(xx, axis1=1, axis2=2))
    xx[lost] = np.eye(2)
    gradient = ux @ np.linalg.inv(xx)
    gradient[lost] = np.nan
    return gradient
