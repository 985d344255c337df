"""A node's log says in sentences, and how severe they are, what the console would say."""

from __future__ import annotations

import threading

import pytest

from chatrobot.core.events import Event, Finished, Notice, Outcome, ProgramLog, Progress, Started, Telemetry
from chatrobot.core.geometry import ORIGIN, Twist
from chatrobot.core.reason import Reason
from chatrobot.language.phrases import render_reason
from chatrobot.nodes.log import Log, Severity, on_stderr
from chatrobot.nodes.told import told

IN_THE_WAY = Reason("would_collide", {"step": 1, "distance_m": 2.6609999999999996, "free_m": 2.6})


def finished(outcome: Outcome, reason: Reason | None = None, turn: int = 3) -> Finished:
    return Finished(turn, outcome, reason, ORIGIN, ORIGIN, 0.0, 0.5, 1.0, 0.0, planned_m=0.5)


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_refusal_is_the_sentence_that_the_console_says(language: str) -> None:
    line = told(finished("refused", IN_THE_WAY), language)
    assert line is not None
    assert render_reason(IN_THE_WAY, language).rstrip(".。") in line.text
    assert "would_collide" not in line.text
    assert "2.6609999" not in line.text


@pytest.mark.parametrize(
    ("event", "severity", "text"),
    [
        (Started(2), "info", "Turn 2 begins."),
        (finished("completed"), "info", "Turn 3: Done: drove 0.50 m of 0.50 m."),
        (finished("completed", turn=0), "info", "Done: drove 0.50 m of 0.50 m."),
        (
            finished("stopped", Reason("stopped_by", {"source": "control", "why": "Ctrl-C"})),
            "info",
            "Turn 3: Stopped (Ctrl-C, at control). So far: drove 0.50 m of 0.50 m.",
        ),
        (finished("stopped", Reason("beats_missed")), "warn", None),
        (finished("refused", IN_THE_WAY), "warn", None),
        (finished("failed", Reason("wire_gone")), "error", None),
        (Notice(0, Reason("wire_gone")), "warn", "The connection to the robot is gone."),
        (Notice(0, Reason("wire_back")), "info", "The connection to the robot is back."),
        (ProgramLog(1, 0.0, "INFO", "hello"), "info", "hello"),
        (ProgramLog(1, 0.0, "WARN", "hm"), "warn", "hm"),
        (ProgramLog(1, 0.0, "FATAL", "oh"), "error", "oh"),
    ],
)
def test_each_event_is_a_sentence_with_its_severity(
    event: Event, severity: Severity, text: str | None
) -> None:
    line = told(event)
    assert line is not None
    assert line.severity == severity
    assert line.text == (text or line.text)
    assert line.text[0].isupper() or isinstance(event, ProgramLog)


@pytest.mark.parametrize(
    "event",
    [Telemetry(0, ORIGIN, Twist(), 0.0), Progress(1, 1, 1, 0.5, ORIGIN, Twist())],
)
def test_what_comes_ten_times_a_second_is_not_logged(event: Event) -> None:
    assert told(event) is None


def test_a_terminal_that_is_held_up_holds_up_nobody() -> None:
    lines: list[str] = []
    goes_on = threading.Event()

    def write(_severity: Severity, text: str) -> None:
        goes_on.wait(10.0)
        lines.append(text)

    log = Log(write)
    log("info", "first")
    log("warn", "second")
    assert not lines
    goes_on.set()
    log.close()
    assert lines == ["first", "second"]


def test_without_ros_it_is_on_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    on_stderr("warn", "The guard did not start.")
    assert capsys.readouterr().err == "The guard did not start.\n"
