"""Every way to say stop or pause, typed while the robot drives, to the zero at a subscriber in another process.

Run: python -m bench.wordings [repetitions], on a quiet machine. What a pause word paused is gone on with (“continue”),
and that motion is stopped. Promised: 3 ms at the median, 10 ms at p99.
"""

from __future__ import annotations

import itertools
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import yaml
from tests.processes import RunningRobot

from bench import line
from chatrobot.reflex import is_emergency_stop, is_pause
from chatrobot.reflex.words import ALL

PROMISED_S = (0.003, 0.010)
CORPUS = Path(__file__).parent.parent / "tests" / "corpus"
MISTYPED = ("pleas stopp", "stp", "hatl", "That'll do, knock it off", "停直", "别冻了")
"""With the first of them the tables of near words are made: it is said once before anything is measured."""
RESUMES = ("continue", "go on", "继续", "接着走")


def stops() -> list[str]:
    """The stop items of the corpora, and some with a mistake in them."""
    said = list(MISTYPED)
    for path in sorted(CORPUS.rglob("*.yaml")):
        for item in yaml.safe_load(path.read_text(encoding="utf-8")):
            if item.get("category") == "stop":
                said += item.get("turns") or [item["say"]]
    return [text for text in dict.fromkeys(said) if not is_emergency_stop(text)]


def ends(robot: RunningRobot, turns: set[int]) -> None:
    """Until all of these turns have their results, and the robot stands."""
    while turns:
        turns.discard(robot.wait_for_event("result")["turn"])
    time.sleep(0.3)
    robot.velocities.all.clear()


def zero_s(robot: RunningRobot, word: str) -> float:
    """From the word to the zero."""
    said_s = robot.say(word)
    return robot.velocities.wait_for_zero(said_s) - said_s


def drive(robot: RunningRobot, text: str) -> float:
    """Until it moves: when it began to."""
    said_s = robot.say(text)
    return robot.velocities.wait_for(lambda twist: twist.vx_mps > 0.1, said_s)[0] - said_s


def stopped(robot: RunningRobot, turns: Iterator[int], word: str) -> float:
    drive(robot, "forward 3 m")
    took_s = zero_s(robot, word)
    ends(robot, {next(turns), next(turns)})
    return took_s


def paused(robot: RunningRobot, turns: Iterator[int], word: str, resume: str) -> tuple[float, float, float]:
    """The pause, the way from `resume` to motion, and the stop of what was gone on with."""
    drive(robot, "forward 3 m")
    pause_s = zero_s(robot, word)
    robot.wait_for_event("paused")
    first, _, _, last = itertools.islice(turns, 4)
    robot.velocities.all.clear()
    resume_s = drive(robot, resume)
    stop_s = zero_s(robot, "stop")
    ends(robot, {first, last})
    return pause_s, resume_s, stop_s


def main() -> None:
    repetitions = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    pauses = [word for word in ALL.pause if is_pause(word)]
    print(f"{'typed while it drives -> zero in another process':62s} {'median':>11s} {'p99':>10s}")
    with tempfile.TemporaryDirectory() as folder:
        robot, turns = RunningRobot(Path(folder)), itertools.count(1)
        try:
            stopped(robot, turns, MISTYPED[0])
            by_word = {word: [stopped(robot, turns, word) for _ in range(repetitions)] for word in stops()}
            kept = [line(f"stop: {word}", values_s, PROMISED_S) for word, values_s in by_word.items()]
            kept.append(
                line(
                    "every stop wording",
                    [value for values in by_word.values() for value in values],
                    PROMISED_S,
                )
            )
            resumes = itertools.cycle(RESUMES)
            rows = [
                paused(robot, turns, word, next(resumes))
                for word in pauses
                for _ in range(max(1, repetitions // 5))
            ]
        finally:
            robot.close()
    pause_s, resume_s, stop_s = (list(column) for column in zip(*rows))
    kept.append(line("every pause wording", pause_s, PROMISED_S))
    kept.append(line("stop in what was gone on with", stop_s, PROMISED_S))
    line("continue -> motion (rehearsed anew)", resume_s)
    print("promises kept" if all(kept) else "BROKEN: is this machine busy with something else?")


if __name__ == "__main__":
    main()
