"""Over rosbridge, in real time, where nothing stands around: infinity is free, null is unknown."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

pytest.importorskip("websockets", reason="pip install 'chatrobot[rosbridge]'")

from tests.motion.test_wifi_loss import Rig
from tests.wire.fake_rosbridge import FakeRosbridge

from chatrobot.core.events import Finished, Notice, Rehearsed

pytestmark = pytest.mark.realtime

PLAN = "drive 0.6 m"


class NearRig(Rig):
    """On this machine, so that nothing but its lidar slows the robot down."""

    host = "127.0.0.1"


@pytest.fixture
def rig_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[FakeRosbridge], NearRig]]:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    made: list[NearRig] = []

    def rig_of_one(bridge: FakeRosbridge) -> NearRig:
        made.append(NearRig(bridge, ("odom", "imu", "scan")))
        return made[0]

    yield rig_of_one
    made[0].close()


def drive(rig: NearRig) -> tuple[Rehearsed, Finished]:
    rig.link.send("plan", 1, plan_text=PLAN, mode="queue")
    rehearsed = rig.wait_for(lambda event: isinstance(event, Rehearsed))
    assert isinstance(rehearsed, Rehearsed)
    return rehearsed, rig.end_of(1)


def unknowns(rig: NearRig) -> list[Notice]:
    notices = [event for event in rig.events if isinstance(event, Notice)]
    return [notice for notice in notices if notice.reason.code == "open_space_unknown"]


def test_with_cbor_an_open_space_is_crossed_at_normal_speed(rig_of: Callable[..., NearRig]) -> None:
    rig = rig_of(FakeRosbridge())
    rehearsed, end = drive(rig)
    assert (end.outcome, end.reason, rehearsed.duration_s) == ("completed", None, pytest.approx(2.3, abs=0.1))
    assert end.duration_s == pytest.approx(rehearsed.duration_s, abs=0.5)
    assert not unknowns(rig)


def test_over_json_alone_it_is_slow_as_rehearsed_and_says_so_once(rig_of: Callable[..., NearRig]) -> None:
    rig = rig_of(FakeRosbridge(offers_cbor=False))
    rig.notice("open_space_unknown")
    rehearsed, end = drive(rig)
    assert (end.outcome, end.reason, rehearsed.duration_s) == ("completed", None, pytest.approx(6.1, abs=0.1))
    assert end.duration_s == pytest.approx(rehearsed.duration_s, abs=0.5)
    assert [notice.reason.values["speed_mps"] for notice in unknowns(rig)] == [0.1]
