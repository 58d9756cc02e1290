"""Functions of the library take what tables print, 'A@354', where they take an aspect."""

import numpy as np
import pytest
import shapes

import feederscrew as fs
from feederscrew.base.errors import ArgumentError
from feederscrew.bowl import arguments


@pytest.mark.parametrize(
    ("aspect", "heading", "meant"),
    [("A", None, ("A", None)), ("A@90", None, ("A", 90.0)), ("A", "90 deg", ("A", 90.0)),
     (None, None, (None, None)), ("B@7.5", None, ("B", 7.5))],
)  # fmt: skip
def test_an_aspect_may_have_its_heading(aspect, heading, meant):
    name, angle = arguments.an_orientation(aspect, heading)
    assert name == meant[0]
    assert angle == (None if meant[1] is None else pytest.approx(np.radians(meant[1])))


def test_of_two_headings_none_is_taken():
    with pytest.raises(ArgumentError, match="A@90 has a heading of its own"):
        arguments.an_orientation("A@90", "80 deg")


@pytest.mark.parametrize("study", [fs.track, fs.floor])
def test_a_study_of_a_named_orientation_is_that_of_its_aspect_at_the_heading(study):
    part, bowl = shapes.part(shapes.box(20, 12, 5)), fs.read_bowl()
    one, other = study(part, bowl, "A@90"), study(part, bowl, "A", heading="90 deg")
    assert one.posture.name == other.posture.name == "A"
    assert one.to_frame().equals(other.to_frame())
    assert not one.to_frame().equals(study(part, bowl, "A").to_frame())
