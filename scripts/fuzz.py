"""Feed the governor what nobody should: `make fuzz`, or `python -m scripts.fuzz --sequences N --seed S --jobs J`.

A plain seeded generator of sequences of 50 commands, over all profiles: NaN, infinities, denormals, huge numbers,
clocks that go back, interleaved sources, sources that die, leases that end, stops, latches, scans, velocities held
back and sent late. After each command it is checked that what a transport would send is finite and within the
profile's speed and (zero exempt) acceleration, that nothing moves after a stop, a latch or the end of a lease, and
that a robot in contact with something goes slowly, and nearer to nothing.
"""

from __future__ import annotations

import argparse
import math
import multiprocessing
import random
import sys
import time
from dataclasses import dataclass

from scripts.fuzz_contact import broken_in_contact
from scripts.fuzz_limits import BrokenPromiseError, Sent
from scripts.fuzz_robots import profiles

from chatrobot.core.clock import TICK_S
from chatrobot.core.geometry import Pose, Twist
from chatrobot.core.governed import GovernedTwist, StopEpoch
from chatrobot.governor.governor import Governor
from chatrobot.governor.rule import Sensed
from chatrobot.robots.profile import RobotProfile
from chatrobot.wire.messages import LaserScan

COMMANDS = 50
CHUNK = 500
"""Sequences a worker does at a time; a chunk is named by its seed, so a finding can be done again alone."""

TERM_S = 0.3
NASTY = (
    math.nan, math.inf, -math.inf, 5e-324, -5e-324, 2.2e-308, 1e308, -1e308, 1.7976931348623157e308, 0.0, -0.0,
    1e-9, -1e-9, 99.0, -99.0, 1e15,
)  # fmt: skip
SOURCES = ("joystick", "stick", "console", "agent", "chatgpt_node", "nobody has heard of")
LEASES = tuple(f"lease of {source}" for source in SOURCES)


@dataclass
class Source:
    """What the fuzzer itself knows of a source: when it last beat, whether it ended, and whether it may move."""

    lease_id: str
    beat_s: float = -math.inf
    ended: bool = True
    may_move: bool = False

    def is_alive(self, now_s: float) -> bool:
        return not self.ended and abs(now_s - self.beat_s) <= TERM_S


