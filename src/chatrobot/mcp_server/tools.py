"""The functions behind the tools of the MCP server (`server.py` describes them to agents)."""

from __future__ import annotations

import asyncio
import base64
import json
import time
from collections.abc import Awaitable, Callable, Iterable
from typing import Annotated, Any

from mcp.server.mcpserver import Context
from mcp.server.mcpserver.tools import Tool
from mcp_types import CallToolResult, ContentBlock, ImageContent, ToolAnnotations
from pydantic import BeforeValidator, Field, ValidationError

from chatrobot.core.errors import ChatRobotError, InputError
from chatrobot.core.events import Event, Looked
from chatrobot.dialogue.session import Session
from chatrobot.mcp_server import surroundings
from chatrobot.mcp_server.calls import Calls, Line, Report
from chatrobot.mcp_server.program_tool import ACTIONS, ProgramTool
from chatrobot.mcp_server.robot import AgentRobot
from chatrobot.mcp_server.told import UNCLEAR_PLAN, answer, course_told, error, pose_told, release_refused
from chatrobot.plan.json_form import plan_from_json
from chatrobot.plan.text import format_plan
from chatrobot.reflex import is_release

MOST_TEXT_CHARS = 4_000
MOST_PLAN_CHARS = 20_000
MOST_QUOTED_CHARS = 300
LOOK_S = 0.5
NEWS_S = 0.3
STAND_S = 2.0
"""So long `stop` waits to see the robot stand; the zero is out long before."""
LINE = "chatrobot.line"
"""Where an HTTP request keeps its `Line`."""


def _as_text(given: Any) -> str:
    """Models send a plan in its JSON form as an object, too, and a number as one; null is nothing."""
    return given if isinstance(given, str) else "" if given is None else json.dumps(given)


TextArgument = Annotated[str, BeforeValidator(_as_text)]


