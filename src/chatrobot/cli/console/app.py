"""Puts the console together: robot, controller, and the display that this terminal can carry."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace

from rich.console import RenderableType
from rich.text import Text

from chatrobot.cli.console import commands, plain
from chatrobot.cli.console.controller import ChatController
from chatrobot.cli.console.lesson import ConsoleLesson
from chatrobot.cli.console.lines import indented
from chatrobot.cli.console.page import PageBeside
from chatrobot.cli.console.tables import example_place, place_in
from chatrobot.cli.console.words import Words, language_of_environment
from chatrobot.cli.lines import TypedAhead
from chatrobot.compose import Connection, OnEvent, Setup
from chatrobot.core.clock import RealClock
from chatrobot.core.errors import LinkError, UsageError
from chatrobot.core.events import Event, TruePose
from chatrobot.link.processes import SIMULATED

HISTORY_FILE = "history"


def run_console(
    setup: Setup,
    typed_ahead: TypedAhead,
    meet: Callable[[Setup, OnEvent], Connection],
    *,
    has_page: bool = False,
    lesson: ConsoleLesson | None = None,
) -> int:
    """Talk to the robot until somebody leaves. What is said while it moves replaces what it does.

    Args:
        typed_ahead: has what was typed while the robot started.
        meet: connects to the robot, and records what happens where that was chosen.
        has_page: show it in a browser, too.
        lesson: what the robot does is judged by it.

    Raises:
        InputError: the setup is wrong.
        LinkError: the robot does not start.
    """
    if setup.fast:
        raise UsageError("the console runs in real time", where="--fast", allowed='chatrobot do "…" --fast')
    words = Words(language_of_environment())
    options = replace(setup.options, while_moving="replace", ask_new=not setup.yes)
    setup = replace(setup, trace=lesson is not None, options=options)
    listeners = _Listeners(lesson)
    connection = meet(setup, listeners.hear)
    controller = listeners.controller = ChatController(connection, words, RealClock(), commands.run)
    page = listeners.page = PageBeside(controller, is_simulated=setup.on in SIMULATED) if has_page else None
    try:
        begin = greeting(controller, setup.on) if lesson is None else lesson.begin(controller)
        return _converse(controller, setup, typed_ahead, begin, page.start if page else lambda: None)
    finally:
        if page is not None:
            page.close()
        connection.close()


class _Listeners:
    """Who hears the events of the one session of a console."""

    def __init__(self, lesson: ConsoleLesson | None) -> None:
        self._lesson = lesson
        self.controller: ChatController | None = None
        self.page: PageBeside | None = None

    def hear(self, event: Event) -> None:
        """Hand an event on."""
        if self._lesson is not None and isinstance(event, TruePose):
            self._lesson.hear(event)  # from the moment of connecting on
            return
        assert self.controller is not None  # nothing else is heard before it is pumped
        self.controller.hear(event)
        if self.page is not None:
            self.page.hear(event)
        if self._lesson is not None:
            self._lesson.hear(event)


def can_chat() -> bool:
    """Tell whether the terminal can do colours and move its cursor, and is wide enough for a line."""
    return (
        os.environ.get("TERM", "dumb") not in ("dumb", "unknown", "")
        and "NO_COLOR" not in os.environ
        and sys.stdin.isatty()
        and sys.stdout.isatty()
        and shutil.get_terminal_size().columns >= plain.LEAST_WIDTH
    )


def _converse(
    controller: ChatController,
    setup: Setup,
    typed_ahead: TypedAhead,
    begin: Sequence[RenderableType],
    on_prompt: Callable[[], None],
) -> int:
    def hang_up() -> None:
        with contextlib.suppress(LinkError):  # nothing is said: nobody is there to read it
            controller.session.stop("terminal closed")
        controller.connection.close()

    if can_chat():
        from chatrobot.cli.console.chat import Chat

        history = setup.folder / HISTORY_FILE if setup.folder is not None else None
        display: Chat | plain.Plain = Chat(controller, history, hang_up)
    else:
        display = plain.Plain(controller, hang_up)
    controller.display = display
    display.print(*begin)
    for text in typed_ahead.stop():
        controller.enter(text)
    if typed_ahead.has_ended:
        controller.leave()
    on_prompt()
    code = display.run()
    if code != 0:
        with contextlib.suppress(LinkError):
            controller.session.stop("the console has ended")
    elif not controller.has_parted:
        print(f"  {controller.words.say('goodbye')}")
    return code


def greeting(controller: ChatController, on: str) -> tuple[RenderableType, ...]:
    """Say which robot it is, where it is, and three things to say."""
    words, world = controller.words, controller.connection.world
    title = controller.connection.profile.title
    if on in SIMULATED:
        where = words.say("greeting_open") if world.is_empty else words.say("greeting_world", name=world.name)
        line = Text(words.say("greeting_robot", title=title, world=where))
    else:
        line = Text(words.say("greeting_wired", title=title, wire=on.rstrip(":")))
    place = place_in(words.language, world, example_place(world))
    second = words.say("example_place", place=place) if place else words.say("example_turn")
    first, third = words.say("example_first"), words.say("example_third")
    examples = Text(words.say("greeting_examples", first=first, second=second, third=third), "dim")
    for example in (first, second, third):
        examples.highlight_words([example], "not dim bold cyan")
    line.highlight_words([title], "bold")
    return indented(line), indented(examples)
