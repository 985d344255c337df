"""`chatrobot` without a command: the console at a terminal, otherwise lines in and events out."""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import replace
from typing import Any

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.json_lines import printer_for
from chatrobot.cli.lines import GOODBYES, PASTE_S, LineReader, TypedAhead
from chatrobot.cli.recorder import recorded
from chatrobot.core.events import Notice
from chatrobot.core.reason import Reason
from chatrobot.reflex import is_stop, leads_with_stop


def run(args: argparse.Namespace) -> int:
    """Return the exit code of the last turn."""
    setup = setup_from(args, programs=True)
    if sys.stdin.isatty() and not args.json:
        from chatrobot.cli.console.app import run_console

        typed_ahead = args.early.typed_ahead if args.early is not None else TypedAhead()
        return run_console(setup, typed_ahead, recorded(args, unasked=True), has_page=args.web)
    from chatrobot.cli.human import HumanPrinter  # late: the console is there sooner

    printer = printer_for(args)
    approver = Approver(can_ask=False, others_answer=args.json)
    if args.json and args.fast:  # time stands while a line waits: none is early
        setup = replace(setup, options=replace(setup.options, answers_in_turn=True))
    with Conversation(setup, printer, approver, recorded(args)) as conversation:
        if isinstance(printer, HumanPrinter):
            conversation.session.on_said = printer.note_said
        lines = PipedLines(conversation)
        hear = JsonInput(lines, conversation, approver).hear if args.json else lines.hear
        reader = LineReader(hear, lines.note_read)
        reader.start()
        while not (conversation.is_leaving or conversation.has_parted or reader.has_ended):
            conversation.wait() if conversation.session.is_idle else conversation.step()
        conversation.finish()
        if conversation.has_parted:  # what came with the goodbye is named
            reader.wait(PASTE_S)
            conversation.finish()
    return conversation.exit_code


class PipedLines:
    """Lines of a pipe. One of `GOODBYES` ends them, but "quit" stops a robot that moved before it was read."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self._moves = False

    def note_read(self) -> None:
        """Note whether the robot moves where lines have come, which may come all at once. By the reader's thread."""
        self._moves = self._conversation.session.is_moving

    def hear(self, line: str) -> None:
        """Called by the reader's thread."""
        leaves = line.casefold() in GOODBYES
        if not leaves or (self._moves and is_stop(line) and not line.startswith("/")):
            self._conversation.hear(line)
        if leaves:
            self._conversation.leave()


class JsonInput:
    """Lines of a `--json` session: text as it is, {"text": …}, or {"approve": true|false} for a plan that waits."""

    def __init__(self, lines: PipedLines, conversation: Conversation, approver: Approver) -> None:
        self._lines = lines
        self._conversation = conversation
        self._approver = approver

    def hear(self, line: str) -> None:
        """Called by the reader's thread."""
        data = _read_object(line)
        if data is None:
            self._lines.hear(line)
            return
        text, yes = data.get("text"), data.get("approve")
        if isinstance(text, str) and text.strip():
            self._conversation.hear(text)
        elif isinstance(yes, bool):
            asked, approved = self._approver.turn, yes
            self._conversation.post(lambda: self._answer(asked, approved))
        else:
            notice = Notice(
                0, Reason("bad_input_line", {"line": line[:80]}), 'not {"text": …} nor {"approve": …}'
            )
            self._conversation.post(lambda: self._conversation.show(notice))

    def _answer(self, asked: int | None, yes: bool) -> None:
        """Answer what was asked when the line came; a plan that is shown later was not meant."""
        if asked is None or asked != self._approver.turn:
            self._conversation.show(
                Notice(0, Reason("nothing_asked"), "no plan waited for a yes when this line came")
            )
        else:
            self._approver.answer(self._conversation.session, yes)


def _read_object(line: str) -> dict[str, Any] | None:
    """Return the object of a line of JSON, an empty one where it has none; None where the line is a text."""
    try:
        data = json.loads(line)
    except (ValueError, RecursionError):
        return {} if line.startswith("{") else None
    if isinstance(data, dict):
        return data
    return None if leads_with_stop(line) else {}  # `"stop"` is JSON of no known form, and stops all the same
