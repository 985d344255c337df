"""What German says by its constructions is done in its order, or asked about: none of it drives another way."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done

ASKED = [
    ("nein, nicht links",),
    ("Nein! Nicht nach links!",),
    ("stopp, ich wollte nicht links",),
    ("stopp, nicht weiter zurück",),
    ("links", "nein, nicht rechts"),
    ("oh no, not left",),
    ("fahr um drei Uhr los",),
    ("um 9 Uhr Pause",),
    ("von links kommt einer",),
    ("zwei Meter hinter dir",),
    ("lass mich bitte vor",),
    ("lass den Mann vor",),
    ("ich fahre jetzt zwei Meter vor",),
    ("ich will nach Hause",),
    ("ich brauche zwei Meter",),
    ("links", "wieder gerade"),
    ("rechts vor links",),
    ("dürfen wir links abbiegen",),
    ("stell dich kurz vor",),
    ("stell dich vor uns",),
    ("geh schlafen",),
    ("fahr hoch",),
    ("mach hinten zu",),
    ("setz eine Runde aus",),
    ("geh zu Fuß",),
    ("bleib zu Hause",),
    ("halt vorne an",),
    ("fahr her",),
    ("von vorn",),
    ("fahr vor und sag links",),
    ("fahr ein S",),
    ("drei Meter hoch",),
    ("ein Zwei-Meter-Mann",),
    ("zieh dich zurück",),
    ("zurück zur Sache",),
    ("eine Seite zurück",),
    ("mach eine Rolle vorwärts",),
    ("die zweite rechts, bitte",),
    ("dreh dich halb um",),
    ("rechts, dann zurück",),
    ("links, rechts, nein, nochmal links",),
    ("kannst du nicht mal links fahren",),
]
DONE = [
    (("zum Schluss links, zuerst rechts",), "turn right 90 deg; turn left 90 deg"),
    (("anstatt vorzufahren fahr zurück",), "drive 0.5 m back"),
    (("nicht nur links, sondern auch rechts",), "turn left 90 deg; turn right 90 deg"),
    (("fahr nicht zwei Meter sondern einen",), "drive 1 m"),
    (("zwei vor, einer zurück",), "drive 2 m; drive 1 m back"),
    (("fahr nach zwei Metern links",), "drive 2 m; turn left 90 deg"),
    (("zweimal einen Meter vor und rechts",), "drive 1 m; turn right 90 deg; drive 1 m; turn right 90 deg"),
    (
        ("links und rechts je zweimal",),
        "turn left 90 deg; turn left 90 deg; turn right 90 deg; turn right 90 deg",
    ),
    (("fahr einen Meter vor und rechts",), "drive 1 m; turn right 90 deg"),
    (("links", "du solltest nach rechts"), "turn right 180 deg"),
    (("hör auf zu fahren und dreh dich um",), "turn left 180 deg"),
    (("merk dir diesen Ort als A", "fahr einen Meter vor", "fahr zu A"), 'go to 0 0 named "a"'),
    (("dreh dich auf drei Uhr",), "turn right 90 deg"),
    (("leicht links",), "turn left 45 deg"),
    (("mach einen großen Bogen nach rechts",), "arc right 90 deg radius 1 m"),
    (("links und links",), "turn left 90 deg; turn left 90 deg"),
    (("gib Gas rückwärts",), "drive 0.5 m back at 0.51 m/s"),
]


@pytest.mark.parametrize("turns", ASKED, ids=lambda turns: turns[-1])
def test_it_is_asked_about(turns: tuple[str, ...]) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.outcome in ("unclear", "answered", "refused")
    assert meant.plan is None


@pytest.mark.parametrize(("turns", "plan"), DONE, ids=[turns[-1] for turns, _ in DONE])
def test_it_is_done(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


def test_what_is_to_stop_is_not_done() -> None:
    assert conversation().say("hör auf, rückwärts zu fahren").outcome == "stop"
