"""What the tests of the design loop share."""

from types import SimpleNamespace

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import proposals
from feederscrew.resting.aspects import find


@pytest.fixture(scope="session")
def block():
    """A block of 20 x 12 x 5 mm along a track without a device: how it lies there, and rows by name."""
    part = shapes.part(shapes.box(20, 12, 5))
    aspects = find(part)
    ways = proposals.follow_orientations(part, aspects, bowls.default())
    names = {one.name: k for k, one in enumerate(ways.lying)}
    return SimpleNamespace(part=part, aspects=aspects, ways=ways, names=names)


@pytest.fixture
def ways(block):
    return block.ways
