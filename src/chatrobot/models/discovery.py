"""Finds model servers on this machine, asking the usual ports of loopback all at once; lists the models of a server."""

from __future__ import annotations

import http.client
import json
import threading
from dataclasses import dataclass
from typing import Any
from urllib.parse import SplitResult, urlsplit

from chatrobot.models.config import ModelConfig
from chatrobot.models.providers import LOCAL, Provider, providers
from chatrobot.models.secret import Secret

PROBE_S = 0.4
LIST_S = 10.0
LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
_LIST_BYTES = 5_000_000
_LOCAL = (*LOCAL, "openai-compatible")


@dataclass(frozen=True)
class LocalServer:
    """One server that answered: the provider it is, its base URL and the models it lists."""

    provider: str
    address: str
    models: tuple[str, ...]


def find_local(config: ModelConfig) -> list[LocalServer]:
    """Return every model server on loopback that answers in time, in the order of our table."""
    addresses = {name: providers()[name].address(config) for name in _LOCAL if name in providers()}
    found: dict[str, LocalServer] = {}

    def probe(name: str, address: str) -> None:
        models = _listed(urlsplit(address), "/models", {}, PROBE_S)
        if models:
            found[name] = LocalServer(name, address, models)

    threads = [
        threading.Thread(target=probe, args=place, daemon=True)
        for place in addresses.items()
        if urlsplit(place[1]).hostname in LOOPBACK
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(2 * PROBE_S)
    return [found[name] for name in addresses if name in found]


def listed_models(provider: Provider, config: ModelConfig, secret: Secret | None) -> tuple[str, ...] | None:
    """Return the models that a provider lists for this key, or None where it does not answer or refuses."""
    address = urlsplit(provider.address(config))
    key = secret.reveal() if secret else ""
    if provider.wire == "anthropic":
        headers = {"x-api-key": key, "anthropic-version": "2023-06-01"}
        return _listed(address, "/v1/models?limit=100", headers, LIST_S)
    if provider.wire == "google":
        return _listed(address, "/v1beta/models?pageSize=200", {"x-goog-api-key": key}, LIST_S)
    return _listed(address, "/models", {"Authorization": f"Bearer {key}"} if key else {}, LIST_S)


def _listed(
    address: SplitResult, path: str, headers: dict[str, str], timeout_s: float
) -> tuple[str, ...] | None:
    """Return the names in the list at that path, in anyone's form; None where there is no such list."""
    body = _get(address, path, headers, timeout_s)
    if body is None:
        return None
    rows = (body.get("data") or body.get("models") or []) if isinstance(body, dict) else []
    names = [row.get("id") or row.get("name") for row in rows if isinstance(row, dict)]
    return tuple(str(name).removeprefix("models/") for name in names if name)


def _get(address: SplitResult, path: str, headers: dict[str, str], timeout_s: float) -> Any | None:
    """Return the JSON at that path, or None. Follows no redirect."""
    if not address.hostname:
        return None
    kind = http.client.HTTPSConnection if address.scheme == "https" else http.client.HTTPConnection
    connection = kind(address.hostname, address.port, timeout=timeout_s)
    try:
        connection.request(
            "GET", address.path.rstrip("/") + path, headers={"Accept": "application/json", **headers}
        )
        answer = connection.getresponse()
        return json.loads(answer.read(_LIST_BYTES)) if answer.status == 200 else None
    except (OSError, ValueError, http.client.HTTPException):
        return None
    finally:
        connection.close()
