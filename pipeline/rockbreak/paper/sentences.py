"""The sentences of the paper's Sections 4.1 and 4.2 that state a number or a trend, paraphrased, and what decides each.

Those of 4.3 and 5 stand in sentences_pressure.py. `paper` holds the paper's numbers behind a sentence, where its tables
give them; "drawn" where it only draws them. `cause` is said where our runs do not show the trend.
"""
from typing import NamedTuple

from .evidence import Between, Beyond, ByBreakage, Widens, Within

AT_2MPA = (2e6,)
SOLID, BROKEN = (False,), (True,)
DELAYED = "breakage delays the strength: what it takes before 10 % strain is there again at a later peak"


class Sentence(NamedTuple):
    where: str
    says: str
    paper: str
    parts: tuple      # of evidence.py; none: not decidable, and `cause` tells why
    cause: str = ""


def grows(quantity, *columns, sign=1, assemblies=(False, True)):
    """Between each stage and the next."""
    return tuple(Between(quantity, pair, sign, assemblies) for pair in zip(columns, columns[1:]))


def falls(quantity, *columns, assemblies=(False, True)):
    return grows(quantity, *columns, sign=-1, assemblies=assemblies)


SECTION_4_1 = (
    Sentence("4.1, Fig. 3", "particles of the central area move little, those of the outer area more", "drawn",
             (Within("outer_over_inner", "end", 1.5, 10, pressures=AT_2MPA),)),
    Sentence("4.1, Fig. 3", "more particles break in the outer area than in the centre", "drawn",
             (Beyond("breakage_outside_over_inside", "end", 1, 1.0, BROKEN, AT_2MPA),),
             "affine motion strains all places alike; the stress of our sample is even, too"),
    Sentence("4.1, Fig. 3, Table 4", "new particles fill voids: breakage lowers the void ratio", "0.336 → 0.316",
             (ByBreakage("void_ratio", "end", -1, AT_2MPA),)),
    Sentence("4.1, Fig. 3", "breakage lowers the largest displacement at the end", "drawn",
             (ByBreakage("largest_displacement", "end", -1, AT_2MPA),)),
    Sentence("4.1, Fig. 3", "more so at the end of the test, when much has broken", "drawn",
             (Widens("largest_displacement", ("7 %", "end"), -1),)),
    Sentence("4.1, Fig. 3", "breakage lowers dilation", "rise of e 0.036 → 0.016",
             (ByBreakage("void_ratio_rise", "end", -1, AT_2MPA), ByBreakage("lateral_stretch", "end", -1, AT_2MPA))),
    Sentence("4.1, Fig. 4", "at the start mainly weak forces", "80 % weak",
             (Within("weak_share", "start", 0.5, 1, pressures=AT_2MPA),),
             "twice as many moderate forces at rest: the paper's 0 % row has a mean force that its pressure cannot "
             "have"),
    Sentence("4.1, Fig. 4", "moderate and strong forces grow in number during shear", "396 → 1286 (10 %)",
             grows("moderate_and_strong", "start", "10 %")),
    Sentence("4.1, Fig. 4", "chains form mainly along the vertical", "drawn",
             (Within("tilt_of_normal_forces", "peak", 0, 10, pressures=AT_2MPA),)),
    Sentence("4.1, Fig. 4; 4.2, Fig. 10", "horizontal forces stay small and almost constant", "drawn",
             (Between("horizontal_normal_force", ("start", "peak"), 0), Between("horizontal_normal_force",
                                                                            ("peak", "end"), 0)),
             "a_n grows at once, and the fit of Eq. 8 lowers the horizontal force with it"),
    Sentence("4.1, Fig. 5", "medium and high vertical stresses grow in number during shear", "189 → 608 (10 %)",
             grows("loaded_vertical", "start", "7 %")),
    Sentence("4.1, Fig. 6", "horizontal stresses grow slightly at first", "186 → 375 (7 %)",
             grows("loaded_horizontal", "start", "7 %")),
    Sentence("4.1, Fig. 6", "and then stay relatively constant", "375, 399, 367 (7, 10, 17.3 %)",
             (Between("loaded_horizontal", ("7 %", "10 %"), 0), Between("loaded_horizontal", ("10 %", "17.3 %"), 0))),
    Sentence("4.1, Fig. 5", "vertical stresses fall after 10 % strain", "high: 132 → 85, breakable 60 → 43",
             falls("high_vertical_stresses", "10 %", "17.3 %")),
    Sentence("4.1", "forces and stresses are highest, and the strength has its peak, at 10 % strain", "10 %",
             (Within("peak_strain", "peak", 0.09, 0.11, pressures=AT_2MPA),),
             "the curves are flat around the peak and one sample fluctuates by 0.02, so its place scatters from 2 to "
             "17 %"),
    Sentence("4.1, Table 2", "strong forces and high stresses grow in number until the peak, then fall slightly",
             "92, 121, 85; 102, 132, 85 (7, 10, 17.3 %)",
             grows("strong_forces", "start", "7 %", assemblies=SOLID)
             + grows("strong_forces", "7 %", "10 %", assemblies=SOLID)
             + grows("high_vertical_stresses", "start", "7 %", "10 %", assemblies=SOLID)
             + falls("strong_forces", "10 %", "17.3 %", assemblies=SOLID)
             + falls("high_vertical_stresses", "10 %", "17.3 %", assemblies=SOLID),
             "our peak is a plateau from 3 to 12 % strain"),
    Sentence("4.1, Table 2", "breakage lowers the number of strong forces", "121 → 56, 85 → 40 (10, 17.3 %)",
             (ByBreakage("strong_forces", "10 %", -1, AT_2MPA), ByBreakage("strong_forces", "17.3 %", -1, AT_2MPA))),
    Sentence("4.1, Table 2", "breakage lowers the number of particles under high stress",
             "132 → 60, 85 → 43 (10, 17.3 %)",
             (ByBreakage("high_vertical_stresses", "10 %", -1, AT_2MPA),
              ByBreakage("high_vertical_stresses", "17.3 %", -1, AT_2MPA)),
             "fragments count as particles: each split makes two, and the larger piece keeps its stress"),
    Sentence("4.1, Fig. 4", "more so at high strains, where more has broken", "−14, −65, −45 (7, 10, 17.3 %)",
             (Widens("strong_forces", ("7 %", "17.3 %"), -1),)),
    Sentence("4.1", "forces between the new smaller particles are lower", "–",
             (Beyond("force_at_fragments", "10 %", -1, 1.0, BROKEN, AT_2MPA),)),
    Sentence("4.1", "breakage lowers the magnitude of forces", "drawn",
             (ByBreakage("mean_force", "10 %", -1, AT_2MPA), ByBreakage("mean_force", "17.3 %", -1, AT_2MPA))),
    Sentence("4.1, Table 2", "breakage lowers the number of large displacements", "86 → 41",
             (ByBreakage("large_displacements", "end", -1, AT_2MPA),)),
    Sentence("4.1, Fig. 7", "at the start low forces prevail", "drawn",
             (Within("share_below_mean", "start", 0.5, 1.0, pressures=AT_2MPA),)),
    Sentence("4.1, Fig. 7", "and strong ones fall off exponentially (our reading: scatter over mean of what exceeds "
             "the mean force is 1 to a tenth)", "drawn",
             (Within("tail_variation", "start", 0.9, 1.1, pressures=AT_2MPA),),
             "they fall off faster (1 is exponential, 0.76 half a normal distribution)"),
    Sentence("4.1, Fig. 7", "strong forces grow in number with strain", "0 → 121 (10 %)",
             grows("strong_forces", "start", "10 %")),
    Sentence("4.1, Fig. 7, Table 2", "breakage makes more low forces and fewer strong ones",
             "weak 661 → 938, 717 → 1091 (10, 17.3 %)",
             (ByBreakage("weak_forces", "10 %", 1, AT_2MPA), ByBreakage("weak_forces", "17.3 %", 1, AT_2MPA))),
    Sentence("4.1, Figs. 4, 7", "breakage makes the distribution of forces more uniform: in newtons", "drawn",
             (ByBreakage("force_scatter", "10 %", -1, AT_2MPA), ByBreakage("force_scatter", "17.3 %", -1, AT_2MPA))),
    Sentence("4.1, Figs. 4, 7", "the same, relative to the mean force: Gini coefficient, share of the strongest tenth",
             "drawn", (ByBreakage("gini", "17.3 %", -1, AT_2MPA), ByBreakage("top_tenth", "17.3 %", -1, AT_2MPA)),
             "more small pieces mean more weak contacts: relative to the mean, forces become less uniform; the paper's "
             "own classes do, too (85 → 40 strong, but 717 → 1091 weak)"),
)
SECTION_4_2 = (
    Sentence("4.2, Figs. 9, 10", "before shear contacts and normal forces are almost isotropic", "drawn",
             (Within("a", "start", 0, 0.1, pressures=AT_2MPA), Within("a_n", "start", 0, 0.1, pressures=AT_2MPA))),
    Sentence("4.2, Fig. 11", "before shear the shear forces are very small", "drawn",
             (Within("shear_over_normal", "start", 0, 0.1, pressures=AT_2MPA),
              Within("a_t", "start", 0, 0.05, pressures=AT_2MPA)),
             "friction is used up while the sample is prepared: shear forces without a common direction are left"),
    Sentence("4.2, Fig. 9", "contacts are lost along the horizontal", "drawn",
             falls("horizontal_contacts", "start", "peak")),
    Sentence("4.2, Fig. 9", "and gained along the vertical", "total 2015 → 1947 (10 %)",
             grows("vertical_contacts", "start", "peak"),
             "a dense sample that dilates loses contacts in all directions, vertical ones least"),
    Sentence("4.2, Fig. 9", "breakage makes new contacts", "1947 → 2338 (10 %)",
             (ByBreakage("contacts", "10 %", 1, AT_2MPA), ByBreakage("horizontal_contacts", "10 %", 1, AT_2MPA),
              ByBreakage("vertical_contacts", "10 %", 1, AT_2MPA))),
    Sentence("4.2", "breakage broadens the distribution of sizes", "drawn",
             (ByBreakage("uniformity_of_sizes", "end", 1, AT_2MPA),)),
    Sentence("4.2, Fig. 10", "vertical normal forces grow until the peak and fall afterwards", "drawn",
             grows("vertical_normal_force", "start", "peak") + falls("vertical_normal_force", "peak", "end")),
    Sentence("4.2, Fig. 10", "breakage lowers the vertical normal forces", "drawn",
             (ByBreakage("vertical_normal_force", "10 %", -1, AT_2MPA),)),
    Sentence("4.2, Fig. 11", "shear forces grow at 45° to the horizontal until the peak and fall afterwards", "drawn",
             grows("diagonal_shear_force", "start", "peak") + falls("diagonal_shear_force", "peak", "end")),
    Sentence("4.2, Fig. 11", "their directions are ±45°", "drawn",
             (Within("tilt_of_shear_forces", "peak", 0, 10, pressures=AT_2MPA),)),
    Sentence("4.2, Figs. 11, 12", "a_t grows at once and stays almost constant", "drawn",
             (Between("a_t", ("2 %", "10 %"), 0), Between("a_t", ("10 %", "17.3 %"), 0)),
             "a_t has its largest value at 2 to 3 % strain and falls by a tenth to a fifth afterwards"),
    Sentence("4.2, Fig. 11", "breakage lowers the shear forces at 45°", "drawn",
             (ByBreakage("diagonal_shear_force", "10 %", -1, AT_2MPA),)),
    Sentence("4.2, Figs. 11, 12", "breakage lowers a_t", "drawn", (ByBreakage("a_t", "10 %", -1, AT_2MPA),)),
    Sentence("4.2, Figs. 9, 12", "a grows steadily", "drawn", grows("a", "start", "2 %", "10 %")),
    Sentence("4.2, Fig. 12", "a grows less after the peak", "drawn", (Between("a", ("10 %", "17.3 %"), 0),),
             "a goes on scattering after the peak"),
    Sentence("4.2, Figs. 9, 12", "breakage lowers a", "drawn",
             (ByBreakage("a", "10 %", -1, AT_2MPA), ByBreakage("a", "17.3 %", -1, AT_2MPA))),
    Sentence("4.2, Fig. 12", "a_n grows to a peak and falls after the peak strength", "drawn",
             grows("a_n", "start", "peak") + falls("a_n", "peak", "end")),
    Sentence("4.2, Fig. 12", "breakage lowers a_n", "drawn",
             (ByBreakage("a_n", "10 %", -1, AT_2MPA), ByBreakage("a_n", "17.3 %", -1, AT_2MPA))),
    Sentence("4.2, Fig. 12", "a + a_n + a_t grows to the peak strength and falls to a residual value", "drawn",
             grows("anisotropy", "start", "peak") + falls("anisotropy", "peak", "end")),
    Sentence("4.2, Fig. 12", "breakage lowers a + a_n + a_t", "drawn",
             (ByBreakage("anisotropy", "10 %", -1, AT_2MPA),)),
    Sentence("4.2", "breakage lowers the shear strength", "drawn", (ByBreakage("sin_phi", "peak", -1, AT_2MPA),),
             DELAYED),
    Sentence("4.2, Fig. 13", "Eq. 10 agrees well with the macroscopic sin φ (our reading: within 0.02)", "drawn",
             (Within("eq10_error", "test", 0, 0.02, pressures=AT_2MPA),)),
    Sentence("4.2, Fig. 13", "Eq. 11 is slightly above it (our reading: by up to 0.06)", "drawn",
             (Beyond("eq11_error", "test", 1, 0.0, pressures=AT_2MPA),
              Within("eq11_error", "test", 0, 0.06, pressures=AT_2MPA))),
)
