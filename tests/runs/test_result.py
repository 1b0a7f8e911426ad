"""A result in Python: a mapping of signals, a table, figures, a folder, a view for notebooks."""

import json
import sys
from pathlib import Path
from xml.etree import ElementTree

import matplotlib
import numpy as np
import pytest
from conftest import ROOT
from console import within
from matplotlib import pyplot

import motionfmu
from motionfmu.base.errors import InputError, UnknownSignal
from motionfmu.run import Result

SIX = [f"machine.table_position[{k}]" for k in range(1, 7)]


@pytest.fixture(scope="module")
def result() -> Result:
    return motionfmu.load(ROOT / "scenarios/circle_theory").run()


@pytest.fixture(scope="module")
def short() -> Result:
    """A run that ends before its circle, of another gain than the scenario's."""
    scenario = motionfmu.load(ROOT / "scenarios/circle_theory")
    return scenario.run(stop=0.1, set={"mcc.p_gain": 100})


def test_the_package_shows_what_a_user_needs_and_its_folders() -> None:
    shown = dir(motionfmu)
    assert {"load", "Scenario", "Result", "InputError", "virtual", "analysis"} <= set(shown)
    assert all(getattr(motionfmu, name) for name in (*motionfmu.__all__, "virtual", "study"))
    with pytest.raises(AttributeError, match="'laod'"):
        _ = motionfmu.laod


def test_a_result_is_a_mapping_of_its_signals(result: Result) -> None:
    assert list(result) == list(result.keys()) == list(result.signals) and len(result) == 19
    assert "card.stock" in result and "card.stock[6]" in result
    assert "card.stok" not in result and "card.stock[7]" not in result and 3 not in result
    assert all(result[name] is data for name, data in result.items())
    assert (result["card.stock[2]"] == result["card.stock"][:, 1]).all()
    assert result.get("card.stok") is None and result == result and len({result}) == 1


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("card.stok", "no signal 'card.stok' is recorded; did you mean 'card.stock'?"),
        ("stok[2]", "no signal 'stok' is recorded; did you mean 'card.stock'?"),
        ("card.stock[7]", "card.stock[7]: card.stock has 6 axes, [1] to [6]"),
        ("card.stock[0]", "card.stock[0]: card.stock has 6 axes, [1] to [6]"),
        ("card.stock[1", "card.stock[1: card.stock has 6 axes, [1] to [6]"),
        ("mcc.done[1]", "mcc.done[1]: mcc.done is a single value"),
        (0, "0: the name of one signal wanted, such as 'card.stock'"),
    ],
)
def test_a_wrong_name_is_told(result: Result, name: str, told: str) -> None:
    for asked in (result.__getitem__, result.to_pandas, result.plot):
        if name == 0 and asked != result.__getitem__:
            continue
        with pytest.raises(UnknownSignal) as caught:
            asked(name)
        assert str(caught.value) == told and isinstance(caught.value, InputError | KeyError)


def test_nothing_that_is_handed_out_can_change_the_result(result: Result) -> None:
    for data in (result.time, result["card.stock"], result["card.stock[1]"], result["mcc.done"]):
        with pytest.raises(ValueError, match="read-only"):
            data += data
    table = result.to_pandas("card.dac")
    table.iloc[:, :] = 7.0
    assert not (result["card.dac"] == 7.0).any()


def test_a_table_has_a_column_an_element_with_its_unit(result: Result) -> None:
    assert result.units["machine.table_position"] == "m" and result.units["card.stock"] == "1"
    table = result.to_dataframe(["mcc.path_feed", "machine.table*", "card.dac[2]", "mcc.done"])
    assert list(table.columns) == ["mcc.path_feed", *SIX, "card.dac[2]", "mcc.done"]
    assert table.index.name == "time [s]" and (table.index == result.time).all()
    for name in table.columns:
        assert (table[name] == result[name]).all() and table[name].dtype == result[name].dtype
    units = dict.fromkeys(SIX, "m") | {"mcc.path_feed": "mm/s", "card.dac[2]": "V", "mcc.done": "1"}
    assert table.attrs == {"units": units, "scenario": "circle_theory"}
    every = result.to_pandas()
    assert every.shape == (30000, sum(d[0].size for d in result.values()))
    with pytest.raises(UnknownSignal, match=r"'card\.x\*' matches no signal \(there are: card"):
        result.to_pandas("card.x*")


