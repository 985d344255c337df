"""Changes the safety code in every way a tool can think of; the tests must notice, or the list must say why not.

Run: make mutants. It fails where no test notices a mutant that tests/safety/surviving_mutants.yaml does not argue.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).parent.parent
ARGUED = ROOT / "tests" / "safety" / "surviving_mutants.yaml"
AT_ONCE = "2"
UNNOTICED = ("survived", "no tests", "suspicious")


@dataclass(frozen=True, order=True)
class Mutant:
    """One change: of which function (`governor.kernel.bounded`), from which line to which."""

    where: str
    was: str
    becomes: str

    def __str__(self) -> str:
        return f"{self.where}\n    - {self.was}\n    + {self.becomes}"


def argued() -> dict[Mutant, str]:
    """The mutants that may survive, with the reason."""
    found = {}
    for group in yaml.safe_load(ARGUED.read_text(encoding="utf-8")):
        for where, was, becomes in group["mutants"]:
            found[Mutant(where, was, becomes)] = group["why"]
    return found


def unnoticed() -> set[Mutant]:
    """Those that the last run of mutmut left alive."""
    names = []
    for line in _mutmut("results").splitlines():
        name, _, fate = line.strip().rpartition(": ")
        if fate in UNNOTICED:
            names.append(name)
    return {_shown(name) for name in names}


def _shown(name: str) -> Mutant:
    was, becomes = [], []
    for line in _mutmut("show", name).splitlines():
        if line.startswith("-") and not line.startswith("---"):
            was.append(line[1:].strip())
        if line.startswith("+") and not line.startswith("+++"):
            becomes.append(line[1:].strip())
    return Mutant(_where(name), " ".join(was), " ".join(becomes))


def _where(name: str) -> str:
    """`chatrobot.governor.obstacle_memory.xǁSeenǁtake__mutmut_3` is a change of `governor.seen.Seen.take`."""
    module, _, mangled = name.removeprefix("chatrobot.").rpartition(".")
    function = mangled.rpartition("__mutmut_")[0].removeprefix("x")
    parts = function.split("ǁ")[1:] if "ǁ" in function else [function.removeprefix("_")]
    return ".".join([module, *parts])


def _mutmut(*arguments: str) -> str:
    command = [str(Path(sys.executable).parent / "mutmut"), *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout


def main() -> int:
    subprocess.run(
        [str(Path(sys.executable).parent / "mutmut"), "run", "--max-children", AT_ONCE], cwd=ROOT, check=True
    )
    found, known = unnoticed(), argued()
    new, gone = sorted(found - known.keys()), sorted(known.keys() - found)
    for mutant in new:
        print(f"nobody noticed {mutant}")
    for mutant in gone:
        print(f"noticed now, and may leave the list: {mutant}")
    print(f"{len(found)} survive, {len(found) - len(new)} of them argued in {ARGUED.relative_to(ROOT)}")
    return 1 if new else 0


if __name__ == "__main__":
    sys.exit(main())
