"""Accuracy studies of laboratory tests: the closed form of the disc against equilibrium and its boundary, errors
against numbers worked out by hand, specimens and references of a study file, and a small study with the real
executable."""
import csv
import json
import math
import subprocess
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
import yaml

from conftest import REPOSITORY
from rockbreak.campaign import laboratory_errors as errors
from rockbreak.accuracy.study import read_study
from rockbreak.run.child import executable
from rockbreak.errors import RockbreakError
from rockbreak.campaign.plan import make_plan
from synthetic import seal

LAB = REPOSITORY / "configs" / "lab"


# -- the disc's field

def test_the_disc_s_field_is_three_to_one_at_its_centre():
    stress = errors.disc_stress(np.zeros((1, 2)), 0.25)[0] * math.pi * 0.25
    assert stress == pytest.approx([-1.0, 3.0, 0.0])


def test_the_disc_s_field_leaves_its_rim_free():
    angle = np.radians([0, 20, 50, 80, 130, 200, 260, 300])
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    xx, yy, xy = errors.disc_stress(0.3 * normal, 0.3).T
    traction = np.column_stack([xx * normal[:, 0] + xy * normal[:, 1], xy * normal[:, 0] + yy * normal[:, 1]])
    assert np.abs(traction).max() < 1e-12 / (math.pi * 0.3), "of the mean tension"


def test_the_disc_s_field_is_in_equilibrium_and_carries_the_load():
    x = np.linspace(-0.25, 0.25, 20001)
    stress = errors.disc_stress(np.column_stack([x, np.zeros_like(x)]), 0.25)
    assert np.trapz(stress[:, 1], x) == pytest.approx(1.0, rel=1e-6)
    step, point = 1e-5, np.array([0.07, 0.11])

    def slope(direction):
        ends = errors.disc_stress(np.array([point + step * direction, point - step * direction]), 0.25)
        return (ends[0] - ends[1]) / (2 * step)

    by_x, by_y = slope(np.array([1.0, 0])), slope(np.array([0, 1.0]))
    assert abs(by_x[0] + by_y[2]) < 1e-6 * abs(by_x[0]) and abs(by_x[2] + by_y[1]) < 1e-6 * abs(by_y[1])


def test_under_arcs_the_disc_s_centre_has_the_stress_of_its_harmonics():
    """Mean and second harmonic of the normal traction reach the centre (xfem/lab/brazilian.cpp)."""
    for arc in (0.02, 0.1, 0.25):
        a = arc / 0.5
        second, mean = (math.sin(a) + math.sin(3 * a) / 3) / a, math.sin(a) / a
        stress = errors.disc_stress(np.zeros((1, 2)), 0.25, arc)[0] * math.pi * 0.25
        assert stress == pytest.approx([mean - second, second + mean, 0.0], abs=1e-12)
    near_the_top = np.array([[0.03, 0.2]])
    point_loads = errors.disc_stress(near_the_top, 0.25)
    assert errors.disc_stress(near_the_top, 0.25, 1e-6) == pytest.approx(point_loads, rel=1e-9)


def test_under_arcs_the_disc_s_rim_is_free_beside_them_and_carries_the_load():
    angle = np.radians([0, 20, 50, 110, 180, 250, 310])
    normal = np.column_stack([np.cos(angle), np.sin(angle)])
    xx, yy, xy = errors.disc_stress(0.3 * normal, 0.3, 0.09).T
    traction = np.column_stack([xx * normal[:, 0] + xy * normal[:, 1], xy * normal[:, 0] + yy * normal[:, 1]])
    assert np.abs(traction).max() < 1e-12 / (math.pi * 0.3), "of the mean tension"
    x = np.linspace(-0.25, 0.25, 20001)
    stress = errors.disc_stress(np.column_stack([x, np.zeros_like(x)]), 0.25, 0.1)
    assert np.trapz(stress[:, 1], x) == pytest.approx(1.0, rel=1e-6)


# -- errors

