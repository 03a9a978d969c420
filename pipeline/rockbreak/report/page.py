"""One self-contained report.html: of one run, or of several side by side. Figures also go to figures/*.png."""
from pathlib import Path

import jinja2
import numpy as np

from ..figures import assemblies, curves
from ..run.run_directory import make_folder, write_text, write_whole
from ..style import data_uri, png_bytes, svg_text
from .tables import checks, headline, summary_table, warnings

TEMPLATES = Path(__file__).resolve().parent / "templates"
PICTURE_DPI = 230
CURVE_DPI = 160

RESPONSE = (
    (curves.deviator, "Deviator stress", "Axial less lateral mean stress (Eq. 13)."),
    (curves.volumetric_strain, "Volumetric strain", "Of the boundary's deformation; compression positive."),
    (curves.friction_angle, "Mobilized friction", "Running mean over 0.2 % strain."),
    (curves.void_ratio, "Void ratio", "e1: ring polygon over the solids inside it; e2: overlaps subtracted; e4: ring "
     "polygon over the particles that are not on the boundary; a comparison shows the definition of its scenes."),
    (curves.particles, "Particles", "Each breakage adds one particle."),
    (curves.contacts, "Contacts", "Contacts in force."),
    (curves.anisotropies, "Anisotropies", "Second-order Fourier fits (Eqs. 7 to 9)."),
    (curves.orientations, "Contact orientations", "Share of the contacts in each direction of 15°, relative to an "
     "isotropic assembly; thin lines: the fit of Eq. 7."),
)
CHECKS = (
    (curves.servo_error, "Servo", "Lateral stress less the confining pressure, relative to it."),
    (curves.unrest, "Quasi-static?", "Unbalanced force: mean resultant on a free particle over the mean normal force."),
    (curves.energy, "Energy ledger", "Boundary work and where it went; the residual is a check."),
    (curves.phases, "Time", "Wall time per phase; handover is what the exchange itself costs."),
)


class Gallery:
    """Draws each figure once: as PNG into figures/, and for the page as SVG (curves) or data URI (pictures)."""

    def __init__(self, folder, prefix):
        self._folder = folder
        self._prefix = prefix
        make_folder(folder)

    def _save(self, name, png):
        write_whole(self._folder / f"{self._prefix}{name}.png", png)

    def curve(self, function, runs, title, caption):
        figure = function(runs)
        if figure is None:
            return None
        self._save(function.__name__, png_bytes(figure, CURVE_DPI))
        return {"title": title, "caption": caption, "svg": svg_text(figure, function.__name__)}

    def curves(self, table, runs):
        return [one for one in (self.curve(function, runs, title, caption) for function, title, caption in table)
                if one]

    def picture(self, figure, name, title):
        png = png_bytes(figure, PICTURE_DPI)
        self._save(name, png)
        return {"title": title, "image": data_uri(png)}


def write_report(runs, target):
    """Writes the page of `runs` (Results) to `target`."""
    target = Path(target)
    several = len(runs) > 1
    gallery = Gallery(target.parent / "figures", f"{target.stem}_" if several else "")
    page = {
        "title": " / ".join(run.name for run in runs) if several else runs[0].name,
        "several": several,
        "incomplete": [run.name for run in runs if not run.summary["complete"]],
        "tiles": headline(runs[0]) if not several else [],
        "response": gallery.curves(RESPONSE, runs),
        "pictures": comparison_pictures(gallery, runs) if several else run_pictures(gallery, runs[0]),
        "checks": gallery.curves(CHECKS, runs),
        "verdicts": checks(runs),
        "runs": runs,
        "summary": summary_table(runs),
        "warnings": warnings(runs),
        "cases": [(run.name, run.directory.case_file.read_text(encoding="utf-8")) for run in runs],
    }
    write_text(target, render("report.html.j2", page))


def render(template, page):
    """Text of a template; .html ones are escaped and get the style sheet."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES), autoescape=lambda name: name.endswith(".html.j2"), trim_blocks=True,
        lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    style = (TEMPLATES / "style.css").read_text(encoding="utf-8")
    return environment.get_template(template).render(page, style=style)


def strongest(pictures):
    """Normal force that gets the strongest shade [N]: a quantile, so that one contact does not pale the rest."""
    forces = np.concatenate([picture.normal_force for picture in pictures])
    return float(np.quantile(forces, 0.995)) if len(forces) and forces.max() > 0 else 1.0


def run_pictures(gallery, run):
    shown = [(name, assemblies.Picture(run.directory.frame_file(k))) for name, k in run.stages]
    limits, scale = assemblies.extent([p for _, p in shown]), strongest([p for _, p in shown])
    chains = [gallery.picture(assemblies.force_chains(picture, limits, scale), f"force_chains_{name}",
                              f"{name.capitalize()}, {picture.strain:.1%} axial strain") for name, picture in shown]
    largest = max(picture.displacement.max() for _, picture in shown)
    moved = [gallery.picture(assemblies.displacements(picture, limits, largest), f"displacements_{name}",
                             f"{name.capitalize()}, {picture.strain:.1%} axial strain")
             for name, picture in shown if name != "start"]
    return [{"title": "Force chains", "items": chains,
             "caption": "A line joins the centroids of two particles over their contact point; width and colour grow "
                        "with the normal force, on one scale for all pictures. Boundary particles are darker."},
            {"title": "Displacements and fragments", "items": moved,
             "caption": "Length of the displacement since the start of shear; fragments of broken particles are "
                        "black."}]


def comparison_pictures(gallery, runs):
    groups = []
    for stage in ("peak", "end"):
        shown = [(run, assemblies.Picture(run.directory.frame_file(run.stage_frame(stage)))) for run in runs]
        limits, scale = assemblies.extent([p for _, p in shown]), strongest([p for _, p in shown])
        groups.append({"title": f"Force chains at the {stage}", "caption": "One scale for all runs.", "items": [
            gallery.picture(assemblies.force_chains(picture, limits, scale), f"force_chains_{stage}_{i}",
                            f"{run.name}, {picture.strain:.1%}") for i, (run, picture) in enumerate(shown)]})
    largest = max(picture.displacement.max() for _, picture in shown)
    groups.append({"title": "Displacements and fragments at the end", "caption": "One scale for all runs.", "items": [
        gallery.picture(assemblies.displacements(picture, limits, largest), f"displacements_end_{i}",
                        f"{run.name}, {picture.strain:.1%}") for i, (run, picture) in enumerate(shown)]})
    return groups
