"""Energy by kind against strain, from the history of a run with the effect `energy_ledger`. J for unit thickness.

boundary work + gravity work = friction + damping + ... + change of elastic + change of kinetic + residual

All sums run since the start of shear, the first row.
"""
from dataclasses import dataclass

import numpy as np

INPUTS = {"boundary_work": "boundary_work", "gravity_work": "gravity_work"}  # kind -> column of the history
SPENT = {"friction": "friction_dissipation", "damping": "damping_dissipation",
         "contact_damping": "contact_damping_dissipation", "rolling": "rolling_dissipation",
         "released_by_breakage": "released_by_breakage", "contact_law_work": "contact_law_work"}
STORED = {"elastic": "elastic_energy", "kinetic": "kinetic_energy"}


@dataclass(frozen=True)
class Energies:
    """H rows; kinds of effects that the run does not have are left out."""
    axial_strain: np.ndarray  # H
    inputs: dict              # kind -> H [J]
    spent: dict               # kind -> H [J]; "elastic" and "kinetic" are changes since the start
    residual: np.ndarray      # H [J]: inputs less everything spent; what is booked nowhere
    scale: float = 1.0        # [J] that the numbers have been divided by

    @property
    def input(self):
        """H sums of the inputs."""
        return sum(self.inputs.values())

    def normalised(self, scale=None):
        """The same over `scale` [J]; None: over the input at the end, so that kinds are shares of it."""
        scale = float(self.input[-1]) if scale is None else scale
        return Energies(self.axial_strain, {kind: values / scale for kind, values in self.inputs.items()},
                        {kind: values / scale for kind, values in self.spent.items()}, self.residual / scale,
                        self.scale * scale)

    @property
    def relative_residual(self):
        """Largest |residual| / (|input| + |stored|) after the first tenth of the strain, as the run's guard sees it."""
        late = self.axial_strain >= 0.1 * self.axial_strain[-1]
        size = np.abs(self.input) + sum(np.abs(self.spent[kind]) for kind in STORED)
        return float(np.max(np.abs(self.residual[late]) / size[late]))


def energies(history):
    """Energies of a history (column -> H values; rockbreak.run.history.read_history); None without a ledger."""
    if "boundary_work" not in history or "elastic_energy" not in history:
        return None
    inputs = {kind: history[column] for kind, column in INPUTS.items() if column in history}
    spent = {kind: history[column] for kind, column in SPENT.items() if column in history}
    spent |= {kind: history[column] - history[column][0] for kind, column in STORED.items()}
    residual = sum(inputs.values()) - sum(spent.values())
    return Energies(np.asarray(history["axial_strain"]), inputs, spent, residual)
