"""The numbers of summary.json, from runs that were made with known ones."""
import json

import numpy as np
import pytest

import synthetic
from rockbreak.run.history import running_mean
from rockbreak.run.results import Results
from rockbreak.run.run_directory import RunDirectory

KEYS = {
    "schema", "case", "particles_initial", "particles_final", "broken_total", "refused_total", "confining_pressure",
    "initial_void_ratio", "final_void_ratio", "void_ratios", "particles_at_strain", "unbalanced_force_at_rest",
    "lateral_stress_error_rms", "contacts_initial", "contacts_peak", "contacts_final", "peak_sin_phi", "peak_strain",
    "residual_sin_phi", "anisotropy_peak", "sin_phi_micro_peak", "solid_area_error", "momentum_error", "energy",
    "max_inertial_number", "wall_seconds", "coupling_overhead", "steps", "contact_steps"}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """21 frames to 10 % strain, every second one breaking one of 48 particles; the last split is not applied."""
    return synthetic.write_run(tmp_path_factory.mktemp("summary") / "case", breaks=lambda k: 1 if k % 2 == 0 else 0)


@pytest.fixture(scope="module")
def summary(run):
    return Results(RunDirectory(run)).summary


def test_every_agreed_key_is_there_and_the_whole_is_json(summary):
    assert KEYS <= set(summary)
    assert set(summary["energy"]) == {"boundary_work", "friction", "damping", "elastic", "kinetic",
                                      "released_by_breakage", "contact_law_work", "residual"}
    assert set(summary["wall_seconds"]) == {"total", "dem", "xfem", "handover", "report"}
    json.loads(json.dumps(summary, allow_nan=False))


def test_particles_are_counted_by_the_splits_applied(summary):
    assert (summary["particles_initial"], summary["particles_final"], summary["broken_total"]) == (48, 58, 11)
    # 0.5 % strain between frames: frame 4 stands at 2 %, after the splits of frames 0 and 2.
    assert summary["particles_at_strain"] == {"0.00": 48, "0.02": 50, "0.05": 53, "0.07": 55, "0.10": 58}


def test_the_end_of_the_test_is_reported_at_its_own_strain(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=5, strain=0.035)
    counts = Results(RunDirectory(run)).summary["particles_at_strain"]
    assert list(counts) == ["0.00", "0.02", "0.035"]


def test_strength_comes_from_the_smoothed_history(summary):
    assert summary["peak_strain"] == pytest.approx(0.04, abs=0.001)
    assert summary["peak_sin_phi"] == pytest.approx(0.5, abs=0.002)
    late = np.linspace(0.08, 0.10, 1000)
    assert summary["residual_sin_phi"] == pytest.approx(np.mean(0.4 + 0.1 * np.exp(-(late - 0.04) / 0.02)), abs=1e-3)


def test_anisotropies_are_those_of_the_frame_at_the_peak(summary):
    assert summary["anisotropy_peak"] == pytest.approx({"a": 0.3, "a_n": 0.5, "a_t": 0.2}, abs=0.01)
    assert summary["sin_phi_micro_peak"] == pytest.approx(0.465, abs=0.01)


def test_errors_and_energies_come_from_history(summary):
    assert summary["lateral_stress_error_rms"] == pytest.approx(0.01)
    assert summary["unbalanced_force_at_rest"] == pytest.approx(5e-4)
    assert summary["max_inertial_number"] == pytest.approx(4e-4)
    assert summary["energy"]["boundary_work"] == pytest.approx(2e6 * 0.10 * 20)
    assert summary["energy"]["friction"] == pytest.approx(0.6 * summary["energy"]["boundary_work"])
    assert summary["void_ratios"]["final"]["e1"] == pytest.approx(0.23)
    assert summary["solid_area_error"] < 1e-12


def test_a_lost_piece_shows_in_the_solid_area(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=3)
    with synthetic.edited(run / "frames" / "000002.h5") as file:
        file["particles/area"][3] *= 0.5
    assert Results(RunDirectory(run)).summary["solid_area_error"] == pytest.approx(0.5 / 48, rel=0.02)


def test_what_an_effect_would_write_is_null_without_it(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=3, breakable=False)
    for file in (run / "frames").glob("*.h5"):
        with synthetic.edited(file) as frame:
            for column in ("boundary_work", "friction_dissipation", "momentum_error"):
                del frame["history"][column]
    summary = Results(RunDirectory(run)).summary
    assert summary["energy"]["boundary_work"] is None and summary["momentum_error"] is None
    assert summary["broken_total"] is None


def test_effects_beyond_the_papers_have_keys_only_where_they_exist(tmp_path, summary):
    assert "mass_scaling" not in summary and "gravity_work" not in summary["energy"]
    run = synthetic.write_run(tmp_path / "run", frames=3)
    for path in sorted((run / "frames").glob("*.h5")):
        with synthetic.edited(path) as frame:
            rows = len(frame["history/step"])
            for column, value in (("gravity_work", 7.0), ("rolling_dissipation", 3.0), ("scaled_particles", 5.0),
                                  ("added_mass", 0.02)):
                frame["history"][column] = np.full(rows, value)
    found = Results(RunDirectory(run)).summary
    assert found["energy"]["gravity_work"] == 7 and found["energy"]["rolling"] == 3
    assert "contact_damping" not in found["energy"]
    assert found["mass_scaling"] == {"scaled_particles": 5, "added_mass": 0.02}


def test_a_run_that_only_has_its_prepared_state_has_a_summary(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=3)
    for k in (1, 2):
        (run / "frames" / f"{k:06d}.h5").unlink()
    summary = Results(RunDirectory(run)).summary
    assert summary["peak_sin_phi"] is None and summary["complete"] is False
    assert summary["initial_void_ratio"] == pytest.approx(0.3)


def test_running_mean_is_the_mean_over_the_window():
    x = np.linspace(0, 1, 101)
    y = np.random.default_rng(1).normal(size=101)
    expected = [np.mean(y[np.abs(x - centre) <= 0.1 + 1e-9]) for centre in x]
    assert running_mean(x, y, 0.2 + 2e-9) == pytest.approx(np.array(expected), rel=1e-9)
