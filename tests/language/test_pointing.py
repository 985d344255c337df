"""What points at something earlier is done beside talk, and not where the talk tells that somebody says it."""

from __future__ import annotations

import pytest

from tests.language.dialogue_runner import conversation

TAUGHT = {
    "en": ("remember this as the loading bay, bud", "go forward 1 m"),
    "zh": ("你现在站的这个地方记住啊 就叫装卸区", "前进一米"),
    "de": ("Wo du jetzt stehst, das ist die Rampe, merk dir das.", "Fahr einen Meter vor."),
}


@pytest.mark.parametrize(
    ("language", "said", "x_m"),
    [
        ("en", "Alright, quitting time, head back to the loading bay.", 0.0),
        ("en", "The AprilTag is not in the frame yet, once more", 2.0),
        ("en", "Bell's gone! Undo that.", 0.0),
        ("zh", "送完了，回装卸区", 0.0),
        ("de", "Alle einsteigen! Zurück zur Rampe.", 0.0),
    ],
)
def test_words_that_nobody_knows_do_not_keep_from_what_points_back(
    language: str, said: str, x_m: float
) -> None:
    assert conversation(*TAUGHT[language], said).track.pose.x_m == pytest.approx(x_m)


@pytest.mark.parametrize(
    ("language", "said"),
    [
        ("en", "My dad always says, go back to the loading bay"),
        ("en", "He told me yesterday, do that again"),
        ("en", "When the bell rings, back to the loading bay"),
        ("en", "Tom, go back to the loading bay"),
        ("zh", "他说，再来一次"),
        ("zh", "电影里他说，撤销"),
        ("de", "Wenn es klingelt, zurück zur Rampe"),
    ],
)
def test_what_others_say_or_what_is_for_later_moves_nothing(language: str, said: str) -> None:
    assert conversation(*TAUGHT[language], said).track.pose.x_m == pytest.approx(1.0)
