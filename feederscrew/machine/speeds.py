"""Whether a part travels at a speed that bowls have."""

import numpy as np

from feederscrew.bowl.record import Sizing

MM_S = 1e-3  # [m/s]


def remark(velocity: float, rules: Sizing | None) -> list[str]:
    """Return what is odd about a conveying velocity.

    Source: trade, the keys ``sizing.slowest`` and ``sizing.fastest``; docs/bowl_file.md.

    Parameters
    ----------
    velocity : float [m/s]
        NaN where there is no steady one.
    rules : Sizing or None
        Its slowest and fastest speed; None of a bowl made by hand, which has none.

    Returns
    -------
    list of str
        One line, or none.
    """
    if rules is None or np.isnan(velocity) or rules.slowest <= velocity <= rules.fastest:
        return []
    between = f"{rules.slowest / MM_S:.4g} to {rules.fastest / MM_S:.4g} mm/s"
    side = "slower" if velocity < rules.slowest else "faster"
    return [
        f"{velocity / MM_S:.3g} mm/s is {side} than bowls run ({between}): check stroke, angle and friction"
    ]
