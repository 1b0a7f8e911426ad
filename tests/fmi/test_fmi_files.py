"""Files of the FMUs: regular text files are read, and what is written replaces nothing else."""

import os
import stat
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from fmi_tools import ERROR, OK, Instance

both = pytest.mark.parametrize("fmi", (2, 3))
TEXT = "G90 G0 X0 Y0\nG1 X0.1 F3000\nM2\n"
# FMU and string parameter that names a file to read; what else it needs.
READ = [("mcc", "program"), ("mcc", "comp_file"), ("mcc_groups", "group2_program")]
TABLE = "axis,interval,home\n1,8000,10\naxis,index,forward,backward\n1,10,3,-3\n"


def begin(name: str, fmi: int, **values: Any) -> tuple[int, Instance]:
    """Status of the initialisation."""
    instance = Instance(name, fmi)
    for key, value in values.items():
        assert instance.set(key, value if isinstance(value, int | list) else str(value)) == OK
    assert instance.enter() == OK
    return instance.call("ExitInitializationMode"), instance


@contextmanager
def a_writer(fifo: Path) -> Iterator[list[bool]]:
    """Ends the wait of a reader of the pipe after 3 s; the list then has an entry."""
    waited: list[bool] = []

    def write() -> None:
        waited.append(True)
        os.close(os.open(fifo, os.O_RDWR | os.O_NONBLOCK))

    timer = threading.Timer(3.0, write)
    timer.start()
    yield waited
    timer.cancel()


