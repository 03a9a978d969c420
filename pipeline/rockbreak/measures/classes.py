"""What the paper counts in a contact state: forces, particle stresses and displacements by classes (Tables 2 and 3).

The paper states the limit of large displacements, 118 cm, but neither those of the forces nor those of the stresses:
STRESS_LIMITS and the force limits are the ones that fit its tables best (class_limits.py; evidence in
pipeline/README.md). Every particle counts, those of the boundary too: its stress classes add up to all 1194.

A particle's stress is read in two ways. "virial": its mean stress (Eq. 13 for one particle). "held": what a finite
element average becomes if two contact points are fixed in both directions, as a literal reading of the paper has it;
a pair of opposite reactions along the line through them then falsifies the mean.
"""
from dataclasses import dataclass

import numpy as np

from ..paper.numbers import FORCES, HORIZONTAL_STRESSES, LARGE_DISPLACEMENT, VERTICAL_STRESSES
from ..sealed import open_sealed

WEAK_FORCE = 1e6    # [N] weak below
STRONG_FORCE = 5e6  # [N] strong above
STRESS_LIMITS = {"virial": (4e6, 12e6), "held": (2e6, 10e6)}  # [Pa] low below, high above
HELD = "_held"      # what is appended to the name of a count in the second reading
POISSON_RATIO = 0.2  # Table 1


def three_classes(values, lower, upper):
    """Numbers of values below `lower`, from `lower` to `upper`, above `upper`."""
    below, above = int(np.sum(values < lower)), int(np.sum(values > upper))
    return below, len(values) - below - above, above


def force_classes(normal_force, weak=WEAK_FORCE, strong=STRONG_FORCE):
    """Weak, moderate and strong contacts of C normal forces [N]. Contacts that carry nothing are not counted."""
    return three_classes(normal_force[normal_force > 0], weak, strong)


def stress_classes(stress, low, high):
    """Low, medium and high of N stresses [Pa], compression positive; tension is low."""
    return three_classes(stress, low, high)


def large_displacements(displacement, limit=LARGE_DISPLACEMENT):
    """Particles whose displacement (N x 2) [m] since the start of shear is longer than `limit`."""
    return int(np.sum(np.linalg.norm(displacement, axis=1) > limit))


def particle_stresses(position, area, a, b, point, force):
    """Mean stress of every particle, N x 3 (xx, yy, xy) [Pa], compression positive: the virial of its contact forces,

        sigma_ij = - 1/A  sum_c f_i l_j,    l = contact point - centroid, f the force on the particle (Eq. 13 for one),

    which is the average over its volume, and so over its finite elements, if the forces balance. xy is the symmetric
    part. `a`, `b`: rows of the two particles of each of C contacts; `point`, `force` (on b): C x 2 [m], [N]; `area` of
    the particle [m^2], unit thickness.
    """
    moment = np.zeros((len(position), 2, 2))
    np.add.at(moment, a, force[:, :, None] * (point - position[a])[:, None, :])
    np.add.at(moment, b, -force[:, :, None] * (point - position[b])[:, None, :])
    stress = moment / area[:, None, None]
    return np.column_stack([stress[:, 0, 0], stress[:, 1, 1], 0.5 * (stress[:, 0, 1] + stress[:, 1, 0])])


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


@dataclass(frozen=True)
class ContactState:
    """The arrays of one frame that the classes need."""
    normal_force: np.ndarray  # C [N]
    stress: dict              # "virial", "held": N x 3 [Pa]
    displacement: np.ndarray  # N x 2 [m]

    def counts(self):
        """Quantity of Tables 2 and 3 -> count; with the totals `contacts` and `particles`."""
        forces = force_classes(self.normal_force)
        counts = {"large_displacements": large_displacements(self.displacement)}
        counts |= zip(FORCES, forces)
        for reading, suffix in (("virial", ""), ("held", HELD)):
            for component, names in ((1, VERTICAL_STRESSES), (0, HORIZONTAL_STRESSES)):
                found = stress_classes(self.stress[reading][:, component], *STRESS_LIMITS[reading])
                counts |= {name + suffix: count for name, count in zip(names, found)}
        return counts | {"contacts": sum(forces), "particles": len(self.displacement)}


def read_contact_state(path):
    """Of a frame file."""
    with open_sealed(path) as file:
        particles, contacts = file["particles"], file["contacts"]
        ids = particles["id"][:]  # ascending (frame/1)
        a, b = np.searchsorted(ids, contacts["a"][:]), np.searchsorted(ids, contacts["b"][:])
        point = contacts["point"][:]
        virial = particle_stresses(particles["position"][:], particles["area"][:], a, b, point, contacts["force"][:])
        held = held_stresses(virial, two_contacts(len(ids), a, b), point) if len(a) else virial
        return ContactState(normal_force=contacts["normal_force"][:], stress={"virial": virial, "held": held},
                            displacement=particles["displacement"][:])
