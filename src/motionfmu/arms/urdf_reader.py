"""An arm from a URDF: the chain to a tip; what is fixed to a link is part of it.

Of <https://wiki.ros.org/urdf/XML>: links with inertia and bodies, joints with origin, axis, limits,
friction and mimic, and the gear ratio of a transmission.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from motionfmu.arms.arm_description import (
    PRISMATIC,
    ArmDescription,
    ArmJoint,
    Array,
    LinkShape,
    RigidLink,
    joined,
    moved,
    placed,
    turn_of,
)
from motionfmu.arms.xml_lines import XmlElement, xml_of
from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import shown, text_of

MOVING = ("revolute", "continuous", PRISMATIC)
USUAL_TIPS = ("tool0", "flange", "ee_link", "tool")  # of tips behind the same joints
TOLD_LINKS = 12
# Principal moments may be negative by so much of the largest: files have a few digits.
ROUNDED = 1e-6


@dataclass(frozen=True)
class _Tree:
    """Links and joints of a file by their names."""

    file: str
    robot: XmlElement
    links: dict[str, XmlElement]
    into: dict[str, XmlElement]  # the joint that leads to a link
    below: dict[str, list[XmlElement]]  # joints that lead on from a link

    def chain(self, tip: str) -> list[XmlElement]:
        """Joints from the root to a link."""
        found: list[XmlElement] = []
        while tip in self.into:
            joint = self.into[tip]
            found.append(joint)
            tip = _end(joint, "parent")
        return found[::-1]

    def movers(self, tip: str) -> list[str]:
        """Names of the joints that move between the root and a link."""
        return [j.given["name"] for j in self.chain(tip) if j.given.get("type") in MOVING]


def urdf_arm(file: str | Path, tip: str | None = None) -> ArmDescription:
    """Read an arm from a URDF.

    Parameters
    ----------
    file : str or Path
    tip : str, optional
        Link at the end of the chain; needed if the tree has several ends behind different joints.

    Returns
    -------
    ArmDescription

    Raises
    ------
    InputError
        The file is no URDF of an arm; the message has its line, element and value.
    """
    return urdf_text_arm(text_of(file), str(file), tip)


def urdf_text_arm(text: str, file: str, tip: str | None = None) -> ArmDescription:
    """The arm of a URDF's text."""
    tree = _tree(xml_of(text, file))
    tip = _tip(tree, tip)
    chain = tree.chain(tip)
    notes: list[str] = []
    reader = _Chain(tree, chain, notes)
    joints, last = reader.joints()
    if not joints:
        raise InputError(f"{file}: nothing moves between {reader.root} and {tip}")
    name = tree.robot.given.get("name", "").strip() or Path(file).stem
    return ArmDescription(name, reader.base, joints, tip, last, tuple(notes))


# CCN 16: one refusal for each thing that keeps links and joints from being a tree.
def _tree(robot: XmlElement) -> _Tree:
    faults = Faults()
    if robot.tag != "robot":
        raise robot.wrong("the root of a URDF is <robot>")
    _no_xacro(robot)
    links: dict[str, XmlElement] = {}
    for link in robot.all("link"):
        with faults.each():
            name = link.word("name")
            if name in links:
                raise link.wrong(f"there is one of this name on line {links[name].line}")
            links[name] = link
    into: dict[str, XmlElement] = {}
    below: dict[str, list[XmlElement]] = {}
    names: dict[str, XmlElement] = {}
    for joint in robot.all("joint"):
        with faults.each():
            name = joint.word("name")
            if name in names:
                raise joint.wrong(f"there is one of this name on line {names[name].line}")
            names[name] = joint
            for which in ("parent", "child"):
                if _end(joint, which) not in links:
                    told = f"{which} {shown(_end(joint, which))} is no link"
                    raise joint.wrong(told + suggestion(_end(joint, which), links))
            child = _end(joint, "child")
            if child in into:
                told = f"{child} is the child of {into[child].given['name']}, too"
                raise joint.wrong(f"{told}; a URDF is a tree")
            into[child] = joint
            below.setdefault(_end(joint, "parent"), []).append(joint)
    faults.tell()
    tree = _Tree(robot.file, robot, links, into, below)
    roots = [n for n in links if n not in into]
    if len(roots) != 1:
        told = f"{len(roots)} links without a parent ({_listed(roots)})" if roots else "a circle"
        raise robot.wrong(f"{told}; a URDF is a tree with one root")
    for name in links:  # links in a circle of their own have parents, but no way to the root
        seen, at = {name}, name
        while at in into:
            at = _end(into[at], "parent")
            if at in seen:
                raise into[name].wrong(f"{name} stands in a circle; a URDF is a tree")
            seen.add(at)
    return tree


