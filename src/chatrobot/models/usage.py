"""Prices calls, records what they have used (one JSON line a call, never a word said), and adds it up."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from chatrobot.core.errors import InputError
from chatrobot.models.config import ModelConfig
from chatrobot.models.providers import LOCAL
from chatrobot.models.seam import Usage

FILE = "usage.jsonl"
PRICES_FILE = "prices.toml"
_SAME_AS = {"openai-responses": "openai"}
_PER_USD = 1e6


def priced(usage: Usage, provider: str, model: str, folder: Path | None = None) -> Usage:
    """Return the usage with its cost in US dollars, or as it is where the price is not known.

    A person's own `prices.toml` in `folder` comes first, then the price list that the model library brings along. What
    runs on one's own machine costs electricity.
    """
    name = _SAME_AS.get(provider, provider)
    try:
        cost_usd = _own_cost(usage, name, model, folder)
    except InputError:
        return (
            usage  # a call has been made; `chatrobot usage` says what is wrong with the file (`check_prices`)
        )
    if cost_usd is None:
        cost_usd = 0.0 if provider in LOCAL else _list_cost(usage, name, model)
    return replace(usage, cost_usd=cost_usd)


def check_prices(folder: Path) -> None:
    """Read a person's own file of prices, where there is one.

    Raises:
        InputError: it cannot be read.
    """
    if (folder / PRICES_FILE).exists():
        _table(folder / PRICES_FILE)


def _own_cost(usage: Usage, provider: str, model: str, folder: Path | None) -> float | None:
    """Return the cost by a person's own prices: those of the longest beginning of a name that fits."""
    path = folder / PRICES_FILE if folder is not None else None
    rows = _table(path).get(provider, {}) if path is not None and path.exists() else {}
    fitting = [name for name in rows if model.startswith(name)]
    if not fitting:
        return None
    prompt, cached, reply = rows[max(fitting, key=len)]
    fresh_tokens = max(0, usage.prompt_tokens - usage.cached_tokens)
    return (fresh_tokens * prompt + usage.cached_tokens * cached + usage.reply_tokens * reply) / _PER_USD


def _list_cost(usage: Usage, provider: str, model: str) -> float | None:
    """Return the cost by the price list that comes with the model library: dated by its release, never fetched."""
    try:
        import genai_prices
    except ImportError:
        return None
    tokens = genai_prices.Usage(
        input_tokens=usage.prompt_tokens,
        cache_read_tokens=min(usage.cached_tokens, usage.prompt_tokens),
        output_tokens=usage.reply_tokens,
    )
    try:
        found = genai_prices.calc_price(tokens, model, provider_id=provider)
    except (LookupError, ValueError):
        return None
    # It takes a similar name for the provider meant, too: `openai-compatible`, which may be anybody's server.
    return float(found.total_price) if found.provider.id == provider else None


@cache
def _table(path: Path) -> dict[str, dict[str, tuple[float, float, float]]]:
    """Read US dollars per million tokens (prompt, cached, reply) by provider and beginning of a model's name."""
    try:
        table: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        return {
            provider: {
                name: (float(row["prompt"]), float(row.get("cached", row["prompt"])), float(row["reply"]))
                for name, row in rows.items()
            }
            for provider, rows in table.items()
            if isinstance(rows, dict)
        }
    except (OSError, ValueError, TypeError, AttributeError, KeyError) as error:
        raise InputError(
            str(error), where=str(path), allowed='["provider"] "model" = { prompt = …, reply = … }'
        ) from None


@dataclass
class Total:
    """Sum over calls. `cost_usd` leaves out the `unpriced` ones; `estimated` counts calls nobody counted for us."""

    calls: int = 0
    prompt_tokens: int = 0
    cached_tokens: int = 0
    reply_tokens: int = 0
    cost_usd: float = 0.0
    unpriced: int = 0
    estimated: int = 0

    def add(self, line: dict[str, Any]) -> None:
        """Add one recorded call."""
        self.calls += 1
        self.prompt_tokens += int(line.get("prompt_tokens", 0))
        self.cached_tokens += int(line.get("cached_tokens", 0))
        self.reply_tokens += int(line.get("reply_tokens", 0))
        cost = line.get("cost_usd")
        self.cost_usd += float(cost or 0.0)
        self.unpriced += cost is None
        self.estimated += not line.get("counted", True)

    def join(self, other: Total) -> None:
        """Add another sum."""
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
    """Yield the recorded calls, oldest first; a line that was cut off is left out."""
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
    """Return sums by `session`, `model` or `day`, in the order of their first call."""
    found: dict[str, Total] = {}
    for line in lines(folder):
        name = _day(line) if key == "day" else str(line.get(key, ""))
        found.setdefault(name, Total()).add(line)
    return found


def _day(line: dict[str, Any]) -> str:
    return time.strftime("%Y-%m-%d", time.localtime(float(line.get("at", 0))))
