"""Programs in a language that a machine's controller does not read."""

import io
import json
import shutil
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from conftest import ROOT
from console import within
from ezdxf.math import Matrix44
from lines_apart import apart
from refusals import refusal
from svgelements import SVG as SvgFile
from svgelements import Move, Shape
from svgelements import Path as SvgPath

import motionfmu
from motionfmu import InputError
from motionfmu.analysis.gcode import read, strokes
from motionfmu.cards import card_job
from motionfmu.cards.server_page.job_pictures import pen_down

FRAME = ROOT / "src/motionfmu/machines/engraver/example.plt"  # 80 x 50 mm from (10, 10) on
RING = "G0 X10 Y10\nG1 X30 F1200\nG2 I-5\nM2\n"


def test_a_configuration_beside_the_drawing_is_not_the_machines(tmp_path: Path) -> None:
    """A card.toml that lies there for another card changes nothing and is not read."""
    frame = Path(shutil.copy(FRAME, tmp_path / "frame.plt"))
    (tmp_path / "card.toml").write_text("nonsense = 3\n")
    machine = motionfmu.machine("engraver")
    assert machine.config == FRAME.parent / "card.toml"
    found, wanted = (machine.scenario(file).run(stop=0.2) for file in (frame, FRAME))
    assert np.array_equal(found["card.pulse_count"], wanted["card.pulse_count"])


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
    more = ("--scale", "0.5", "--copies", "2x1", "--pitch", "45", "0")
    words = ("run", "frame.plt", "--machine", "engraver", "--save-as", "kept", *more)
    ran = within(*words, folder=tmp_path)
    assert ran.returncode == 0, ran.stderr
    kept = sorted(p.name for p in (tmp_path / "kept").iterdir())
    assert kept == ["frame.mcj", "scenario.toml"]
    of_scenario = motionfmu.load(tmp_path / "kept").run(stop=0.5)
    asked = {"scale": 0.5, "copies": [2, 1], "pitch": [45, 0]}
    plan = motionfmu.machine("engraver").scenario(tmp_path / "frame.plt", drawing=asked)
    direct = plan.run(stop=0.5)
    assert all(np.array_equal(of_scenario[n], direct[n]) for n in direct.signals)


# Lines along X 20 mm and 30 mm long, each on a page of its own.
PAGES = "IN;SP1;PU0,0;PD800,0;PU;PG;PU0,0;PD1200,0;PU;PG;"


@pytest.mark.parametrize("machine", ["xy_table", "engraver"])
def test_a_page_of_several_is_chosen_and_told(machine: str, tmp_path: Path) -> None:
    """By run, check and the table: what is drawn, and how many pages there are."""
    (tmp_path / "two.plt").write_text(PAGES)
    for page, length in ((1, 20.0), (2, 30.0)):
        told = f"two.plt: page {page} of 2; --page or [drawing] page chooses another"
        asked = () if page == 1 else ("--page", "2")
        for command in ("check", "run"):
            words = (command, "two.plt", "--machine", machine, *asked)
            ran = within(*words, folder=tmp_path)
            assert ran.returncode == 0, ran.stderr
            assert told in ran.stdout.replace("\n", " ")
        plan = motionfmu.machine(machine).scenario(tmp_path / "two.plt", drawing={"page": page})
        assert [note.partition("/two.plt")[2] for note in plan.notes] == [told[7:]]
        place = plan.run()["machine.table_position"][:, 0]
        assert place.max() == pytest.approx(length * 1e-3, abs=5e-5)
    with pytest.raises(InputError, match=r"two\.plt: no page 3, it has 2 pages"):
        motionfmu.machine(machine).scenario(tmp_path / "two.plt", drawing={"page": 3})
    (tmp_path / "one.plt").write_text("IN;SP1;PU0,0;PD800,0;")
    assert motionfmu.machine(machine).scenario(tmp_path / "one.plt").notes == ()


@pytest.mark.more
def test_a_look_at_a_page_of_several(tmp_path: Path) -> None:
    """By gcode, with and without a machine."""
    (tmp_path / "two.plt").write_text(PAGES)
    for on in ((), ("--machine", "mill3")):
        for page, length in ((1, 20.0), (2, 30.0)):
            words = ("gcode", "two.plt", "--page", str(page), *on)
            ran = within(*words, folder=tmp_path)
            told = f"two.plt: page {page} of 2; --page or [drawing] page chooses another"
            assert ran.returncode == 0 and told in ran.stdout.replace("\n", " "), ran.stderr
            assert f"X 0.0000 .. {length:.4f} mm" in ran.stdout
            found = json.loads(within(*words, "--json", folder=tmp_path).stdout)["two.plt"]
            assert (found["page"], found["pages"]) == (page, 2)


SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="60mm" viewBox="0 0 80 60">
<g transform="translate(10 10) rotate(15 20 15)">
<rect width="30" height="20" rx="4"/><circle cx="10" cy="10" r="3"/>
<path d="M16 5 c 2 -4 8 -4 9 2 s -3 6 -6 7 z"/></g>
<text y="5">left out</text></svg>
"""


def drawn_twin(folder: Path) -> dict[str, Path]:
    """The same contours in SVG and DXF."""
    (folder / "a.svg").write_text(SVG)
    doc = ezdxf.new("R2010", units=4)
    at, turn = doc.modelspace(), Matrix44.z_rotate(-np.radians(15))
    turn = Matrix44.translate(-20, 15, 0) @ turn @ Matrix44.translate(30, 35, 0)
    corner = np.tan(np.pi / 8)
    rows = [(4, 0), (26, 0), (30, -4), (30, -16), (26, -20), (4, -20), (0, -16), (0, -4)]
    parts = [at.add_lwpolyline([(x, y, -corner * (k % 2)) for k, (x, y) in enumerate(rows)], "xyb")]
    parts[0].closed = True
    parts.append(at.add_circle((10, -10), 3))
    curve = [(16, -5), (18, -1), (24, -1), (25, -7), (26, -13), (22, -13), (19, -14)]
    parts += [at.add_open_spline(curve[k : k + 4]) for k in (0, 3)]
    parts.append(at.add_line(curve[-1], curve[0]))
    for part in parts:
        part.transform(turn)
    at.add_text("left out")
    doc.saveas(folder / "a.dxf")
    return {"svg": folder / "a.svg", "dxf": folder / "a.dxf"}


def cut(program: Path) -> list[np.ndarray]:
    """What a mill's program draws, where the tool is down."""
    every = strokes(read(program), 1e-4)
    found = [s.points[np.isclose(s.points[:, 2], -1), :2] for s in every if not s.rapid]
    return [p for p in found if len(p) > 1]


def exact(scale: float = 1.0) -> list[np.ndarray]:
    """The contours of SVG by svgelements' point() [mm]."""
    found = []
    whole = SvgFile.parse(io.BytesIO(SVG.encode()), ppi=25.4)
    for shape in whole.elements():
        if isinstance(shape, Shape):
            path = abs(SvgPath(shape))
            t = np.linspace(0.0, 1.0, 200)
            parts = [[p.point(x) for x in t] for p in path if not isinstance(p, Move)]
            found.append(np.array([[p.x, 60.0 - p.y] for part in parts for p in part]) * scale)
    return found


@pytest.mark.parametrize("kind", ["svg", "dxf"])
def test_a_mill_and_a_card_get_the_same_drawing(kind: str, tmp_path: Path) -> None:
    file = drawn_twin(tmp_path)[kind]
    mill, card = (motionfmu.machine(name) for name in ("mill3", "engraver"))
    made = mill.translated(file, {})
    text = made.file.read_text()
    assert text.count("G2 ") + text.count("G3 ") == 6 and text.count("G5 ") == 2
    assert len(made.notes) == 1 and "left out" in made.notes[0]
    # The reader shows a curve by 41 points.
    assert apart(exact(), cut(made.file)) < 0.0035 and apart(cut(made.file), exact()) < 0.001
    # The first is the circle, which lies in the outline.
    assert np.ptp(cut(made.file)[0], axis=0) == pytest.approx(6.0, abs=1e-3)
    job_ = card_job.read(card.translated(file, {}).file)
    places = job_.positions[:, :2] / 640
    down = pen_down(job_, np.zeros(len(places)))
    # 0.02 mm of the plan, chords, half a pulse
    assert apart([places[down]], exact()) < 0.026 and apart(exact(), [places[down]], 8) < 0.026


@pytest.mark.more
def test_options_of_a_drawing_are_those_of_mill_and_card(tmp_path: Path) -> None:
    file = drawn_twin(tmp_path)["svg"]
    asked = {"scale": 0.5, "copies": [2, 2], "pitch": [50, 40], "at": [3, 4]}
    mill, card = (motionfmu.machine(name) for name in ("mill3", "engraver"))
    shifts = [(3, 4), (53, 4), (53, 44), (3, 44)]
    wanted = [p + shift for shift in shifts for p in exact(0.5)]
    found = cut(mill.translated(file, asked).file)
    assert len(found) == 12
    assert apart(wanted, found) < 0.002 and apart(found, wanted) < 0.001
    job_ = card_job.read(card.translated(file, asked).file)
    places = job_.positions[:, :2] / 640
    down = pen_down(job_, np.zeros(len(places)))
    assert apart([places[down]], wanted) < 0.026
    plt = mill.translated(FRAME, asked | {"knife": 0.25}).file.read_text()
    assert plt.count("G3 ") == 4 * 4  # corners of the copies
    with pytest.raises(InputError, match=r"<mill3>:\[drawing\] copies: copies = \[2, 1\]: a pitch"):
        mill.scenario(file, drawing={"copies": [2, 1]})
    with pytest.raises(InputError, match=r"scale = 0: .*greater than 0"):
        mill.scenario(file, drawing={"scale": 0})
    (tmp_path / "a.ngc").write_text(RING)
    with pytest.raises(InputError, match=r"a\.ngc: scale is for drawings"):
        mill.scenario(tmp_path / "a.ngc", drawing={"scale": 2})


