"""Runs `chatrobot model [setup|list|test|use|key] [PROVIDER[:NAME]]`."""

from __future__ import annotations

import argparse
import getpass
import sys
from urllib.parse import urlsplit

from chatrobot.cli.folders import config_folder
from chatrobot.core.errors import UsageError
from chatrobot.language.phrases import render_reason
from chatrobot.models.config import ModelConfig, resolve, store_choice
from chatrobot.models.discovery import find_local, listed_models
from chatrobot.models.keys import KeyringError, delete_key, find_key, keyring_name, store_key, where_key_is
from chatrobot.models.providers import Provider, providers, split_name
from chatrobot.models.seam import ModelError
from chatrobot.models.secret import Secret

_SHOWN = 40
NONE = "none"
_FLAWS = {"not_ascii": "a character that no key has", "space": "a space or a line break within"}


def run(args: argparse.Namespace) -> int:
    """Do the action; 0 where it worked, 1 where the model did not answer."""
    if args.json and args.action != "test":
        raise UsageError(
            f"model {args.action} prints no JSON", where="--json", allowed="chatrobot model test --json"
        )
    config = ModelConfig(folder=config_folder(args), session="model test")
    try:
        return _ACTIONS[args.action](args, config)
    except ModelError as error:
        raise UsageError(render_reason(error.reason, "en")) from None


def _setup(args: argparse.Namespace, config: ModelConfig) -> int:
    if not sys.stdin.isatty():
        code = _list(args, config)
        print("\nto choose: chatrobot model use PROVIDER:NAME")
        return code
    from chatrobot.cli.model.wizard import set_up

    return set_up(config)


def _list(args: argparse.Namespace, config: ModelConfig) -> int:
    if args.name:
        return _list_one(args.name.partition(":")[0], config)
    choice = resolve(args.model, config)
    print(f"in use: {choice.name} ({choice.source})" if choice else "in use: none")
    servers = find_local(config)
    print("\non this machine:" if servers else "\non this machine: no Ollama, llama.cpp or vLLM answers")
    for server in servers:
        for name in server.models[:_SHOWN]:
            print(f"  {server.provider}:{name:<40} {server.address}")
    print("\nproviders:")
    for provider in providers().values():
        example = f"{provider.name}:{provider.example}"
        print(f"  {example:<34} {_key_state(provider, config):<34} {provider.title}")
    return 0


def _key_state(provider: Provider, config: ModelConfig) -> str:
    if where := where_key_is(provider, config):
        return f"key: {where}"
    return f"no key ({provider.key_variables[0]})" if provider.needs_key else "needs no key"


def _list_one(name: str, config: ModelConfig) -> int:
    provider = provider_named(name)
    models = listed_models(provider, config, _checked(provider, find_key(provider, config)))
    if models is None:
        host = urlsplit(provider.address(config)).netloc.rpartition("@")[
            2
        ]  # without a password in the address
        print(
            f"{host or provider.name} does not list its models. Name one: {provider.name}:NAME",
            file=sys.stderr,
        )
        return 1
    for model in models:
        print(f"{provider.name}:{model}")
    return 0


def _test(args: argparse.Namespace, config: ModelConfig) -> int:
    from chatrobot.cli.model.trial import try_model

    choice = resolve(args.name or args.model, config)
    if choice is None:
        raise UsageError("no model is chosen", allowed="chatrobot model test PROVIDER:NAME")
    return try_model(choice.name, config, as_json=args.json)


def _use(args: argparse.Namespace, config: ModelConfig) -> int:
    from chatrobot.cli.model.trial import try_model

    if not args.name:
        raise UsageError("no model is named", allowed="chatrobot model use PROVIDER:NAME, or: use none")
    assert config.folder is not None
    if args.name == NONE:
        store_choice("", config.folder)
        print("No model is used from now on. What is understood offline still works.")
        return 0
    split_name(args.name)
    path = store_choice(args.name, config.folder)
    print(f"{args.name} is your model from now on ({path})")
    return try_model(args.name, config, as_json=args.json)


def _key(args: argparse.Namespace, config: ModelConfig) -> int:
    del config
    if not args.name:
        raise UsageError("no provider is named", allowed="chatrobot model key PROVIDER")
    provider = provider_named(args.name.partition(":")[0])
    if not provider.key_variables:
        raise UsageError(f"{provider.name} has no key")
    export = f"export {provider.key_variables[0]}=…"
    if not keyring_name():  # before a key is typed for nothing
        raise UsageError("this system has no keyring that keeps a key safely", allowed=export)
    try:
        if args.delete:
            delete_key(provider)
        elif secret := read_secret(provider):
            store_key(provider, secret)
        else:
            raise UsageError("no key was given", allowed=export)
    except KeyringError as error:
        raise UsageError(str(error), allowed=export) from None
    print(f"the key of {provider.name} is {'no longer' if args.delete else 'now'} in the keyring")
    return 0


def read_secret(provider: Provider) -> Secret:
    """Read a key typed without being shown, or the first line of standard input where that is a pipe.

    Raises:
        UsageError: what was given can be no key.
    """
    try:
        if not sys.stdin.isatty():
            secret = Secret(sys.stdin.readline())
        else:
            asked = f"key for {provider.title} (not shown; made at {provider.key_page}): "
            secret = Secret(getpass.getpass(asked))
    except UnicodeDecodeError:  # it would show a character
        raise _flawed(provider, "not_ascii") from None
    _checked(provider, secret)
    return secret


def _checked(provider: Provider, secret: Secret | None) -> Secret | None:
    if secret is not None and secret.flaw is not None:
        raise _flawed(provider, secret.flaw)
    return secret


def _flawed(provider: Provider, flaw: str) -> UsageError:
    return UsageError(
        f"the key of {provider.name} has {_FLAWS[flaw]}. Copy it again, alone and whole",
        allowed="unaccented letters, digits and ASCII signs",
    )


def provider_named(name: str) -> Provider:
    """Return the provider of that name.

    Raises:
        UsageError: there is none.
    """
    provider = providers().get(name.strip().lower())
    if provider is None:
        shown = repr(name) if name.isalpha() else "of that name"  # it may be a key, in the wrong place
        raise UsageError(f"there is no provider {shown}", allowed=", ".join(providers()))
    return provider


_ACTIONS = {"setup": _setup, "list": _list, "test": _test, "use": _use, "key": _key}
