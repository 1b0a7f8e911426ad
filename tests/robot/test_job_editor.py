"""The page of a robot's program: judging what is not saved, saving whole, who has access."""

import asyncio
import json
import os
import shutil
import stat
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx2 as httpx
import numpy as np
import pytest
from browser import browser, tab  # noqa: F401  (a fixture)
from conftest import ROOT
from py_mini_racer import MiniRacer

from motionfmu import run
from motionfmu.base.errors import InputError
from motionfmu.base.page_server import PageServer
from motionfmu.job_editor import EditedJob, JobTexts, application
from motionfmu.job_editor.edited_job import replace_files
from motionfmu.report.view.arm import chain
from motionfmu.scenarios.arm_lengths import Arm

EXAMPLE = ROOT / "src/motionfmu/machines/robot6"
PAGE = ROOT / "src/motionfmu/job_editor/page"
TOKEN = "a-token"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    for name in ("example.job", "example.points"):
        shutil.copy(EXAMPLE / name, tmp_path)
    return tmp_path / "example.job"


def edited(file: Path) -> EditedJob:
    return EditedJob(run.machine("robot6").scenario(file))


def folder_of(file: Path) -> dict[str, bytes]:
    return {f.name: f.read_bytes() for f in file.parent.iterdir()}


def test_steps_end_at_their_points_with_the_arm_there(file: Path) -> None:
    job, before = edited(file), folder_of(file)
    found = job.judge(job.texts)
    assert found["faults"] == [] and len(found["steps"]) == 12
    assert [s["line"] for s in found["steps"]] == [*range(5, 17)]
    ends = {s["line"]: s["place"] for s in found["steps"]}
    wanted = {5: (950, -50, 400), 6: (950, -50, 350), 10: (950, -50, 350), 13: (1040, 0, 350)}
    for line, place in wanted.items():
        assert np.allclose(ends[line], place, atol=0.01), line
    arm = Arm((150, -115, 0, 445, 700, 795, 85), (0, 0, -0.5 * np.pi, 0, 0, 0))
    for s in found["steps"]:
        flange = chain(arm, np.radians([s["joint"]]))["flange"][0]
        assert np.linalg.norm(np.array(s["place"]) - flange) == pytest.approx(150.0, abs=0.02)
    assert folder_of(file) == before


def test_what_is_not_saved_is_judged(file: Path) -> None:
    job, texts, before = edited(file), edited(file).texts, folder_of(file)
    wrong = texts.job.replace("MOVL P003 V=100.0 CR=10.0", "MOVL P003 V=abc")
    (fault,) = job.judge(JobTexts(wrong, texts.points))["faults"]
    assert fault["line"] == 8 and "abc" in fault["text"] and "motionfmu-job-" not in fault["text"]
    far = texts.points.replace("P002 X=1050", "P002 X=9050")
    (fault,) = job.judge(JobTexts(texts.job, far))["faults"]
    assert fault["line"] == 7
    broken = texts.points.replace("P002 X=1050", "P002 X=10z")
    (fault,) = job.judge(JobTexts(texts.job, broken))["faults"]
    assert fault["text"].startswith("points: line 5: ")
    assert (fault["line"], fault["points_line"]) == (0, 5)
    assert folder_of(file) == before


