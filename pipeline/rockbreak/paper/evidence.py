"""Whether a trend that the paper states in words is in our runs: decided by differences between runs of the same seed.

One seed makes one sample at each pressure, which is sheared with and without breakage. A difference d between two such
twins, two stages or two pressures is taken seed by seed, so that what one sample has more than another drops out. With
the mean of d and its standard error s.e. = s / sqrt(n) over n seeds, a trend is

  reproduced          mean(d) has the stated sign and is at least `sure(n)` s.e. (2.8 with five seeds, differences.py)
  within the scatter  the stated sign, less than that
  not reproduced      the other sign, or no difference at all

Several differences in one sentence: not reproduced if one is not; else within the scatter if one is. A trend with
pressure is the slope against log2 p, by least squares through a seed's pressures: a change for each doubling. Where a
step between two pressures goes the other way, the reason says so; if that step is beyond the scatter, the trend is not
reproduced. One seed alone has no scatter: the sign decides, and the reason says so.
"""
from dataclasses import dataclass
from statistics import mean
from typing import NamedTuple

from .differences import contrary_steps, form, judged, slope, with_error
from .observations import WORDS
from .verdicts import NOT_REPRODUCED, REPRODUCED, WITHIN_SCATTER

NEARLY_CONSTANT = 0.10  # of the mean: our reading of "almost constant"
ASSEMBLY = {False: "non-breakable", True: "breakable"}
ORDER = (REPRODUCED, WITHIN_SCATTER, NOT_REPRODUCED)


@dataclass
class Samples:
    """(pressure [Pa], breakable) -> seed -> (quantity, column) -> number."""
    values: dict

    def of(self, key, pressure, breakable):
        """seed -> number."""
        runs = self.values.get((pressure, breakable), {})
        return {seed: run[key] for seed, run in runs.items() if key in run}

    def paired(self, key, pressure):
        """seed -> breakable less non-breakable, of the seeds that have both."""
        solid, broken = self.of(key, pressure, False), self.of(key, pressure, True)
        return {seed: broken[seed] - solid[seed] for seed in sorted(solid.keys() & broken.keys())}

    def pressures(self):
        return sorted({pressure for pressure, _ in self.values})


class Piece(NamedTuple):
    text: str
    verdict: str
    reason: str
    note: str = ""  # said whatever decides the sentence


def megapascal(pressure):
    return f"{1e-6 * pressure:g} MPa"


# What a sentence is made of. Each takes Samples and gives Pieces; none where the runs do not have the numbers.

class ByBreakage(NamedTuple):
    """Breakable less non-breakable has this sign: at each of the pressures told; told none, in the mean over all."""
    quantity: str
    column: str
    sign: int
    pressures: tuple = ()

    def pieces(self, samples):
        there = [p for p in self.pressures or samples.pressures() if samples.paired(self._key, p)]
        paired = {p: samples.paired(self._key, p) for p in there}
        if not there:
            return []
        listed = ", ".join(f"{megapascal(p)} {with_error(list(paired[p].values()))}" for p in there)
        text = f"{said(self._key)}, breakable − non-breakable: {listed}"
        if self.pressures:
            return [Piece(text if i == 0 else "", *judged(list(paired[p].values()), self.sign))
                    for i, p in enumerate(there)]
        seeds = sorted(set.intersection(*(set(paired[p]) for p in there)))
        return [Piece(text, *judged([mean(paired[p][seed] for p in there) for seed in seeds], self.sign))
                ] if seeds else []

    @property
    def _key(self):
        return self.quantity, self.column


class WithPressure(NamedTuple):
    """Grows (+1) or falls (-1) with the pressure, or is almost constant (0); of each assembly, or (None) of the paired
    differences by breakage."""
    quantity: str
    column: str
    sign: int
    assemblies: tuple = (False, True)

    def pieces(self, samples):
        key, found = (self.quantity, self.column), []
        for breakable in self.assemblies:
            rows = {p: samples.paired(key, p) if breakable is None else samples.of(key, p, breakable)
                    for p in samples.pressures()}
            rows = {p: row for p, row in rows.items() if row}
            seeds = sorted(set.intersection(*map(set, rows.values()))) if len(rows) > 1 else []
            if not seeds:
                continue
            slopes = [slope({p: row[seed] for p, row in rows.items()}) for seed in seeds]
            means = {p: mean(row.values()) for p, row in rows.items()}
            listed = ", ".join(f"{megapascal(p)} {form(value)}" for p, value in means.items())
            kind = "breakable − non-breakable" if breakable is None else ASSEMBLY[breakable]
            text = f"{said(key)}, {kind}: {listed}; for each doubling {with_error(slopes)}"
            if not self.sign:
                found.append(Piece(text, *constant(list(means.values()))))
                continue
            contrary = contrary_steps(rows, self.sign)
            note = "; ".join(f"{megapascal(low)} to {megapascal(high)} the other way, {words}"
                             for low, high, _, words in contrary)
            against = any(beyond for _, _, beyond, _ in contrary)
            found.append(Piece(text, *((NOT_REPRODUCED, "a step beyond the scatter") if against else
                                       judged(slopes, self.sign)), f"not monotone: {note}" if note else ""))
        return found


