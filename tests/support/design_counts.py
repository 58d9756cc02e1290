"""Designs of which nothing was simulated: queues, draws and short trials made of counts."""

from dataclasses import replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.designing import short_trials
from feederscrew.designing.findings import Cause, End, Fault, FaultKind, Move, MoveKind
from feederscrew.designing.record import Attempt, DesignRequest, DesignStudy, RobustRun
from feederscrew.trials.course import Fate
from feederscrew.trials.fills import FilledQueue, LeavingPose, PoseKind

TURNED_ON_TRACK = End(Fate.TURNED)
ARRIVALS = (("A", 0.6), ("B", 0.3), ("C", 0.08), ("D", 0.02))


def end_at(fate, kind, station=1):
    """An end at a device of a kind, the first of its chain."""
    return End(fate, station, kind)


def stopped_at(kind, station=1):
    """The end of a part that stands at a device of a kind."""
    return end_at(Fate.STOPPED, kind, station)


def lost(name, *ends, row=0):
    """A wanted orientation of which parts ended so."""
    return Fault(FaultKind.LOST, name, row, ends)


def carried(name, row=1):
    """Another orientation that leaves."""
    return Fault(FaultKind.CARRIED, name, row)


def stays(name, *ends, row=1):
    """Another orientation of which parts stay so."""
    return Fault(FaultKind.STAYS, name, row, ends)


def heading_off(aspect):
    """The pose of parts that left on an aspect at no known heading."""
    return LeavingPose(PoseKind.HEADING_OFF, aspect)


def orientation(name):
    """The pose of parts that left in another orientation, 'B@0'."""
    return LeavingPose(PoseKind.ORIENTATION, name.partition("@")[0], name)


def queue(right=200, left=None, returned=0, jams=0, fill="normal", gaps=0.2, **more):
    """One fill, followed for 200 s, in which as many parts left as were delivered."""
    left = right if left is None else left
    made = FilledQueue(fill, gaps, 12, 200.0, 200.0, float(left), right, left, returned, jams, 0)
    return replace(made, **more)


def design_study(part, *queues, target=40.0, held=20, bowl=None, **more):
    """A design for so many a minute that holds where its queues and 20 draws do."""
    worst = None if held == 20 else lost("A@0", TURNED_ON_TRACK).counted_in_draws(20 - held, 20)
    own = {"queues": queues or (queue(),), "robust": RobustRun(20, held, worst)} | more
    return DesignStudy(
        part, DesignRequest(target / 60.0), bowl or bowls.default(), "A@0", 0, **{"wanted_aspect": "A"} | own
    )


def proved(part, bowl, **more):
    """A design that holds for 30 a minute: 200 parts of a queue left right, and none came back."""
    right = queue(200, returned=0, seconds=200.0, counted=200.0)
    return design_study(part, right, target=30.0, bowl=bowl, **more)


def short_trial(ways, right, wrong=(), held=(), *, each=2, row=0, **more):
    """A short trial of all orientations, some of each; rows of those that left right, wrong and stayed."""
    count = len(ways.lying)
    own = [np.array([each * (k in some) for k in range(count)]) for some in (right, wrong, held)]
    known = {
        "ends": tuple({stopped_at("gap"): each} if k in held else {} for k in range(count)),
        "velocity": 0.05, "states": (row,),
    }  # fmt: skip
    shares, parts = np.full(count, 1.0 / count), np.full(count, each)
    return short_trials.ShortTrial(ways, shares, np.arange(count), parts, *own, **known | more)


def attempt(wanted="A@270", rate=0.0, faults=None, **more):
    """A short trial of which nothing left, unless its faults are given."""
    nothing_left = Fault(FaultKind.NOTHING_LEAVES), lost(wanted, end_at(Fate.RETURNED, "gap"))
    ended = nothing_left if faults is None else faults
    made = Attempt(
        wanted, wanted.partition("@")[0], ("gap: 9 mm",), Move(MoveKind.PROPOSED), 0.0, 0.1, 8,
        0.0 if ended else 0.4, 1.0, 0.0, rate / 60.0, ended, Cause.DEVICE,
    )  # fmt: skip
    return replace(made, **more)


def design_of_nothing(part, *attempts, request=None, **more):
    """A design of which no chain got through its trial."""
    asked = request or DesignRequest(1.0)
    made = attempts or (attempt(),) * 4 + (attempt("A@54"), attempt("B@184"))
    return DesignStudy(part, asked, None, None, None, attempts=made, **{"arrivals": ARRIVALS} | more)
