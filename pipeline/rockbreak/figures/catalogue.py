"""Every figure that a report can show: what it is in the paper, what it needs, how it is drawn, what its caption says.

A figure is drawn wherever its `needs` hold, and left out without a word where a run lacks what it is drawn from (no
breakage, no friction, no energy ledger).
"""
from dataclasses import dataclass
from typing import Callable, Optional

from . import assemblies, breakage, cracks, curves, energy, fabric, forces, strength
from .drawn import Drawn

RUN, PRESSURES = "one run", "pressures"  # what a figure needs at least

SECTIONS = (("response", "Response of the assembly"), ("micro", "Particles and forces"),
            ("fabric", "Fabric and strength"), ("pressure", "Effect of the confining pressure"),
            ("breakage", "Breakage"), ("energy", "Energy"), ("checks", "Checks"))


@dataclass(frozen=True)
class Entry:
    name: str              # of its files and its place on the page
    paper: Optional[str]   # number of the figure in the paper
    section: str
    title: str
    caption: str           # what is seen, and how it was computed
    draw: Callable         # Selection -> Drawn, or None where the runs lack something
    needs: str = RUN

    def applies_to(self, selection):
        return self.needs == RUN or (selection.is_grid and len(selection.pressures) > 1)

    def drawn(self, selection) -> Optional[Drawn]:
        return self.draw(selection) if self.applies_to(selection) else None


def pictures(draw):
    return lambda selection: draw(assemblies.against_strain(selection))


def by_pressure(draw, stage):
    return lambda selection: draw(assemblies.against_pressure(selection, stage))


def roses(draw, layout):
    return lambda selection: draw(layout(selection))


CLASSES_NOTE = "Below each picture: how many of each class, in the order of the legend."
FITTED = "Limits of the classes: those that fit the paper's counts best, which states none."
STRESS = ("Mean stress of each particle from its contact forces (its virial, equal to the average over the finite "
          f"elements where the forces balance), compression positive. {CLASSES_NOTE} {FITTED}")

LOWEST = "Of several seeds the lowest."
BESIDE = "Marks, for the paper's assembly at 2 MPa: its Table 2."

