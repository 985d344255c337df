"""Asks a model one sentence, as a session would, and prints what came of it: text, times, tokens, cost."""

from __future__ import annotations

import sys
import time
from typing import Any

from chatrobot.cli.json_lines import json_line
from chatrobot.core.reason import Reason
from chatrobot.dialogue.llm.prompt import system_prompt
from chatrobot.dialogue.llm.reply_reader import ReplyReader
from chatrobot.language.phrases import render_reason
from chatrobot.models.config import ModelConfig
from chatrobot.models.make import make_model, problem_with, warm
from chatrobot.models.seam import CallLimits, Message, ModelError, Usage
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile

SENTENCE = "Go one metre forward, then turn left."
LOADING_S = 60.0


def try_model(name: str, config: ModelConfig, *, as_json: bool = False) -> int:
    """Ask one sentence and print what came. 0 for a reply that keeps to the form, 1 otherwise."""
    problem = problem_with(name, config)
    if problem is not None:
        return _tell(name, problem, as_json)
    if not as_json:
        print(f"> {SENTENCE}", flush=True)
    model = make_model(name, config)
    warm(model, wait_s=LOADING_S)  # a session does this while its person is still typing
    messages = [
        Message("system", system_prompt(load_profile(DEFAULT_PROFILE), {})),
        Message("user", SENTENCE),
    ]
    reader, began_s, first_s = ReplyReader(), time.monotonic(), 0.0
    reply = model.ask(messages, CallLimits(reply_tokens=300))
    steps = 0
    try:
        for piece in reply:
            first_s = first_s or time.monotonic() - began_s
            steps += len(reader.feed(piece))
    except ModelError as error:
        return _tell(name, error.reason, as_json)
    steps += len(reader.finish())
    result: dict[str, Any] = {
        "event": "model_test", "model": name, "text": reader.text, "first_piece_s": round(first_s, 3),
        "total_s": round(time.monotonic() - began_s, 3), "keeps_to_the_form": steps > 0 and reader.error is None,
    }  # fmt: skip
    _print(result, reply.usage or Usage(), as_json)
    return 0 if result["keeps_to_the_form"] else 1


def _print(result: dict[str, Any], usage: Usage, as_json: bool) -> None:
    if as_json:
        names = ("prompt_tokens", "reply_tokens", "cost_usd")
        sys.stdout.write(json_line({**result, **{name: getattr(usage, name) for name in names}}))
        return
    for line in result["text"].splitlines():
        print(f"    {line}")
    about = "" if usage.counted else "about "
    print(f"  first words after {result['first_piece_s']:.2f} s, all after {result['total_s']:.2f} s")
    print(f"  {about}{usage.prompt_tokens} + {usage.reply_tokens} tokens, {_cost(usage, result['model'])}")
    print(f"  {'it keeps to the form of a plan' if result['keeps_to_the_form'] else 'this is no plan text'}")


def _cost(usage: Usage, model: str) -> str:
    if usage.cost_usd is None:
        return f"cost unknown: no price is known for {model} (docs/models.md, Cost)"
    return f"$ {usage.cost_usd:.6f} at list price" if usage.cost_usd else "no cost"


def _tell(name: str, reason: Reason, as_json: bool) -> int:
    if as_json:
        sys.stdout.write(json_line({"event": "model_test", "model": name, "failed": reason.to_json()}))
    print(render_reason(reason, "en"), file=sys.stderr)
    return 1
