"""Programs in a language that a machine's controller does not read."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from console import within
from refusals import refusal

import motionfmu
from motionfmu.analysis.gcode import read, strokes

FRAME = ROOT / "src/motionfmu/machines/engraver/example.plt"  # 80 x 50 mm from (10, 10) on
RING = "G0 X10 Y10\nG1 X30 F1200\nG2 I-5\nM2\n"


def test_a_drawing_on_a_network_card() -> None:
    result = motionfmu.machine("engraver").run(FRAME)
    assert result.ok
    place = result["machine.table_position"][:, :2]
    assert place.max(axis=0) == pytest.approx([0.090, 0.060], abs=5e-5)
    assert result["card.state"][-1] == 1 and 2 in result["card.state"]


@pytest.mark.parametrize(("name", "depth"), [("mill3", -1e-3), ("xy_table", 0.0)])
def test_a_drawing_on_a_mill_is_a_part_program(name: str, depth: float) -> None:
    result = motionfmu.machine(name).run(FRAME, set={"mcc.feed": 3000})
    assert result.ok
    place = result["machine.table_position"]
    assert place[:, :2].max(axis=0) == pytest.approx([0.090, 0.060], abs=3e-5)
    assert place[:, 2].min() == pytest.approx(depth, abs=3e-5)
    # With the tool down, and exact stops at the corners, the pulses are on the drawing's outline.
    x, y, z = result["card.pulse_count"][:, :3].T * 1e-3
    down = z == depth * 1e3
    edge = np.min([np.abs(x - 10), np.abs(x - 90), np.abs(y - 10), np.abs(y - 60)], axis=0)
    assert edge[down].max() < 2e-3 or name == "xy_table"  # which has no pen to raise


def test_a_part_program_on_a_network_card(tmp_path: Path) -> None:
    (tmp_path / "ring.ngc").write_text(RING)
    result = motionfmu.machine("engraver").run(tmp_path / "ring.ngc")
    assert result.ok
    x, y = result["card.pulse_count"][:, :2].T / 640  # [mm]
    radius = np.hypot(x - 25, y - 10)
    ring = np.abs(radius - 5) < 0.5
    assert np.abs(radius[ring & (np.abs(y - 10) > 1)] - 5).max() < 0.025  # 0.02 of the plan
    assert y[ring].max() == pytest.approx(15, abs=0.025)


def test_chords_are_as_near_to_arcs_as_asked(tmp_path: Path) -> None:
    program = read(RING)
    for chord in (1e-2, 1e-3):
        *_, cut = strokes(program, chord)
        middle = 0.5 * (cut.points[1:] + cut.points[:-1])[1:]
        off = 5 - np.hypot(middle[:, 0] - 25, middle[:, 1] - 10)
        assert off.max() <= chord * 1.01
    assert off.max() > 0.5e-3  # and not much nearer than that


def test_a_drawing_and_a_machine_are_kept_as_a_scenario(tmp_path: Path) -> None:
    shutil.copy(FRAME, tmp_path / "frame.plt")
    words = ("run", "frame.plt", "--machine", "engraver", "--save-as", "kept")
    ran = within(*words, folder=tmp_path)
    assert ran.returncode == 0, ran.stderr
    kept = sorted(p.name for p in (tmp_path / "kept").iterdir())
    assert kept == ["frame.mcj", "scenario.toml"]
    of_scenario = motionfmu.load(tmp_path / "kept").run(stop=0.5)
    direct = motionfmu.machine("engraver").scenario(tmp_path / "frame.plt").run(stop=0.5)
    assert all(np.array_equal(of_scenario[n], direct[n]) for n in direct.signals)


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.txt", "", "a.txt: a drawing (.plt, .hpgl, .hgl, .plo, .svg, .dxf), a job (.mcj) or a"),
        ("a.svg", "<svg/>", "a.svg: nothing is drawn"),
        ("a.ngc", "G1 X\n", "a.ngc: line 1: "),
        ("a.ngc", "G1 X5 F600\nG1 Z-1\n", "a.ngc: line 2: Z moves with feed; the card draws in"),
        ("a.ngc", "G0 X5\n", "a.ngc: nothing is drawn"),
        ("a.ngc", "G0 X5\nG1 X500 F600\n", "a.ngc"),
    ],
)
def test_what_no_card_can_draw(tmp_path: Path, name: str, text: str, told: str) -> None:
    (tmp_path / name).write_text(text)
    (first, *_) = refusal(motionfmu.machine("engraver").scenario, tmp_path / name)
    assert told in first


def test_drawings_that_draw_nothing_and_a_card_without_configuration(tmp_path: Path) -> None:
    (tmp_path / "a.plt").write_text("IN;PU400,400;")
    assert refusal(motionfmu.machine("mill3").scenario, tmp_path / "a.plt") == [
        f"{tmp_path}/a.plt: nothing is drawn"
    ]
    (tmp_path / "machine.toml").write_text(
        '# A card.\nextends = "engraver"\n[signals]\nconfig = "none.toml"\n'
    )
    assert refusal(motionfmu.machine(tmp_path).scenario, FRAME) == [
        f"{tmp_path}/machine.toml:4: config = 'none.toml': no such file"
    ]
