"""`chatrobot mcp`: an MCP server, through which a language agent drives a robot. Over stdio, or over HTTP."""

from __future__ import annotations

import argparse
import asyncio
import importlib.util
import sys
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from chatrobot.cli.entry import STOPPED
from chatrobot.core.errors import UsageError
from chatrobot.core.process import wake_promptly

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

    from chatrobot.cli.recorder import Connect
    from chatrobot.compose import Connection, OnEvent, Setup
    from chatrobot.core.events import Event
    from chatrobot.mcp_server.robot import AgentRobot

_PARTED = "asked to end"
MEET_AFTER_S = 0.1
SWITCH_S = 0.0005
"""A call that is cancelled takes its turn of the interpreter from the thread that hears the robot."""


def run(args: argparse.Namespace) -> int:
    """Return 0 where the client has left, 5 where a signal ended the server. The robot stops before either.

    Raises:
        UsageError: an option cannot be used.
    """
    if args.host_line is not None:
        from chatrobot.cli.attach import pass_on

        return pass_on(args.host_line)
    _check(args)
    return _run_own(args)


def _run_own(args: argparse.Namespace) -> int:
    """Serve a robot of our own."""
    from chatrobot.cli.choices import setup_from
    from chatrobot.cli.recorder import recorded
    from chatrobot.cli.signals import SignalWatch
    from chatrobot.mcp_server.robot import SOURCE, AgentRobot

    meet = recorded(args, tokens=lambda: (args.token or "",))
    setup = replace(setup_from(args, named_model=True, programs=True), source=SOURCE)
    if setup.model is None:  # the client's own model does what the offline language cannot: hint at no other
        setup = replace(setup, options=replace(setup.options, interpreter="offline"))
    robot = AgentRobot(_connector(setup, meet))
    with SignalWatch(robot.stop) as watch:
        try:
            asyncio.run(_serve(args, setup, robot, lambda: watch.is_leaving))
        finally:
            robot.close(_PARTED)
    return STOPPED if watch.is_leaving else 0


def _check(args: argparse.Namespace) -> None:
    if importlib.util.find_spec("mcp") is None:
        raise UsageError("the MCP server is not installed", allowed="pip install 'chatrobot[mcp]'")
    for given, flag in ((args.fast, "--fast"), (args.trace, "--trace"), (args.json, "--json")):
        if given:
            raise UsageError(
                "an MCP server runs in real time and speaks MCP", where=flag, allowed="leave it out"
            )
    if not args.http:
        for given, flag in ((args.host, "--host"), (args.port, "--port"), (args.token, "--token")):
            if given is not None:
                raise UsageError("only HTTP has an address and a token", where=flag, allowed="--http besides")


def _connector(setup: Setup, meet: Connect) -> Callable[[OnEvent], Connection]:
    """Return what meets the robot; the processes that were started ahead are used once."""
    ahead = [setup]

    def connect(on_event: OnEvent) -> Connection:
        chosen = ahead.pop() if ahead else replace(setup, processes=None)
        return meet(chosen, lambda event: _hear(on_event, event))

    return connect


def _hear(on_event: OnEvent, event: Event) -> None:
    """Have the agent told, and who reads what this server writes of a recording: standard output is the protocol's."""
    from chatrobot.core.events import Notice
    from chatrobot.language.phrases import render_reason

    if isinstance(event, Notice) and event.reason.code.startswith("recording"):
        print(render_reason(event.reason, "en"), file=sys.stderr, flush=True)
    on_event(event)


async def _serve(
    args: argparse.Namespace, setup: Setup, robot: AgentRobot, is_leaving: Callable[[], bool]
) -> None:
    _hint_at_terminal(args)
    sys.setswitchinterval(SWITCH_S)
    wake_promptly()
    from chatrobot.link.processes import SIMULATED
    from chatrobot.mcp_server.server import build_server

    server = build_server(robot, setup.profile, is_simulated=setup.on in SIMULATED)
    # A moment later: the client's first request comes at once, and loading the words takes the interpreter.
    asyncio.get_running_loop().call_later(MEET_AFTER_S, robot.start)
    if args.http:
        await _serve_http(args, server, is_leaving)
    else:
        await _serve_stdio(server, robot, is_leaving)


async def _serve_http(
    args: argparse.Namespace, server: MCPServer[Any], is_leaving: Callable[[], bool]
) -> None:
    from chatrobot.mcp_server.http import LEAST_TOKEN_CHARS, PATH, guarded_app, listen, new_token, serve_http

    if args.token is not None and len(args.token) < LEAST_TOKEN_CHARS:
        problem = f"the token is shorter than {LEAST_TOKEN_CHARS} characters"
        raise UsageError(
            problem, where="--token", allowed="a longer one, or leave it out: one is made and printed"
        )
    host, made = args.host or "127.0.0.1", new_token() if args.token is None else ""
    token = args.token = args.token or made  # a recording, which asks for it, must not have it
    with listen(host, args.port) as listener:
        port = listener.getsockname()[1]
        shown = f"[{host}]" if ":" in host else host
        told = f"  token: {made}" if made else ""
        print(f"MCP server: http://{shown}:{port}{PATH}{told}", flush=True)
        await serve_http(guarded_app(server, token, host, port), listener, is_leaving)


async def _serve_stdio(server: MCPServer[Any], robot: AgentRobot, is_leaving: Callable[[], bool]) -> None:
    from chatrobot.mcp_server.streams import ANSWER_S, LineStream, private_stdio, serve_lines

    with private_stdio() as (read_fd, write_fd):
        lines = LineStream(read_fd, write_fd, lambda: robot.stop("the agent's client is gone"))
        serving = asyncio.create_task(serve_lines(server, lines))
        while not (serving.done() or is_leaving()):
            await asyncio.wait([serving], timeout=0.1)
        if not serving.done():
            robot.refuse(_PARTED)
            await lines.answered(ANSWER_S)
        serving.cancel()
        await asyncio.gather(serving, return_exceptions=True)


def _hint_at_terminal(args: argparse.Namespace) -> None:
    """Tell a person who types this at a terminal what it is for."""
    if sys.stdin.isatty() and not args.http:
        text = "chatrobot mcp waits for an MCP client on standard input (docs/agents.md); Ctrl-C ends it"
        print(text, file=sys.stderr)
