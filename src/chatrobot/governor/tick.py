"""The control period, for those who need nothing else of the governor: importing that loads numpy."""

from __future__ import annotations

TICK_S = 0.02
"""50 Hz."""
