"""`chatrobot eval FILE…`: run a corpus, say what was understood."""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from chatrobot.cli.choices import setup_from
from chatrobot.cli.eval.corpus import load_corpus
from chatrobot.cli.eval.report import item_json, table, totals_json
from chatrobot.cli.eval.run import run_items
from chatrobot.cli.json_lines import json_line
from chatrobot.session.options import Options


def run(args: argparse.Namespace) -> int:
    """0 where the files are valid, whatever the verdicts.

    Raises:
        CorpusError: a file is not.
    """
    setup = setup_from(args, options=Options(), world="empty", named_model=True)
    items = [item for file in args.files for item in load_corpus(Path(file))]
    began_s = time.monotonic()
    judged = []
    for one in run_items(items, setup):
        judged.append(one)
        if args.json:
            print(json_line(item_json(one)), end="", flush=True)
    if args.json:
        print(json_line(totals_json(judged)), end="")
    else:
        print(table(judged), end="")
        print(f"\n{len(items)} items in {time.monotonic() - began_s:.1f} s")
    return 0
