"""`chatrobot calibrate`: one metre and one turn; a person measures, and the profile gets the correction.

In a simulation there is no tape: it tells itself how far the robot really went.
"""

from __future__ import annotations

import argparse
import datetime
import math
import queue
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

from chatrobot.cli.approver import Approver
from chatrobot.cli.choices import setup_from
from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.conversation import Conversation
from chatrobot.cli.entry import FAILED, STOPPED
from chatrobot.cli.folders import profile_folders
from chatrobot.cli.json_lines import Printer, printer_for
from chatrobot.cli.lines import LineReader
from chatrobot.core.errors import UsageError
from chatrobot.core.events import Event, Result, TruePose
from chatrobot.core.geometry import wrap_angle
from chatrobot.dialogue.options import Options
from chatrobot.language.consent import read_consent
from chatrobot.language.data_files import load_table
from chatrobot.language.interpretation import LanguageCode
from chatrobot.link.processes import SIMULATED
from chatrobot.reflex import is_stop
from chatrobot.robots.calibration import (
    DEGREES,
    METRES,
    Measured,
    corrected,
    read_measure,
    reset_calibration,
    save_calibration,
)
from chatrobot.robots.load import load_profile
from chatrobot.robots.profile import RobotProfile

_SKIP = ("skip", "跳过")


def run(args: argparse.Namespace) -> int:
    """Return 0 for a correction saved, taken back or not needed, 1 for a wrong robot or measure, 5 for a stop."""
    if args.json:
        raise UsageError(
            "calibrate asks a person to measure", where="--json", allowed="calibrate without --json"
        )
    folders = profile_folders(args)
    profile = load_profile(args.robot, folders)
    if args.reset:
        return _reset(profile, args.robot, folders[0])
    if not profile.has_odometry:
        print(_phrases()["without_odometry"].format(robot=args.robot))
        return FAILED
    setup = replace(setup_from(args, options=Options(), world="empty"), yes=True)
    is_simulated = setup.on in SIMULATED
    truth = Truth(printer_for(args))
    setup = replace(setup, trace=is_simulated)
    with Conversation(setup, truth, Approver(can_ask=False)) as conversation:
        dialogue = Dialogue(conversation, truth if is_simulated else None)
        try:
            if not (is_simulated or _hears_odometry(dialogue, truth)):
                dialogue.say("no_odometry")
                return FAILED
            return _calibrate(dialogue, profile, args.robot, folders[0])
        except Left:
            return STOPPED
        except DoesNotFit:
            dialogue.say("does_not_fit", robot=args.robot)
            return FAILED


class Left(Exception):  # noqa: N818
    """The person has gone, or wants no more of it."""


class DoesNotFit(Exception):  # noqa: N818
    """The robot did not do what its profile says it can."""


class Truth:
    """A `Printer` that takes the true poses of a simulated robot for itself, and can keep to what fails."""

    def __init__(self, printer: Printer) -> None:
        self._printer = printer
        self._poses: list[TruePose] = []
        self.tells_failures_alone = False

    @property
    def is_broken(self) -> bool:
        """Nobody reads what is written."""
        return self._printer.is_broken

    def turn(self, text: str) -> None:
        """Show what begins a turn."""
        self._printer.turn(text)

    def show(self, event: Event, language: LanguageCode) -> None:
        """Keep a true pose; show any other event."""
        if isinstance(event, TruePose):
            self._poses.append(event)
        elif not self.tells_failures_alone or (isinstance(event, Result) and event.outcome != "completed"):
            self._printer.show(event, language)

    def begin(self) -> None:
        """Measure from the latest pose on."""
        del self._poses[:-1]

    def gone_m(self) -> float:
        """Return how far it is from where the measuring began."""
        first, last = self._poses[0], self._poses[-1]
        return math.hypot(last.x_m - first.x_m, last.y_m - first.y_m)

    def turned_deg(self) -> float:
        """Return how far it has turned since then, whole turns included."""
        steps = (wrap_angle(after.yaw_rad - before.yaw_rad) for before, after in pairwise(self._poses))
        return math.degrees(abs(sum(steps)))


@dataclass(frozen=True)
class Trial:
    """One motion to measure: its plan, its phrases, and how an answer is read."""

    name: str
    plan_text: str
    units: dict[str, float]


METRE = Trial("metre", "drive 1 m", METRES)
TURN = Trial("turn", "turn left 360 deg", DEGREES)


