"""What calls have used: one JSON line a call in the settings folder. It holds counts and names, never a word said."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from chatrobot.models.config import ModelConfig
from chatrobot.models.seam import Usage

FILE = "usage.jsonl"


@dataclass
class Total:
    """A sum over calls. `cost_usd` leaves out the `unpriced` ones; `estimated` counts calls nobody counted for us."""

    calls: int = 0
    prompt_tokens: int = 0
    cached_tokens: int = 0
    reply_tokens: int = 0
    cost_usd: float = 0.0
    unpriced: int = 0
    estimated: int = 0

    def add(self, line: dict[str, Any]) -> None:
        self.calls += 1
        self.prompt_tokens += int(line.get("prompt_tokens", 0))
        self.cached_tokens += int(line.get("cached_tokens", 0))
        self.reply_tokens += int(line.get("reply_tokens", 0))
        cost = line.get("cost_usd")
        self.cost_usd += float(cost or 0.0)
        self.unpriced += cost is None
        self.estimated += not line.get("counted", True)

    def join(self, other: Total) -> None:
        for name, value in vars(other).items():
            setattr(self, name, getattr(self, name) + value)


def record(config: ModelConfig, model: str, usage: Usage) -> None:
    """Add one call. A folder that cannot be written costs the record, not the call."""
    if config.folder is None:
        return
    line = {
        "at": round(time.time(), 3), "session": config.session, "model": model,
        "prompt_tokens": usage.prompt_tokens, "cached_tokens": usage.cached_tokens,
        "reply_tokens": usage.reply_tokens, "cost_usd": usage.cost_usd, "counted": usage.counted,
    }  # fmt: skip
    data = (json.dumps(line, ensure_ascii=False) + "\n").encode()
    try:
        config.folder.mkdir(parents=True, exist_ok=True)
        descriptor = os.open(config.folder / FILE, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600)
        try:
            os.write(descriptor, data)  # one write: lines of several processes do not mix
        finally:
            os.close(descriptor)
    except OSError:
        return


def lines(folder: Path) -> Iterator[dict[str, Any]]:
    """The recorded calls, oldest first; a line that was cut off is left out."""
    try:
        text = (folder / FILE).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return
    for row in text.splitlines():
        try:
            line = json.loads(row)
        except ValueError:
            continue
        if isinstance(line, dict):
            yield line


def totals(folder: Path, key: str) -> dict[str, Total]:
    """Sums by `session`, `model` or `day`, in the order of their first call."""
    found: dict[str, Total] = {}
    for line in lines(folder):
        name = _day(line) if key == "day" else str(line.get(key, ""))
        found.setdefault(name, Total()).add(line)
    return found


def _day(line: dict[str, Any]) -> str:
    return time.strftime("%Y-%m-%d", time.localtime(float(line.get("at", 0))))
