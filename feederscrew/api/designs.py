"""From a part and a rate to a bowl that its own trial confirms."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from feederscrew.api import asked
from feederscrew.api.asked import Quantity
from feederscrew.bowl import Bowl
from feederscrew.designing.families import FamilyStudy
from feederscrew.designing.record import DesignStudy
from feederscrew.errors import ArgumentError
from feederscrew.part import Part
from feederscrew.studies.rate import LEAST
from feederscrew.units import listed

SEARCH = {
    "aspect": "aspect", "up": "any", "outcome": "any", "without": "any", "diameter": "any", "rule": "any",
    "budget": "count", "draws": "count", "seed": "seed", "jobs": "count",
}  # fmt: skip


def design(
    part: Part | Sequence[Part],
    target: Quantity,
    bowl: Bowl | None = None,
    *,
    given: frozenset[str] = frozenset(),
    known: asked.Shares | None = None,
    heading: Quantity | None = None,
    tolerance: Quantity = "0.1 mm",
    **search: Any,
) -> DesignStudy | FamilyStudy:
    """Design a bowl for a part and a rate and try it, as ``feeder design``.

    Parameters
    ----------
    part : Part or sequence of Part
        From meshes. Several share one bowl as far as they can.
    target : str or float [1/s]
        Parts that shall leave, '60/min'.
    bowl : Bowl, optional
        What is given of it; the defaults without it.
    given : set of str
        Names of the keys of that bowl that are kept, 'track.width'.
    known : Shares, optional
        Of ``shares``; what lies on the moving floor of the designed bowl without it.
    heading : str or float [rad], optional
    tolerance : str or float [m]
        Of the part's size, to either side.
    **search
        aspect, up, outcome, without, diameter, rule, budget, draws, seed, jobs: as for ``feeder design``;
        up and without are names, 'A,B' or a list.

    Returns
    -------
    DesignStudy
        Its ``status`` is one of four words, 'not proved' where the user stopped it; its ``bowl`` has the
        devices. Of several parts a FamilyStudy: its ``members``, whether all is ``shared``, and the worst
        ``status``.
    """
    from feederscrew import bowl as bowls
    from feederscrew.designing import beside
    from feederscrew.designing.families import family
    from feederscrew.designing.loop import design as study
    from feederscrew.designing.record import OUTCOMES, DesignRequest

    if "diameter" in search and search["diameter"] is not None:
        search["diameter"] = asked.pair("diameter", search["diameter"], "length")
    request = DesignRequest(
        target=asked.amount("target", target, "rate", LEAST),
        heading=asked.angle("heading", heading),
        tolerance=asked.amount("tolerance", tolerance, "length", 0.0),
        **asked.searched(search, SEARCH),
    )
    if request.outcome not in OUTCOMES:
        raise ArgumentError("outcome", f"is {request.outcome!r}", f"give {listed(list(OUTCOMES))}")
    plain = bowls.default() if bowl is None else asked.a_bowl(bowl)
    kept = beside.settings_of(plain, given)
    if isinstance(part, (list, tuple)) and part:
        found = family([asked.a_part(one, mesh=True) for one in part], plain, given, request)
        members = (beside.with_machine(one, beside.built(one, kept)) for one in found.members)
        return replace(found, members=tuple(members))
    known = asked.the_shares(known)
    designed = study(asked.a_part(part, mesh=True), plain, given, request, known=known)
    return beside.with_machine(designed, beside.built(designed, kept))
