"""What the paper counts in a contact state: forces, particle stresses and displacements by classes (Tables 2 and 3).

Weak forces are below 1 MN and strong ones above 5 MN, normal forces. Low particle stresses are below LOW_STRESS, high
ones above HIGH_STRESS. The paper states none of these four; how they were found, and how much the counts depend on
them, is told in pipeline/README.md. Large displacements, above 118 cm, are stated. Every particle counts, those of
the boundary too: the paper's stress classes add up to all 1194.
"""
from dataclasses import dataclass

import h5py
import numpy as np

from .paper import FORCES, HORIZONTAL_STRESSES, LARGE_DISPLACEMENT, VERTICAL_STRESSES

WEAK_FORCE = 1e6    # [N]
STRONG_FORCE = 5e6  # [N]
LOW_STRESS = 4e6    # [Pa]
HIGH_STRESS = 12e6  # [Pa]


def three_classes(values, lower, upper):
    """Numbers of values below `lower`, from `lower` to `upper`, above `upper`."""
    below, above = int(np.sum(values < lower)), int(np.sum(values > upper))
    return below, len(values) - below - above, above


def force_classes(normal_force, weak=WEAK_FORCE, strong=STRONG_FORCE):
    """Weak, moderate and strong contacts of C normal forces [N]. Contacts that carry nothing are not counted."""
    return three_classes(normal_force[normal_force > 0], weak, strong)


def stress_classes(stress, low=LOW_STRESS, high=HIGH_STRESS):
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


def rows_of(ids, wanted):
    """Row of each wanted id; particles ascend by id (frame/1)."""
    return np.searchsorted(ids, wanted)


@dataclass(frozen=True)
class ContactState:
    """The arrays of one frame that the classes need."""
    axial_strain: float
    normal_force: np.ndarray  # C [N]
    stress: np.ndarray        # N x 3 [Pa]
    displacement: np.ndarray  # N x 2 [m]

    def counts(self, low_stress=LOW_STRESS, high_stress=HIGH_STRESS):
        """Quantity of Tables 2 and 3 -> count; with the totals `contacts` and `particles`."""
        forces = force_classes(self.normal_force)
        counts = {"large_displacements": large_displacements(self.displacement)}
        counts |= zip(FORCES, forces)
        counts |= zip(VERTICAL_STRESSES, stress_classes(self.stress[:, 1], low_stress, high_stress))
        counts |= zip(HORIZONTAL_STRESSES, stress_classes(self.stress[:, 0], low_stress, high_stress))
        return counts | {"contacts": sum(forces), "particles": len(self.stress)}


def read_contact_state(path):
    with h5py.File(path, "r") as file:
        particles, contacts = file["particles"], file["contacts"]
        ids = particles["id"][:]
        a, b = rows_of(ids, contacts["a"][:]), rows_of(ids, contacts["b"][:])
        return ContactState(
            axial_strain=float(file.attrs["axial_strain"]), normal_force=contacts["normal_force"][:],
            stress=particle_stresses(particles["position"][:], particles["area"][:], a, b, contacts["point"][:],
                                     contacts["force"][:]),
            displacement=particles["displacement"][:])
