"""What a person sets for all that follows: `from now on at 10 cm/s`, `never faster than 0.2 m/s`."""

from __future__ import annotations

import math

from chatrobot.language import forms
from chatrobot.language.frames import Frame
from chatrobot.language.interpretation import Interpretation, Usual
from chatrobot.language.phrases import say
from chatrobot.language.reading import Reading
from chatrobot.language.tokens import SILENT, Atom
from chatrobot.language.unclear import Unclear

_AMOUNTS = {"distance": ("length",), "turn": ("angle", "turns", "number")}


def read_usual(plain: str, reading: Reading) -> Interpretation | None:
    """Return the answer to a text that sets the distance or the turn which is meant where none is said; else None.

    Raises:
        Unclear: what it sets is no length or no angle.
    """
    told, language = forms.read_usual(plain, reading.language), reading.language
    if told is None:
        return None
    amount = _amount_in(told[1], reading, _AMOUNTS[told[0]])
    if amount is None:
        raise Unclear("no_unit", told[1])
    if told[0] == "distance":
        reply = say(language, "usual_distance_set", distance_m=f"{amount.number:.3g}")
        usual = Usual(distance_m=amount.number)
    else:
        turn_rad = math.radians(amount.number) if amount.value == "number" else amount.number
        reply = say(language, "usual_turn_set", degrees=f"{math.degrees(turn_rad):.3g}")
        usual = Usual(turn_rad=turn_rad)
    return Interpretation("answered", reply, language, usual=usual)


def read_limit(plain: str, reading: Reading) -> Interpretation | None:
    """Return the answer to a text that sets the highest speed, or ends that: `never faster than 0.2 m/s`; else None."""
    language = reading.language
    if forms.ends_limit(plain, language):
        reply = say(language, "speed_limit_ended")
        return Interpretation("answered", reply, language, usual=Usual(limit_mps=math.inf))
    told = forms.read_limit(plain, language)
    limit = _amount_in(told, reading, ("speed", "number")) if told else None
    if limit is None:
        return None
    reply = say(language, "speed_limit_set", mps=f"{limit.number:.3g}")
    return Interpretation("answered", reply, language, usual=Usual(limit_mps=limit.number))


def _amount_in(text: str, reading: Reading, kinds: tuple[str, ...]) -> Atom | None:
    """The one amount that a text is, of these kinds and positive; None where it is anything else."""
    atoms = [atom for atom in reading.atoms(text) if atom.kind not in SILENT]
    is_one = len(atoms) == 1 and atoms[0].kind == "q" and atoms[0].value in kinds
    return atoms[0] if is_one and 0 < atoms[0].number < math.inf else None


def from_now_on(frames: list[Frame], reading: Reading) -> Interpretation | None:
    """Return the answer to frames that set the speed for all that follows: `from now on drive at 10 cm/s`; else None.

    Raises:
        Unclear: they set no speed, or say more than one.
    """
    if not frames or not any("from_now_on" in frame.flags for frame in frames):
        return None
    frame, language = frames[0], reading.language
    if len(frames) > 1 or frame.has_extent or frame.direction or frame.shape:
        raise Unclear("unclear_motion", frame.text)
    if frame.turning or "rate" in frame.q:
        rate = reading.pace.rate(frame)
        if rate is not None:
            reply = say(language, "default_rate_set", radps=f"{rate:.3g}")
            return Interpretation("answered", reply, language, usual=Usual(rate_radps=rate))
    else:
        usual = reading.profile.defaults.speed_mps if frame.pace == "default" and not frame.q else None
        speed = usual or reading.pace.speed(frame)
        if speed is not None:
            reply = say(language, "default_set", mps=f"{speed:.3g}")
            return Interpretation("answered", reply, language, usual=Usual(speed_mps=speed))
    raise Unclear("unclear_motion", frame.text)
