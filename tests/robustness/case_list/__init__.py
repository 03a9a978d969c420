"""The list of hard cases: their files, how they run, what is measured of them, and their table."""
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[3]
FOLDER = REPOSITORY / "tests" / "robustness"
PARTS = ("dem", "xfem", "coupling")