def test_a_machine_says_how_it_draws(tmp_path: Path) -> None:
    own = '# A cutter.\nextends = "mill3"\n[drawing]\nknife = 0.25\nup = 3\ndown = -0.5\n'
    (tmp_path / "machine.toml").write_text(own)
    cutter, file = motionfmu.machine(tmp_path), drawn_twin(tmp_path)["svg"]
    text = cutter.translated(file, {}).file.read_text()
    assert "G0 Z3\n" in text and "G1 Z-0.5\n" in text and "G5" not in text
    assert "G5" in cutter.translated(file, {"knife": 0}).file.read_text()
    (tmp_path / "scenario.toml").write_text(
        '# About.\nmachine = "mill3"\nstop = 1.0\n[drawing]\nscale = 2.0\n'
    )
    (told,) = refusal(motionfmu.load, tmp_path)
    assert told == f"{tmp_path}/scenario.toml:4: drawing is a machine's, no scenario's"


@pytest.mark.parametrize("machine", ["mill3", "engraver"])
def test_a_fault_names_the_drawing_and_its_line(machine: str, tmp_path: Path) -> None:
    files = drawn_twin(tmp_path)
    for kind, place in (("svg", "line 3"), ("dxf", "line ")):
        far = motionfmu.machine(machine)
        (told, *_) = refusal(
            lambda f=far, k=kind: f.scenario(files[k], drawing={"scale": 9}).run(stop=0.1)
        )
        assert f"{files[kind]}: {place}" in told and ".ngc" not in told and "limit" in told
        assert kind == "svg" or ", CIRCLE " in told


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--scale", "0"), "--scale 0: above 0 wanted"),
        (("--copies", "3"), "--copies 3: NXxNY wanted, such as 3x2, each 1 to 1000"),
        (("--copies", "3x0"), "--copies 3x0: NXxNY wanted"),
        (("--copies", "2x2", "--pitch", "5", "0"), "--copies 2x2: --pitch X Y is missing"),
        (("--pitch", "5", "0"), "--pitch: --copies is missing"),
        (("--knife", "-1"), "--knife -1: 0 to 100 mm wanted"),
        (("--page", "0"), "--page 0: 1 or more wanted"),
        (("--page", "2"), "no page 2, it has one page"),
        (("--order", "far"), "--order far: file, nearest or inside wanted"),
        (("--corners", "far"), "--corners far: round or stop wanted"),
    ],
)
def test_wrong_options_of_a_drawing(words: tuple[str, ...], told: str, tmp_path: Path) -> None:
    for command in ("run", "gcode"):
        done = within(command, str(FRAME), "--machine", "mill3", *words, folder=tmp_path)
        assert done.returncode == 2 and told in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_look_at_a_drawing_as_a_part_program(tmp_path: Path) -> None:
    file = drawn_twin(tmp_path)["svg"]
    words = ("gcode", str(file), "--machine", "mill3", "-o", "out")
    done = within(*words, "--at", "5", "5", folder=tmp_path)
    assert done.returncode == 0, done.stderr
    assert f"note: {file}: left out <text> (line 5)\n" in done.stdout
    assert (tmp_path / "out/a.gcode/report.html").is_file()
    far = within(*words, "--at", "500", "5", folder=tmp_path)
    assert far.returncode == 1
    assert f"{file}: line 3: path leaves the software limits G0 X5" in far.stdout
    (tmp_path / "a.ngc").write_text(RING)
    wrong = within("gcode", "a.ngc", "--scale", "2", folder=tmp_path)
    assert wrong.returncode == 2 and "--scale: a.ngc: it is for drawings" in wrong.stderr


def test_what_is_left_out_is_a_warning_of_the_run(tmp_path: Path) -> None:
    file = drawn_twin(tmp_path)["svg"]
    scenario = motionfmu.machine("mill3").scenario(file)
    result = scenario.changed(set={"mcc.feed": 3000}).run(stop=0.2)
    assert result.warnings[0] == f"{file}: left out <text> (line 5)"


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