def particle(**changes):
    """A square particle of De = 1, broken along the load axis."""
    return SimpleNamespace(case={"material": {"sigma_ci": 100.0, "m_i": 10.0}}, out=None, summary={
        "test": "multi_contact", "specimen": {"area": math.pi / 4}, "analytical": None, "status": "broken",
        "first_failure_load": 4.0, "breakage_load": 5.0, "ratio": None, "ratio_first_failure": None,
        "breakage_line": [[0, -0.5], [0, 0.5]], "crack_path": [], "fragments": [{"area": 0.4}, {"area": 0.6}],
        **changes})


def test_without_theory_errors_are_those_against_the_reference():
    one = particle(first_failure_load=4.4, breakage_line=[[0.1, 0.5], [0.0, -0.5]], fragments=[{"area": 0.7},
                                                                                               {"area": 0.3}])
    assert errors.initiation_load(one, particle()) == pytest.approx(0.1)
    assert errors.breakage_load(one, particle()) == 0
    assert errors.path(one, particle()) == pytest.approx(0.1), "whichever end stands first"
    assert errors.angle(one, particle()) == pytest.approx(math.degrees(math.atan(0.1)))
    assert errors.fragment(one, particle()) == pytest.approx(-0.1)
    assert errors.initiation_load_value(one) == pytest.approx(4.4 / (0.5 * math.pi * 10.0))


def test_angles_turn_the_short_way():
    steep, other = particle(breakage_line=[[-0.5, 0.02], [0.5, -0.02]]), particle(breakage_line=[[-0.5, -0.02],
                                                                                                 [0.5, 0.02]])
    assert abs(errors.angle(steep, other)) == pytest.approx(2 * math.degrees(math.atan(0.04)))


def test_theory_goes_before_the_reference():
    disc = particle(test="brazilian", ratio=1.05, ratio_first_failure=1.02, analytical={"fracture_angle_deg": 0},
                    crack_path=[[0.04, -0.3], [-0.06, 0.3]], breakage_line=[[0.02, -0.5], [0.02, 0.5]])
    assert errors.initiation_load(disc, particle()) == pytest.approx(0.02)
    assert errors.breakage_load(disc, particle()) == pytest.approx(0.05)
    assert errors.path(disc, particle()) == pytest.approx(0.06)
    assert errors.angle(disc, particle()) == 0 and errors.fragment(disc, particle()) == pytest.approx(-0.1)


def test_what_did_not_break_has_a_verdict_and_no_geometry():
    whole = particle(status="arrested", breakage_load=None, breakage_line=[], fragments=[])
    assert errors.verdict(whole, particle()) == 1 and errors.verdict(whole, whole) == 0
    for error in (errors.breakage_load, errors.path, errors.angle, errors.fragment):
        assert error(whole, particle()) is None and error(particle(), whole) is None


def write_field(folder, nodes, triangles, stress, load):
    folder.mkdir()
    with h5py.File(folder / "result.h5", "w") as file:
        file.attrs["first_failure_load"] = load
        file["mesh/nodes"], file["mesh/triangles"] = np.array(nodes, dtype=float), np.array(triangles)
        file["stress/element"], file["loads/point"] = np.array(stress, dtype=float), np.array([[0.0, 0.0]])
    seal(folder / "result.h5")
    run = particle(first_failure_load=load)
    run.out = folder
    return run


