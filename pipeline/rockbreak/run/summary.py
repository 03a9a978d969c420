"""summary.json: the numbers of one run (keys in the order of the list in pipeline/README.md). SI units."""
import json

import numpy as np

from .history import running_mean, shear_rows, sin_phi
from .ledger import coupling_overhead, seconds_per_phase
from .results import nearest
from .run_directory import write_text

SMOOTHING_WINDOW = 0.002  # axial strain; peak_sin_phi is the largest value of the running mean over it
RESIDUAL_WINDOW = 0.02    # axial strain; residual_sin_phi is the mean over the last of it
# Entries of effects that the paper's scenes do not have: key of the summary, column of the history.
EFFECT_ENERGIES = {"contact_damping": "contact_damping_dissipation", "rolling": "rolling_dissipation",
                   "gravity_work": "gravity_work"}
REPORTED_STRAINS = (0.0, 0.02, 0.05, 0.07, 0.10, 0.15)


def summarize(results):
    """The summary of a run that has at least one frame; it may be incomplete (`complete` says so)."""
    frames, history, broken = results.frames, results.history, results.broken
    pressure = (results.case.get("preparation") or {}).get("confining_pressure")
    shear = shear_rows(history)
    strain, ratio = shear["axial_strain"], sin_phi(shear)
    smooth = running_mean(strain, ratio, SMOOTHING_WINDOW)
    peak = int(np.argmax(smooth)) if len(smooth) else None
    peak_strain = None if peak is None else float(strain[peak])
    peak_frame = frames[nearest(frames, peak_strain if peak is not None else 0.0)]
    fabric = results.anisotropies(peak_frame["frame"])
    first, last = frames[0], frames[-1]

    return {
        "schema": "run_summary/1",
        "case": results.name,
        "complete": bool(last["final"]),
        "particles_initial": first["particles"],
        "particles_final": last["particles"],
        "broken_total": sum(broken.values()) if results.breakable else None,
        "refused_total": results.refused if results.breakable else None,
        "confining_pressure": pressure,
        "initial_void_ratio": at(history, "void_ratio", 0),
        "final_void_ratio": at(history, "void_ratio", -1),
        "void_ratios": {
            name: {kind: at(history, f"void_ratio_{kind}", row) for kind in ("e1", "e2", "e4")}
            for name, row in (("initial", 0), ("final", -1))},
        "particles_at_strain": particles_at_strain(frames),
        "unbalanced_force_at_rest": at(history, "unbalanced_force", 0),
        "lateral_stress_error_rms": lateral_stress_error(shear, pressure),
        "contacts_initial": first["contacts"],
        "contacts_peak": peak_frame["contacts"],
        "contacts_final": last["contacts"],
        "peak_sin_phi": None if peak is None else float(smooth[peak]),
        "peak_strain": peak_strain,
        "residual_sin_phi": None if peak is None else float(
            np.mean(ratio[strain >= strain[-1] - RESIDUAL_WINDOW])),
        "sin_phi_definition": "(stress_yy - stress_xx) / (stress_yy + stress_xx); peak: largest running mean over "
                              f"{SMOOTHING_WINDOW:.1%} axial strain; residual: mean over the last "
                              f"{RESIDUAL_WINDOW:.0%}; anisotropies from the frame nearest to the peak",
        "anisotropy_peak": None if fabric is None else {"a": fabric.a, "a_n": fabric.a_n, "a_t": fabric.a_t},
        "sin_phi_micro_peak": None if fabric is None else fabric.sin_phi,
        "solid_area_error": abs(last["solid_area"] - first["solid_area"]) / first["solid_area"],
        "momentum_error": largest(shear, "momentum_error"),
        "energy": {
            "boundary_work": at(history, "boundary_work", -1),
            "friction": at(history, "friction_dissipation", -1),
            "damping": at(history, "damping_dissipation", -1),
            "elastic": at(history, "elastic_energy", -1),
            "kinetic": at(history, "kinetic_energy", -1),
            "released_by_breakage": at(history, "released_by_breakage", -1),
            "contact_law_work": at(history, "contact_law_work", -1),
            "residual": at(history, "energy_residual", -1),
            **{key: at(history, column, -1) for key, column in EFFECT_ENERGIES.items() if column in history},
        },
        **({"mass_scaling": {"scaled_particles": integer(at(history, "scaled_particles", -1)),
                             "added_mass": at(history, "added_mass", -1)}} if "added_mass" in history else {}),
        "max_inertial_number": largest(shear, "inertial_number"),
        "wall_seconds": wall_seconds(results.ledger()),
        "cpu_seconds": cpu_seconds(results.ledger()),
        "coupling_overhead": rounded(coupling_overhead(results.ledger()), 4),
        "steps": last["step"],
        "contact_steps": integer(at(history, "contact_steps", -1)),
    }


def wall_seconds(ledger):
    return {phase: round(value, 3) for phase, value in seconds_per_phase(ledger).items()}


def cpu_seconds(ledger):
    """User seconds of dem and xfem, interrupted starts included; None if the ledger does not tell."""
    spent = [event["cpu_seconds"] for event in ledger if event["event"] == "end" and "cpu_seconds" in event]
    return round(sum(spent), 3) if spent else None


def write_summary(directory, summary):
    write_text(directory.summary_file, json.dumps(summary, indent=2) + "\n")


def particles_at_strain(frames):
    """Number of particles in the frame nearest to each reported strain: the splits of all frames before are applied."""
    spacing = np.median(np.diff([row["axial_strain"] for row in frames])) if len(frames) > 1 else 0.0
    end = frames[-1]["axial_strain"]
    counts = {f"{strain:.2f}": frames[nearest(frames, strain)]["particles"]
              for strain in REPORTED_STRAINS if strain <= end + spacing / 2}
    if all(abs(end - float(strain)) > spacing / 2 for strain in counts):
        counts[f"{end:.3f}"] = frames[-1]["particles"]
    return counts


def lateral_stress_error(shear, pressure):
    """Root mean square of stress_xx / confining pressure - 1 over the shear stage."""
    if not pressure or "stress_xx" not in shear or len(shear["stress_xx"]) == 0:
        return None
    return float(np.sqrt(np.mean((shear["stress_xx"] / pressure - 1) ** 2)))


def at(rows, column, index):
    """None where the effect that writes the column is absent."""
    return float(rows[column][index]) if column in rows and len(rows[column]) else None


def largest(rows, column):
    return float(np.max(rows[column])) if column in rows and len(rows[column]) else None


def rounded(value, digits):
    return None if value is None else round(value, digits)


def integer(value):
    return None if value is None else int(value)
