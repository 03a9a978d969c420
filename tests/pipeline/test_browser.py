"""The pages in a real browser: no network, no complaint, figures as in the catalogue, an animation that moves, tables
and downloads that agree, widths of a laptop and of a telephone, print."""
import base64
import csv
import io
from pathlib import Path
from types import SimpleNamespace

import pytest

import browser
import synthetic
from rockbreak.campaign.report import write_campaign_report
from rockbreak.figures.catalogue import CATALOGUE
from rockbreak.report.page import write_report
from rockbreak.run.results import Results
from rockbreak.run.run_directory import RunDirectory

pytestmark = pytest.mark.skipif(browser.CHROMIUM is None,
                                reason="chromium is not installed (pipeline/setup --with-tests)")

TABLES = """Array.from(document.querySelectorAll("table")).map(table => ({
  name: table.id, href: table.parentElement.querySelector("a[download]").href,
  cells: Array.from(table.rows).map(row => Array.from(row.cells).map(cell => cell.textContent.trim()))}))"""
OVERFLOW = "document.documentElement.scrollWidth - document.documentElement.clientWidth"


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pages")
    runs = [Results(RunDirectory(synthetic.write_run(folder / name, frames=9, breakable=breakable, pressure=pressure)))
            for name, breakable, pressure in (("breakable <1>", True, 2e6), ("solid, \"1\"", False, 2e6),
                                              ("breakable 4", True, 4e6), ("solid 4", False, 4e6))]
    write_report(runs[:1], folder / "run.html")
    write_report(runs, folder / "comparison.html")
    (folder / "paper_table.html").write_text("<main><header>x</header><h2>At 2 MPa</h2><div class=\"card\"><table><tr>"
                                             "<th>row</th><th>ours</th></tr><tr><td>a, \"b\"</td><td>1</td></tr>"
                                             "</table></div></main>")
    plan = SimpleNamespace(out=folder, runs=[planned(run) for run in runs])
    write_campaign_report(SimpleNamespace(file=Path("sweep.yaml")), plan, {"sample": 3.0})
    return folder


def planned(run):
    """A finished run as a campaign's plan knows it."""
    labels = (("variant", "breakable" if run.breakable else "solid"),
              ("preparation.confining_pressure", str(run.summary["confining_pressure"])))
    return SimpleNamespace(name=run.name, out=run.directory.path, summary=run.summary, failure=None, code=0,
                           command=["pipeline/run", run.name],
                           variations=[SimpleNamespace(title="", labels=labels, keys=labels[1:])])


@pytest.fixture(scope="module")
def chromium():
    with browser.Browser() as one:
        yield one


@pytest.fixture(params=["run.html", "comparison.html", "campaign.html"])
def page(request, pages, chromium):
    chromium.resize(1280)
    chromium.open(pages / request.param)
    return chromium


def test_a_page_loads_without_network_and_without_complaint(page):
    assert page.value("document.readyState") == "complete"
    assert page.complaints() == []


def test_every_figure_of_the_catalogue_is_there_with_alt_text_caption_and_data(pages, chromium):
    shown = {}
    for name in ("run.html", "comparison.html", "campaign.html"):
        chromium.open(pages / name)
        found = chromium.value("""Array.from(document.querySelectorAll("figure[id]")).map(figure => [figure.id,
            figure.querySelector("svg") ? figure.querySelector("svg").getAttribute("aria-label").length : -1,
            figure.querySelector("figcaption .caption").textContent.length,
            figure.querySelector("svg") ? figure.querySelector("svg").getBoundingClientRect().height : 0,
            figure.querySelector(".links a") ? figure.querySelector(".links a").href.slice(0, 9) : ""])""")
        shown[name] = [row[0] for row in found if row[0] != "animation"]
        for identity, label, caption, height, link in found:
            if identity != "animation":
                assert label > 20 and caption > 10 and height > 80 and link.startswith("data:"), identity
    several = {"energy_shares"}
    for_one = {entry.name for entry in CATALOGUE if entry.needs == "one run"} - several
    assert set(shown["run.html"]) == for_one
    assert set(shown["comparison.html"]) == {entry.name for entry in CATALOGUE} - {"energy"}
    assert set(shown["campaign.html"]) == set(shown["comparison.html"]) | {"trend-preparation.confining_pressure"}
    papers = {entry.paper for entry in CATALOGUE} - {None}
    assert papers == {str(number) for number in (*range(3, 8), *range(9, 23))}, "Figs. 3 to 7 and 9 to 22"


