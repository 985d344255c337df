"""No attack has an effect outside the sandbox, on any level that this machine has."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from attacks import ATTACKS, Attack
from witness import Witness

from chatrobot.sandbox.limits import Layers
from chatrobot.sandbox.process import ExitReport
from chatrobot.sandbox.server import MOST_DESCRIPTORS
from chatrobot.sandbox.walls import find_bubblewrap
from chatrobot.sandbox.warm_server import WarmServer, probe

INSIDE = Path(__file__).parent / "inside"
LEVELS = {
    "minimum": Layers(landlock=False, namespaces=False, bubblewrap=False),
    "landlock": Layers(landlock=True, namespaces=False, bubblewrap=False),
    "namespaces": Layers(landlock=False, namespaces=True, bubblewrap=False),
    "bubblewrap": Layers(landlock=False, namespaces=False, bubblewrap=True),
    "full": Layers(),
}
if find_bubblewrap() is None:
    del LEVELS["bubblewrap"]


@pytest.fixture(scope="module")
def witness(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Witness]:
    witness = Witness(tmp_path_factory.mktemp("outside"))
    yield witness
    witness.close()


@pytest.fixture(scope="module", params=LEVELS)
def server(request: pytest.FixtureRequest, witness: Witness) -> Iterator[WarmServer]:
    """One warm server for all attacks on a level: each of them could spoil it for the next."""
    wanted = LEVELS[request.param]
    os.environ["CHATROBOT_SECRET"] = witness.word
    # A host that has many files open: what it gives to the server has numbers above those that the server may have.
    leaky = [os.open(witness.world["writable"], os.O_RDWR) for _ in range(MOST_DESCRIPTORS)]
    for each in leaky:
        os.set_inheritable(each, True)
    try:
        with WarmServer([INSIDE], ["sandbox_entries"], layers=wanted) as server:
            server.start()
            missing = [name for name in ("landlock", "namespaces", "bubblewrap") if server.problems[name]]
            if request.param in missing or (request.param == "full" and len(missing) > 1):
                pytest.skip(f"not on this machine: {missing}")
            yield server
    finally:
        del os.environ["CHATROBOT_SECRET"]
        for each in leaky:
            os.close(each)


def strike(server: WarmServer, witness: Witness, attack: Attack) -> tuple[ExitReport, str]:
    payload = json.dumps({"source": attack.source, "world": witness.world}).encode()
    with server.launch("sandbox_entries:run_attack", payload, attack.limits) as process:
        report = process.wait(15)
        assert report is not None, "it still runs"
        return report, process.read_logs()


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda attack: attack.name.replace(" ", "_"))
def test_attack(server: WarmServer, witness: Witness, attack: Attack) -> None:
    report, logs = strike(server, witness, attack)

    assert witness.effects() == []
    assert "LEAK" not in logs
    assert witness.word not in logs
    assert server.is_running()
    assert all(letter.isprintable() or letter in "\n\t" for letter in logs)
    if attack.ends == "refused":
        assert report.exit_code not in (None, 0), (report, logs)
    elif attack.ends == "runs":
        assert report.exit_code == 0, (report, logs)
    elif attack.ends == "dies":
        assert report.signal == signal.SIGSYS, (report, logs)
    elif attack.ends == "fails":
        assert report.exit_code != 0, (report, logs)
    else:
        assert report.signal is not None, (report, logs)
    if attack.reason:
        assert report.reason is not None
        assert report.reason.code == attack.reason, (report, logs)
    if attack.finding:
        assert attack.finding in [finding.code for finding in report.findings], (report, logs)


def test_the_server_still_serves_after_all_attacks(server: WarmServer) -> None:
    with server.launch("sandbox_entries:echo", b"still here") as process:
        assert process.channel.recv(100) == b"heard still here"


def test_there_are_enough_attacks() -> None:
    assert len(ATTACKS) >= 40
    assert len({attack.name for attack in ATTACKS}) == len(ATTACKS)


def test_the_level_follows_from_what_stands() -> None:
    minimum = probe(LEVELS["minimum"])
    if minimum.refusal is None:
        assert minimum.level == "minimum"
