"""Whether a row of the paper is reproduced: a mean over seeds beside one number of one sample.

Reproduced: |mean - paper| within a stated tolerance. Within the scatter: beyond it, but within 2 standard deviations
over the seeds; one sample of the paper is compared with the scatter of single samples, so that the deviation is not
divided by sqrt(n). Numbers of particles are judged by the particles that breakage has added to the 1194.
"""
from .numbers import CONTACTS_2MPA, PARTICLES

REPRODUCED, NOT_REPRODUCED, UNDECIDABLE = "reproduced", "not reproduced", "not decidable"
WITHIN_SCATTER = "within the scatter"

SHARE_OF_TOTALS = 0.05    # of contacts
SHARE_OF_CLASSES = 0.10   # of the counts of classes, large displacements, new particles, and the strain at the peak
SMALLEST_SHARE = 0.005    # of all contacts or particles: what a small count N may miss, but no more than 2 sqrt(N)
VOID_RATIO = 0.005
MISFIT = 0.02             # of sin(phi): our reading of "good agreement"
SAME_START = 0.005        # void ratios are compared where our sample starts at the paper's

TOLERANCES_IN_WORDS = (
    f"{SHARE_OF_TOTALS:.0%} for the total of contacts, {SHARE_OF_CLASSES:.0%} for classes, large displacements, the "
    f"particles that breakage adds to the {PARTICLES}, and the strain at the peak, but for a count at least "
    f"{SMALLEST_SHARE:.1%} of all contacts or particles, or 2 √N of a few N (2 of none); {VOID_RATIO:g} for void "
    f"ratios; {MISFIT:g} for Eq. 10 − Eq. 12, our reading of “good agreement”")


def stated_tolerance(quantity, published):
    """In the unit of the quantity, and in words."""
    if quantity.startswith("void_ratio"):
        return VOID_RATIO, f"{VOID_RATIO:g}"
    if quantity == "sin_phi_misfit":
        return MISFIT, f"{MISFIT:g}"
    if quantity == "peak_strain":
        return SHARE_OF_CLASSES * published, f"{SHARE_OF_CLASSES:.0%}"
    share = SHARE_OF_TOTALS if quantity == "contacts" else SHARE_OF_CLASSES
    published -= PARTICLES if quantity == "particles" else 0
    everything = CONTACTS_2MPA[False][0.0] if quantity.endswith(("forces", "contacts")) else PARTICLES
    smallest = min(SMALLEST_SHARE * everything, 2 * max(published, 1) ** 0.5)  # else nothing would do for a few
    return (smallest, f"{smallest:.0f}") if smallest > share * published else (
        share * published, f"{share:.0%}" + (" of the new ones" if quantity == "particles" else ""))


def verdict(quantity, column, published, mean, deviation, starts):
    """(verdict, reason). `deviation`: None for one run. `starts`: quantity -> our mean void ratio at the start."""
    if published is None:
        return UNDECIDABLE, "only drawn in a figure"
    if mean is None:
        return UNDECIDABLE, "our runs do not have it"
    if quantity == "large_displacements" and column == "0 %":
        return UNDECIDABLE, "zero by definition"
    if quantity == "particles" and published == PARTICLES:
        return UNDECIDABLE, "set by the scene"
    if quantity.startswith("void_ratio_e"):
        if column == "start":
            return UNDECIDABLE, "the paper does not define its void ratio; ours is set by the scene"
        start, wanted = starts.get(quantity), starts["paper"]
        if start is None or abs(start - wanted) > SAME_START:
            ours = "unknown" if start is None else f"at {start:.3f}"
            return UNDECIDABLE, f"the paper does not define its void ratio; our start is {ours}, not at {wanted:.3f}"
    difference = abs(mean - published)
    tolerance, words = stated_tolerance(quantity, published)
    if difference <= tolerance * (1 + 1e-9):
        return REPRODUCED, f"within {words}"
    if deviation is None:
        return NOT_REPRODUCED, f"beyond {words}; one run has no scatter"
    if difference <= 2 * deviation:
        return WITHIN_SCATTER, f"within 2 s.d., beyond {words}"
    times = f"{difference / deviation:.1f} s.d." if deviation > 0 else "the scatter is 0"
    return NOT_REPRODUCED, f"beyond {words}; {times}"