class Between(NamedTuple):
    """From one stage to a later one it grows (+1), falls (-1) or is almost constant (0)."""
    quantity: str
    columns: tuple
    sign: int
    assemblies: tuple = (False, True)
    pressure: float = 2e6

    def pieces(self, samples):
        found = []
        for breakable in self.assemblies:
            first, last = (samples.of((self.quantity, column), self.pressure, breakable) for column in self.columns)
            seeds = sorted(first.keys() & last.keys())
            if not seeds:
                continue
            ends = [mean(row[seed] for seed in seeds) for row in (first, last)]
            differences = [last[seed] - first[seed] for seed in seeds]
            text = (f"{said((self.quantity, None))}, {ASSEMBLY[breakable]}, {self.columns[0]} to {self.columns[1]}: "
                    f"{form(ends[0])} to {form(ends[1])} ({with_error(differences)})")
            found.append(Piece(text, *(judged(differences, self.sign) if self.sign else constant(ends))))
        return found


class Within(NamedTuple):
    """The mean over seeds lies between two limits, in each assembly at each pressure (told none: at all)."""
    quantity: str
    column: str
    low: float
    high: float
    assemblies: tuple = (False, True)
    pressures: tuple = ()

    def pieces(self, samples):
        found = []
        for breakable in self.assemblies:
            rows = {p: list(samples.of((self.quantity, self.column), p, breakable).values())
                    for p in self.pressures or samples.pressures()}
            rows = {p: row for p, row in rows.items() if row}
            if rows:
                listed = ", ".join(f"{megapascal(p)} {form(mean(row))}" for p, row in rows.items())
                holds = all(self.low <= mean(row) <= self.high for row in rows.values())
                found.append(Piece(f"{said((self.quantity, self.column))}, {ASSEMBLY[breakable]}: {listed}",
                                   REPRODUCED if holds else NOT_REPRODUCED,
                                   f"{'' if holds else 'not all '}in {self.low:g} to {self.high:g}"))
        return found


class Same(NamedTuple):
    """With and without breakage the same to a tolerance, in the mean over the seeds, at each pressure."""
    quantity: str
    column: str
    tolerance: float

    def pieces(self, samples):
        key, found = (self.quantity, self.column), []
        for pressure in samples.pressures():
            paired = list(samples.paired(key, pressure).values())
            if paired:
                kind, reason = ((REPRODUCED, f"within {self.tolerance:g}") if abs(mean(paired)) <= self.tolerance else
                                (NOT_REPRODUCED, f"beyond {self.tolerance:g} at {megapascal(pressure)}"))
                found.append(Piece(f"{megapascal(pressure)} {with_error(paired)}", kind, reason))
        if found:
            found[0] = found[0]._replace(text=f"{said(key)}, breakable − non-breakable: {found[0].text}")
        return found


class Beyond(NamedTuple):
    """More (sign +1) or less (-1) than a limit."""
    quantity: str
    column: str
    sign: int
    limit: float
    assemblies: tuple = (False, True)
    pressures: tuple = ()

    def pieces(self, samples):
        found = []
        for breakable in self.assemblies:
            for pressure in self.pressures or samples.pressures():
                values = list(samples.of((self.quantity, self.column), pressure, breakable).values())
                if values:
                    error = with_error(values).partition("±")[2]
                    text = (f"{said((self.quantity, self.column))}, {ASSEMBLY[breakable]}: {megapascal(pressure)} "
                            f"{form(mean(values))}" + (f" ±{error}" if error else ""))
                    found.append(Piece(text, *judged([value - self.limit for value in values], self.sign)))
        return found


class Widens(NamedTuple):
    """What breakage changes (breakable less non-breakable) grows (+1) or falls (-1) from one stage to a later one."""
    quantity: str
    columns: tuple
    sign: int
    pressure: float = 2e6

    def pieces(self, samples):
        first, last = (samples.paired((self.quantity, column), self.pressure) for column in self.columns)
        seeds = sorted(first.keys() & last.keys())
        if not seeds:
            return []
        listed = ", ".join(f"{form(mean(row[seed] for seed in seeds))} at {column}"
                           for column, row in zip(self.columns, (first, last)))
        differences = [last[seed] - first[seed] for seed in seeds]
        return [Piece(f"{said((self.quantity, None))}, breakable − non-breakable: {listed} ({with_error(differences)})",
                      *judged(differences, self.sign))]


def constant(values):
    spread = (max(values) - min(values)) / abs(mean(values)) if mean(values) else 0.0
    return (REPRODUCED if spread <= NEARLY_CONSTANT else NOT_REPRODUCED), f"spread {spread:.0%}"


def said(key):
    quantity, column = key
    name = WORDS[quantity]
    if column in (None, "test") or name.endswith(f"at the {column}"):
        return name
    return f"{name} at {'the ' if column in ('peak', 'end', 'start') else ''}{column}"
