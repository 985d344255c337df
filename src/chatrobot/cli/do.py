"""`chatrobot do TEXT [TEXT…]`: one instruction, or a dialogue turn by turn."""

from __future__ import annotations

import argparse

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.keyboard import Keyboard, has_keyboard
from chatrobot.cli.printer import printer_for


def run(args: argparse.Namespace) -> int:
    """The exit code of the last turn."""
    printer = printer_for(args)
    approver = Approver(can_ask=has_keyboard())
    conversation = Conversation(setup_from(args, programs=True), printer, approver)
    Keyboard(conversation, approver).start()  # a stop may be typed while the robot starts
    with conversation:
        conversation.drop_if_stopped(args.texts)
        for text in args.texts:
            if conversation.is_leaving or conversation.has_parted:
                break
            if len(args.texts) > 1:
                printer.turn(text)
            conversation.do(text)
    return conversation.exit_code
