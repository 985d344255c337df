"""`chatrobot usage`: tokens and cost, by session, model or day."""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict

from chatrobot.cli.folders import config_folder
from chatrobot.cli.json_lines import json_line
from chatrobot.models.usage import Total, check_prices, totals


def run(args: argparse.Namespace) -> int:
    """Always 0."""
    folder = config_folder(args)
    check_prices(folder)
    found = totals(folder, args.by)
    if args.json:
        for name, total in found.items():
            sys.stdout.write(json_line({"event": "usage", args.by: name, **asdict(total)}))
        return 0
    if not found:
        print("no language model has been asked yet")
        return 0
    print(f"{args.by:<30} {'calls':>6} {'prompt':>9} {'cached':>9} {'reply':>9} {'cost':>12}")
    whole = Total()
    for name, total in found.items():
        print(_row(name, total))
        whole.join(total)
    print(_row("all", whole))
    print("tokens; US dollars at the list prices known when each call was made (“?”: a price is unknown)")
    return 0


def _row(name: str, total: Total) -> str:
    counts = f"{total.calls:6d} {total.prompt_tokens:9d} {total.cached_tokens:9d} {total.reply_tokens:9d}"
    cost = (
        "?" if total.unpriced == total.calls else f"{total.cost_usd:.4f}" + (" +?" if total.unpriced else "")
    )
    return f"{name or '?':<30} {counts} {cost:>12}"
