"""What the paper's sentences speak of, measured in one run: quantity and column -> number.

Columns are stages of the test: "start" and "end" of shear, "peak" of shear strength, "2 %", "7 %", "10 %", "17.3 %" of
axial strain; "test" is the whole of it. A stage that the run has not reached has no entries. sin(phi) at the end is the
mean over the last 2 % of strain, at 7 and 10 % that over 1 % to both sides.
"""
import numpy as np

from ..measures.breakage import read_breakages
from ..measures.classes import read_contact_state
from ..measures.displacements import frame_motion
from ..measures.forces import tail_variation, uniformity
from ..measures.frame import read_frame
from ..measures.gradation import frame_gradation
from .rows import LABELS
from ..run.history import running_mean, shear_rows, sin_phi
from ..run.results import nearest
from ..run.summary import RESIDUAL_WINDOW, SMOOTHING_WINDOW

WORDS = LABELS | {
    "vertical_normal_force": "vertical normal force, Eq. 8 [kN]",
    "horizontal_normal_force": "horizontal normal force, Eq. 8 [kN]",
    "diagonal_shear_force": "shear force at 45°, f_0 a_t [kN]", "mean_force": "mean normal force [kN]",
    "tilt_of_normal_forces": "angle of θ_n to the vertical [deg]",
    "tilt_of_shear_forces": "angle of the shear forces' axis to the vertical [deg]",
    "vertical_contacts": "contacts nearer to the vertical", "horizontal_contacts": "contacts nearer to the horizontal",
    "shear_over_normal": "mean shear / mean normal force", "gini": "Gini coefficient of normal forces",
    "top_tenth": "share that the strongest tenth of the contacts carries",
    "force_scatter": "standard deviation of normal forces [kN]",
    "tail_variation": "scatter over mean of what exceeds the mean force",
    "share_below_mean": "share of the forces below their mean",
    "force_at_fragments": "mean normal force at fragments / among unbroken particles",
    "uniformity_of_sizes": "coefficient of uniformity d60 / d10", "largest_displacement": "largest displacement [m]",
    "lateral_stretch": "lateral expansion of the assembly", "void_ratio": "void ratio e4",
    "void_ratio_rise": "rise of void ratio e4", "percentage_of_breakage": "new particles, % of 1194",
    "breakage_outside_over_inside": "share of particles that break, outer over inner half",
    "eq10_error": "mean size of Eq. 10 − Eq. 12", "eq11_error": "mean of Eq. 11 − Eq. 12",
    "weak_share": "share of weak forces", "loaded_vertical": "particles of medium and high vertical stress",
    "loaded_horizontal": "particles of medium and high horizontal stress",
    "moderate_and_strong": "moderate and strong forces", "outer_over_inner": "outer over inner mean displacement",
}
STRAINS = {"start": 0.0, "2 %": 0.02, "7 %": 0.07, "10 %": 0.10, "17.3 %": 0.173}
FABRIC_SPACING = 0.005  # axial strain between the frames in which Eqs. 10 and 11 are compared with Eq. 12
VERTICAL, HORIZONTAL = np.pi / 2, 0.0


def observe(results):
    """(quantity, column) -> number of one run (Results)."""
    found = {}
    for column, row in stages(results).items():
        path = results.directory.frame_file(results.frames[row]["frame"])
        state = frame_numbers(read_frame(path), results.anisotropies(results.frames[row]["frame"]))
        state |= with_sums(read_contact_state(path).counts())
        found |= {(quantity, column): value for quantity, value in state.items()}
    found |= {(quantity, column): value for (quantity, column), value in of_the_test(results).items()}
    return {key: float(value) for key, value in found.items() if value is not None}


def stages(results):
    """Column -> row in the table of frames."""
    frames, summary = results.frames, results.summary
    end = frames[-1]["axial_strain"]
    spacing = end / (len(frames) - 1) if len(frames) > 1 else 0.0
    rows = {column: nearest(frames, strain) for column, strain in STRAINS.items() if strain <= end + spacing}
    if summary["complete"]:
        rows["end"] = len(frames) - 1
        rows["peak"] = nearest(frames, summary["peak_strain"] or 0.0)
    return rows


