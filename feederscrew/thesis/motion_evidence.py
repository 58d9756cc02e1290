"""The numbers behind the findings on chapter 5, from the limits of slip and hop."""

import numpy as np

from feederscrew.mechanics import limits
from feederscrew.thesis import chapter_5


def hop():
    """Return where Figures 5-6 and 5-7 lie past the hop, and where friction holds the part."""
    ratio = chapter_5.ratio_of_5_6()
    drawn = chapter_5.figure_5_7()
    return {
        "beta_deg": np.degrees(np.arcsin(1.0 / ratio)),
        "acceleration": ratio * chapter_5.GRAVITY,
        "share": 100.0 * np.mean(drawn.hops),
        "held": 100.0 * np.mean(drawn.values < 0.0),
    }


def sliding():
    """Return limiting friction of [4.28] at two vibrations and two angles."""
    low, high = chapter_5.RATIOS[5], chapter_5.RATIOS[-1]
    at = {
        f"{name}_{beta}": float(limits.published_limit(ratio, np.radians(beta)))
        for name, ratio in (("low", low), ("high", high))
        for beta in (10, 40)
    }
    return at | {"low": f"{low:.1f}", "high": f"{high:.1f}"}
