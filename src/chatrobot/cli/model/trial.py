"""One sentence to a model, and what came of it: text, times, tokens, cost."""

from __future__ import annotations

import sys
import time
from typing import Any

from chatrobot.cli.json_lines import json_line
from chatrobot.core.errors import PlanTextError
from chatrobot.core.reason import Reason
from chatrobot.language.phrases import render_reason
from chatrobot.models.config import ModelConfig
from chatrobot.models.make import make_model, warm
from chatrobot.models.prices import prices_date
from chatrobot.models.seam import CallLimits, Message, ModelError, Usage
from chatrobot.models.state import problem_with
from chatrobot.plan.text import parse_plan

SENTENCE = "Go one metre forward, then turn left."
LOADING_S = 60.0
_SYSTEM = """\
You drive a robot. Reply with plan text alone, one step a line, nothing else. Steps look like this:
drive 2 m
turn right 45 deg"""


def try_model(name: str, config: ModelConfig, *, as_json: bool = False) -> int:
    """Ask one sentence and print what came. 0 for a reply that keeps to the form, 1 otherwise."""
    problem = problem_with(name, config)
    if problem is not None:
        return _tell(name, problem, as_json)
    if not as_json:
        print(f"> {SENTENCE}", flush=True)
    model = make_model(name, config)
    warm(model, wait_s=LOADING_S)  # a session does this while its person is still typing
    began_s = time.monotonic()
    reply = model.ask([Message("system", _SYSTEM), Message("user", SENTENCE)], CallLimits(reply_tokens=300))
    pieces: list[str] = []
    first_s: float | None = None
    try:
        for piece in reply:
            first_s = first_s or time.monotonic() - began_s
            pieces.append(piece)
    except ModelError as error:
        return _tell(name, error.reason, as_json)
    result: dict[str, Any] = {
        "event": "model_test", "model": name, "text": "".join(pieces), "first_piece_s": round(first_s or 0.0, 3),
        "total_s": round(time.monotonic() - began_s, 3), "keeps_to_the_form": _is_plan("".join(pieces)),
    }  # fmt: skip
    _print(result, reply.usage or Usage(), as_json)
    return 0 if result["keeps_to_the_form"] else 1


def _print(result: dict[str, Any], usage: Usage, as_json: bool) -> None:
    if as_json:
        tokens = {
            "prompt_tokens": usage.prompt_tokens,
            "reply_tokens": usage.reply_tokens,
            "cost_usd": usage.cost_usd,
        }
        sys.stdout.write(json_line({**result, **tokens}))
        return
    for line in result["text"].splitlines():
        print(f"    {line}")
    about = "" if usage.counted else "about "
    print(f"  first words after {result['first_piece_s']:.2f} s, all after {result['total_s']:.2f} s")
    print(f"  {about}{usage.prompt_tokens} + {usage.reply_tokens} tokens, {cost_text(usage.cost_usd)}")
    print(f"  {'it keeps to the form of a plan' if result['keeps_to_the_form'] else 'this is no plan text'}")


def _tell(name: str, reason: Reason, as_json: bool) -> int:
    if as_json:
        sys.stdout.write(json_line({"event": "model_test", "model": name, "failed": reason.to_json()}))
    print(render_reason(reason, "en"), file=sys.stderr)
    return 1


def _is_plan(text: str) -> bool:
    try:
        return bool(parse_plan(text).steps)
    except PlanTextError:
        return False


def cost_text(cost_usd: float | None) -> str:
    """A price in words; small ones in tenths of a cent, so that they are not all zero."""
    if cost_usd is None:
        return "cost unknown"
    if cost_usd == 0:
        return "no cost"
    return f"$ {cost_usd:.6f} (prices of {prices_date()})"
