"""`chatrobot do TEXT [TEXT…]`: one instruction, or a dialogue turn by turn. `--plan FILE`: a saved plan first."""

from __future__ import annotations

import argparse

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.console.pasted import goes_on_after, quoted
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.json_lines import printer_for
from chatrobot.cli.keyboard import Keyboard
from chatrobot.cli.lines import has_keyboard
from chatrobot.cli.plan import read_plan_file
from chatrobot.cli.recorder import recorded
from chatrobot.core.events import EXIT_CODES, Notice, Result
from chatrobot.core.reason import Reason
from chatrobot.language.consent import read_consent
from chatrobot.reflex import is_emergency_stop


def run(args: argparse.Namespace) -> int:
    """Return the exit code of the last turn that was taken; with `--keep-going` of the first that was not done.

    Raises:
        UsageError: the plan's file cannot be used.
    """
    plan_text = read_plan_file(args.plan, or_stdin=True) if args.plan else ""
    printer = printer_for(args)
    approver = Approver(can_ask=has_keyboard())
    conversation = Conversation(setup_from(args, programs=True), printer, approver, recorded(args))
    Keyboard(conversation, approver).start()  # a stop may be typed while the robot starts
    with conversation:
        conversation.tell_dropped([args.plan, *args.texts] if args.plan else args.texts)
        results: list[Result] = []
        if plan_text and not conversation.is_leaving:
            if args.texts:
                printer.turn(args.plan)
            results.append(conversation.do_plan(plan_text))
        for number, text in enumerate(args.texts):
            if conversation.is_leaving:
                break
            if conversation.has_parted:
                conversation.tell_dropped(args.texts[number:])
                return EXIT_CODES["refused"]
            if not (args.keep_going or may_follow(text, results)):
                rest = args.texts[number:]
                reason = Reason(
                    "turns_not_done", {"texts": quoted(rest, conversation.language), "count": len(rest)}
                )
                conversation.show(Notice(0, reason))
                break
            if len(args.texts) > 1 or plan_text:
                printer.turn(text)
            results.append(conversation.do(text))
            if is_emergency_stop(text):
                conversation.show(Notice(results[-1].turn, Reason("emergency_stop_ends")))
    undone = [result for result in results if not goes_on_after(result.outcome)]
    if args.keep_going and undone and not conversation.is_leaving:
        return EXIT_CODES[undone[0].outcome]
    return conversation.exit_code


def may_follow(text: str, results: list[Result]) -> bool:
    """Tell whether `text` is taken after turns that ended so: all was done, or it answers what was asked, once."""
    if not results or goes_on_after(results[-1].outcome):
        return True
    if len(results) > 1 and results[-2].is_question and not goes_on_after(results[-2].outcome):
        return False  # the last text was to be the answer
    last = results[-1]
    return last.outcome == "unclear" or (last.is_question and read_consent(text) is not None)
