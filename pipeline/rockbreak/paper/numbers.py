"""Published numbers to set beside ours: Raisianzadeh et al. (2019), biaxial tests on 1194 angular particles.

Tables 2 to 4 stand in data/*.csv. Numbers of particles and contacts are sums over their classes (stress classes count
every particle, force classes every contact). Assemblies: False is the non-breakable one, True the breakable one.
"""
import csv
from pathlib import Path

DATA = Path(__file__).resolve().parent / "data"

PARTICLES = 1194                          # Table 1
PRESSURES = (0.5e6, 1e6, 2e6, 4e6)        # [Pa]
INITIAL_VOID_RATIO = 0.30                 # Table 1, in a definition that is not stated
PEAK_STRAIN_2MPA = 0.10                   # Section 4.1; its Table 3 at 2 MPa is its Table 2 at 10 %
LARGE_DISPLACEMENT = 1.18                 # [m] Section 4.1
ASSEMBLIES = {"nonbreakable": False, "breakable": True}

FORCES = ("weak_forces", "moderate_forces", "strong_forces")
VERTICAL_STRESSES = ("low_vertical_stresses", "medium_vertical_stresses", "high_vertical_stresses")
HORIZONTAL_STRESSES = ("low_horizontal_stresses", "medium_horizontal_stresses", "high_horizontal_stresses")


def _rows(name):
    with open(DATA / name, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def _counts(name, unit):
    """assembly -> quantity -> column (axial strain, or pressure [Pa]) -> count."""
    (_, *header), *rows = _rows(name)
    table = {False: {}, True: {}}
    for quantity, *counts in rows:
        for column, count in zip(header, counts):
            assembly, value = column.split("_")
            table[ASSEMBLIES[assembly]].setdefault(quantity, {})[round(float(value) * unit, 9)] = int(count)
    return table


def _sums(table, classes):
    """assembly -> column -> sum over the classes."""
    return {breakable: {column: sum(rows[name][column] for name in classes) for column in rows[classes[0]]}
            for breakable, rows in table.items()}


COUNTS_2MPA = _counts("paper_table2.csv", 0.01)     # Table 2; at axial strains
COUNTS_AT_PEAK = _counts("paper_table3.csv", 1e6)   # Table 3; large displacements are those at the end of the test

CONTACTS_2MPA = _sums(COUNTS_2MPA, FORCES)
CONTACTS_AT_PEAK = _sums(COUNTS_AT_PEAK, FORCES)
PARTICLES_2MPA_BREAKABLE = _sums(COUNTS_2MPA, VERTICAL_STRESSES)[True]
PARTICLES_AT_PEAK_BREAKABLE = _sums(COUNTS_AT_PEAK, VERTICAL_STRESSES)[True]


def _void_ratios():
    (_, *pressures), *rows = _rows("paper_table4.csv")
    return {ASSEMBLIES[assembly]: {1e6 * float(pressure): float(value) for pressure, value in zip(pressures, values)}
            for assembly, *values in rows}


FINAL_VOID_RATIO = _void_ratios()  # Table 4; assembly -> confining pressure [Pa] -> at the end of the test


def pressure_of(case):
    """The paper's confining pressure [Pa] that this scene has; None if its assembly or pressure is another."""
    particles = (case.get("assembly") or {}).get("particles")
    pressure = (case.get("preparation") or {}).get("confining_pressure")
    return float(pressure) if particles == PARTICLES and pressure in PRESSURES else None


def applies_to(case):
    """True for the paper's own assembly at 2 MPa, whose numbers may be drawn beside ours."""
    return pressure_of(case) == 2e6