def test_fields_are_compared_per_unit_load_where_the_coarse_one_has_its_elements(tmp_path):
    square = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    fine = write_field(tmp_path / "fine", [*square, [0, 0.9]], [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
                       [[1, 0, 0], [1, 0, 2], [1, 0, 0], [1, 0, 2]], load=1.0)
    coarse = write_field(tmp_path / "coarse", square, [[0, 1, 2], [0, 2, 3]], [[2, 0, 0], [2, 0, 4]], load=2.0)
    # Centroids (1/3, -1/3) and (-1/3, 1/3) lie in the elements of the bottom and of the left.
    assert errors.stress_field(coarse, fine) == pytest.approx(0.0)
    other = write_field(tmp_path / "other", square, [[0, 1, 2], [0, 2, 3]], [[1.2, 0, 0], [1, 0, 2]], load=1.0)
    assert errors.stress_field(other, fine) == pytest.approx(0.2 / math.sqrt(1 + 1 + 8))
    other.case["specimen"] = {"cracks": [[0.0, -0.1, 0.0, 0.1]]}
    assert errors.stress_field(other, fine) is None, "the file holds the field without the crack"


def test_a_disc_under_arcs_is_compared_with_the_field_of_arcs(tmp_path):
    command = [executable("xfem"), "lab", LAB / "brazilian.yaml", "--set", "mesh.nodes=1200", "--set",
               "loading.largest=1", "--set", "loading.patch=0.2", "--out", tmp_path / "arc"]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)
    arc = SimpleNamespace(out=tmp_path / "arc", case=yaml.safe_load((tmp_path / "arc/case.yaml").read_text()),
                          summary=json.loads((tmp_path / "arc/summary.json").read_text()))
    error = errors.stress_field(arc, None)
    assert error < 0.06  # as with point loads on this mesh
    arc.case["loading"]["patch"] = 0.0
    errors.field_of.cache_clear()
    assert errors.stress_field(arc, None) > 1.4 * error, "the field of point loads is another one"


# -- the file

def study_file(path, **content):
    file = path / "study.yaml"
    study = {"subjects": {"disc": {
        "base": str(LAB / "brazilian.yaml"), "set": {"mesh.nodes": 100},
        "specimens": {"plain": {}, "coarser": {"mesh.nodes": "x0.8"}}, "tolerances": {"initiation load": 0.2},
        "measures": {"initiation load": "initiation_load", "stress field": "stress_field"}}},
        "knobs": {"nodes": {"key": "mesh.nodes", "rungs": [600, 100, 50]},
                  "radius": {"key": "breakage.initiation_radius", "rungs": [0.1, 0.05],
                             "reference": {"mesh.nodes": 400}}}}
    file.write_text(yaml.safe_dump(study | content, sort_keys=False))
    return file


def test_a_specimen_may_be_a_part_of_what_the_rung_asks_for(tmp_path):
    disc = read_study(study_file(tmp_path)).subjects[0]
    assert dict(disc.base["coarser"].keys)["mesh.nodes"] == "80"
    nodes = disc.knobs[0]
    assert [dict(nodes.variations[rung, "coarser"].keys)["mesh.nodes"] for rung in nodes.rungs] == ["480", "80", "40"]
    plan = make_plan(disc.campaign, tmp_path / "out")
    assert plan.row_runs[disc.base["coarser"]] is plan.row_runs[nodes.variations["100", "coarser"]]


def test_a_knob_s_rungs_may_be_compared_with_themselves_on_a_finer_mesh(tmp_path):
    disc = read_study(study_file(tmp_path)).subjects[0]
    radius = disc.knobs[1]
    assert [dict(radius.references[rung, "plain"].keys) for rung in radius.rungs] == [
        {"breakage.initiation_radius": "0.1", "mesh.nodes": "400"},
        {"breakage.initiation_radius": "0.05", "mesh.nodes": "400"}]
    assert dict(radius.references["0.1", "coarser"].keys)["mesh.nodes"] == "320"
    own = {"knobs": {"radius": {"key": "breakage.initiation_radius", "rungs": [0.1, 0.05],
                                "reference": {"disc": {"mesh.nodes": 400}}}}}
    named = read_study(study_file(tmp_path, **own)).subjects[0].knobs[0]
    assert dict(named.references["0.1", "plain"].keys) == dict(radius.references["0.1", "plain"].keys)
    assert not radius.is_reference("0.1") and disc.knobs[0].is_reference("600")


