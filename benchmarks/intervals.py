"""Calibration of the recommended answer's intervals, for ``accuracy.py``.

A share p of a closed form is off by its score times ``recommended.shape(p)``; the width that is printed is
the score that 95 % of the shares keep below. Left out means: one part at a time has no say in the width it
is judged by. The widths of ``recommended.WIDTHS`` are those printed here, rounded to a hundredth.
"""

from itertools import groupby

import numpy as np

from feederscrew.resting.rules import recommended

HELD = 0.95
SMALL = 1e-9


def quantile(scores):
    """The score that HELD of new ones keep below, from a sample: its rank is rounded up."""
    rank = min(int(np.ceil(HELD * (len(scores) + 1))), len(scores))
    return np.sort(scores)[rank - 1]


def entries(bodies, launch):
    """(name of the body, share of the closed form, of the drop test) of every class it can rest on."""
    for body in bodies:
        stable = body.aspects.stable
        if stable.sum() > 1:
            for p, truth in zip(body.closed(launch).p[stable], body.drop(launch)[stable]):
                yield body.name, p, truth


def closed_forms(bodies):
    """Print the width of the closed form for each launch, with and without a rolling class."""
    print("\nClosed forms against drop tests of the same launch: half the interval of a share of a half, as")
    print("calibrated here and as it is; the share of those left out that it holds; mean width, and formerly")
    heads = ("fit", "is", "held", "left out", "of", "wide", "was", "held")
    print(f"{'':18}{'rule':>14}" + "".join(f"{head:>9}" for head in heads))
    for launch in recommended.LAUNCHES:
        for rolling in (False, True):
            chosen = [body for body in bodies if body.rolling == rolling]
            if chosen:
                _one(launch, rolling, chosen)


def _one(launch, rolling, bodies):
    found = list(entries(bodies, launch))
    parts, p, truth = (np.array(column) for column in zip(*found))
    scores = np.abs(truth - p) / recommended.shape(p)
    outside = [scores[parts == name] <= quantile(scores[parts != name]) for name in np.unique(parts)]
    ends = [(one.low, one.high) for one in (body.closed(launch) for body in bodies)]
    held, wide = _coverage(bodies, launch, ends)
    former, was = _coverage(bodies, launch, [_former(body) for body in bodies])
    rule = bodies[0].closed(launch).rule.partition(",")[0]
    fit, used = quantile(scores), recommended.WIDTHS[launch, rolling]
    name = launch + (", rolling" if rolling else "")
    print(
        f"{name:18}{rule:>14}{fit:9.3f}{used:9.2f}{held:9.1%}{np.mean(np.concatenate(outside)):9.1%}"
        f"{len(p):9d}{wide:9.3f}{was:9.3f}{former:9.1%}"
    )


def _former(body):
    """The interval before: between soft, medium and hard surface and the hops, 0.06 wider."""
    rules = body.rules()
    found = np.array([rules["surface, 0"], rules["surface, 1"], rules["surface, 2"], rules["hops"]])
    return np.clip(found.min(axis=0) - 0.06, 0.0, 1.0), np.clip(found.max(axis=0) + 0.06, 0.0, 1.0)


def _coverage(bodies, launch, ends):
    """Share of the drop tests' shares inside, and the mean width."""
    inside, widths = [], []
    for body, (low, high) in zip(bodies, ends):
        stable = body.aspects.stable & (body.aspects.stable.sum() > 1)
        truth = body.drop(launch)
        inside += ((low - SMALL <= truth) & (truth <= high + SMALL))[stable].tolist()
        widths += (high - low)[stable].tolist()
    return np.mean(inside), np.mean(widths)


def drop_tests(measured):
    """Print what a launch's name leaves open, on the measured sets, leaving one set out at a time.

    Parameters
    ----------
    measured : list of (str, float, float, float, float)
        Set, measured share, half its sampling interval; simulated share, half its sampling interval.
    """
    print("\nDrop tests against what was measured under a launch of that name: half the interval of a share")
    print("of a half beside sampling, from the other sets, and the shares of the set it holds")
    sets = {name: list(group) for name, group in groupby(measured, key=lambda entry: entry[0])}
    inside = []
    for name, own in sets.items():
        others = [_beyond(*entry[1:]) for other, group in sets.items() if other != name for entry in group]
        width = quantile(np.array(others))
        held = [_beyond(*entry[1:]) <= width for entry in own]
        inside += held
        print(f"  {name:24}{width:7.3f}   {sum(held)} of {len(held)}")
    every = np.array([_beyond(*entry[1:]) for entry in measured])
    held = np.mean(every <= recommended.LAUNCHED)
    print(f"  {'all together':24}{quantile(every):7.3f}   left out {np.mean(inside):.1%} of {len(inside)}")
    print(f"  {'as it is':24}{recommended.LAUNCHED:7.3f}   {held:.1%}")


def _beyond(truth, tossed, p, dropped):
    """How far a simulated share is off beyond the sampling of both, relative to a share of a half."""
    excess = (truth - p) ** 2 - tossed**2 - dropped**2
    return np.sqrt(max(excess, 0.0)) / recommended.shape(np.array(p))
