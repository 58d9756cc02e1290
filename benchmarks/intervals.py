"""Calibration of the recommended answer's intervals, for ``accuracy.py``.

A share p of a closed form is off by its score times ``recommended.shape(p)``; the width that is printed is
the score that 95 % of the shares keep below. Left out means: one part at a time has no say in the width it
is judged by. The widths of ``recommended.SHARE_WIDTHS`` are those printed here, rounded to a hundredth, and
so is ``recommended.LAUNCH_WIDTH``, what was measured less what was simulated. Its shares are too few for a
quantile: of ten the largest is passed by one new share in eleven. They are taken as normal about zero, with
a standard deviation that all launches have in common and that is not known but for them (``reach``).
"""

import numpy as np
from scipy import optimize, stats

from feederscrew.arrivals.ensemble import NORMAL_95
from feederscrew.resting.deviation import total_variation
from feederscrew.resting.rules import recommended

HELD = 0.95
WEIGHTS = tuple(np.linspace(0.0, 1.0, 11))
SMALL = 1e-9
DEVIATIONS = np.linspace(1e-4, 0.5, 5000)  # [1] standard deviations that are tried


def quantile(scores):
    """The score that HELD of new ones keep below, from a sample: its rank is rounded up."""
    rank = min(int(np.ceil(HELD * (len(scores) + 1))), len(scores))
    return np.sort(scores)[rank - 1]


def reach(away, noise):
    """Return what HELD of new deviations keep within, from a sample of them.

    Parameters
    ----------
    away : (N,) float
        Deviations, relative to ``recommended.shape``.
    noise : (N,) float
        Variance of each that is sampling.

    Returns
    -------
    float
        For a normal distribution about zero whose standard deviation may be anything, each as likely before
        the sample is known: Student's distribution, were there no sampling.

    References
    ----------
    A. Gelman, "Prior distributions for variance parameters in hierarchical models", Bayesian Analysis 1(3),
    515-533, 2006.
    """
    variance = DEVIATIONS[:, None] ** 2 + noise
    likelihood = -0.5 * (away**2 / variance + np.log(variance)).sum(axis=1)
    weight = np.exp(likelihood - likelihood.max())
    weight /= weight.sum()
    return optimize.brentq(
        lambda width: (weight * (2.0 * stats.norm.cdf(width / DEVIATIONS) - 1.0)).sum() - HELD, SMALL, 10.0
    )


def entries(bodies, launch):
    """(name of the body, share of the closed form, of the drop test) of every class it can rest on."""
    for body in bodies:
        stable = body.aspects.stable
        if stable.sum() > 1:
            for p, truth in zip(body.closed(launch).p[stable], body.drop(launch)[stable]):
                yield body.name, p, truth


def closed_forms(bodies):
    print("\nClosed forms against drop tests of the same launch: half the interval of a share of a half, as")
    print("calibrated here and as it is; the share of those left out that it holds; mean width, and formerly")
    heads = ("fit", "is", "held", "left out", "of", "wide", "was", "held")
    print(f"{'':18}{'rule':>14}" + "".join(f"{head:>9}" for head in heads))
    for launch in recommended.LAUNCH_NAMES:
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
    fit, used = quantile(scores), recommended.SHARE_WIDTHS[launch, rolling]
    name = launch + (", rolling" if rolling else "")
    print(
        f"{name:18}{rule:>14}{fit:9.3f}{used:9.2f}{held:9.1%}{np.mean(np.concatenate(outside)):9.1%}"
        f"{len(p):9d}{wide:9.3f}{was:9.3f}{former:9.1%}"
    )


def _former(body):
    """The interval before: between soft and hard surface and the hops, 0.06 wider."""
    found = np.array([*body.surfaces().values(), body.aspects.probabilities["hops"]])
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


