"""One-sided bounds of shares and rates, and the samples that show a demand.

All bounds are exact (Clopper and Pearson for a share, Garwood for a rate) at ``CONFIDENCE``: a share or a
rate beyond its bound gives such counts, or more extreme ones, with a chance of 1 - ``CONFIDENCE`` at most.
"""

import math

from feederscrew.base.heavy import heavy

special = heavy("scipy.special")

CONFIDENCE = 0.95  # [1] of every one-sided bound
MAX_SAMPLE = 10**9  # parts: no sample that is asked for is larger


def share_at_least(right: int, total: int, confidence: float = CONFIDENCE) -> float:
    """Return the lower bound of a share.

    Parameters
    ----------
    right : int
        Parts that count.
    total : int
        Parts that were looked at.
    confidence : float [1]
        One-sided.

    Returns
    -------
    float [1]
        The share at which ``right`` or more of ``total`` have a chance of 1 - confidence; 0 of no part.

    References
    ----------
    C. J. Clopper, E. S. Pearson, "The use of confidence or fiducial limits illustrated in the case of the
    binomial", Biometrika 26, 404-413, 1934.
    """
    if right <= 0:
        return 0.0
    return float(special.betaincinv(right, total - right + 1, 1.0 - confidence))


def share_at_most(right: int, total: int, confidence: float = CONFIDENCE) -> float:
    """Return the upper bound of a share, as ``share_at_least`` returns the lower one.

    Parameters
    ----------
    right, total : int
        Parts of the kind, and all of them.
    confidence : float [1], optional
        One-sided.

    Returns
    -------
    float [1]
        1 of no part.
    """
    return 1.0 - share_at_least(total - right, total, confidence)


def rate_at_most(count: int, time: float, confidence: float = CONFIDENCE) -> float:
    """Return the upper bound of a rate of events that come by chance.

    Parameters
    ----------
    count : int
        Events that were seen.
    time : float [s]
        For which they were looked for.
    confidence : float [1]
        One-sided.

    Returns
    -------
    float [1/s]
        The rate at which ``count`` or fewer have a chance of 1 - confidence: 3.0 / time of no event ("rule
        of three"); infinite where nobody looked.

    References
    ----------
    F. Garwood, "Fiducial limits for the Poisson distribution", Biometrika 28, 437-442, 1936.
    """
    return _mean_at_most(count, confidence) / time if time > 0.0 else math.inf


def rate_at_least(count: int, time: float, confidence: float = CONFIDENCE) -> float:
    """Return the lower bound of a rate of events, as ``rate_at_most`` returns the upper one.

    It is the rate at which ``count`` or more have a chance of 1 - confidence: the Poisson mean m with
    P(count, m) = 1 - confidence, over the time, P the regularised lower incomplete gamma function.

    Parameters
    ----------
    count : int
        Events that came.
    time : float [s]
        In which they came.
    confidence : float [1], optional
        One-sided.

    Returns
    -------
    float [1/s]
        0 of no event.

    References
    ----------
    As ``rate_at_most``.
    """
    if count <= 0 or not time > 0.0:
        return 0.0
    return float(special.gammaincinv(count, 1.0 - confidence)) / time


def _mean_at_most(count: int, confidence: float) -> float:
    return float(special.gammaincinv(count + 1, confidence))  # half of chi-square


def log_likelihood_ratio(right: int, total: int, share: float, other: float) -> float:
    """Return by how much a share explains what was seen better than another share.

    Parameters
    ----------
    right : int
        Parts that count.
    total : int
        Parts that were looked at.
    share : float [1]
        Above 0 and below 1.
    other : float [1]
        Above 0 and below 1.

    Returns
    -------
    float [1]
        right ln(share / other) + (total - right) ln((1 - share) / (1 - other)). Where ``other`` is true it
        ever rises to ln(1 / risk) with a chance of ``risk`` at most, however often it is looked at (Ville).

    References
    ----------
    A. Wald, "Sequential tests of statistical hypotheses", Ann. Math. Statist. 16, 117-186, 1945, sec. 5.2;
    J. Ville, "Etude critique de la notion de collectif", 1939, for the inequality.
    """
    wrong = total - right
    return right * math.log(share / other) + wrong * math.log((1.0 - share) / (1.0 - other))


def parts_to_look_at(demand: float, wrong: int, confidence: float = CONFIDENCE) -> int:
    """Return the smallest sample that shows a share of good parts though some of it are wrong.

    Parameters
    ----------
    demand : float [1]
        Share of good parts, above 0 and below 1.
    wrong : int
        Parts of the sample that are wrong, at most.
    confidence : float [1]
        One-sided.

    Returns
    -------
    int
        The least n for which a feeder that only just misses the demand has ``wrong`` or fewer of n with a
        chance of 1 - confidence at most (binomial): of 98 %, 149 with 0 wrong, 236 with 1.

    Raises
    ------
    ValueError
        If no sample shows such a demand.
    """
    if not 0.0 < demand < 1.0:
        raise ValueError(f"a share of {demand:g} is shown by no sample")

    def is_enough(sample: int) -> bool:
        return bool(special.bdtr(wrong, sample, 1.0 - demand) <= 1.0 - confidence)

    few, many = wrong, wrong + 1  # the first is too small a sample, the second grows until it is enough
    while not is_enough(many):
        few, many = many, 2 * many
        if many > MAX_SAMPLE:
            raise ValueError(f"a share of {demand:g} needs a sample of more than {MAX_SAMPLE} parts")
    while many - few > 1:
        middle = (few + many) // 2
        few, many = (few, middle) if is_enough(middle) else (middle, many)
    return many


def time_to_run(demand: float, count: int, confidence: float = CONFIDENCE) -> float:
    """Return for how long no more than some events must come to show a rate below a demand.

    Of 1 an hour: 2.996 h without an event, 4.744 h with one.

    Parameters
    ----------
    demand : float [1/s]
        Above 0.
    count : int
        Events that may come.
    confidence : float [1], optional
        One-sided.

    Returns
    -------
    float [s]

    References
    ----------
    As ``rate_at_most``.
    """
    return _mean_at_most(count, confidence) / demand
