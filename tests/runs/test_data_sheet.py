"""Data sheets of machines: what the command writes, and what the READMEs of the library say."""

import json
import re
from pathlib import Path

import pytest
from console import within
from few_cases import few
from refusals import refusal

import motionfmu
from motionfmu.analysis.data_sheet import DataSheet, data_sheet
from motionfmu.analysis.data_sheet.sheet_axes import sheet_axes
from motionfmu.report.data_sheet_table import markdown
from motionfmu.scenarios import package_files

LIBRARY = package_files.machines()


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the command writes of a machine that was made like another one."""
    here = tmp_path_factory.mktemp("sheet")
    within("new", "machine", "mine", "--like", "first_order", folder=here)
    told = within("machines", "mine", "--set", "mcc.p_gain=400", folder=here)
    assert told.returncode == 0 and "ISO 230-4, XY, R 50 mm" in told.stdout, told.stderr
    assert "X position" in told.stdout and "report: " in told.stdout
    return here / "results/mine.machine"


@pytest.mark.more
def test_the_folder_of_a_data_sheet(written: Path) -> None:
    names = {f.name for f in written.iterdir()}
    programs = {"iso230_2_X.ngc", "iso230_2_Y.ngc", "iso230_4_XY.ngc"}
    assert names == programs | {
        *("report.html", "result.json", "figures.md", "figures.png", "figures.svg")
    }
    found = json.loads((written / "result.json").read_text())
    assert found["set"] == {"mcc.p_gain": 400} and found["iso9283"] is None
    x = found["axes"]["X"]
    assert x["loops"][0]["kp"] == pytest.approx(95.37, abs=0.01)
    assert len(x["iso230_2"]["up"]) == 5 and (x["low"], x["high"]) == (-100.0, 100.0)
    page = (written / "report.html").read_text()
    for part in ("Positioning", "Circle in XY, radius 50 mm", "Loops", "Programs", "p_gain = 400"):
        assert part in page


@pytest.mark.more
def test_its_programs_give_its_figures(written: Path) -> None:
    """They run by themselves; R shrinks by v^2 / (2 Kp^2), which theory says of this plant."""
    found = json.loads((written / "result.json").read_text())["iso230_4"]["XY"]
    set_ = {"mcc.p_gain": 400}
    result = motionfmu.machine("first_order").run(written / "iso230_4_XY.ngc", set=set_)
    circle = result.contour().circles[0]
    assert circle.both is not None and circle.both.g == found["both"]["g"]
    assert circle.ccw is not None and circle.ccw.coverage > 6.28  # a whole turn, steadily
    kp = 95.367
    assert found["both"]["d"] == pytest.approx(-(50.0**2) / (2 * kp**2 * 50.0), rel=0.03)


def test_wrong_calls(tmp_path: Path) -> None:
    told = within("machines", "mil3", folder=tmp_path)
    assert told.returncode == 2 and "did you mean 'mill3'?" in told.stderr
    told = within("machines", "mill3", "--set", "mcc.p_gan=1", folder=tmp_path)
    assert told.returncode == 2 and "did you mean 'p_gain'?" in told.stderr
    told = within("machines", "--set", "mcc.p_gain=1", folder=tmp_path)
    assert told.returncode == 2 and "--set and --out go with a machine" in told.stderr
    assert not list(tmp_path.iterdir())


def machine_at(folder: Path, text: str) -> motionfmu.Machine:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "machine.toml").write_text("# A machine.\n" + text)
    return motionfmu.machine(folder)


def test_what_a_machine_has_not_is_left_out_with_the_reason(tmp_path: Path) -> None:
    text = 'extends = "first_order"\nwithout = ["contour", "axis.Y", "limits.travel"]\n'
    found = data_sheet(machine_at(tmp_path / "a", text))
    assert not found.circles and found.axes[0].positioning is None
    assert found.left_out["ISO 230-4"].startswith("no two linear axes")
    assert found.left_out["ISO 230-2, X"] == "[limits] has no travel"
    assert found.axes[0].loops and "X" in found.numbers()["axes"]


@pytest.mark.more
def test_a_run_that_fails_has_no_figures(tmp_path: Path) -> None:
    """The axes do not come that far: the lag is more than the library bears."""
    text = 'extends = "first_order"\n[set]\n"mcc.track_error_limit" = 100\n'
    found = data_sheet(machine_at(tmp_path / "a", text))
    assert not found.circles and "mcc." in found.left_out["ISO 230-4, XY"]
    assert {"ISO 230-2, X", "ISO 230-2, Y"} <= found.left_out.keys()


def test_axes_are_moved_where_switches_and_software_let_them() -> None:
    mill = motionfmu.machine("mill4")
    axes = {a.name: a for a in sheet_axes(mill, mill.plan().axis_limits())}
    assert (axes["X"].low, axes["X"].high) == (-250.0, 250.0)
    assert (axes["A"].low, axes["A"].high, axes["A"].unit) == (-180.0, 180.0, "°")
    gantry = motionfmu.machine("gantry")
    second = sheet_axes(gantry, gantry.plan().axis_limits())[3]
    assert second.follows and second.word == "Y" and (second.low, second.high) == (-200.0, 200.0)
    card = motionfmu.machine("engraver")
    assert [(a.low, a.high) for a in sheet_axes(card, card.plan().axis_limits())] == [
        (-5.0, 200.0)
    ] * 2


@pytest.mark.more
def test_a_target_that_lacks_its_unit(tmp_path: Path) -> None:
    text = 'extends = "hydraulic_slide"\nwithout = ["signals.count"]\n'
    found = data_sheet(machine_at(tmp_path / "a", text))
    assert found.left_out["ISO 230-2, slide"] == "[signals] target goes with count and start"
    text = 'extends = "hydraulic_slide"\n[signals]\ncount = 0\n'
    (told,) = refusal(lambda: machine_at(tmp_path / "b", text).plan())
    assert told.startswith(f"{tmp_path}/b/machine.toml:4: signals.count = 0")


@pytest.mark.more
def test_margins_are_those_of_the_command(tmp_path: Path) -> None:
    """`motionfmu margins` of the circle's program, without --at."""
    sheet = data_sheet("mill3")
    (tmp_path / "circle.ngc").write_text(sheet.programs["iso230_4_XY.ngc"])
    call = ["margins", "circle.ngc", "--machine", "mill3", "--axis", "2", "--no-simulate"]
    assert within(*call, folder=tmp_path).returncode == 0
    told = json.loads((tmp_path / "results/circle.margins/result.json").read_text())
    for own, loop in zip(sheet.axes[1].loops, told["loops"], strict=True):
        assert own.at == loop["at"]
        for name in ("gain", "phase", "delay", "sensitivity", "bandwidth"):
            assert getattr(own.margins, name) == pytest.approx(loop["margins"][name], rel=1e-9)


