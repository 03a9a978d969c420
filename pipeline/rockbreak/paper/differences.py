"""Whether differences, one of each seed, show a sign: the numbers behind evidence.py.

A difference of the mean counts from `sure(n)` standard errors on: Student's t at 97.5 % with n - 1 degrees of freedom,
which is 2.78 for five seeds and 1.96 for very many. A sign that is there by chance alone passes in 1 of 40.
"""
from statistics import NormalDist, mean, stdev

import numpy as np

from .verdicts import NOT_REPRODUCED, REPRODUCED, WITHIN_SCATTER

STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)  # 97.5 %, 1 to 10 degrees of freedom


def sure(count):
    """Standard errors from which on the mean of `count` > 1 differences counts."""
    freedom = count - 1
    if freedom <= len(STUDENT):
        return STUDENT[freedom - 1]
    z = NormalDist().inv_cdf(0.975)  # Fisher's expansion, right to 0.001 there
    return z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2)


def error_of(values):
    """Standard error of the mean; None of one value."""
    return stdev(values) / len(values) ** 0.5 if len(values) > 1 else None


def judged(differences, sign):
    """(verdict, reason) of differences that should have a sign (+1 or -1)."""
    middle, error = mean(differences), error_of(differences)
    if middle * sign <= 0:
        return NOT_REPRODUCED, "no difference" if middle == 0 else "the other sign" + (
            f", {size(middle, error)}" if error else "")
    if error is None:
        return REPRODUCED, "one seed: the sign alone"
    if middle * sign >= sure(len(differences)) * error:
        return REPRODUCED, size(middle, error)
    return WITHIN_SCATTER, size(middle, error)


def size(middle, error):
    return f"{abs(middle) / error:.1f} s.e." if error > 0 else "all seeds alike"


def slope(by_pressure):
    """Of one seed: least squares of pressure -> number against log2 of the pressure."""
    return float(np.polyfit(np.log2(list(by_pressure)), list(by_pressure.values()), 1)[0])


def contrary_steps(rows, sign):
    """[(lower pressure, upper pressure, whether beyond the scatter, in words)] of the steps between neighbouring
    pressures that go against `sign` in the mean; `rows`: pressure -> seed -> number."""
    found = []
    for low, high in zip(list(rows), list(rows)[1:]):
        steps = [rows[high][seed] - rows[low][seed] for seed in sorted(rows[low].keys() & rows[high].keys())]
        if steps and mean(steps) * sign < 0:
            kind, words = judged(steps, -sign)
            found.append((low, high, len(steps) > 1 and kind == REPRODUCED, words))
    return found


def form(value):
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def signed(value):
    return ("+" if value > 0 else "") + form(value)


def with_error(values):
    error = error_of(values)
    return signed(mean(values)) + ("" if error is None else f" ± {form(error)}")
