"""Runs `chatrobot fake-model SCRIPT.yaml`: a scripted stand-in for a language model."""

from __future__ import annotations

import argparse
import os
import secrets
import sys
from dataclasses import replace
from pathlib import Path

from chatrobot.cli.entry import STOPPED
from chatrobot.cli.json_lines import json_line
from chatrobot.core.errors import UsageError
from chatrobot.models.discovery import LOOPBACK
from chatrobot.models.fake.script import load_script
from chatrobot.models.fake.server import Call, FakeModel


def run(args: argparse.Namespace) -> int:
    """Serve until Ctrl-C. Beyond loopback callers need a token, which is printed."""
    script = load_script(Path(args.script))
    if args.host not in LOOPBACK and not script.keys:
        script = replace(script, keys=(secrets.token_urlsafe(24),))
    fake = FakeModel(script, host=args.host, port=args.port, on_call=_show_json if args.json else _show)
    try:
        fake.start()
    except OSError as error:
        why = (
            os.strerror(error.errno) if error.errno and error.errno > 0 else error
        )  # asyncio adds the address a second time
        problem = f"cannot listen on {args.host}:{args.port}: {why}"
        raise UsageError(problem, allowed="--port 0") from None
    if args.json:
        _print_json({"event": "listening", "url": fake.url, "model": script.models[0]})
    else:
        print(f"a fake model listens on {fake.url}; it ends with Ctrl-C. To use it:")
        key = script.keys[0] if script.keys else "any"
        print(f"  export OPENAI_BASE_URL={fake.url}/v1 OPENAI_API_KEY={key}")
        print(f"  chatrobot --model openai:{script.models[0]}")
        print(
            "OpenAI (Chat Completions, Responses), Anthropic, Google and Ollama are understood.", flush=True
        )
    try:
        fake.closing.wait()
    except KeyboardInterrupt:
        fake.stop()
    return STOPPED


def _show(call: Call) -> None:
    print(f"{call.path}  {' '.join(_said(call).split())[:100]}", flush=True)


def _show_json(call: Call) -> None:
    _print_json({"event": "call", "path": call.path, "said": _said(call)})


def _print_json(event: dict[str, str]) -> None:
    sys.stdout.write(json_line(event))
    sys.stdout.flush()


def _said(call: Call) -> str:
    return call.asked.said if call.asked is not None else ""