CATALOGUE = (
    Entry("deviator", None, "response", "Deviator stress",
          "Axial less lateral mean stress of the assembly (Eq. 13).", curves.deviator),
    Entry("friction_angle", None, "response", "Mobilized friction",
          "sin φ of Eq. 12 from the mean stresses, as a running mean over 0.2 % axial strain.", curves.friction_angle),
    Entry("volumetric_strain", None, "response", "Volumetric strain",
          "Of the boundary's deformation; compression positive, so that a falling curve is dilation.",
          curves.volumetric_strain),
    Entry("void_ratio", None, "response", "Void ratio",
          "e1: ring polygon over the solids inside it; e2: the same with overlaps subtracted; e4: ring polygon over "
          "the particles that are not on the boundary; each less 1. A comparison shows the definition of its scenes.",
          curves.void_ratio),
    Entry("particles", None, "response", "Number of particles",
          f"Each breakage makes two particles of one. {BESIDE}", curves.particles),
    Entry("contacts", None, "response", "Number of contacts", f"Contacts in force. {BESIDE}",
          curves.contacts),

    Entry("displacements", "3", "micro", "Displacements and fragments",
          "Length of each particle's displacement since the start of shear, on one scale; particles that have come out "
          "of breakage are black.", pictures(assemblies.displacements)),
    Entry("force_chains", "4", "micro", "Normal force chains",
          "A line joins the centroids of two particles over their contact point; colour and width tell the class of "
          f"the normal force. Boundary particles are darker. {CLASSES_NOTE} {FITTED}",
          pictures(assemblies.force_chains)),
    Entry("vertical_stresses", "5", "micro", "Vertical particle stresses", STRESS,
          pictures(assemblies.vertical_stresses)),
    Entry("horizontal_stresses", "6", "micro", "Horizontal particle stresses", STRESS,
          pictures(assemblies.horizontal_stresses)),
    Entry("force_pdf", "7", "micro", "Probability density of normal forces",
          "Of all contacts that carry force, in 30 equal bins up to the force that 1 in 2000 of those shown exceeds; "
          "logarithmic density.", forces.force_pdf),

    Entry("contact_orientation", "9", "fabric", "Contact orientations",
          "Bars: contacts whose normal lies in each 10°, both directions of a normal counted. Line: the fit of Eq. 7.",
          roses(fabric.contact_orientation, fabric.at_stages)),
    Entry("normal_force_directions", "10", "fabric", "Normal forces by direction",
          "Bars: mean normal force of the contacts in each 10°. Line: the fit of Eq. 8.",
          roses(fabric.normal_forces, fabric.at_stages)),
    Entry("shear_force_directions", "11", "fabric", "Shear forces by direction",
          "Bars: size of the mean shear force of the contacts in each 10°; its sign alternates from quadrant to "
          "quadrant. Line: the fit of Eq. 9.", roses(fabric.shear_forces, fabric.at_stages)),
    Entry("anisotropies", "12", "fabric", "Anisotropies",
          "a, a_n and a_t of second-order Fourier fits (Eqs. 7 to 9), and their sum.", strength.anisotropies),
    Entry("stress_and_fabric", "13", "fabric", "Stress and fabric",
          "sin φ from the mean stresses (Eq. 12, running mean over 0.2 %), and from the anisotropies by Eq. 10 and by "
          "its simplified form, Eq. 11.", strength.stress_and_fabric),

    Entry("displacements_by_pressure", "14", "pressure", "Displacements at the end",
          "As in the figure against strain, at the end of each test, on one scale.",
          by_pressure(assemblies.displacements, "end"), PRESSURES),
    Entry("force_chains_by_pressure", "15", "pressure", "Normal force chains at the peak",
          f"In the frame nearest to the peak of sin φ. {CLASSES_NOTE}", by_pressure(assemblies.force_chains, "peak"),
          PRESSURES),
    Entry("vertical_stresses_by_pressure", "16", "pressure", "Vertical particle stresses at the peak",
          f"In the frame nearest to the peak of sin φ. {CLASSES_NOTE}",
          by_pressure(assemblies.vertical_stresses, "peak"), PRESSURES),
    Entry("contact_orientation_by_pressure", "17", "pressure", "Contact orientations at the peak",
          "Bars: contacts whose normal lies in each 10°. Line: the fit of Eq. 7.",
          roses(fabric.contact_orientation, fabric.at_peak), PRESSURES),
    Entry("normal_force_directions_by_pressure", "18", "pressure", "Normal forces by direction at the peak",
          "Bars: mean normal force of the contacts in each 10°. Line: the fit of Eq. 8.",
          roses(fabric.normal_forces, fabric.at_peak), PRESSURES),
    Entry("shear_force_directions_by_pressure", "19", "pressure", "Shear forces by direction at the peak",
          "Bars: size of the mean shear force of the contacts in each 10°. Line: the fit of Eq. 9.",
          roses(fabric.shear_forces, fabric.at_peak), PRESSURES),
    Entry("anisotropies_by_pressure", "20", "pressure", "Anisotropies at all pressures",
          "Second-order Fourier fits (Eqs. 7 to 9), and their sum.", strength.anisotropies_by_pressure, PRESSURES),
    Entry("stress_and_fabric_by_pressure", "21", "pressure", "Stress and fabric at all pressures",
          "sin φ from the mean stresses (Eq. 12, lines) and from the anisotropies (Eq. 10, marks).",
          strength.stress_and_fabric_by_pressure, PRESSURES),
    Entry("peak_friction", "22", "pressure", "Peak friction angle",
          "From the largest running mean of sin φ (Eq. 12), and from the anisotropies in the frame nearest to it "
          "(Eq. 10).", strength.peak_friction, PRESSURES),

    Entry("gradations", None, "breakage", "Gradation",
          f"Share by mass of the particles up to each equivalent diameter. {LOWEST}", breakage.gradations),
    Entry("breakage_against_strain", None, "breakage", "Breakage against strain",
          "Mass of all particles that have come out of breakage; Marsal's index of the gradation before and after, on "
          "sieves a factor of 2^(1/4) apart; Hardin's relative breakage, 1 where all is broken down to the smallest "
          "piece that the scene allows.", breakage.breakage_against_strain),
    Entry("breakage_by_pressure", None, "breakage", "Breakage against pressure",
          "At the end of each test; a mark for each run, lines through the means.", breakage.breakage_by_pressure,
          PRESSURES),
    Entry("fragments_by_generation", None, "breakage", "Fragments by generation",
          "At the end: the mass of particles that never broke and of fragments by the number of breakages behind them. "
          f"{LOWEST}",
          breakage.fragments_by_generation),
    Entry("crack_rose", None, "breakage", "Directions of breakage lines",
          "Lines along which particles broke, all breakages of the test, as share in each 10° (90° is the loading "
          "axis), by the mode in which the crack began.", cracks.crack_rose),

    Entry("energy", None, "energy", "Energy by kind",
          "Work done on the assembly since the start of shear and where it went; the residual is a check.",
          energy.energy),
    Entry("energy_shares", None, "energy", "Where the work went",
          "Shares at the end of each test, means over the seeds.", energy.energy_shares),

    Entry("servo_error", None, "checks", "Servo", "Lateral stress less the confining pressure, relative to it.",
          energy.servo_error),
    Entry("unrest", None, "checks", "Quasi-static?",
          "Unbalanced force: mean resultant on a free particle over the mean normal force.", energy.unrest),
    Entry("phases", None, "checks", "Time", "Wall time per phase; handover is what the exchange itself costs.",
          energy.phases),
)
