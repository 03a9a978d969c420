"""The paper's numbers as they are read, and one run beside them."""
import numpy as np
import pytest
import yaml

import synthetic
from rockbreak.paper import numbers as paper
from rockbreak.paper.class_limits import limits_table
from rockbreak.paper.rows import LABELS, paper_rows
from rockbreak.run.results import Results
from rockbreak.run.run_directory import RunDirectory


def test_classes_of_forces_add_up_to_contacts_and_classes_of_stresses_to_particles():
    """Sums made by hand; the stresses in both directions are those of the same particles."""
    assert paper.CONTACTS_2MPA[False] == {0.0: 2015, 0.07: 1987, 0.10: 1947, 0.173: 1920}
    assert paper.CONTACTS_2MPA[True] == {0.0: 2015, 0.07: 2256, 0.10: 2338, 0.173: 2503}
    assert paper.PARTICLES_2MPA_BREAKABLE == {0.0: 1194, 0.07: 1344, 0.10: 1411, 0.173: 1513}
    assert paper.PARTICLES_AT_PEAK_BREAKABLE == {0.5e6: 1234, 1e6: 1288, 2e6: 1411, 4e6: 1562}
    for rows in paper.COUNTS_2MPA.values():
        for strain in rows["weak_forces"]:
            assert sum(rows[name][strain] for name in paper.VERTICAL_STRESSES) == sum(
                rows[name][strain] for name in paper.HORIZONTAL_STRESSES)


def test_the_peak_at_2_mpa_is_10_percent_strain():
    for breakable in (False, True):
        for name in paper.FORCES + paper.VERTICAL_STRESSES:
            assert paper.COUNTS_AT_PEAK[breakable][name][2e6] == paper.COUNTS_2MPA[breakable][name][0.10]


def test_void_ratios_of_table_4_are_read_by_pressure():
    assert paper.FINAL_VOID_RATIO[False] == {0.5e6: 0.360, 1e6: 0.351, 2e6: 0.336, 4e6: 0.314}
    assert paper.FINAL_VOID_RATIO[True][4e6] == 0.288


def results(folder, pressure=2e6, particles=paper.PARTICLES, breakable=False, **options):
    """A synthetic run that claims to be the paper's assembly."""
    run = synthetic.write_run(folder, breakable=breakable, **options)
    case = yaml.safe_load((run / "case.yaml").read_text())
    case["assembly"]["particles"], case["preparation"]["confining_pressure"] = particles, pressure
    (run / "case.yaml").write_text(yaml.safe_dump(case))
    return Results(RunDirectory(run))


def test_another_assembly_or_pressure_has_no_rows(tmp_path):
    assert paper_rows(results(tmp_path / "a", particles=1000)) == []
    assert paper_rows(results(tmp_path / "b", pressure=3e6)) == []


def test_a_run_has_every_number_of_its_column_once(tmp_path):
    rows = paper_rows(results(tmp_path / "r", strain=0.173))
    found = {row[:3]: row for row in rows}
    assert len(found) == len(rows) and {row.row for row in rows} <= set(LABELS)
    for name, counts in paper.COUNTS_2MPA[False].items():
        for strain, count in counts.items():
            assert found["Table 2", name, f"{100 * strain:g} %"].paper == count
    assert found["Table 2", "weak_forces", "0 %"].ours == 0  # all forces are 1 MN there, later half of them less
    assert 30 < found["Table 2", "weak_forces", "7 %"].ours < 60
    assert found["Figs. 13, 21", "sin_phi_simplified", "peak"].ours == pytest.approx(0.5, abs=0.01)
    assert found["Table 3", "large_displacements", "end"].paper == 86
    assert found["Table 3", "strong_forces", "peak"].paper == 121
    assert found["Table 4", "void_ratio_e4", "end"][3:] == pytest.approx((0.336, 0.30 + 0.3 * 0.173))
    assert found["Tables 1, 4", "void_ratio_rise_e1", "end"][3:] == pytest.approx((0.036, 0.3 * 0.173))
    assert found["Sec. 4.1", "peak_strain", "peak"][3:] == pytest.approx((0.10, 0.04), abs=0.002)
    assert found["Figs. 13, 21", "sin_phi", "peak"].paper is None
    assert found["Sec. 4.2, 4.3", "sin_phi_misfit", "peak"].ours == pytest.approx(0.465 - 0.5, abs=0.01)
    assert found["Figs. 12, 20", "anisotropy", "peak"].ours == pytest.approx(1.0, abs=0.02)
    assert all(row.ours is not None for row in rows)


@pytest.mark.parametrize("pressure, columns", [(2e6, 4), (4e6, 1)])
def test_the_misfit_of_the_limits_is_that_of_the_rows(tmp_path, pressure, columns):
    """Root mean square of ours less the paper's over the rows of Table 2 at 2 MPa, of Table 3's peak elsewhere."""
    run = results(tmp_path / "r", pressure=pressure, strain=0.173)
    rows = [row for row in paper_rows(run) if row.table == ("Table 2" if pressure == 2e6 else "Table 3")
            and row.column != ("10 %" if pressure == 4e6 else "")]
    names = (paper.FORCES, ("_stresses",), ("_stresses_held",))
    for found, ends in zip(limits_table([run]), names):
        differences = [row.ours - row.paper for row in rows if row.row.endswith(ends)]
        assert len(differences) == found["counts"] == columns * 3 * (
            1 if ends == paper.FORCES else 2 if pressure == 2e6 else 1)
        assert found["misfit"] == pytest.approx(np.sqrt(np.mean(np.square(differences))))
        assert found["best_misfit"] <= found["misfit"]


def test_a_breakable_run_stands_beside_the_breakable_columns(tmp_path):
    found = {row[:3]: row for row in paper_rows(results(tmp_path / "r", breakable=True, strain=0.173))}
    assert found["Table 2", "particles", "10 %"].paper == 1411
    assert found["Table 2", "weak_forces", "17.3 %"].paper == 1091
    assert found["Table 3", "particles", "peak"].paper == 1411


def test_other_pressures_have_no_rows_of_table_2(tmp_path):
    rows = paper_rows(results(tmp_path / "r", pressure=4e6))
    assert "Table 2" not in {row.table for row in rows}
    assert {(row.paper, row.column) for row in rows if row.row == "contacts"} == {(2028, "peak"), (2028, "10 %")}


def test_an_unfinished_run_has_nothing_of_the_end(tmp_path):
    run = results(tmp_path / "r", strain=0.173)
    for k in range(13, 21):
        run.directory.frame_file(k).unlink()
    rows = paper_rows(run)
    assert {row.column for row in rows if row.table == "Table 2"} == {"0 %", "7 %", "10 %"}
    assert {row.ours for row in rows if row.column == "end"} == {None}