def test_an_endless_program_is_given_up(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("motionfmu.job_editor.edited_job.PATIENCE", 0.0)
    job = edited(file)
    (fault,) = job.judge(job.texts)["faults"]
    assert fault["line"] == 0 and "not at its end" in fault["text"]
    (fault,) = job.judge(job.texts, lambda: False)["faults"]
    assert "newer" in fault["text"]


def test_a_file_keeps_its_line_ends_and_its_rights(file: Path) -> None:
    file.write_bytes(file.read_bytes().replace(b"\n", b"\r\n"))
    file.chmod(0o640)
    job = edited(file)
    text = job.texts.job
    assert "\r" not in text
    job.save(JobTexts(text + "' more\n", job.texts.points))
    assert file.read_bytes() == (text + "' more\n").replace("\n", "\r\n").encode()
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    assert sorted(folder_of(file)) == ["example.job", "example.points"]


def test_a_link_stays_a_link(file: Path) -> None:
    real = file.rename(file.with_name("real.job"))
    file.symlink_to(real)
    replace_files({file: b"END\n"})
    assert file.is_symlink() and real.read_bytes() == b"END\n"


def test_anothers_change_is_not_lost(file: Path) -> None:
    job = edited(file)
    points = file.with_suffix(".points")
    points.write_text(points.read_text() + "' by hand\n")
    before = folder_of(file)
    texts = JobTexts("TOOL 1\nEND\n", job.texts.points.replace("950", "951"))
    with pytest.raises(InputError, match="somebody else"):
        job.save(texts)
    assert folder_of(file) == before
    job.save(texts, over=True)
    assert (file.read_text(), points.read_text()) == (texts.job, texts.points)


@pytest.mark.parametrize("call", ["fsync", "replace"])
def test_a_disk_that_fails_leaves_what_was_there(
    file: Path, call: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    job, before = edited(file), folder_of(file)

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device", "x")

    monkeypatch.setattr(os, call, full)
    with pytest.raises(InputError, match="No space left"):
        job.save(JobTexts("END\n", "P000 X=1\n"))
    assert folder_of(file) == before


@contextmanager
def serving(job: EditedJob) -> Iterator[str]:
    """The address of a program's page."""
    ended, found = asyncio.Event(), Future[tuple[asyncio.AbstractEventLoop, int]]()

    async def main() -> None:
        async with PageServer(application(job, TOKEN), 0) as port:
            found.set_result((asyncio.get_running_loop(), port))
            await ended.wait()

    thread = threading.Thread(target=asyncio.run, args=(main(),), daemon=True)
    thread.start()
    loop, port = found.result(60)
    try:
        yield f"http://127.0.0.1:{port}/"
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(20)
    assert not thread.is_alive()


def test_only_who_has_the_token_reads_or_writes(file: Path) -> None:
    before = folder_of(file)
    own = {"authorization": f"Bearer {TOKEN}"}
    with serving(edited(file)) as address:

        def status(path: str, body: Any = None, **headers: str) -> int:
            data = body if isinstance(body, bytes) else json.dumps(body or {}).encode()
            return httpx.post(address + path, content=data, headers=headers).status_code

        for path in ("open", "judge", "save"):
            assert status(path) == 403
            assert status(path, authorization="Bearer other") == 403
            assert status(path, **own, origin="http://elsewhere.example") == 403
            assert status(path, **own, host="elsewhere.example") == 403
            assert httpx.get(address + path, headers=own).status_code == 405
        assert status("open", **own) == 200
        for wrong in (b"{", b"[]", b'{"job": 1}', b'{"points": ""}', b'{"job": "", "file": "x"}'):
            assert status("save", wrong, **own) == 422
            assert status("judge", wrong, **own) == 422
        page = httpx.get(address)
        assert "TOOL" not in page.text and "script-src 'self'" in str(page.headers)
    assert folder_of(file) == before


def test_points_and_steps_of_a_text() -> None:
    engine = MiniRacer()
    engine.eval((PAGE / "point_table.js").read_text().replace("export function", "function"))

    def js(expression: str) -> Any:
        return json.loads(engine.eval(f"JSON.stringify({expression})"))

    text = (EXAMPLE / "example.points").read_text()
    points = js(f"pointsOf({json.dumps(text)})")
    assert [p["name"] for p in points] == [f"P00{k}" for k in range(10)]
    assert points[2]["words"] == {"X": "1050", "Y": "-50", "Z": "350", "A": "180", "B": "0"} | {
        "C": "180", "TOOL": "1",
    }  # fmt: skip
    for p in points:
        changed = js(f"withWord({json.dumps(text)}, {p['place']}, 'Y', '12.5')")
        differ = [
            (a, b) for a, b in zip(text.split("\n"), changed.split("\n"), strict=True) if a != b
        ]
        assert len(differ) == 1 and differ[0][0].startswith(p["name"])
        assert differ[0][1] == differ[0][0].replace(f"Y={p['words']['Y']}", "Y=12.5")
    assert js("pointsIn('MOVC P006 P007 V=100.0 ' + \"' to P008\")") == ["P006", "P007"]
    steps = "[{line: 4}, {line: 9}, {line: 4}, {line: 7}]"
    assert [js(f"stepAt({steps}, {n})") for n in (1, 4, 5, 7, 8, 9, 12)] == [-1, 0, 0, 3, 3, 1, 1]


@pytest.mark.more
def test_the_page_edits_judges_and_saves(browser: Any, file: Path) -> None:  # noqa: F811
    from playwright.sync_api import expect

    desk = {"width": 1400, "height": 900}
    with serving(edited(file)) as address, tab(browser, f"{address}?token={TOKEN}", desk) as page:
        verdict, text = page.locator("#verdict"), page.locator("#text")
        expect(verdict).to_contain_text("12 moves")
        assert "token" not in page.url
        for _ in range(20):
            if page.locator("#back").is_disabled():
                break
            page.locator("#back").click()
        expect(page.locator("#where")).to_contain_text("line 5, MOVJ P000")
        page.locator("#on").click()
        expect(page.locator("#where")).to_contain_text("line 6")
        expect(page.locator("#gutter button.now")).to_have_text("6")
        expect(page.locator("#points tr.now")).to_have_count(1)
        expect(page.locator("#pose")).to_contain_text("950.0, -50.0, 350.0 mm")
        canvas = page.locator("#view canvas")
        before = canvas.screenshot()
        page.locator("#gutter button").nth(12).click()
        expect(page.locator("#pose")).to_contain_text("1040.0, 0.0, 350.0 mm")
        assert canvas.screenshot() != before

        whole = text.input_value()
        text.fill(whole.replace("MOVL P004 V=100.0 CR=10.0", "MOVL P014 V=100.0"))
        expect(page.locator("#gutter button.fault")).to_have_text("9")
        expect(page.locator("#faults")).to_contain_text("P014")
        expect(page.locator("#marks i.fault")).to_have_count(1)
        text.fill(whole)
        expect(verdict).to_contain_text("12 moves")
        page.get_by_label("X of P002").fill("9050")
        expect(page.locator("#gutter button.fault")).to_have_text("7")
        page.locator("summary").click()
        points = page.locator("#points-text")
        right = points.input_value()
        points.fill(right.replace("Y=50", "W=50"))
        expect(page.locator("#faults")).to_contain_text('unknown word "W"')
        expect(page.locator("#points tr.fault")).to_have_attribute("data-name", "P003")
        expect(page.locator("#gutter button.fault")).to_have_count(0)
        points.fill(right)
        page.get_by_label("X of P002").fill("1060.5")
        expect(verdict).to_contain_text("12 moves")
        page.locator("#gutter button").nth(6).click()
        assert file.with_suffix(".points").read_text() == (EXAMPLE / "example.points").read_text()
        page.locator("#save").click()
        expect(page.locator("#save")).to_have_text("Saved")
        saved = file.with_suffix(".points").read_text()
        assert saved == (EXAMPLE / "example.points").read_text().replace(
            "P002 X=1050", "P002 X=1060.5"
        )
        assert file.read_text() == whole
