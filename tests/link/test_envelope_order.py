"""Envelopes of one source come from several threads: what may overtake what."""

from pathlib import Path

from tests.link.link_rigs import SimulatedRig, finished

from chatrobot.link.envelope import Envelope
from chatrobot.link.in_process import InProcessLink


def test_a_plan_that_a_heartbeat_has_overtaken_is_still_done(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    link = rig.link
    assert isinstance(link, InProcessLink)
    plan = link._sender.envelope("plan", 1, plan_text="drive 0.1 m")
    link.send("beat")
    link._motion.receive(plan)
    assert finished(rig, 1).outcome == "completed"


def test_a_plan_that_a_stop_has_overtaken_ends_as_stopped(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    link = rig.link
    assert isinstance(link, InProcessLink)
    plan = link._sender.envelope("plan", 1, plan_text="drive 0.1 m")
    link.send("stop")
    link._motion.receive(plan)
    assert finished(rig, 1).outcome == "stopped"
    assert not any(any(velocity) for velocity in rig.velocities)


def test_a_first_word_that_names_its_term_opens_the_lease_and_is_done(tmp_path: Path) -> None:
    rig = SimulatedRig(tmp_path)
    link = rig.link
    assert isinstance(link, InProcessLink)
    payload = {"plan_text": "drive 0.05 m", "term_s": 1.0}
    link._motion.receive(Envelope("plan", "base", "spoke before we listened", 1, 7, payload))
    assert finished(rig, 7).outcome == "completed"