def test_every_table_downloads_as_the_cells_that_it_shows(page):
    tables = page.value(TABLES)
    assert len(tables) >= 3 and len({table["href"] for table in tables}) == len(tables)
    for table in tables:
        text = page.value(f"fetch({table['href']!r}).then(answer => answer.text())")
        rows = [[" ".join(cell.split()) for cell in row] for row in csv.reader(io.StringIO(text))]
        assert rows == [[" ".join(cell.split()) for cell in row] for row in table["cells"]], table["name"]


def test_the_data_of_a_figure_parse_and_hold_its_numbers(page, pages):
    text = page.value("fetch(document.querySelector('#contacts .links a').href).then(answer => answer.text())")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert float(rows[0]["contacts"]) == 96 and float(rows[-1]["axial_strain"]) == pytest.approx(0.10)


def test_the_animation_draws_something_and_moves_on(pages, chromium):
    chromium.resize(1280)
    chromium.open(pages / "run.html")
    ink = """(() => { const c = document.querySelector("#animation canvas");
        const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data; let n = 0, sum = 0;
        for (let i = 0; i < p.length; i += 4) if (p[i] + p[i + 1] + p[i + 2] < 750) { n += 1; sum += i % 9973; }
        return [n / (p.length / 4), sum]; })()"""
    share, still = chromium.value(ink)
    assert 0.2 < share < 0.95, "particles cover a good part of the picture"
    assert chromium.value("document.querySelector('#animation canvas').dataset.frame") == "8", "the end stands still"
    chromium.value("document.querySelector('#animation button').click()")
    moved = chromium.value("""new Promise(done => { const canvas = document.querySelector("#animation canvas");
        const look = () => canvas.dataset.frame === "2" ? done([document.querySelector("#animation output").textContent,
          document.querySelector("#animation button").textContent]) : setTimeout(look, 10); look(); })""")
    assert "axial strain 2.5 %" in moved[0] and "Pause" in moved[1]
    assert chromium.value(ink)[1] != still
    stepped = chromium.value("""(() => { const s = document.querySelector("#animation input[type=range]"); s.value = 2;
        s.dispatchEvent(new Event("input")); const c = document.querySelector("#animation canvas");
        c.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight"}));
        return [c.dataset.frame, c.getAttribute("aria-label"), s.getAttribute("aria-valuetext")]; })()""")
    assert stepped[0] == "3" and "3.8 %" in stepped[1] and "3.8 %" in stepped[2]
    legends = chromium.value("""(() => { const s = document.querySelector("#animation select");
        s.value = "displacement"; s.dispatchEvent(new Event("change"));
        return Array.from(document.querySelectorAll("[data-legend]"))
        .filter(one => !one.hidden).map(one => one.dataset.legend); })()""")
    assert legends == ["displacement"]


@pytest.mark.parametrize("width", [1280, 400])
def test_nothing_overflows_sideways(page, width):
    page.resize(width)
    assert page.value(OVERFLOW) <= 0


def test_a_figure_is_saved_as_a_whole_svg(page):
    text = page.value("""new Promise(done => { const keep = URL.createObjectURL;
        URL.createObjectURL = blob => { blob.text().then(done); return keep.call(URL, blob); };
        HTMLAnchorElement.prototype.click = function () {};
        document.querySelector("[data-svg=deviator]").click(); })""")
    assert text.startswith("<?xml") and 'xmlns="http://www.w3.org/2000/svg"' in text and text.endswith("</svg>")


def test_it_prints(page):
    pdf = base64.b64decode(page.pdf())
    assert pdf.startswith(b"%PDF") and pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page ") >= 3
    cut = page.value("""(() => { const sheets = Array.from(document.styleSheets[0].cssRules)
        .filter(rule => rule.media && rule.media.mediaText === "print");
        return sheets.some(sheet => sheet.cssText.includes("break-inside: avoid")); })()""")
    assert cut, "figures are not cut"
