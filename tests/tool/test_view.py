"""The moving picture: its data against the run, its geometry against other people's code."""

import json
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio
import py_opw_kinematics as opw
import pytest
from conftest import ROOT
from hypothesis import given
from hypothesis import strategies as st
from page_curves import page_data
from public_arms import universal
from py_mini_racer import MiniRacer

import motionfmu
from motionfmu.arms.arm_description import turn_of
from motionfmu.report import write_report
from motionfmu.report.html_page import Page
from motionfmu.report.run_summary import summary_of, without_leaps
from motionfmu.report.view.arm import chain
from motionfmu.report.view.deviations import from_contour
from motionfmu.report.view.scene import no_arm, scene_of
from motionfmu.report.view_section import PICTURE, SCRIPTS, add_view, quantised, view_data
from motionfmu.scenarios.arm_lengths import Arm

REPORT = ROOT / "src/motionfmu/report"
SHARED = ROOT / "src/motionfmu/base/machine_picture"
BYTES_MAX = 60_000  # of the scripts, without data
ARMS = {
    "IRB 2600": Arm(
        (150, -115, 0, 445, 700, 795, 85), (0, 0, -math.pi / 2, 0, 0, 0), (1,) * 6, 150
    ),
    "KR 6": Arm(
        (25, -35, 0, 400, 315, 365, 80), (0, -math.pi / 2, 0, 0, 0, 0), (-1, 1, 1, -1, 1, -1)
    ),
    "lateral": Arm((100, -50, 35, 400, 500, 600, 90), (0,) * 6, (1,) * 6, 20),
}
ATOB = """
function atob(text) {
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  let out = "", bits = 0, held = 0;
  for (const c of text.replace(/=+$/, "")) {
    held = (held << 6) | letters.indexOf(c);
    bits += 6;
    if (bits >= 8) { bits -= 8; out += String.fromCharCode((held >> bits) & 255); }
  }
  return out;
}
"""


@pytest.fixture(scope="module")
def script() -> MiniRacer:
    engine = MiniRacer()
    files = ("view_math.js", "machine_faces.js", "depth_buffer.js")
    engine.eval(ATOB + "".join((SHARED / name).read_text() for name in files))
    return engine


def of(script: MiniRacer, expression: str):
    return json.loads(script.eval(f"JSON.stringify({expression})"))


def js(arm: Arm) -> str:
    return json.dumps(vars(arm))


@pytest.mark.parametrize("name", ARMS)
def test_the_arm_stands_where_opw_kinematics_says(name: str) -> None:
    arm = ARMS[name]
    names = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
    lengths = {k: 1e-3 * v for k, v in zip(names, arm.lengths, strict=True)}
    flips = tuple(s < 0 for s in arm.signs)
    model = opw.KinematicModel(**lengths, offsets=tuple(arm.offsets), flip_axes=flips)
    robot = opw.Robot(model, degrees=False)
    joints = np.random.default_rng(5).uniform(-3.0, 3.0, (300, 6))
    points = chain(arm, joints)
    for k, q in enumerate(joints):
        pose = robot.forward(q).as_matrix()
        assert np.allclose(1e-3 * points["flange"][k], pose[:3, 3], atol=1e-12)
        tip = pose[:3, 3] + 1e-3 * arm.pen * pose[:3, 2]
        assert np.allclose(1e-3 * points["tip"][k], tip, atol=1e-12)


@pytest.mark.parametrize("name", ARMS)
def test_the_script_draws_the_same_arm(script: MiniRacer, name: str) -> None:
    arm = ARMS[name]
    joints = np.random.default_rng(6).uniform(-3.0, 3.0, (40, 6))
    points = chain(arm, joints)
    for k, q in enumerate(joints):
        drawn = of(script, f"armPose({js(arm)}, {json.dumps(q.tolist())})")
        for part, place in points.items():
            assert np.allclose(drawn[part], place[k], atol=1e-9), part


