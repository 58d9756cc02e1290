"""Lengths as a shop makes them and a bowl file says them."""

import numpy as np

SHOP_STEP_M = 5e-5  # [m] of values that a shop makes
SHOP_ROUNDING_M = 1e-7  # [m] to which a value is rounded


def snapped(value, step, up):
    """Return the nearest multiple of a step [m] that is not below a value, or not above it."""
    count = value / step
    return float((np.ceil(count - 1e-6) if up else np.floor(count + 1e-6)) * step)


def millimetres(value):
    """Return a length [m] as a bowl file has it: '9.25 mm'."""
    return f"{1e3 * fine(value):.9g} mm"


def fine(value):
    """Return a length [m] rounded to what a bowl file says of it."""
    return float(np.round(value / SHOP_ROUNDING_M)) * SHOP_ROUNDING_M
