"""What a person sets for all that does not say it: `from now on at 10 cm/s`, `if I don't say how far, go 25 cm`."""

from __future__ import annotations

import math

from chatrobot.language import forms
from chatrobot.language.frames import Frame
from chatrobot.language.interpretation import Interpretation, Usual
from chatrobot.language.phrases import say
from chatrobot.language.reading import Reading
from chatrobot.language.tokens import SILENT
from chatrobot.language.unclear import Unclear


def read_usual(plain: str, reading: Reading) -> Interpretation | None:
    """Return the answer to a text that sets the distance or the turn which is meant where none is said; else None.

    Raises:
        Unclear: what it sets is no length or no angle.
    """
    told = forms.read_usual(plain, reading.language)
    if told is None:
        return None
    kind, amount = told
    atoms = [atom for atom in reading.atoms(amount) if atom.kind not in SILENT]
    names = {"distance": ("length",), "turn": ("angle", "turns", "number")}[kind]
    if (
        len(atoms) != 1
        or atoms[0].kind != "q"
        or atoms[0].value not in names
        or not 0 < atoms[0].number < math.inf
    ):
        raise Unclear("no_unit", amount)
    number = atoms[0].number
    if kind == "distance":
        reply, usual = (
            say(reading.language, "usual_distance_set", distance_m=f"{number:.3g}"),
            Usual(distance_m=number),
        )
    else:
        turn_rad = math.radians(number) if atoms[0].value == "number" else number
        reply = say(reading.language, "usual_turn_set", degrees=f"{math.degrees(turn_rad):.3g}")
        usual = Usual(turn_rad=turn_rad)
    return Interpretation("answered", reply, reading.language, usual=usual)


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
        speed = reading.pace.speed(frame) or usual
        if speed is not None:
            reply = say(language, "default_set", mps=f"{speed:.3g}")
            return Interpretation("answered", reply, language, usual=Usual(speed_mps=speed))
    raise Unclear("unclear_motion", frame.text)
