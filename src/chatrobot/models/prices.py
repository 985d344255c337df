"""What tokens cost, from `data/prices.toml` (dated, never fetched) and a person's own `prices.toml` before it."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

from chatrobot.core.errors import InputError
from chatrobot.models.seam import Usage

FILE = "prices.toml"
_BUILT_IN = Path(__file__).parent / "data" / FILE
_SAME_AS = {"openai-responses": "openai"}
_PER_USD = 1e6


def prices_date() -> str:
    """The day our prices were looked up, as YYYY-MM-DD."""
    return str(_table(_BUILT_IN)["date"])


def priced(usage: Usage, provider: str, model: str, folder: Path | None = None) -> Usage:
    """The usage with its cost in US dollars, or as it is where the price is not known."""
    try:
        price = _price(_SAME_AS.get(provider, provider), model, folder)
    except InputError:
        return (
            usage  # a call has been made; `chatrobot usage` says what is wrong with the file (`check_prices`)
        )
    if price is None:
        return usage
    prompt, cached, reply = price
    fresh = max(0, usage.prompt_tokens - usage.cached_tokens)
    cost = (fresh * prompt + usage.cached_tokens * cached + usage.reply_tokens * reply) / _PER_USD
    return replace(usage, cost_usd=cost)


def check_prices(folder: Path) -> None:
    """Read a person's own file of prices, where there is one.

    Raises:
        InputError: it cannot be read.
    """
    if (folder / FILE).exists():
        _table(folder / FILE)


def _price(provider: str, model: str, folder: Path | None) -> tuple[float, float, float] | None:
    own = folder / FILE if folder is not None else None
    for path in (own, _BUILT_IN):
        rows = _table(path).get(provider, {}) if path is not None and path.exists() else {}
        fitting = [name for name in rows if model.startswith(name)]
        if fitting:
            row = rows[max(fitting, key=len)]
            prompt = float(row["prompt"])
            return prompt, float(row.get("cached", prompt)), float(row["reply"])
    return None


@cache
def _table(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(
            str(error), where=str(path), allowed='["provider"] "model" = { prompt = …, reply = … }'
        ) from None