@both
@pytest.mark.parametrize(("name", "key"), READ)
def test_only_a_regular_file_is_read(name: str, key: str, fmi: int, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for place in (pipe, Path("/dev/zero"), Path("/dev/null"), tmp_path):
        with a_writer(pipe) as waited:
            status, instance = begin(name, fmi, **{key: place})
        assert waited == []
        assert status == ERROR
        assert str(place) in instance.said
        assert ("Is a directory" if place == tmp_path else "not a regular file") in instance.said
        assert f"{key}: " in instance.said
        instance.free()
    link = tmp_path / "link"
    link.symlink_to("gone")
    status, instance = begin(name, fmi, **{key: link})
    assert status == ERROR
    assert "No such file" in instance.said


@both
@pytest.mark.parametrize(("name", "key"), READ)
@pytest.mark.parametrize("place", [(1, ""), (3, ""), (1, "# "), (3, "G1 X1 F100 (")])
def test_a_zero_byte_is_refused_with_its_line(
    name: str, key: str, place: tuple[int, str], fmi: int, tmp_path: Path
) -> None:
    (line, head), file = place, tmp_path / "file"
    before = (TABLE if key == "comp_file" else TEXT).split("\n")[: line - 1]
    file.write_text("\n".join([*before, f"{head}\0)", "M2", ""]))
    values: dict[str, Any] = {key: file}
    if name == "mcc_groups":
        values |= {"group2_card": 2, "group2_channel": [1, 2, 3, 0, 0, 0]}
    status, instance = begin(name, fmi, **values)
    assert status == ERROR
    assert f"{file}: line {line}: " in instance.said
    assert "byte 0" in instance.said


@both
@pytest.mark.parametrize("way", ["same", "dots", "hard", "symbolic", "folder"])
@pytest.mark.parametrize("key", ["program", "comp_file"])
def test_an_input_is_not_replaced(key: str, way: str, fmi: int, tmp_path: Path) -> None:
    files = {"program": tmp_path / "a.ngc", "comp_file": tmp_path / "b.csv"}
    files["program"].write_text(TEXT)
    files["comp_file"].write_text(TABLE)
    link = tmp_path / "link"
    if way == "hard":
        os.link(files[key], link)
    elif way == "symbolic":
        link.symlink_to(files[key])
    elif way == "folder":
        link.symlink_to(tmp_path)
        link /= files[key].name
    elif way == "dots":
        link = tmp_path / ".." / tmp_path.name / files[key].name
    else:
        link = files[key]
    status, instance = begin("mcc", fmi, path_file=link, **files)
    assert status == ERROR
    assert f"path_file: cannot write {link}: " in instance.said
    assert ("not a regular file" if way == "symbolic" else f"it is {key}") in instance.said
    assert files["program"].read_text() == TEXT
    assert files["comp_file"].read_text() == TABLE
    assert not list(tmp_path.glob("*.part*"))


def things(folder: Path) -> list[Path]:
    """What is no regular file, in a folder."""
    os.mkfifo(folder / "pipe")
    (folder / "old").write_text("old\n")
    (folder / "link").symlink_to(folder / "old")
    (folder / "directory").mkdir()
    os.mknod(folder / "socket", stat.S_IFSOCK | 0o600)
    return [folder / name for name in ("pipe", "link", "directory", "socket")]


def kept(place: Path) -> tuple[int, ...]:
    """What stays of a file that is left alone."""
    now = place.lstat()
    return now.st_mode, now.st_ino, now.st_dev, now.st_nlink, now.st_size


@both
def test_path_file_replaces_only_a_regular_file(fmi: int, tmp_path: Path) -> None:
    (tmp_path / "a.ngc").write_text(TEXT)
    for place in things(tmp_path):
        before = kept(place)
        status, instance = begin("mcc", fmi, program=tmp_path / "a.ngc", path_file=place)
        assert status == ERROR
        why = "Is a directory" if place.is_dir() else "not a regular file"
        assert f"cannot write {place}: {why}" in instance.said
        assert kept(place) == before
    # What was regular at the start and no longer is at the end is left alone too.
    place = tmp_path / "late"
    status, instance = begin("mcc", fmi, program=tmp_path / "a.ngc", path_file=place)
    assert status == OK
    assert instance.step(1e-3) == OK
    os.mkfifo(place)
    assert instance.call("Terminate") == ERROR
    assert "not a regular file" in instance.said
    assert place.is_fifo()
    assert not list(tmp_path.glob("*.part*"))


@both
def test_a_file_of_the_user_that_is_named_like_a_part_stays(fmi: int, tmp_path: Path) -> None:
    program = tmp_path / "way.part"
    program.write_text(TEXT)
    status, instance = begin("mcc", fmi, program=program, path_file=tmp_path / "way")
    assert status == OK, instance.said
    assert instance.step(1e-3) == OK
    assert instance.call("Terminate") == OK
    assert program.read_text() == TEXT
    assert (tmp_path / "way").read_text().startswith("command,line,type")
    assert len(list(tmp_path.iterdir())) == 2


@both
@pytest.mark.parametrize("ending", ["real.npy", "int.npy", "csv"])
def test_a_scope_that_cannot_write_keeps_the_earlier_recording(
    fmi: int, ending: str, tmp_path: Path
) -> None:
    names = [f"t.{end}" for end in ("real.npy", "int.npy", "csv")]
    for name in names:
        (tmp_path / name).write_text("earlier")
    scope = Instance("scope", fmi).initialize({"file": str(tmp_path / "t"), "csv": True})
    assert scope.step(1e-3) == OK
    bad = tmp_path / f"t.{ending}"
    bad.unlink()
    bad.mkdir()
    assert scope.call("Terminate") == ERROR
    assert f"cannot write {bad}: " in scope.said
    assert bad.is_dir()
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(names)
    assert all((tmp_path / n).read_text() == "earlier" for n in names if n != bad.name)


@both
@pytest.mark.parametrize("ending", ["real.npy", "int.npy", "csv"])
def test_a_scope_replaces_only_regular_files(fmi: int, ending: str, tmp_path: Path) -> None:
    bad = tmp_path / f"t.{ending}"
    os.mkfifo(bad)
    scope = Instance("scope", fmi)
    assert scope.set("file", str(tmp_path / "t")) == OK
    assert scope.set("csv", True) == OK
    assert scope.enter() == OK
    assert scope.call("ExitInitializationMode") == ERROR
    assert f"cannot write {bad}: not a regular file" in scope.said
    assert bad.is_fifo()
    assert len(list(tmp_path.iterdir())) == 1
