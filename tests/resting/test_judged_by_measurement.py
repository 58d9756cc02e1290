"""Constants that were chosen on measured sets, judged by those sets."""

from pathlib import Path

import numpy as np
import pytest

from feederscrew.resting.aspects import find
from feederscrew.resting.counts.deviation import total_variation
from feederscrew.resting.rules import recommended
from feederscrew.studies.compare import compare_sets

MEASURED = Path(__file__).parents[2] / "docs/measured"


@pytest.fixture(scope="module")
def dropped():
    """Chances by every rule and measured shares, of each set of a part that was dropped."""
    sets = compare_sets(sorted(MEASURED.glob("*.csv"))).sets
    found = []
    for study in sets:
        if study.part.vertices is None or study.measured.head.launch != "drop":
            continue
        aspects = find(study.part)
        shares = np.zeros(len(aspects.stable))
        shares[aspects.stable] = study.profile.fractions / study.profile.fractions.sum()
        found.append((aspects.chances, shares))
    assert len(found) >= 2
    return found


def test_the_share_of_hops_of_drop_is_nearest_to_what_was_measured(dropped):
    """No share a twentieth away is nearer to any of the sets."""
    chosen = recommended.SHARES["drop"]
    for chances, shares in dropped:
        error = {
            share: total_variation(recommended.tempered(chances, share)[1], shares)
            for share in (chosen - 0.05, chosen, chosen + 0.05)
        }
        assert min(error, key=error.get) == chosen