@pytest.mark.parametrize("content, said", [
    ({"subjects": {}}, "subjects: found none, expected at least one with its base"),
    ({"base": "x.yaml"}, 'base: unknown key'),
    ({"knobs": {"a": {"key": "mesh.nodes", "rungs": [1, 2], "subjects": ["disk"]}}},
     'knobs.a.subjects: found "disk", expected a name under subjects'),
    ({"subjects": {"disc": {"base": str(LAB / "brazilian.yaml"), "specimens": {"a": {"mesh.node": "x2"}}}}},
     "specimens.a.mesh.node: found nothing, expected a number to multiply"),
    ({"subjects": {"disc": {"base": str(LAB / "brazilian.yaml"), "seeds": [1]},
                   "sample": {"base": str(REPOSITORY / "configs" / "demo.yaml"), "seeds": [1]}}},
     "subjects: found scenes and laboratory tests, expected one kind of base"),
])
def test_bad_input_names_file_key_found_and_expected(tmp_path, content, said):
    with pytest.raises(RockbreakError) as caught:
        read_study(study_file(tmp_path, **content))
    assert caught.value.code == 2 and said in str(caught.value)


def test_the_study_of_xfem_is_valid_and_the_base_is_a_rung_of_every_knob(tmp_path):
    study = read_study(REPOSITORY / "configs" / "accuracy_xfem.yaml")
    for subject in study.subjects:
        plan = make_plan(subject.campaign, tmp_path / "out")
        base = [plan.row_runs[variation] for variation in subject.base.values()]
        for knob in subject.knobs:
            assert base in [[plan.row_runs[knob.variations[label, specimen]] for specimen in subject.specimens]
                            for label in knob.rungs], f"{knob.name}: {subject.name}"


# -- the whole

def test_repetition_changes_the_times_alone(tmp_path):
    summaries = []
    for repeats in ("1", "3"):
        command = [executable("xfem"), "lab", LAB / "brazilian.yaml", "--out", tmp_path / repeats, "--repeat", repeats,
                   "--set", "mesh.nodes=75"]
        assert subprocess.run(command, capture_output=True, check=False).returncode == 0
        summaries.append(json.loads((tmp_path / repeats / "summary.json").read_text()))
        cpu = summaries[-1].pop("cpu_seconds")
        assert 0 < cpu["set_up"] and 0 < cpu["analysis"]
        assert cpu["particle"] == pytest.approx(cpu["set_up"] + cpu["analysis"])
        del summaries[-1]["seconds"]
    assert summaries[0] == summaries[1] and summaries[0]["load_levels"] == 1, "the disc breaks where it first fails"
    assert (tmp_path / "1" / "result.h5").read_bytes() == (tmp_path / "3" / "result.h5").read_bytes()


def test_a_study_of_the_disc_finds_the_finer_mesh_better_and_dearer(tmp_path):
    command = [REPOSITORY / "pipeline" / "accuracy", study_file(tmp_path), "--out", tmp_path / "out", "-j", "2"]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    assert process.returncode == 0, process.stderr
    with open(tmp_path / "out" / "accuracy.csv", encoding="utf-8") as file:
        rows = {(row["knob"], row["rung"], row["measure"]): row for row in csv.DictReader(file)}
    found = [float(rows["nodes", rung, "stress field"]["error_rms"]) for rung in ("600", "100", "50")]
    assert found[0] < 0.1 < found[1] < found[2], "first order in h: 600 nodes against 50"
    assert 2 < found[2] / found[0] < 6
    assert float(rows["radius", "0.1", "stress field"]["error_rms"]) == pytest.approx(found[1])
    row = rows["nodes", "100", "initiation load"]
    assert row["pairs"] == "2" and row["subject"] == "disc"
    page = (tmp_path / "out" / "accuracy.html").read_text()
    assert "nodes: disc" in page and "compared with itself under <code>mesh.nodes: 400</code>" in page
    before = (tmp_path / "out" / "accuracy.csv").read_text()
    assert subprocess.run(command, capture_output=True, check=False).returncode == 0
    assert (tmp_path / "out" / "accuracy.csv").read_text() == before, "finished tests are kept"
