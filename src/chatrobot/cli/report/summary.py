"""The drive in a few sentences and numbers: what stands on top of the report."""

from __future__ import annotations

import time
from collections.abc import Callable

from chatrobot.cli.report.drive import Drive
from chatrobot.core.events import Outcome
from chatrobot.language.data_files import load_table
from chatrobot.language.phrases import render_reason

Say = Callable[..., str]
_OUTCOMES: tuple[Outcome, ...] = ("completed", "answered", "stopped", "refused", "unclear", "failed")
_MOST_REASONS = 8


def words_in(language: str) -> Say:
    """Return what says the report's words in a language."""
    table = load_table(language, "report")
    return lambda code, **values: str(table.get(code, code)).format(**values)


def headline(drive: Drive, say: Say) -> str:
    """Name robot, world and day on one line."""
    parts = [drive.title or say("robot_unknown")]
    if not drive.world.is_empty or drive.world.places:
        parts.append(say("in_world", world=drive.world.name))
    if drive.recording.began_ns:
        parts.append(time.strftime("%Y-%m-%d %H:%M", time.localtime(drive.recording.began_ns / 1e9)))
    return " · ".join(parts)


def sentences(drive: Drive, say: Say) -> list[str]:
    """Tell how long, how far, what was ordered, stopped and limited, and what models cost."""
    recording = drive.recording
    if not (recording.events or recording.odometry or recording.commands or recording.words):
        return [say("nothing")]
    found = [say("lasted", duration=duration(recording.duration_s, say))]
    found += _instructions(drive, say)
    if drive.rehearsals or drive.measured_m:
        found.append(_distances(drive, say))
    if drive.results:
        found += [_stops(drive, say), _limits(drive, say)]
    if drive.model_calls:
        found.append(_models(drive, say))
    return found


def tiles(drive: Drive, say: Say) -> list[tuple[str, str]]:
    """Return the numbers of the report, each with its name."""
    found = [(say("tile_duration"), duration(drive.recording.duration_s, say))]
    lengths = (
        ("told", drive.told_m if drive.rehearsals else None),
        ("measured", drive.measured_m),
        ("true", drive.true_m),
    )
    found += [(say(f"tile_{name}"), f"{length:.2f} m") for name, length in lengths if length is not None]
    outcomes, limits = drive.outcomes, len(drive.limited)
    counts = {
        "instructions": len(drive.results),
        "refused": outcomes["refused"],
        "stops": outcomes["stopped"],
    }
    if drive.results or limits:
        found += [(say(f"tile_{name}"), str(count)) for name, count in {**counts, "limits": limits}.items()]
    if drive.model_calls:
        found.append((say("tile_tokens"), str(_tokens(drive))))
    return found


def duration(duration_s: float, say: Say) -> str:
    """Write a time in words."""
    if duration_s < 60.0:
        return say("seconds", s=f"{duration_s:.1f}")
    minutes, seconds = divmod(round(duration_s), 60)
    return say("minutes", min=minutes, s=seconds)


def _instructions(drive: Drive, say: Say) -> list[str]:
    if not drive.results:
        return [say("words_alone", count=len(drive.heard))] if drive.heard else []
    counts = drive.outcomes
    named = [f"{counts[name]} {say(f'outcome_{name}')}" for name in _OUTCOMES if counts[name]]
    if len(drive.results) == 1:
        return [say("instruction", outcomes=say(f"outcome_{drive.results[0][1].outcome}"))]
    return [say("instructions", count=len(drive.results), outcomes=say("comma").join(named))]


def _distances(drive: Drive, say: Say) -> str:
    told = f"{drive.told_m:.2f}"
    if drive.measured_m is None:
        return say("distances_unmeasured", told=told)
    if not drive.rehearsals:
        return say("distances_alone", measured=f"{drive.measured_m:.2f}")
    values = {"told": told, "measured": f"{drive.measured_m:.2f}"}
    if drive.true_m is None:
        return say("distances", **values)
    return say("distances_true", true=f"{drive.true_m:.2f}", **values)


def _stops(drive: Drive, say: Say) -> str:
    stopped = [result for _, result in drive.results if result.outcome == "stopped"]
    reasons = [render_reason(each.reason, drive.language) if each.reason else each.reply for each in stopped]
    return say("stops", reasons=_listed(reasons, say)) if stopped else say("no_stops")


def _limits(drive: Drive, say: Say) -> str:
    rules = [say(f"rule_{event.rule}") for _, event, _ in drive.limited]
    return say("limits", rules=_listed(rules, say)) if rules else say("no_limits")


def _listed(texts: list[str], say: Say) -> str:
    """List texts, each once with how often it came."""
    counts = {text.rstrip(".。"): texts.count(text) for text in texts}
    named = [text if n == 1 else say("listed", name=text, count=n) for text, n in counts.items()]
    return "; ".join(named[:_MOST_REASONS]) + ("; …" if len(named) > _MOST_REASONS else "")


def _models(drive: Drive, say: Say) -> str:
    costs = [call.cost_usd for call in drive.model_calls]
    known = [cost for cost in costs if cost is not None]
    code = "cost_unknown" if not known else "cost_usd" if len(known) == len(costs) else "cost_partly"
    cost = say(code, cost=f"{sum(known):.4f}")
    return say("models", calls=len(costs), tokens=_tokens(drive), cost=cost)


def _tokens(drive: Drive) -> int:
    return sum(call.prompt_tokens + call.reply_tokens for call in drive.model_calls)
