"""`chatrobot schema`: the JSON schema of plans, for tools and models."""

from __future__ import annotations

import argparse
import json


def run(_: argparse.Namespace) -> int:
    """Always 0."""
    from chatrobot.plan.json_form import plan_schema

    print(json.dumps(plan_schema(), indent=2, ensure_ascii=False))
    return 0
