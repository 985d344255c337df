"""`control`: from `chatgpt_node` to `cmd_vel`. It is Motion's process; only what carries the link is a topic.

Knows no language: its events carry codes with numbers, and whoever starts it may have them written into a log.
"""

from __future__ import annotations

import contextlib
import json
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from chatrobot.core.errors import WireError
from chatrobot.core.events import Event, Finished, Scan, Telemetry
from chatrobot.core.reason import Reason
from chatrobot.governor.lease import RELEASERS
from chatrobot.link.envelope import Envelope, Word
from chatrobot.link.topic_link import CHATGPT_NODE, EVENTS, TELEMETRY
from chatrobot.motion.runner import MotionRunner
from chatrobot.motion.safety.stop import Sight
from chatrobot.nodes.foreign import Foreign
from chatrobot.wire.messages import Text

if TYPE_CHECKING:
    from chatrobot.nodes.ros_interfaces import Diagnosis, RosInterfaces

NODE = "chatrobot_control"
BASE = "base"
"""The source that `base` speaks as: what a person typed on `user_input`."""
SERVICE = "service"
RELEASE_S = 0.5
LEAVE_S = 5.0
ODOMETRY_LATE_S = 1.0
STOP_SENT: dict[Sight, str] = {
    "moving": "stop sent: odometry shows the robot still moving",
    "standing": "stop sent: odometry shows the robot standing",
    "unseen": "stop sent: no odometry shows whether the robot stands",
}
"""What the services answer, by what odometry shows at that moment."""


