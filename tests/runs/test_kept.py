"""What is made once and kept on the disk, and what the machine's compiler makes."""

import ctypes
import os
from pathlib import Path

import pytest

from motionfmu.base import disk_cache
from motionfmu.base.compiler import Compiler, compiler
from motionfmu.base.errors import InputError


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.setenv("MOTIONFMU_CACHE", str(tmp_path))
    return tmp_path


def _write(text):
    return lambda folder: (folder / "a").write_text(text)


def test_it_is_made_once(place):
    first = disk_cache.kept("word", "k", _write("one"))
    assert first == place / "word" / "k"
    assert disk_cache.kept("word", "k", _write("two")) == first
    assert (first / "a").read_text() == "one"
    assert [p.name for p in (place / "word").iterdir()] == ["k"]


def test_a_key_knows_where_its_parts_end():
    assert disk_cache.key("ab", "c") != disk_cache.key("a", "bc")
    assert disk_cache.key("ab") == disk_cache.key(b"ab")


def test_what_fails_leaves_nothing(place):
    def fail(folder: Path) -> None:
        (folder / "half").write_text("x")
        raise InputError("no")

    with pytest.raises(InputError, match="no"):
        disk_cache.kept("word", "k", fail)
    assert list((place / "word").iterdir()) == []


def test_the_longest_unused_goes_first(place, monkeypatch):
    monkeypatch.setattr(disk_cache, "ROOM", 25)
    for age, name in ((30, "old"), (20, "used"), (10, "young")):
        made = disk_cache.kept("word", name, _write("0123456789"))
        os.utime(made, (1e9 - age, 1e9 - age))
    disk_cache.kept("word", "used", _write(""))  # now the youngest
    disk_cache.kept("word", "new", _write("0123456789"))
    assert sorted(p.name for p in (place / "word").iterdir()) == ["new", "used"]


def test_so_many_of_a_kind_are_kept(place, monkeypatch):
    monkeypatch.setattr(disk_cache, "MOST", 2)
    for age, name in ((30, "old"), (20, "young")):
        os.utime(disk_cache.kept("word", name, _write("0")), (1e9 - age, 1e9 - age))
    disk_cache.kept("word", "new", _write("0"))
    assert sorted(p.name for p in (place / "word").iterdir()) == ["new", "young"]


def test_a_place_that_cannot_be_written_to_serves_the_process(place, monkeypatch):
    (place / "file").write_text("")
    monkeypatch.setenv("MOTIONFMU_CACHE", str(place / "file"))
    made = disk_cache.kept("word", "k", _write("one"))
    assert (made / "a").read_text() == "one"
    assert disk_cache.kept("word", "k", _write("two")) == made


def test_a_library_is_made(place):
    cc = compiler()
    assert cc is not None and cc.version
    (place / "a.c").write_text(
        '__attribute__((visibility("default"))) int twice(int x) { return 2 * x; }\n'
    )
    made = cc.library(["a.c"], "a.so", place, "-O2")
    assert ctypes.CDLL(str(made)).twice(21) == 42
    (place / "a.c").write_text("int twice(\n")
    with pytest.raises(InputError, match=r"a\.c:1"):
        cc.library(["a.c"], "a.so", place)
    with pytest.raises(InputError, match="false"):
        Compiler(("false",), "").run([], place)
