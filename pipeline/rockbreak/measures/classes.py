"""What the paper counts in a contact state: forces, particle stresses and displacements by classes (Tables 2 and 3).

The paper states the limit of large displacements, 118 cm, but neither those of the forces nor those of the stresses:
STRESS_LIMITS and the force limits are the ones that fit its tables best (class_limits.py; evidence in
pipeline/README.md). Every particle counts, those of the boundary too: its stress classes add up to all 1194.
A particle's stress is read in two ways, "virial" and "held": see stresses.py.
"""
from dataclasses import dataclass

import numpy as np

from ..paper.numbers import FORCES, HORIZONTAL_STRESSES, LARGE_DISPLACEMENT, VERTICAL_STRESSES
from ..sealed import open_sealed
from .stresses import held_stresses, particle_stresses, three_classes, two_contacts

WEAK_FORCE = 1e6    # [N] weak below
STRONG_FORCE = 5e6  # [N] strong above
STRESS_LIMITS = {"virial": (4e6, 12e6), "held": (2e6, 10e6)}  # [Pa] low below, high above
HELD = "_held"      # what is appended to the name of a count in the second reading


def force_classes(normal_force, weak=WEAK_FORCE, strong=STRONG_FORCE):
    """Weak, moderate and strong contacts of C normal forces [N]. Contacts that carry nothing are not counted."""
    return three_classes(normal_force[normal_force > 0], weak, strong)


def stress_classes(stress, low, high):
    """Low, medium and high of N stresses [Pa], compression positive; tension is low."""
    return three_classes(stress, low, high)


def large_displacements(displacement, limit=LARGE_DISPLACEMENT):
    """Particles whose displacement (N x 2) [m] since the start of shear is longer than `limit`."""
    return int(np.sum(np.linalg.norm(displacement, axis=1) > limit))


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
