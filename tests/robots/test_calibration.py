"""What a person measures becomes a correction, and gets into the user's own profile."""

from __future__ import annotations

from pathlib import Path

import pytest

from chatrobot.core.errors import ProfileError
from chatrobot.robots.calibration import (
    DEGREES,
    METRES,
    Measured,
    corrected,
    read_measure,
    reset_calibration,
    save_calibration,
)
from chatrobot.robots.load import load_profile
from chatrobot.robots.parse import parse_profile
from chatrobot.robots.profile import Calibration


@pytest.mark.parametrize(
    ("text", "units", "means"),
    [
        ("0.95", METRES, 0.95),
        (" 95 cm ", METRES, 0.95),
        ("95cm", METRES, 0.95),
        ("0,95", METRES, 0.95),
        ("950 mm", METRES, 0.95),
        ("1 Metre", METRES, 1.0),
        ("九十", METRES, None),
        ("95 inch", METRES, None),
        ("", METRES, None),
        ("1 2", METRES, None),
        ("nan", METRES, None),
        ("352°", DEGREES, 352.0),
        ("352 degrees", DEGREES, 352.0),
        ("352", DEGREES, 352.0),
        ("352 cm", DEGREES, None),
    ],
)
def test_a_measure_is_read_with_its_unit(text: str, units: dict[str, float], means: float | None) -> None:
    got = read_measure(text, units)
    assert got == (means if means is None else pytest.approx(means))


def test_corrections_multiply() -> None:
    first = corrected(Calibration(), Measured(0.95, 1.0), None, "first")
    second = corrected(first, Measured(1.01, 1.0), Measured(351.0, 360.0), "second")
    assert second == Calibration(0.9595, 0.975, "second")


@pytest.mark.parametrize("measured", [Measured(2.0, 1.0), Measured(95.0, 1.0), Measured(1.0, 0.0)])
def test_what_is_too_far_off_is_no_calibration(measured: Measured) -> None:
    assert not measured.is_plausible


def test_a_built_in_profile_is_copied_and_takes_its_own_place(tmp_path: Path) -> None:
    calibration = Calibration(0.97, 1.01, "me, today")
    file = save_calibration("turtlebot4", calibration, tmp_path)
    assert file == tmp_path / "turtlebot4.toml"
    found = load_profile("turtlebot4", (tmp_path,))
    assert found.calibration == calibration
    assert found.limits == load_profile("turtlebot4").limits


def test_a_second_calibration_takes_the_place_of_the_first(tmp_path: Path) -> None:
    save_calibration("turtlebot4", Calibration(0.97, 1.01, "first"), tmp_path)
    file = save_calibration("turtlebot4", Calibration(0.98, 1.0, "second"), tmp_path)
    assert file.read_text(encoding="utf-8").count("[calibration]") == 1
    assert load_profile("turtlebot4", (tmp_path,)).calibration == Calibration(0.98, 1.0, "second")


def test_a_profile_given_as_a_file_is_changed_itself(tmp_path: Path) -> None:
    text = (Path(__file__).parents[2] / "src/chatrobot/robots/profiles/generic_diff.toml").read_text("utf-8")
    mine = tmp_path / "mine.toml"
    head, _, rest = text.partition("[wiring]")
    mine.write_text(
        f'{head}[calibration]\ndistance_scale = 2.0\nturn_scale = 1.0\nsource = "x"\n\n[wiring]{rest}',
        "utf-8",
    )
    assert save_calibration(str(mine), Calibration(0.9, 1.0, "y"), tmp_path / "robots") == mine
    after = load_profile(str(mine))
    assert after.calibration.distance_scale == 0.9
    assert after.wiring == parse_profile(text, "mine").wiring


def test_a_scale_that_cannot_be_is_refused() -> None:
    file = Path(__file__).parents[2] / "src/chatrobot/robots/profiles/generic_diff.toml"
    text = file.read_text(encoding="utf-8")
    with pytest.raises(ProfileError, match="distance_scale"):
        parse_profile(f'{text}\n[calibration]\ndistance_scale = 9\nturn_scale = 1\nsource = "x"\n', "x")


def test_a_correction_of_a_person_s_own_profile_goes_and_the_rest_stays(tmp_path: Path) -> None:
    save_calibration("wheeltec_mini_mec", Calibration(0.97, 1.01, "me"), tmp_path)
    file = tmp_path / "wheeltec_mini_mec.toml"
    title = load_profile(str(file)).title
    file.write_text(file.read_text().replace(title, "Mine"))
    assert reset_calibration("wheeltec_mini_mec", tmp_path) == file
    kept = load_profile(str(file))
    assert (kept.calibration, kept.title) == (Calibration(), "Mine")
    assert reset_calibration("wheeltec_mini_mec", tmp_path) is None


def test_a_profile_that_is_a_file_is_reset_in_its_place(tmp_path: Path) -> None:
    save_calibration("wheeltec_mini_mec", Calibration(0.97, 1.01, "me"), tmp_path)
    file = (tmp_path / "wheeltec_mini_mec.toml").rename(tmp_path / "mine.toml")
    assert reset_calibration(str(file), tmp_path / "elsewhere") == file
    assert load_profile(str(file)).calibration == Calibration()
