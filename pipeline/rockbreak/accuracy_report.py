"""accuracy.csv, one figure per knob, and accuracy.md: what accuracy costs in time."""
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

from .accuracy_numbers import beyond, cheapest_good, floors_of, is_whole, ladder_of
from .campaign import file_name
from .campaign_tables import markdown_table, write_csv
from .run_directory import write_text
from .style import BLUE, GREY, INK, LIGHT, VERMILION, png_bytes

DPI = 160
PANELS = 3  # in a row


def write_accuracy(study, plan, sample_seconds):
    """Returns the path of the page."""
    ladders = [ladder_of(knob, study, plan, sample_seconds) for knob in study.knobs]
    floors = floors_of(ladders)
    write_csv(plan.out / "accuracy.csv", csv_rows(ladders))
    names = {ladder.knob.name: write_figure(ladder, study, floors, plan.out) for ladder in ladders}
    page = plan.out / "accuracy.md"
    write_text(page, markdown(study, plan, ladders, floors, names, sample_seconds))
    return page


def csv_rows(ladders):
    return [{"knob": ladder.knob.name, "rung": rung.label, "reference": int(rung.is_reference),
             "base": int(rung.is_base), "measure": measure, "mean": cell.mean, "mean_difference": cell.difference,
             "error_rms": cell.error, "seed_scatter": ladder.scatter[measure], "pairs": cell.pairs,
             "cpu_seconds": rung.cpu_seconds, "preparation_cpu_seconds": rung.preparation_seconds,
             "contact_steps": rung.contact_steps}
            for ladder in ladders for rung in ladder.rungs for measure, cell in rung.cells.items()]


# -- figures

def write_figure(ladder, study, floors, out):
    """Saves SVG and PNG; returns the name without its ending, None if there is nothing to draw."""
    if not any(rung.cpu_seconds for rung in ladder.rungs):
        return None
    figure = pareto(ladder, study, floors)
    folder = out / "figures"
    folder.mkdir(exist_ok=True)
    name = f"accuracy_{file_name(ladder.knob.name)}"
    (folder / f"{name}.png").write_bytes(png_bytes(figure, DPI))
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    return name


def pareto(ladder, study, floors):
    """Error against CPU time, a panel per measure, the rungs named; grey: the scatter between seeds."""
    rows = -(-len(study.measures) // PANELS)
    figure = Figure(figsize=(3.5 * min(PANELS, len(study.measures)), 2.9 * rows), layout="constrained")
    figure.suptitle(ladder.knob.name, fontsize=11, color=INK)
    panels = figure.subplots(rows, min(PANELS, len(study.measures)), squeeze=False).ravel()
    for panel, measure in zip(panels, study.measures):
        draw_panel(panel, ladder, measure, floors.get(measure))
    for panel in panels[len(study.measures):]:
        panel.axis("off")
    legend_in = panels[len(study.measures)] if len(panels) > len(study.measures) else panels[0]
    shown = {label: handle for panel in panels[:len(study.measures)]
             for handle, label in zip(*panel.get_legend_handles_labels())}
    marks = {"reference": mark(BLUE, "s", "white"), "base": mark(VERMILION, "D", VERMILION),
             "other rungs": mark(BLUE, "o", BLUE)}
    if not any(rung.is_base for rung in ladder.rungs):
        del marks["base"]
    legend_in.legend([*marks.values(), *shown.values()], [*marks, *shown], loc="center" if legend_in.axison is False
                     else "best")
    return figure


def mark(color, shape, face):
    return Line2D([], [], color=color, marker=shape, markerfacecolor=face, linestyle="none", markersize=6)


def draw_panel(panel, ladder, measure, floor):
    points = [(rung.cpu_seconds, rung.cells[measure].error, rung) for rung in ladder.rungs
              if rung.cpu_seconds and rung.cells[measure].error is not None]
    spread = ladder.scatter[measure]
    if spread is not None:
        panel.axhspan(0, spread, color=LIGHT, zorder=0, label="scatter between seeds")
    if floor is not None and not ladder.knob.rounding_only:
        panel.axhline(floor, color=GREY, linestyle=":", linewidth=1.2, label="growth of rounding")
    panel.plot([x for x, _, _ in points], [y for _, y, _ in points], "-", color=BLUE, linewidth=1.0, alpha=0.5)
    for x, y, rung in points:
        base = rung.is_base
        panel.plot(x, y, "D" if base else "s" if rung.is_reference else "o", color=VERMILION if base else BLUE,
                   markerfacecolor="white" if rung.is_reference else None, markersize=7 if base else 5.5, zorder=3,
                   clip_on=False)
        panel.annotate(rung.label, (x, y), xytext=(0, 7), textcoords="offset points", ha="center", fontsize=8,
                       color=VERMILION if base else INK)
    panel.margins(x=0.15, y=0.2)
    panel.set_ylim(bottom=0)
    range_of_costs = max(x for x, _, _ in points) / min(x for x, _, _ in points) if points else 1
    if range_of_costs > 2:
        panel.set_xscale("log")
        panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if range_of_costs < 50 else (1,)))
        panel.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        panel.xaxis.set_minor_formatter(NullFormatter())
    panel.set_xlabel("CPU time [s]")
    panel.set_ylabel("error")
    panel.set_title(measure)


