"""Every scenario's verdict fails when what the scenario shows is switched off."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from few_cases import few

import motionfmu
from motionfmu.run import contrary
from motionfmu.run.checks import judge
from motionfmu.run.session import Session
from motionfmu.scenarios import document
from motionfmu.scenarios.body import Bounds

FOLDERS = sorted(p.parent for p in ROOT.glob("scenarios/*/scenario.toml"))
SMALL = Path(__file__).parent / "interrupt_sources.toml"


def numbers(folder: Path) -> list[int | None]:
    """The cases of a scenario; None if it has none, so that it has a test to fail."""
    return [*range(len(document.read(folder).body.contrary))] or [None]


def weakness(tried: "motionfmu.Scenario | Once", number: int | None) -> str:
    """Why a verdict proves nothing; empty if it fails as it must."""
    if number is None:
        return f"{tried.name}: no [[contrary]] says with which settings its verdict fails"
    case = tried.document.body.contrary[number]
    verdicts = tried.run(**contrary.options(tried.document, case)).checks
    hold = contrary.survivors(case, verdicts)
    return f"{tried.name}: {', '.join(hold)} hold without {case.off}" if hold else ""


class Once:
    """The cases of one scenario: it is loaded once and, but for those of driven inputs, built
    once. A session gives the bits of a run (tests/runs/test_sweep.py).
    """

    def __init__(self, folder: Path) -> None:
        self.scenario = motionfmu.load(folder)
        self.name, self.document = self.scenario.name, self.scenario.document
        cases = self.document.body.contrary
        self.options = [contrary.options(self.document, case) for case in cases]
        varied = {n for o in self.options if not o["undriven"] for n in o["set"]}
        self.session = Session(self.scenario, sorted(varied)) if varied else None

    def run(self, **options: Any) -> motionfmu.Result:
        """As `Scenario.run`."""
        if self.session is None or options["undriven"]:
            return self.scenario.run(**options)
        return self.session.run(options["set"])

    def close(self) -> None:
        """Free the FMUs."""
        if self.session is not None:
            self.session.close()


@pytest.fixture(scope="module")
def built() -> Iterator[Callable[[Path], Once]]:
    """A scenario's `Once`; that of the one before is closed."""
    last: list[tuple[Path, Once]] = []

    def of(folder: Path) -> Once:
        if not last or last[0][0] != folder:
            while last:
                last.pop()[1].close()
            last.append((folder, Once(folder)))
        return last[0][1]

    yield of
    for _, once in last:
        once.close()


# A scenario's cases go to one worker.
CASES = [
    pytest.param(
        f,
        n,
        id=f"{f.name}-{'none' if n is None else n}",
        marks=pytest.mark.xdist_group(f"contrary {f.name}"),
    )
    for f in FOLDERS
    for n in numbers(f)
]


# `make test` has the first case of each.
FIRST = [(f, numbers(f)[0]) for f in FOLDERS]


@pytest.mark.parametrize(("folder", "number"), few(CASES, FIRST[::3]))
def test_a_verdict_fails_with_what_is_shown_switched_off(
    folder: Path, number: int | None, built: Callable[[Path], Once]
) -> None:
    """By the checks it names, not by an error."""
    assert weakness(built(folder), number) == ""


def made_up(folder: Path, cases: str) -> Path:
    """A short scenario with other cases than its own."""
    text = SMALL.read_text()
    text = text[: text.index("[[contrary]]")] if "[[contrary]]" in text else text
    (folder / "scenario.toml").write_text(text + cases)
    return folder


def test_a_scenario_without_a_case_is_found(tmp_path: Path) -> None:
    folder = made_up(tmp_path, "")
    assert numbers(folder) == [None]
    assert "no [[contrary]]" in weakness(motionfmu.load(folder), None)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ('"mcc.seed" = 2', "mcc.serving hold without nothing"),
        ('"card.io_ldi" = true', "mcc.serving hold without nothing"),
        ('"mcc.irq_sources" = 0', ""),
    ],
)
def test_a_verdict_that_holds_is_found(tmp_path: Path, values: str, told: str) -> None:
    """What fails beside the checks named does not count."""
    case = f'\n[[contrary]]\noff = "nothing"\nset = {{ {values} }}\nfails = ["mcc.serving"]\n'
    found = weakness(motionfmu.load(made_up(tmp_path, case)), 0)
    assert found.endswith(told) and bool(found) == bool(told)


