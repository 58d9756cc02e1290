"""How many well-oriented parts leave a bowl, and what drive or what bowl reaches a rate."""

from collections.abc import Sequence
from typing import Any, Unpack, cast

from feederscrew.api import asked
from feederscrew.api.asked import AlongTrack, BowlFile, ProbabilitySource, Quantity
from feederscrew.bowl import Bowl
from feederscrew.part import Part
from feederscrew.rates.well_oriented import RECOMMENDED
from feederscrew.studies.bowl import MachineSheet
from feederscrew.studies.rate import LEAST, RateStudy, Shares
from feederscrew.studies.tune import TuneStudy
from feederscrew.tooling.devices.base import Device

DEVICES = "give devices in a list, as a bowl's devices are"


def shares(part: Part, bowl: Bowl, **answer: Unpack[ProbabilitySource]) -> Shares:
    """Return the aspects of a part with the answer that ``rate``, ``tune`` and others take.

    Parameters
    ----------
    part : Part
    bowl : Bowl
    **answer
        rule, launch, probabilities, fed, seed: whose probabilities are taken, see ``rate``.

    Returns
    -------
    Shares
        To be handed on as ``known``: what takes long is computed once.
    """
    return asked.answered(asked.a_part(part), asked.a_bowl(bowl), answer)


def rate(
    part: Part,
    bowl: Bowl,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    devices: Sequence[Device] | None = None,
    gap: Quantity = 0.0,
    fill: float = 1.0,
    **answer: Unpack[ProbabilitySource],
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
    **answer
        rule : whose probabilities are taken, 'recommended' without it.
        launch : what is done to the part on a floor at rest: 'place', 'drop', 'flip', 'roll' or 'feed';
            without it parts are fed onto the moving floor of the bowl.
        probabilities : file of counts whose shares are taken.
        fed, seed : how many are fed, and their seed; without ``fed`` until every share is known to 2 %.
        known : what ``shares`` returned, in place of all of them.

    Returns
    -------
    RateStudy
        Its ``parts`` are parts per second with an interval.
    """
    from feederscrew.studies.rate import rate as study

    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl)
    return study(
        solid,
        bowl,
        aspect,
        heading=asked.angle("heading", heading),
        rule=asked.rule(answer),
        devices=None if devices is None else asked.several("devices", devices, Device, DEVICES),
        gap=asked.amount("gap", gap, "length", 0.0),
        fill=fill,
        known=asked.answered(solid, bowl, answer),
    )


def tune(
    part: Part,
    bowl: Bowl,
    aspect: str,
    target: Quantity,
    *,
    heading: Quantity | None = None,
    worst: bool = False,
    **answer: Unpack[AlongTrack],
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
    heading
        As for ``rate``.
    worst : bool
        Meet the target at the worst of every start, of friction a fifth lower and higher and, where parts
        hop, of restitution over its spread.
    **answer
        gap, fill, rule, launch, probabilities, fed, known: as for ``rate``.

    Returns
    -------
    TuneStudy
    """
    from feederscrew.studies.tune import FEW
    from feederscrew.studies.tune import tune as study

    own = {"launch", "probabilities", "fed", "known"} & set(answer) or asked.rule(answer) != RECOMMENDED
    few = cast(AlongTrack, {**answer, "fed": FEW})
    solid, bowl = asked.a_part(part, mesh=True), asked.a_bowl(bowl)
    return study(
        solid,
        bowl,
        aspect,
        asked.amount("target", target, "rate", LEAST),
        heading=asked.angle("heading", heading),
        rule=asked.rule(answer),
        gap=asked.amount("gap", answer.get("gap", 0.0), "length", 0.0),
        fill=answer.get("fill", 1.0),
        worst=worst,
        arriving=lambda driven: asked.answered(solid, driven, answer),
        rough=None if own else lambda driven: asked.answered(solid, driven, few),
    )


def size_bowl(
    part: Part,
    target: Quantity,
    aspect: str | None = None,
    *,
    heading: Quantity | None = None,
    rule: str = "recommended",
    gap: Quantity = 0.0,
    fill: float = 1.0,
    **bowl: Unpack[BowlFile],
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
    **bowl
        path, overrides : as for ``read_bowl``: what they give is kept, the rest is sized.

    Returns
    -------
    MachineSheet
    """
    from feederscrew.studies.bowl import bowl as study

    own: dict[str, Any] = {"rule": rule, "gap": asked.amount("gap", gap, "length", 0.0), "fill": fill}
    wanted = asked.amount("target", target, "rate", LEAST)
    lies = asked.angle("heading", heading)
    solid = asked.a_part(part, mesh=True)
    return study(asked.settings(bowl), solid, wanted, aspect=aspect, heading=lies, **own)
