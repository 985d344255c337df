"""Numbers as people read them: to the millimetre and the tenth of a degree, without float noise."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from chatrobot.core.reason import fixed, number


@pytest.mark.parametrize(
    ("value", "places", "shown"),
    [
        (1.9000000000000001, 3, "1.9"),
        (29.773198144942803, 1, "29.8"),
        (-9.8e-07, 3, "0"),
        (-0.0001, 2, "-0.0001"),
        (2.0, 3, "2"),
        (1234.5, 3, "1234.5"),
        (123456789.0, 3, "123456789"),
        (0.0004, 3, "0.0004"),
        (-0.00042, 3, "-0.0004"),
    ],
)
def test_a_number_is_short_and_true(value: float, places: int, shown: str) -> None:
    assert number(value, places) == shown


@given(st.floats(-1e6, 1e6), st.integers(0, 4))
def test_a_number_is_never_further_off_than_its_last_place(value: float, places: int) -> None:
    for shown in (number(value, places), fixed(value, places)):
        assert re.fullmatch(r"-?\d+(\.\d+)?", shown), "no exponent"
        assert not re.fullmatch(r"-0(\.0*)?", shown)
        assert abs(float(shown) - value) <= 0.5 * 10.0**-places + 1e-6
