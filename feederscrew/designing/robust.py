"""Draws of what differs from part to part, day to day and shop to shop, and whether a chain still sorts."""

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import shapely

from feederscrew import check
from feederscrew.conveying.answer import RESTITUTION_DOUBT
from feederscrew.designing import short_trials
from feederscrew.designing.record import RobustRun
from feederscrew.dropping.pool import gather
from feederscrew.dropping.toss_runs import scattered
from feederscrew.errors import FeederError
from feederscrew.geometry import vectors
from feederscrew.part.hull import convex_hull
from feederscrew.rates import stream
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.orientation_names import place_of
from feederscrew.tooling.fates import at_entry

FRICTION, DRIVE, CUT = (0.6, 1.4), (0.9, 1.1), 1e-4  # [1], [1], [m] to either side
CARRIED, CLEAN = " is carried through", 0.985  # and the purity from which that is let be
EQUAL_MOMENTS = 1e-4  # of the greatest: principal moments that a part of revolution has in common
RETRIED_PARTS = 3  # of each wanted orientation, where one came back: a bowl brings more of them
LEAST_SHARE_LEAVING = 0.5  # [1] of what is wanted that has to leave in a draw, where some of it comes back
OTHERS_DRAWN = 3  # parts tried in each draw beside the wanted one, as they come


def drawn_bowl(bowl, lying, rng):
    """Return a bowl with other friction, restitution, drive and cuts.

    Parameters
    ----------
    bowl : Bowl
    lying : sequence of Orientation
        Of the part as drawn, which a profile may name: its opening is that of the nominal part.
    rng : numpy Generator

    Returns
    -------
    Bowl
    """
    rubbed, driven = rng.uniform(*FRICTION), rng.uniform(*DRIVE)
    friction = bowl.friction
    values = {name: getattr(friction, name) for name in vars(friction)}
    friction = replace(friction, **{k: None if v is None else v * rubbed for k, v in values.items()})
    drive = replace(bowl.drive, amplitude=bowl.drive.amplitude * driven)
    devices = tuple(_drawn_device(device, lying, rng) for device in bowl.devices)
    (own,) = rng.spawn(1)
    bounce = scattered((bowl.restitution, bowl.restitution), RESTITUTION_DOUBT, own.standard_normal(1))
    return replace(
        bowl, friction=friction, drive=drive, devices=devices, restitution=min(float(bounce[0]), 1.0)
    )


def _drawn_device(device, lying, rng):
    """A device whose every length is off by up to CUT."""
    more: dict[str, Any] = {}
    if device.like and not device.senses:  # an opening
        device = replace(device, corners=opening(device, lying), like=())
    elif device.like:  # a sensor: by how much a part may differ that it takes for the wanted one
        aspect, heading, play = device.like
        more["like"] = aspect, heading, max(play + rng.uniform(-CUT, CUT), 0.5 * play)
    if math.isfinite(device.limit):
        more["limit"] = max(device.limit + rng.uniform(-CUT, CUT), CUT)
    if device.span:
        ends = sorted(end + rng.uniform(-CUT, CUT) if end > 0.0 else end for end in device.span)
        more["span"] = (max(ends[0], 0.0), ends[1])
    if device.corners:
        grown = shapely.Polygon(device.corners).buffer(rng.uniform(-CUT, CUT), join_style="mitre")
        more["corners"] = tuple(map(tuple, shapely.get_coordinates(grown.exterior)[:-1].tolist()))
    return replace(device, **more)


def _named(devices, lying, drawn) -> tuple[Any, ...]:
    """Devices with the orientation that they name as the drawn part has it: its aspects may change places."""
    devices_named = []
    for device in devices:
        if device.like:
            orientations = [
                _named_orientation(device, named, lying) for named in (device.like[:2], *device.also)
            ]
            matches = [drawn[matched(orientation, drawn)] for orientation in orientations]
            first, *further = ((match.aspect, match.heading) for match in matches)
            device = replace(device, like=(*first, *device.like[2:]), also=tuple(further))
        devices_named.append(device)
    return tuple(devices_named)


