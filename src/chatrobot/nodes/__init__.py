"""The tutorial's three nodes: `input`, `base` and `control`, on any wire."""
