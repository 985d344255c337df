"""A program that writes to its host's pipe by itself gains nothing but what it may ask for anyway."""

from __future__ import annotations

import pytest

from chatrobot.motion.programs.rehearsal import ProgramRehearsal, rehearse_program
from chatrobot.programs.events import Died, Ended
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer

MEC = load_profile("wheeltec_mini_mec")
WRITES = """
import json, os, struct, time
def say(*words):
    body = json.dumps(words).encode()
    os.write(3, struct.pack("!I", len(body)) + body)
"""


def rehearse(server: WarmServer, body: str) -> ProgramRehearsal:
    return rehearse_program(server, WRITES + body, MEC, wall_limit_s=2.0)


def test_a_faked_velocity_is_governed_like_any_other(server: WarmServer) -> None:
    rehearsal = rehearse(
        server, "say('twist', 0, 99.0, 0.0, 0.0, True); say('twist', 3 * 10**9, 0.0, 0.0, 0.0, True)"
    )
    assert rehearsal.top_speed_mps <= MEC.limits.max_speed_mps + 1e-6
    assert "limited" in [finding.reason.code for finding in rehearsal.findings]


def test_a_faked_end_is_an_end_and_the_robot_stands(server: WarmServer) -> None:
    rehearsal = rehearse(
        server, "say('twist', 0, 0.3, 0.0, 0.0, True); say('ended', 10**9, 'returned', 0); time.sleep(50)"
    )
    assert isinstance(rehearsal.end, Ended)
    assert rehearsal.path[-1, 0] < 5.0
    assert [finding.reason.code for finding in rehearsal.findings] == ["program_never_stops"]


@pytest.mark.parametrize(
    "body",
    [
        "os.write(3, b'\\xff' * 100000)",
        "say('mint', 1)",
        "say('beat', 'soon')",
        "say('until', 0, 10**9, True); say('until', 0, 10**9, 'x')",
        "os.write(3, struct.pack('!I', 70000))",
    ],
)
def test_nonsense_ends_it(server: WarmServer, body: str) -> None:
    end = rehearse(server, body).end
    assert isinstance(end, Died)
    assert end.reason.code in ("program_broke_pipe", "program_vanished")


@pytest.mark.parametrize("body", ["os.close(3)", "os.dup2(0, 3)"])
def test_who_closes_its_pipe_is_gone(server: WarmServer, body: str) -> None:
    assert isinstance(rehearse(server, body).end, Died)


def test_time_may_be_claimed_only_up_to_the_horizon(server: WarmServer) -> None:
    rehearsal = rehearse(server, "say('twist', 9 * 10**14, 0.3, 0.0, 0.0, True); say('beat', 9 * 10**14)")
    assert rehearsal.path[-1, 0] <= 60.0 + 5.0


def test_time_does_not_go_back(server: WarmServer) -> None:
    rehearsal = rehearse(
        server, "say('beat', 5 * 10**9); say('twist', 0, 0.2, 0.0, 0.0, True); say('beat', 6 * 10**9)"
    )
    assert rehearsal.length_m == pytest.approx(0.2, abs=0.05)


def test_asking_for_time_without_reading_the_answers_harms_nobody(server: WarmServer) -> None:
    rehearsal = rehearse(
        server, "say('listens', 0, 'scan', 1000)\nfor t in range(10**7): say('until', 0, t * 10**7, True)"
    )
    assert not rehearsal.ok or rehearsal.path[-1, 0] <= 65.0