def frame_numbers(frame, fit):
    """Of one Frame and its Anisotropies. Forces [kN], lengths [m]."""
    loaded = frame.normal_force > 0
    normal, force, shear = frame.normal[loaded], frame.normal_force[loaded], np.abs(frame.shear_force[loaded])
    if fit is None:
        return {}
    vertical = np.abs(normal[:, 1]) > np.abs(normal[:, 0])
    shares = uniformity(force)
    at_fragment = (frame.generation[frame.a[loaded]] > 0) | (frame.generation[frame.b[loaded]] > 0)
    motion = frame_motion(frame)
    place = frame.position - frame.displacement
    radius = np.linalg.norm(place - place.mean(axis=0), axis=1)
    moved = np.linalg.norm(frame.displacement, axis=1)
    inner = radius < 0.5 * radius.max()
    return {
        "a": fit.a, "a_n": fit.a_n, "a_t": fit.a_t, "anisotropy": fit.sum,
        "tilt_of_normal_forces": tilt(fit.theta_n, VERTICAL), "tilt_of_shear_forces": tilt(fit.theta_shear, VERTICAL),
        "vertical_normal_force": 1e-3 * fit.normal(VERTICAL),
        "horizontal_normal_force": 1e-3 * fit.normal(HORIZONTAL),
        "diagonal_shear_force": 1e-3 * fit.mean_normal_force * fit.a_t,
        "vertical_contacts": vertical.sum(), "horizontal_contacts": (~vertical).sum(),
        "mean_force": 1e-3 * force.mean(), "shear_over_normal": shear.mean() / force.mean(),
        "gini": shares.gini, "top_tenth": shares.top_tenth, "tail_variation": tail_variation(force),
        "share_below_mean": 1 - shares.above_mean,
        "force_at_fragments": (force[at_fragment].mean() / force[~at_fragment].mean()
                               if 0 < at_fragment.sum() < len(force) else None),
        "force_scatter": 1e-3 * force.std(), "uniformity_of_sizes": frame_gradation(frame).uniformity,
        "largest_displacement": moved.max(),
        "outer_over_inner": moved[~inner].mean() / moved[inner].mean() if moved[inner].any() else None,
        "lateral_stretch": -motion.strain[0],
    }


def with_sums(counts):
    """Counts of classes, and what the sentences take together."""
    return counts | {
        "weak_share": counts["weak_forces"] / counts["contacts"] if counts["contacts"] else None,
        "moderate_and_strong": counts["moderate_forces"] + counts["strong_forces"],
        "loaded_vertical": counts["medium_vertical_stresses"] + counts["high_vertical_stresses"],
        "loaded_horizontal": counts["medium_horizontal_stresses"] + counts["high_horizontal_stresses"]}


def tilt(direction, axis):
    """Angle between two lines [deg], 0 to 90."""
    return np.degrees(np.abs((direction - axis + np.pi / 2) % np.pi - np.pi / 2))


def of_the_test(results):
    summary = results.summary
    found = {("sin_phi", "peak"): summary["peak_sin_phi"], ("peak_strain", "peak"): summary["peak_strain"]}
    rows = shear_rows(results.history)
    for column in ("7 %", "10 %"):
        if results.frames[-1]["axial_strain"] >= STRAINS[column] + RESIDUAL_WINDOW / 2:
            near = np.abs(rows["axial_strain"] - STRAINS[column]) <= RESIDUAL_WINDOW / 2
            found["sin_phi", column] = sin_phi(rows)[near].mean()
    found |= {(f"eq{equation}_error", "test"): value for equation, value in equations_10_11(results).items()}
    if not summary["complete"]:
        return found
    void = summary["void_ratios"]
    found[("sin_phi", "end")] = summary["residual_sin_phi"]
    found[("void_ratio", "end")] = void["final"]["e4"]
    found[("void_ratio_rise", "end")] = void["final"]["e4"] - void["initial"]["e4"]
    if results.breakable:
        first = results.frames[0]["particles"]
        found[("percentage_of_breakage", "end")] = 100 * (results.frames[-1]["particles"] / first - 1)
        found[("breakage_outside_over_inside", "end")] = outside_over_inside(results)
    return found


def equations_10_11(results):
    """Mean of |Eq. 10 - Eq. 12| and of Eq. 11 - Eq. 12 over the test, in frames FABRIC_SPACING apart; {} if none."""
    rows = shear_rows(results.history)
    if not len(rows["axial_strain"]):
        return {}
    smooth = running_mean(rows["axial_strain"], sin_phi(rows), SMOOTHING_WINDOW)
    ten, eleven = [], []
    last = results.frames[-1]["axial_strain"]
    for strain in np.arange(FABRIC_SPACING, last + 1e-9, FABRIC_SPACING):
        frame = results.frames[nearest(results.frames, strain)]
        fit = results.anisotropies(frame["frame"])
        if fit is not None:
            measured = np.interp(frame["axial_strain"], rows["axial_strain"], smooth)
            ten.append(abs(fit.sin_phi - measured))
            eleven.append(fit.sin_phi_simplified - measured)
    return {10: np.mean(ten), 11: np.mean(eleven)} if ten else {}


def outside_over_inside(results):
    """Share of original particles that break, of those in the outer half of the unbroken ones over the inner half.

    Boundary particles never break and do not count. None without a breakage inside.
    """
    first = read_frame(results.directory.frame_file(results.frames[0]["frame"]))
    breakages = read_breakages(results.directory.path)
    free = ~first.boundary
    radius = np.linalg.norm(first.position - first.position.mean(axis=0), axis=1)
    outer = radius > np.median(radius[free])
    broke = np.isin(first.id, breakages.root) & free
    inside = broke[~outer & free].sum() / (~outer & free).sum()
    return broke[outer & free].sum() / (outer & free).sum() / inside if inside else None
