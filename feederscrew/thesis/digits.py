"""Printed digits: what number a text can stand for."""

import math

SLACK = 1e-9  # of the last digit: a half of it is not exact in binary


def last_digit(text):
    """Return the weight of the last printed digit: '0.805' gives 0.001."""
    return 10.0 ** -len(text.partition(".")[2])


def is_number(text):
    """Whether the printed text is a number at all."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def prints_as(value, text, cut=False):
    """Whether a value, rounded (or cut off) after the last printed digit, gives the text.

    Parameters
    ----------
    value : float
    text : str
        A number in print, '0.805'.
    cut : bool
        The digits after the last are dropped, not rounded.

    Returns
    -------
    bool
    """
    step = last_digit(text)
    error = (value - float(text)) / step
    if cut:
        return -SLACK <= error * math.copysign(1.0, value) < 1.0 - SLACK
    return abs(error) <= 0.5 + SLACK


def slip(value, text):
    """Whether one wrong character keeps the text from being the value: '804.1.73' for 804.1073."""
    right = f"{value:.{len(text) - text.index('.') - 1}f}"
    return len(right) == len(text) and sum(a != b for a, b in zip(right, text)) == 1
