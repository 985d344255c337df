"""From the command line to what the composition root takes."""

from __future__ import annotations

import argparse

from chatrobot.cli.folders import config_folder
from chatrobot.compose import Setup
from chatrobot.core.errors import UsageError
from chatrobot.session.session import Options


def setup_from(
    args: argparse.Namespace, *, options: Options | None = None, world: str = "", programs: bool = False
) -> Setup:
    """What a person chose. `world` is the one where nothing is said; "" for the one that fits the robot.

    `programs`: see `Setup`.

    Raises:
        UsageError: this version cannot do what was chosen.
    """
    if args.model or args.interpreter == "model":
        raise UsageError(
            "language models are not built in yet",
            where="--model" if args.model else "--interpreter model",
            allowed="leave it out: the offline interpreter needs none",
        )
    return Setup(
        on=args.on,
        robot=args.robot,
        world=args.world or world,
        sim=args.sim,
        fast=args.fast,
        trace=args.trace,
        yes=args.yes,
        programs=programs,
        folder=config_folder(args),
        options=options or Options(approve=args.approve and not args.yes, ask_findings=not args.yes),
    )
