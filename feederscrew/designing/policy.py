"""The numbers that steer the search of a design, and on which data each of them was chosen.

None of them is physics: another value finds another design, or the same one later. Whether a design holds is
decided by its draws and its queues (``designing.short_trials``, ``designing.queues``), not by these.
"""

from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Basis:
    """The data on which a value of the policy was chosen."""

    parts: tuple[str, ...]  # that decided it, by their names in docs/designs.csv; () where none did
    finding: str  # what was seen, or that it is a judgement


JUDGED = Basis((), "a judgement: no run decided the value; the designs of docs/designs.csv were made with it")
STEEL_FIRST = Basis(
    ("pan_m4x10",),
    "chains of steel ranked so: narrowed track, wiper and rails are clean in the first trial at 211/min, "
    "where a camera was proposed before; the other values of the ranking are a judgement beside it",
)
MENDED_BY_PROOF = Basis(
    ("rivet_body",),
    "with these narrowed track, wiper and rails held at 130/min; before them a camera held at 64/min",
)
FASTER_DRIVE = Basis(("shcs_m3x8_simple",), "18 of 20 draws sorted, and 19 at 1.3 times the speed")
RAILS_TRIED = Basis(
    (),
    "eyelet, cup_flange, tnut_m5 and pushbutton, which are none of docs/designs.csv: each comes to hang "
    "by another move of the slot, its lead-in or the blade",
)
JAMS = Basis(
    (),
    "tnut_m5 and eyelet, which are none of docs/designs.csv: clean in short trials and in draws, they jam in "
    "a full track",
)
IMPURE = Basis(
    ("lbracket_30x20x15",),
    "97.8 % pure past two cameras; a gap before them stops what left instead, a narrowed track drops it",
)
JETS = Basis(
    ("tnut_m5",),
    "parts on their side stand at the blade of every chain of steel that was tried; with a jet before the "
    "rails a full track brought 83/min in 20 s, 22 of 22 right, and no jam",
)
ASSIST = Basis(
    (),
    "eyelet, which is none of docs/designs.csv: behind its rails 6 of 10 on their side stand at a wiper of "
    "30 deg, and none of 10 with air along its face",
)
DENIED = Basis(
    ("tnut_m5", "cap_14x10", "lbracket_30x20x15"),
    "558 s and 384 s of processor time until the first two fell short, four fifths of it in the queues of "
    "nine and seven designs; what is tried before two cameras of the bracket comes after 600 s",
)
SIDES = Basis(
    (),
    "a cap of 16 x 9 mm with a pin of 2 x 5 mm off its middle, none of docs/designs.csv: 26 trials of seven "
    "orientations, all lost, before the pin was up once, as 8 % of the parts come",
)
LOWER_RATE = Basis(
    ("cap_14x10",),
    "at 400/min both clean chains run at throw number 3, and draws carry other orientations through",
)


def _chosen(value: Any, basis: Basis = JUDGED) -> Any:
    """A field of the policy with its value, and the data on which it was chosen."""
    return field(default=value, metadata={"basis": basis})


