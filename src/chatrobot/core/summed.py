"""Several runs of one turn told as one."""

from __future__ import annotations

from dataclasses import replace

from chatrobot.core.events import Finished


def summed(total: Finished, run: Finished) -> Finished:
    """Two runs of one turn as one."""
    return replace(
        run,
        start=total.start,
        turned_rad=total.turned_rad + run.turned_rad,
        path_m=total.path_m + run.path_m,
        duration_s=total.duration_s + run.duration_s,
        paused_s=total.paused_s + run.paused_s,
        planned_m=total.planned_m + run.planned_m,
        planned_turn_rad=total.planned_turn_rad + run.planned_turn_rad,
        steps_done=total.steps_done + run.steps_done,
        steps=total.steps + run.steps,
        measured=total.measured and run.measured,
        open_ended=total.open_ended or run.open_ended,
        late_s=max(total.late_s, run.late_s),
        executed="\n".join(filter(None, (total.executed, run.executed))),
    )


def gone_on(so_far: Finished, rest: Finished) -> Finished:
    """A plan that was paused, and the rest of it, as one: what was planned in vain at the pause counts once."""
    whole = summed(so_far, rest)
    return replace(
        whole,
        planned_m=so_far.path_m + rest.planned_m,
        planned_turn_rad=so_far.turned_rad + rest.planned_turn_rad,
        steps=so_far.steps,
        open_ended=rest.open_ended,
    )
