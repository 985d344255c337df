"""The Python API: a few names, values instead of exceptions, a stop from anywhere."""

from __future__ import annotations

import contextlib
import math
import os
import threading
import time
from pathlib import Path

import pytest

import chatrobot
from chatrobot.core.errors import PlanTextError, ProfileError, UsageError, WorldError
from chatrobot.core.events import Event, Paused, Progress
from chatrobot.plan.steps import Drive, Plan
from tests.dialogue.scripted_model import ScriptedModel
from tests.processes import wait_until


@pytest.fixture
def runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))


def fast(**options: object) -> chatrobot.Robot:
    return chatrobot.connect(fast=True, world="empty", **options)  # type: ignore[arg-type]


def test_do_returns_what_was_measured() -> None:
    with fast() as robot:
        result = robot.do("forward 1 m")
        assert result.outcome == "completed"
        assert result.path_m == pytest.approx(1.0, abs=0.02)
        assert robot.pose == result.pose


@pytest.mark.parametrize(
    ("text", "outcome"), [("fly", "refused"), ("florble the wug", "unclear"), ("where are you?", "answered")]
)
def test_what_cannot_be_done_is_a_value(text: str, outcome: str) -> None:
    with fast() as robot:
        assert robot.do(text).outcome == outcome


def test_a_result_says_what_was_left_out_and_what_could_not_be_kept() -> None:
    with fast(robot="wheeltec_mini_akm", config_dir="/proc/none") as robot:
        turned, kept = robot.do("forward 50 cm, then turn left"), robot.do("remember this place as base")
    assert turned.reason is not None
    assert kept.reason is not None
    assert (turned.outcome, turned.reason.code) == ("completed", "turn_left_out")
    assert (kept.outcome, kept.reason.code) == ("answered", "places_not_kept")


def test_a_plan_runs_as_an_object_or_as_text() -> None:
    with fast() as robot:
        assert robot.run(Plan((Drive(distance_m=0.5),))).path_m == pytest.approx(0.5, abs=0.02)
        assert robot.run("turn left 90 deg").turned_rad == pytest.approx(math.pi / 2, abs=0.03)
        assert robot.do("again").turned_rad == pytest.approx(math.pi / 2, abs=0.03)


def test_a_plan_that_cannot_be_is_an_error_of_ours_and_a_value_error() -> None:
    for make in (lambda: Plan(()), lambda: Drive(distance_m=-1.0)):
        with pytest.raises(chatrobot.ChatRobotError) as raised:
            make()
        assert isinstance(raised.value, ValueError)


def test_what_nobody_measured_is_none() -> None:
    with chatrobot.connect(fast=True, open_loop=True) as robot:
        for text in ("forward 20 cm", "where are you?"):
            result = robot.do(text)
            assert (result.measured, result.has_moved) == (False, False)
            assert (result.pose, result.path_m, result.turned_rad, robot.pose) == (None, None, None, None)


def test_a_plan_that_is_proposed_to_a_robot_that_measures_nothing_waits_for_a_yes() -> None:
    with chatrobot.connect(fast=True, open_loop=True) as robot:
        assert robot.do("Ben says forward 20 cm").proposal is not None
        assert robot.do("yes").outcome == "completed"


def test_a_text_drives_as_far_and_as_long_as_connect_allows() -> None:
    with fast(max_distance_m=3) as robot:
        told = robot.do("forward 4 m")
        assert (told.outcome, told.reason and told.reason.code) == ("refused", "over_max_distance")
        assert robot.do("forward 2 m").outcome == "completed"
    with fast(max_time_s=2.0) as robot:
        told = robot.do("forward 4 m")
        assert (told.outcome, told.reason and told.reason.code) == ("refused", "over_max_time")
    with fast(max_distance_m=None, max_time_s=None) as robot:
        assert robot.do("forward 101 m at 1 m/s").outcome == "completed"


@pytest.mark.parametrize("text", ["forward 101 m at 1 m/s", "fahr 101 m vor mit 1 m/s", "以1米每秒前进101米"])
def test_a_limit_names_the_argument_that_allows_more(text: str) -> None:
    with fast() as robot:
        reply = robot.do(text).reply
    assert "connect(max_distance_m=…)" in reply
    assert "/limit" not in reply


@pytest.mark.parametrize("text", ["/estop", "forward 1 m", "release the emergency stop"])
def test_an_emergency_stop_names_no_way_out_that_a_program_has_not(text: str) -> None:
    with fast() as robot:
        robot.do("/estop")
        reply = robot.do(text).reply
    assert "/release" not in reply
    assert "new one" in reply
    with fast() as robot:
        assert robot.do("forward 0.2 m").outcome == "completed"


def test_a_text_that_is_no_plan_names_its_line() -> None:
    with fast() as robot, pytest.raises(PlanTextError, match="line 2"):
        robot.run("drive 1 m\nfly 2 m")