# -- page

def markdown(study, plan, ladders, floors, names, sample_seconds):
    campaign = study.campaign
    total = sum(run.summary.get("cpu_seconds") or 0 for run in plan.runs if run.summary)
    keys = ", ".join(f"`{key}: {value}`" for key, value in campaign.common.items()) or "nothing else"
    parts = [
        f"# What accuracy costs in time: {campaign.file.stem}",
        f"One knob at a time, around the base `{campaign.base.name}` with {keys}; seeds {', '.join(study.seeds)}. The "
        "first rung of a ladder is its reference. **Error**: root mean square, over the seeds, of the difference from "
        "the reference's run of the same seed; in brackets the mean difference. **Scatter**: standard deviation "
        "between the seeds, all rungs of the ladder together; a **bold** error is larger than that"
        + (" and than the growth of rounding" if floors else "") + ". CPU time: user seconds of the shear stage; the "
        "prepared sample is counted apart. Contact-steps do not depend on the machine. "
        f"{len(plan.runs)} runs, {total:.0f} s, and {sum(sample_seconds.values()):.0f} s for the samples. All numbers: "
        "`accuracy.csv`; every run: `campaign.csv`.",
        "## What follows", "\n".join(f"- {sentence(ladder, floors)}" for ladder in ladders)]
    if floors:
        parts.append("Growth of rounding, the largest error of the rungs that differ by rounding alone: "
                     + ", ".join(f"{name} {value:.4f}" for name, value in floors.items())
                     + ". No smaller error means anything.")
    for ladder in ladders:
        parts += [f"## {ladder.knob.name}", table(ladder, study, floors)]
        parts += [f"Rung {rung.label} failed: {failure}" for rung in ladder.rungs for failure in rung.failures]
        if names[ladder.knob.name]:
            parts.append(f"![{ladder.knob.name}: error against CPU time](figures/{names[ladder.knob.name]}.svg)")
    return "\n\n".join(parts) + "\n"


def table(ladder, study, floors):
    base_seconds = ladder.base.cpu_seconds if ladder.base else None
    head = ["rung", "CPU [s]", "of the base", "contact-steps", "sample [s]", *study.measures]
    rows = []
    for rung in ladder.rungs:
        notes = [note for note, holds in (("reference", rung.is_reference), ("base", rung.is_base)) if holds]
        label = f"**{rung.label}**" if rung.is_base else rung.label
        rows.append([f"{label} ({', '.join(notes)})" if notes else label, form(rung.cpu_seconds, "{:.3g}"),
                     form(rung.cpu_seconds / base_seconds if base_seconds and rung.cpu_seconds else None, "{:.0%}"),
                     form(rung.contact_steps, "{:.3g}"), form(rung.preparation_seconds, "{:.3g}"),
                     *(error_text(rung, ladder, name, floors) for name in study.measures)])
    rows.append(["*scatter between seeds*", "", "", "", "", *(form(ladder.scatter[name]) for name in study.measures)])
    rows.append(["*mean of the reference*", "", "", "", "",
                 *(form(ladder.reference.cells[name].mean) for name in study.measures)])
    return markdown_table(head, rows)


def form(value, text="{:.4f}"):
    return "–" if value is None else text.format(value)


def error_text(rung, ladder, name, floors):
    cell = rung.cells[name]
    if cell.error is None:
        return "–"
    if rung.is_reference:
        return "0"
    text = f"{cell.error:.4f}"
    return (f"**{text}**" if name in beyond(rung, ladder, floors) else text) + f" ({cell.difference:+.4f})"


def sentence(ladder, floors):
    """What the numbers say of one knob."""
    base, cheapest = ladder.base, cheapest_good(ladder, floors)
    words = f"**{ladder.knob.name}**: "
    if base is None:
        words += "the base is none of its rungs. "
    elif not is_whole(base):
        words += f"the base, {base.label}, is not finished. "
    else:
        outside = beyond(base, ladder, floors)
        words += f"the base, {base.label} ({base.cpu_seconds:.3g} s), " + (
            "is the reference itself. " if base.is_reference else
            "stays within the scatter in every measure. " if not outside else
            "stands out of the scatter in " + ", ".join(
                f"{name} ({form(base.cells[name].error)} against {form(ladder.scatter[name])})" for name in outside)
            + ". ")
    if cheapest is None:
        return words + "No rung is whole and within the scatter."
    words += f"Cheapest rung within the scatter: {cheapest.label}, {cheapest.cpu_seconds:.3g} s"
    if base is not None and base is not cheapest and base.cpu_seconds:
        words += f", {cheapest.cpu_seconds / base.cpu_seconds:.0%} of the base"
    return words + "."
