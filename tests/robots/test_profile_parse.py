"""A profile that cannot be used is refused by file, line and field, with what would be right."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from chatrobot.core.errors import ProfileError
from chatrobot.robots.load import list_profiles
from chatrobot.robots.parse import parse_profile
from chatrobot.robots.profile import MotionBudget, RobotProfile

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

GOOD = (Path(list_profiles()[0].file).parent / "wheeltec_mini_akm.toml").read_text(encoding="utf-8")
MECANUM = (Path(list_profiles()[0].file).parent / "wheeltec_mini_mec.toml").read_text(encoding="utf-8")


def changed(old: str, new: str, text: str = GOOD) -> str:
    assert text.count(old) == 1, f"{old!r} is there {text.count(old)} times"
    return text.replace(old, new)


def line_of(part: str, text: str) -> int:
    return next(number for number, line in enumerate(text.splitlines(), start=1) if part in line)


def refused(text: str) -> ProfileError:
    with pytest.raises(ProfileError) as caught:
        parse_profile(text, "bot", "bot.toml")
    assert caught.value.where.startswith("bot.toml")
    assert caught.value.allowed
    return caught.value


# old text, new text, field, what the allowed part says
FIELD_ERRORS = {
    "negative": ("{ value = 0.6,", "{ value = -0.6,", "limits.max_speed_mps.value", "at most 10 m/s"),
    "millimetres": ("{ value = 0.6,", "{ value = 600,", "limits.max_speed_mps.value", "at most 10 m/s"),
    "nan": ("{ value = 0.6,", "{ value = nan,", "limits.max_speed_mps.value", "at most 10 m/s"),
    "infinite": ("{ value = 0.1,", "{ value = inf,", "limits.latency_s.value", "2 s"),
    "text": ("{ value = 0.6,", '{ value = "0.6",', "limits.max_speed_mps.value", "a number"),
    "true": ("{ value = 0.6,", "{ value = true,", "limits.max_speed_mps.value", "a number"),
    "degrees": ("turn_rad = 1.5707963267948966", "turn_rad = 90", "defaults.turn_rad", "6.28319 rad"),
    "beams": ("beams = 360", "beams = 360.0", "lidar.beams", "whole number"),
    "kinematics": ('"ackermann"', '"tracked"', "kinematics", "differential, mecanum, ackermann"),
    "cmd_vel type": (
        'cmd_vel_topic = "cmd_vel"',
        'cmd_vel_type = "Joy"',
        "wiring.cmd_vel_type",
        "TwistStamped",
    ),
    "topic": (
        'cmd_vel_topic = "cmd_vel"',
        'cmd_vel_topic = "cmd vel"',
        "wiring.cmd_vel_topic",
        "turtle1/pose",
    ),
    "no topic": ('scan_topic = "scan"', 'scan_topic = ""', "wiring.scan_topic", "leave the line out"),
    "timeout": ('"forever"', '"for ever"', "wiring.base_timeout_s", '"forever"'),
    "title": ('"Wheeltec mini Ackermann"', '" "', "title", "people read"),
    "default beyond": ("speed_mps = 0.3", "speed_mps = 0.7", "defaults.speed_mps", "max_speed_mps, 0.6"),
    "rate beyond": ("rate_radps = 0.6", "rate_radps = 1.8", "defaults.rate_radps", "max_rate_radps, 1.7"),
    "sideways": ("{ value = 0.0,", "{ value = 0.1,", "limits.max_sideways_mps.value", "mecanum"),
    "radius": ("{ value = 0.35,", "{ value = 0.0,", "limits.min_turning_radius_m", "above 0 m"),
    "steered rate": ("{ value = 1.7,", "{ value = 1.8,", "limits.max_rate_radps.value", "1.714 rad/s"),
    "ranges": ("min_range_m = 0.12", "min_range_m = 9", "lidar.max_range_m", "above lidar.min_range_m"),
    "clockwise": (
        "[0.22, -0.10], [0.22, 0.10]",
        "[0.22, 0.10], [0.22, -0.10]",
        "footprint",
        "counter-clockwise",
    ),
    "two corners": ("[0.22, -0.10], [0.22, 0.10], ", "", "footprint", "3 to 64"),
    "off centre": (
        "[-0.05, 0.10], [-0.05, -0.10]",
        "[0.05, 0.10], [0.05, -0.10]",
        "footprint",
        "around (0, 0)",
    ),
    "dent": ("[-0.05, 0.10],", "[-0.05, 0.10], [0.10, 0.0],", "footprint", "convex"),
    "doubled": ("[-0.05, 0.10],", "[-0.05, 0.10], [-0.05, 0.10],", "footprint", "each once"),
    "triple": ("[0.22, -0.10],", "[0.22, -0.10, 0.0],", "footprint", "[x, y] pairs"),
    "no pairs": ("[0.22, -0.10],", "0.22, -0.10,", "footprint", "[x, y] pairs"),
    "corner": ("[0.22, -0.10],", "[220, -0.10],", "footprint", "5 m"),
}


@pytest.mark.parametrize("case", FIELD_ERRORS.values(), ids=FIELD_ERRORS.keys())
def test_a_wrong_value_is_refused_at_its_line_and_field(case: tuple[str, str, str, str]) -> None:
    old, new, field, allowed = case
    first = "value" in old or "turn_rad" in old or "rate_radps" in old or "speed_mps" in old
    text = GOOD.replace(old, new, 1) if first else changed(old, new)
    error = refused(text)
    assert error.where.split(": ")[1] == field
    assert allowed in error.allowed
    number = int(error.where.split(": ")[0].removeprefix("bot.toml:"))
    key = field.removesuffix(".value").split(".")[-1]
    assert text.splitlines()[number - 1].strip().startswith(key)


def test_a_pentagram_is_no_footprint() -> None:
    star = [[math.cos(4 * math.pi * i / 5), math.sin(4 * math.pi * i / 5)] for i in range(5)]
    text = changed("[[0.22, -0.10], [0.22, 0.10], [-0.05, 0.10], [-0.05, -0.10]]", str(star))
    assert "more than once" in refused(text).problem


@pytest.mark.parametrize("value", ["0.0", "1.1"])
def test_a_mecanum_base_goes_sideways_but_not_faster_than_forwards(value: str) -> None:
    error = refused(
        MECANUM.replace("max_sideways_mps = { value = 1.0", f"max_sideways_mps = {{ value = {value}")
    )
    assert error.where.endswith("limits.max_sideways_mps.value")
    assert "above 0 and at most" in error.allowed


def test_a_base_that_turns_on_the_spot_has_no_turning_radius() -> None:
    radius = '\nmin_turning_radius_m = { value = 0.5, source = "measured" }\n\n[defaults]'
    error = refused(changed("\n[defaults]", radius, MECANUM))
    assert error.where.endswith("limits.min_turning_radius_m.value")


@pytest.mark.parametrize(
    ("old", "new", "field", "allowed"),
    [
        ("beams = 360", "", "lidar.beams", "a whole number from 1"),
        ("[defaults]", "[preferences]", "preferences", "did you mean"),
        ("beams = 360", "beams = 360\nfrequency_hz = 3", "lidar.frequency_hz", "known here: x_m"),
        ("max_range_m = 8.0", "max_rnge_m = 8.0", "lidar.max_rnge_m", "did you mean max_range_m?"),
        ('title = "', 'titel = "', "titel", "did you mean title?"),
        ("yaw_rad", "yaw_deg", "lidar.yaw_deg", "did you mean yaw_rad?"),
        ('{ value = 1.7, source = "', '{ value = 1.7, sauce = "', "limits.max_rate_radps.sauce", "source?"),
    ],
)
def test_a_missing_or_unknown_field_is_named(old: str, new: str, field: str, allowed: str) -> None:
    error = refused(GOOD.replace(old, new, 1))
    assert error.where.split(": ")[-1] == field
    if "did you" in allowed and field == "preferences":
        assert "defaults" in error.allowed
    else:
        assert allowed in error.allowed


def test_a_missing_field_points_to_the_table_it_belongs_to() -> None:
    text = changed("beams = 360\n", "")
    assert refused(text).where == f"bot.toml:{line_of('[lidar]', text)}: lidar.beams"


@pytest.mark.parametrize(
    "limit", ["1.7", '{ value = 1.7, source = "" }', "{ value = 1.7 }", '{ source = "x" }']
)
def test_no_limit_goes_without_its_value_and_source(limit: str) -> None:
    whole = next(line for line in GOOD.splitlines() if line.startswith("max_rate_radps"))
    assert "limits.max_rate_radps" in refused(changed(whole, f"max_rate_radps = {limit}")).where


def test_a_limit_may_be_written_as_a_table_of_its_own() -> None:
    whole = next(line for line in GOOD.splitlines() if line.startswith("max_rate_radps"))
    table = '\n[limits.max_rate_radps]\nvalue = 1.6\nsource = "measured"\n\n[defaults]'
    text = changed("[defaults]", table, changed(whole, ""))
    robot = parse_profile(text, "bot")
    assert (robot.limits.max_rate_radps, robot.sources["max_rate_radps"]) == (1.6, "measured")
    wrong = text.replace("value = 1.6", "value = -1.6")
    assert refused(wrong).where == f"bot.toml:{line_of('value = -1.6', wrong)}: limits.max_rate_radps.value"


def test_lines_are_counted_past_a_footprint_of_many_lines() -> None:
    spread = "[\n  [0.22, -0.10],\n  [0.22, 0.10],\n  [-0.05, 0.10],\n  [-0.05, -0.10]\n]"
    text = changed("[[0.22, -0.10], [0.22, 0.10], [-0.05, 0.10], [-0.05, -0.10]]", spread)
    text = changed('kinematics = "ackermann"\n', "", text).replace(
        "]\n\n[limits]", ']\nkinematics = "x"\n\n[limits]'
    )
    assert refused(text).where == f"bot.toml:{line_of('kinematics =', text)}: kinematics"


def test_what_is_not_toml_is_refused_at_its_line() -> None:
    text = changed("beams = 360", "beams = = 360")
    error = refused(text)
    assert error.where == f"bot.toml:{line_of('beams', text)}"
    assert "not TOML" in error.problem


def test_numbers_that_no_float_can_hold_are_refused() -> None:
    for huge in ("1" + "0" * 400, "1" + "0" * 5000, "0x1" + "f" * 6000):
        for old in ("beams = 360", "rate_hz = 10.0", 'title = "Wheeltec mini Ackermann"'):
            refused(changed(old, f"{old.split()[0]} = {huge}"))


# Any value in the place of any field.


def toml(value: Any) -> str:
    """`value` as TOML on one line."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(key)} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        plain = all(character.isprintable() and character not in '"\\' for character in value)
        return f'"{value}"' if plain else '"' + "".join(f"\\U{ord(c):08x}" for c in value) + '"'
    return str(value)


