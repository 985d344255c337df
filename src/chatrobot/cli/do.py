"""`chatrobot do TEXT [TEXT…]`: one instruction, or a dialogue turn by turn. `--plan FILE`: a saved plan first."""

from __future__ import annotations

import argparse

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.console.pasted import goes_on_after, quoted
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.json_lines import Printer, printer_for
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
    results: list[Result] = []
    with conversation:
        if conversation.is_leaving:
            conversation.tell_dropped([args.plan, *args.texts] if args.plan else args.texts)
            return conversation.exit_code
        if plan_text:
            if args.texts:
                printer.turn(args.plan)
            results.append(conversation.do_plan(plan_text))
        if not _do_texts(args, conversation, printer, results):
            return EXIT_CODES["refused"]
    undone = [result for result in results if not goes_on_after(result.outcome)]
    if args.keep_going and undone and not (conversation.is_leaving or _is_stopped_by_somebody(results)):
        return EXIT_CODES[undone[0].outcome]
    return conversation.exit_code


def _do_texts(
    args: argparse.Namespace, conversation: Conversation, printer: Printer, results: list[Result]
) -> bool:
    """Do the texts turn by turn, as long as they may follow; name the rest. False where it came after a goodbye."""
    for number, text in enumerate(args.texts):
        rest = args.texts[number:]
        is_stopped = conversation.is_leaving or _is_stopped_by_somebody(results)
        if conversation.has_parted and not is_stopped:
            conversation.tell_dropped(rest)
            return False
        if is_stopped or not (args.keep_going or may_follow(text, results)):
            code = "turns_stopped" if is_stopped else "turns_not_done"
            texts = quoted(rest, conversation.language)
            conversation.show(Notice(0, Reason(code, {"texts": texts, "count": len(rest)})))
            break
        if len(args.texts) > 1 or results:
            printer.turn(text)
        results.append(conversation.do(text))
        if is_emergency_stop(text):
            conversation.show(Notice(results[-1].turn, Reason("emergency_stop_ends")))
    return True


def _is_stopped_by_somebody(results: list[Result]) -> bool:
    """Tell whether the last turn was stopped from elsewhere: by `chatrobot stop`, or by another client."""
    why = results[-1].reason if results else None
    return why is not None and why.code == "stopped_by"


def may_follow(text: str, results: list[Result]) -> bool:
    """Tell whether `text` is taken after turns that ended so: all was done, or it answers what was asked, once."""
    if not results or goes_on_after(results[-1].outcome):
        return True
    if len(results) > 1 and results[-2].is_question and not goes_on_after(results[-2].outcome):
        return False  # the last text was to be the answer
    last = results[-1]
    return last.outcome == "unclear" or (last.is_question and read_consent(text) is not None)
