"""Sets a model up with three questions: `chatrobot model` at a terminal."""

from __future__ import annotations

import sys
from dataclasses import replace

from chatrobot.cli.model.command import read_secret
from chatrobot.cli.model.trial import try_model
from chatrobot.models.config import ModelConfig, store_choice
from chatrobot.models.discovery import find_local
from chatrobot.models.keys import KeyringError, keyring_name, store_key, where_key_is
from chatrobot.models.providers import LOCAL, Provider, providers


def set_up(config: ModelConfig) -> int:
    """Ask, store the choice, try one sentence. 0 where it answered, 5 where the person gave up."""
    folder = config.folder
    assert folder is not None
    try:
        name, config = _choose(config)
    except EOFError:
        print()
        return 5
    print(f"{name} is your model from now on ({store_choice(name, folder)})")
    return try_model(name, config)


def _choose(config: ModelConfig) -> tuple[str, ModelConfig]:
    """Return the model, and the settings with a key that was typed for this once."""
    print("looking for model servers on this machine…", flush=True)
    servers = find_local(config)
    local = [f"{server.provider}:{name}" for server in servers for name in server.models]
    rows: list[str | Provider] = [*local, *(row for row in providers().values() if row.name not in LOCAL)]
    for number, row in enumerate(rows, start=1):
        if isinstance(row, str):
            print(f"  {number:2d}  {row}  (on this machine: free, and nothing leaves it)")
        else:
            key = f", key in the {where}" if (where := where_key_is(row, config)) else ""
            print(f"  {number:2d}  {row.title}{key}")
    if not local:
        print(
            "  No Ollama or llama.cpp answers here. Ollama is the easiest: https://ollama.com, "
            "then: ollama pull qwen3:4b-instruct"
        )
    chosen = rows[_number(len(rows)) - 1]
    if isinstance(chosen, str):
        return chosen, config
    config = _with_key(chosen, config)
    name = input(f"which model? [{chosen.example}] ").strip() or chosen.example
    return f"{chosen.name}:{name}", config


def _number(most: int) -> int:
    while True:
        said = input(f"number (1 to {most}): ").strip()
        if said.isdigit() and 1 <= int(said) <= most:
            return int(said)


def _with_key(provider: Provider, config: ModelConfig) -> ModelConfig:
    """Ask for a key where one is needed and none is known; keep it in the keyring, or for this once."""
    if not provider.needs_key or where_key_is(provider, config):
        return config
    secret = read_secret(provider)
    if not secret:
        return config
    variable = provider.key_variables[0]
    try:
        store_key(provider, secret)
        print(f"kept in the keyring ({keyring_name()})")
    except KeyringError as error:
        print(f"{error}. It is used for this test alone; for later: export {variable}=…", file=sys.stderr)
        return replace(config, environ={**config.environ, variable: secret.reveal()})
    return config