def test_a_case_that_cannot_run_is_an_error(tmp_path: Path) -> None:
    case = (
        '\n[[contrary]]\noff = "x"\nset = { "mcc.program" = "none.ngc" }\nfails = ["mcc.error"]\n'
    )
    with pytest.raises(motionfmu.InputError, match=r"none\.ngc"):
        weakness(motionfmu.load(made_up(tmp_path, case)), 0)


def test_a_value_of_a_driven_input_stands_for_the_whole_run(tmp_path: Path) -> None:
    case = '\n[[contrary]]\noff = "x"\nset = { "card.io_remote" = 0 }\nfails = ["mcc.serving"]\n'
    loaded = motionfmu.load(made_up(tmp_path, case))
    options = contrary.options(loaded.document, loaded.document.body.contrary[0])
    assert options["undriven"] == {"card.io_remote"}
    usual, without = loaded.run()["mcc.serving"], loaded.run(**options)["mcc.serving"]
    assert np.array_equal(loaded.run(set=options["set"])["mcc.serving"], usual)
    assert 5 in usual and 5 not in without


def test_the_command_names_what_holds_and_what_fails(tmp_path: Path) -> None:
    case = '\n[[contrary]]\noff = "one"\nset = {{ {} }}\nfails = ["mcc.serving", "mcc.error"]\n'
    folder = made_up(tmp_path, case.format('"mcc.irq_sources" = 0'))
    command = [sys.executable, "-m", "motionfmu", "check", "--contrary", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "src")
    assert done.returncode == 1, done.stderr
    assert "off: one" in done.stdout and "holds: mcc.error" in done.stdout
    assert (
        "fails: mcc.serving = nan (nothing follows 1), asked order 1, 9, 8, 2, 7, 5, "
        in done.stdout
    )
    made_up(tmp_path, "")
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "src")
    assert done.returncode == 1 and "there is no [[contrary]]" in done.stdout
    made_up(tmp_path, case.format('"mcc.irq_sources" = 0').replace(', "mcc.error"', ""))
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT / "src")
    assert done.returncode == 0 and done.stdout.startswith("ok")


WRONG = [
    ('off = "x"\nset = {}\nfails = ["mcc.error"]', 2, "contrary.0.set = {}"),
    ('off = ""\nset = { "mcc.seed" = 2 }\nfails = ["mcc.error"]', 1, "contrary.0.off = ''"),
    ('off = "x"\nset = { "mcc.seed" = 2 }\nfails = []', 3, "contrary.0.fails = []"),
    ('off = "x"\nset = { "mcc.seed" = 2 }', 0, "fails is missing"),
    (
        'off = "x"\nset = { "mcc.seed" = 2 }\nfails = ["mcc.done"]',
        3,
        "mcc.done is not in [check] or [expect]",
    ),
    ('off = "x"\nset = { "mcc.sed" = 2 }\nfails = ["mcc.error"]', 2, "did you mean 'seed'?"),
    ('off = "x"\nset = { "mcc.seed" = 0.5 }\nfails = ["mcc.error"]', 2, "mcc.seed = 0.5: Int32"),
    ('off = "x"\nset = { "mcc.done" = true }\nfails = ["mcc.error"]', 2, "is an output"),
    ('off = "x"\nset = { "card.host_dda_run" = false }\nfails = ["mcc.error"]', 2, "is connected"),
    (
        'off = "x"\nset = { "mcc.seed" = 2 }\nwith = 1\nfails = ["mcc.error"]',
        3,
        "unknown key 'with'",
    ),
    ('off = "x"\nfails = ["mcc.error"]\n[contrary.set]\n"mcc.seed" = 0.5', 4, "mcc.seed = 0.5: I"),
    (
        'off = "x"\nset = { "mcc.seed" = 2 }\nfails = ["mcc.error"]\n'
        '[[contrary]]\noff = "x"\nset = { "mcc.seed" = 3 }\nfails = ["mcc.error"]',
        5,
        "off = 'x' is there twice",
    ),
]


@pytest.mark.parametrize(("case", "line", "told"), WRONG, ids=[w[2][:30] for w in WRONG])
def test_a_wrong_case_is_one_message(tmp_path: Path, case: str, line: int, told: str) -> None:
    folder = made_up(tmp_path, "[[contrary]]\n" + case + "\n")
    text = (folder / "scenario.toml").read_text().splitlines()
    with pytest.raises(motionfmu.InputError) as caught:
        motionfmu.load(folder)
    message = str(caught.value)
    assert message.startswith(f"{folder}/scenario.toml:{text.index('[[contrary]]') + 1 + line}: ")
    assert told in message and "\n" not in message


