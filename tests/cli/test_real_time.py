"""The command line in real time: stops, signals, pipes that break. Nothing sleeps: every wait is for an event."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import psutil
import pytest

from tests.cli.running import PATIENCE_S, Command, Running, environment

pytestmark = pytest.mark.realtime

EMPTY = ("--world", "empty")


def driving(event: dict[str, Any]) -> bool:
    return float(event["twist"]["vx_mps"]) > 0.1


def moving(robot: Running) -> None:
    robot.event("progress", driving)


def test_a_pipe_is_done_to_its_end_in_real_time(chatrobot: Command) -> None:
    done = chatrobot.apart("--json", *EMPTY, stdin="forward 30 cm\nturn left 30 degrees\n")
    assert [event["outcome"] for event in done.named("result")] == ["completed", "completed"]
    assert done.code == 0


def test_a_typed_stop_ends_what_moves_and_what_waits(chatrobot: Command) -> None:
    with chatrobot.start("--json", *EMPTY) as robot:
        robot.say("forward 10 m")
        moving(robot)
        robot.say("back 10 m")
        robot.say("stop")
        outcomes = {}
        while len(outcomes) < 3:
            result = robot.event("result")
            outcomes[result["turn"]] = result["outcome"]
        assert outcomes == {1: "stopped", 2: "stopped", 3: "stopped"}
        robot.say("where are you?")
        assert robot.event("result")["outcome"] == "answered"
        robot.say("forward 10 m")
        moving(robot)
        robot.say("quit")
        robot.say("back 1 m")
        while len(outcomes) < 6:
            result = robot.event("result")
            outcomes[result["turn"]] = result["outcome"]
        assert [outcomes[turn] for turn in (5, 6, 7)] == ["stopped", "stopped", "refused"]
        assert robot.end() == 4


def test_ten_texts_may_wait_and_the_next_is_refused(chatrobot: Command) -> None:
    with chatrobot.start("--json", *EMPTY) as robot:
        robot.say("forward 10 m")
        moving(robot)
        for _ in range(10):
            robot.say("back 10 m")
        robot.say("turn left")
        robot.say("stop")
        outcomes = {}
        while len(outcomes) < 13:
            result = robot.event("result")
            outcomes[result["turn"]] = result["outcome"]
        assert [outcomes[turn] for turn in range(1, 14)] == ["stopped"] * 11 + ["refused", "stopped"]


def test_chatrobot_stop_stops_what_runs_elsewhere(chatrobot: Command) -> None:
    with chatrobot.start("do", "forward 10 m", "--json", *EMPTY) as robot:
        moving(robot)
        done = chatrobot.apart("stop")
        assert done.code == 0
        assert "Stopped. It was moving" in done.out
        assert robot.event("result")["outcome"] == "stopped"
        assert robot.end() == 5


def test_chatrobot_stop_ends_a_dialogue_whatever_else_may_follow(chatrobot: Command) -> None:
    with chatrobot.start("do", "forward 2 m", "back 1 m", "--keep-going", "--json", *EMPTY) as robot:
        moving(robot)
        chatrobot.apart("stop")
        assert robot.event("result")["outcome"] == "stopped"
        reason = robot.event("notice")["reason"]
        assert (reason["code"], reason["texts"]) == ("turns_stopped", "“back 1 m”")
        assert robot.end() == 5


def test_chatrobot_stop_says_of_a_robot_that_stood_that_it_stood(chatrobot: Command) -> None:
    with chatrobot.start("--json", *EMPTY) as robot:
        robot.say("where are you?")
        robot.event("result")
        done = chatrobot.apart("stop")
        assert (done.code, done.out.partition(": ")[2]) == (
            0,
            "It was already standing. Zero velocities were sent all the same.\n",
        )
        robot.say("wait 60 s")
        robot.event("started")
        done = chatrobot.apart("stop")
        assert "It was standing. Queued instructions are dropped" in done.out
        assert robot.event("result")["outcome"] == "stopped"


def test_chatrobot_stop_that_finds_nothing_says_where_it_looked(chatrobot: Command, tmp_path: Path) -> None:
    done = chatrobot.apart("stop")
    assert (done.code, done.out) == (1, "")
    assert f"no running robot is found in {tmp_path / 'chatrobot'}, /run/user/" in done.err
    assert chatrobot("STOP") == done


def test_chatrobot_stop_clears_away_what_a_killed_robot_left(chatrobot: Command, tmp_path: Path) -> None:
    folder = tmp_path / "chatrobot"
    folder.mkdir(mode=0o700)
    left = folder / "motion-999999.stop"
    code = f"import socket; socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET).bind({str(left)!r})"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert left.exists()
    assert "nothing was stopped" in chatrobot.apart("stop").err
    assert not left.exists()


@pytest.mark.parametrize(
    ("number", "arguments"),
    [
        (signal.SIGINT, ["do", "forward 10 m", "back 1 m"]),
        (signal.SIGHUP, ["do", "forward 10 m", "back 1 m"]),
        (signal.SIGTERM, []),
    ],
    ids=["Ctrl-C in do", "hang-up in do", "termination of a pipe"],
)
def test_a_signal_stops_the_robot_then_reports_it(
    chatrobot: Command, number: signal.Signals, arguments: list[str]
) -> None:
    with chatrobot.start(*arguments, "--json", *EMPTY) as robot:
        if not arguments:
            robot.say("forward 10 m")
        moving(robot)
        robot.process.send_signal(number)
        result = robot.event("result")
        assert result["outcome"] == "stopped"
        assert result["path_m"] < 5.0
        assert robot.end() == 5
        assert [event["turn"] for event in robot.seen if event["event"] == "result"] == [1]


def test_ctrl_z_stops_the_robot_and_then_really_suspends(chatrobot: Command) -> None:
    with chatrobot.start("do", "forward 10 m", "--json", *EMPTY) as robot:
        moving(robot)
        robot.process.send_signal(signal.SIGTSTP)
        process = psutil.Process(robot.process.pid)
        deadline_s = time.monotonic() + PATIENCE_S
        while process.status() != psutil.STATUS_STOPPED:
            assert time.monotonic() < deadline_s
            time.sleep(0.005)
        robot.process.send_signal(signal.SIGCONT)
        assert robot.event("result")["outcome"] == "stopped"
        assert robot.end() == 5


def test_ctrl_c_while_nothing_moves_leaves(chatrobot: Command) -> None:
    with chatrobot.start("--json", *EMPTY) as robot:
        robot.say("where are you?")
        robot.event("result")
        robot.process.send_signal(signal.SIGINT)
        assert robot.end() == 5


@pytest.mark.parametrize("flags", [["--json"], []], ids=["json", "text"])
def test_a_broken_pipe_stops_the_robot_and_is_no_drama(tmp_path: Path, flags: list[str]) -> None:
    command = [sys.executable, "-m", "chatrobot", "do", "forward 10 m", *flags, *EMPTY]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment(tmp_path), text=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert "drive" in process.stdout.readline()
        began_s = time.monotonic()
        process.stdout.close()
        assert process.wait(PATIENCE_S) == 5
        assert time.monotonic() - began_s < 10.0  # the drive would take half a minute
        assert process.stderr.read() == ""
