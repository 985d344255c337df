"""The table of an evaluation, and its JSON lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from chatrobot.cli.eval.corpus import CATEGORIES
from chatrobot.cli.eval.run import Judged


def item_json(judged: Judged) -> dict[str, Any]:
    """One item as an object of one `--json` line."""
    measured = judged.measured
    return {
        "event": "item",
        "id": judged.item.id,
        "category": judged.item.category,
        "turns": [turn.say for turn in judged.item.turns],
        "verdict": judged.verdict.kind,
        "reasons": list(judged.verdict.reasons),
        "outcomes": [record.outcome for record in judged.records],
        "replies": [record.reply for record in judged.records],
        "plan_texts": list(judged.plans),
        "measured": {"yaw_deg": round(measured.yaw_deg, 3)}
        | {
            name: value if isinstance(value, bool) else round(value, 4)
            for name, value in asdict(measured).items()
        },
    }


def totals_json(all_judged: Sequence[Judged]) -> dict[str, Any]:
    """The last `--json` line: counts per category and in total."""
    return {
        "event": "total",
        **_counts_json(_count(all_judged)),
        "categories": {category: _counts_json(_count(group)) for category, group in _by_category(all_judged)},
    }


def table(all_judged: Sequence[Judged]) -> str:
    """Counts per category and in total, for people; then what went wrong."""
    rows = [(category, _count(group)) for category, group in _by_category(all_judged)]
    lines = [f"{'category':<12}{'items':>6}{'correct':>9}{'wrong':>7}{'abstained':>11}{'correct %':>11}"]
    for name, counts in [*rows, ("total", _count(all_judged))]:
        share = 100.0 * counts["correct"] / counts.total()
        lines.append(
            f"{name:<12}{counts.total():>6}{counts['correct']:>9}{counts['wrong']:>7}{counts['abstained']:>11}{share:>11.1f}"
        )
    return "\n".join([*lines, *_listing(all_judged, "wrong"), *_listing(all_judged, "abstained")]) + "\n"


def _listing(all_judged: Sequence[Judged], kind: str) -> list[str]:
    lines: list[str] = []
    for judged in all_judged:
        if judged.verdict.kind == kind:
            said = " / ".join(turn.say for turn in judged.item.turns)
            plan = " / ".join(text.replace("\n", "; ") or "–" for text in judged.plans)
            lines += [f"  {judged.item.id} {said}", f"      did: {plan}"]
            lines += [f"      {reason}" for reason in judged.verdict.reasons]
    return [f"\n{kind}:", *lines] if lines else []


def _by_category(all_judged: Sequence[Judged]) -> list[tuple[str, list[Judged]]]:
    groups = [(name, [one for one in all_judged if one.item.category == name]) for name in CATEGORIES]
    return [(name, group) for name, group in groups if group]


def _count(all_judged: Sequence[Judged]) -> Counter[str]:
    return Counter(judged.verdict.kind for judged in all_judged)


def _counts_json(counts: Counter[str]) -> dict[str, int]:
    return {
        "items": sum(counts.values()),
        **{kind: counts[kind] for kind in ("correct", "wrong", "abstained")},
    }
