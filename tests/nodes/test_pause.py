"""Pause and continue through the three nodes over DDS."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from chatrobot.wire.messages import Flag, Text
from tests.nodes.node_rig import NodeRig, running

pytestmark = pytest.mark.realtime

PROMISE_S = 0.25


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeRig]:
    with running(tmp_path_factory.mktemp("nodes")) as made:
        yield made


def paused(rig: NodeRig) -> tuple[float, dict[str, object]]:
    """A metre is to be driven, and “pause” is typed at speed: when, and what is told of it once the robot stands."""
    rig.rest()
    rig.drive("forward 1 m at 0.3 m/s")
    typed_s = rig.nodes["input"].say("pause")
    took_s = rig.velocities.seconds_to_zero(typed_s)
    print(f"typed pause: {took_s * 1e3:.0f} ms")
    assert took_s <= PROMISE_S
    return typed_s, rig.event("paused", typed_s)


def moved_since(rig: NodeRig, since_s: float) -> bool:
    return any(any(twist) for _, twist in rig.velocities.since(since_s))


def test_a_typed_pause_keeps_the_plan_and_continue_drives_the_rest(rig: NodeRig) -> None:
    typed_s, left = paused(rig)
    assert str(left["plan_text"]).startswith("drive 0.")
    told_s, _ = rig.replies.wait_for(lambda text: text.data.startswith("Paused"), typed_s)
    time.sleep(1.0)
    assert not moved_since(rig, told_s)
    said_s = rig.nodes["input"].say("continue")
    _, result = rig.events.wait_for(
        lambda event: event["event"] == "result" and event["turn"] == left["turn"], said_s
    )
    assert result["outcome"] == "completed"
    assert result["path_m"] == pytest.approx(1.0, abs=0.05)
    assert result["paused_s"] >= 1.0
    rehearsed = rig.event("rehearsed", said_s)
    assert rehearsed["length_m"] < 0.95, "the rest is rehearsed anew"


def test_it_is_paused_and_gone_on_with_over_user_input_too(rig: NodeRig) -> None:
    rig.rest()
    rig.drive("forward 1 m at 0.3 m/s")
    said_s = rig.publish("user_input", Text("暂停"))
    left = rig.event("paused", said_s)
    said_s = rig.publish("user_input", Text("继续"))
    _, result = rig.events.wait_for(
        lambda event: event["event"] == "result" and event["turn"] == left["turn"], said_s
    )
    assert result["outcome"] == "completed"
    assert result["path_m"] == pytest.approx(1.0, abs=0.05)


def test_a_stop_on_its_topic_drops_what_is_paused(rig: NodeRig) -> None:
    _, left = paused(rig)
    stopped_s = rig.publish("chatrobot/stop", Flag(True))
    _, result = rig.events.wait_for(
        lambda event: event["event"] == "result" and event["turn"] == left["turn"], stopped_s
    )
    assert result["outcome"] == "stopped"
    time.sleep(0.5)
    assert not moved_since(rig, stopped_s)


def test_what_is_paused_is_dropped_where_who_gave_it_falls_silent(rig: NodeRig) -> None:
    _, left = paused(rig)
    struck_s = rig.nodes["input"].strike("SIGKILL")
    _, finished = rig.events.wait_for(
        lambda event: event["event"] == "result" and event["turn"] == left["turn"], struck_s
    )
    assert finished["outcome"] == "stopped"
    rig.replace("input")
    said_s = rig.nodes["input"].say("continue")
    rig.result(said_s)
    time.sleep(0.5)
    assert not moved_since(rig, said_s)


def test_slower_is_heard_while_the_robot_drives_though_orders_wait(rig: NodeRig) -> None:
    rig.rest()
    rig.drive("forward 1 m at 0.3 m/s")
    said_s = rig.nodes["input"].say("slower")
    assert rig.event("result", said_s)["outcome"] == "answered"
    _, result = rig.events.wait_for(
        lambda event: event["event"] == "result" and event["outcome"] == "completed", said_s
    )
    assert result["path_m"] == pytest.approx(1.0, abs=0.05)
    assert result["duration_s"] > 5.0
