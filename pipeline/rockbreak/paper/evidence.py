"""Whether a trend that the paper states in words is in our runs: decided by differences between runs of the same seed.

One seed makes one sample at each pressure, which is sheared with and without breakage. A difference d between two such
twins, two stages or two pressures is taken seed by seed, so that what one sample has more than another drops out. With
the mean of d and its standard error s.e. = s / sqrt(n) over n seeds, a trend is

  reproduced          mean(d) has the stated sign and is at least 2 s.e.
  within the scatter  the stated sign, less than 2 s.e.
  not reproduced      the other sign, or no difference at all

Several differences in one sentence: not reproduced if one is not; else within the scatter if one is. A trend with
pressure is the slope against log2 p, by least squares through a seed's pressures: a change for each doubling. One seed
alone has no scatter: the sign decides, and the reason says so.
"""
from dataclasses import dataclass
from statistics import mean, stdev
from typing import NamedTuple

import numpy as np

from .observations import WORDS
from .verdicts import NOT_REPRODUCED, REPRODUCED, UNDECIDABLE, WITHIN_SCATTER

SURE = 2.0              # standard errors
NEARLY_CONSTANT = 0.10  # of the mean: our reading of "almost constant" and "nearly the same"
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


def form(value):
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def signed(value):
    return ("+" if value > 0 else "") + form(value)


def error_of(values):
    """Standard error of the mean; None of one value."""
    return stdev(values) / len(values) ** 0.5 if len(values) > 1 else None


def with_error(values):
    error = error_of(values)
    return signed(mean(values)) + ("" if error is None else f" ± {form(error)}")


def judged(differences, sign):
    """(verdict, reason) of differences that should have a sign (+1 or -1)."""
    middle, error = mean(differences), error_of(differences)
    if middle * sign <= 0:
        return NOT_REPRODUCED, "no difference" if middle == 0 else "the other sign" if (
            error is None or abs(middle) >= SURE * error) else f"the other sign, {abs(middle) / error:.1f} s.e."
    if error is None:
        return REPRODUCED, "one seed: the sign alone"
    if middle * sign >= SURE * error:
        return REPRODUCED, f"{abs(middle) / error:.1f} s.e." if error > 0 else "all seeds alike"
    return WITHIN_SCATTER, f"{abs(middle) / error:.1f} s.e."


def slope(by_pressure):
    """Of one seed: least squares of pressure -> number against log2 of the pressure."""
    return float(np.polyfit(np.log2(list(by_pressure)), list(by_pressure.values()), 1)[0])


def megapascal(pressure):
    return f"{1e-6 * pressure:g} MPa"


# What a sentence is made of. Each takes Samples and gives Pieces; none where the runs do not have the numbers.

class ByBreakage(NamedTuple):
    """Breakable less non-breakable has this sign: at each of the pressures told, or, told none, in the mean over all."""
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
            found.append(Piece(text, *(judged(slopes, self.sign) if self.sign else constant(list(means.values())))))
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
    """Nearly the same with and without breakage, at each pressure."""
    quantity: str
    column: str

    def pieces(self, samples):
        key = self.quantity, self.column
        rows = {p: (mean(samples.of(key, p, False).values()), mean(samples.of(key, p, True).values()))
                for p in samples.pressures() if samples.paired(key, p)}
        listed = ", ".join(f"{megapascal(p)} {form(solid)} / {form(broken)}" for p, (solid, broken) in rows.items())
        return [Piece(f"{said(key)}, non-breakable / breakable: {listed}" if i == 0 else "", *constant(list(pair)))
                for i, pair in enumerate(rows.values())]


def constant(values):
    spread = (max(values) - min(values)) / abs(mean(values)) if mean(values) else 0.0
    return (REPRODUCED if spread <= NEARLY_CONSTANT else NOT_REPRODUCED), f"spread {spread:.0%}"


def said(key):
    quantity, column = key
    name = WORDS[quantity]
    return name if column in (None, "test") else f"{name} at {'the ' if column in ('peak', 'end', 'start') else ''}{column}"


def finding(parts, samples):
    """(ours in words, verdict, reason) of the parts of one sentence."""
    pieces = [piece for part in parts for piece in part.pieces(samples)]
    if not pieces:
        return "–", UNDECIDABLE, "our runs do not have it"
    worst = max((piece.verdict for piece in pieces), key=ORDER.index)
    reasons = [piece.reason for piece in pieces if piece.verdict == worst]
    return "; ".join(piece.text for piece in pieces if piece.text), worst, ", ".join(dict.fromkeys(reasons))