X = np.array([0.0, 5.0, 5.0, 2.0, 5.0])
HELD: list[tuple[dict[str, Any], bool, float]] = [
    ({"min": (0.0, 0.0)}, True, 0.0),
    ({"min": (-1.0, -0.5)}, False, 0.0),
    ({"max": (5.0, 6.0)}, True, 5.0),
    ({"max": (6.0, 7.0)}, False, 5.0),
    ({"absmax": (4.0, 4.5)}, False, 5.0),
    ({"changes": 3.0}, True, 3.0),
    ({"changes": 4.0}, False, 3.0),
    ({"changes": (1.0, 3.0)}, True, 3.0),
    ({"order": (0.0, 5.0, 2.0, 5.0)}, True, 5.0),
    ({"order": (0.0, 5.0, 2.0)}, False, 5.0),
    ({"order": (0.0, 5.0, 2.0, 5.0, 0.0)}, False, np.nan),
    ({"order": (0.0, 2.0, 5.0)}, False, 5.0),
    ({"order": (5.0, 2.0), "windows": ((0.1, 0.3),)}, True, 2.0),
    ({"changes": 0.0, "windows": ((0.1, 0.2),)}, True, 0.0),
    ({"final": 2.0, "at": 0.25}, True, 2.0),
    ({"final": 5.0, "at": 2 * 0.1}, True, 5.0),
    ({"final": 2.0, "at": 3 * 0.1}, True, 2.0),
    ({"max": (50.0, 50.0), "rate": 0.1}, True, 50.0),
    ({"min": -29.0, "rate": 0.1}, False, -30.0),
    ({"order": (0.0,), "rate": 0.3, "at": 0.35}, True, 0.0),
    ({"max": 0.0, "rate": 0.1, "windows": ((0.2, 0.3),)}, True, 0.0),
]


@pytest.mark.parametrize(("bounds", "ok", "value"), HELD, ids=[str(h[0]) for h in HELD])
def test_bounds(bounds: dict[str, Any], ok: bool, value: float) -> None:
    time = np.arange(5) * 0.1
    (found,) = judge("x", Bounds(**bounds), time, X)
    assert found.ok is ok and found.value == pytest.approx(value, nan_ok=True)
    (two,) = judge("x", Bounds(**bounds), time, np.column_stack([X, X]))
    assert two.ok is ok
    (gone,) = judge("x", Bounds(**bounds), time, np.full(5, np.nan))
    assert not gone.ok


def test_every_axis_changes_for_itself() -> None:
    time, still = np.arange(5) * 0.1, np.zeros(5)
    both = np.column_stack([X, still])
    assert not judge("x", Bounds(changes=3.0), time, both)[0].ok
    assert not judge("x", Bounds(order=(0.0, 5.0, 2.0, 5.0)), time, both)[0].ok
    assert judge("x", Bounds(changes=(0.0, 3.0)), time, both)[0].ok


def test_several_tables_of_one_signal(tmp_path: Path) -> None:
    """Each has its own windows; a wrong one is named like a single one."""
    text = SMALL.read_text()
    text = text[: text.index("[check]")] + '[check]\n"mcc.serving" = '
    (tmp_path / "scenario.toml").write_text(text + "[{ at = 0.05, max = 1 }, { min = 0 }]\n")
    result = motionfmu.load(tmp_path).run(stop=0.06)
    assert [v.bounds for v in result.checks] == ["<= 1, at 0.05 s", ">= 0"]
    (tmp_path / "scenario.toml").write_text(text + "[{ min = 0 }, { mix = 1 }]\n")
    with pytest.raises(motionfmu.InputError, match="unknown key 'mix'"):
        motionfmu.load(tmp_path)
    (tmp_path / "scenario.toml").write_text(text + "[{ min = 0 }, { at = 9.0, min = 0 }]\n")
    with pytest.raises(motionfmu.InputError, match=r"at = 9.0 s is not within"):
        motionfmu.load(tmp_path)
    for rate in ("0.0", "-5e-05", "7e-05", "0.1"):
        (tmp_path / "scenario.toml").write_text(text + f"{{ rate = {rate}, min = 0 }}\n")
        with pytest.raises(motionfmu.InputError, match=rf"mcc.serving: rate = {rate} s is "):
            motionfmu.load(tmp_path)
    (tmp_path / "scenario.toml").write_text(text + "[]\n")
    with pytest.raises(motionfmu.InputError, match=r"check.mcc.serving = \[\]"):
        motionfmu.load(tmp_path)
