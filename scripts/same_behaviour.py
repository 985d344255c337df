"""Compares two checkouts: do the same texts give the same events, but for the wording of replies?

python -m scripts.same_behaviour BEFORE AFTER CORPUS.yaml…    (each checkout after `make setup`)

Every text of the corpora is a turn of one conversation in simulated time, in each checkout, with the whole trace:
order, keys, codes and figures must be the same.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

import yaml

SHOWN = 10
_TEXTS = ("say", "text")
_OPTIONS = ("--keep-going", "--fast", "--json", "--trace", "--world", "home")


def texts_in(node: object) -> Iterator[str]:
    """Every text that a corpus says, in order."""
    if isinstance(node, list):
        for one in node:
            yield from texts_in(one)
    elif isinstance(node, dict):
        for key, value in node.items():
            said = value if isinstance(value, list) else [value]
            if key in _TEXTS:
                yield from (" ".join(text.split()) for text in said if isinstance(text, str))
            yield from texts_in(value)


def events(checkout: Path, texts: list[str]) -> list[str]:
    """What that checkout does with the texts, one event a line, without the wording of replies."""
    command = [str(checkout / ".venv/bin/chatrobot"), "do", *texts, *_OPTIONS]
    told = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=False).stdout
    found = [json.loads(line) for line in told.splitlines()]
    return [json.dumps({k: v for k, v in event.items() if k != "reply"}, sort_keys=True) for event in found]


def main(arguments: list[str]) -> int:
    before, after = (Path(name).resolve() for name in arguments[:2])
    texts = [text for name in arguments[2:] for text in texts_in(yaml.safe_load(Path(name).read_text()))]
    pairs = list(zip_longest(events(before, texts), events(after, texts)))
    different = [(number, *pair) for number, pair in enumerate(pairs) if pair[0] != pair[1]]
    for number, was, now in different[:SHOWN]:
        print(f"event {number}:\n  before {was}\n  after  {now}")
    print(f"{len(texts)} texts, {len(pairs)} events, {len(different)} different")
    return 1 if different or not pairs else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