def test_every_option_is_checked() -> None:
    with pytest.raises(UsageError, match="slip"):
        fast(sim="slip=9")
    with pytest.raises(ProfileError, match="r2d2"):
        fast(robot="r2d2")
    with pytest.raises(UsageError, match="--on"):
        fast(on="moon")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"on": 3}, "on: 3 cannot be used (it takes 'sim', 'dds', 'ros' or 'rosbridge')"),
        ({"robot": 5}, "robot: 5 cannot be used"),
        (
            {"world": None},
            "world: None cannot be used (it takes a name that `chatrobot worlds` lists, or a file)",
        ),
        ({"sim": 0.03}, "sim: 0.03 cannot be used"),
        ({"fast": "yes"}, "fast: 'yes' cannot be used (it takes True or False)"),
        ({"interpreter": "best"}, "it takes 'auto' or 'offline' or 'model'"),
        ({"interpreter": "model"}, "interpreter: no language model is given"),
        ({"model": "clippy:95"}, "model: I do not know the model “clippy:95”."),
        ({"model": 3}, "model: 3 cannot be used"),
        ({"camera": 3}, "camera: 3 cannot be used"),
        (
            {"max_distance_m": 0},
            "max_distance_m: 0 cannot be used (it takes a number above zero, None for no limit",
        ),
        ({"max_distance_m": "5 m"}, "max_distance_m: '5 m' cannot be used"),
        ({"max_time_s": True}, "max_time_s: True cannot be used"),
        ({"config_dir": __file__}, "it takes a folder"),
    ],
)
def test_a_wrong_argument_is_refused_with_what_is_allowed(options: dict[str, object], told: str) -> None:
    with pytest.raises(UsageError) as raised:
        chatrobot.connect(**{"fast": True, "world": "empty", **options})  # type: ignore[arg-type]
    assert told in str(raised.value)


def test_a_profile_and_a_world_may_be_paths(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=r"nope\.toml: No such file"):
        fast(robot=tmp_path / "nope.toml")
    with pytest.raises(WorldError, match=r"nope\.yaml: cannot be read \(No such file"):
        chatrobot.connect(fast=True, world=tmp_path / "nope.yaml")


@pytest.mark.parametrize("wrong", [None, 5, b"forward 1 m", ["forward 1 m"]])
def test_what_is_neither_text_nor_plan_is_refused_and_breaks_nothing(wrong: object) -> None:
    with fast() as robot:
        for call in (robot.do, robot.run, robot.on_event):
            with pytest.raises(UsageError, match="cannot be used"):
                call(wrong)  # type: ignore[operator]
        assert robot.do("forward 0.2 m").outcome == "completed"


def test_events_are_heard_in_their_order() -> None:
    names: list[str] = []
    with fast() as robot:
        robot.on_event(lambda event: names.append(event.name))
        robot.do("forward 0.3 m")
    heard = [name for name in names if name not in ("telemetry", "progress")]
    assert heard == ["interpreted", "rehearsed", "started", "finished", "result"]


def test_a_listener_may_stop_the_robot() -> None:
    with fast() as robot:

        def stop_half_way(event: Event) -> None:
            if isinstance(event, Progress) and event.pose.x_m > 0.5:
                robot.stop()

        robot.on_event(stop_half_way)
        result = robot.do("forward 2 m")
    assert result.outcome == "stopped"
    assert result.path_m < 1.0


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_pause_keeps_the_plan_and_resume_drives_the_rest(language: str) -> None:
    text = {"en": "forward 2 m, then turn left 90 degrees", "zh": "前进两米，然后左转90度"}[language]
    seen: list[Paused] = []
    with fast() as robot:

        def pause_half_way(event: Event) -> None:
            if isinstance(event, Progress) and event.pose.x_m > 0.5 and not seen:
                robot.pause()
            elif isinstance(event, Paused):
                seen.append(event)
                robot.resume()

        robot.on_event(pause_half_way)
        result = robot.do(text)
        assert robot.pose == result.pose
    (left,) = seen
    assert left.turn == result.turn
    assert 0.5 < left.pose.x_m < 1.0
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(2.0, abs=0.02)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.02)
    assert result.paused_s > 0.0


def test_a_run_is_paused_like_what_was_said() -> None:
    starts: list[Event] = []
    with fast() as robot:

        def pause_at_first(event: Event) -> None:
            if event.name == "started":
                starts.append(event)
                if len(starts) == 1:
                    robot.pause()

        robot.on_event(pause_at_first)
        robot.on_event(lambda event: robot.resume() if isinstance(event, Paused) else None)
        result = robot.run("drive 1 m\nturn left 90 deg")
    assert len(starts) == 2
    assert (result.outcome, result.turn) == ("completed", 1)
    assert result.path_m == pytest.approx(1.0, abs=0.02)
    assert result.turned_rad == pytest.approx(math.pi / 2, abs=0.02)


