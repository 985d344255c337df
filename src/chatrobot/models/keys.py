"""Finds keys: in an environment variable, or in the keyring of the user's desktop. Never in a plain file.

Without a desktop (over ssh, in a container, on a robot) there is usually no keyring: then the environment is the place.
"""

from __future__ import annotations

import importlib
from typing import Any

from chatrobot.core.errors import ChatRobotError
from chatrobot.models.config import ModelConfig
from chatrobot.models.providers import Provider
from chatrobot.models.secret import Secret

SERVICE = "chatrobot"


class KeyringError(ChatRobotError):
    """Raised where there is no keyring, or it does not open. `str` says so without any key."""


def find_key(provider: Provider, config: ModelConfig) -> Secret | None:
    """Return the key for that provider: from its environment variable, else from the keyring, else None."""
    if value := config.variable(*provider.key_variables):
        return Secret(value)
    if not config.keyring or not provider.key_variables:
        return None
    try:
        value = _call("get_password", provider)
    except KeyringError:
        return None
    return Secret(value) if value else None


def where_key_is(provider: Provider, config: ModelConfig) -> str:
    """Return `environment`, `keyring`, or "" for nowhere."""
    if config.variable(*provider.key_variables):
        return "environment"
    return "keyring" if find_key(provider, config) is not None else ""


def store_key(provider: Provider, secret: Secret) -> None:
    """Put the key into the keyring.

    Raises:
        KeyringError: no keyring, or it does not open.
    """
    _call("set_password", provider, secret.reveal())


def delete_key(provider: Provider) -> None:
    """Take the key out of the keyring.

    Raises:
        KeyringError: no keyring, or nothing in it.
    """
    _call("delete_password", provider)


def keyring_name() -> str:
    """Return what the keyring here is called, or "" where there is none that keeps anything safely."""
    try:
        keyring = importlib.import_module("keyring")
    except ImportError:
        return ""
    backend = keyring.get_keyring()
    # Backends that keep keys in a plain file, or keep nothing, are worse than none.
    return "" if _is_unsafe(backend) else str(backend.name)


def _is_unsafe(backend: Any) -> bool:
    module = type(backend).__module__
    if module == "keyring.backends.chainer":  # the first of several that takes the key
        return not backend.backends or _is_unsafe(backend.backends[0])
    return backend.priority <= 0 or module.startswith(
        ("keyring.backends.fail", "keyring.backends.null", "keyrings.alt")
    )


def _call(method: str, provider: Provider, *arguments: str) -> Any:
    try:
        keyring = importlib.import_module("keyring")
        errors = importlib.import_module("keyring.errors")
    except ImportError:
        raise KeyringError(
            "keyring is not installed. Install it (pip install 'chatrobot[models]'), or use the environment variable"
        ) from None
    if _is_unsafe(keyring.get_keyring()):
        raise KeyringError("This system has no keyring that keeps a key safely. Use the environment variable")
    try:
        return getattr(keyring, method)(SERVICE, provider.key_variables[0], *arguments)
    except errors.KeyringError as error:
        kind = type(error).__name__
        raise KeyringError(f"The keyring does not open ({kind}). Use the environment variable") from None
