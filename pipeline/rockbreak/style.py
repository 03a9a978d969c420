"""How the figures look: one palette (Okabe and Ito, safe for colour-blind readers), quiet axes, two file formats."""
import base64
import html
import io
import re

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#AA4499", "#E69F00", "#56B4E9"
INK, SOFT, GREY, LIGHT = "#1f2933", "#52606d", "#7b8794", "#e4e7eb"
CLASS_COLORS = ("#c3ccd5", "#e69f00", "#5d1451")  # low, medium and high; weak, moderate and strong: ever darker
CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
# Unbroken; from the first breakage on viridis.
GENERATION_COLORS = ("#e3e7eb", "#7ad151", "#22a884", "#2a788e", "#414487", "#440154")
MARKERS = "oDs^vP"
LINES = ("-", "--", "-.", (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5, 1, 1.5)), "-")

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 10, "axes.labelsize": 9.5,
    "axes.edgecolor": GREY, "axes.labelcolor": INK, "axes.linewidth": 0.8, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": LIGHT, "grid.linewidth": 0.8,
    "axes.axisbelow": True, "xtick.color": GREY, "ytick.color": GREY, "xtick.labelcolor": INK,
    "ytick.labelcolor": INK, "text.color": INK, "legend.frameon": False, "legend.fontsize": 8.5,
    "lines.linewidth": 1.7, "lines.solid_capstyle": "round", "svg.fonttype": "path", "savefig.facecolor": "white",
})


def sequence(count):
    """Colours of ordered things (pressures, strains): viridis without its pale end, which is lost on white."""
    return [matplotlib.colors.to_hex(color) for color in matplotlib.colormaps["viridis"](np.linspace(0.0, 0.8, count))]


def curve_figure(xlabel="axial strain [%]", ylabel=""):
    figure = Figure(figsize=(5.4, 3.5), layout="constrained")
    axes = figure.add_subplot()
    axes.set_xlabel(xlabel)
    axes.set_ylabel(ylabel)
    return figure, axes


def thinned(x, y, points=1200):
    """Every n-th point, and the last: more than a screen can show only makes the file large."""
    stride = max(1, len(x) // points)
    keep = list(range(0, len(x), stride))
    if keep and keep[-1] != len(x) - 1:
        keep.append(len(x) - 1)
    return x[keep], y[keep]


def svg_document(figure, salt):
    """The figure as an SVG file; its ids depend on `salt` alone, its paths have two decimals of a point."""
    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": salt}):
        FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None})  # savefig would draw twice
    return re.sub(r' d="[^"]*"', lambda path: tightened(path[0]), buffer.getvalue())


def tightened(path):
    """The d attribute of a path with two decimals; of straight lines relative, which is half as long."""
    commands = re.findall(r"([MLQCz])([^MLQCz]*)", path)
    if any(kind in "QC" for kind, _ in commands):
        return re.sub(r"\s*([MLQCz])\s*", r"\1", re.sub(r"(\.\d\d)\d+", r"\1", path))
    parts, x, y, x0, y0 = [], 0, 0, 0, 0
    for kind, numbers in commands:
        if kind == "z":
            parts.append("z")
            x, y = x0, y0
            continue
        new_x, new_y = (round(100 * float(number)) for number in numbers.replace('"', "").split())
        parts.append(f"M{hundredths(new_x)} {hundredths(new_y)}" if kind == "M" else
                     f"l{hundredths(new_x - x)} {hundredths(new_y - y)}")
        x, y = new_x, new_y
        if kind == "M":
            x0, y0 = x, y
    return f' d="{"".join(parts)}"'


def hundredths(count):
    """Shortest text of count / 100."""
    text = f"{count / 100:.2f}".rstrip("0").rstrip(".")
    return text.replace("0.", ".", 1) if text.startswith(("0.", "-0.")) else text


def svg_text(figure, salt, label=None):
    """The figure as an <svg> element for a page: no prologue, no metadata, ids of its own; `label` is what a screen
    reader says."""
    text = svg_document(figure, salt)
    text = text[text.index("<svg"):]
    if label:
        text = f'<svg role="img" aria-label="{html.escape(label, quote=True)}"' + text[len("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r' (width|height)="[0-9.]+pt"', "", text, count=2)
    # Glyphs are shared by name between figures of one page; the other ids are salted already.
    return re.sub(r'((?:id="|href="#))(DejaVu[^"]*)"', rf'\1{salt}-\2"', text)


def png_bytes(figure, dpi):
    buffer = io.BytesIO()
    figure.dpi = dpi
    FigureCanvasAgg(figure).print_png(buffer, metadata={"Software": None})
    return buffer.getvalue()


def data_uri(png):
    return "data:image/png;base64," + base64.b64encode(png).decode()
