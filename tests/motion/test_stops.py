"""Every stop is out at once; each that came from elsewhere is booked once, whatever else ends in the same moment."""

from __future__ import annotations

from collections.abc import Callable

from chatrobot.core.clock import VirtualClock
from chatrobot.core.governed import GovernedTwist, StopEpoch
from chatrobot.core.reason import Reason
from chatrobot.execution.sensors import Sensors
from chatrobot.motion.safety.stop import StopConfirmation, Stops
from chatrobot.robots.load import DEFAULT_PROFILE, load_profile

PERSON = Reason("stopped_by", {"source": "console", "why": "stop"})
FAILURE = Reason("does_not_move")


class HaltingTransport:
    """Counts the zeros; `meanwhile` is what another thread does while one goes out."""

    def __init__(self, epoch: StopEpoch) -> None:
        self._epoch = epoch
        self.zeros = 0
        self.meanwhile: Callable[[], None] = lambda: None

    def send(self, twist: GovernedTwist) -> bool:
        raise AssertionError(f"nothing is to be sent: {twist}")

    def halt(self) -> None:
        self._epoch.stop()
        self.zeros += 1
        meanwhile, self.meanwhile = self.meanwhile, lambda: None
        meanwhile()


def rig() -> tuple[Stops, HaltingTransport, StopConfirmation]:
    epoch, clock = StopEpoch(), VirtualClock()
    transport = HaltingTransport(epoch)
    stop_confirmation = StopConfirmation(
        Sensors(load_profile(DEFAULT_PROFILE), clock), lambda _: None, lambda _: None
    )
    return Stops(epoch, transport, stop_confirmation, clock), transport, stop_confirmation


def test_a_stop_is_out_before_it_is_booked_and_booked_once() -> None:
    stops, transport, stop_confirmation = rig()
    assert stops.book() is None
    stops.halt(PERSON)
    assert transport.zeros == 1
    assert stops.is_unbooked
    assert stops.book() == PERSON
    assert stop_confirmation.is_active
    assert stops.book() is None


def test_the_stop_at_the_end_of_a_motion_is_nobodys_and_leaves_what_waits() -> None:
    stops, transport, stop_confirmation = rig()
    stops.halt_and_book(FAILURE)
    assert transport.zeros == 1
    assert stop_confirmation.is_active
    assert stops.book() is None
    assert stops.last_reason == FAILURE, "what it overtook is told why"


def test_a_persons_stop_is_not_lost_in_a_motions_own() -> None:
    for before in (True, False):
        stops, transport, _ = rig()
        if before:
            stops.halt(PERSON)
        else:
            transport.meanwhile = lambda stops=stops: stops.halt(PERSON)  # type: ignore[misc]
        stops.halt_and_book(FAILURE)
        assert transport.zeros == 2
        assert stops.book() == PERSON, "and it keeps its name"
        assert stops.book() is None
