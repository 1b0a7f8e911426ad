"""The differential equation of a class as text that an FMU carries."""

import json
from typing import Any

import casadi as ca

from motionfmu.fmu.modelica.flat import Declaration
from motionfmu.fmu.modelica.ode import Ode

# Its path in a plant's FMU; FMI leaves the folder extra/ to tools.
FILE = "ode.json"
_GROUPS = ("states", "inputs", "parameters", "outputs")
_ABOUT = ("name", "type", "kind", "unit", "description")


def to_json(ode: Ode) -> str:
    """JSON of names, units and CasADi's own form of the functions; equal for equal equations."""
    results = [ode.xdot, ode.y, ode.start]
    function = ca.Function("ode", [ode.x, ode.u, ode.p], results, {"allow_free": False})
    groups = {g: [[getattr(d, a) for a in _ABOUT] for d in getattr(ode, g)] for g in _GROUPS}
    data = {
        "name": ode.name,
        "description": ode.description,
        **groups,
        "u0": ode.u0,
        "p0": ode.p0,
        "limits": ode.limits,
        "function": function.serialize(),
    }
    return json.dumps(data, indent=1) + "\n"


def from_json(text: str) -> Ode:
    """Read what `to_json` wrote, which has no checks, sizes or expressions of declarations."""
    data: dict[str, Any] = json.loads(text)
    function = ca.Function.deserialize(data["function"])
    x, u, p = (ca.SX.sym(s, function.size1_in(k)) for k, s in enumerate("xup"))
    xdot, y, start = function(x, u, p)
    rest: tuple[Any, ...] = (False, False, None, None, None, None, None)
    groups = {g: tuple(Declaration(*row, *rest) for row in data[g]) for g in _GROUPS}
    return Ode(
        name=data["name"],
        description=data["description"],
        **groups,
        x=x,
        u=u,
        p=p,
        xdot=xdot,
        y=y,
        start=start,
        checks=(),
        sizes=ca.SX.ones(x.numel()),
        u0=tuple(data["u0"]),
        p0=tuple(data["p0"]),
        limits={name: tuple(three) for name, three in data["limits"].items()},
    )