def weights_of_hops(bodies, series):
    """Print which weight of the hops drop tests of made bodies ask for, and what it does on measured sets.

    Out of sample: the weight is chosen on drop tests alone. In sample: the one in use, chosen with the
    measured sets of that launch in view as well.
    """
    print(
        "\nTempered hops: weight of the hops nearest to drop tests of bodies without a rolling class, and in"
    )
    print("use; mean total variation there, and the error on the measured sets of that launch")
    flat = [body for body in bodies if not body.rolling]
    for launch in recommended.LAUNCH_NAMES:
        away = [_mean_apart(flat, weight, launch) for weight in WEIGHTS]
        chosen, used = WEIGHTS[int(np.argmin(away))], recommended.HOP_SHARES[launch]
        for label, weight in (("chosen", chosen), ("in use", used)):
            told = f"  {launch:8}{label:>8}{weight:5.1f}{_mean_apart(flat, weight, launch):7.3f}"
            print(told + "".join(_missed(sets, weight, launch) for sets in series.values()))


def _mean_apart(bodies, weight, launch):
    return np.mean([_apart(body, weight, body.drop(launch)) for body in bodies])


def _missed(sets, weight, launch):
    """The error of one series in words; nothing where another launch was used."""
    own = [one for one in sets if one.launch == launch and not one.body.rolling]
    error = [_apart(one.body, weight, one.shares) ** 2 for one in own]
    return f"   {own[0].series} {np.sqrt(np.mean(error)):.4f}" if own else ""


def _apart(body, weight, truth):
    return total_variation(recommended.temper_shares(body.aspects.probabilities, weight)[1], truth)


def measured(series):
    """Print what a launch's name leaves open, from the measured series, leaving one out at a time.

    Parameters
    ----------
    series : dict of str to list of Measured
    """
    print("\nDrop tests against what was measured under a launch of that name: half the interval of a share")
    print("of a half beside sampling, from the other series, and the shares of the series it holds; then the")
    print("shares that the interval of the closed form and of the recommended answer hold, and their width")
    known = {name: np.concatenate([_beyond(one) for one in sets], axis=1) for name, sets in series.items()}
    inside, total = 0, sum(own.shape[1] for own in known.values())
    for name, own in known.items():
        width = reach(*np.concatenate([some for other, some in known.items() if other != name], axis=1))
        inside += _within(own, width)
        answers = "".join(_held(series[name], kind) for kind in ("closed", "answer"))
        print(f"  {name:20}{width:7.3f}   {_within(own, width)} of {own.shape[1]}   {answers}")
    every = np.concatenate(list(known.values()), axis=1)
    print(f"  {'all together':20}{reach(*every):7.3f}   left out {inside} of {total}: {inside / total:.1%}")
    width = recommended.LAUNCH_WIDTH
    print(f"  {'as it is':20}{width:7.3f}   {_within(every, width)} of {total}")


def _rows(body):
    """Classes that say something of their own: of two, the second says what the first does."""
    stable = np.flatnonzero(body.aspects.stable)
    return stable if len(stable) > 2 else stable[:1]


def _beyond(one):
    """(2, rows): how far simulated shares are off, relative to a share of a half, and its variance."""
    rows, p = _rows(one.body), one.body.drop(one.launch)
    tosses, drops = one.count, one.body.tally(one.launch).counts.sum()
    noise = np.nan_to_num(one.shares * (1.0 - one.shares) / tosses) + p * (1.0 - p) / drops
    shape = recommended.shape(p)
    return np.stack([(one.shares - p) / shape, noise / shape**2])[:, rows]


def _within(known, width):
    """How many deviations a width holds, with their own sampling beside it."""
    away, noise = known
    return int(np.sum(np.abs(away) <= np.hypot(width, NORMAL_95 * np.sqrt(noise))))


def _held(sets, kind):
    """How many measured shares the intervals hold, and their mean width."""
    entries = [
        (found.low[k], one.shares[k], found.high[k])
        for one in sets
        for found in [getattr(one.body, kind)(one.launch)]
        for k in _rows(one.body)
    ]
    low, truth, high = np.array(entries).T
    held = np.sum((low <= truth) & (truth <= high))
    return f"{kind} {held} of {len(truth)}, {np.mean(high - low):.3f} wide   "
