"""Downloads that need no server: numbers and tables as data: URIs."""
import base64
import csv
import gzip
import io
from urllib.parse import quote

LARGEST_TEXT = 800_000  # bytes of a URI; browsers refuse to save from those longer than about 2 MB


def csv_text(head, rows):
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(rows)
    return out.getvalue()


def link(name, text):
    """File name and data: URI of a CSV text; a large one is compressed."""
    uri = "data:text/csv;charset=utf-8," + quote(text, safe=" ,;:/()[]{}!*+=@$&?|^~°±·→≤–†")
    uri = uri.replace(" ", "%20")
    if len(uri.encode()) <= LARGEST_TEXT:
        return {"name": f"{name}.csv", "uri": uri, "format": "CSV"}
    packed = gzip.compress(text.encode(), mtime=0)
    return {"name": f"{name}.csv.gz", "format": "CSV, compressed",
            "uri": "data:application/gzip;base64," + base64.b64encode(packed).decode()}


def table(name, head, rows, marks=None):
    """A table for the page: cells as text, and the link of the same cells as CSV; `marks`: style of some cells."""
    rows = [[str(cell) for cell in row] for row in rows]
    return {"name": name, "head": [str(cell) for cell in head], "rows": rows, "link": link(name, csv_text(head, rows)),
            "marks": marks or {}}
