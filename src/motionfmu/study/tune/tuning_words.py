"""A tuning's model, plants and cost in words."""

from collections.abc import Mapping

from motionfmu.analysis.linear.block import Plant, Sampled
from motionfmu.analysis.linear.tuning_parts import worst
from motionfmu.study.tune.path_error import PathCost
from motionfmu.study.tune.problem import ON_PATH
from motionfmu.study.tune.tuning_functions import TuningFunctions


def assumptions(study: TuningFunctions) -> list[str]:
    """Feedback side, delays and operating point of the model."""
    axis = study.axes[next(iter(study.axes))]
    found = []
    ports = study.scenario.resolver.ports
    for target, source in axis.wires.items():
        if isinstance(axis.blocks[source[0]], Plant):
            doc = ports[source[0]][source[1]].doc
            found.append(f"Feedback: {'.'.join(target)} reads {'.'.join(source)} ({doc})")
    found.append(f"Judged: {study.signals.position}{summed(study)}")
    for name, block in axis.blocks.items():
        grid = f"{block.grid_ns * 1e-3:g} µs"
        if isinstance(block, Sampled) and _acts(block):
            found.append(f"Delay: {name} samples every {grid} and shows it one period later")
            if len(block.laws) > 1:
                cycle = f"{block.cycle_ns * 1e-3:g} µs"
                found.append(f"Delay: {name} computes its law every {cycle}")
        elif isinstance(block, Plant):
            found.append(f"Delay: {name} holds its input over {grid}")
    found.append(f"Delay: the wires none, communication step {axis.step_ns * 1e-3:g} µs")
    found += [f"Worst case: {text}" for text in worst(axis)]
    point = ", ".join(f"{n} = {v:.4g}" for n, v in study.at.items()) or "at rest"
    found.append(f"Operating point: {point}")
    if isinstance(study.path, PathCost) and study.path.judged < 0.99 * study.base.time[-1]:
        found.append(
            f"Path: {study.path.judged:.0f} s of {study.base.time[-1]:.0f} s are judged, half where"
            " the error is largest, half spread evenly; the FMUs run the whole"
        )
    if study.problem.family:
        ranges = ", ".join(f"{n} {lo:g} to {hi:g}" for n, (lo, hi) in study.problem.family.items())
        found.append(f"Plants: nominal and all corners of {ranges}")
    return found


def summed(study: TuningFunctions) -> str:
    """Words that say how a cost after a step is summed over several axes."""
    cost = study.problem.cost
    if cost in ON_PATH or len(study.axes) == 1:
        return ""
    return f", {cost} is the sum over axes {', '.join(map(str, study.axes))}"


def _acts(block: Sampled) -> bool:
    """Whether an output of a block depends on anything."""
    first = len(block.states)
    return bool(block.pattern[first : first + len(block.outputs)].any())


def plant_text(plant: Mapping[str, float]) -> str:
    """A plant in words."""
    return ", ".join(f"{n} = {v:g}" for n, v in plant.items()) or "nominal plant"


def units_of(cost: str) -> tuple[float, str]:
    """Factor and unit in which a cost is shown."""
    if cost in ON_PATH:
        return 1e3, "µm"
    return {"ise": (1e3, "ms"), "iae": (1e3, "ms"), "itae": (1e6, "ms²")}[cost]
