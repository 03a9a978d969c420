"""Stress tensors with known principal values, classes, energies."""
import numpy as np
import pytest

from rockbreak import measures
from test_measures_breakage import split_of
from test_measures_frame import plain_frame


@pytest.mark.parametrize("degrees", [0, 20, 45, 90, 91, 179])
def test_principal_stresses_of_a_turned_tensor(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    stress = np.array([5 * c * c + 2 * s * s, 5 * s * s + 2 * c * c, 3 * c * s])
    major, minor, direction = measures.principal_stresses(stress)
    assert (major, minor) == pytest.approx((5, 2)) and measures.angle_between(
        direction, np.radians(degrees)) == pytest.approx(0, abs=1e-12)
    assert 0 <= direction < np.pi
    assert measures.sin_phi_of_stress(stress) == pytest.approx(3 / 7)


def test_particle_stresses_add_up_to_the_assembly_s():
    """Two squares pressed together between two more: sum of A sigma over the inner ones is their part of Eq. 13."""
    position = np.array([[0, 0], [0, 1], [0, 2], [0, 3.0]])
    a, b = np.array([0, 1, 2]), np.array([1, 2, 3])
    frame = plain_frame(position, a=a, b=b, force=np.tile([0.0, 5e6], (3, 1)))
    stress = measures.frame_stresses(frame)
    assert stress == pytest.approx(np.array([[0, 2.5e6, 0], [0, 5e6, 0], [0, 5e6, 0], [0, 2.5e6, 0]]))
    whole = measures.assembly_stress(frame.branch, frame.force, 2.0)
    assert whole == pytest.approx([0, 15e6 / 2, 0]) and whole == pytest.approx(stress.sum(axis=0) / 2)


def test_element_averages_where_the_split_has_them():
    position = np.array([[0, 0], [0, 1], [0, 2.0]])
    frame = plain_frame(position, a=[0, 1], b=[1, 2], force=np.tile([0.0, 5e6], (2, 1)), id=np.array([3, 5, 8]))
    known = np.array([[np.nan] * 3, [1e6, 4.9e6, 0.0]])
    split = split_of(plain_frame(position[:2], id=np.array([3, 5])), stress=known)
    assert measures.element_stresses(frame, split) == pytest.approx(np.array([[0, 2.5e6, 0], known[1], [0, 2.5e6, 0]]))


def test_classes_of_particles_agree_with_their_counts():
    values = np.array([-1.0, 3.9, 4.0, 12.0, 12.1])
    assert measures.class_of(values, 4, 12).tolist() == [0, 0, 1, 1, 2]
    assert np.bincount(measures.class_of(values, 4, 12)).tolist() == list(measures.stress_classes(values, 4, 12))


def ledger(rows=11):
    strain = np.linspace(0, 0.1, rows)
    return {"axial_strain": strain, "boundary_work": 1000 * strain, "friction_dissipation": 700 * strain,
            "damping_dissipation": 100 * strain, "elastic_energy": 40 + 150 * strain, "kinetic_energy": 1 + 0 * strain,
            "contact_law_work": 10 * strain, "released_by_breakage": 20 * strain}


def test_energies_balance_by_hand():
    found = measures.energies(ledger())
    assert found.input[-1] == pytest.approx(100) and found.residual[-1] == pytest.approx(100 - 98)
    assert found.spent["elastic"][-1] == pytest.approx(15) and found.spent["kinetic"] == pytest.approx(0)
    assert found.spent["elastic"][0] == 0 and "rolling" not in found.spent
    shares = found.normalised()
    assert shares.spent["friction"][-1] == pytest.approx(0.7) and shares.residual[-1] == pytest.approx(0.02)
    assert sum(v[-1] for v in shares.spent.values()) + shares.residual[-1] == pytest.approx(1)
    assert found.relative_residual == pytest.approx(0.02 / 1.15)
    assert found.normalised(50).input[-1] == pytest.approx(2)


def test_energies_of_effects_are_there_if_the_run_has_them():
    rows = ledger() | {"gravity_work": 5 * np.linspace(0, 0.1, 11), "rolling_dissipation": 5 * np.linspace(0, 0.1, 11)}
    found = measures.energies(rows)
    assert found.residual == pytest.approx(measures.energies(ledger()).residual)
    assert found.inputs["gravity_work"][-1] == pytest.approx(0.5) and found.spent["rolling"][-1] == pytest.approx(0.5)
    assert measures.energies({"axial_strain": np.zeros(3)}) is None


def test_the_package_needs_no_drawing():
    """matplotlib takes a second to load, and a cluster's node may lack it."""
    import subprocess
    import sys
    from conftest import REPOSITORY
    code = "import sys; from rockbreak import measures; sys.exit(bool({'matplotlib', 'jinja2'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY / "pipeline").returncode == 0
