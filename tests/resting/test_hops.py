"""The cascade of hops over the saddles."""

import dataclasses

import numpy as np
import pytest

from feederscrew.resting.barriers import Tipping
from feederscrew.resting.rules.formulas import KEPT_ENERGY_EXPONENT, hop_shares

SHARES = np.array([0.5, 0.3, 0.2])
HEIGHTS = np.array([0.3, 0.45, 0.6])


def tipping(shares, heights, pairs, tops):
    """Faces and ways given by hand."""
    pairs = np.array(pairs, dtype=int).reshape(-1, 2)
    return Tipping(
        np.array(shares), np.array(heights), pairs, np.array(tops, float), np.zeros((len(pairs), 3)), ()
    )


CHAIN = tipping(SHARES, HEIGHTS, [[0, 1], [1, 2]], [0.62, 0.8])


def walked(tips, count, rng):
    """Shares of walkers that hop one by one, energies drawn without any levels."""
    ended = np.zeros(len(tips.shares))
    neighbours = {k: [] for k in range(len(ended))}
    for (one, other), top in zip(tips.pairs, tips.tops):
        neighbours[one].append((other, top))
        neighbours[other].append((one, top))
    for face in rng.choice(len(ended), size=count, p=tips.shares):
        energy = 1.0
        while True:
            depth = energy - tips.heights
            ways = [(face, tips.shares[face] * depth[face])]
            ways += [
                (other, tips.shares[other] * depth[other] * (energy - top) / depth[face])
                for other, top in neighbours[face]
                if top < energy
            ]
            weights = np.array([weight for _, weight in ways])
            face = ways[rng.choice(len(ways), p=weights / weights.sum())][0]
            energy = tips.heights[face] + (energy - tips.heights[face]) * rng.random() ** (
                1.0 / KEPT_ENERGY_EXPONENT
            )
            if all(top >= energy for _, top in neighbours[face]):
                break
        ended[face] += 1
    return ended / count


def test_it_is_what_walkers_do():
    count = 6000
    found, exact = walked(CHAIN, count, np.random.default_rng(8)), hop_shares(CHAIN, 1.0)
    assert np.abs(found - exact).max() < 4.0 * np.sqrt(0.25 / count)
    assert np.abs(exact - SHARES).max() > 0.05


def test_a_deep_face_gains_and_a_lower_saddle_helps():
    shares = hop_shares(CHAIN, 1.0)
    assert shares[0] > SHARES[0] and shares[2] < SHARES[2]
    easier = dataclasses.replace(CHAIN, tops=np.array([0.62, 0.65]))
    assert hop_shares(easier, 1.0)[2] < shares[2]


def test_units_cancel_and_faces_keep_their_place():
    small = dataclasses.replace(CHAIN, heights=1e-3 * HEIGHTS, tops=1e-3 * CHAIN.tops)
    assert hop_shares(small, 1e-3) == pytest.approx(hop_shares(CHAIN, 1.0), rel=1e-9)
    turned = tipping(SHARES[::-1], HEIGHTS[::-1], [[0, 1], [1, 2]], [0.8, 0.62])
    assert hop_shares(turned, 1.0)[::-1] == pytest.approx(hop_shares(CHAIN, 1.0), rel=1e-9)


def test_faces_without_a_sink_stay_empty():
    more = tipping([*SHARES, 0.0], [*HEIGHTS, np.nan], CHAIN.pairs, CHAIN.tops)
    assert hop_shares(more, 1.0).tolist() == [*hop_shares(CHAIN, 1.0), 0.0]
