"""The Python side of Rockbreak: drives `dem` and `xfem`, keeps the ledger, summarizes and reports runs."""
