"""What a rehearsal found, and the limits of what is rehearsed at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from chatrobot.core.geometry import ORIGIN, Pose
from chatrobot.core.reason import Reason

Severity = Literal["refuse", "warn", "note"]


@dataclass(frozen=True)
class Finding:
    """Something to know about a plan before it runs; one `refuse` and it does not run.

    `index` is the path of the step in the plan that was rehearsed, from 0; `t_s` is counted from the start of the
    plan; `where` is the predicted pose at that moment, in the odom frame.
    """

    severity: Severity
    reason: Reason
    index: tuple[int, ...] = ()
    t_s: float = 0.0
    where: Pose = ORIGIN