def _named_orientation(device, named, lying):
    """The orientation of an aspect and heading [rad] that a device names."""
    aspect, heading = named
    return lying[place_of(lying, aspect, heading, device.where, f"{device.kind} names")]


def opening(device, lying) -> tuple[Any, ...]:
    """Return the corners (K, 2) [m] of a gate that is given by an orientation and its play."""
    grown = _named_orientation(device, device.like[:2], lying).view_ahead.buffer(device.like[2])
    return tuple(map(tuple, shapely.get_coordinates(grown.exterior)[:-1].tolist()))


def drawn_part(part, tolerance, rng):
    """Return a part whose size along each principal axis is off by up to a tolerance.

    Parameters
    ----------
    part : Part
        From a mesh.
    tolerance : float [m]
    rng : numpy Generator

    Returns
    -------
    Part
        Axes about which it is round stay so.
    """
    moments, axes = vectors.eigen(part.inertia)
    axes = axes.T
    size = [float(np.ptp(_along(part.vertices, axis))) for axis in axes]
    scales = 1.0 + rng.uniform(-tolerance, tolerance, 3) / size
    for a, b in ((0, 1), (1, 2)):
        if abs(moments[b] - moments[a]) < EQUAL_MOMENTS * moments.max():
            scales[b] = scales[a]
    return _scaled(part, axes, scales)


def _along(points, axis):
    return points[:, 0] * axis[0] + points[:, 1] * axis[1] + points[:, 2] * axis[2]


def _scaled(part, axes, scales):
    """The part stretched along three axes about its centre of mass."""
    stretch = sum(s * np.outer(axis, axis) for s, axis in zip(scales, axes))
    moved = part.vertices - part.centre_of_mass
    vertices = part.centre_of_mass + np.stack([_along(moved, row) for row in stretch], axis=1)
    grown = float(np.prod(scales))
    moments = [float(vectors.dot(_along(part.inertia, axis), axis)) for axis in axes]
    second = [0.5 * sum(moments) - moment for moment in moments]  # integral of the square along each axis
    second = [s * s * moment * grown for s, moment in zip(scales, second)]
    inertia = sum((sum(second) - own) * np.outer(axis, axis) for own, axis in zip(second, axes))
    return replace(
        part,
        vertices=check.frozen(vertices),
        hull=convex_hull(vertices, part.centre_of_mass, part.source),
        inertia=check.frozen(inertia),
        mass=part.mass * grown,
        volume=part.volume * grown,
        names=None,
    )


def matched(orientation, lying):
    """Return the place of the orientation of a part that is nearest to one of a part a little different."""
    size = max(orientation.length, orientation.height)

    def away(other):
        values = (
            (getattr(orientation, name), getattr(other, name))
            for name in ("length", "width", "height", "distance")
        )
        turned = sum(
            vectors.dot(a, b) for a, b in zip(orientation.axes, other.axes)
        )  # 3 where nothing is turned
        return sum(abs(a - b) for a, b in values) / size + 0.02 * (3.0 - float(turned))

    return min(range(len(lying)), key=lambda k: away(lying[k]))