class Tools:
    """The functions behind the tools; each returns an answer, also where something is wrong."""

    def __init__(self, robot: AgentRobot) -> None:
        self._robot = robot
        self._calls = Calls(robot)
        self._programs = ProgramTool(robot, self._calls)
        self.leave = self._calls.leave

    async def instruct(
        self, ctx: Context[Any, Any], text: TextArgument = "", plan: TextArgument = ""
    ) -> CallToolResult:
        """Do what is said, or a plan; return once it has ended."""
        return await self._do(ctx, text, plan, rehearse_only=False)

    async def rehearse(
        self, ctx: Context[Any, Any], text: TextArgument = "", plan: TextArgument = ""
    ) -> CallToolResult:
        """Try what `instruct` would do, without moving."""
        return await self._do(ctx, text, plan, rehearse_only=True)

    async def stop(self) -> CallToolResult:
        """Stop the robot: the zero is out before anything is waited for."""
        was_s = time.monotonic()
        self._robot.stop("the agent asked")
        return await self._guarded(self._see_stand(was_s))

    async def observe(self, picture: bool = True) -> CallToolResult:
        """Tell what is known of the robot and its surroundings now."""
        return await self._guarded(self._observe(picture=picture))

    async def places(self) -> CallToolResult:
        """List the places that can be gone to."""
        return await self._guarded(self._places())

    async def programs(
        self,
        ctx: Context[Any, Any],
        action: Annotated[str, Field(json_schema_extra={"enum": [*ACTIONS]})] = "list",
        name: str = "",
        text: str = "",
    ) -> CallToolResult:
        """List, show, write, rehearse or run programs."""
        report, line = _reporter(ctx), _line_of(ctx)
        return await self._guarded(self._programs.do(action, name, text, report, line))

    # --- behind them ---

    async def _do(
        self, ctx: Context[Any, Any], text: str, plan: str, *, rehearse_only: bool
    ) -> CallToolResult:
        text, plan = text.strip(), _without_fence(plan.strip())
        problem = _problem_with(text, plan)
        if problem:
            return error(problem, "bad_arguments")
        if text and is_release(text):
            return release_refused(is_set=self._robot.is_emergency)
        if plan.startswith("{"):
            try:
                plan = format_plan(plan_from_json(plan))
            except InputError as wrong:
                told = {
                    "outcome": "unclear",
                    "reply": str(wrong),
                    "reason": {"code": "bad_plan"},
                    "hint": UNCLEAR_PLAN,
                }
                return answer(f"unclear: {wrong}\n{UNCLEAR_PLAN}", told)

        def say(session: Session) -> int:
            return session.say(text) if text else session.say_plan(plan)

        return await self._guarded(
            self._see_through(say, _reporter(ctx), _line_of(ctx), text, rehearse_only=rehearse_only)
        )

    async def _see_through(
        self,
        say: Callable[[Session], int],
        report: Report,
        line: Line | None,
        text: str,
        *,
        rehearse_only: bool,
    ) -> CallToolResult:
        course = await self._calls.do(say, report, line, text=text, rehearse_only=rehearse_only)
        course.is_plan = not text
        return course_told(course, self._robot.language, self._robot.approval_address())

    async def _see_stand(self, since_s: float) -> CallToolResult:
        record = self._robot.record
        if self._robot.session is None:
            return answer("Stopped: the robot is not connected yet, and nothing is done.", {"stopped": True})
        stands = False
        while not stands and time.monotonic() - since_s < STAND_S:
            await asyncio.sleep(0.05)
            telemetry = record.telemetry
            is_new = record.heard_at_s > since_s + 0.1
            stands = is_new and telemetry is not None and not surroundings.moves(telemetry)
        data: dict[str, Any] = {"stopped": True, "seen_standing": stands}
        if record.telemetry is not None:
            data["pose"] = pose_told(record.telemetry.pose)
        seen = "The robot is seen standing." if stands else "It has not been seen standing yet: use observe."
        return answer(f"Stop sent. {seen}", data)

    async def _observe(self, *, picture: bool) -> CallToolResult:
        connection = await self._robot.ready()
        began_s, record = time.monotonic(), self._robot.record
        sectors = surroundings.sectors_told(await self._look(connection.session))
        while record.heard_at_s < began_s and time.monotonic() - began_s < NEWS_S:
            await asyncio.sleep(
                0.01
            )  # what was heard before it asked may be of a motion that has ended since
        data: dict[str, Any] = surroundings.motion_told(record.telemetry, record.heard_at_s)
        data["robot"] = surroundings.robot_told(connection, is_shared=self._robot.is_shared)
        pose = record.telemetry.pose if record.telemetry is not None else None
        data["free_way_m"] = sectors
        data["near"] = surroundings.things_near(connection.world, pose) if pose is not None else []
        data["happened"] = record.happened()
        if self._robot.waiting_turn is not None:
            data["waiting_for_approval_at"] = self._robot.approval_address()
        if connection.session.is_paused:
            data["paused"] = True
        if self._robot.is_emergency:
            data["emergency_stop"] = "A person has to release it; nothing moves before."
        camera = connection.camera
        image = await asyncio.to_thread(surroundings.take_picture, camera) if picture and camera else None
        data["picture"] = "attached" if image else "none to be had" if camera else "no camera"
        return answer(surroundings.seen_in_words(data), data, *_pictures(image))

    async def _look(self, session: Session) -> Looked | None:
        seen: asyncio.Queue[Event | None] = asyncio.Queue()
        with self._robot.listening(seen.put_nowait):
            session.look()
            ends_s = time.monotonic() + LOOK_S
            while (left_s := ends_s - time.monotonic()) > 0.0:
                try:
                    event = await asyncio.wait_for(seen.get(), left_s)
                except asyncio.TimeoutError:
                    return None
                if isinstance(event, Looked) and event.turn == 0:
                    return event
        return None

    async def _places(self) -> CallToolResult:
        connection = await self._robot.ready()
        telemetry = self._robot.record.telemetry
        found = surroundings.places_of(connection, telemetry.pose if telemetry is not None else None)
        lost = surroundings.lost_places(connection)
        names = "; ".join(surroundings.place_in_words(place) for place in found) or "none are known"
        text = f"Places: {names}."
        if lost:
            text += f" Remembered in an earlier session, so nobody knows where it is now: {', '.join(lost)}."
        return answer(text, {"places": found, "lost": lost})

    @staticmethod
    async def _guarded(doing: Awaitable[CallToolResult]) -> CallToolResult:
        try:
            return await doing
        except ChatRobotError as wrong:
            return error(str(wrong), "bad_arguments" if isinstance(wrong, InputError) else "robot")