def document(data: dict[str, Any]) -> str:
    return "".join(f"{key} = {toml(value)}\n" for key, value in data.items())


def places(data: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    below = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [path] * bool(path) + [place for key, item in below for place in places(item, (*path, key))]


def put(data: Any, path: tuple[Any, ...], value: Any) -> Any:
    if not path:
        return value
    items = dict(data) if isinstance(data, dict) else list(data)
    items[path[0]] = put(items[path[0]], path[1:], value)
    return items


SCALARS = st.one_of(
    st.floats(), st.floats(-3, 3), st.integers(), st.integers(-3, 3), st.booleans(), st.datetimes(), st.text()
)
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text("ab"), inner, max_size=3)
)
TEXTS = [entry.file.read_text(encoding="utf-8") for entry in list_profiles()]


def loads_or_is_refused(text: str) -> None:
    try:
        robot = parse_profile(text, "bot", "bot.toml")
    except ProfileError:
        refused(text)
    else:
        assert is_safe(robot)


def is_safe(robot: RobotProfile) -> bool:
    limits = robot.limits
    return (
        0 < robot.defaults.speed_mps <= limits.max_speed_mps <= 10
        and 0 < robot.defaults.rate_radps <= limits.max_rate_radps <= 20
        and 0 <= limits.max_sideways_mps <= limits.max_speed_mps
        and min(limits.acceleration_mps2, limits.angular_acceleration_radps2, limits.deceleration_mps2) > 0
        and 0 < robot.footprint_radius_m < 10
    )


