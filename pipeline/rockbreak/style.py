"""How the figures look: one palette (Okabe and Ito, safe for colour-blind readers), quiet axes, two file formats."""
import base64
import io
import re

import matplotlib

matplotlib.use("Agg")
from matplotlib.figure import Figure  # noqa: E402

BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#AA4499", "#E69F00", "#56B4E9"
INK, GREY, LIGHT = "#1f2933", "#7b8794", "#e4e7eb"
CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)
LINES = ("-", "--", "-.", (0, (1, 1.2)), (0, (6, 1.5, 1, 1.5, 1, 1.5)), "-")

matplotlib.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9.5, "axes.titlesize": 10, "axes.labelsize": 9.5,
    "axes.edgecolor": GREY, "axes.labelcolor": INK, "axes.linewidth": 0.8, "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": LIGHT, "grid.linewidth": 0.8,
    "axes.axisbelow": True, "xtick.color": GREY, "ytick.color": GREY, "xtick.labelcolor": INK,
    "ytick.labelcolor": INK, "text.color": INK, "legend.frameon": False, "legend.fontsize": 8.5,
    "lines.linewidth": 1.7, "lines.solid_capstyle": "round", "svg.fonttype": "path", "savefig.facecolor": "white",
})


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


def svg_text(figure, salt):
    """The figure as an <svg> element for a page: no prologue, no metadata, ids of its own."""
    with matplotlib.rc_context({"svg.hashsalt": salt}):
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = buffer.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r' (width|height)="[0-9.]+pt"', "", text, count=2)
    # Glyphs are shared by name between figures of one page; the other ids are salted already.
    return re.sub(r'((?:id="|href="#))(DejaVu[^"]*)"', rf'\1{salt}-\2"', text)


def png_bytes(figure, dpi):
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dpi, metadata={"Software": None})
    return buffer.getvalue()


def data_uri(png):
    return "data:image/png;base64," + base64.b64encode(png).decode()
