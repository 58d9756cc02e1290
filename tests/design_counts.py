"""Designs of which nothing was simulated: queues, draws and short trials made of counts."""

from dataclasses import replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.designing import short_trials
from feederscrew.designing.record import DesignRequest, DesignStudy, FilledQueue, RobustRun


def queue(right=45, left=None, returned=5, jams=0, fill="normal", gaps=0.2, **more):
    """One fill, followed for a minute; what left is what was delivered a minute."""
    left = right if left is None else left
    return replace(
        FilledQueue(fill, gaps, 12, 60.0, 60.0, float(left), right, left, returned, jams, 0), **more
    )


def design_study(part, *queues, target=40.0, held=20, bowl=None, **more):
    """A design for so many a minute that holds where its queues and 20 draws do."""
    lost = "" if held == 20 else "A@0 is lost (turned on the track) in 5 of 20"
    own = {"queues": queues or (queue(),), "robust": RobustRun(20, held, lost)} | more
    return DesignStudy(part, DesignRequest(target / 60.0), bowl or bowls.default(), "A@0", 0, **own)


def proved(part, bowl, **more):
    """A design that holds for 30 a minute: 200 parts of a queue left right, and none came back."""
    right = queue(200, returned=0, seconds=200.0, counted=200.0)
    return design_study(part, right, target=30.0, bowl=bowl, **more)


def short_trial(ways, right, wrong=(), held=(), *, each=2, row=0, **more):
    """A short trial of all orientations, some of each; rows of those that left right, wrong and stayed."""
    count = len(ways.lying)
    own = [np.array([each * (k in some) for k in range(count)]) for some in (right, wrong, held)]
    known = {
        "places": tuple({"stopped at gap": each} if k in held else {} for k in range(count)),
        "velocity": 0.05, "states": (row,),
    }  # fmt: skip
    shares, parts = np.full(count, 1.0 / count), np.full(count, each)
    return short_trials.ShortTrial(ways, shares, np.arange(count), parts, *own, **known | more)
