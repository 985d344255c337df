"""`chatrobot do TEXT [TEXT…]`: one instruction, or a dialogue turn by turn."""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.keyboard import Keyboard, has_keyboard
from chatrobot.cli.printer import printer_for
from chatrobot.core.events import Notice, Outcome
from chatrobot.core.reason import Reason

DONE: tuple[Outcome, ...] = ("completed", "answered")


def run(args: argparse.Namespace) -> int:
    """The exit code of the last turn that was taken."""
    printer = printer_for(args)
    approver = Approver(can_ask=has_keyboard())
    with Conversation(setup_from(args, programs=True), printer, approver) as conversation:
        Keyboard(conversation, approver).start()
        before: Outcome = "completed"
        for number, text in enumerate(args.texts):
            if conversation.is_leaving or conversation.has_parted:
                break
            if len(args.texts) > 1:
                printer.turn(text)
            outcome = conversation.do(text)
            if not (args.keep_going or goes_on_after(outcome, before)):
                _tell_not_done(conversation, args.texts[number + 1 :])
                break
            before = outcome
    return conversation.exit_code


def goes_on_after(outcome: Outcome, before: Outcome) -> bool:
    """Whether the next text is taken. What was not understood asks back, and the next text answers, once."""
    return outcome in DONE or (outcome == "unclear" and before != "unclear")


def _tell_not_done(conversation: Conversation, texts: Sequence[str]) -> None:
    if texts and not conversation.is_leaving:
        quoted = ", ".join(f"“{text}”" for text in texts)
        conversation.show(Notice(0, Reason("turns_not_done", {"texts": quoted, "count": len(texts)})))
