"""A warm server starts quickly, forks quickly, and takes all with it when it goes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from chatrobot.box.limits import BoxLimits
from chatrobot.box.warm_server import WarmServer
from chatrobot.core.errors import BoxError

INSIDE = Path(__file__).parent / "inside"


@pytest.fixture(scope="module")
def server() -> Iterator[WarmServer]:
    with WarmServer([INSIDE], ["box_entries"], BoxLimits(cpu_s=5, wall_s=10)) as server:
        server.start()
        yield server


def output_of(server: WarmServer, source: str) -> str:
    with server.launch("box_entries:run_source", source.encode()) as process:
        report = process.wait(10)
        assert report is not None
        assert report.exit_code == 0, process.read_logs()
        return process.read_logs()


def test_a_program_gets_its_payload_and_a_channel(server: WarmServer) -> None:
    with server.launch("box_entries:echo", b"hello") as process:
        assert process.channel.recv(100) == b"heard hello"
        report = process.wait(5)
        assert report is not None
        assert (report.exit_code, report.signal, report.reason) == (0, None, None)


def test_a_large_payload_arrives_whole(server: WarmServer) -> None:
    with server.launch("box_entries:echo", b"x" * 3_000_000) as process:
        arrived = 0
        while part := process.channel.recv(1 << 20):
            arrived += len(part)
        assert arrived == 3_000_006


def test_a_child_that_does_not_find_its_entry_says_so(server: WarmServer) -> None:
    with server.launch("box_entries:nothing") as process:
        report = process.wait(5)
        assert report is not None
        assert report.exit_code not in (0, None)
        assert "nothing" in process.read_logs()


def test_no_server_no_launch() -> None:
    with pytest.raises(BoxError) as caught:
        WarmServer().launch("box_entries:echo")
    assert caught.value.reason.code == "box_does_not_start"


def test_a_module_that_cannot_be_imported_is_named() -> None:
    with pytest.raises(BoxError, match="no_such_module"):
        WarmServer(preload=["no_such_module"]).start()
