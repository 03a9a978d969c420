"""One run: the coupled loop, its directory, its ledger, what is read from it."""