class _StrictTool(Tool):
    """A tool that does nothing where it is called with an argument that it does not have, or of another type."""

    async def run(
        self, arguments: dict[str, Any], context: Context[Any, Any], convert_result: bool = False
    ) -> Any:
        """Run it, or say what is wrong with the arguments. A stop is obeyed whatever comes with it."""
        known = self.parameters["properties"]
        unknown = _quoted(name for name in arguments if name not in known)
        if unknown and self.name != "stop":
            has = f"it has {_quoted(known)}" if known else "it takes none"
            return error(f"Nothing was done: {self.name} has no argument {unknown}; {has}.", "bad_arguments")
        try:
            self.fn_metadata.validate_arguments(arguments)
        except ValidationError as wrong:
            name = str(wrong.errors()[0]["loc"][0])
            kind, given = known[name]["type"], json.dumps(arguments[name])[:MOST_QUOTED_CHARS]
            return error(
                f"Nothing was done: `{name}` of {self.name} is a {kind}, not {given}.", "bad_arguments"
            )
        return await super().run(arguments, context, convert_result)


def _quoted(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)[:MOST_QUOTED_CHARS]


def strict_tool(function: Callable[..., Any], told: str, hints: ToolAnnotations) -> Tool:
    """Make the tool of a function, told to agents like that."""
    tool = _StrictTool.from_function(function, description=told, annotations=hints, structured_output=False)
    properties = {
        name: {key: value for key, value in schema.items() if key != "title"}  # it is the name again
        for name, schema in tool.parameters["properties"].items()
    }
    tool.parameters = {"type": "object", "properties": properties, "additionalProperties": False}
    return tool


def _problem_with(text: str, plan: str) -> str:
    """Say what is wrong with the arguments; "" where nothing is."""
    if bool(text) == bool(plan):
        return "Give one of the arguments `text` and `plan`, not both and not none."
    if len(text) > MOST_TEXT_CHARS:
        return (
            f"text has {len(text)} characters, at most {MOST_TEXT_CHARS} are read: say it in several calls."
        )
    if len(plan) > MOST_PLAN_CHARS:
        return (
            f"plan has {len(plan)} characters, at most {MOST_PLAN_CHARS} are read: send it in several calls."
        )
    return ""


def _without_fence(plan: str) -> str:
    """Return plan text without the Markdown fence that models like to put around it."""
    lines = plan.splitlines()
    is_fenced = len(lines) > 1 and lines[0].startswith("```") and lines[-1].strip() == "```"
    return "\n".join(lines[1:-1]) if is_fenced else plan


def _reporter(ctx: Context[Any, Any]) -> Report:
    async def report(percent: float, words: str) -> None:
        await ctx.report_progress(round(percent, 2), 100.0, words)

    return report


def _line_of(ctx: Context[Any, Any]) -> Line | None:
    """Return the line of an HTTP request; None on a carrier that ends with its client."""
    request = ctx.request_context.request
    line = request.scope.get(LINE) if request is not None else None
    return line if isinstance(line, Line) else None


def _pictures(image: bytes | None) -> list[ContentBlock]:
    if not image:
        return []
    kind = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
    return [ImageContent(type="image", data=base64.b64encode(image).decode(), mime_type=kind)]