def robust_run(
    part, bowl, orientations, shares, wanted, *, draws, tolerance, run, any_heading=(), spared=(),
    enough=LEAST_SHARE_LEAVING, allowed=None,
) -> RobustRun:  # fmt: skip
    """Try draws of part, friction, drive and cuts.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    orientations : Orientations
        Of the nominal part in that bowl; M of them.
    shares : (M,) float [1]
    wanted : int or sequence of int
        The wanted orientation, and others that count as it.
    draws : int
    tolerance : float [m]
        Of the part.
    run : RunSettings
        Its progress is told how many draws are done, of how many.
    any_heading : sequence of str
        Aspects that count as the wanted one, whatever the heading.
    spared : sequence of int
        Orientations that count as the wanted one and may be returned.
    enough : float [1]
        Share of what is wanted that has to leave, where a part of it comes back: LEAST_SHARE_LEAVING or more.
    allowed : int, optional
        Draws that may fail: with one more the run ends, for the rest decides nothing. All draws without it.

    Returns
    -------
    RobustRun
        A draw holds where what is wanted leaves as wanted, and nothing of the others leaves or stays. Each
        draw tries the wanted orientation and some others, drawn by their shares. Where a wanted part comes
        back, RETRIED_PARTS more of each wanted orientation are tried: it is offered again, and costs rate.
    """

    def draw_one(draw) -> tuple[Any, ...]:
        return _draw(
            part, bowl, orientations, shares, np.atleast_1d(wanted), tolerance, (run.seed, draw),
            any_heading, spared, enough,
        )  # fmt: skip

    def work(begin) -> None:
        tasks: list[Any] = []
        failures = 0
        for done in range(draws):
            while len(tasks) < min(done + run.jobs, draws):
                tasks.append(begin(draw_one, len(tasks)))
            failures += bool(tasks[done].result()[0])
            run.tell(done + 1, draws)
            if failures > most:
                return

    most = draws if allowed is None else allowed
    try:
        outcomes, stopped = gather(work, run.jobs)  # after an interrupt what was done is counted, and marked
    except KeyboardInterrupt:
        outcomes, stopped = [], True
    failed = np.cumsum([bool(wrongs) for wrongs, _ in outcomes])
    outcomes = outcomes[: int((failed <= most).sum()) + 1]  # alike for any number of jobs
    held, done = sum(not wrongs for wrongs, _ in outcomes), len(outcomes)
    wrong = Counter(fault for wrongs, _ in outcomes for fault in set(wrongs))
    speeds = [speed for _, speed in outcomes]
    worst = "" if not wrong else f"{wrong.most_common(1)[0][0]} in {wrong.most_common(1)[0][1]} of {done}"
    return RobustRun(done, held, worst, float(min(speeds, default=0.0)), partial=stopped)


def _draw(
    part, bowl, orientations, shares, wanted, tolerance, seed, any_heading, spared, enough
) -> tuple[Any, ...]:
    """What goes wrong in one draw, and the velocity there."""
    rng = np.random.default_rng(seed)
    other = drawn_part(part, tolerance, rng)
    driven = drawn_bowl(bowl, orientations.lying, rng)
    chosen = drawn_rows(orientations, shares, wanted, rng, spared)
    try:
        aspects = find(other)
        bare = stream.follow_orientations(other, aspects, bowl.track, (), bowl=driven)
        driven = replace(driven, devices=_named(driven.devices, orientations.lying, bare.lying))
        lying = at_entry(bare.lying, driven.devices)
        rows = [matched(orientations.lying[k], lying) for k in chosen]
        equivalent = [matched(orientations.lying[k], lying) for k in wanted] if len(wanted) > 1 else []
        free = {
            lying[matched(orientation, lying)].aspect
            for orientation in orientations.lying
            if orientation.aspect in any_heading
        }
        oriented = stream.along(bare.lying, aspects, driven.devices, bowl=driven, rows={*rows, *equivalent})
        even = np.full(len(oriented.lying), 1.0 / len(oriented.lying))
        own: dict[str, Any] = {"aspects": aspects, "any_heading": tuple(sorted(free))}
        wanted_rows = [rows[0], *equivalent]
        tried = short_trials.single(
            other, driven, oriented, even, wanted_rows, rows=list(dict.fromkeys(rows)), each=1,
            run=RunSettings(sum(seed)), **own,
        )  # fmt: skip
        counting = short_trials.wanted_rows(oriented, tried.states[:1])
        if any(came_back(tried, row) for row in tried.rows if row in counting):
            returned = wanted_of(orientations, shares, wanted, spared)
            places = [matched(orientations.lying[k], lying) for k in returned]
            more = short_trials.single(
                other, driven, oriented, even, wanted_rows, rows=list(dict.fromkeys(places)),
                each=RETRIED_PARTS, run=RunSettings(sum(seed) + 1), **own,
            )  # fmt: skip
            weights = {place: float(shares[k]) for k, place in zip(returned, places)}
            spared = (*spared, *returned) if comes_through(more, weights, enough) else spared
    except FeederError as fault:  # the drawn bowl does not convey, or the part does not fit
        return [fault.what], 0.0
    return faults(tried, {matched(orientations.lying[k], lying) for k in spared}), tried.velocity


