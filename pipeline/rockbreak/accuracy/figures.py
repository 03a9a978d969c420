"""One figure per ladder: error against cost, a panel per measure, the rungs named; grey: what is good enough."""
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from ..style import BLUE, GREEN, GREY, INK, LIGHT, VERMILION

LEGEND = 0.4  # height in inches
PANELS = 3  # in a row
WIDE = 30   # ratio of the largest to the smallest error from which their axis is logarithmic


def pareto(ladder, kind, floors):
    """None if no rung has a cost."""
    if not any(rung.cost for rung in ladder.rungs):
        return None
    names = [measure.name for measure in ladder.subject.measures
             if any(rung.cells[measure.name].error is not None for rung in ladder.rungs)]
    rows = -(-len(names) // PANELS)
    figure = Figure(figsize=(3.5 * max(2, min(PANELS, len(names))), 2.9 * rows + LEGEND), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(2.9 * rows, LEGEND))
    above.suptitle(title_of(ladder), fontsize=11, color=INK)
    panels = above.subplots(rows, min(PANELS, len(names)), squeeze=False).ravel()
    for panel, name in zip(panels, names):
        draw_panel(panel, ladder, name, kind, floors.get(name))
    for panel in panels[len(names):]:
        panel.axis("off")
    shown = {label: handle for panel in panels[:len(names)]
             for handle, label in zip(*panel.get_legend_handles_labels())}
    marks = {"reference": mark(BLUE, "s", "white"), "base": mark(VERMILION, "D", VERMILION),
             "other rungs": mark(BLUE, "o", BLUE)}
    if ladder.reference is None:
        del marks["reference"]
    if ladder.base is None:
        del marks["base"]
    below.legend([*marks.values(), *shown.values()], [*marks, *shown], loc="center", ncol=len(marks) + len(shown))
    return figure


def title_of(ladder):
    return f"{ladder.knob.name}: {ladder.subject.name}" if ladder.subject.name else ladder.knob.name


def mark(color, shape, face):
    return Line2D([], [], color=color, marker=shape, markerfacecolor=face, linestyle="none", markersize=6)


def draw_panel(panel, ladder, name, kind, floor):
    factor = kind.COSTS[0][3]
    points = [(factor * rung.cost, rung.cells[name].error, rung) for rung in ladder.rungs
              if rung.cost and rung.cells[name].error is not None]
    errors = [error for _, error, _ in points if error > 0]
    is_wide = bool(errors) and max(errors) > WIDE * min(errors)
    spread, tolerance = ladder.scatter[name], ladder.subject.tolerances.get(name)
    if spread is not None and not is_wide:
        panel.axhspan(0, spread, color=LIGHT, zorder=0, label=f"scatter between {kind.SPECIMENS}")
    if tolerance is not None:
        panel.axhline(tolerance, color=GREEN, linestyle="--", linewidth=1.2, label="good enough")
    if floor is not None and floor > 0 and not ladder.knob.rounding_only:
        panel.axhline(floor, color=GREY, linestyle=":", linewidth=1.2, label="growth of rounding")
    shown = [(x, y, rung) for x, y, rung in points if y > 0 or not is_wide]
    panel.plot([x for x, _, _ in shown], [y for _, y, _ in shown], "-", color=BLUE, linewidth=1.0, alpha=0.5)
    for x, y, rung in shown:
        base = rung.is_base
        panel.plot(x, y, "D" if base else "s" if rung.is_reference else "o", color=VERMILION if base else BLUE,
                   markerfacecolor="white" if rung.is_reference else None, markersize=7 if base else 5.5, zorder=3,
                   clip_on=False)
        panel.annotate(rung.label, (x, y), xytext=(0, 7), textcoords="offset points", ha="center", fontsize=8,
                       color=VERMILION if base else INK)
    panel.margins(x=0.15, y=0.2)
    if is_wide:
        panel.set_yscale("log")
    else:
        panel.set_ylim(bottom=0, top=None if any(errors) else 1)
    range_of_costs = max(x for x, _, _ in points) / min(x for x, _, _ in points) if points else 1
    if range_of_costs > 2:
        panel.set_xscale("log")
        panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if range_of_costs < 50 else (1,)))
        panel.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set_xlabel(kind.COST_AXIS)
    panel.set_ylabel("error")
    panel.set_title(name)
