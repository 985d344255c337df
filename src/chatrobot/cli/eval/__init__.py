"""`chatrobot eval`: corpora of sayings, run and judged."""