@settings(max_examples=200, deadline=None)
@given(data=st.data(), text=st.sampled_from(TEXTS), value=VALUES)
def test_any_value_in_any_field_loads_or_is_a_profile_error(
    data: st.DataObject, text: str, value: Any
) -> None:
    parsed = tomllib.loads(text)
    path = data.draw(st.sampled_from(places(parsed)))
    loads_or_is_refused(document(put(parsed, path, value)))


@settings(max_examples=150, deadline=None)
@given(text=st.sampled_from(TEXTS), data=st.data(), junk=st.text(max_size=8))
def test_any_text_anywhere_loads_or_is_a_profile_error(text: str, data: st.DataObject, junk: str) -> None:
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 40)))
    loads_or_is_refused(text[:start] + junk + text[end:])


def test_the_property_tests_start_from_profiles_that_load() -> None:
    for text in TEXTS:
        assert is_safe(parse_profile(document(tomllib.loads(text)), "bot"))


def with_limits(**values: float) -> str:
    lines = "".join(
        f'{name} = {{ value = {value}, source = "measured" }}\n' for name, value in values.items()
    )
    return MECANUM.replace("\n[defaults]", f"{lines}\n[defaults]", 1)


def test_wheels_and_jerk_are_limited_where_a_profile_says_so() -> None:
    text = with_limits(max_wheel_speed_mps=1.2, wheel_reach_m=0.2, jerk_mps3=4.0, angular_jerk_radps3=8.0)
    limits = parse_profile(text, "bot").limits
    assert (limits.max_wheel_speed_mps, limits.wheel_reach_m) == (1.2, 0.2)
    assert (limits.jerk_mps3, limits.angular_jerk_radps3) == (4.0, 8.0)
    assert limits.wheel_speed_mps(0.5, -0.25, 0.5) == pytest.approx(0.85)
    unlimited = parse_profile(MECANUM, "bot").limits
    assert (unlimited.max_wheel_speed_mps, unlimited.jerk_mps3) == (math.inf, math.inf)


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"max_wheel_speed_mps": 1.2}, "wheel_reach_m"),
        ({"wheel_reach_m": 0.2}, "wheel_reach_m"),
        ({"max_wheel_speed_mps": 0.9, "wheel_reach_m": 0.2}, "max_wheel_speed_mps.value"),
        ({"max_wheel_speed_mps": 1.2, "wheel_reach_m": 0.7}, "max_wheel_speed_mps.value"),
        ({"jerk_mps3": 3.9}, "jerk_mps3.value"),
        ({"angular_jerk_radps3": 7.9}, "angular_jerk_radps3.value"),
        ({"jerk_mps3": 0.0}, "jerk_mps3.value"),
    ],
)
def test_limits_that_do_not_fit_together_are_refused(values: dict[str, float], field: str) -> None:
    assert refused(with_limits(**values)).where.endswith(f"limits.{field}")


# --- the motion budget ---

BUDGETS = [
    ("", MotionBudget()),
    ("max_distance_m = 250\n", MotionBudget(250.0)),
    ('max_time_s = "none"\n', MotionBudget(None, math.inf)),
    ('max_distance_m = "none"\nmax_time_s = 30.5\n', MotionBudget(math.inf, 30.5)),
]


@pytest.mark.parametrize(("lines", "budget"), BUDGETS)
def test_the_motion_budget_stands_under_safety(lines: str, budget: MotionBudget) -> None:
    assert parse_profile(f"{MECANUM}\n[safety]\n{lines}", "bot").safety.budget == budget


@pytest.mark.parametrize("value", ["0", "-3", "inf", "nan", "true", '"all"', '"100"', "1e9"])
@pytest.mark.parametrize("key", ["max_distance_m", "max_time_s"])
def test_what_is_no_motion_budget_is_refused(key: str, value: str) -> None:
    error = refused(f"{MECANUM}\n[safety]\n{key} = {value}\n")
    assert f"safety.{key}" in error.where
    assert '"none"' in error.allowed


def test_a_budget_is_no_table_of_its_own() -> None:
    assert "max_distance_m" in refused(f"{MECANUM}\n[safety]\nbudget = 3\n").allowed
