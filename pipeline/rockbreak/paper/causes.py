"""Why numbers of the paper are not reproduced: what varying the causes has shown (README.md, Causes)."""
CAUSES = {
    "large_displacements": "a matter of scale: the paper's counts need an assembly of 5.3 to 5.7 m radius, ours has "
                           "7.7 m",
    ("contacts", "0 %"): "shapes and stiffness: 9 % more contacts at rest",
    ("weak_forces", "0 %"): "the paper's 0 % row has a mean force that its pressure cannot have",
    ("moderate_forces", "0 %"): "the paper's 0 % row has a mean force that its pressure cannot have",
    "particles": "at low pressure what breaks off first is smaller than the smallest piece allowed",
    "peak_strain": "flat curves: the place of the largest value scatters",
}


def cause_of(quantity, column):
    """In words; "" where none is known."""
    return CAUSES.get((quantity, column), CAUSES.get(quantity, ""))
