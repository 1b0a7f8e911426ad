"""Position gains in 1/s, of registers of any kind: closed formulas, following errors of runs."""

import zipfile

import numpy as np
import pytest
from conftest import FMUS, ROOT

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.linear import gains, position_gain

CIRCLE = ROOT / "scenarios/circle"
CODE = 20.0 / 65536.0  # [V] of the DAC


def test_gain_of_a_card_is_that_of_the_formula() -> None:
    # speed per volt, of counts per turn, by the register at its scale: another one for each axis
    for name in ("circle", "circle_theory"):
        given = {"mcc.p_gain": [173, 40, 0, 0, 0, 0], "card.p_scale": 5}
        found = linear.gain_of(ROOT / "scenarios" / name, set=given)
        assert [(g.name, g.axis, g.value) for g in found] == [
            ("mcc.p_gain", 1, 173),
            ("mcc.p_gain", 2, 40),
        ]
        for gain in found:
            formula = gain.value / 2**5 * CODE * 300.0 * 10_000 / 60.0
            assert gain.kp == pytest.approx(formula, rel=1e-6)
    assert str(found[0]) == "mcc.p_gain[1] = 173 (Kp 82.5 1/s)"


def test_only_the_gain_that_acts_is_told() -> None:
    # axis 1 is moved by pulses and its drive's own loop; 3 by the library's law in volts per count
    found = linear.gain_of(ROOT / "scenarios/output_modes")
    assert [(g.name, g.axis) for g in found] == [("mcc.p_gain", 2), ("mcc.software_gain", 3)]
    assert found[1].kp == pytest.approx(0.95e-3 * 300.0 * 10_000 / 60.0, rel=1e-6)
    assert linear.gain_of(ROOT / "scenarios/robot_line") == ()
    # in 1/s already, and still right: the drive's position loop around its velocity loop
    axis = linear.model(ROOT / "scenarios/output_modes", 1, {"machine.motor_speed": 10.0})
    told = axis.value("drives.position_gain")
    assert linear.kp_of(axis, "drives.position_gain") == pytest.approx(told, rel=1e-3)


def test_following_error_of_a_ramp_is_speed_over_gain() -> None:
    # 45 degrees at 6000 mm/min: both axes at 70.71 mm/s, each with a gain of its own
    scenario = motionfmu.load(ROOT / "scenarios/mismatch_line")
    result = scenario.run()
    at = np.argmax(result["mcc.path_feed"] > 99.9) + 2000  # 0.2 s of settling
    assert result["mcc.path_feed"][at] == pytest.approx(100.0, abs=0.05)
    for gain in linear.gain_of(scenario):
        counts = result["card.err_count"][at : at + 100, gain.axis - 1].mean()
        speed = 100.0 / np.sqrt(2.0) * 1000.0  # [counts/s], 10 mm and 10000 counts a turn
        assert speed / counts == pytest.approx(gain.kp, rel=2e-3)


RAMP = {"p_gain": 1660, "step_target": False, "speed": 4000.0}  # [counts/s] of 5 um


def test_gain_of_a_hydraulic_axis_is_that_of_its_ramps() -> None:
    # Friction is in both following errors: their difference is that of 20 and 40 mm/s over Kp.
    given = {f"{p}.{n}": v for p in ("p", "gap") for n, v in RAMP.items()}
    given |= {"gap_axis.valve_overlap": 0.0, "gap.speed": 8000.0}
    scenario = motionfmu.load(ROOT / "scenarios/hydraulic_p_step")
    result = scenario.run(set=given, stop=0.6)
    slow, fast = (result[f"{p}.error"][-500:].mean() for p in ("p", "gap"))
    between = {"axis.table_speed": 0.03, "gap_axis.table_speed": 0.03}
    gains = linear.gain_of(scenario, set=given, at=between)
    assert [(g.name, g.axis) for g in gains] == [("p.p_gain", 0), ("gap.p_gain", 0)]
    for gain in gains:
        assert 4000.0 / (fast - slow) == pytest.approx(gain.kp, rel=2e-3)
    # 4948 counts/s per volt, 10 mV per PWM count; the integral is no part of it
    given |= {"p.law": 2, "p.i_gain": 64, "p.band": 0}
    for gain in linear.gain_of(scenario, set=given):
        assert gain.kp == pytest.approx(4948.0 * 0.01 * 1660 / 4096, rel=5e-3)


def _kp(path=CIRCLE, **given):
    return [g.kp for g in linear.gain_of(path, **given)]


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder without kept gains, and what is worked out from now on."""
    monkeypatch.setenv("MOTIONFMU_CACHE", str(tmp_path / "kept"))
    made, work = [], position_gain.found
    monkeypatch.setattr(position_gain, "found", lambda *a: made.append(a) or work(*a))
    return tmp_path, made, monkeypatch


def test_gains_are_worked_out_again_when_anything_changes(place) -> None:
    _, made, monkeypatch = place
    once = _kp()
    assert _kp() == once and len(made) == 1
    twice = _kp(set={"mcc.p_gain": [400, 200, 0, 0, 0, 0]})
    assert twice == pytest.approx([2.0 * once[0], once[1]], rel=1e-9)
    assert _kp(axis=2) == once[1:]
    assert _kp(at={"machine.motor_speed": 20.0}) == pytest.approx(once, rel=1e-6)
    written = motionfmu.load(CIRCLE).changed(set={"mcc.p_gain": 100})
    assert _kp(written) == pytest.approx([0.5 * kp for kp in once], rel=1e-9)
    assert len(made) == 5
    monkeypatch.setattr(gains, "_text", lambda: "another text of the package")
    assert _kp() == once and len(made) == 6


@pytest.mark.parametrize(
    ("fmu", "law", "other", "factor"),
    [
        ("epcio", b"* host_p_gain /", b"* 3 * host_p_gain /", 3.0),
        ("ball_screw_axes", b'"description": "', b'"description": "Another: ', 1.0),
    ],
)
def test_another_fmu_has_gains_of_its_own(
    place, fmu: str, law: bytes, other: bytes, factor: float
) -> None:
    folder, made, monkeypatch = place
    once = _kp()
    for built in FMUS.glob("*.fmi3.fmu"):
        (folder / built.name).symlink_to(built)
    changed = folder / f"{fmu}.fmi3.fmu"
    changed.unlink()
    with zipfile.ZipFile(FMUS / changed.name) as own, zipfile.ZipFile(changed, "w") as archive:
        texts = {name: own.read(name) for name in own.namelist()}
        assert any(law in text for name, text in texts.items() if "/org.motionfmu/" in name)
        for name, text in texts.items():
            mine = "/org.motionfmu/" in name
            archive.writestr(name, text.replace(law, other, 1) if mine else text)
    monkeypatch.setenv("MOTIONFMU_FMUS", str(folder))
    position_gain.law.carried.cache_clear()
    try:
        assert _kp() == pytest.approx([factor * kp for kp in once], rel=1e-9)
        assert len(made) == 2
    finally:
        position_gain.law.carried.cache_clear()


@pytest.mark.parametrize(
    ("kp", "words"),
    [(9.996, "10.0"), (99.94, "99.9"), (99.95, "100"), (100, "100"), (250.4, "250")],
)
def test_three_digits_and_never_a_bare_point(kp: float, words: str) -> None:
    assert gains.in_words(kp) == f"{words} 1/s"
