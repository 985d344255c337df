"""German orders are done as they are said; what has no reading, or is told and not ordered, moves nothing."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation
from tests.language.test_usual import done

_PLACE = ("merk dir das als Küche", "fahr einen Meter vor")


@pytest.mark.parametrize(
    ("turns", "plan"),
    [
        (("einen Meter vor, 90 links",), "drive 1 m; turn left 90 deg"),
        (("mach hier einen Kreis",), "arc left 360 deg radius 0.5 m"),
        (("dreh dich nach links", "fahr einen Meter vor", "dreh dich wieder zurück"), "face 0 deg"),
        (("links", "vor", "dieselbe Drehung nochmal"), "turn left 90 deg"),
        (("links", "dreh das um"), "turn right 90 deg"),
        (("vor, links und vor",), "drive 0.5 m; turn left 90 deg; drive 0.5 m"),
        (("fahr zwei Meter und rechts",), "drive 2 m; turn right 90 deg"),
        (("1 m; links; 1 m",), "drive 1 m; turn left 90 deg; drive 1 m"),
        (("in zwei Metern links",), "drive 2 m; turn left 90 deg"),
        (("in drei Sekunden rechts",), "wait 3 s; turn right 90 deg"),
        (("zweimal links und einen Meter vor",), "turn left 90 deg; turn left 90 deg; drive 1 m"),
        (("fahr einen Meter vor, vorher rechts",), "turn right 90 deg; drive 1 m"),
        (("fahr zwei Meter vor", "noch einen"), "drive 1 m"),
        (("mach einen Schritt vor", "noch einen"), "drive 0.5 m"),
        (("drei Meter vor und nur einen zurück",), "drive 3 m; drive 1 m back"),
        (("fahr zwei Meter vor", "auf drei Meter"), "drive 1 m"),
        (("fahr ein Quadrat", "noch zwei"), "; ".join(["drive 0.5 m; turn left 90 deg"] * 8)),
        (("zwei große Kreise",), "arc left 720 deg radius 1 m"),
        (
            ("mach einen Kreis links, dann rechts",),
            "arc left 360 deg radius 0.5 m; arc right 360 deg radius 0.5 m",
        ),
        (
            ("mach ein Quadrat, danach 2 m vor",),
            "; ".join(["drive 0.5 m; turn left 90 deg"] * 4) + "; drive 2 m",
        ),
        (
            ("einen Meter vor", "merk dir das als Zuhause", "einen Meter vor", "nach Hause"),
            'go to 1 0 named "home"',
        ),
        (("fahr zwei Meter vor, dann links", "nochmal nur das erste"), "drive 2 m"),
        ((*_PLACE, "fahr in die Küche und wieder hierher"), 'go to 0 0 named "küche"; go to 0 0 from start'),
        (
            ("hier ist A", "fahr einen Meter vor", "hier ist B", "fahr von A nach B"),
            'go to 0 0 named "a"; go to 1 0 named "b"',
        ),
        (("dreh dich nach links, dann wieder nach vorne",), "turn left 90 deg; face 0 deg from start"),
        (("fahr einen und einen halben Meter vor",), "drive 1.5 m"),
        (("fahr zwei Meter vor", "ups, zurück"), "drive 2 m back"),
        (("kannst du hier wenden",), "turn left 180 deg"),
        (("links in drei Sekunden",), "wait 3 s; turn left 90 deg"),
        (("einen Meter vor, links, noch einen",), "drive 1 m; turn left 90 deg; drive 1 m"),
        (("drei Meter und dann links und zwei Meter",), "drive 3 m; turn left 90 deg; drive 2 m"),
        (("zwei Sekunden lang vor",), "drive 2 s"),
        (("einen halben Meter vor und einen ganzen zurück",), "drive 0.5 m; drive 1 m back"),
    ],
)
def test_it_is_done_as_it_is_said(turns: tuple[str, ...], plan: str) -> None:
    assert done(*turns) == plan


MOVES_NOTHING = [
    ("einen Meter vor und 90 zurück",),
    ("fahr hier nicht weiter",),
    ("hier drüben",),
    ("hör mal her",),
    ("rückwärts kannst du nicht",),
    ("fahr zwei, drei Meter",),
    ("stopp das Rückwärtsfahren",),
    ("nimm mal das Tempo zurück",),
    ("mach die Kiste zu",),
    ("zurück bis zur Linie",),
    ("fahr zwei Meter und halte nach einem Meter kurz an",),
    ("dreh dich nach links", "mach den Kreis voll"),
    ("nimm zwei Meter Abstand",),
    ("fahr 50 Prozent der Strecke",),
    ("fahr zwei Meter vor", "das sollten Zentimeter sein"),
    ("fahr zwei Meter vor", "fahr wieder dahin"),
    ("fahr einen Meter vor", "nochmal nach links"),
    ("fahr einen Meter vor", "links", "die Strecke zurück"),
    ("dreh dich 45 Grad nach links", "einen Tick zurück"),
    ("ein Quadrat und noch ein kleineres",),
    ("einen großen und einen kleinen Kreis",),
    ("geh weg und komm nicht wieder",),
    ("fahr auf Platz zwei",),
    (*_PLACE, "einen Schritt Richtung Küche"),
    (*_PLACE, "Küche putzen"),
    (*_PLACE, "mach in der Küche einen Kreis"),
    (*_PLACE, "in die Küche, nein, nach links"),
    ("du kannst gut Kreise fahren",),
    ("du drehst dich ja im Kreis",),
    ("magst du Kreise",),
    ("gehst du gern nach Hause",),
    ("geh hoch",),
    ("fahr ein Quadrat in 20 Sekunden",),
    ("mach das Quadrat weg",),
    ("fahr zwei Meter neben mich",),
    ("aus zwei Metern Entfernung",),
    ("mach rechts an",),
    ("linkes Rad vor",),
    ("lauf an",),
    ("setz ab",),
    ("halt vor der Linie an",),
    ("schau zurück, ohne dich zu drehen",),
    ("links bzw. rechts",),
    ("fahr mich an",),
    ("ein bisschen vor, viel zurück",),
    ("sprich rückwärts",),
    ("komme gleich zurück",),
    ("komm mit",),
    ("gib mir zwei Meter",),
    ("fahr die zweite rechts",),
    ("kann man hier wenden",),
    ("mach ein Quadrat links und dann rechts",),
    ("fahr einen Meter vor", "links", "das Ganze noch dreimal"),
    ("noch zwei Meter bis zur Tür",),
    ("die Kinder fahren im Kreis",),
    ("fahr bis zur Linie",),
    ("stopp das Fahren",),
    ("links", "eins rechts"),
]


@pytest.mark.parametrize("turns", MOVES_NOTHING, ids=lambda turns: turns[-1])
def test_it_moves_nothing(turns: tuple[str, ...]) -> None:
    meant = conversation(*turns[:-1]).say(turns[-1])
    assert meant.plan is None
    assert not meant.remember_place
    assert not meant.define