class ControlNode:
    """Motion behind topics. Any number of sources may come and go; it ends when it is told to.

    Args:
        note: hears every event that is published on `chatrobot/events`, after the tick; it must not block.
        release: an emergency stop may be released over ROS.
        options: those of `MotionRunner`.

    Raises:
        WireError: there is no robot, or the guard does not start.
        InputError: the profile or the world cannot be used.
    """

    def __init__(
        self,
        address: str,
        profile: str,
        world: str = "empty",
        *,
        note: Callable[[Event], None] = lambda _event: None,
        release: bool = False,
        **options: Any,
    ) -> None:
        self._may_release = release
        self._note = note
        self._ours: set[int] = set()
        self._untold: deque[Event] = deque()
        self._is_leaving = False
        releasers = RELEASERS | {BASE} if release else RELEASERS
        self._runner = MotionRunner(
            address, profile, world, self._tell, node=NODE, releasers=releasers, **options
        )
        self._profile = profile
        self._foreign = Foreign(self._runner, lambda: bool(self._ours))
        for topic in (EVENTS, TELEMETRY):
            self._runner.wire.advertise(topic, Text)
        self._runner.wire.subscribe(CHATGPT_NODE, Text, self._hear)

    def run(self, is_leaving: Callable[[], bool]) -> None:
        """Run until `is_leaving`, and then until the robot stands or is gone; where time stands still not for ever."""
        leaving_since_s: float | None = None

        def has_left() -> bool:
            nonlocal leaving_since_s
            if not is_leaving():
                return False
            self._is_leaving = True  # it takes no more plans
            now_s = time.monotonic()
            leaving_since_s = now_s if leaving_since_s is None else leaving_since_s
            if not self._runner.motion.is_busy or self._runner.robot_has_left:
                return True
            return now_s - leaving_since_s > LEAVE_S

        self._runner.run(has_left, self._each_tick)

    def resolved(self, topic: str) -> str:
        """Return the name of that topic on the wire."""
        return self._runner.wire.resolve(topic)

    @property
    def cmd_vel_topic(self) -> str:
        """Where velocities go, by its name on the wire."""
        return self.resolved(self._runner.profile.wiring.cmd_vel_topic)

    def stop(self, why: str) -> None:
        """Stop the robot now, from any thread."""
        with contextlib.suppress(WireError):
            self._runner.halt("control", why)

    def introduce(self, ros_interfaces: RosInterfaces) -> None:
        """Offer to ROS what a node of it offers."""
        ros_interfaces.serve("~/stop", self._serve_stop)
        ros_interfaces.serve("~/emergency_stop", self._serve_emergency_stop)
        if self._may_release:
            ros_interfaces.serve("~/release", self._serve_release)
        ros_interfaces.diagnose(self._profile, self._diagnose)

    # --- the wire's thread ---

    def _serve_stop(self) -> tuple[bool, str]:
        self._runner.halt(SERVICE, "~/stop")
        return True, STOP_SENT[self._runner.motion.stop_confirmation.sight]

    def _serve_emergency_stop(self) -> tuple[bool, str]:
        self._runner.receive(self._service_envelope("emergency_stop", SERVICE))
        sent = STOP_SENT[self._runner.motion.stop_confirmation.sight]
        return True, f"{sent}; nothing moves until the emergency stop is released"

    def _serve_release(self) -> tuple[bool, str]:
        # Who started this node with allow_release has given the right of the local console to this service.
        self._runner.receive(self._service_envelope("release", "console"))
        ends_s = time.monotonic() + RELEASE_S
        while self._runner.motion.latched is not None:
            if time.monotonic() > ends_s:
                return False, "not released"
            time.sleep(0.005)
        return True, "released"

    def _service_envelope(self, word: Word, source: str) -> Envelope:
        return Envelope(word, source, SERVICE, time.monotonic_ns())

    def _diagnose(self) -> Diagnosis:
        from chatrobot.nodes.ros_interfaces import Diagnosis

        motion = self._runner.motion
        barred = motion.latched or motion.interlock.obstruction
        values: dict[str, object] = {
            "moving": motion.is_busy,
            **{f"{name}_age_s": round(age_s, 2) for name, age_s in motion.sensors.ages_s().items()},
        }
        if barred is not None:
            return Diagnosis("error" if motion.latched else "warn", barred.code, {**values, **barred.values})
        if motion.sensors.has_odometry and motion.sensors.odometry_age_s() > ODOMETRY_LATE_S:
            return Diagnosis("warn", "no_odometry", values)
        if self._runner.profile.open_loop:
            return Diagnosis("warn", "open_loop", values)
        return Diagnosis("ok", "driving" if motion.is_busy else "ready", values)

    def _hear(self, message: Text) -> None:
        envelope = Envelope.from_bytes(message.data.encode(errors="replace"))
        if envelope is None:
            self._foreign.hear(message.data)
        elif envelope.word in ("plan", "program"):
            self._hear_plan(envelope)
        elif envelope.word == "release" and not self._may_release:
            self._runner.notice(Reason("release_refused", {"source": envelope.source}))
        elif envelope.word == "limit":  # here nobody is at a local console, whatever the source is called
            self._runner.notice(Reason("limit_refused_here", {"source": envelope.source}))
        else:
            self._runner.receive(envelope)

    def _hear_plan(self, envelope: Envelope) -> None:
        if self._is_leaving:
            return
        self._ours.add(envelope.turn)
        is_part = envelope.payload.get("mode") == "extend"
        if self._foreign.has_work and not is_part:  # the lowest priority: it gives way
            envelope = replace(envelope, payload={**envelope.payload, "mode": "replace"})
        self._runner.receive(envelope)

    # --- the control thread ---

    def _tell(self, event: Event) -> None:
        if isinstance(event, Finished):
            if event.turn == 0:
                self._foreign.note_finished()
            self._ours.discard(event.turn)
        self._untold.append(event)

    def _each_tick(self) -> None:
        """After the tick: telling takes longer than a velocity may wait."""
        self._foreign.beat()
        while self._untold:
            self._publish(self._untold.popleft())

    def _publish(self, event: Event) -> None:
        topic = TELEMETRY if isinstance(event, (Telemetry, Scan)) else EVENTS
        text = Text(json.dumps(event.to_json(), separators=(",", ":"), ensure_ascii=False))
        with contextlib.suppress(
            WireError
        ):  # a robot that cannot be told is Motion's affair, not the teller's
            self._runner.wire.publish(topic, text)
        if topic == EVENTS:
            self._note(event)
