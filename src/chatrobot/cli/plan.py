"""`chatrobot plan TEXT`: understand and rehearse; nothing moves, nothing is started. And plans that were saved."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from chatrobot.cli.choices import setup_from
from chatrobot.cli.json_lines import printer_for
from chatrobot.compose import Connection, connect
from chatrobot.core.errors import PlanTextError, UsageError
from chatrobot.core.events import EXIT_CODES, Event, Rehearsed, Result
from chatrobot.dialogue.options import Options
from chatrobot.language.phrases import render_reason
from chatrobot.link.processes import SIMULATED
from chatrobot.plan.json_form import plan_from_json
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.reflex import is_stop


def run(args: argparse.Namespace) -> int:
    """Return the exit code of the turn: 0 where the plan could be done.

    Raises:
        UsageError: `--png` names no PNG file.
    """
    png = Path(args.png) if args.png else None
    if png is not None and png.suffix.lower() != ".png":
        raise UsageError(f"{args.png!r} is not a PNG file", where="--png", allowed="a name that ends in .png")
    printer = printer_for(args)
    rehearsed: list[Rehearsed] = []
    results: list[Result] = []

    def on_event(event: Event) -> None:
        if isinstance(event, Rehearsed):
            rehearsed.append(event)
        if isinstance(event, Result) and is_stop(args.text):  # there was nothing to be stopped
            event = replace(
                event, outcome="answered", reply=session.understanding.say("only_stops", args.text)
            )
        if isinstance(event, Result):
            results.append(event)
        printer.show(event, session.understanding.language)

    setup = setup_from(args, options=Options(rehearse_only=True), programs=True)
    setup = replace(setup, fast=setup.on in SIMULATED, trace=False)
    connection = connect(setup, lambda event: on_event(event))
    session = connection.session
    session.do(args.text)
    connection.close()
    if args.explain:
        print("\n".join(session.understanding.why()), file=sys.stderr if args.json else sys.stdout)
    if png is not None:
        _draw(png, args.text, connection, rehearsed)
    return EXIT_CODES[results[-1].outcome]


def _draw(png: Path, title: str, connection: Connection, rehearsed: list[Rehearsed]) -> None:
    """Draw the last plan that was rehearsed."""
    if not rehearsed:
        print("chatrobot: there is no plan to draw", file=sys.stderr)
        return
    from chatrobot.cli.draw import draw_plan

    language = connection.session.understanding.language
    draw_plan(
        png,
        world=connection.world,
        profile=connection.profile,
        rehearsed=rehearsed[-1],
        title=title,
        words=lambda finding: render_reason(finding.reason, language),
    )


MOST_BYTES = 65_536
"""A longer file was most likely meant for something else; a plan is over after half an hour at the latest."""


def read_plan_file(name: str, *, or_stdin: bool = False, takes_pipe: bool = True) -> str:
    """Return the text of the plan in that file, which may have it as JSON. `or_stdin`: - is standard input.

    `takes_pipe`: so is what others still write; without it nothing is waited for.

    Raises:
        UsageError: there is no such file, or a line of it cannot be read; which, and what is allowed there.
    """
    path: Path | str = Path(name).expanduser()
    try:
        if or_stdin and name == "-":
            path = "standard input"
            content = sys.stdin.buffer.read(MOST_BYTES + 1)
        else:
            if not takes_pipe and Path(path).exists() and not Path(path).is_file():
                raise UsageError("not a file", where=str(path), allowed="a file that holds a plan")
            with Path(path).open("rb") as file:
                content = file.read(MOST_BYTES + 1)
        text = content.decode("utf-8-sig")
    except OSError as error:
        raise UsageError(error.strerror or "cannot be read", where=str(path)) from error
    except UnicodeDecodeError as error:
        raise UsageError("not a text file", where=str(path), allowed="plan text, one step a line") from error
    if len(content) > MOST_BYTES:
        raise UsageError("too long for a plan", where=str(path), allowed=f"at most {MOST_BYTES} bytes")
    try:
        if text.lstrip().startswith("{"):
            return format_plan(plan_from_json(text))
        parse_plan(text)
    except PlanTextError as error:
        raise UsageError(str(error), where=str(path)) from error
    return text
