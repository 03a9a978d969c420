"""The paper's numbers, and runs beside them."""
