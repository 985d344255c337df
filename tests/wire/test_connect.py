"""A wire by its address."""

from __future__ import annotations

import builtins
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from chatrobot.core.errors import UsageError, WireError
from chatrobot.core.wiring import Wiring
from chatrobot.wire.connect import connect_wire
from chatrobot.wire.local import LocalHub, LocalWire
from chatrobot.wire.messages import TwistMessage


@pytest.mark.parametrize("prefix", ["", "local:"])
def test_a_path_is_a_local_wire(tmp_path: Path, prefix: str) -> None:
    hub = LocalHub(tmp_path / "wire")
    wire = connect_wire(f"{prefix}{tmp_path}/wire", Wiring(), "test")
    assert isinstance(wire, LocalWire)
    wire.close()
    hub.close()


def test_a_local_wire_finds_its_listeners_at_once(tmp_path: Path) -> None:
    hub = LocalHub(tmp_path / "wire")
    wire = connect_wire(f"local:{tmp_path}/wire", Wiring(), "test")
    wire.advertise("cmd_vel", TwistMessage)
    assert wire.wait_for_listener("cmd_vel", TwistMessage, 0.0)
    assert wire.publishers_of("cmd_vel") == []
    assert not wire.comes_back
    wire.close()
    hub.close()


def test_where_nobody_serves_it_says_so(tmp_path: Path) -> None:
    with pytest.raises(WireError, match="no robot answers"):
        connect_wire(f"local:{tmp_path}/wire", Wiring(), "test")


@pytest.mark.parametrize(
    "address",
    [
        "",
        "local:",
        "sim",
        "dds://233",
        "dds://x",
        "dds:42",
        "dds://1/2robot",
        "rosbridge:",
        "rosbridge:robot:9090",
    ],
)
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(UsageError):
        connect_wire(address, Wiring(), "test")


@pytest.mark.parametrize(
    ("address", "module", "extra"),
    [
        ("dds:", "chatrobot.wire.dds.wire", "[dds]"),
        ("rosbridge:ws://r", "chatrobot.wire.rosbridge.wire", "[rosbridge]"),
    ],
)
def test_what_is_not_installed_is_named_with_the_way_to_get_it(
    monkeypatch: pytest.MonkeyPatch, address: str, module: str, extra: str
) -> None:
    real: Callable[..., Any] = builtins.__import__

    def missing(name: str, *more: Any) -> Any:
        if name == module:
            raise ModuleNotFoundError("No module named 'it'", name="it")
        return real(name, *more)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(UsageError) as caught:
        connect_wire(address, Wiring(), "test")
    assert f"pip install 'chatrobot{extra}'" in caught.value.allowed
