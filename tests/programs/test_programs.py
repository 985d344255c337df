"""Programs as models and tutorials write them do in the sandbox what they do under ROS, at the times they do it
there."""

from __future__ import annotations

import pytest

from chatrobot.motion.programs.rehearsal import rehearse_program
from chatrobot.programs.events import Ended, Raised
from chatrobot.robots.load import load_profile
from chatrobot.sandbox.warm_server import WarmServer
from chatrobot.sim.load import load_world
from tests.programs.expectations import Expected, all_programs, is_alike, phases_of

PROGRAMS = all_programs()
WITHIN_S = 0.11
"""A loop that publishes every 0.1 s notices the end of a phase up to that much later."""
WITHIN_M = 0.05


def test_there_are_enough_of_them() -> None:
    assert len(PROGRAMS) >= 40


@pytest.mark.parametrize("expected", PROGRAMS, ids=lambda expected: expected.name)
def test_program_does_what_it_says(server: WarmServer, expected: Expected) -> None:
    rehearsal = rehearse_program(
        server,
        expected.source,
        load_profile("wheeltec_mini_mec"),
        load_world(expected.robot or "empty"),
        name=expected.name,
        horizon_s=60.0 if expected.ends == "returned" else 20.0,
    )
    end = rehearsal.end
    if expected.raises is not None:
        assert isinstance(end, Raised), end
        assert end.type_name == expected.raises[0]
        assert expected.raises[1] in end.message
    else:
        assert isinstance(end, Ended), end
        assert end.how == expected.ends
    if expected.phases is not None:
        found = phases_of(list(rehearsal.cmd_vel))
        assert is_alike(found, expected.phases, WITHIN_S), found
    if expected.lasts_s is not None:
        assert rehearsal.duration_s == pytest.approx(expected.lasts_s, abs=WITHIN_S)
    if expected.at is not None:
        for found_at, wanted in zip(rehearsal.path[-1, 1:].tolist(), expected.at):
            assert wanted is None or found_at == pytest.approx(wanted, abs=WITHIN_M)
    assert rehearsal.length_m >= expected.drives_m
    log = "\n".join(line.text for line in rehearsal.log)
    for text in expected.prints:
        assert text in log
    codes = [finding.reason.code for finding in rehearsal.findings]
    assert set(expected.finds) <= set(codes)
    assert ("would_collide" in codes) == ("would_collide" in expected.finds)
