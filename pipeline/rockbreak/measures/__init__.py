"""Micromechanical measures of a contact state and of a run."""
