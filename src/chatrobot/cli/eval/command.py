"""`chatrobot eval FILE…`: run a corpus, say what was understood."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from chatrobot.cli.choices import setup_from
from chatrobot.cli.eval.corpus import Item, load_corpus
from chatrobot.cli.eval.report import item_json, misses, table, totals_json
from chatrobot.cli.eval.run import Judged, run_items
from chatrobot.cli.json_lines import json_line
from chatrobot.dialogue.options import Options

_REPORTED_EVERY_S = 0.2


def run(args: argparse.Namespace) -> int:
    """0 where the files are valid, whatever the verdicts.

    Raises:
        CorpusError: a file is not.
    """
    setup = setup_from(args, options=Options(), world="empty", named_model=True)
    items = [item for file in args.files for item in load_corpus(Path(file)) if _is_chosen(item, args.only)]
    began_s = time.monotonic()
    judged: list[Judged] = []
    with _Progress(len(items), began_s) as progress:
        for one in run_items(items, setup):
            judged.append(one)
            if args.json:
                progress.clear()
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
    """How many items are done, on one line of the terminal that errors go to; nothing where they go elsewhere.

    The line is there while it is entered.
    """

    def __init__(self, total: int, began_s: float) -> None:
        self._total = total
        self._began_s = self._shown_s = began_s
        self._is_shown = sys.stderr.isatty()

    def __enter__(self) -> _Progress:
        self._write(f"0 of {self._total}")
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()

    def show(self, done: int) -> None:
        now_s = time.monotonic()
        if now_s - self._shown_s >= _REPORTED_EVERY_S:
            self._shown_s = now_s
            left_s = (now_s - self._began_s) / done * (self._total - done)
            self._write(f"{done} of {self._total}, {left_s:.0f} s to go ")

    def clear(self) -> None:
        self._write("")

    def _write(self, text: str) -> None:
        if self._is_shown:
            print(f"\r{text}\033[K", end="", file=sys.stderr, flush=True)