def drawn_rows(orientations, shares, rows, rng, spared=()) -> list[Any]:
    """Return the orientations that one draw tries: a wanted one, then OTHERS_DRAWN parts as they come.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
    rows : sequence of int
        The wanted orientation, and others that count as it.
    rng : numpy Generator
    spared : sequence of int
        Wanted orientations that may be returned: none of them is drawn first while another is left.

    Returns
    -------
    list of int
        No orientation twice.
    """
    wanted = short_trials.wanted_rows(orientations, short_trials.wanted_states(orientations, rows)[:1]) or [
        rows[0]
    ]
    wanted = [k for k in wanted if k not in spared] or wanted
    likely = np.where([k in wanted for k in range(len(shares))], shares + 1e-12, 0.0)
    first = int(rng.choice(len(shares), p=likely / likely.sum()))
    more = rng.choice(len(shares), OTHERS_DRAWN, p=shares / shares.sum())
    return list(dict.fromkeys([first, *(int(k) for k in more)]))


def came_back(tried, row):
    """Return whether the part of a wanted orientation was returned: it comes along once more."""
    place = list(tried.rows).index(row)
    ends = tried.places[place]
    return not tried.right[place] and bool(ends) and all(end.startswith("returned") for end in ends)


def wanted_of(orientations, shares, rows, spared=()):
    """Return the rows that leave as wanted, but those that are spared and those that hardly come.

    Parameters
    ----------
    orientations : Orientations
        M of them.
    shares : (M,) float [1]
    rows, spared : sequence of int
    """
    own = short_trials.wanted_rows(orientations, short_trials.wanted_states(orientations, rows)[:1]) or [
        rows[0]
    ]
    some = [k for k in own if k not in spared and shares[k] >= short_trials.SELDOM_SHARE]
    return some or [rows[0]]


def comes_through(tried, weights, enough=LEAST_SHARE_LEAVING):
    """Return whether enough of more parts of what is wanted leave, and the others come back.

    Parameters
    ----------
    tried : Tried
    weights : dict of int to float [1]
        Shares in which their orientations come.
    enough : float [1]
        Share of them that has to leave.
    """
    own = np.array([weights[k] for k in tried.rows])
    leaving = float((own * tried.right / tried.parts).sum())
    return leaving >= enough * own.sum() * (1.0 - 1e-9) and not tried.wrong.any() and not tried.held.any()


def faults(tried, spared=()):
    """Return what goes wrong in a short trial, a sentence each: (what is lost, stopped or carried, where).

    What counts as the wanted one and comes back is a loss of parts a minute only; so is that of orientations
    that are ``spared``, rows.
    """
    sentences, right = [], set(short_trials.wanted_rows(tried.orientations, tried.states[:1])) - set(spared)
    for place, k in enumerate(tried.rows):
        name = tried.orientations.lying[k].name
        if k in right:
            if tried.right[place] < tried.parts[place]:
                turns = tried.turns[place] if tried.turns else {}
                where = ", ".join((*tried.places[place], *turns)) or "turned"
                sentences.append(f"{name} is lost ({where})")
        elif tried.wrong[place]:
            sentences.append(f"{name}{CARRIED}")
        if tried.held[place] and k not in right:
            sentences.append(f"{name} stays ({', '.join(tried.places[place])})")
    return sentences


def denied(tried) -> Iterator[Any]:
    """Say what a short trial denies: what leaves or stays though rejected, and what is lost in the main."""
    if not tried.efficiency > 0.0:
        yield "nothing leaves as wanted"
    right, spared = (
        set(short_trials.wanted_rows(tried.orientations, tried.states)),
        short_trials.spared_rows(tried),
    )
    for fault in faults(tried, spared):
        name = fault.split(" ", 1)[0]
        place = next(n for n, k in enumerate(tried.rows) if tried.orientations.lying[k].name == name)
        if fault.endswith(CARRIED) and tried.purity >= CLEAN:
            continue
        mostly = tried.rows[place] in right and 2 * tried.right[place] > tried.parts[place]
        if not (mostly and not tried.held[place]):
            yield fault