def _no_xacro(element: XmlElement) -> None:
    if element.tag.startswith("xacro:"):
        raise element.wrong("xacro is not read; expand it first: xacro FILE.xacro > FILE.urdf")
    for child in element.children:
        _no_xacro(child)


def _end(joint: XmlElement, which: str) -> str:
    child = joint.first(which)
    if child is None:
        raise joint.wrong(f"<{which}> is missing")
    return child.word("link")


# CCN 16: the tip asked for, one by its name, or the only one; or why there is none.
def _tip(tree: _Tree, tip: str | None) -> str:
    """The end of the chain: the one asked for, or that behind the most joints."""
    if tip is not None:
        if tip not in tree.links:
            raise InputError(f"{tree.file}: no link {shown(tip)}{suggestion(tip, tree.links)}")
        return tip
    movers = {n: tree.movers(n) for n in tree.links}
    most = max(map(len, movers.values()))
    longest = [n for n, names in movers.items() if len(names) == most]
    ends = [n for n in longest if n not in tree.below]
    if len({tuple(movers[n]) for n in longest}) > 1:
        told = f"{tree.file}: several chains: --tip one of {_listed(ends)}"
        raise InputError(f"{told}, or {_parting(tree, ends)}, where they part")
    for name in USUAL_TIPS:
        if found := [n for n in longest if n == name or n.endswith(f"_{name}")]:
            return found[0]
    return ends[0] if len(ends) == 1 else longest[0]


def _parting(tree: _Tree, ends: Sequence[str]) -> str:
    """The last link that all ways from the root have."""
    ways = [[_end(j, "child") for j in tree.chain(n)] for n in ends]
    shared = [step[0] for step in zip(*ways, strict=False) if len(set(step)) == 1]
    return shared[-1] if shared else next(n for n in tree.links if n not in tree.into)


def _listed(names: Sequence[str]) -> str:
    more = f" and {len(names) - TOLD_LINKS} more" if len(names) > TOLD_LINKS else ""
    return ", ".join(names[:TOLD_LINKS]) + more


