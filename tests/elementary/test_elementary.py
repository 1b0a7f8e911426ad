"""The elementary functions: nearest to mpmath's values, and the same bits whoever compiles them."""

import ctypes
import itertools
import shutil
import subprocess
from pathlib import Path

import nearest
import pytest
import tables
from few_cases import few
from mpmath import mp

mp.prec = 200
ARM = "aarch64-linux-gnu-gcc"
# 2^-40: a value so near to the middle between two doubles may be taken for the middle.
NEAREST = 0.5 + 2.0**-40


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return nearest.built(tmp_path_factory.mktemp("quick"))


@pytest.fixture(scope="module")
def slow(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    return nearest.telling(tmp_path_factory.mktemp("slow"), "-DONLY_SLOW")


@pytest.fixture(scope="module", params=["", "-DONLY_SLOW"], ids=["quick", "slow"])
def telling(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> ctypes.CDLL:
    return nearest.telling(tmp_path_factory.mktemp("telling"), *request.param.split())


@pytest.mark.parametrize("name", few(nearest.DRAWN, 6))
def test_results_are_the_nearest_doubles(quick: ctypes.CDLL, name: str) -> None:
    nearest.rnd.seed(name)
    all_at = itertools.chain(nearest.drawn(name, 4000), nearest.hard(name, 1000))
    assert nearest.worst(nearest.function(quick, name), name, all_at)[:2] < (NEAREST, ())


@pytest.mark.parametrize("name", few(sorted(nearest.DRAWN.keys() - {"hypot", "cbrt"}), 6))
def test_what_is_rounded_is_within_its_bound(
    telling: ctypes.CDLL, name: str, request: pytest.FixtureRequest
) -> None:
    """Quick values, and those to 96 bits where quick ones may round either way.

    A bound a hundred times too large would send a hundred times as many arguments the slow way.
    """
    nearest.rnd.seed(name)
    shares = [nearest.share_of_bound(telling, name, at) for at in nearest.drawn(name, 1500)]
    least = 0.01 if "quick" in request.node.callspec.id else 1e-7
    assert least < max(shares) <= 1.0


@pytest.mark.parametrize("name", sorted(nearest.DRAWN.keys() - {"hypot", "cbrt"}))
def test_both_ways_round_to_the_same(quick: ctypes.CDLL, slow: ctypes.CDLL, name: str) -> None:
    """As many arguments as cost little where no value of mpmath is needed."""
    nearest.rnd.seed(name)
    first, other = (nearest.function(library, name) for library in (quick, slow))
    differ = [at for at in nearest.drawn(name, 8000) if first(*at) != other(*at)]
    assert [at for at in differ if first(*at) == first(*at)] == []


def test_the_tables_are_what_mpmath_gives() -> None:
    with mp.workprec(1400):
        made = tables.texts()
    assert made == {f.name: f.read_text() for f in nearest.CORE.glob("el_*_tables.h")}


def bits(folder: Path, *command: str, run: tuple[str, ...] = ()) -> str:
    """What tests/elementary/bits.c prints, compiled so."""
    program = folder / "_".join(command).replace("/", "_")
    sources = [Path(__file__).with_name("bits.c"), *sorted(nearest.CORE.glob("*.c"))]
    compiler, *flags = command
    subprocess.run(
        [compiler, "-std=c11", *flags, "-I", nearest.CORE, "-o", program, *sources, "-lm"],
        check=True,
    )
    return subprocess.run([*run, program], check=True, capture_output=True, text=True).stdout


@pytest.mark.more
def test_every_compiler_gives_the_same_bits(tmp_path: Path) -> None:
    wanted = bits(tmp_path, "gcc", "-O2", "-ffp-contract=off")
    assert len(set(wanted.split())) == 32
    ways = [("gcc", "-O0"), ("gcc", "-O3", "-flto", "-march=haswell", "-ffp-contract=off")]
    ways += [("clang", "-O2", "-ffp-contract=off")] if shutil.which("clang") else []
    for way in ways:
        assert bits(tmp_path, *way) == wanted, way


def test_an_arm_processor_gives_the_same_bits(tmp_path: Path) -> None:
    if not (shutil.which(ARM) and shutil.which("qemu-aarch64")):
        pytest.skip(f"needs {ARM} and qemu-aarch64 (Debian: gcc-aarch64-linux-gnu, qemu-user)")
    there = bits(tmp_path, ARM, "-O2", "-static", "-ffp-contract=off", run=("qemu-aarch64",))
    assert there == bits(tmp_path, "gcc", "-O2", "-ffp-contract=off")


@pytest.mark.parametrize("flag", ["-mfpmath=387", "-ffast-math"])
def test_other_arithmetic_is_refused(flag: str) -> None:
    made = subprocess.run(
        ["gcc", "-std=c11", flag, "-fsyntax-only", nearest.CORE / "el_root.c"],
        capture_output=True,
        text=True,
    )
    assert "#error" in made.stderr and "elementary:" in made.stderr
