"""What a study measures: a number of a run, its difference from another run or from theory."""
from dataclasses import dataclass
from typing import Callable

from ..campaign.tables import numbers_of


@dataclass(frozen=True)
class Measure:
    name: str
    value: Callable       # (run) -> number of this run alone, None if there is none
    difference: Callable  # (run, reference run) -> signed error, None if it cannot be told
    relative: bool = False  # differences are parts of the value: so is the scatter then
    is_share: bool = False  # differences are 0 or 1: the error is their mean


def number_measure(label, key, divisor=None):
    """A number of summary.json, or a ratio of two."""
    def value(run):
        numbers = numbers_of(run.summary) if run.summary else {}
        if divisor is None or numbers.get(key) is None:
            return numbers.get(key)
        return numbers[key] / numbers[divisor] if numbers.get(divisor) else None

    def difference(run, reference):
        one, other = value(run), value(reference)
        return None if one is None or other is None else one - other

    return Measure(label, value, difference)
