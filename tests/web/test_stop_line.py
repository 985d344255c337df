"""The line that stops has a thread, a loop and a port of its own: nothing that the page is busy with holds it up."""

from __future__ import annotations

import statistics
import threading
import time

import pytest

from tests.web.rig import WebRig

BLOCKED_S = 5.0


def test_a_stop_is_out_before_it_is_answered(rig: WebRig) -> None:
    line = rig.stop_line()
    line.say("stop")
    assert line.wait_for("stopped") == {"is": "stopped", "do": "stop"}
    assert rig.session.log == [("stop", "the Stop button")]
    line.say("emergency_stop")
    assert line.wait_for("stopped")["do"] == "emergency_stop"
    assert rig.session.log[-1] == ("emergency_stop", "the Emergency stop button")


@pytest.mark.parametrize(
    "text", ["", "{", "[]", '{"do":"say","text":"forward 1 m"}', '{"do":"release"}', '{"do":[]}']
)
def test_it_hears_nothing_but_stops(rig: WebRig, text: str) -> None:
    line = rig.stop_line()
    line.socket.send(text)
    line.wait_for("refused")
    assert rig.session.log == []
    line.say("stop")
    line.wait_for("stopped")


def test_it_serves_no_page(rig: WebRig) -> None:
    answer = rig.http().get(f"http://127.0.0.1:{rig.access.stop_port}/")
    assert answer.status_code == 404


def test_an_emergency_stop_there_is_told_to_the_pages(rig: WebRig) -> None:
    page, line = rig.page(), rig.stop_line()
    line.say("emergency_stop")
    assert page.wait_for("emergency")["set"]


@pytest.mark.parametrize("busy", [False, True], ids=["asleep", "computing"])
def test_a_stop_is_out_though_the_event_loop_of_the_page_is_blocked(rig: WebRig, busy: bool) -> None:
    page, line = rig.page(), rig.stop_line()
    page.say("say", text="forward 1 m")
    rig.session.wait_for("say", "forward 1 m")
    is_blocked, is_done = threading.Event(), threading.Event()

    def block() -> None:
        is_blocked.set()
        ends_s = time.monotonic() + BLOCKED_S
        while time.monotonic() < ends_s and not is_done.is_set():
            if not busy:
                is_done.wait(BLOCKED_S)

    rig.call(block)
    assert is_blocked.wait(1.0)
    took_s = []
    for _ in range(20):
        said_s = time.monotonic()
        line.say("stop")
        line.wait_for("stopped", timeout_s=1.0)
        took_s.append(time.monotonic() - said_s)
    assert statistics.median(took_s) < 0.1
    rig.session.wait_for("stop", "the steering page is gone", timeout_s=1.0)
    is_done.set()
