"""Shared fixtures."""

import numpy as np
import pytest


@pytest.fixture
def rng():
    """One seed for every test that needs chance."""
    return np.random.default_rng(20260101)