def test_the_script_draws_an_arm_by_its_axes(script: MiniRacer) -> None:
    """A UR5e: places and axes of its joints are those of pinocchio."""
    ur5e = universal((0.1625, 0.1333, 0.0997, 0.0996), (-0.425, -0.3922))
    origins, directions, _, _ = ur5e.straight()
    axes = zip((1e3 * origins).tolist(), directions.tolist(), strict=True)
    arm = Arm((), axes=tuple((tuple(o), tuple(d)) for o, d in axes))
    model, _ = ur5e.model()
    data = model.createData()
    for q in np.random.default_rng(7).uniform(-3.0, 3.0, (40, 6)):
        pinocchio.forwardKinematics(model, data, q)
        for drawn, place in zip(
            of(script, f"axesPose({js(arm)}, {json.dumps(q.tolist())})"), data.oMi[1:], strict=True
        ):
            assert np.allclose(drawn["at"], 1e3 * place.translation, atol=1e-6)
            assert np.allclose(drawn["axis"], place.rotation[:, 2], atol=1e-9)
    assert of(script, f"armReach({js(arm)})")[1] == pytest.approx(162.5)


def test_a_joint_that_slides_is_drawn_where_it_is(script: MiniRacer) -> None:
    """A SCARA whose quill slides 0.1 m downwards behind two turns, and turns at its end."""
    rows = [[[0, 0, 250], [0, 0, 1], False], [[325, 0, 60], [0, 0, 1], False],
            [[275, 0, 100], [0, 0, -1], True], [[0, 0, -120], [0, 0, -1], False]]  # fmt: skip
    arm = json.dumps({"axes": rows})
    drawn = of(script, f"axesPose({arm}, [0.3, 0.5, 0.1, 2.0])")
    wrist = 325 * np.array([np.cos(0.3), np.sin(0.3)]) + 275 * np.array([np.cos(0.8), np.sin(0.8)])
    assert np.allclose(drawn[2]["at"], [*wrist, 310.0], atol=1e-9)
    assert np.allclose(drawn[3]["at"], [*wrist, 190.0], atol=1e-9)
    assert np.allclose(drawn[3]["axis"], [0, 0, -1])


def test_a_level_hand_is_drawn_level(script: MiniRacer) -> None:
    """A palletizer: upper arm and forearm by formulas, the hand turned by joint 1 alone."""
    none = [0, 0, 0]
    rows = [[[0, 0, 400], [0, 0, 1], False, 0, none], [[260, 0, 340], [0, 1, 0], False, 0, none],
            [[0, 0, 900], [0, -1, 0], False, 1, none],
            [[1000, 0, 0], [0, 0, -1], False, 2, [200, 0, -100]]]  # fmt: skip
    drawn = of(script, f"axesPose({json.dumps({'axes': rows})}, [0.3, 0.5, 0.2, 2.0])")
    out = 260 + 900 * np.sin(0.5) + 1000 * np.cos(0.2) + 200
    up = 740 + 900 * np.cos(0.5) + 1000 * np.sin(0.2) - 100
    wanted = [out * np.cos(0.3), out * np.sin(0.3), up]
    assert np.allclose(drawn[3]["at"], wanted, atol=1e-9)
    assert np.allclose(drawn[3]["axis"], [0, 0, -1])


@given(st.lists(st.floats(-1e5, 1e5), max_size=60))
def test_packed_numbers_are_off_by_half_a_step_at_most(values: list[float]) -> None:
    packed = quantised(np.array(values))
    engine = _engine()
    got = of(engine, f"Array.from(numbers({json.dumps(packed)}))")
    span = max(values, default=0.0) - min(values, default=0.0)
    assert np.allclose(got, values, rtol=0.0, atol=0.5001 * span / 65535 + 1e-9)


def _engine(kept: list[MiniRacer] = []) -> MiniRacer:  # noqa: B006  (made once)
    if not kept:
        kept.append(MiniRacer())
        kept[0].eval(ATOB + (SHARED / "view_math.js").read_text())
    return kept[0]


def test_the_camera_is_a_pinhole(script: MiniRacer) -> None:
    view = "{azimuth: 0.7, elevation: 0.3, target: [10, 20, 30], distance: 500}"
    look = f"camera({view}, 800, 600)"
    assert of(script, f"{look}([10, 20, 30])") == [400, 300, 500, True]
    eye = np.array([math.cos(0.3) * math.cos(0.7), math.cos(0.3) * math.sin(0.7), math.sin(0.3)])
    right, target = np.array([-math.sin(0.7), math.cos(0.7), 0.0]), np.array([10.0, 20.0, 30.0])
    up = np.cross(eye, right)
    for point in np.random.default_rng(2).uniform(-150, 150, (20, 3)):
        x, y, depth, _ = of(script, f"{look}({point.tolist()})")
        ray = point - (target + 500 * eye)
        assert depth == pytest.approx(-ray @ eye)
        assert x == pytest.approx(400 + 1140 * (ray @ right) / depth)
        assert y == pytest.approx(300 - 1140 * (ray @ up) / depth)
    assert of(script, f"{look}({(target + 499 * eye).tolist()})")[3] is False  # behind the lens


