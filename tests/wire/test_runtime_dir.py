"""Where the sockets of this user's robots are: what one shell starts another one finds."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from chatrobot.core.errors import WireError
from chatrobot.wire import runtime_dir as module
from chatrobot.wire.runtime_dir import (
    agent_socket_path,
    agent_socket_paths,
    stop_socket_path,
    stop_socket_paths,
)


@pytest.fixture
def shared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder that stands in for /tmp, of a user whom nobody has logged in."""
    folder = tmp_path / "shared"
    folder.mkdir()
    monkeypatch.setattr(module, "SHARED", folder)
    return folder


def test_what_was_started_without_the_variable_is_found_with_it(
    shared: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    if module.runtime_dir().parent != shared:
        pytest.skip("this user has a runtime folder: nothing falls back")
    stop, agents = stop_socket_path(7), agent_socket_path(7)
    stop.touch()
    agents.touch()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert module.runtime_dir().parent == tmp_path
    assert (stop_socket_paths(), agent_socket_paths()) == ([stop], [agents])
    own = agent_socket_path(8)
    own.touch()
    os.utime(own, (0, 0))
    assert agent_socket_paths() == [own, agents], "an agent goes to the console beside it, however old"


def test_a_folder_of_somebody_else_is_neither_used_nor_looked_into(
    shared: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    other = os.getuid() + 54_321
    monkeypatch.setattr(os, "getuid", lambda: other)
    (shared / f"chatrobot-{other}").mkdir()
    (shared / f"chatrobot-{other}" / "motion-7.stop").touch()
    assert stop_socket_paths() == []
    with pytest.raises(WireError, match="not ours"):
        module.runtime_dir()