class Sequence:
    """One sequence against one governor, with a model of its own of what may be sent."""

    def __init__(self, profile: RobotProfile, chance: random.Random) -> None:
        self.profile = profile
        self.chance = chance
        self.epoch = StopEpoch()
        self.governor = Governor(profile, self.epoch)
        self.sources = [Source(lease_id) for lease_id in LEASES]
        self.now_s = 100.0
        self.latched = False
        self.stops = 0
        self.before = Sent(profile)
        self.held_back: list[tuple[GovernedTwist, int]] = []
        self.scans_left = 1

    def run(self) -> None:
        self.open(self.chance.choice(self.sources))
        if self.chance.random() < 0.5:
            self.governor.take_scan(_good_scan(self.chance), Pose())
        for _ in range(COMMANDS):
            self._command(self.chance.random())

    def _command(self, dice: float) -> None:
        """Three commands of four ask for a velocity; the rest meddles."""
        chance = self.chance
        if dice < 0.76:
            self._pass_time()
            source = chance.choice(self.sources) if dice < 0.08 else self._driver()
            self.ask(source, self._twist())
        elif dice < 0.83:
            self.begin(chance.choice(self.sources))
        elif dice < 0.88:
            self.open(chance.choice(self.sources))
        elif dice < 0.91:
            self.end(chance.choice(self.sources))
        elif dice < 0.93:
            self.stop()
        elif dice < 0.936:
            self.latch()
            if chance.random() < 0.8:
                self.stop()
        elif dice < 0.96:
            self.release()
        elif dice < 0.98:
            self.send_late()
        elif dice < 0.99:
            self.scan()
        else:
            self.narrow()

    # --- what is done to it ---

    def _driver(self) -> Source:
        """Whoever may move beats and asks; else anybody, who mostly begins first."""
        for source in self.sources:
            if source.may_move:
                if self.chance.random() < 0.9:
                    self.beat(source)
                return source
        source = self.chance.choice(self.sources)
        if self.chance.random() < 0.8:
            if source.ended:
                self.open(source)
            self.begin(source)
        return source

    def _pass_time(self) -> None:
        dice = self.chance.random()
        if dice < 0.7:
            self.now_s += TICK_S
        elif dice < 0.9:
            self.now_s += self.chance.random() * 0.1
        elif dice < 0.95:
            self.now_s += self.chance.random() * 5.0
        elif dice < 0.99:
            self.now_s -= self.chance.random() * 2.0
        else:
            self.now_s += self.chance.choice((0.0, 1e-12, 3600.0, -3600.0))

    def open(self, source: Source) -> None:
        source_name = SOURCES[LEASES.index(source.lease_id)]
        self.governor.leases.open(source.lease_id, source_name, TERM_S, self.now_s)
        source.beat_s, source.ended = self.now_s, False

    def beat(self, source: Source) -> None:
        self.governor.leases.beat(source.lease_id, self.now_s)
        source.beat_s = self.now_s

    def begin(self, source: Source) -> None:
        sensed = self._sensed()
        if self.governor.begin(source.lease_id, self.now_s, sensed).refusal is not None:
            return
        if self.latched:
            raise BrokenPromiseError("a motion began under an emergency stop")
        if not source.is_alive(self.now_s):
            raise BrokenPromiseError("a motion began without a lease")
        rank = self.sources.index(source)
        for other_rank, other in enumerate(self.sources):
            if other is not source and other.may_move and other.is_alive(self.now_s) and other_rank <= rank:
                raise BrokenPromiseError("a source took over from one that goes before it")
            other.may_move = other is source

    def end(self, source: Source) -> None:
        if self.chance.random() < 0.5:
            self.governor.leases.end(source.lease_id)
            source.ended = True
        self.governor.end(source.lease_id)
        source.may_move = False

    def latch(self) -> None:
        self.governor.latch("fuzz", "")
        self.latched = True

    def stop(self) -> None:
        self.epoch.stop()
        self.stops += 1
        for source in self.sources:
            source.may_move = False
        self.before.stop()

    def release(self) -> None:
        """An agent tries and must fail; a person mostly may."""
        self.governor.release("agent")
        if self.chance.random() < 0.7:
            self.governor.release("console")
            self.latched = False

    def send_late(self) -> None:
        """A transport's thread that slept: what it holds may go out only if no stop came since."""
        for governed, stops in self.held_back:
            if governed.epoch == self.epoch.value and stops != self.stops:
                raise BrokenPromiseError("a velocity of before a stop went out after it")
        self.held_back.clear()

    def scan(self) -> None:
        if self.scans_left == 0:
            return
        self.scans_left -= 1
        ranges = [self._range() for _ in range(12)]
        step = self.chance.choice((math.tau / 12, math.tau / 12, 0.1, -0.3, 0.0, math.nan))
        self.governor.take_scan(
            LaserScan(self.now_s, -math.pi, step, 0.1, 8.0, ranges), self._pose() or Pose()
        )

    def _range(self) -> float:
        dice = self.chance.random()
        if dice < 0.3:
            return self.chance.choice(NASTY)
        if dice < 0.5:  # where the robot touches it, or nearly
            return self.profile.footprint_radius_m + self.chance.uniform(-0.06, 0.06)
        return self.chance.random() * 3.0

    def narrow(self) -> None:
        speed = self.chance.random() * 1.5
        self.governor.narrow(speed, 2.0 * speed)
        self.before.narrow(speed, 2.0 * speed)

    def _pose(self) -> Pose | None:
        dice = self.chance.random()
        if dice < 0.05:
            return None
        if dice < 0.08:
            return Pose(self.chance.choice(NASTY), 0.0, self.chance.choice(NASTY))
        return Pose(dice, 0.5 - dice, 7.0 * dice)

    def _sensed(self) -> Sensed:
        dice = self.chance.random()
        ages = {"odom": dice * 0.32, "scan": dice * 0.52, "imu": dice * 0.32}
        return Sensed(ages, None if dice < 0.5 else 100.0 * dice)

    def _twist(self) -> Twist:
        chance, limits = self.chance, self.profile.limits
        dice = chance.random()
        if dice < 0.1:
            return Twist(chance.choice(NASTY), chance.choice(NASTY), chance.choice(NASTY))
        if dice < 0.2:
            return Twist(chance.uniform(-9, 9), chance.uniform(-9, 9), chance.uniform(-9, 9))
        if dice < 0.3:
            return Twist()
        most, turn = limits.max_speed_mps, limits.max_rate_radps
        return Twist(chance.uniform(-most, most), chance.uniform(-most, most), chance.uniform(-turn, turn))

    # --- what must hold ---

    def ask(self, source: Source, asked: Twist) -> None:
        """A source asks for a velocity, and what a transport would make of the answer is checked."""
        pose = self._pose()
        verdict = self.governor.govern(asked, source.lease_id, self.now_s, pose, self._sensed())
        governed = verdict.sent
        if pose is not None and not verdict.allowed.is_zero:
            broken = broken_in_contact(
                self.profile, self.governor.seen_points.tolist(), verdict.allowed, pose
            )
            if broken:
                raise BrokenPromiseError(broken)
        if governed.epoch != self.epoch.value:
            if verdict.rule != "outranked":
                raise BrokenPromiseError(f"{verdict.rule} made a velocity that is void from the start")
            return
        if self.chance.random() < 0.05:
            self.held_back.append((governed, self.stops))
        self._check(governed.twist, source)
        self.before.note(governed.twist, self.now_s)

    def _check(self, sent: Twist, source: Source) -> None:
        vx, vy, wz = sent
        if not sent.is_finite:
            raise BrokenPromiseError(f"not finite: {sent}")
        if vx == 0.0 and vy == 0.0 and wz == 0.0:
            return  # zero is exempt
        if self.latched:
            raise BrokenPromiseError("motion under an emergency stop")
        if not source.is_alive(self.now_s):
            raise BrokenPromiseError("motion after the end of a lease")
        if not source.may_move:
            raise BrokenPromiseError("motion after a stop, or of a source that did not begin")
        self.before.check(sent, self.now_s)


