"""The table of laboratory tests: theory, measured, error, mode, angle, time. A row per run."""
import csv
import io

from ..run.run_directory import write_text

THEORY, FINEST, ESTIMATE = "theory", "finest mesh", "estimate"
MESH = "mesh.nodes"


def table_rows(runs):
    """A dictionary per run. Loads in N per metre of thickness, angles in degrees from the load axis; what does not
    exist is None. `error_*`: relative difference of a measured load from the reference."""
    return [row_of(run, references(run, runs)) for run in runs]


def references(run, runs):
    """(kind, first failure, breakage, angle): theory; else the finest mesh of the same sweep; else an estimate."""
    if not run.summary:
        return None, None, None, None
    theory = run.summary["analytical"]
    if theory:
        return (THEORY, theory.get("first_failure_load", theory["breakage_load"]), theory["breakage_load"],
                theory.get("fracture_angle_deg"))
    if MESH in dict(run.labels):
        finest = max((other for other in runs if other.file == run.file and other.summary
                      and others(other) == others(run)), key=lambda other: other.summary["mesh"]["nodes"])
        if finest is not run or len([other for other in runs if other.file == run.file]) > 1:
            return (FINEST, finest.summary["first_failure_load"], finest.summary["breakage_load"],
                    finest.summary["fracture_angle_deg"])
    estimate = run.summary["reference"]
    if estimate:
        return ESTIMATE, estimate["breakage_load"], estimate["breakage_load"], None
    return None, None, None, None


def others(run):
    """Its place in the sweep apart from the mesh."""
    return tuple((axis, label) for axis, label in run.labels if axis != MESH)


def row_of(run, reference):
    kind, first, breakage, angle = reference
    summary = run.summary or {}
    mesh = summary.get("mesh") or {}
    row = {"test": run.name, "kind": summary.get("test"), "file": run.file.name,
           **{axis: label for axis, label in run.labels},
           "status": summary.get("status", "failed" if run.failure else "not run"),
           "rock": (summary.get("rock") or {}).get("name"), "nodes": mesh.get("nodes"), "reference": kind,
           "reference_first_failure_load": first, "reference_breakage_load": breakage,
           "first_failure_load": summary.get("first_failure_load"), "breakage_load": summary.get("breakage_load"),
           "error_first_failure": difference(summary.get("first_failure_load"), first),
           "error_breakage": difference(summary.get("breakage_load"), breakage),
           "failure_mode": summary.get("failure_mode"), "fracture_angle_deg": summary.get("fracture_angle_deg"),
           "reference_angle_deg": angle, "initiation_angle_deg": summary.get("initiation_angle_deg"),
           "fragments": len(summary["fragments"]) if summary else None, "growth_steps": summary.get("growth_steps"),
           "seconds": summary.get("seconds"), "exit_code": run.code, "failure": run.failure or None}
    return row


def difference(measured, reference):
    return measured / reference - 1 if measured is not None and reference else None


def write_table(path, rows):
    columns = list(dict.fromkeys(column for row in rows for column in row))
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: "" if value is None else value for key, value in row.items()} for row in rows)
    write_text(path, text.getvalue())


def form(value, text):
    return "–" if value is None else text.format(value)


def percent(share, digits=2):
    """Signed percent; what rounds to nothing has no sign."""
    if share is None:
        return "–"
    text = f"{100 * share:+.{digits}f}"
    return f"{text if float(text) else text[1:]} %"


HEAD = ("test", "reference", "ref. [kN/m]", "first failure", "error", "breakage", "error", "mode", "angle", "ref.",
        "status", "time [s]")


def cells(row):
    """A row as text, in the order of HEAD."""
    kilo = {key: None if row[key] is None else row[key] / 1e3
            for key in ("reference_breakage_load", "first_failure_load", "breakage_load")}
    return [row["test"], row["reference"] or "–", form(kilo["reference_breakage_load"], "{:.5g}"),
            form(kilo["first_failure_load"], "{:.5g}"), percent(row["error_first_failure"]),
            form(kilo["breakage_load"], "{:.5g}"), percent(row["error_breakage"]),
            row["failure_mode"] or "–", form(row["fracture_angle_deg"], "{:.1f}°"),
            form(row["reference_angle_deg"], "{:.1f}°"), row["status"], form(row["seconds"], "{:.2f}")]


def text_table(rows):
    lines = [list(HEAD), *(cells(row) for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(HEAD))]
    left = {0, 1, 7, 10}
    return "\n".join("  ".join(cell.ljust(width) if i in left else cell.rjust(width)
                               for i, (cell, width) in enumerate(zip(line, widths))).rstrip() for line in lines)