class _Chain:
    """Reads the joints of a chain and folds what is fixed to its links."""

    def __init__(self, tree: _Tree, chain: list[XmlElement], notes: list[str]) -> None:
        self.tree, self.chain, self.notes = tree, chain, notes
        self.on = {id(j) for j in chain}
        self.ratios = _ratios(tree)
        self.root = next(n for n in tree.links if n not in tree.into)
        self.base = RigidLink(self.root)
        # The joints read so far: which one has their angle, times what, plus what.
        self.angles: dict[str, tuple[int, float, float]] = {}

    def joints(self) -> tuple[tuple[ArmJoint, ...], Array]:
        """The moving joints, and the tip in the last link."""
        faults = Faults()
        parts: list[tuple[RigidLink, Array]] = self._fixed(self.root, np.eye(4), faults)
        found: list[ArmJoint] = []
        at = np.eye(4)  # of the latest link in the latest moving one
        for element in self.chain:
            child = _end(element, "child")
            kind = element.given.get("type", "")
            with faults.each():
                at = at @ _origin(element)
                if kind == "fixed":
                    parts += self._fixed(child, at, faults)
                    continue
                joint = self._joint(element, kind, at)
                self._close(found, parts)
                self.angles[joint.name] = joint.follows or (len(found), 1.0, 0.0)
                found.append(joint)
                at = np.eye(4)
                parts = self._fixed(child, at, faults)
        self._close(found, parts)
        faults.tell()
        return tuple(found), at

    def _close(self, found: list[ArmJoint], parts: list[tuple[RigidLink, Array]]) -> None:
        """Give the links that are fixed to each other to the joint before them."""
        if not found:
            self.base = joined(self.root, parts)
            return
        found[-1] = replace(found[-1], link=joined(found[-1].link.name, parts))

    def _fixed(self, name: str, at: Array, faults: Faults) -> list[tuple[RigidLink, Array]]:
        """A link and all that hangs on it beside the chain, with frames in the moving link."""
        parts = [(_link(self.tree.links[name], faults, self.notes), at)]
        for joint in self.tree.below.get(name, ()):
            if id(joint) in self.on:
                continue
            place, kind = at @ _origin(joint), joint.given.get("type", "")
            child = _end(joint, "child")
            if kind in MOVING:
                held = 0.0
                if kind != "continuous" and (limit := joint.first("limit")) is not None:
                    low, high = limit.number("lower", 0.0), limit.number("upper", 0.0)
                    held = min(max(0.0, low), high)
                self.notes.append(
                    f"joint {joint.word('name')} ({kind}) is beside the chain: held at {held:g}"
                )
                axis = _axis(joint)
                bare = ArmJoint("", kind, place, axis, 0.0, 0.0, 0.0, RigidLink(""))
                place = place @ moved(bare, np.array(held))
            elif kind != "fixed":
                faults.lines += _unknown(joint, kind).args
            parts += self._fixed(child, place, faults)
        return parts

    def _joint(self, element: XmlElement, kind: str, at: Array) -> ArmJoint:
        if kind not in MOVING:
            raise _unknown(element, kind)
        name = element.word("name")
        limit, dynamics = element.first("limit"), element.first("dynamics")
        low, high = -math.inf, math.inf
        if kind != "continuous":
            if limit is None:
                raise element.wrong("<limit> is missing")
            low, high = limit.number("lower", 0.0), limit.number("upper", 0.0)
            if low >= high:
                raise limit.wrong(f"of joint {name}: lower = {low:g}, upper = {high:g}")
        speed = 0.0 if limit is None else limit.number("velocity", 0.0)
        effort = 0.0 if limit is None else limit.number("effort", 0.0)
        if limit is not None and (speed < 0.0 or effort < 0.0):
            raise limit.wrong(f"of joint {name}: velocity = {speed:g}, effort = {effort:g}")
        damping = friction = None
        if dynamics is not None:
            damping, friction = dynamics.number("damping", 0.0), dynamics.number("friction", 0.0)
        return ArmJoint(
            name=name,
            kind=kind,
            origin=at,
            axis=_axis(element),
            low=low,
            high=high,
            speed=speed or math.inf,
            link=RigidLink(_end(element, "child")),
            effort=effort,
            ratio=self.ratios.get(name),
            damping=damping or None,
            friction=friction or None,
            follows=self._follows(element, name),
        )

    def _follows(self, element: XmlElement, name: str) -> tuple[int, float, float] | None:
        mimic = element.first("mimic")
        if mimic is None:
            return None
        leader = mimic.word("joint")
        if leader not in self.angles:
            known = ", ".join(self.angles) or "none"
            told = f"of joint {name}: {shown(leader)} is no joint before it in the chain ({known})"
            raise mimic.wrong(told)
        factor, offset = mimic.number("multiplier", 1.0), mimic.number("offset", 0.0)
        self.notes.append(f"joint {name} mimics {leader}: {factor:g} times its angle")
        own, times, plus = self.angles[leader]
        return own, factor * times, factor * plus + offset


def _unknown(joint: XmlElement, kind: str) -> InputError:
    return joint.wrong(f"type = {shown(kind)}: fixed, {', '.join(MOVING)} are read")