def test_a_stop_drops_what_is_paused() -> None:
    with fast() as robot:
        robot.on_event(lambda event: robot.pause() if isinstance(event, Progress) else None)
        robot.on_event(lambda event: robot.stop() if isinstance(event, Paused) else None)
        result = robot.do("forward 2 m")
        assert result.outcome == "stopped"
        robot.resume()
        assert robot.do("where are you?").outcome == "answered"
        assert robot.pose.x_m == result.pose.x_m


def test_without_anything_paused_resume_and_pause_move_nothing() -> None:
    with fast() as robot:
        robot.resume()
        robot.pause()
        robot.resume()
        assert robot.do("where are you?").outcome == "answered"
        assert robot.pose.x_m == 0.0
        assert robot.do("forward 0.2 m").path_m == pytest.approx(0.2, abs=0.01)


@pytest.mark.realtime
@pytest.mark.usefixtures("runtime")
def test_in_real_time_another_thread_pauses_and_resumes_what_do_waits_for() -> None:
    moving, paused = threading.Event(), threading.Event()
    with chatrobot.connect(world="empty") as robot:
        robot.on_event(lambda event: moving.set() if isinstance(event, Progress) else None)
        robot.on_event(lambda event: paused.set() if isinstance(event, Paused) else None)

        def pause_and_resume() -> None:
            assert moving.wait(30)
            robot.pause()
            assert paused.wait(30)
            robot.resume()

        threading.Thread(target=pause_and_resume).start()
        result = robot.do("forward 1 m")
    assert paused.is_set()
    assert result.outcome == "completed"
    assert result.path_m == pytest.approx(1.0, abs=0.03)


def break_on_start(event: Event) -> None:
    if event.name == "started":
        raise ZeroDivisionError("in a listener")


def test_what_a_listener_raises_stops_the_robot_and_comes_out_of_do() -> None:
    with fast() as robot:
        robot.on_event(break_on_start)
        with pytest.raises(ZeroDivisionError):
            robot.do("forward 2 m")
        assert robot.do("where are you?").outcome == "answered"
        assert robot.pose.x_m < 0.1


def test_a_closed_robot_says_so() -> None:
    robot = fast()
    robot.close()
    robot.close()
    with pytest.raises(chatrobot.ChatRobotError, match="closed"):
        robot.do("forward 1 m")


@pytest.mark.realtime
@pytest.mark.usefixtures("runtime")
def test_in_real_time_a_stop_from_another_thread_waits_for_nothing() -> None:
    moving = threading.Event()
    with chatrobot.connect(world="empty") as robot:
        robot.on_event(lambda event: moving.set() if isinstance(event, Progress) else None)

        def stop_when_moving() -> None:
            assert moving.wait(30)
            robot.stop()

        threading.Thread(target=stop_when_moving).start()
        result = robot.do("forward 10 m")
        assert result.outcome == "stopped"
        assert result.path_m < 5.0
        assert robot.do("turn left 20 degrees").outcome == "completed"


@pytest.mark.realtime
@pytest.mark.usefixtures("runtime")
def test_in_real_time_who_waits_hears_that_another_thread_has_closed_the_robot() -> None:
    moving, told = threading.Event(), []
    robot = chatrobot.connect(world="empty")
    robot.on_event(lambda event: moving.set() if isinstance(event, Progress) else None)

    def drive() -> None:
        with pytest.raises(chatrobot.ChatRobotError, match="closed") as raised:
            robot.do("forward 10 m")
        told.append(raised.value)

    waiting = threading.Thread(target=drive, daemon=True)
    waiting.start()
    assert moving.wait(30)
    began_s = time.monotonic()
    robot.close()
    assert time.monotonic() - began_s < 3.0, "it waited for the ten metres"
    waiting.join(30)
    assert told


def children() -> set[str]:
    """The processes that this one has started and not yet seen the end of."""
    found = set()
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            parent = stat.read_text(errors="replace").rpartition(")")[2].split()[1]
            found |= {stat.parent.name} if parent == str(os.getpid()) else set()
    return found


@pytest.mark.realtime
@pytest.mark.usefixtures("runtime")
def test_in_real_time_a_closed_robot_leaves_no_process_behind() -> None:
    before = children()
    with chatrobot.connect(world="empty"):
        started = children() - before
    assert len(started) == 2
    wait_until(lambda: not started & children())


@pytest.mark.realtime
@pytest.mark.usefixtures("runtime")
def test_in_real_time_what_a_listener_raises_comes_out_of_do() -> None:
    with chatrobot.connect(world="empty") as robot:
        robot.on_event(break_on_start)
        with pytest.raises(ZeroDivisionError):
            robot.do("forward 10 m")
        assert robot.do("where are you?").outcome == "answered"


def test_a_model_is_shown_the_picture_of_the_camera_that_was_passed() -> None:
    model = ScriptedModel("look camera", 'say "a red ball"')
    with fast(model=model, interpreter="model", camera=lambda: b"\x89PNG") as robot:
        assert robot.do("what do you see?").outcome in ("completed", "answered")
    assert any(message.picture == b"\x89PNG" for message in model.asked[-1])
