"""The tool `programs`: an agent lists, writes, rehearses and runs ROS 2 programs, in the sandbox like everybody's."""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from mcp_types import CallToolResult

from chatrobot.core.errors import InputError
from chatrobot.dialogue.programs.authoring import Authoring
from chatrobot.dialogue.session import Session
from chatrobot.link.envelope import MAX_CODE_CHARS
from chatrobot.mcp_server.calls import Calls, Line, Report
from chatrobot.mcp_server.robot import AgentRobot
from chatrobot.mcp_server.told import answer, course_told, error
from chatrobot.programs.library import AGENT, KeptProgram, Provenance, clean_name, today

ACTIONS = ("list", "show", "write", "rehearse", "run")
MOST_WORDS_CHARS = 4_000


class ProgramTool:
    """Does what `programs` is called for. Nothing here removes or replaces a program that is kept."""

    def __init__(self, robot: AgentRobot, calls: Calls) -> None:
        self._robot = robot
        self._calls = calls

    async def do(
        self, action: str, name: str, text: str, report: Report, line: Line | None
    ) -> CallToolResult:
        """Do one action.

        Raises:
            ChatRobotError: there is no robot, no such program, or it cannot be kept.
        """
        if action not in ACTIONS:
            return error(f"{action!r} is no action: {', '.join(ACTIONS)}.", "bad_arguments")
        authoring = (await self._robot.ready()).session.authoring
        if authoring is None:
            return error("This robot runs no programs.", "no_programs")
        if action == "list":
            return _listed(authoring)
        if action == "write":
            return await self._write(authoring, name, text, report, line)
        if not name.strip():
            return error(f"{action} needs the name of a program: see programs(list).", "bad_arguments")
        try:
            program = authoring.library.get(name)
        except InputError as wrong:
            return error(str(wrong), "no_program")
        if action == "show":
            return answer(f"{program.name}:\n{program.source}", {**about(program), "source": program.source})
        draft = authoring.draft_of(program)
        return await self._see_through(
            lambda session: session.say_draft(draft), report, line, rehearse_only=action == "rehearse"
        )

    async def _write(
        self, authoring: Authoring, name: str, text: str, report: Report, line: Line | None
    ) -> CallToolResult:
        if not text.strip():
            return error("write needs text: a Python program, or what it is to do in words.", "bad_arguments")
        if not is_source(text):
            if len(text) > MOST_WORDS_CHARS:
                return error(
                    f"text has {len(text)} characters and is no Python program; at most {MOST_WORDS_CHARS} words' "
                    "characters are read.",
                    "bad_arguments",
                )
            told = await self._see_through(
                lambda session: session.say_program(text, name), report, line, rehearse_only=True
            )
            written = (told.structured_content or {}).get("program")
            return _with_name(told, written["name"]) if written else told
        if len(text) > MAX_CODE_CHARS:
            return error(f"The program is longer than {MAX_CODE_CHARS} characters.", "too_long")
        kept = _keep(authoring, name, text)
        draft = authoring.draft_of(kept)
        told = await self._see_through(
            lambda session: session.say_draft(draft), report, line, rehearse_only=True
        )
        return _with_name(told, kept.name)

    async def _see_through(
        self, say: Callable[[Session], int], report: Report, line: Line | None, *, rehearse_only: bool
    ) -> CallToolResult:
        course = await self._calls.do(say, report, line, rehearse_only=rehearse_only)
        course.is_program = True
        return course_told(course, self._robot.language, self._robot.approval_address())


def is_source(text: str) -> bool:
    """Tell whether `text` is a Python program, and no words: it imports something, or defines."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return "import rclpy" in text or "def main" in text  # a broken program is told as one
    kinds = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef)
    return any(isinstance(node, kinds) for node in tree.body)


def _keep(authoring: Authoring, name: str, source: str) -> KeptProgram:
    """Keep an agent's program, under a new name where another program has that one already.

    Raises:
        InputError: the name cannot be one.
    """
    library = authoring.library
    wanted = clean_name(name) or "agent program"
    before = library.find(wanted)
    if before is not None and before.source == source:
        return before
    if before is not None and before.provenance.model != AGENT:
        wanted = library.free_name(wanted)
        before = None
    versions = before.provenance.versions + 1 if before is not None else 1
    program = KeptProgram(wanted, source, provenance=Provenance("", "model", AGENT, today(), versions))
    library.keep(program if before is None else replace(program, runs=before.runs))
    return program


def about(program: KeptProgram) -> dict[str, Any]:
    """Return what is known of a program besides its source."""
    origin, last = program.provenance, program.runs[-1] if program.runs else None
    return {
        "name": program.name,
        "description": program.description or origin.sentence,
        "by": origin.author,
        "model": origin.model_name,
        "versions": origin.versions,
        "rehearsal": dict(program.rehearsal),
        "runs": len(program.runs),
        "last_run": vars(last) if last is not None else None,
    }


def _listed(authoring: Authoring) -> CallToolResult:
    programs = [about(program) for program in authoring.library.all()]
    names = "; ".join(
        f"{each['name']}" + (f": {each['description']}" if each["description"] else "") for each in programs
    )
    text = f"Programs: {names}" if programs else "No programs are kept yet: write makes one."
    return answer(text, {"programs": programs})


def _with_name(told: CallToolResult, name: str) -> CallToolResult:
    """Add the name under which it was kept."""
    content = [*told.content]
    first = content[0]
    if first.type == "text":
        content[0] = first.model_copy(update={"text": f"Kept as “{name}”. {first.text}"})
    return told.model_copy(
        update={
            "content": content,
            "structured_content": {"program": name, **(told.structured_content or {})},
        }
    )
