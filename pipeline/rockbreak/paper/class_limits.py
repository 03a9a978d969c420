"""Which limits of the classes fit the paper's counts best, and how much the counts depend on them.

The misfit is the root mean square of (our count - the paper's) over all counts of Tables 2 and 3 that the runs have.
"""
from dataclasses import dataclass
from typing import Callable

import numpy as np

from . import numbers as paper
from ..measures.classes import STRESS_LIMITS, STRONG_FORCE, WEAK_FORCE, three_classes
from .rows import state_at


@dataclass(frozen=True)
class Measure:
    label: str
    limits: tuple        # in force
    lower: np.ndarray    # candidates, as `upper`
    upper: np.ndarray
    samples: Callable    # ContactState -> [(values, names of the three counts)]


def _stresses(reading):
    return lambda state: [(state.stress[reading][:, 1], paper.VERTICAL_STRESSES),
                          (state.stress[reading][:, 0], paper.HORIZONTAL_STRESSES)]


MEASURES = (
    Measure("normal forces [MN]", (WEAK_FORCE, STRONG_FORCE), 1e6 * np.arange(0.3, 3.01, 0.1),
            1e6 * np.arange(2.0, 10.01, 0.1), lambda state: [(state.normal_force, paper.FORCES)]),
    Measure("particle stresses, mean [MPa]", STRESS_LIMITS["virial"], 1e6 * np.arange(1.0, 8.01, 0.1),
            1e6 * np.arange(5.0, 18.01, 0.1), _stresses("virial")),
    Measure("particle stresses, two contacts held [MPa]", STRESS_LIMITS["held"], 1e6 * np.arange(1.0, 8.01, 0.1),
            1e6 * np.arange(5.0, 18.01, 0.1), _stresses("held")),
)


def published_states(results):
    """(contact state, quantity -> the paper's count) for every column of Tables 2 and 3 that belongs to a run."""
    pressure = paper.pressure_of(results.case)
    columns = []
    if pressure == 2e6:
        table = paper.COUNTS_2MPA[results.breakable]
        columns = [(strain, {name: row[strain] for name, row in table.items()}) for strain in table["weak_forces"]]
    elif pressure is not None:  # at 2 MPa the peak is a column of Table 2
        table = paper.COUNTS_AT_PEAK[results.breakable]
        columns = [(results.summary["peak_strain"], {name: row[pressure] for name, row in table.items()})]
    found = [(state_at(results, strain), counts) for strain, counts in columns]
    return [(state, counts) for state, counts in found if state is not None]


def samples_of(measure, states):
    """(sorted values, the paper's three counts) wherever the paper has them."""
    return [(np.sort(values), [counts[name] for name in names]) for state, counts in states
            for values, names in measure.samples(state) if names[0] in counts]


def misfit(samples, lower, upper):
    """Root mean square over all counts."""
    differences = [np.subtract(three_classes(values, lower, upper), counts) for values, counts in samples]
    return float(np.sqrt(np.mean(np.square(differences))))


def best_limits(samples, lower, upper):
    """(misfit, lower, upper) of the best pair of candidates, lower < upper."""
    total = np.zeros((len(lower), len(upper)))
    for values, (low, medium, high) in samples:
        below = np.searchsorted(values, lower, side="left")[:, None]
        above = len(values) - np.searchsorted(values, upper, side="right")[None, :]
        total += (below - low) ** 2 + (len(values) - below - above - medium) ** 2 + (above - high) ** 2
    total[lower[:, None] >= upper[None, :]] = np.inf
    i, j = np.unravel_index(np.argmin(total), total.shape)
    return float(np.sqrt(total[i, j] / (3 * len(samples)))), float(lower[i]), float(upper[j])


def limits_table(runs):
    """For each measure: limits in force with their misfit, the best ones with theirs, and the misfit of limits 20 %
    lower and higher. `runs`: Results of the paper's assembly."""
    states = [pair for run in runs for pair in published_states(run)]
    rows = []
    for measure in MEASURES:
        samples = samples_of(measure, states)
        if not samples:
            continue
        low, high = measure.limits
        best, best_low, best_high = best_limits(samples, measure.lower, measure.upper)
        rows.append({"label": measure.label, "counts": 3 * len(samples), "limits": (low, high),
                     "misfit": misfit(samples, low, high), "best": (best_low, best_high), "best_misfit": best,
                     "lower": misfit(samples, 0.8 * low, 0.8 * high),
                     "higher": misfit(samples, 1.2 * low, 1.2 * high)})
    return rows