def _ratios(tree: _Tree) -> dict[str, float]:
    """Gear ratio by joint, of transmissions that say one."""
    found: dict[str, float] = {}
    for transmission in tree.robot.all("transmission"):
        joints = [j.given.get("name", "") for j in transmission.all("joint")]
        for actuator in transmission.all("actuator"):
            reduction = actuator.first("mechanicalReduction")
            if reduction is None or len(joints) != 1:
                continue
            try:
                value = float(reduction.text)
            except ValueError:
                value = math.nan
            if not 0.0 < abs(value) < math.inf:
                raise reduction.wrong(f"{shown(reduction.text)}: a number that is not 0 wanted")
            if abs(value) != 1.0:  # ROS needs one there and writes 1 where nobody knows it
                found[joints[0]] = abs(value)
    return found


def _axis(joint: XmlElement) -> Array:
    element = joint.first("axis")
    axis = (1.0, 0.0, 0.0) if element is None else element.words("xyz", 3, (1.0, 0.0, 0.0))
    length = math.hypot(*axis)
    if not length:
        assert element is not None
        raise element.wrong(f"of joint {joint.given['name']}: xyz = 0 0 0 is no direction")
    return np.array(axis) / length


def _origin(element: XmlElement) -> Array:
    """The frame of a child <origin>; without one no offset."""
    origin = element.first("origin")
    if origin is None:
        return np.eye(4)
    nothing = (0.0, 0.0, 0.0)
    turn = turn_of(*origin.words("rpy", 3, nothing))
    return placed(origin.words("xyz", 3, nothing), turn)


def _link(element: XmlElement, faults: Faults, notes: list[str]) -> RigidLink:
    name = element.given["name"]
    shapes: list[LinkShape] = []
    for use in ("visual", "collision"):
        for body in element.all(use):
            with faults.each():
                shapes += _shape(body, use)
    inertial = element.first("inertial")
    if inertial is None:
        return RigidLink(name, shapes=tuple(shapes))
    with faults.each():
        mass, frame = inertial.first("mass"), _origin(inertial)
        value = 0.0 if mass is None else mass.number("value")
        if mass is not None and value < 0.0:
            raise mass.wrong(f"of link {name}: value = {value:g} is negative")
        tensor = np.zeros((3, 3))
        if (inertia := inertial.first("inertia")) is not None:
            tensor = _tensor(inertia, name, notes)
        turn = frame[:3, :3]
        return RigidLink(name, value, frame[:3, 3], turn @ tensor @ turn.T, tuple(shapes))
    return RigidLink(name, shapes=tuple(shapes))


def _tensor(element: XmlElement, link: str, notes: list[str]) -> Array:
    xx, yy, zz = (element.number(k, 0.0) for k in ("ixx", "iyy", "izz"))
    xy, xz, yz = (element.number(k, 0.0) for k in ("ixy", "ixz", "iyz"))
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    low, middle, high = np.linalg.eigvalsh(tensor)
    if low < -ROUNDED * max(high, 0.0) or high < 0.0:
        told = f"principal moments {low:.6g}, {middle:.6g}, {high:.6g} kg·m²: none may be negative"
        raise element.wrong(f"of link {link}: {told}")
    if low + middle < (1.0 - ROUNDED) * high:
        notes.append(
            f"link {link}: no body has the principal moments {low:.4g}, {middle:.4g}, {high:.4g} "
            "kg·m²: the largest is above the sum of the others"
        )
    return tensor


def _shape(body: XmlElement, use: str) -> list[LinkShape]:
    geometry = body.first("geometry")
    if geometry is None or not geometry.children:
        raise body.wrong("<geometry> is missing")
    shape, frame = geometry.children[0], _origin(body)
    if shape.tag == "box":
        return [LinkShape(use, "box", shape.words("size", 3, None), frame)]
    if shape.tag == "sphere":
        return [LinkShape(use, "sphere", (shape.number("radius"),), frame)]
    if shape.tag in ("cylinder", "capsule"):
        return [LinkShape(use, "cylinder", (shape.number("radius"), shape.number("length")), frame)]
    if shape.tag == "mesh":
        scale = shape.words("scale", 3, (1.0, 1.0, 1.0))
        return [LinkShape(use, "mesh", scale, frame, shape.word("filename"))]
    raise shape.wrong("a box, cylinder, sphere or mesh wanted")
