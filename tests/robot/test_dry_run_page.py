"""The page of a dry run: the arm's picture, the bodies of its cell, the path in its plane."""

import numpy as np
import pytest
from conftest import ROOT
from page_curves import page_data
from page_outline import shows_what_is_kept

import motionfmu
from motionfmu.analysis.collisions import Cell, CellBody
from motionfmu.analysis.cycle_time import CommandedMotion
from motionfmu.analysis.dry_run import DryRun, dry_run
from motionfmu.base.motion_rows import ROW
from motionfmu.report.cycle_time_section import path_by_cause
from motionfmu.report.jobs.dry_run_page import page_text
from motionfmu.report.jobs.dry_scene import dry_scene
from motionfmu.report.view.arm import chain

POST = CellBody("post", bar=np.array([[900.0, 300.0, 0.0], [900.0, 300.0, 900.0]]), radius=60.0)
BOX = CellBody("box", 0.5 * np.array([100.0, 80.0, 60.0]), np.eye(3), np.array([0.0, -900.0, 30.0]))


@pytest.fixture(scope="module")
def run() -> DryRun:
    scenario = motionfmu.load(ROOT / "scenarios/robot_pick")
    return dry_run(scenario, cell=Cell((POST, BOX), floor=-20.0))


def test_the_arm_holds_the_tool_at_each_frame(run: DryRun) -> None:
    scene = dry_scene(run)
    assert scene is not None and scene.arm is not None and scene.joints is not None
    flange = chain(scene.arm, scene.joints)["flange"]
    tool = np.linalg.norm(scene.tool - flange, axis=1)
    assert np.allclose(tool[tool > 1.0], 150.0, atol=0.1)  # the pen of TOOL 1; none before it
    assert scene.rapid is not None and scene.rapid.any() and not scene.rapid.all()


def test_the_picture_has_the_cell_and_begins_where_it_is_touched(run: DryRun) -> None:
    page = page_text(run)
    shows_what_is_kept("dry_run", page)
    data = page_data(page)["views"][0]
    assert data["floor"] == -20.0
    assert data["cell"][0] == {"bar": [[900, 300, 0], [900, 300, 900]], "radius": 60}
    assert data["cell"][1]["half"] == [50, 40, 30] and data["cell"][1]["centre"] == [0, -900, 30]
    assert data["begin"] == min(a.time for a in run.collisions)


def rows_of(points: np.ndarray, feed: np.ndarray) -> CommandedMotion:
    rows = np.zeros(len(points), ROW)
    rows["place"][:, :3], rows["feed"], rows["cause"] = points, feed, 1
    return CommandedMotion(0.001, rows, tuple("XYZABC"), driven=True)


@pytest.mark.parametrize("across", [0, 1, 2])
def test_a_path_in_a_plane_is_drawn_in_it(across: int) -> None:
    """A circle in a plane of two axes, an approach of the joints before it, a lift behind it."""
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    circle = np.insert(np.stack([40 * np.cos(angle), 40 * np.sin(angle)], axis=1), across, 7.0, 1)
    lift = circle[-1] + np.outer(np.linspace(0, 50, 50), np.eye(3)[across])
    approach = circle[0] + np.outer(np.linspace(600, 0, 100), [1.0, 1.0, 1.0])
    points = np.concatenate([approach, circle, lift])
    feed = np.where(np.arange(len(points)) < 100, 0.0, 10.0)
    diagram = path_by_cause(rows_of(points, feed))
    names = [diagram.x[0].title, diagram.subplots[0].y.title]
    assert names == [n for k, n in enumerate("XYZ") if k != across]
    (mark,) = diagram.marks
    assert max(np.nanmax(np.abs(mark.x)), np.nanmax(np.abs(mark.y))) < 60.0


def test_a_path_in_space_is_drawn_in_space() -> None:
    angle = np.linspace(0.0, 9.0, 300)
    helix = np.stack([np.cos(angle), np.sin(angle), angle], axis=1)
    diagram = path_by_cause(rows_of(helix, np.full(300, 1.0)))
    assert diagram.shape == "space"