class Dialogue:
    """Asks, and hears the answers; a stop word stops the robot at once, whenever it comes."""

    def __init__(self, conversation: Conversation, truth: Truth | None) -> None:
        self.conversation = conversation
        self.truth = truth
        self._phrases = _phrases()
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = LineReader(self._hear)
        self._reader.start()

    def say(self, code: str, **values: object) -> None:
        """Print the phrase of that code."""
        print(self._phrases[code].format(**values), flush=True)

    def ask(self, code: str, **values: object) -> str:
        """Return the answer, in lower case.

        Raises:
            Left: there will be none.
        """
        print(self._phrases[code].format(**values), end=" ", flush=True)
        while self._lines.empty():
            if self.conversation.is_leaving or (self._reader.has_ended and self._lines.empty()):
                raise Left
            self.conversation.wait()
        answer = self._lines.get()
        if is_stop(answer):
            raise Left
        return answer.casefold()

    def drive(self, plan_text: str) -> Result:
        """Have it done, and see it through."""
        result = self.conversation.see_through(self.conversation.session.say_plan(plan_text))
        if self.conversation.is_leaving or result.outcome == "stopped":
            raise Left
        return result

    def _hear(self, line: str) -> None:
        if is_stop(line):
            self.conversation.stop(line)
        self._lines.put(line)


def _hears_odometry(dialogue: Dialogue, printer: Truth) -> bool:
    """Have the robot stand for a moment: without odometry that fails, and nobody has fetched a tape yet."""
    printer.tells_failures_alone = True
    result = dialogue.drive("wait 0.1 s")
    printer.tells_failures_alone = False
    return result.outcome == "completed"


def _calibrate(dialogue: Dialogue, profile: RobotProfile, robot: str, folder: Path) -> int:
    dialogue.say("begin", robot=profile.title)
    if dialogue.truth is not None:
        dialogue.say("no_tape", profile=robot, quoted=shlex.quote(robot))
    metre = _measure(dialogue, METRE)
    turn = _measure(dialogue, TURN) if profile.can_turn_on_the_spot else None
    if turn is None and not profile.can_turn_on_the_spot:
        dialogue.say("no_turn")
    if metre is None and turn is None:
        dialogue.say("nothing_measured")
        return 0
    for measured in (metre, turn):
        if measured is not None and not measured.is_plausible:
            dialogue.say("implausible", true=measured.true, seen=measured.seen, robot=robot)
            return FAILED
    source = "; ".join(
        f"{measured.true:g} {unit} measured for {measured.seen:.4g}"
        for measured, unit in ((metre, "m"), (turn, "degrees"))
        if measured is not None
    )
    source = f"chatrobot calibrate, {datetime.date.today().isoformat()}: {source}"
    calibration = corrected(profile.calibration, metre, turn, source)
    numbers = {"distance": calibration.distance_scale, "turn": calibration.turn_scale}
    try:
        file = save_calibration(robot, calibration, folder)
    except OSError as error:  # what a person has measured with a tape is not to be lost
        dialogue.say("not_saved", problem=f"{error.filename}: {error.strerror}", **numbers)
        return FAILED
    dialogue.say("saved", file=file, **numbers)
    return 0


def _measure(dialogue: Dialogue, trial: Trial) -> Measured | None:
    """Return what the person measured, and what odometry saw; None where they skip it."""
    truth = dialogue.truth
    answer = dialogue.ask(f"{trial.name}_ready" if truth is None else f"{trial.name}_ready_simulated")
    if read_consent(answer) is not True:
        if answer in _SKIP:
            return None
        raise Left
    if truth is not None:
        truth.begin()
    result = dialogue.drive(trial.plan_text)
    if result.outcome != "completed" or result.path_m is None or result.turned_rad is None:
        raise DoesNotFit
    seen = result.path_m if trial is METRE else math.degrees(abs(result.turned_rad))
    if truth is not None:
        gone = truth.gone_m() if trial is METRE else truth.turned_deg()
        dialogue.say(f"{trial.name}_true", seen=seen, true=gone)
        return Measured(gone, seen)
    while True:
        true = read_measure(dialogue.ask(f"{trial.name}_measure", seen=seen), trial.units)
        if true is not None and true > 0.0:
            return Measured(true, seen)
        dialogue.say("no_number")


def _reset(profile: RobotProfile, robot: str, folder: Path) -> int:
    """Take back what was saved."""
    before = profile.calibration
    file = reset_calibration(robot, folder)
    numbers = {"distance": before.distance_scale, "turn": before.turn_scale}
    code = "reset" if file is not None else "not_calibrated"
    print(_phrases()[code].format(robot=robot, file=file, **numbers))
    return 0


def _phrases() -> Mapping[str, str]:
    """Load the phrases in the language of the terminal: nobody has said anything yet."""
    return load_table(language_of_environment(), "calibrate")
