"""Envelopes of one source come from several threads: what may overtake what."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.link.link_rigs import SimulatedRig, finished

from chatrobot.link.envelope import PROTOCOL, Envelope
from chatrobot.link.in_process import InProcessLink


@pytest.mark.parametrize(("overtaking", "outcome"), [("beat", "completed"), ("stop", "stopped")])
def test_a_heartbeat_may_overtake_a_plan_and_a_stop_that_does_ends_it(
    tmp_path: Path, overtaking: str, outcome: str
) -> None:
    rig = SimulatedRig(tmp_path)
    link = rig.link
    assert isinstance(link, InProcessLink)
    plan = link.sender.envelope("plan", 1, plan_text="drive 0.1 m")
    link.send(overtaking)  # type: ignore[arg-type]
    link._motion.receive(plan)
    assert finished(rig, 1).outcome == outcome
    assert any(any(velocity) for velocity in rig.velocities) == (outcome == "completed")


def test_a_first_word_that_names_its_term_opens_the_lease_and_is_done(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    link = rig.link
    assert isinstance(link, InProcessLink)
    payload = {"plan_text": "drive 0.05 m", "term_s": 1.0, "protocol": PROTOCOL}
    link._motion.receive(Envelope("plan", "base", "spoke before we listened", 1, 7, payload))
    assert finished(rig, 7).outcome == "completed"
