"""Stresses of particles and of the assembly, (xx, yy, xy) [Pa], positive in compression; Eq. 13 of the paper.

sigma_ij = 1/A sum_c f_i l_j    (13)   l: from centroid to centroid, f: the force on the particle that it points to

A particle's stress is read in two ways. "virial": its mean stress (Eq. 13 for one particle). "held": what a finite
element average becomes if two contact points are fixed in both directions, as a literal reading of the paper has it;
a pair of opposite reactions along the line through them then falsifies the mean. Splits hold the element averages of
`xfem` (`element_stresses`). It takes the contact points onto the outline, where `dem` has them within the overlap: the
two differ by the overlap's depth over the size, in the mean by 2 % at 2 MPa, most in small fragments.
"""
import numpy as np

POISSON_RATIO = 0.2  # Table 1


def assembly_stress(branch, force, area):
    """Eq. 13: 3 (xx, yy, xy) [Pa] of C contacts, branch vectors and forces on their ends (C x 2) [m], [N]; area [m^2].

    xy is the symmetric part. Of a frame: assembly_stress(frame.branch, frame.force, frame.assembly_area).
    """
    full = force.T @ branch / area
    return np.array([full[0, 0], full[1, 1], 0.5 * (full[0, 1] + full[1, 0])])


def particle_stresses(position, area, a, b, point, force):
    """Mean stress of every particle, N x 3 (xx, yy, xy) [Pa], compression positive: the virial of its contact forces,

        sigma_ij = - 1/A  sum_c f_i l_j,    l = contact point - centroid, f the force on the particle (Eq. 13 for one),

    which is the average over its volume, and so over its finite elements, if the forces balance. xy is the symmetric
    part. `a`, `b`: rows of the two particles of each of C contacts; `point`, `force` (on b): C x 2 [m], [N]; `area` of
    the particle [m^2], unit thickness.
    """
    count = len(position)
    particle = np.concatenate([a, b])
    arm = np.concatenate([point - position[a], position[b] - point])
    f = np.concatenate([force, force])
    xx, yy, xy, yx = (np.bincount(particle, f[:, i] * arm[:, j], count) for i, j in ((0, 0), (1, 1), (0, 1), (1, 0)))
    return np.column_stack([xx, yy, 0.5 * (xy + yx)]) / area[:, None]


def frame_stresses(frame):
    """particle_stresses of a Frame."""
    return particle_stresses(frame.position, frame.area, frame.a, frame.b, frame.point, frame.force)


def element_stresses(frame, split):
    """N x 3 [Pa] in the frame's order: the split's averages over elements; the virial of particles that it lacks."""
    stress = frame_stresses(frame)
    row = frame.rows(split.id)
    known = (row >= 0) & np.isfinite(split.stress).all(axis=1)
    stress[row[known]] = split.stress[known]
    return stress


def principal_stresses(stress):
    """(major, minor, direction) of stress (..., 3): [unit of stress] and the axis of the major one in [0, pi) [rad]."""
    xx, yy, xy = np.moveaxis(np.asarray(stress, dtype=float), -1, 0)
    centre, difference = 0.5 * (xx + yy), 0.5 * (xx - yy)
    radius = np.hypot(difference, xy)
    return centre + radius, centre - radius, line_angle(0.5 * np.arctan2(xy, difference))


def line_angle(angle):
    """The same line's angle in [0, pi) [rad]."""
    folded = np.mod(angle, np.pi)
    return np.where(folded < np.pi, folded, 0.0)[()]  # -1e-20 mod pi is pi


def three_classes(values, lower, upper):
    """Numbers of values below `lower`, from `lower` to `upper`, above `upper`."""
    below, above = int(np.sum(values < lower)), int(np.sum(values > upper))
    return below, len(values) - below - above, above


def class_of(values, lower, upper):
    """0, 1 or 2 for each value: below `lower`, from `lower` to `upper`, above `upper` (Figs. 4-6, 15, 16)."""
    return (values >= lower).astype(int) + (values > upper)


def two_contacts(count, a, b):
    """Rows of two contacts of each of `count` particles, count x 2; -1 where there are fewer.

    Any two: those first in an order scrambled from the numbers of the particles. Numbers follow places (dem), so that
    the contacts first by number would lie side by side.
    """
    mixed = (a.astype(np.uint64) << np.uint64(32)) + b.astype(np.uint64)
    for shift in (30, 27, 31):  # multiply and shift, modulo 2^64: every bit reaches every other
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(0xbf58476d1ce4e5b9)
    particle, contact = np.concatenate([a, b]), np.tile(np.arange(len(a)), 2)
    order = np.lexsort((np.tile(mixed, 2), particle))
    particle, contact = particle[order], contact[order]
    begin, end = np.searchsorted(particle, np.arange(count)), np.searchsorted(particle, np.arange(count), side="right")
    found = np.full((count, 2), -1)
    for k in range(2):
        has = end - begin > k
        found[has, k] = contact[begin[has] + k]
    return found


def held_stresses(stress, supports, point, poisson_ratio=POISSON_RATIO):
    """The stresses (N x 3) with the reactions of two fixed contact points (rows of `point`, N x 2; -1: free).

    The reactions q d (x) d along the unit vector d between the points keep their distance; with the mean strain of
    plane strain, eps = (1 + nu)/E (sigma - nu tr sigma), d . eps . d = 0 gives q = (d.sigma.d - nu tr sigma)/(1 - nu).
    """
    line = point[supports[:, 0]] - point[supports[:, 1]]
    length = np.linalg.norm(line, axis=1)
    fixed = (supports >= 0).all(axis=1) & (length > 0)
    d = line / np.where(fixed, length, 1.0)[:, None]
    outer = np.column_stack([d[:, 0] ** 2, d[:, 1] ** 2, d[:, 0] * d[:, 1]])
    along = stress[:, 0] * outer[:, 0] + stress[:, 1] * outer[:, 1] + 2 * stress[:, 2] * outer[:, 2]
    q = (along - poisson_ratio * (stress[:, 0] + stress[:, 1])) / (1 - poisson_ratio)
    return stress - np.where(fixed, q, 0.0)[:, None] * outer