def test_faces_look_outwards(script: MiniRacer) -> None:
    for made, middle in (
        ("tube([0,0,0],[30,40,0],5,2)", [15, 20, 0]),
        ("box([0,0,0],[2,4,6])", [1, 2, 3]),
    ):
        faces = of(script, made)
        assert len(faces) >= 6
        for face in faces:
            corners = np.array(face["corners"])
            assert np.linalg.norm(face["normal"]) == pytest.approx(1.0)
            assert (corners.mean(axis=0) - middle) @ face["normal"] > 0.0


def test_samples_between_frames_and_round_numbers(script: MiniRacer) -> None:
    time = np.sort(np.random.default_rng(1).uniform(0, 9, 40))
    values = np.sin(time)
    for now in np.linspace(-1, 10, 60):
        got = of(script, f"sampled({time.tolist()}, [{values.tolist()}], {now})")[0]
        assert got == pytest.approx(np.interp(now, time, values), abs=1e-12)
    for value, wanted in ((1, 1), (9.99, 5), (0.031, 0.02), (250, 200)):
        assert of(script, f"round125({value})") == pytest.approx(wanted)
    assert of(script, 'colour(["#000000", "#ff8040"], 0.5)') == "rgb(128,64,32)"


def test_the_scripts_are_small_and_whole(script: MiniRacer) -> None:
    texts = [((SHARED if s in PICTURE else REPORT) / s).read_text() for s in SCRIPTS]
    assert sum(len(t.encode()) for t in texts) < BYTES_MAX
    for text in texts:
        script.eval(f"new Function({json.dumps(text)})")  # a wrong word would not compile
    for word in ("http:", "https:", "import(", "fetch("):
        assert not any(word in t for t in texts), "the page needs no network"


