"""Keys come from the environment or the keyring; a system without a safe keyring says so and keeps none."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from chatrobot.models import keys
from chatrobot.models.config import ModelConfig
from chatrobot.models.providers import providers
from chatrobot.models.secret import Secret
from tests.models.rig import KEY

OPENAI = providers()["openai"]


class Backend:
    """A keyring in memory."""

    priority = 5.0
    name = "memory"

    def __init__(self) -> None:
        self.kept: dict[tuple[str, str], str] = {}
        self.is_locked = False

    def get_password(self, service: str, name: str) -> str | None:
        self._check()
        return self.kept.get((service, name))

    def set_password(self, service: str, name: str, value: str) -> None:
        self._check()
        self.kept[service, name] = value

    def delete_password(self, service: str, name: str) -> None:
        self._check()
        del self.kept[service, name]

    def _check(self) -> None:
        if self.is_locked:
            raise LockedError(f"locked; the key was {KEY}")


class LockedError(Exception):
    """What a keyring raises that does not open."""


def install(monkeypatch: pytest.MonkeyPatch, backend: Any) -> None:
    keyring: Any = ModuleType("keyring")
    errors: Any = ModuleType("keyring.errors")
    errors.KeyringError = LockedError
    keyring.get_keyring = lambda: backend
    for method in ("get_password", "set_password", "delete_password"):
        setattr(keyring, method, getattr(backend, method, None))
    monkeypatch.setitem(sys.modules, "keyring", keyring)
    monkeypatch.setitem(sys.modules, "keyring.errors", errors)


def test_a_key_is_kept_in_the_keyring_and_the_environment_goes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    install(monkeypatch, Backend())
    bare = ModelConfig(environ={})
    assert keys.find_key(OPENAI, bare) is None
    keys.store_key(OPENAI, Secret(KEY))
    found = keys.find_key(OPENAI, bare)
    assert found is not None
    assert (found.reveal(), keys.where_key_is(OPENAI, bare), keys.keyring_name()) == (
        KEY,
        "keyring",
        "memory",
    )
    both = ModelConfig(environ={"OPENAI_API_KEY": "sk-other"})
    assert (keys.find_key(OPENAI, both) or Secret("")).reveal() == "sk-other"
    assert keys.where_key_is(OPENAI, both) == "environment"
    keys.delete_key(OPENAI)
    assert keys.where_key_is(OPENAI, bare) == ""


@pytest.mark.parametrize(
    "backend",
    [
        SimpleNamespace(priority=0, name="fail"),
        type("Plaintext", (Backend,), {"__module__": "keyrings.alt.file"})(),
        type("Chain", (), {"__module__": "keyring.backends.chainer", "priority": 10, "backends": []})(),
    ],
)
def test_a_system_without_a_safe_keyring_keeps_no_key(monkeypatch: pytest.MonkeyPatch, backend: Any) -> None:
    install(monkeypatch, backend)
    with pytest.raises(keys.KeyringError, match="environment variable") as caught:
        keys.store_key(OPENAI, Secret(KEY))
    assert KEY not in str(caught.value)
    assert keys.find_key(OPENAI, ModelConfig(environ={})) is None
    assert keys.keyring_name() == ""


def test_a_keyring_that_stays_locked_is_told_without_the_key(monkeypatch: pytest.MonkeyPatch) -> None:
    backend = Backend()
    backend.is_locked = True
    install(monkeypatch, backend)
    with pytest.raises(keys.KeyringError, match="does not open") as caught:
        keys.store_key(OPENAI, Secret(KEY))
    assert KEY not in str(caught.value)
    assert keys.find_key(OPENAI, ModelConfig(environ={})) is None


def test_without_the_extra_it_says_how_to_get_a_keyring(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "keyring", None)
    with pytest.raises(keys.KeyringError, match="pip install"):
        keys.store_key(OPENAI, Secret(KEY))
    assert keys.keyring_name() == ""
    assert keys.find_key(OPENAI, ModelConfig(environ={})) is None


def test_the_real_keyring_of_a_headless_machine_is_handled(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    keyring = pytest.importorskip("keyring")
    from keyring.backends.fail import Keyring

    monkeypatch.setattr(keyring, "get_keyring", Keyring)
    with pytest.raises(keys.KeyringError, match="environment variable"):
        keys.store_key(OPENAI, Secret(KEY))
    assert not list(tmp_path.iterdir())
