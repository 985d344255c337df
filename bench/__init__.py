"""How fast it is, measured: each module is one table. Run: python -m bench.NAME, or `make bench` for all."""

from __future__ import annotations

import math
import statistics
from collections.abc import Sequence

NOTHING_PROMISED = (math.inf, math.inf)


def percentile(values: Sequence[float], share: float) -> float:
    """Return the value that this share of them does not exceed."""
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, round(share * (len(ordered) - 1)))]


def line(
    name: str, values_s: Sequence[float], promised_s: tuple[float, float] = NOTHING_PROMISED, note: str = ""
) -> bool:
    """Print a row: median and 99th percentile. Return whether both hold what is promised of them."""
    median_s, p99_s = statistics.median(values_s), percentile(values_s, 0.99)
    kept = median_s <= promised_s[0] and p99_s <= promised_s[1]
    said = " ".join(part for part in (note, "" if kept else "BROKEN") if part)
    print(f"{name:62s} {median_s * 1e3:8.2f} ms {p99_s * 1e3:8.2f} ms  {said}".rstrip(), flush=True)
    return kept