def test_without_pandas_the_message_says_how_to_get_it(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match="pip install pandas"):
        result.to_pandas()


def test_a_result_is_one_line(result: Result, short: Result) -> None:
    told = "<Result circle_theory: all 6 checks hold, 30000 rows of 19 signals, 3 s>"
    assert repr(result) == told
    told = "1 of 4 checks FAILED, 2 expected not judged, 1000 rows of 19 signals, 0.1 s"
    assert repr(short) == f"<Result circle_theory: {told}>"


def test_a_plot_has_a_panel_a_name_and_shows_the_samples(result: Result) -> None:
    backend, names = matplotlib.get_backend(), ("card.dac[1]", "card.dac[2]")
    figure = result.plot("mcc.path_feed", names, "mcc.done", window=(0.5, 0.6))
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["mcc.path_feed [mm/s]", "card.dac [V]", "mcc.done"]
    assert figure.axes[0].get_xlim() == (0.5, 0.6)
    for line, name in zip(figure.axes[1].lines, names, strict=True):
        time, values = line.get_xdata(), line.get_ydata()
        assert line.get_label() == name and (np.diff(time) > 0.0).all()
        at = np.round(np.asarray(time) * 1e4).astype(int)
        assert (result[name][at] == values).all() and at[0] in (4999, 5000) and at[-1] >= 6000
    assert pyplot.get_fignums() == [] and matplotlib.get_backend() == backend
    assert "circle_theory: contour error" in result.plot().texts[0].get_text()
    for window in ((0.6, 0.5), (0, 4), 3, "ab"):
        with pytest.raises(InputError, match=r"window = .*wanted"):
            result.plot("mcc.done", window=window)


def test_where_there_is_a_window_pyplot_knows_the_plot(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(matplotlib, "get_backend", lambda: "TkAgg")
    figure = result.plot("mcc.done")
    assert pyplot.gcf() is figure
    pyplot.close(figure)


def test_save_writes_what_the_command_writes(short: Result, tmp_path: Path) -> None:
    report = short.save(str(tmp_path / "own"), csv=True)
    assert report == tmp_path / "own/report.html"
    words = ["--stop", "0.1", "--set", "mcc.p_gain=100", "--csv", "--out", tmp_path / "run"]
    within("run", "scenarios/circle_theory", *words)
    for file in ("result.json", "signals.csv", "report.html"):
        assert (tmp_path / "own" / file).read_text() == (tmp_path / "run" / file).read_text(), file
    assert json.loads((tmp_path / "own/result.json").read_text())["options"]["stop"] == 0.1
    (tmp_path / "other").mkdir()
    (tmp_path / "other/thesis.tex").write_text("")
    with pytest.raises(InputError, match="holds no earlier result"):
        short.save(tmp_path / "other")


def test_a_notebook_shows_verdict_numbers_and_picture(result: Result, short: Result) -> None:
    view = result._repr_html_()
    tree = ElementTree.fromstring(view)
    text = "\n".join(tree.itertext())
    assert "all 6 checks hold" in text and "30000 rows of 19 signals" in text
    for check in result.checks:
        assert check.name in text and f"{check.value:.6g}" in text and check.bounds in text
    assert f"{result.contour().error.max * 1e3:.1f} µm" in text
    source = next(tree.iter("img")).attrib["src"]
    assert source.startswith("data:image/png;base64,iVBOR") and len(view) < 250_000
    assert "table_position" in text and "not as written" not in text
    text = "\n".join(ElementTree.fromstring(short._repr_html_()).itertext())
    assert "1 of 4 checks FAILED, 2 expected not judged" in text and all(
        v.reason in text for v in short.checks
    )
    assert "mcc.p_gain = 100 (scenario: 200)" in text and "stop = 0.1 s (scenario: 3 s)" in text
