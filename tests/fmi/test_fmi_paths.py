"""Files that parameters name: by path, by URI, and as what an FMU carries."""

import os
import shutil
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_tools import ERROR, OK, Instance
from fmpy import read_model_description, simulate_fmu

from motionfmu.base.errors import InputError
from motionfmu.fmu.pack import repacked
from motionfmu.scenarios.fmus import fmu_path

both = pytest.mark.parametrize("fmi", (2, 3))
NAME = "pärt ü.ngc"
TEXT = "G91 G0 X0 Y0\nG1 X5 Y3 F3000\nG2 I2 J0\nM2\n"
FRAMES = "card_cmd_frames"
SEEN = {2: ["queue", *(f"{FRAMES}[{i},1]" for i in range(1, 17))], 3: ["queue", FRAMES]}


def told(fmi: int, where: str, resources: Path, key: str = "program", name: str = "mcc") -> str:
    """What an FMU with other resources says of a file; empty if it is content."""
    instance = Instance(name, fmi, resources=str(resources))
    try:
        assert instance.set(key, where) == OK
        assert instance.enter() == OK
        status = instance.call("ExitInitializationMode")
        return "" if status == OK else instance.said.removeprefix("one: ")
    finally:
        instance.free()


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with resources and a program beside them, which is where we are."""
    (tmp_path / "resources/sub").mkdir(parents=True)
    for name in (NAME, f"resources/{NAME}", "resources/sub/b.ngc", "resources/tools.tbl"):
        (tmp_path / name).write_text(TEXT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@both
def test_a_path_a_uri_and_a_resource_name_a_program(fmi: int, place: Path) -> None:
    uri = (place / NAME).as_uri()
    assert "%C3%A4" in uri and "%20" in uri
    plain = str(place / NAME)
    for where in (NAME, plain, uri, uri.replace("///", "/"), f"file://localhost{uri[7:]}"):
        assert told(fmi, where, place / "resources") == ""
    for where in (uri.replace("file", "FILE"), f"file://{plain}"):
        assert told(fmi, where, place / "resources") == ""
    for where in (f"resource:{NAME}", "resource:sub/b.ngc", f"Resource:{NAME}"):
        assert told(fmi, where, place / "resources") == ""
        assert told(fmi, where, (place / "resources").as_uri()) == ""  # type: ignore[arg-type]


WRONG = {
    "resource:gone.ngc": f"no such file in the FMU's resources; there are: {NAME}, sub, tools.tbl",
    "resource:../a.ngc": 'a file inside the FMU\'s resources, without ".."',
    "resource:sub/../../a.ngc": 'a file inside the FMU\'s resources, without ".."',
    "resource:/etc/passwd": 'a file inside the FMU\'s resources, without ".."',
    "resource:": 'a file inside the FMU\'s resources, without ".."',
    "resource:sub": "Is a directory",
    "file://host/a.ngc": "file:///PATH is wanted, on this machine",
    "file:a.ngc": "file:///PATH is wanted, on this machine",
    "file:///a%zz": "a % in a URI is followed by two hexadecimal digits, not 00",
    "file:///a%00b": "a % in a URI is followed by two hexadecimal digits, not 00",
    "file:///a%4": "a % in a URI is followed by two hexadecimal digits, not 00",
    "file:///gone.ngc": "No such file or directory",
    "http://host/a.ngc": "a path, file:///PATH or resource:NAME is wanted",
    "./resource:a": "No such file or directory",
}


@both
@pytest.mark.parametrize("where", WRONG)
def test_what_is_wrong_with_a_place_is_told(fmi: int, where: str, place: Path) -> None:
    said = told(fmi, where, place / "resources")
    assert said == f"program: cannot read {where}: {WRONG[where]}" or (
        said == f"program: cannot read {where}: resource:NAME is {WRONG[where]}"
    )


@both
def test_empty_and_unknown_resources_are_told(fmi: int, place: Path) -> None:
    (place / "empty").mkdir()
    said = told(fmi, "resource:a", place / "empty")
    assert said.endswith("no such file in the FMU's resources, which are empty")
    assert "has named no folder" in told(fmi, "resource:a", "")  # type: ignore[arg-type]
    for i in range(400):
        (place / f"empty/{i:04d}").touch()
    said = told(fmi, "resource:a", place / "empty")
    assert "there are: 0000, 0001, 0002" in said and len(said) < 4200


@both
@pytest.mark.parametrize(
    ("name", "key"),
    [("mcc", "comp_file"), ("mcc", "tool_table"), ("mcc_groups", "group2_program")]
    + [("soft_controller", key) for key in ("program", "points")]
    + [(name, "job") for name in ("network_card", "card_host")],
)
def test_every_file_that_is_read_is_looked_for_in_the_resources(
    fmi: int, name: str, key: str, place: Path
) -> None:
    said = told(fmi, "resource:gone", place / "resources", key, name)
    assert said.startswith(f"{key}: ") and f"there are: {NAME}, sub, tools.tbl" in said
    assert "there are" not in told(fmi, "resource:tools.tbl", place / "resources", key, name)


@both
@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("mcc", "path_file"),
        ("soft_controller", "teach_file"),
        ("scope", "file"),
        ("logic_analyser", "record_file"),
    ],
)
def test_a_file_is_written_by_uri_and_not_into_the_resources(
    fmi: int, name: str, key: str, place: Path
) -> None:
    said = told(fmi, "resource:out", place / "resources", key, name)
    assert said.endswith("an FMU's resources are only read")
    instance = Instance(name, fmi).initialize({key: (place / "öut").as_uri()})
    assert instance.step(1e-3) == OK and instance.call("Terminate") == OK, instance.said
    instance.free()
    assert list(place.glob("öut*"))


@both
def test_a_uri_of_the_program_is_not_replaced(fmi: int, place: Path) -> None:
    instance = Instance("mcc", fmi)
    assert instance.set("program", (place / NAME).as_uri()) == OK
    assert instance.set("path_file", NAME) == OK
    assert instance.enter() == OK
    assert instance.call("ExitInitializationMode") == ERROR
    assert "it is program" in instance.said


def seen(file: Path, fmi: int, **start: Any) -> bytes:
    found = simulate_fmu(
        str(file),
        stop_time=0.2,
        step_size=1e-3,
        output_interval=1e-3,
        output=SEEN[fmi],
        start_values=start,
    )
    assert found["queue"].max() > 10 and any(np.any(found[n]) for n in SEEN[fmi][1:])
    return found.tobytes()


@both
def test_a_packed_program_runs_elsewhere_with_the_same_bits(fmi: int, place: Path) -> None:
    """Without a value for any parameter, from another folder; and the gains are what was packed."""
    source, target = fmu_path("mcc", fmi), place / "elsewhere/packed.fmu"
    gains = "p_gain" if fmi == 3 else "p_gain[1]"
    wanted = seen(source, fmi, program=str(place / NAME), **{gains: 70} if fmi == 2 else {})
    target.parent.mkdir()
    starts = {"program": f"resource:{NAME}", "p_gain": "70 60 60 60 60 60", "feed": "600.1"}
    repacked(source, target, {NAME: place / NAME}, starts)
    first = target.read_bytes()
    repacked(source, target, {NAME: place / NAME}, starts)
    assert target.read_bytes() == first
    shutil.rmtree(place / "resources")
    (place / NAME).rename(place / "away")
    os.chdir(target.parent)
    assert seen(target, fmi) == wanted

    variables = {v.name: v for v in read_model_description(str(target)).modelVariables}
    assert variables["program"].start == f"resource:{NAME}"
    assert str(variables[gains].start).split()[0] == "70"
    assert variables["feed"].start == "600.1"


@both
def test_an_instance_begins_with_the_packed_values(fmi: int, place: Path) -> None:
    """Values of every type arrive to the bit, also behind a reset, and one set later counts."""
    values = {"feed": "0.1", "lead": "1e-6 0.3 7 8 9 3.0000000000000004", "seed": "-7"}
    starts = {**values, "dry_run": "true", "acc_type": "S"}
    target = place / "x.fmu"
    repacked(fmu_path("mcc", fmi), target, {}, {"seed": "3", "dec_type": "S"})
    repacked(target, target, {}, starts)
    description = read_model_description(str(target))
    with zipfile.ZipFile(target) as archive:
        archive.extractall(place / "x")
    instance = Instance("mcc", fmi, resources=str(place / "x/resources"), token=description.guid)
    wanted = {name: [float(x) for x in text.split()] for name, text in values.items()}
    for _ in range(2):
        assert {name: instance.get(name) for name in values} == wanted
        assert instance.get("dry_run") == [True]
        assert [instance.get(n) for n in ("acc_type", "dec_type")] == [[b"S"], [b"S"]]
        assert instance.set("seed", 5) == OK
        assert instance.call("Reset") == OK
    instance.free()
    # A description without its resources, and resources of another description.
    lost = Instance("mcc", fmi, resources=str(place / "none"), token=description.guid)
    assert not lost.fmu.component and "its resources are not in" in lost.said
    other = Instance("mcc", fmi, resources=str(place / "x/resources"))
    assert not other.fmu.component and "another token" in other.said


DAMAGED = {
    "": "line 1: an empty file",
    "token {T}": "line 1: no whole line",
    "token {T}\ngone 1\n": "line 2: no parameter or input",
    "token {T}\nstatus 1\n": "line 2: no parameter or input",
    "token {T}\n\n": "line 2: no parameter or input",
    "token {T}\nseed 1\nfeed 0.1\n": "line 3: no number",
    "token {T}\nseed 99999999999\n": "line 2: a value outside the limits",
    "token {T}\nfeed 0\n": "line 2: a value outside the limits",
    "token {T}\nfeed 1p2000\n": "line 2: no number",
    "token {T}\ndry_run 2\n": "line 2: a value outside the limits",
    "token {T}\nlead 1 2\n": "line 2: fewer values than elements",
    "token {T}\nseed 1 2\n": "line 2: more values than elements",
    f"token {{T}}\nprogram {'x' * 1024}\n": "line 2: a text that does not fit",
    f"token {{T}}\nprogram {'x' * 40000}\n": "line 2: no whole line",
}


@both
@pytest.mark.parametrize("text", DAMAGED)
def test_damaged_start_values_are_refused(fmi: int, text: str, place: Path) -> None:
    (place / "resources/start_values.txt").write_text(text)
    instance = Instance("mcc", fmi, resources=str(place / "resources"), token="{T}")
    assert not instance.fmu.component
    assert instance.said.endswith(f"start_values.txt: {DAMAGED[text]}")


@both
def test_what_cannot_be_packed_is_told_and_nothing_is_written(fmi: int, place: Path) -> None:
    source, target = fmu_path("mcc", fmi), place / "x.fmu"
    file = place / NAME
    wrong: list[tuple[dict[str, Path], dict[str, str], str]] = [
        ({"../a": file}, {}, "../a: no name for a file inside"),
        ({"start_values.txt": file}, {}, "start_values.txt: no name"),
        ({"/a": file}, {}, "/a: no name"),
        ({"a": place / "gone"}, {}, "gone: No such file"),
        ({}, {"progam": "a"}, "progam: no such variable; did you mean 'program'?"),
        ({}, {"status": "1"}, "status: cannot be set"),
        ({}, {"seed": "1.5"}, "seed = 1.5: Int32 wanted"),
        ({}, {"seed": "3000000000"}, "seed = 3000000000: outside"),
        ({}, {"feed": "nan"}, "feed = nan: outside"),
        ({}, {"dry_run": "1"}, "dry_run = 1: true or false wanted"),
        ({}, {"lead": "1 2"}, "lead has 6 elements, not 2"),
        ({}, {"program": "a\nb"}, "program = 'a\\nb': one line"),
        ({}, {"program": "x" * 1024}, "one line of less than 1024 bytes"),
    ]
    for resources, starts, words in wrong:
        with pytest.raises(InputError) as error:
            repacked(source, target, resources, starts)
        assert words in str(error.value)
        assert not target.exists()
    foreign = place / "foreign.fmu"
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(foreign, "w") as new:
        xml = old.read("modelDescription.xml").replace(b'generationTool="motionfmu"', b"")
        new.writestr("modelDescription.xml", xml)
    with pytest.raises(InputError, match="not an FMU of motionfmu"):
        repacked(foreign, target, {}, {"feed": "1"})
    repacked(foreign, target, {"a": file}, {})
    assert zipfile.ZipFile(target).read("resources/a") == TEXT.encode()
    (place / "no.fmu").write_text("x")
    with pytest.raises(InputError, match="not a readable FMU"):
        repacked(place / "no.fmu", target, {}, {})