def _good_scan(chance: random.Random) -> LaserScan:
    """All around, something here and there."""
    ranges = [0.3 + 4.0 * chance.random() if chance.random() < 0.3 else math.inf for _ in range(16)]
    return LaserScan(100.0, -math.pi, math.tau / 16, 0.1, 8.0, ranges)


def run_chunk(seed: int, sequences: int) -> str:
    """Empty if all held; else what broke, and how to do it again."""
    robots = profiles()
    for number in range(sequences):
        chance = random.Random(seed * 1_000_003 + number)
        profile = robots[number % len(robots)]
        try:
            Sequence(profile, chance).run()
        except BrokenPromiseError as broken:
            return f"{profile.name}: {broken} (chunk {seed}, sequence {number})"
    return ""


def _work(job: tuple[int, int]) -> str:
    return run_chunk(*job)


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sequences", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    chunks = math.ceil(options.sequences / CHUNK)
    last = options.sequences - (chunks - 1) * CHUNK
    jobs = [(options.seed * 1_000_000 + i, last if i == chunks - 1 else CHUNK) for i in range(chunks)]
    began_s = time.monotonic()
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        for done, broken in enumerate(pool.imap_unordered(_work, jobs), start=1):
            if broken:
                print(broken)
                return 1
            if done % 20 == 0 and sys.stderr.isatty():
                print(f"\r{done * CHUNK} sequences", end="", file=sys.stderr)
    took_s = time.monotonic() - began_s
    print(
        f"{options.sequences} sequences of {COMMANDS} commands held in {took_s:.1f} s ({options.jobs} jobs)"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
