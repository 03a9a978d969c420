"""Laboratory tests on single specimens."""
