"""A part on the floor or the track for arrays of settings: maps as those of Figures 5-6 and 5-7.

Source: the thesis, chapter 5.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from feederscrew.base.arrays import Array, Bools, Floats, Reals
from feederscrew.base.errors import FeederError
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.record import Bowl, BowlGrid, Track
from feederscrew.motion import floor_balance, limits, track_balance
from feederscrew.motion.floor_balance import HOP, MOTION_STATES
from feederscrew.motion.headings import Headings, headings, on_track, stable_row, supported_reaches
from feederscrew.motion.track_balance import Seat, card_seat, seat
from feederscrew.resting.posture import Posture

FLOOR_REGIMES = MOTION_STATES  # a regime code is a place in this list


def floor_cells(posture: Posture, bowl: BowlGrid, heading: Reals) -> dict[str, Array]:
    """Return the upper reversal on the floor for arrays of bowl settings, cell by cell.

    Parameters
    ----------
    posture : Posture
    bowl : BowlGrid
        Fields may be arrays that broadcast.
    heading : float or (...) float [rad]
        theta.

    Returns
    -------
    dict of str to (...) array
        In SI, as each name says: 'acceleration_z_m_s2' V'_z and 'alignment_acceleration_rad_s2', NaN where
        the part has lost contact; 'throw_number', above 1 where it hops; 'regime', places in
        ``FLOOR_REGIMES``.

    References
    ----------
    ``floor_balance.motion``; maps as in Figures 5-6 and 5-7 of the thesis.
    """
    motion = floor_balance.motion(posture, bowl, heading)
    contact = motion.state != HOP
    ratio = limits.acceleration_ratio(bowl.drive.amplitude, bowl.drive.frequency, bowl.gravity)
    return {
        "acceleration_z_m_s2": np.where(contact, motion.acceleration[..., 0], np.nan),
        "alignment_acceleration_rad_s2": np.where(contact, motion.turning, np.nan),
        "throw_number": limits.throw_number(ratio, bowl.drive.vibration_angle),
        "regime": motion.state,
    }


TRACK_REGIMES = (*MOTION_STATES, "leaves the wall", "does not fit")  # a code is a place in this list
LEAVES_WALL = len(MOTION_STATES)
DOES_NOT_FIT = len(MOTION_STATES) + 1
MOTION_MAP_COLUMNS = (
    "acceleration_x_m_s2",
    "normal_force_N",
    "wall_1_N",
    "wall_2_N",
    "radial_friction_N",
    "traction_N",
    "normal_line_offset_m",
    "normal_line_offset_across_m",
)
# of a bowl, that act on a part
SECTIONS = ("drive", "friction", "track")  # sections
SINGLE = ("restitution", "gravity")  # keys
TRACK_DECIMALS = 12  # decimals that tell two radii, widths or banks apart


def seated(posture: Posture, bowl: Bowl, heading: float | None = None) -> tuple[Seat, Headings | None, int]:
    """Return how a part lies against the wall of a bowl.

    Parameters
    ----------
    posture : Posture
        A part card has its printed seat only, and no headings.
    bowl : Bowl
    heading : float [rad] or None
        As laid down; None takes the most frequent heading that stays on the track.

    Returns
    -------
    Seat
    Headings or None
        None of a part card.
    int
        Row of the headings that was taken.

    Raises
    ------
    FeederError
        If the bowl is smaller than the part, the part falls off, or a card lacks the data of its seat.

    References
    ----------
    docs/mechanics.md, "Headings".
    """
    if posture.corners is None:
        return card_seat(posture), None, 0
    stable = headings(posture, bowl.track)
    row = stable_row(stable, heading)
    return seat(posture, float(stable.headings[row]), stable.touching[row], bowl.track.bank), stable, row


def track_cells(posture: Posture, bowl: BowlGrid, heading: float | None = None) -> dict[str, Array]:
    """Return the upper reversal on the track at every cell of a map.

    Parameters
    ----------
    posture : Posture
    bowl : BowlGrid
        Fields may be arrays that broadcast.
    heading : float [rad] or None
        As in ``seated``.

    Returns
    -------
    dict of str to (...) array
        In SI, as each name says: ``MOTION_MAP_COLUMNS``; 'throw_number', above 1 where the part hops;
        'regime', places in ``TRACK_REGIMES``. NaN where the part does not fit; no acceleration where it hops.

    References
    ----------
    ``track_balance.motion``, cell by cell.
    """
    # Fields of the bowl that act on a part, by section. Cells that share a seat are solved together, so each
    # field is spread over the whole map first.
    sections = {section: vars(getattr(bowl, section)) for section in SECTIONS}
    single = {name: getattr(bowl, name) for name in SINGLE}
    settings = [value for fields in (*sections.values(), single) for value in fields.values()]
    shape = np.broadcast_shapes(*map(np.shape, settings))
    columns = {name: np.full(shape, np.nan) for name in MOTION_MAP_COLUMNS}
    columns["regime"] = np.full(shape, DOES_NOT_FIT)
    for place, here in _seats(posture, bowl, heading, shape):

        def cells(fields: Keywords, here: Bools = here) -> Keywords:
            return {name: np.broadcast_to(value, shape)[here] for name, value in fields.items()}

        picked = {s: replace(getattr(bowl, s), **cells(fields)) for s, fields in sections.items()}
        motion = track_balance.motion(place, replace(bowl, **cells(single), **picked))
        leaves = ~motion.closed.any(axis=-1) & (motion.state != HOP) & (motion.acceleration[..., 1] > 0.0)
        along = np.where(motion.slides, motion.acceleration[..., 0], 0.0)
        along = np.where(motion.state == HOP, np.nan, along)
        walls, offsets = np.moveaxis(motion.walls, -1, 0), np.moveaxis(motion.offset, -1, 0)
        values = (along, motion.normal_force, *walls, motion.radial_friction, motion.traction, *offsets)
        for name, value in zip(MOTION_MAP_COLUMNS, values):
            columns[name][here] = value
        columns["regime"][here] = np.where(leaves, LEAVES_WALL, motion.state)
    drive, track = bowl.drive, bowl.track
    ratio = limits.acceleration_ratio(drive.amplitude, drive.frequency, bowl.gravity)
    columns["throw_number"] = limits.throw_number(ratio, drive.vibration_angle, track.climb)
    return columns


def _seats(
    posture: Posture, bowl: BowlGrid, heading: float | None, shape: tuple[int, ...]
) -> Iterator[tuple[Seat, Bools]]:
    """Each seat that occurs and the cells, (...) bool, where it does."""
    if posture.corners is None:
        yield card_seat(posture), np.ones(shape, bool)
        return
    # A map has thousands of cells and few tracks: a seat is found once for each different track. Headings
    # depend on its radius alone, the support on radius and width, and the lean on the sign of the bank.
    names = ("climb", "bank", "radius", "width")
    values = np.stack([np.broadcast_to(getattr(bowl.track, name), shape).ravel() for name in names])
    kinds, place = np.unique(np.round(values, TRACK_DECIMALS), axis=1, return_inverse=True)
    groups: dict[
        tuple[float, int, float], tuple[Seat, list[int]]
    ] = {}  # by radius, row, lean: and its tracks
    free_by_radius: dict[float, Headings] = {}
    reaches: dict[tuple[float, float], list[Floats]] = {}  # by radius and width
    for k, kind in enumerate(kinds.T):
        track = Track(*kind)
        try:
            if track.radius not in free_by_radius:
                free_by_radius[track.radius] = headings(posture, track)
            free = free_by_radius[track.radius]
            if (track.radius, track.width) not in reaches:
                reaches[track.radius, track.width] = supported_reaches(free, posture, track)
            stable = on_track(free, posture, track, reaches[track.radius, track.width])
            row = stable_row(stable, heading)
        except FeederError:  # the part does not fit
            continue
        lean = float(np.sign(track.bank))
        if (track.radius, row, lean) not in groups:
            turn = float(stable.headings[row])
            groups[track.radius, row, lean] = seat(posture, turn, stable.touching[row], lean), []
        groups[track.radius, row, lean][1].append(k)
    for seat_there, members in groups.values():
        yield seat_there, np.isin(place.reshape(shape), members)
