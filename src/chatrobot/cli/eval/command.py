"""`chatrobot eval FILE…`: run a corpus, and say what was understood: counts, misses, JSON lines."""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from chatrobot.cli.choices import setup_from
from chatrobot.cli.eval.corpus import CATEGORIES, Item, load_corpus
from chatrobot.cli.eval.run import Judged, run_items
from chatrobot.cli.json_lines import json_line
from chatrobot.cli.status_line import StatusLine, status_line
from chatrobot.dialogue.options import Options

_REPORTED_EVERY_S = 0.2


def run(args: argparse.Namespace) -> int:
    """Return 0 where the files are valid, whatever the verdicts.

    Raises:
        CorpusError: a file is not.
    """
    setup = setup_from(args, options=Options(), world="empty", named_model=True)
    items = [item for file in args.files for item in load_corpus(Path(file)) if _is_chosen(item, args.only)]
    began_s = time.monotonic()
    judged: list[Judged] = []
    with status_line() as line:
        progress = _Progress(line, len(items), began_s)
        for one in run_items(items, setup):
            judged.append(one)
            if args.json:
                line.clear()
                print(json_line(item_json(one)), end="", flush=True)
            progress.show(len(judged))
    if args.json:
        print(json_line(totals_json(judged)), end="")
        return 0
    print(table(judged), end="")
    if args.misses:
        print(misses(judged), end="")
    print(f"\n{len(items)} items in {time.monotonic() - began_s:.1f} s")
    return 0


def _is_chosen(item: Item, only: str | None) -> bool:
    return only is None or item.number % 2 == (only == "odd")


class _Progress:
    """How many items are done, now and then."""

    def __init__(self, line: StatusLine, total_count: int, began_s: float) -> None:
        self._line, self._total = line, total_count
        self._began_s = self._shown_s = began_s
        line.show(f"0 of {total_count}")

    def show(self, done_count: int) -> None:
        now_s = time.monotonic()
        if now_s - self._shown_s >= _REPORTED_EVERY_S:
            self._shown_s = now_s
            left_s = (now_s - self._began_s) / done_count * (self._total - done_count)
            self._line.show(f"{done_count} of {self._total}, {left_s:.0f} s to go")


def item_json(judged: Judged) -> dict[str, Any]:
    """Put one item as an object of one `--json` line."""
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
        "proposals": list(judged.proposals),
        "after_yes": judged.after_yes.kind if judged.after_yes else None,
        "must_stand": judged.item.must_stand,
        "measured": {"yaw_deg": round(measured.yaw_deg, 3)}
        | {
            name: value if isinstance(value, bool) else round(value, 4)
            for name, value in asdict(measured).items()
        },
    }


def totals_json(all_judged: Sequence[Judged]) -> dict[str, Any]:
    """Put counts per category and in total as the last `--json` line."""
    return {
        "event": "total",
        **_counts_json(_count(all_judged)),
        "still": _still_counts(all_judged),
        "categories": {category: _counts_json(_count(group)) for category, group in _by_category(all_judged)},
    }


def table(all_judged: Sequence[Judged]) -> str:
    """Counts per category and in total, for people; then how many moved that had to stand."""
    rows = [(category, _count(group)) for category, group in _by_category(all_judged)]
    lines = [
        f"{'category':<12}{'items':>6}{'correct':>9}{'wrong':>7}{'abstained':>11}{'correct %':>11}{'proposed':>10}"
    ]
    for name, counts in [*rows, ("total", _count(all_judged))]:
        share = 100.0 * counts["correct"] / max(_items(counts), 1)
        lines.append(
            f"{name:<12}{_items(counts):>6}{counts['correct']:>9}{counts['wrong']:>7}{counts['abstained']:>11}"
            f"{share:>11.1f}{counts['proposed']:>10}"
        )
    still = _still_counts(all_judged)
    if still["items"]:
        lines.append(
            f"\n{still['items']} items must stand still: {still['moved']} moved, {still['proposals']} got a proposal"
        )
    return "\n".join(lines) + "\n"


def misses(all_judged: Sequence[Judged]) -> str:
    """Each item that went wrong, then each that was abstained: what was done, and what did not hold."""
    return "\n".join([*_listing(all_judged, "wrong"), *_listing(all_judged, "abstained")]) + "\n"


def _listing(all_judged: Sequence[Judged], kind: str) -> list[str]:
    lines: list[str] = []
    for judged in all_judged:
        if judged.verdict.kind == kind:
            said = " / ".join(turn.say for turn in judged.item.turns)
            plan = " / ".join(text.replace("\n", "; ") or "–" for text in judged.plans)
            lines += [f"  {judged.item.id} {said}", f"      did: {plan}"]
            lines += [f"      {reason}" for reason in judged.verdict.reasons]
            if judged.after_yes is not None:
                proposed = " / ".join(text.replace("\n", "; ") or "–" for text in judged.proposals)
                lines.append(f"      proposed, and a yes is {judged.after_yes.kind}: {proposed}")
    return [f"\n{kind}:", *lines] if lines else []


def _by_category(all_judged: Sequence[Judged]) -> list[tuple[str, list[Judged]]]:
    groups = [(name, [one for one in all_judged if one.item.category == name]) for name in CATEGORIES]
    return [(name, group) for name, group in groups if group]


def _count(all_judged: Sequence[Judged]) -> Counter[str]:
    counts: Counter[str] = Counter(judged.verdict.kind for judged in all_judged)
    counts["proposed"] = sum(judged.was_proposed for judged in all_judged)
    counts["misproposed"] = sum(
        judged.after_yes is not None and not judged.was_proposed for judged in all_judged
    )
    return counts


def _items(counts: Counter[str]) -> int:
    return counts["correct"] + counts["wrong"] + counts["abstained"]


def _still_counts(all_judged: Sequence[Judged]) -> dict[str, int]:
    still = [judged for judged in all_judged if judged.item.must_stand]
    return {
        "items": len(still),
        "moved": sum(judged.measured.has_moved for judged in still),
        "proposals": sum(any(judged.proposals) for judged in still),
    }


def _counts_json(counts: Counter[str]) -> dict[str, int]:
    """`proposed` and `misproposed` are among the abstained: what a yes would have made of them."""
    kinds = ("correct", "wrong", "abstained", "proposed", "misproposed")
    return {"items": _items(counts), **{kind: counts[kind] for kind in kinds}}
