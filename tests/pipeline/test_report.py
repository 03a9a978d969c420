"""The page: it builds from one run and from several, holds what it shows, and asks nothing of a network."""
import re
import subprocess
from types import SimpleNamespace

import pytest

import synthetic
from conftest import REPOSITORY
from rockbreak.figures.catalogue import CATALOGUE
from rockbreak.report.page import title_of
from rockbreak.report.tables import warnings


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    return (synthetic.write_run(folder / "breakable <1>", frames=9),
            synthetic.write_run(folder / "solid", frames=9, breakable=False))


def report(*arguments):
    return subprocess.run([REPOSITORY / "pipeline" / "report", *arguments], capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def page(runs):
    process = report(runs[0])
    assert process.returncode == 0, process.stderr
    assert process.stdout == f"{runs[0] / 'report.html'}\n"
    return (runs[0] / "report.html").read_text()


def test_nothing_on_the_page_comes_from_elsewhere(page):
    sources = re.findall(r'(?:src|href|action)="([^"]*)"|url\(([^)]*)\)', page)
    assert len(sources) > 100
    within = re.compile("data:(text/csv|application/gzip)|#")
    assert [one[:80] for one in (a or b for a, b in sources) if not within.match(one)] == []
    links = set(re.findall(r"https?://[^\"'<>\s]+", page))
    assert links <= {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"}, "namespaces only"
    assert "<script src" not in page and "@import" not in page


def test_every_figure_stands_on_the_page_and_in_the_folder(page, runs):
    expected = {entry.name for entry in CATALOGUE if entry.needs == "one run"} - {"energy_shares"}
    assert set(re.findall(r'<figure id="(\w+)"', page)) == expected | {"animation"}
    assert page.count("<svg") == len(expected)
    assert {file.stem for file in (runs[0] / "figures").glob("*.png")} == expected
    for file in (runs[0] / "figures").glob("*.png"):
        assert file.read_bytes().startswith(b"\x89PNG")


def test_figures_can_be_had_as_files(runs, tmp_path):
    assert report(runs[0], "--out", tmp_path / "r.html", "--figures", tmp_path / "f").returncode == 0
    names = {entry.name for entry in CATALOGUE if entry.needs == "one run"} - {"energy_shares"}
    assert {file.name for file in (tmp_path / "f").iterdir()} == {f"{n}.{kind}" for n in names
                                                                 for kind in ("svg", "png", "csv")}
    assert "<svg" in (tmp_path / "f" / "energy.svg").read_text()
    assert (tmp_path / "f" / "energy.csv").read_text().startswith("condition,kind,axial_strain,energy_J\n")


def test_ids_of_the_figures_do_not_clash(page):
    ids = re.findall(r'\bid="(DejaVu[^"]*|[^"]*-DejaVu[^"]*|[mp][0-9a-f]{10})"', page)
    assert len(ids) == len(set(ids))


def test_names_and_warnings_are_escaped(page):
    assert "breakable &lt;1&gt;" in page and "breakable <1>" not in page
    assert "the servo &lt;saturated&gt; once" in page


def test_the_resolved_case_is_shown(page):
    assert "confining_pressure: 2000000.0" in page


def test_several_runs_are_compared(runs):
    process = report(*runs)
    assert process.returncode == 0, process.stderr
    page = (runs[0] / "comparison.html").read_text()
    assert "2 biaxial tests" in page and "<td>solid</td>" not in page and ">solid</th>" in page
    assert (runs[0] / "figures" / "comparison_deviator.png").exists()


def test_the_papers_numbers_stand_beside_its_own_scene_only(runs, tmp_path):
    run = synthetic.write_run(tmp_path / "paper", frames=4)
    assert "Raisianzadeh" not in (runs[0] / "report.html").read_text()
    case = run / "case.yaml"
    case.write_text(case.read_text().replace("particles: 48", "particles: 1194"))
    assert report(run).returncode == 0
    page = (run / "report.html").read_text()
    assert "Raisianzadeh et al. (2019)" in page and "<td>1194</td>" in page


def test_an_unfinished_run_is_reported_as_such(tmp_path):
    run = synthetic.write_run(tmp_path / "r", frames=4)
    (run / "frames" / "000003.h5").unlink()
    assert report(run).returncode == 0
    assert "has not reached its final frame" in (run / "report.html").read_text()


@pytest.mark.parametrize("spoil, message", [
    (lambda run: None, "no such directory"),
    (lambda run: synthetic.write_run(run, frames=2) and [f.unlink() for f in (run / "frames").iterdir()],
     "found no frames"),
    (lambda run: synthetic.write_run(run, frames=2) and (run / "case.yaml").write_text("- 1\n"), "mapping of keys"),
    (lambda run: synthetic.write_run(run, frames=2) and (run / "frames" / "000001.h5").write_bytes(b"half"),
     "000001.h5"),
])
def test_what_cannot_be_reported_gets_a_message_and_an_exit_code(tmp_path, spoil, message):
    run = tmp_path / "r"
    spoil(run)
    process = report(run)
    assert process.returncode in (2, 4) and message in process.stderr and "Traceback" not in process.stderr


def test_warnings_that_differ_by_numbers_alone_are_told_once():
    class Run:
        name = "r"

        @staticmethod
        def ledger():
            texts = ["frame 1: 3 particles are out of balance by 1.5e-3",
                     "frame 2: 12 particles are out of balance by 7", "the servo saturated"]
            return [{"event": "start"}] + [{"event": "warning", "source": "xfem", "text": text} for text in texts]

    assert warnings([Run]) == [
        ("r", "xfem: frame 1: 3 particles are out of balance by 1.5e-3 (and 1 more like it)"),
        ("r", "xfem: the servo saturated")]


def test_names_make_a_title_as_long_as_it_can_be_read():
    def named(*names):
        return title_of([SimpleNamespace(name=name) for name in names])

    assert named("a" * 80) == "a" * 80 and named("demo", "solid") == "demo / solid"
    assert named("seed-1_breakable_confining_pressure-2.0e6", "seed-1_solid_confining_pressure-2.0e6") == "2 runs"
