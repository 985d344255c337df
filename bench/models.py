"""What a language model costs in time and tokens, against a scripted one over HTTP. Run: python -m bench.models

Velocities are stamped at a subscriber in a process that is none of ours; a line of the reply is stamped by the server
when it leaves. The machine's monotonic clock is one for all.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tests.processes import RunningRobot

from bench import line
from chatrobot.dialogue.llm.call import ModelCall
from chatrobot.dialogue.llm.prompt import request, system_prompt
from chatrobot.models.config import ModelConfig
from chatrobot.models.fake.script import read_script
from chatrobot.models.fake.server import FakeModel
from chatrobot.models.make import make_model, warm
from chatrobot.models.seam import CallLimits, Message
from chatrobot.robots.load import load_profile
from chatrobot.sim.load import load_world

STREAMS, WHOLE, CALLS, STOPS = 20, 3, 60, 60
SIX_STEPS = (
    "drive 0.30 m forward at 0.30 m/s\nturn left 45 deg at 0.60 rad/s\ndrive 0.25 m forward at 0.30 m/s\n"
    "turn right 90 deg at 0.60 rad/s\ndrive 0.30 m back at 0.30 m/s\nturn left 45 deg at 0.60 rad/s\n"
)
COMMANDS = {"in the empty world": "empty", "in the furnished flat": "home"}


@contextmanager
def serving(*replies: dict[str, Any]) -> Iterator[FakeModel]:
    with FakeModel(read_script({"models": ["fake"], "replies": list(replies)})) as fake:
        yield fake


@contextmanager
def robot_with(fake: FakeModel, folder: Path, *more: str) -> Iterator[RunningRobot]:
    os.environ.update(OPENAI_BASE_URL=f"{fake.url}/v1", OPENAI_API_KEY="sk-bench")
    arguments = ("--json", "--world", "empty", "--model", "openai:fake", *more)
    robot = RunningRobot(folder, arguments)
    try:
        yield robot
    finally:
        robot.close()


def ask_once(robot: RunningRobot) -> None:
    """The first call loads the library: that is not what is measured here."""
    robot.say("please do something odd")
    robot.wait_for_event("result")


def first_wheel_commands(folder: Path) -> list[float]:
    """From the first whole line of a plan leaving the server to the first velocity."""
    plan = {"match": "nice", "text": "turn left 20 deg\nturn right 20 deg\n", "tokens_per_s": 100}
    took = []
    with serving(plan, {"match": ".", "text": 'say "no"'}) as fake, robot_with(fake, folder) as robot:
        ask_once(robot)
        for _ in range(STREAMS):
            said_s = robot.say("please do something nice")
            moved_s = robot.velocities.wait_for_motion(said_s)
            robot.wait_for_event("result")
            took.append(moved_s - line_left_s(fake, "turn left 20 deg\n"))
            time.sleep(0.2)
            robot.velocities.all.clear()
    return took


def line_left_s(fake: FakeModel, line: str) -> float:
    """When the last token of that first line left the server."""
    answer = fake.script.answers[0]
    sent = ""
    for token, at_s in zip(answer.tokens("nice"), fake.calls[-1].sent_s):
        sent += token
        if len(sent) >= len(line):
            return at_s
    raise AssertionError("the line never left")


def time_to_motion(folder: Path, *more: str) -> list[float]:
    """From the question to the first velocity of six steps at 50 tokens a second."""
    plan = {"match": "nice", "text": SIX_STEPS, "tokens_per_s": 50}
    took = []
    with serving(plan, {"match": ".", "text": 'say "no"'}) as fake, robot_with(fake, folder, *more) as robot:
        ask_once(robot)
        for _ in range(WHOLE):
            said_s = robot.say("please do something nice")
            if more:
                robot.wait_for_event("rehearsed")
                robot.say('{"approve": true}')
            took.append(robot.velocities.wait_for_motion(said_s) - said_s)
            robot.wait_for_event("result")
            time.sleep(0.2)
            robot.velocities.all.clear()
    return took


def overheads() -> tuple[list[float], list[float]]:
    """One call through the seam and its thread, and the part of it that the session adds: server at no delay."""
    whole, ours = [], []
    with serving({"match": ".", "text": "drive 1 m\n"}) as fake:
        config = ModelConfig(
            environ={"OPENAI_BASE_URL": f"{fake.url}/v1", "OPENAI_API_KEY": "sk-bench"}, keyring=False
        )
        model = make_model("openai:fake", config)
        warm(model, wait_s=60.0)
        messages = [Message("system", "x" * 1500), Message("user", "go on")]
        for count in range(CALLS):
            began_s = time.perf_counter()
            reply = model.ask(messages, CallLimits())
            "".join(reply)
            direct_s = time.perf_counter() - began_s
            began_s = time.perf_counter()
            call = ModelCall(model, messages, CallLimits(), lambda: None)
            while not call.has_ended:
                call.wait(1.0)
                call.take()
            through_s = time.perf_counter() - began_s
            if count >= 10:
                whole.append(through_s)
                ours.append(through_s - direct_s)
    return whole, ours


def stops(folder: Path, answer: dict[str, Any], wait: Callable[[RunningRobot, float], object]) -> list[float]:
    """From a typed stop to a zero at the subscriber, while a model streams or hangs and the robot moves."""
    took = []
    replies = ({"match": "nice", **answer}, {"match": ".", "text": 'say "no"'})
    with serving(*replies) as fake, robot_with(fake, folder) as robot:
        ask_once(robot)
        for _ in range(STOPS):
            said_s = robot.say("please do something nice")
            wait(robot, said_s)
            said_s = robot.say("stop")
            took.append(robot.velocities.wait_for_zero(said_s) - said_s)
            for _ in range(2):
                robot.wait_for_event("result")
            time.sleep(0.25)
            robot.velocities.all.clear()
    return took


def tokens() -> None:
    counted, how = counter()
    profile = load_profile("wheeltec_mini_mec")
    for name, world in COMMANDS.items():
        places = load_world(world).places
        first = load_world(world).places.get("nowhere")
        assert first is None
        from chatrobot.core.geometry import ORIGIN

        prompt = system_prompt(profile, places), request("forward 1 m", ORIGIN, {})
        print(f"prompt tokens of one command {name:33s} {counted(''.join(prompt)):8.0f}     ({how})")


def counter() -> tuple[Callable[[str], float], str]:
    """A real tokenizer where its tables are at hand, else four characters a token. Nothing is downloaded."""
    try:
        import tiktoken

        folder = os.environ.get("TIKTOKEN_CACHE_DIR", "")
        if folder and any(Path(folder).iterdir()):
            encoding = tiktoken.get_encoding("o200k_base")
            return lambda text: float(len(encoding.encode(text))), "o200k_base"
    except (ImportError, OSError):
        pass
    return lambda text: len(text) / 4.0, "characters / 4; tiktoken's tables would have to be downloaded"


def main() -> None:
    tokens()
    print(f"{'':62s} {'median':>11s} {'p99':>11s}")
    whole, ours = overheads()
    line("one call of the scripted model, through library and thread", whole)
    line("of it: what our thread and queue add to the library", ours)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        line("first plan line leaves the server -> first velocity", first_wheel_commands(folder / "a"))
        streamed = time_to_motion(folder / "b")
        whole_reply = time_to_motion(folder / "c", "--approve")
        ratio = statistics.median(whole_reply) / statistics.median(streamed)
        line("six steps at 50 tokens/s: question -> motion, streamed", streamed)
        line("the same, waiting for the whole reply", whole_reply, note=f"{ratio:.1f} x later")
        slow = {"text": "drive 0.1 m\ndrive 0.1 m back\n" * 20, "tokens_per_s": 30}
        line(
            "typed stop while a model streams -> zero",
            stops(folder / "d", slow, lambda robot, said_s: robot.velocities.wait_for_motion(said_s)),
        )
        hung = {"text": "turn left 45 deg\nturn", "hang_after": 6}
        line(
            "typed stop while a model hangs -> zero",
            stops(folder / "e", hung, lambda robot, said_s: robot.velocities.wait_for_motion(said_s)),
        )


if __name__ == "__main__":
    main()
