"""Does the robot know where it is after a long session? Run: python -m scripts.soak --seeds 100

Plays sessions of 30 random turns (motion, questions, waits, stops in mid-motion, undo) with the default robot and no
faults, and compares the pose that was told with the simulated robot's true pose: after every turn, and at the end.
The bound is 2 cm and 0.5 % of the way driven, and 1 degree. The session of a seed is always the same.

    python -m scripts.soak --seeds 100                     simulated time, both worlds
    python -m scripts.soak --real --busy 2 --seeds 10      real time beside two busy processes
    python -m scripts.soak --seed 17 --seeds 1 --world home --show      every turn of one session
"""

from __future__ import annotations

import argparse
import contextlib
import math
import multiprocessing
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from chatrobot.compose import Connection, Setup, connect
from chatrobot.core.events import Event, Result, TruePose
from chatrobot.dialogue.options import Options

TURNS = 30
WORLDS = ("empty", "home")
BOUND_M, BOUND_SHARE, BOUND_DEG = 0.02, 0.005, 1.0
STANDS_S = 0.3
"""The truth is read so long after the end of a turn was told."""
PATIENCE_S = 120.0
UNDO = True
"""Whether sessions take turns back where nobody says."""


@dataclass(frozen=True)
class Turn:
    """What is said, and after how long a motion is stopped (None: it is left to end)."""

    text: str
    stop_after_s: float | None = None


@dataclass
class Session:
    """What became of one session."""

    seed: int
    off_m: float = 0.0
    off_deg: float = 0.0
    worst_turn_m: float = 0.0
    worst_turn_deg: float = 0.0
    path_m: float = 0.0
    outcomes: dict[str, int] = field(default_factory=dict)

    @property
    def is_within(self) -> bool:
        return self.off_m <= BOUND_M + BOUND_SHARE * self.path_m and self.off_deg <= BOUND_DEG

    def note(self, told: Result, true: TruePose) -> None:
        """A turn has ended, as told and in truth."""
        pose = told.pose
        self.path_m += told.path_m
        self.outcomes[told.outcome] = self.outcomes.get(told.outcome, 0) + 1
        self.off_m = math.hypot(pose.x_m - true.x_m, pose.y_m - true.y_m)
        self.off_deg = abs(math.degrees(math.remainder(pose.yaw_rad - true.yaw_rad, math.tau)))
        self.worst_turn_m = max(self.worst_turn_m, self.off_m)
        self.worst_turn_deg = max(self.worst_turn_deg, self.off_deg)


# --- what is said ---


def turns_of(world: str, seed: int, undo: bool) -> list[Turn]:
    """The turns of that session."""
    chance = random.Random(f"soak {seed}")
    kinds: list[tuple[int, Callable[[random.Random], Turn]]] = [
        (5, _drive),
        (5, _rotate),
        (3, _curve),
        (2, _several),
        (1, _timed),
        (8, _stopped),
        (4, _asked),
        (3, _waited),
        *([(2, _undone)] if undo else []),
        *([(2, _place)] if world == "home" else []),
    ]
    weights, makers = [weight for weight, _ in kinds], [maker for _, maker in kinds]
    return [maker(chance) for maker in chance.choices(makers, weights, k=TURNS)]


def _drive(chance: random.Random) -> Turn:
    way = chance.choice(["forward", "forward", "back", "left", "right"])
    speed = chance.choice(["", "", " at 0.15 m/s", " at 0.6 m/s"])
    return Turn(f"{way} {chance.randint(5, 150)} cm{speed}")


def _rotate(chance: random.Random) -> Turn:
    side, rate = chance.choice(["left", "right"]), chance.choice(["", "", " at 0.2 rad/s", " at 1.5 rad/s"])
    return Turn(f"turn {side} {chance.choice([5, 10, 30, 45, 90, 90, 135, 180, 270])} degrees{rate}")


def _curve(chance: random.Random) -> Turn:
    side, radius_m = chance.choice(["left", "right"]), chance.choice([0.3, 0.5, 0.8])
    return Turn(f"arc {side} {chance.choice([45, 90, 180])} degrees with radius {radius_m} m")


def _several(chance: random.Random) -> Turn:
    side = chance.choice(["left", "right"])
    return Turn(
        chance.choice(
            [
                f"drive a square with sides of {chance.choice([30, 50, 80])} cm",
                f"forward {chance.randint(10, 60)} cm, then turn {side} {chance.randint(20, 160)} degrees",
                f"turn {side} {chance.randint(10, 90)} degrees, wait 1 second, then back {chance.randint(10, 40)} cm",
            ]
        )
    )


def _timed(chance: random.Random) -> Turn:
    wz_radps = chance.choice([-0.8, -0.3, 0.3, 0.8])
    return Turn(f"drive at 0.2 m/s while turning left at {wz_radps} rad/s for {chance.randint(1, 4)} s")


def _stopped(chance: random.Random) -> Turn:
    text = chance.choice(["forward 3 m", "turn left 300 degrees", "arc right 300 degrees with radius 0.5 m"])
    return Turn(text, round(chance.uniform(0.1, 4.0), 2))


def _asked(chance: random.Random) -> Turn:
    return Turn(chance.choice(["where are you?", "how far have you driven?", "what can you do?"]))


def _waited(chance: random.Random) -> Turn:
    return Turn(f"wait {chance.choice([0.5, 1, 2, 5])} seconds")


def _place(chance: random.Random) -> Turn:
    return Turn(f"go to the {chance.choice(['kitchen', 'door', 'sofa', 'desk'])}")


