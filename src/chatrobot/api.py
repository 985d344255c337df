"""The Python API: a robot to talk to from a program.

with chatrobot.connect() as robot:
    result = robot.do("forward 1 m")
    print(result.outcome, result.pose)
"""

from __future__ import annotations

import contextlib
import math
import threading
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Literal

from chatrobot.compose import Connection, Setup
from chatrobot.compose import connect as compose_connect
from chatrobot.core.errors import ChatRobotError, UsageError
from chatrobot.core.events import Event, Result, Telemetry
from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.dialogue.llm.requests import Interpreter
from chatrobot.dialogue.llm.setup import chosen_model
from chatrobot.dialogue.options import Options
from chatrobot.dialogue.pump import PUMP_S, Pump
from chatrobot.dialogue.session import Session
from chatrobot.language.phrases import render_reason
from chatrobot.language.typed import speak_for
from chatrobot.models.seam import Model, ModelError
from chatrobot.options import DEFAULT_ROBOT, INTERPRETERS, NO_ODOMETRY
from chatrobot.plan.steps import Plan
from chatrobot.plan.text import format_plan, parse_plan
from chatrobot.robots.profile import MotionBudget, read_limit

Listener = Callable[[Event], None]
Limit = float | Literal["profile"] | None


def connect(
    *,
    on: str = "auto",
    robot: str | Path = "",
    world: str | Path = "",
    sim: str = "",
    fast: bool = False,
    trace: bool = False,
    open_loop: bool = False,
    max_distance_m: Limit = "profile",
    max_time_s: Limit = "profile",
    config_dir: Path | str | None = None,
    model: Model | str | None = None,
    interpreter: Interpreter = "auto",
    camera: Callable[[], bytes | None] | None = None,
) -> Robot:
    """Connect to a robot; by default to the simulated one, in a furnished flat. The options of the command line.

    Args:
        sim: faults injected into the simulated robot, such as `slip=0.03,noise=on`.
        open_loop: drive a robot that has no odometry, slowly and for at most 10 s a text; nothing of its motion is
            measured (`Result.measured` is False), and `pose` and distances are None.
        max_distance_m, max_time_s: how far and how long one text or plan may drive; None for no limit.
        config_dir: where remembered places and the user's own profiles live; None keeps nothing.
        model: `PROVIDER:NAME`, or anything with the methods of `chatrobot.models.seam.Model`. None: no model.
        camera: takes a picture, as JPEG or PNG, for a model that asks to see one; None where there is none just now.
            Without it, a robot on a wire uses the camera that its profile names.

    Raises:
        InputError: an option cannot be used; it says what is allowed.
        LinkError: the robot's processes do not start.
    """
    _check_kinds(on=on, robot=robot, world=world, sim=sim, fast=fast, trace=trace, open_loop=open_loop)
    interpreters = " or ".join(map(repr, INTERPRETERS))
    _refuse_unless(interpreter in INTERPRETERS, "interpreter", interpreter, interpreters)
    _refuse_unless(camera is None or callable(camera), "camera", camera, "a function that returns a picture")
    budget = MotionBudget(_limit_of("max_distance_m", max_distance_m), _limit_of("max_time_s", max_time_s))
    folder = _folder_of(config_dir)
    chosen = _model_of(model, folder)
    if interpreter == "model" and chosen is None:
        raise UsageError("no language model is given", where="interpreter", allowed="model='PROVIDER:NAME'")
    profile = str(robot) or (NO_ODOMETRY if open_loop else DEFAULT_ROBOT)
    setup = Setup(
        on=on, robot=profile, world=str(world), sim=sim, fast=fast, trace=trace, open_loop=open_loop, budget=budget,
        folder=folder, model=chosen, camera=camera, options=Options(interpreter=interpreter),
    )  # fmt: skip
    speak_for("python")
    return Robot(setup)


_SWITCH = ((bool,), "True or False")
_KINDS: dict[str, tuple[tuple[type, ...], str]] = {
    "on": ((str,), "'sim', 'dds', 'ros' or 'rosbridge'"),
    "robot": ((str, Path), "a name or a file"),
    "world": ((str, Path), "a name that `chatrobot worlds` lists, or a file"),
    "sim": ((str,), "'KEY=VALUE,…'"),
    **dict.fromkeys(("fast", "trace", "open_loop"), _SWITCH),
}


def _check_kinds(**given: object) -> None:
    for name, value in given.items():
        kinds, allowed = _KINDS[name]
        _refuse_unless(isinstance(value, kinds), name, value, allowed)


def _refuse_unless(is_right: bool, name: str, value: object, allowed: str) -> None:
    """Refuse an argument of a call.

    Raises:
        UsageError: which, what it was, and what is allowed.
    """
    if not is_right:
        raise UsageError(f"{value!r} cannot be used", where=name, allowed=f"it takes {allowed}")


def _limit_of(name: str, value: Limit) -> float | None:
    """Return a limit as `MotionBudget` has it: None is the profile's there, and infinity is none."""
    if value is None or value == "profile":
        return math.inf if value is None else None
    try:
        return read_limit(value)
    except ValueError:
        allowed = "it takes a number above zero, None for no limit, or 'profile'"
        raise UsageError(f"{value!r} cannot be used", where=name, allowed=allowed) from None


