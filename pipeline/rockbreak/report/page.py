"""One self-contained report.html: of one run, or of several side by side. Figures also go to figures/*.png."""
import json
from pathlib import Path

import jinja2

from .data_links import link, table
from .tables import NOT_MET, VERDICTS, checks, condition_table, headline, summary_table, warnings, worst_checks
from ..figures.animation import animation
from ..figures.catalogue import CATALOGUE, SECTIONS
from ..figures.selection import KINDS, select
from ..run.run_directory import make_folder, write_text, write_whole
from ..style import GENERATION_COLORS, png_bytes, sequence, svg_document, svg_text

TEMPLATES = Path(__file__).resolve().parent / "templates"
PNG_DPI = 130
DISPLACEMENT_SHADES = 10  # of the animation
LONGEST_TITLE = 60  # characters
FILM = ("film", "The test in motion")
LAST_SECTIONS = (("summary", "All numbers"), ("warnings", "Warnings"), ("configuration", "Configuration"))


def write_report(runs, target, figures=None):
    """Writes the page of `runs` (Results) to `target`, its figures as PNG beside it; with a folder `figures`, every one
    there as SVG, PNG and CSV too."""
    target = Path(target)
    several = len(runs) > 1
    selection = select(runs)
    png_folder, prefix = target.parent / "figures", f"{target.stem}_" if several else ""
    sections = figure_sections(selection, Files(png_folder, prefix, (".png",)), Files(figures) if figures else None)
    verdicts = worst_checks(runs) if several else checks(runs)
    shown_film = film(runs[0]) if not several else None
    page = {
        "title": title_of(runs),
        "subtitle": subtitle(selection),
        "incomplete": [run.name for run in runs if not run.summary["complete"]],
        "tiles": headline(runs[0]) if not several else [],
        "key_numbers": table("key_numbers", *condition_table(selection)) if several else None,
        "film": shown_film,
        "sections": sections,
        "contents": contents(sections, ([FILM] if shown_film else []), LAST_SECTIONS),
        "checks": table("checks", ["check", "worst run" if several else "run", "found", "wanted", "verdict"], verdicts,
                        marks=VERDICTS),
        "unmet": sorted({label for label, *_, verdict in verdicts if verdict == NOT_MET}),
        "definition": runs[0].summary["sin_phi_definition"],
        "summary": table("summary", *summary_table(runs)),
        "warnings": warnings(runs),
        "cases": [(run.name, run.directory.case_file.read_text(encoding="utf-8")) for run in runs],
    }
    write_text(target, render("report.html.j2", page))


def title_of(runs):
    """The runs' names, as long as they make a title."""
    names = " / ".join(run.name for run in runs)
    return names if len(runs) == 1 or len(names) <= LONGEST_TITLE else f"{len(runs)} runs"


def contents(sections, before=(), after=()):
    """(anchor, title, figures) of the list of contents."""
    return [(name, title, []) for name, title in before] + [
        (section["name"], section["title"], section["figures"]) for section in sections] + [
        (name, title, []) for name, title in after]


class Files:
    """Where the figures go as files of their own."""

    def __init__(self, folder, prefix="", kinds=(".svg", ".png", ".csv")):
        self._folder, self._prefix, self._kinds = Path(folder), prefix, kinds
        make_folder(self._folder)

    def write(self, name, drawn):
        makers = {".svg": lambda: svg_document(drawn.figure, name).encode(),
                  ".png": lambda: png_bytes(drawn.figure, PNG_DPI), ".csv": lambda: drawn.data.text().encode()}
        for kind in self._kinds:
            write_whole(self._folder / f"{self._prefix}{name}{kind}", makers[kind](), durable=False)


def figure_sections(selection, *files):
    """The catalogue's figures that the selection allows, by section, for the page; each is written to `files` too."""
    found = {name: [] for name, _ in SECTIONS}
    for entry in CATALOGUE:
        drawn = entry.drawn(selection)
        if drawn is None:
            continue
        found[entry.section].append(drawing(entry.name, entry.title, entry.caption, drawn, entry.paper))
        for one in files:
            if one:
                one.write(entry.name, drawn)
    return [{"name": name, "title": title, "figures": found[name]} for name, title in SECTIONS if found[name]]


def drawing(name, title, caption, drawn, paper=None):
    """What the page needs of a figure."""
    item = {"name": name, "paper": paper, "title": title, "caption": caption, "wide": drawn.wide,
            "width": round(96 * drawn.figure.get_size_inches()[0]),
            "svg": svg_text(drawn.figure, name, f"{title}. {caption}"), "link": link(name, drawn.data.text())}
    drawn.figure.set_layout_engine("none")  # what follows keeps the places that the layout found
    return item


def subtitle(selection):
    if selection.is_single:
        run = selection.runs[0]
        pressure = run.summary["confining_pressure"]
        words = [f"Biaxial test of {'a breakable' if run.breakable else 'an unbreakable'} assembly",
                 *([f"{1e-6 * pressure:g} MPa confining pressure"] if pressure else []),
                 f"{run.summary['particles_initial']} particles", f"seed {run.case.get('seed', '?')}"]
        return ", ".join(words)
    words = [f"{len(selection.runs)} biaxial tests", " and ".join(KINDS[kind] for kind in selection.kinds)]
    if selection.pressures:
        words.append(", ".join(f"{1e-6 * pressure:g}" for pressure in selection.pressures) + " MPa confining pressure")
    if selection.has_seeds:
        words.append("curves are means over the seeds, bands one standard deviation")
    return "; ".join(words)


def film(run):
    found = animation(run)
    if found is None:
        return None
    return {"data": json.dumps(found, separators=(",", ":")), "furthest": f"{found['furthest']:.2f} m",
            "generations": GENERATION_COLORS, "shades": sequence(DISPLACEMENT_SHADES)[::-1]}


def render(template, page):
    """Text of a template; .html ones are escaped and get the style sheet."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=lambda name: name.endswith(".html.j2"), trim_blocks=True,
        lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.globals["table_of"] = table
    environment.globals["asset"] = lambda name: (TEMPLATES / name).read_text(encoding="utf-8")
    style = (TEMPLATES / "style.css").read_text(encoding="utf-8")
    return environment.get_template(template).render(page, style=style)