def by_rays(faces: list, wide: int, high: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of each pixel the nearest face, from 1, by its middle; 1/depth; its way to an edge."""
    x, y = np.meshgrid(np.arange(wide) + 0.5, np.arange(high) + 0.5)
    nearest, word, edge = (
        np.zeros((high, wide)),
        np.zeros((high, wide), int),
        np.full((high, wide), 9.0),
    )
    for number, corners in enumerate(faces, 1):
        c = np.array(corners)
        inside, sign = np.ones((high, wide), bool), 0.0
        for a, b in zip(c, np.roll(c, -1, axis=0), strict=True):
            side = (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
            (ux, uy), (vx, vy) = c[1, :2] - c[0, :2], c[2, :2] - c[0, :2]
            sign = sign or math.copysign(1.0, ux * vy - uy * vx)
            inside &= sign * side > 0.0
            edge = np.minimum(edge, np.abs(side) / np.linalg.norm(b[:2] - a[:2]))
        plane = np.linalg.solve(np.column_stack([c[:3, :2], np.ones(3)]), c[:3, 2])
        depth = plane[0] * x + plane[1] * y + plane[2]
        front = inside & (depth > nearest)
        nearest[front], word[front] = depth[front], number
    return word, nearest, edge


def convex(rng: np.random.Generator, count: int) -> list[list[float]]:
    """Corners of a face in a plane of 1/depth, in order round it."""
    angles = np.sort(rng.uniform(0.0, 2.0 * math.pi, count))
    at, size = rng.uniform(-5.0, 45.0, 2), rng.uniform(6.0, 30.0, 2)
    tilt, middle = rng.uniform(-2e-5, 2e-5, 2), rng.uniform(2e-3, 4e-3)
    points = at + size * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return [[*p, middle + float(tilt @ p)] for p in points.tolist()]


def test_each_pixel_shows_the_nearest_face(script: MiniRacer) -> None:
    """Faces that cross each other, some partly outside of the picture."""
    rng, (wide, high), seen = np.random.default_rng(8), (40, 30), []
    for _ in range(40):
        faces = [convex(rng, int(n)) for n in rng.integers(3, 7, 6)]
        drawn = of(
            script,
            f"(() => {{ const near = new Float32Array({wide * high}),"
            f" words = new Uint32Array({wide * high});"
            f" {json.dumps(faces)}.forEach((f, k) =>"
            f" fillFace(near, {wide}, {high}, f, words, k + 1));"
            " return [Array.from(words), Array.from(near)]; })()",
        )
        words, near = (np.reshape(v, (high, wide)) for v in drawn)
        word, nearest, edge = by_rays(faces, wide, high)
        clear = edge > 1e-6
        assert np.allclose(near[clear], nearest[clear], rtol=1e-5, atol=1e-9)
        ordered = np.abs(near - nearest) < 1e-9  # two that are equally near are left out
        assert (words == word)[clear & ordered].mean() > 0.999
        seen.append(len(np.unique(word)))
    assert np.mean(seen) > 4.0


def test_a_face_is_cut_before_the_camera(script: MiniRacer) -> None:
    corners = [[0, 0, 0], [10, 0, 0], [10, 0, 20], [0, 0, 20]]
    depth = "(p) => p[2]"
    kept = of(script, f"clipped({corners}, {depth}, 5)")
    assert sorted(kept) == [[0, 0, 5], [0, 0, 20], [10, 0, 5], [10, 0, 20]]
    assert of(script, f"clipped({corners}, {depth}, 30)") == []
    assert of(script, f"clipped({corners}, {depth}, -1)") == corners


def test_a_line_is_left_out_where_a_face_hides_it(script: MiniRacer) -> None:
    """It goes through a plane at depth 100 that stands from x = 20 to 60."""
    hides = "({ hidden: ([x, y, d], slack) => x >= 20 && x < 60 && d - slack > 100 })"
    line = "[[0, 5, 80, true], [80, 5, 120, true]]"
    (first, second) = of(script, f"shownPieces({line}, {hides}, 0)")
    share = (1 / 80 - 1 / 100) / (1 / 80 - 1 / 120)  # of the picture, at which it is behind
    assert first[0][0] == 0 and 80 * share - 5 < first[-1][0] <= 80 * share
    assert 60 <= second[0][0] < 65 and second[-1][0] == 80
    assert all(1 / p[2] == pytest.approx(1 / 80 + (1 / 120 - 1 / 80) * p[0] / 80) for p in first)
    assert len(of(script, f"shownPieces({line}, {hides}, 30)")) == 1
    assert of(script, f"shownPieces([[0,0,9,false],[9,0,9,true]], {hides}, 0)") == [
        [[9, 0, 9, True]]
    ]


def test_bodies_of_a_cell_are_drawn_where_they_stand(script: MiniRacer) -> None:
    """Corners of a turned box are as far from its middle, in its own directions, as its halves."""
    turn = turn_of(0.3, -0.7, 1.1)
    body = {"half": [30, 20, 10], "turn": turn.tolist(), "centre": [100, 200, 300]}
    faces = of(script, f"cellFaces([{json.dumps(body)}], [1, 2, 3])")
    corners = np.array([f["corners"] for f in faces]) - body["centre"]
    assert np.allclose(np.abs(corners @ turn), body["half"])
    outward = np.einsum("fkx,fx->fk", corners, [f["normal"] for f in faces])
    assert (outward > 0.0).all()


@pytest.fixture(scope="module")
def circle():
    return motionfmu.load(ROOT / "scenarios/circle").run()


def test_a_scene_is_the_run(circle, tmp_path: Path) -> None:
    scene = scene_of(circle, [from_contour(circle.contour())])
    assert scene is not None and scene.arm is None and 500 < len(scene.time) <= 2000
    table = 1e3 * circle["machine.table_position"][:, :3]
    for time, tool in ((scene.time, scene.tool), (scene.path_time, scene.path)):
        assert (time[0], time[-1]) == (circle.time[0], circle.time[-1])
        assert np.array_equal(tool, table[np.searchsorted(circle.time, time)])
    drawn = np.stack([np.interp(circle.time, scene.path_time, c) for c in scene.path.T], axis=1)
    assert np.linalg.norm(drawn - table, axis=1).max() < 0.005 * np.ptp(table)
    gap = np.linalg.norm(scene.lines[0].gap, axis=1)
    assert gap.max() == pytest.approx(circle.contour().error.max, rel=1e-9)
    page = write_report(circle, circle.contour(), tmp_path).read_text()
    assert page.count("<h2>The machine in motion</h2>") == 1
    data = page_data(page)["views"][0]
    assert len(json.dumps(data)) < 200_000
    values = of(_engine(), f"Array.from(numbers({json.dumps(data['tool'][0])}))")
    assert np.allclose(values, scene.tool[:, 0], atol=np.ptp(scene.tool[:, 0]) / 65535)


def recorded(view: dict, **signals):
    """A run of an arm that no FMU here has made."""
    from motionfmu.scenarios.analyses import View

    def port(shape, causality="output", unit="m"):
        return SimpleNamespace(shape=shape, causality=causality, unit=unit, count=math.prod(shape))

    ports = {n.partition(".")[2]: port(v.shape[1:]) for n, v in signals.items()}
    given = {"a1": (0.15,), "a2": (-0.115,), "b": (0.0,), "c1": (0.445,), "c2": (0.7,)}
    given |= {"c3": (0.795,), "c4": (0.085,), "joint_offset": (0, 0, -math.pi / 2, 0, 0, 0)}
    given |= {"joint_sign": (1,) * 6, "tool_length": (0.15,)}
    ports |= {n: port((len(v),) if len(v) > 1 else (), "parameter") for n, v in given.items()}
    body = SimpleNamespace(view=View(**view), iso9283=None, contour=None, component={}, connect={})
    resolver = SimpleNamespace(ports={"arm": ports}, document=SimpleNamespace(body=body))

    class Run(dict):
        pass

    run = Run(signals)
    run.time, run.signals, run.resolver = np.linspace(0, 1, 400), signals, resolver
    run.parameter = lambda name: given[name.partition(".")[2]]
    return run


def test_no_corner_of_the_path_is_lost() -> None:
    """A zigzag of 201 strokes in 60000 samples, which no even sampling to 1500 meets."""
    place = np.linspace(0.0, 1.0, 60_000)
    y = np.interp(place, np.linspace(0, 1, 202), np.arange(202) % 2)
    tip = np.stack([place, y, 0 * y], axis=1)
    run = recorded({}, **{"arm.tool_position": tip})
    run.time = place
    scene = scene_of(run)
    assert scene is not None and len(scene.path) < 3100
    drawn = np.interp(place, scene.path_time, scene.path[:, 1])
    assert np.abs(drawn - 1e3 * y).max() < 4.0  # a sample's way is 3.4 mm


def test_the_speed_is_that_between_the_samples_beside() -> None:
    """On a parabola the mean over two steps is the slope itself; at the ends it is over one."""
    time = np.linspace(0.0, 1.0, 3001)
    run = recorded({}, **{"arm.tool_position": np.stack([time**2, time, 0 * time], axis=1)})
    run.time = time
    scene = scene_of(run)
    assert scene is not None and scene.path_time[0] == 0.0 and scene.path_time[-1] == 1.0
    slope = 2 * scene.path_time
    slope[[0, -1]] += np.array([time[1], -time[1]])
    assert np.allclose(scene.speed, 1e3 * np.hypot(1.0, slope), rtol=1e-9, atol=0.0)


def test_an_arm_appears_by_itself_with_the_lengths_of_its_fmu() -> None:
    joints = np.outer(np.linspace(0, 1, 400), [0.4, 0.3, -0.2, 0.5, 0.6, -1.0])
    tip = 1e-3 * chain(ARMS["IRB 2600"], joints)["tip"]
    both = {"arm.tool_position": tip, "arm.link_angle": joints}
    scene = scene_of(recorded({}, **both))
    assert scene is not None and scene.arm == ARMS["IRB 2600"] and scene.joints is not None
    assert np.allclose(chain(scene.arm, scene.joints)["tip"], scene.tool, atol=1e-9)
    json.dumps(view_data(scene, 1.0))
    axes = recorded({}, **{"arm.tool_position": tip})
    axes.resolver.document.body.component = {"arm": "velocity_axes"}
    gantry = scene_of(axes)
    assert gantry is not None and gantry.arm is None and no_arm(axes) == ""
    assert scene_of(recorded({"show": False}, **both)) is None
    still = {"arm.tool_position": 0 * tip, "arm.link_angle": 0 * joints}
    assert scene_of(recorded({}, **still)) is None
    page = Page()
    assert add_view(page, None) == {} and page.sections == []


def test_an_arm_without_joint_angles_is_no_gantry() -> None:
    """A record of its tool alone: words stand where the picture would."""
    tip = np.linspace(0.0, 1.0, 400)[:, None] * [1.0, 2.0, 3.0]
    run = recorded({}, **{"arm.tool_position": tip})
    run.resolver.document.body.component = {"arm": "robot_arm"}
    told = "The joint angles of arm are not recorded: there is no arm to draw."
    assert scene_of(run) is None and no_arm(run) == told
    page = Page()
    assert add_view(page, None, missing=told) == {}
    assert "The machine in motion" in page.sections[0] and told in page.sections[0]
    run.resolver.document.body.view.show = False
    assert no_arm(run) == ""


OWN = """# Own robot: it writes, and nothing of it but its end is asked for.
stop = 3.0
{machine}
"soft.program" = "ivu.job"
"soft.points" = "small.txt"
"soft.job" = "TWO"
"soft.start_delay" = 1.0
"*.start_joint" = [0.0, 16.543311, 27.588135, 0.0, 45.868554, 0.0]

[record]
signals = [{signals}]
every = 20
"""
# The arm, or a controller and its card alone.
MACHINE = (ROOT / "src/motionfmu/machines/robot6/machine.toml").read_text()
WITH_ARM = MACHINE[MACHINE.index("step =") : MACHINE.index("[signals]")]
ALONE = """
step = 5e-5
leave = ["card.*", "soft.*"]
component = { soft = "soft_controller", card = "fpga_card" }

[connect]
"card.host_*" = "soft.card_*"
"soft.card_*" = "card.*"

[set]
"soft.tool" = [0, 0, 150, 0, 0, 0]
"""


@pytest.mark.parametrize(
    ("machine", "signals", "tool", "joints"),
    [
        (WITH_ARM, '"soft.done"', "arm.tool_position", "arm.link_angle"),
        (ALONE, '"soft.tool_position"', "soft.tool_position", "soft.joint_command"),
    ],
    ids=["arm", "controller alone"],
)
def test_a_robot_s_page_draws_the_arm(
    tmp_path: Path, machine: str, signals: str, tool: str, joints: str
) -> None:
    """Its joint angles are recorded unasked; without an arm, those commanded."""
    for name in ("ivu.job", "small.txt"):
        (tmp_path / name).write_text((ROOT / "scenarios/robot_ivu" / name).read_text())
    text = OWN.format(machine=machine, signals=signals)
    (tmp_path / "scenario.toml").write_text(text)
    run = motionfmu.load(tmp_path).run()
    assert {tool, joints, "soft.base_place"} <= set(run.signals)
    scene = scene_of(run)
    assert scene is not None and scene.arm is not None and scene.joints is not None
    assert scene.base is not None and not scene.base.any()
    rows = np.searchsorted(run.time, scene.time)
    assert np.array_equal(scene.joints, run[joints][rows])
    assert np.array_equal(scene.tool, 1e3 * run[tool][rows])
    # The pen's spring and the arm's own give change 150 mm by little.
    flange = chain(scene.arm, scene.joints)["flange"]
    assert np.linalg.norm(flange - scene.tool, axis=1) == pytest.approx(150.0, abs=2.0)
    page = write_report(run, None, tmp_path / "page").read_text()
    assert page_data(page)["views"][0]["arm"]["lengths"] == list(scene.arm.lengths)


def test_another_tool_is_no_motion() -> None:
    """Its tip is 150 mm away in one sample; 100 mm/s from rest before and behind it stay."""
    time = np.arange(1000) * 1e-3
    x = 0.1e3 * (time - 0.1).clip(0.0, 0.5)
    tip = np.stack([x, 0.2 * x, 0.0 * x], axis=1)
    assert np.array_equal(without_leaps(tip), tip)
    for first in (1, 50, 800):
        other = tip - np.where(np.arange(1000)[:, None] < first, 0.0, [0.0, 0.0, 150.0])
        assert np.allclose(without_leaps(other), tip, atol=1e-9)
    coarse = np.zeros((9, 3))
    coarse[4:, 0] = (2.0, 8.0, 14.0, 16.0, 16.0)  # a quick motion in few samples
    assert np.array_equal(without_leaps(coarse), coarse)


def test_a_page_s_speed_and_way_are_without_another_tool() -> None:
    """50 mm at up to 100 mm/s, whose tool is 150 mm longer from 0.3 s on: its step is no speed."""
    time = np.arange(1000) * 1e-3
    x = 0.1 * (time - 0.1).clip(0.0, 0.5)
    tip = np.stack([x, 0.0 * x, np.where(time < 0.3, 0.0, -0.150)], axis=1)
    run = recorded({}, **{"arm.tool_position": tip})
    run.time, run.scenario, run.options, run.done_at = time, None, {}, None
    found = summary_of(run, None)
    assert found.distance == pytest.approx(50.0 - 0.1, rel=1e-9)  # without the step that leaps
    assert found.speeds is not None
    assert found.speeds.tool.max() == pytest.approx(100.0, rel=1e-9)
