"""Trends that the paper states in words, looked up in the means over seeds.

A trend is judged where its numbers are there: over at least two pressures, or in a breakable and a non-breakable
assembly at one pressure. Nothing of the scatter enters: it stands beside the rows that a trend compares.
"""
from typing import NamedTuple

from .rows import LABELS

NEARLY_CONSTANT = 0.10  # of the mean: our reading of "almost constant" and "nearly the same"


class Trend(NamedTuple):
    where: str       # section or figure of the paper
    statement: str
    assembly: str
    values: str      # "0.5 MPa: 0.31, ..."
    holds: bool


ASSEMBLY = {False: "non-breakable", True: "breakable"}


def falls(values):
    return all(later < earlier for earlier, later in zip(values, values[1:]))


def rises(values):
    return falls(values[::-1])


def never_falls(values):
    return all(later >= earlier for earlier, later in zip(values, values[1:]))


def constant(values):
    return max(values) - min(values) <= NEARLY_CONSTANT * abs(sum(values) / len(values))


def rises_then_falls(values):
    return rises(values[:3]) and values[3] < values[2]


# (where, what follows the quantity's name, assemblies, (table, quantity, column), condition on the values by pressure)
WITH_PRESSURE = (
    ("Table 4", "falls as the pressure grows", (False, True), ("Table 4", "void_ratio_e4", "end"), falls),
    ("Table 3", "falls as the pressure grows", (False, True), ("Table 3", "large_displacements", "end"), falls),
    ("Table 3", "never falls as the pressure grows", (False, True), ("Table 3", "strong_forces", "peak"), never_falls),
    ("Table 3", "rises as the pressure grows", (False, True), ("Table 3", "high_vertical_stresses", "peak"), rises),
    ("Fig. 20", "falls as the pressure grows", (False, True), ("Figs. 12, 20", "a", "peak"), falls),
    ("Fig. 20", "almost constant over the pressures", (False,), ("Figs. 12, 20", "a_n", "peak"), constant),
    ("Fig. 20", "almost constant over the pressures", (False,), ("Figs. 12, 20", "a_t", "peak"), constant),
    ("Fig. 20", "falls as the pressure grows", (False, True), ("Figs. 12, 20", "anisotropy", "peak"), falls),
)
# Over the columns 0, 7, 10, 17.3 % of Table 2.
WITH_STRAIN = (
    ("rises to 10 % strain, then falls", (False,), "strong_forces", rises_then_falls),
    ("rises to 10 % strain, then falls", (False,), "high_vertical_stresses", rises_then_falls),
    ("falls all the time", (False,), "contacts", falls),
    ("rises all the time", (True,), "contacts", rises),
    ("rises all the time", (True,), "particles", rises),
)
def less(solid, broken):
    return broken < solid


# Breakable beside non-breakable, at each pressure.
BY_BREAKAGE = (
    ("Table 4", "smaller with breakage", ("Table 4", "void_ratio_e4", "end"), less),
    ("Table 3", "smaller with breakage", ("Table 3", "large_displacements", "end"), less),
    ("Table 3", "not larger with breakage", ("Table 3", "strong_forces", "peak"),
     lambda solid, broken: broken <= solid),
    ("Table 3", "smaller with breakage", ("Table 3", "high_vertical_stresses", "peak"), less),
    ("Fig. 21", "smaller with breakage", ("Figs. 13, 21", "sin_phi", "peak"), less),
    ("Fig. 21", "nearly the same with breakage", ("Figs. 13, 21", "sin_phi", "end"),
     lambda solid, broken: constant([solid, broken])),
    ("Fig. 20", "smaller with breakage", ("Figs. 12, 20", "anisotropy", "peak"), less),
)
COLUMNS = ("0 %", "7 %", "10 %", "17.3 %")


def form(value):
    return f"{value:.0f}" if abs(value) >= 20 else f"{value:.3g}"


def listed(labels, values):
    return ", ".join(f"{label}: {form(value)}" for label, value in zip(labels, values))


def label_of(key):
    table, quantity, column = key
    return f"{LABELS[quantity]} at the {column}" if column in ("peak", "end") else LABELS[quantity]


def trends(means):
    """`means`: (pressure [Pa], breakable) -> (table, quantity, column) -> mean over seeds, or None."""
    found = []
    for where, words, assemblies, key, condition in WITH_PRESSURE:
        for breakable in assemblies:
            row = [(pressure, values[key]) for (pressure, kind), values in sorted(means.items())
                   if kind == breakable and values.get(key) is not None]
            if len(row) > 1:
                pressures, values = zip(*row)
                found.append(Trend(where, f"{label_of(key)}: {words}", ASSEMBLY[breakable],
                                   listed([f"{1e-6 * p:g} MPa" for p in pressures], values), condition(list(values))))
    for words, assemblies, quantity, condition in WITH_STRAIN:
        for breakable in assemblies:
            values = [means.get((2e6, breakable), {}).get(("Table 2", quantity, column)) for column in COLUMNS]
            if None not in values:
                found.append(Trend("Table 2", f"{LABELS[quantity]}: {words}", ASSEMBLY[breakable],
                                   listed(COLUMNS, values), condition(values)))
    for where, words, key, condition in BY_BREAKAGE:
        for pressure in sorted({pressure for pressure, _ in means}):
            values = [means.get((pressure, breakable), {}).get(key) for breakable in (False, True)]
            if None not in values:
                found.append(Trend(where, f"{label_of(key)}: {words}", f"both, {1e-6 * pressure:g} MPa",
                                   listed(("non-breakable", "breakable"), values), condition(*values)))
    return found
