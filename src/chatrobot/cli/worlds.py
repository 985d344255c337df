"""`chatrobot worlds`: the worlds for the simulated robot, a line each."""

from __future__ import annotations

import argparse

from chatrobot.cli.json_lines import json_line
from chatrobot.sim.load import load_world, world_names
from chatrobot.sim.world import World


def run(args: argparse.Namespace) -> int:
    """Always 0."""
    for name in world_names():
        world = load_world(name)
        if args.json:
            print(json_line({"event": "world", "name": name, **_facts(world)}), end="")
        else:
            print(f"{name:<10}{_line(world)}")
    if not args.json:
        print("A world of your own: --world FILE.yaml, see docs/simulation.md.")
    return 0


def _facts(world: World) -> dict[str, object]:
    around = world.bounds
    return {
        "length_m": round(around.max_x_m - around.min_x_m, 3) if around else None,
        "width_m": round(around.max_y_m - around.min_y_m, 3) if around else None,
        "obstacles": len(world.obstacles),
        "places": list(world.places),
    }


def _line(world: World) -> str:
    if world.is_empty:
        return "an open floor: no walls, no places"
    facts = _facts(world)
    places = ", ".join(world.places)
    return f"{facts['length_m']:g} × {facts['width_m']:g} m, {facts['obstacles']} obstacles; places: {places}"
