"""Orientations that are wanted, or count as it, and the poses in which they are found."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from feederscrew.base.arrays import Floats, Ints
from feederscrew.bowl.verified import AMONG
from feederscrew.feeding import stream
from feederscrew.motion.headings import rests
from feederscrew.sorting.orientations import Hanging, Orientation


def wanted_states(orientations: stream.Orientations, rows: Sequence[int] | Ints) -> tuple[int, ...]:
    """Return the states in which some rows leave.

    Parameters
    ----------
    orientations : Orientations
    rows : sequence of int
        The wanted row first, then others that count as it; of these, what is returned adds no state.

    Returns
    -------
    tuple of int
        Rows of ``orientations.states``, each once, that of the wanted row first.
    """
    further = [k for k in rows[1:] if orientations.leaving[k].max() > 0.5]
    return tuple(dict.fromkeys(int(orientations.leaves_as[k]) for k in (rows[0], *further)))


def leaves_hanging(orientations: stream.Orientations, states: Sequence[int]) -> bool:
    """Tell whether the wanted parts leave hanging between rails: then trials say which rows do.

    Parameters
    ----------
    orientations : Orientations
    states : sequence of int
        The wanted state first.

    Returns
    -------
    bool
    """
    return isinstance(orientations.states[states[0]], Hanging)


def wanted_rows(orientations: stream.Orientations, states: Sequence[int]) -> list[int]:
    """Return the rows of which more than half leave in one of some states, as the static rule says.

    Parameters
    ----------
    orientations : Orientations
    states : sequence of int
        Rows of ``orientations.states``.

    Returns
    -------
    list of int
    """
    return [k for k in range(len(orientations.lying)) if orientations.leaving[k, list(states)].sum() > 0.5]


def aspects_at_any_heading(
    orientations: Sequence[Orientation], row: int, up: Sequence[str], *, heading_given: bool = False
) -> tuple[str, ...]:
    """Return the aspects on which a part counts as a wanted row however it is turned.

    They are those of ``up``, and the wanted row's own where it is round in plan and takes any heading, unless
    one heading was asked for.

    Parameters
    ----------
    orientations : sequence of Orientation
    row : int
        The wanted one.
    up : sequence of str
        Names of aspects, the option `--up`; their case does not matter.
    heading_given : bool, optional
        Whether one heading was asked for.

    Returns
    -------
    tuple of str
        As the orientations name them, each once.
    """
    names, wanted = {name.strip().casefold() for name in up}, orientations[row]
    aspects = [other.aspect for other in orientations if other.aspect.casefold() in names]
    if not heading_given and rests(wanted.posture.outline, wanted.track.radius).rounded:
        aspects.append(wanted.aspect)
    return tuple(dict.fromkeys(aspects))


def find_poses(
    orientations: stream.Orientations, states: Sequence[int], any_heading: Sequence[str] = ()
) -> tuple[Orientation, ...]:
    """Return the poses, one a state, in which parts may be found.

    Parameters
    ----------
    orientations : Orientations
    states : sequence of int
        Rows of ``orientations.states``, the wanted one first.
    any_heading : sequence of str, optional
        Names of aspects.

    Returns
    -------
    tuple of Orientation
        At any heading where the aspect is that of a further state, or named.
    """
    own = [orientations.states[k] for k in states[1:]]
    names = {pose.aspect for pose in own if not isinstance(pose, Hanging)} | set(any_heading)
    return tuple(replace(pose, any_heading=pose.aspect in names) for pose in orientations.states)


def equivalent_rows(orientations: Sequence[Orientation], row: int, up: Iterable[str]) -> tuple[int, ...]:
    """Return the rows beside a wanted one that count as it: those of aspects that may be up too.

    Parameters
    ----------
    orientations : sequence of Orientation
    row : int
        The wanted one.
    up : iterable of str
        Names of aspects; their case does not matter.

    Returns
    -------
    tuple of int
    """
    named = {name.strip().casefold() for name in up}
    return tuple(k for k, one in enumerate(orientations) if k != row and one.aspect.casefold() in named)


def states_of_name(
    orientations: stream.Orientations, shares: Floats, name: str, up: Sequence[str] = ()
) -> tuple[tuple[int, ...], tuple[str, ...]]:
    """Return the states that count as wanted by the name that a bowl file gives them.

    Parameters
    ----------
    orientations : stream.Orientations
        M of them.
    shares : (M,) array [1]
        In which they come.
    name : str
        'A@188', 'hanging', 'A@0 or B': the first one is the wanted orientation or aspect, others are aspects
        that count as it.
    up : sequence of str
        Further aspects that count as it, whatever their heading.

    Returns
    -------
    tuple of int
        The states in which parts leave as wanted, the first one first.
    tuple of str
        The aspects on which they do so at any heading.

    Raises
    ------
    ValueError
        If no orientation of that name can leave.
    """
    first, *more = (text.strip().casefold() for text in name.split(AMONG))
    up = tuple(dict.fromkeys([*(aspect.strip() for aspect in up if aspect.strip()), *more]))
    rows = [
        k
        for k, state in enumerate(orientations.leaves_as)
        if first in (orientations.states[state].name.casefold(), orientations.states[state].aspect.casefold())
    ]
    if not rows:  # what a trial alone has shown to hang
        hangs = [
            k
            for k, state in enumerate(orientations.states)
            if isinstance(state, Hanging) and first == state.name.casefold()
        ]
        if hangs:
            return (hangs[0],), ()
        raise ValueError(f"no orientation leaves as {name}")
    row = max(rows, key=lambda k: shares[k])
    states = wanted_states(orientations, (row, *equivalent_rows(orientations.lying, row, up)))
    return states, aspects_at_any_heading(orientations.lying, row, up)
