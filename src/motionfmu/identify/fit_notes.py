"""What is to be known of an identification, in words: of the record, its controller, the fit."""

from collections.abc import Iterator

import numpy as np

from motionfmu.identify import rigid_motion
from motionfmu.identify.free_parameters import FreeParameters
from motionfmu.identify.ground import LOW_PASS, OF_RATE, Ground, IdentifyOptions
from motionfmu.identify.law_choice import Validation
from motionfmu.identify.shooting import Fitted
from motionfmu.identify.span_fit import FOLLOWING, misfit

# Share of a law's signal above which the scenario's controller is not that of the record.
_STRANGE = 0.1
# A fit is bad where it leaves more than this share of a signal of the part kept back, and so many
# times what is noise in it.
_BAD, _TIMES = 0.15, 3.0
# Times that are told, and how much wider deviations are for it to be told.
_SHOWN, WIDER = 5, 1.1


def bad_fit(own: Ground, chosen: Validation | None) -> dict[str, tuple[float, float]]:
    """Signals that a fit explains badly: what it leaves of the part kept back, and their noise.

    Both as shares of the signal about its mean. A position is judged by the following error: of
    itself it always leaves little.
    """
    if chosen is None:
        return {}
    position = f"{own.loop.component}.{own.rates.outputs[own.position]}"
    cutoff = min(LOW_PASS, OF_RATE / own.data.interval)
    found = {}
    for name, left in chosen.kept.items():
        if name == position and FOLLOWING in chosen.kept:
            continue
        raw = own.data.measured[:, own.data.compared.index(position if name == FOLLOWING else name)]
        noise = float(np.std(raw - rigid_motion.smooth([raw], own.data.interval, cutoff)[0]))
        share = noise / max(chosen.sizes[name], 1e-300)
        if left > max(_BAD, _TIMES * share):
            found[name] = left, share
    return found


def contact_notes(own: Ground, fit: Fitted, span: tuple[int, int]) -> Iterator[str]:
    """What a fit across a gap left aside, and by how much its deviations are wider for it."""
    if not own.gap:
        return
    aside = fit.weights < 1.0
    rows = own.stretch(*span)[0].rows
    begins = rows[aside & ~np.append(False, aside[:-1])]
    if len(begins):
        first = ", ".join(f"{t:.4g} s" for t in own.data.time[begins[:_SHOWN]])
        yield (
            f"{100 * np.mean(aside):.2g} % of the samples count little: at {first}"
            f"{' and so on' if len(begins) > _SHOWN else ''} the motion is another than the"
            " recorded one, as when a passage through the gap falls the other way."
        )
    wider = misfit(own, fit, span) if fit.linear.sound else 1.0
    if wider > WIDER:
        yield (
            f"Standard deviations are {wider:.3g} times what residuals alone would make them: so"
            " much more than noise does the fit leave."
        )


def notes(
    own: Ground, free: FreeParameters, options: IdentifyOptions, chosen: Validation | None
) -> Iterator[str]:
    """What is to be known, in words."""
    check = own.check
    if own.limited.note:
        yield own.limited.note
    if not free.names:
        yield "This record tells nothing of the axis: it stands, or its speed does not change."
    for name, (left, noise) in bad_fit(own, chosen).items():
        yield (
            f"The fit is bad: of {name} it leaves {100 * left:.2g} % of the part kept back, where"
            f" noise is {100 * noise:.2g} % of it. This may be the record of another machine, or of"
            " one that does what this plant does not; do not use the values."
        )
    if check is None:
        return
    if check.lag:
        late = 1e3 * check.lag * own.loop.step
        yield f"{check.signal} shows {late:.4g} ms later what the record has: compared so."
    if check.taken:
        gains = ", ".join(f"{n} {b:.6g} instead of {a:.6g}" for n, (a, b) in check.gains.items())
        word = "taken" if options.controller else "not taken"
        yield (
            f"The record was made with other gains than the scenario's: {gains}"
            f" ({100 * check.fitted:.2g} % of {check.signal} are left unexplained instead of"
            f" {100 * check.difference:.2g} %): {word}."
        )
    elif check.difference > _STRANGE:
        yield (
            f"The scenario's controller does not explain the record: {check.signal} differs by"
            f" {100 * check.difference:.2g} % from what its law makes of the same motion. This may"
            " be the record of another machine."
        )
