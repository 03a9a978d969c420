"""Time limits of the tests. They are those of the release; ROCKBREAK_SLOW is how many times as long other programs may take, such
as those with a sanitizer (set by tests/sanitizers)."""
import os

SLOWNESS = float(os.environ.get("ROCKBREAK_SLOW") or 1)


def patience(seconds):
    """The limit that stands for `seconds` with the release."""
    return seconds * SLOWNESS
