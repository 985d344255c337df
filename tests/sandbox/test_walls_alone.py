"""What each wall stops by itself is as docs/sandbox.md says: no wall is there for show, and none is relied on alone."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from attacks import ATTACKS
from witness import Witness

from chatrobot.sandbox.layers import can_make_namespaces
from chatrobot.sandbox.syscalls import this_machine
from chatrobot.sandbox.walls import landlock_version

DOCUMENT = Path(__file__).parents[2] / "docs" / "sandbox.md"
WALLS = ("filter", "Landlock", "namespaces", "limits")
DYING_S = 0.005
LANDLOCK_OF_THE_TABLE = 6
SOURCES = {attack.name: attack.source for attack in ATTACKS}


def documented() -> dict[str, dict[str, bool]]:
    """The table of the document: attack → wall → whether it is stopped."""
    rows = [
        line.strip("|").split("|")
        for line in DOCUMENT.read_text("utf-8").splitlines()
        if line.startswith("| ")
    ]
    cells = [[cell.strip() for cell in row] for row in rows]
    head = next(row for row in cells if row[1:] == list(WALLS))
    return {
        row[0]: {wall: cell == "stopped" for wall, cell in zip(head[1:], row[1:])}
        for row in cells
        if row[0] in SOURCES and len(row) == len(head)
    }


@contextmanager
def runner(wall: str) -> Iterator[Callable[[str, Witness], str]]:
    command = [sys.executable, str(Path(__file__).parent / "alone.py"), wall]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:

        def strike(source: str, witness: Witness) -> str:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write(json.dumps({"source": source, "world": witness.world}) + "\n")
            process.stdin.flush()
            return str(json.loads(process.stdout.readline())[1])

        yield strike
        assert process.stdin is not None
        process.stdin.close()


def is_here(wall: str) -> bool:
    machine = this_machine()
    assert machine is not None
    if wall != "Landlock":
        return wall != "namespaces" or can_make_namespaces()
    try:
        return landlock_version(machine) >= LANDLOCK_OF_THE_TABLE
    except OSError:
        return False


def stopped_by(wall: str, tmp_path: Path) -> dict[str, bool]:
    """Each attack of the table behind this wall alone."""
    stopped: dict[str, bool] = {}
    witness = Witness(tmp_path)
    with runner(wall) as strike:
        for name in documented():
            said = strike(SOURCES[name], witness)
            effects = witness.effects() or (time.sleep(DYING_S), witness.effects())[1]
            stopped[name] = not effects and "LEAK" not in said
            if effects:
                witness.restore()
    witness.close()
    return stopped


@pytest.fixture(scope="module")
def works_here(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """What the machine does not forbid anyway, to this user."""
    stopped = stopped_by("nothing", tmp_path_factory.mktemp("nothing"))
    return {name for name, is_stopped in stopped.items() if not is_stopped}


@pytest.mark.parametrize("wall", WALLS)
def test_a_wall_stops_what_the_table_says(wall: str, works_here: set[str], tmp_path: Path) -> None:
    if this_machine() is None or not is_here(wall):
        pytest.skip("not on this machine")
    measured = stopped_by(wall, tmp_path)
    said = {name: walls[wall] for name, walls in documented().items()}
    assert {name: measured[name] for name in works_here} == {name: said[name] for name in works_here}


def test_the_table_covers_what_matters() -> None:
    assert len(documented()) >= 20