MINUS = "\N{MINUS SIGN}"
NUMBER = re.compile(rf"[-{MINUS}]?\d+(?:\.\d+)?")


def numbers(row: str) -> list[float]:
    return [float(n.replace(MINUS, "-")) for n in NUMBER.findall(row)]


FIGURES = ("| ISO", "| position loop:", "| velocity loop:", "| its step:", "- ISO")


@pytest.mark.more
@pytest.mark.parametrize("name", few(sorted(LIBRARY), ["mill3", "robot6"], pytest.mark.long))
def test_a_readme_has_the_figures_of_a_run(name: str) -> None:
    """Each row of the table that the command writes, within 1 % or the last digit, and no other."""
    readme = (LIBRARY[name] / "README.md").read_text()
    sheet: DataSheet = data_sheet(name)
    told, found = (
        [row for row in text.splitlines() if row.startswith(FIGURES)]
        for text in (readme, markdown(sheet))
    )
    assert found and [NUMBER.sub("#", r) for r in told] == [NUMBER.sub("#", r) for r in found]
    for own, row in zip(told, found, strict=True):
        assert numbers(own) == pytest.approx(numbers(row), rel=0.01, abs=0.011), row
    assert (LIBRARY[name] / "figures.png").is_file() and "figures.png" in readme