def _folder_of(config_dir: Path | str | None) -> Path | None:
    if config_dir is None:
        return None
    allowed = "a folder, made if need be"
    _refuse_unless(isinstance(config_dir, (str, Path)), "config_dir", config_dir, allowed)
    folder = Path(config_dir).expanduser()
    _refuse_unless(folder.is_dir() or not folder.exists(), "config_dir", config_dir, allowed)
    return folder


def _model_of(model: Model | str | None, folder: Path | None) -> Model | None:
    if not isinstance(model, str):
        has_methods = model is None or callable(getattr(model, "ask", None))
        _refuse_unless(has_methods, "model", model, "'PROVIDER:NAME', or what has the methods of Model")
        return model
    try:
        return chosen_model(model, folder)
    except ModelError as error:
        raise UsageError(render_reason(error.reason, "en"), where="model") from error


class Robot:
    """A connected robot. Close it, or use it in a `with`.

    In real time events are heard on a thread of their own, all the time; in simulated time while `do` or `run`
    runs, on the caller's. `stop`, `pause` and `resume` may be called from any thread, everything
    else from one at a time.
    """

    def __init__(self, setup: Setup) -> None:
        self._listeners: list[Listener] = []
        self._news = threading.Condition()
        self._listener_error: Exception | None = None
        self._lost: Exception | None = None
        self._closing = False
        self._waiting: list[Callable[[], int]] = []
        """What was said and has no result yet, of each thread that waits for one."""
        self._connection: Connection = compose_connect(setup, self._hear)
        self._pose: Pose | None = ORIGIN if self._connection.profile.has_odometry else None
        self._pump: Pump | None = None
        if not setup.fast:
            self._pump = Pump(self._connection.session, self._lose, self._tell_waiting)
            self._pump.start()

    def do(self, text: str) -> Result:
        """Say it and wait for what comes of it: a value, whatever the outcome. Ctrl-C stops the robot first.

        Raises:
            UsageError: `text` is no text.
            ChatRobotError: something broke, or another thread has closed the robot.
        """
        _refuse_unless(isinstance(text, str), "text", text, "what to do, such as 'forward 1 m'")
        return self._see_through(lambda: self._session.say(text))

    def run(self, plan: Plan | str) -> Result:
        """Run a plan, given as such or as plan text. It is rehearsed and limited like any other.

        Raises:
            PlanTextError: the text is no plan; it names the line.
            UsageError: `plan` is neither a plan nor a text.
            ChatRobotError: something broke.
        """
        _refuse_unless(
            isinstance(plan, (Plan, str)), "plan", plan, "a Plan, or plan text such as 'drive 1 m'"
        )
        text = format_plan(parse_plan(plan) if isinstance(plan, str) else plan)
        return self._see_through(lambda: self._session.say_plan(text))

    def stop(self) -> None:
        """Stop now: waits for nothing that is going on. What runs ends as `stopped`."""
        self._session.stop("stop()")

    def pause(self) -> None:
        """Stop now, and keep the plan that runs: `do` goes on waiting for it. It goes on with `resume`."""
        self._session.pause("pause()")

    def resume(self) -> None:
        """Go on with what is paused, from where the robot stands now; the `do` that waits for it sees its end."""
        self._session.resume()

    @property
    def pose(self) -> Pose | None:
        """Where the robot last said it was: metres and radians from where it was connected. None without odometry."""
        return self._pose

    def on_event(self, callback: Listener) -> None:
        """Have `callback` called with every event from now on. What it raises comes out of `do` or `run`."""
        _refuse_unless(callable(callback), "callback", callback, "a function that takes an event")
        self._listeners.append(callback)

    def close(self) -> None:
        """Say goodbye. What another thread's `do` has begun is stopped, and it raises. Closing twice does no harm."""
        if self._closing:
            return
        self._closing = True
        session = self._connection.session
        session.end_after()  # what a `do` says in this very moment
        if self._waiting:
            with contextlib.suppress(ChatRobotError):
                session.stop("close()")
        self._tell_waiting()
        if self._pump is not None:
            self._pump.stop()
        self._connection.close()

    def __enter__(self) -> Robot:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            with contextlib.suppress(ChatRobotError):
                self.stop()
        self.close()

    @property
    def _session(self) -> Session:
        self._refuse_closed()
        return self._connection.session

    def _refuse_closed(self) -> None:
        if self._closing:
            raise ChatRobotError("this robot has been closed")

    def _hear(self, event: Event) -> None:
        if isinstance(event, (Telemetry, Result)):
            self._pose = event.pose
        for listener in tuple(self._listeners):
            try:
                listener(event)
            except Exception as error:  # noqa: BLE001  # a stranger's code may raise anything: the robot stops, who waits is told
                self._listener_error = error
                self._connection.session.stop("a listener broke")

    def _see_through(self, say: Callable[[], int]) -> Result:
        session = self._session
        self._waiting.append(say)
        try:
            turn = say()
            while turn not in session.results:
                if self._pump is None:
                    session.pump(PUMP_S)
                else:
                    with self._news:
                        self._news.wait(PUMP_S)
                self._raise_errors()
        except KeyboardInterrupt:
            self.stop()
            raise
        finally:
            self._waiting.remove(say)
        return session.results[turn]

    def _raise_errors(self) -> None:
        if self._listener_error is not None:
            error, self._listener_error = self._listener_error, None
            raise error
        if self._lost is not None:
            raise self._lost
        self._refuse_closed()  # nobody pumps any more: the result would never come

    def _tell_waiting(self) -> None:
        with self._news:
            self._news.notify_all()

    def _lose(self, error: Exception) -> None:
        self._lost = error