def _undone(_chance: random.Random) -> Turn:
    return Turn("undo")


# --- how it is played ---


class Player:
    """One session with a robot, in simulated or in real time."""

    def __init__(self, world: str, *, real: bool, folder: Path, sim: str = "") -> None:
        self._true: TruePose | None = None
        self._real = real
        options = Options(interpreter="offline")
        setup = Setup(fast=not real, trace=True, world=world, sim=sim, folder=folder, options=options)
        self._connection: Connection = connect(setup, self._hear)
        self._session = self._connection.session

    def close(self) -> None:
        self._connection.close()

    def play(self, turn: Turn) -> Result:
        """See one turn through."""
        number = self._session.say(turn.text)
        if turn.stop_after_s is not None:
            self.live(turn.stop_after_s)
            self._session.say("stop")
        results = self._session.results
        self._pump_until(lambda: number in results and self._session.is_idle, PATIENCE_S)
        return results[number]

    def live(self, duration_s: float) -> None:
        """Let time pass."""
        with contextlib.suppress(TimeoutError):
            self._pump_until(lambda: False, duration_s)

    @property
    def true(self) -> TruePose:
        """Where the robot really is."""
        assert self._true is not None
        return self._true

    def _now_s(self) -> float:
        return time.monotonic() if self._real else (self._true.t_s if self._true is not None else 0.0)

    def _pump_until(self, done: Callable[[], bool], patience_s: float) -> None:
        ends_s = self._now_s() + patience_s
        while not done():
            if self._now_s() >= ends_s - 1e-6:
                raise TimeoutError
            self._session.pump(0.02)

    def _hear(self, event: Event) -> None:
        if isinstance(event, TruePose):
            self._true = event


def play(
    world: str, seed: int, *, real: bool = False, undo: bool = UNDO, sim: str = "", show: bool = False
) -> Session:
    """The session of that seed, from beginning to end."""
    session = Session(seed)
    with tempfile.TemporaryDirectory() as folder:
        player = Player(world, real=real, folder=Path(folder), sim=sim)
        try:
            for turn in turns_of(world, seed, undo):
                told = player.play(turn)
                player.live(STANDS_S)
                session.note(told, player.true)
                if show:
                    _show(turn, told, session)
        finally:
            player.close()
    return session


def _show(turn: Turn, told: Result, session: Session) -> None:
    stopped = f", stop after {turn.stop_after_s} s" if turn.stop_after_s is not None else ""
    said = f"{turn.text}{stopped}"
    why = f"   {told.reply}" if told.outcome in ("failed", "unclear") else ""
    print(f"{said:60s} {told.outcome:10s} {session.off_m * 1e3:7.2f} mm {session.off_deg:7.3f} deg{why}")


# --- what is printed ---


def _busy() -> None:
    while True:
        pass


@contextlib.contextmanager
def beside(count: int) -> Iterator[None]:
    """So many processes that compute for ever."""
    context = multiprocessing.get_context("spawn")
    processes = [context.Process(target=_busy, daemon=True) for _ in range(count)]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.join()


def p95(values: list[float]) -> float:
    return sorted(values)[math.ceil(0.95 * len(values)) - 1]


def row(world: str, sessions: list[Session]) -> str:
    """A line of the table."""
    ends_m, ends_deg = [s.off_m for s in sessions], [s.off_deg for s in sessions]
    outside = [s.seed for s in sessions if not s.is_within]
    path_m = sum(s.path_m for s in sessions) / len(sessions)
    return (
        f"{world:6s} {len(sessions):5d} {path_m:8.1f} "
        f"{max(ends_m) * 1e3:9.2f} {p95(ends_m) * 1e3:9.2f} {max(ends_deg):9.3f} {p95(ends_deg):9.3f} "
        f"{max(s.worst_turn_m for s in sessions) * 1e3:9.2f} {max(s.worst_turn_deg for s in sessions):9.3f}   "
        f"{outside or 'none'}"
    )


HEADER = (
    "       seeds   path m  worst mm    p95 mm worst deg   p95 deg    any mm   any deg   outside\n"
    "                       (at the end of the session)              (after any turn)"
)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=100, help="how many sessions a world")
    parser.add_argument("--seed", type=int, default=0, help="the first of them")
    parser.add_argument("--world", choices=WORLDS, action="append", help="only this one")
    parser.add_argument("--fast", action="store_true", help="simulated time; it is the default")
    parser.add_argument("--real", action="store_true", help="real time, with every process there is")
    parser.add_argument("--busy", type=int, default=0, help="so many busy processes beside it")
    parser.add_argument("--undo", action=argparse.BooleanOptionalAction, default=UNDO)
    parser.add_argument("--sim", default="", help="how the robot lies, as for chatrobot: nothing is promised")
    parser.add_argument("--show", action="store_true", help="every turn")
    options = parser.parse_args(arguments)
    print(HEADER, flush=True)
    all_within = True
    with beside(options.busy):
        for world in options.world or WORLDS:
            sessions = []
            for seed in range(options.seed, options.seed + options.seeds):
                sessions.append(
                    play(
                        world, seed, real=options.real, undo=options.undo, sim=options.sim, show=options.show
                    )
                )
                if options.real:
                    print(row(world, sessions[-1:]), flush=True)
            print(row(world, sessions), flush=True)
            outcomes = sorted({name for s in sessions for name in s.outcomes})
            print(
                "       " + ", ".join(f"{sum(s.outcomes.get(n, 0) for s in sessions)} {n}" for n in outcomes)
            )
            all_within = all_within and all(s.is_within for s in sessions)
    return 0 if all_within or options.sim else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
