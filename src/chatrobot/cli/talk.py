"""`chatrobot` without a command: the console at a terminal, otherwise lines in and events out."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.json_lines import printer_for
from chatrobot.cli.lines import LineReader, TypedAhead
from chatrobot.cli.recorder import recorded
from chatrobot.core.events import Notice
from chatrobot.core.reason import Reason


def run(args: argparse.Namespace) -> int:
    """Return the exit code of the last turn."""
    setup = setup_from(args, programs=True)
    if sys.stdin.isatty() and not args.json:
        from chatrobot.cli.console.app import run_console

        typed_ahead = args.early.typed_ahead if args.early is not None else TypedAhead()
        return run_console(setup, typed_ahead, recorded(args, unasked=True), has_page=args.web)
    printer = printer_for(args)
    approver = Approver(can_ask=False, others_answer=args.json)
    with Conversation(setup, printer, approver, recorded(args)) as conversation:
        reader = LineReader(JsonInput(conversation, approver).hear if args.json else conversation.hear)
        reader.start()
        while not (conversation.is_leaving or conversation.has_parted or reader.has_ended):
            session = conversation.session
            conversation.wait() if session.is_idle or session.waits_for_a_word else conversation.step()
        conversation.finish()
    return conversation.exit_code


class JsonInput:
    """Lines of a `--json` session: text as it is, {"text": …}, or {"approve": true|false} for a plan that waits."""

    def __init__(self, conversation: Conversation, approver: Approver) -> None:
        self._conversation = conversation
        self._approver = approver

    def hear(self, line: str) -> None:
        """Called by the reader's thread."""
        if not line.startswith("{"):
            self._conversation.hear(line)
            return
        data = _read_object(line)
        text, yes = data.get("text"), data.get("approve")
        if isinstance(text, str) and text.strip():
            self._conversation.hear(text)
        elif isinstance(yes, bool):
            approved = yes
            self._conversation.post(lambda: self._approver.answer(self._conversation.session, approved))
        else:
            notice = Notice(
                0, Reason("bad_input_line", {"line": line[:80]}), 'not {"text": …} nor {"approve": …}'
            )
            self._conversation.post(lambda: self._conversation.show(notice))


def _read_object(line: str) -> dict[str, Any]:
    try:
        data = json.loads(line)
    except (ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}
