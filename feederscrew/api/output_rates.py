"""How many well-oriented parts leave a bowl, and what drive or what bowl reaches a rate."""

import math
from collections.abc import Sequence
from typing import Any, Unpack

from feederscrew import bowl as bowls
from feederscrew.api import asked
from feederscrew.api.asked import Path, Quantity
from feederscrew.api.bowl_settings import BowlSettings, Overrides, override_texts, with_settings
from feederscrew.bowl import Bowl
from feederscrew.output import proof
from feederscrew.part import Part
from feederscrew.rates.well_oriented import RECOMMENDED_RULE
from feederscrew.studies import bowl as machines
from feederscrew.studies import rate as rates
from feederscrew.studies import tune as tuning
from feederscrew.studies.bowl import MachineSheet
from feederscrew.studies.rate import LEAST, RateStudy, Shares
from feederscrew.studies.tune import TuneStudy
from feederscrew.tooling.devices.base import Device

DEVICES = "give devices in a list, as a bowl's devices are"


@with_settings
def shares(
    part: Part,
    bowl: Bowl,
    *,
    rule: str = RECOMMENDED_RULE,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> Shares:
    """Return the aspects of a part with the answer that ``rate``, ``tune`` and others take.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    rule, launch, probabilities, fed, seed
        Whose probabilities are taken, as for ``rate``.
    overrides, **settings
        As for ``read_bowl``: in place of the bowl's own.

    Returns
    -------
    Shares
        To be handed on as ``known``: what takes long is computed once.
    """
    return asked.probabilities(
        asked.a_part(part),
        asked.a_bowl(bowl, overrides, settings),
        rule=rule,
        launch=launch,
        probabilities=probabilities,
        fed=fed,
        seed=seed,
    )


@with_settings
def rate(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    devices: Sequence[Device] | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    rule: str = RECOMMENDED_RULE,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    known: Shares | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> RateStudy:
    """Compute the well-oriented parts per second, with each factor, as ``feeder rate``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str, optional
        The one wanted, as ``aspects`` names it; without it the orientation that leaves most often.
    heading : str or float [rad], optional
        Without one, the most frequent that stays on the track.
    devices : sequence of Device
        From ``feederscrew.tooling.devices``; those of the bowl without it.
    gap : str or float [m]
        Between one part and the next.
    fill : float [1]
        Share of the track that is occupied.
    rule : str
        Whose probabilities are taken.
    launch : str, optional
        What is done to the part on a floor at rest: 'place', 'drop', 'flip', 'roll' or 'feed'; without it
        parts are fed onto the moving floor of the bowl.
    probabilities : str or Path, optional
        File of counts whose shares are taken.
    fed : int, optional
        How many parts are fed; without it until every share is known to 2 %.
    seed : int
        Of these parts.
    known : Shares, optional
        What ``shares`` returned, in place of all of them.
    overrides, **settings
        As for ``read_bowl``, amplitude='0.3 mm': in place of the bowl's own.

    Returns
    -------
    RateStudy
        Its ``parts`` are parts per second with an interval.
    """
    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl, overrides, settings)
    arriving = asked.probabilities(
        solid, bowl,
        rule=rule, launch=launch, probabilities=probabilities, fed=fed, seed=seed, known=known,
    )  # fmt: skip
    return rates.rate(
        solid,
        bowl,
        aspect,
        heading=asked.angle("heading", heading),
        rule=rule,
        devices=None if devices is None else asked.several("devices", devices, Device, DEVICES),
        gap=asked.amount("gap", gap, "length", 0.0),
        fill=fill,
        known=arriving,
    )


@with_settings
def tune(
    part: Part,
    bowl: Bowl,
    aspect: str,
    target: Quantity,
    *,
    heading: Quantity | None = None,
    worst: bool = False,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    rule: str = RECOMMENDED_RULE,
    launch: str | None = None,
    probabilities: Path | None = None,
    fed: int | None = None,
    seed: int = 1,
    known: Shares | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> TuneStudy:
    """Find settings of the drive that reach a rate, as ``feeder tune``.

    Parameters
    ----------
    part : Part
        From a mesh.
    bowl : Bowl
    aspect : str
        The one wanted.
    target : str or float [1/s]
        '60/min' of it.
    heading, gap, fill, rule, launch, probabilities, fed, seed, known, overrides, **settings
        As for ``rate``.
    worst : bool
        Meet the target at the worst of every start, of friction a fifth lower and higher and, where parts
        hop, of restitution over its spread.

    Returns
    -------
    TuneStudy
    """
    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl, overrides, settings)

    def arriving(driven: Bowl, parts: int | None = fed) -> Shares:
        return asked.probabilities(
            solid, driven,
            rule=rule, launch=launch, probabilities=probabilities, fed=parts, seed=seed, known=known,
        )  # fmt: skip

    is_fed = rule == RECOMMENDED_RULE and launch is None and probabilities is None and known is None
    return tuning.tune(
        solid,
        bowl,
        aspect,
        asked.amount("target", target, "rate", LEAST),
        heading=asked.angle("heading", heading),
        rule=rule,
        gap=asked.amount("gap", gap, "length", 0.0),
        fill=fill,
        worst=worst,
        arriving=arriving,
        rough=(lambda driven: arriving(driven, tuning.FEW)) if is_fed and fed is None else None,
    )


@with_settings
def size_bowl(
    part: Part,
    target: Quantity,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    rule: str = RECOMMENDED_RULE,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    path: Path | None = None,
    overrides: Overrides = (),
    **settings: Unpack[BowlSettings],
) -> MachineSheet:
    """Size the bowl for a part and a rate, with its springs, tuning and drift, as ``feeder bowl``.

    Parameters
    ----------
    part : Part
        From a mesh.
    target : str or float [1/s]
        '60/min' of parts that count.
    aspect : str, optional
        That counts; whatever passes the devices without it.
    heading, rule, gap, fill
        As for ``rate``.
    path, overrides, **settings
        As for ``read_bowl``: what they give is kept, the rest is sized.

    Returns
    -------
    MachineSheet
        At the stroke that was tried, where the file has a trial that is still of this part and bowl.
    """
    own: dict[str, Any] = {"rule": rule, "gap": asked.amount("gap", gap, "length", 0.0), "fill": fill}
    wanted = asked.amount("target", target, "rate", LEAST)
    angle = asked.angle("heading", heading)
    solid = asked.a_part(part, mesh=True)
    file = None if path is None else asked.a_file("path", path)
    effective = bowls.settings(file, override_texts(overrides, settings))
    name = aspect if aspect is None or angle is None else f"{aspect}@{round(math.degrees(angle)) % 360}"
    own["as_tried"] = proof.holds(bowls.verified(file), solid, bowls.record(effective), name)
    return machines.bowl(effective, solid, wanted, aspect=aspect, heading=angle, **own)