@dataclass(frozen=True)
class SearchPolicy:
    """Policy of the search: how it ranks chains, what it tries next, and when it gives up."""

    # short trials
    trial_parts: int = _chosen(2)  # parts of each orientation in one
    mends: int = _chosen(3)  # times that one proposal is mended
    lost_trials: int = _chosen(2)  # of a proposal in which nothing leaves as wanted: then it is given up
    livelier_trials: int = _chosen(2)  # livelier drives of a chain where parts stay at a blade
    calmer_trials: int = _chosen(2)  # calmer drives of a chain where the drive loses what is wanted
    rare_trials: int = _chosen(5)  # where no orientation comes often enough for the target at any calm drive
    rails_parts: int = _chosen(30, RAILS_TRIED)  # parts in a trial of rails, where orientations are few
    rails_parts_each: int = _chosen(4, RAILS_TRIED)  # of each orientation in it at most
    rails_trials: int = _chosen(10, RAILS_TRIED)  # of the rails of one head on one track
    rails_given_up: int = _chosen(4, RAILS_TRIED)  # of them in which nothing hangs: then they are given up
    tries_before_others: int = _chosen(4, SIDES)  # of one orientation, then each other is tried once
    air_trials: int = _chosen(3, JETS)  # chains with rails that get a jet for what stands at them
    assisted: int = _chosen(2, ASSIST)  # chains with a blade that get air along it for what stands there
    often_share: float = _chosen(0.05, SIDES)  # [1] of the parts, from which an orientation comes often
    screening_draws: int = _chosen(6)  # draws before a clean chain is proved
    rate_reserve: float = _chosen(1.6)  # [1] of the target, for which a bowl is driven: queues bring less

    # which chains are looked for
    rate_share: float = _chosen(0.5)  # [1] of the best clean rate: what promises less is not tried
    purity: float = _chosen(0.3, STEEL_FIRST)  # [1] by the static rule, below which a chain is not tried
    # [1] of the trials that are allowed, after which each cost class has had its turn
    budget_shares: tuple[float, ...] = _chosen((0.5, 0.7, 1.0), STEEL_FIRST)
    rolling_share: float = _chosen(0.3)  # [1] of the parts that lie on a round side: then the bank is steep
    hanging_bank: float = _chosen(float(np.radians(5.0)), STEEL_FIRST)  # [rad] steeper: askew beside a slot
    left_out: int = _chosen(2, STEEL_FIRST)  # times that a device is left out at which parts were lost
    velocity_step: float = _chosen(1.2, MENDED_BY_PROOF)  # [1] between velocities at which chains are sought
    slower: float = _chosen(1.2)  # [1] a chain that gains so much more is proposed again at its own drive
    # chains are alike whose values differ by less than the greater of a distance or an angle, and a share
    alike_length: float = _chosen(1e-4, STEEL_FIRST)  # [m]
    alike_angle: float = _chosen(float(np.radians(0.1)), STEEL_FIRST)  # [rad]
    alike_share: float = _chosen(0.03, STEEL_FIRST)  # [1]

    # how promising [1] an idea is beside another one, by what it takes
    bank_rank: float = _chosen(0.93, STEEL_FIRST)  # each further bank
    turning_rank: float = _chosen(0.6, STEEL_FIRST)  # a device that turns others into what is wanted
    hole_rank: float = _chosen(0.5, STEEL_FIRST)  # a hole of several corners
    device_rank: float = _chosen(0.98, STEEL_FIRST)  # each device
    left_out_rank: float = _chosen(0.8, STEEL_FIRST)  # each time that a device was left out
    lost_rank: float = _chosen(0.7, STEEL_FIRST)  # a device at which the same orientation was lost before
    no_margin_rank: float = _chosen(0.7, STEEL_FIRST)  # no margin at all, beside the greatest
    share_power: float = _chosen(0.25, STEEL_FIRST)  # of the share: what comes oftener is tried first

    # the proof, and what is changed by it
    queued_designs: int = _chosen(2)  # of a cost class that go through queues
    drawn_designs: int = _chosen(4)  # of a cost class that go through draws
    proof_changes: int = _chosen(3, MENDED_BY_PROOF)  # of one design, each by what its proof denied
    jam_mends: int = _chosen(3, JAMS)  # chains that are tried for a queue that jams, by what stood there
    purity_mends: int = _chosen(3, IMPURE)  # chains that are tried for a queue that is impure
    # [s] of queues that denied designs, after which no other design is proved: of each cost class, and near
    # them. A jam is seen at once; impure by few parts in a hundred, as past a sensor, only after minutes
    denied_in_class: tuple[float, ...] = _chosen((90.0, 120.0, 1200.0), DENIED)
    denied_near: float = _chosen(900.0, DENIED)
    lively_hop: float = _chosen(1.2e-4, MENDED_BY_PROOF)  # [m] from which jams ask for a device
    faster: float = _chosen(1.3, FASTER_DRIVE)  # [1] times the speed, where draws lose what creeps
    slow_reserve: float = _chosen(1.2)  # [1] times what the worst fill of a slow design lacks of the target
    slow_reserve_limit: float = _chosen(3.0)  # [1] by which the reserve grows at most at once

    # the nearest that holds
    near_proofs: int = _chosen(3)  # designs beside those of the search that go through draws and queues
    near_drives: int = _chosen(2)  # drives at which one chain is proved, that of the search among them
    flatter_drives: int = _chosen(2)  # flatter angles at which a chain without a machine is proved
    near_trials: int = _chosen(4)  # short trials beside those of the search
    other_way_trials: int = _chosen(6)  # of other ways up, where only some were asked for
    other_way_calmer_trials: int = _chosen(2)  # of them at a calmer drive
    lower_rate_share: float = _chosen(0.5, LOWER_RATE)  # [1] of the rate that short trials promise
    lower_rate_trials: int = _chosen(12, LOWER_RATE)  # short trials for it at most
    lower_rate_proofs: int = _chosen(2, LOWER_RATE)  # designs for it through draws and queues


USUAL_POLICY = SearchPolicy()


def basis_of(name: str) -> Basis:
    """Return on which data a value of the policy was chosen.

    Parameters
    ----------
    name : str
        Field of ``SearchPolicy``.

    Returns
    -------
    Basis

    Raises
    ------
    KeyError
        If the policy has no such field.
    """
    bases: dict[str, Basis] = {one.name: one.metadata["basis"] for one in fields(SearchPolicy)}
    return bases[name]
