"""From the command line to what the composition root takes."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace

from chatrobot.cli.console.words import language_of_environment
from chatrobot.cli.early import Early
from chatrobot.cli.folders import config_folder
from chatrobot.cli.parameters import parameters_in, read_parameters
from chatrobot.compose import Setup
from chatrobot.core.errors import UsageError
from chatrobot.dialogue.llm.setup import chosen_model, explain_server_held
from chatrobot.dialogue.llm.terms import ModelOptions
from chatrobot.dialogue.options import Options
from chatrobot.language.phrases import render_reason
from chatrobot.models.seam import Model, ModelError
from chatrobot.robots.profile import MotionBudget

_SOURCES = {"option": "--model", "environment": "CHATROBOT_MODEL", "stored": "the model you chose"}


def setup_from(
    args: argparse.Namespace,
    *,
    options: Options | None = None,
    world: str = "",
    named_model: bool = False,
    programs: bool = False,
) -> Setup:
    """Gather what a person chose. `world` is the one where nothing is said; "" for the one that fits the robot.

    Args:
        named_model: only a model that is named on this very command line counts.
        programs: who asks for a program gets one (see `Setup`).

    Raises:
        UsageError: what was chosen does not exist.
    """
    early: Early | None = getattr(args, "early", None)
    options = options or Options(approve=args.approve and not args.yes, ask_findings=not args.yes)
    return Setup(
        on=args.on,
        robot=args.robot,
        world=args.world or world,
        sim=args.sim,
        fast=args.fast,
        trace=args.trace,
        yes=args.yes,
        programs=programs,
        budget=MotionBudget(args.max_distance, args.max_time),
        open_loop=args.open_loop,
        folder=config_folder(args),
        options=replace(options, interpreter=args.interpreter, language=language_of_environment()),
        model=model_from(args, named=named_model),
        model_options=ModelOptions(
            rounds=args.rounds, budget_tokens=args.budget_tokens, budget_s=args.budget_s
        ),
        processes=early.processes if early is not None else None,
        on_ready=early.ready if early is not None else lambda: None,
    )


def model_from(args: argparse.Namespace, *, named: bool = False) -> Model | None:
    """Return the model that was chosen, and say what became of the tutorial's switch where that chose it.

    Raises:
        UsageError: there is none of that name, or none where `--interpreter model` wants one.
    """
    if args.interpreter == "offline" or (named and not args.model and args.interpreter != "model"):
        return None
    is_node = args.command == "node"
    given = [] if is_node else [*args.parameters, *parameters_in(args.ros_args)]
    server_held = args.revChatGPT if is_node else read_parameters(given)["revChatGPT"]
    try:
        model = chosen_model(args.model, config_folder(args), server_held=server_held)
    except ModelError as error:
        raise UsageError(render_reason(error.reason, "en"), where=_source_of_model(args)) from error
    if model is None and args.interpreter == "model":
        raise UsageError(
            "no language model is set up",
            where="--interpreter model",
            allowed="--model PROVIDER:NAME, CHATROBOT_MODEL, or: chatrobot model",
        )
    if server_held and not is_node:
        print(explain_server_held(model, "en"), file=sys.stderr)
    return model


def _source_of_model(args: argparse.Namespace) -> str:
    """Say where the name of the model comes from."""
    from chatrobot.models.config import ModelConfig, resolve

    choice = resolve(args.model, ModelConfig(config_folder(args)))
    return _SOURCES[choice.source] if choice is not None else "--model"
