"""What a heading is turned from is said once, where a text names one."""

import numpy as np
import pytest

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.geometry.polygons import centroid
from feederscrew.output.tables import heading_note
from feederscrew.resting.aspects import find
from feederscrew.tooling.orientations import orientations

TEXTS = [
    ("A@188 is isolated", "A@188: aspect A, turned 188 deg counter-clockwise"),
    ("aspect  heading  share\nA  188  39", "heading: "),
    ("keeps A at heading 188 and 354 deg", "heading: "),
]


@pytest.mark.parametrize(("text", "begins"), TEXTS)
def test_a_text_that_names_a_heading_has_a_note(text, begins):
    assert heading_note(text).startswith(begins)


@pytest.mark.parametrize(
    "text",
    [
        "aspect  lies\nA  flat",
        "mass 13 g",
        "quantity  value\naspect and heading  A at 188 deg",
        "user@example",
        "climbs at 3 deg",
    ],
)
def test_any_other_has_none(text):
    assert heading_note(text) == ""


def test_the_note_is_true_of_a_part():
    """In the axes of the track the middle of the face lies at the heading from the way ahead."""
    found = parts.load("parts/lbracket_30x20x15.stl")
    every = orientations(found, find(found), bowls.record(bowls.settings(None, ())).track)
    for one in every:
        file_axes = one.posture.axes.T  # posture to file, as columns
        middle = file_axes[:, :2] @ centroid(one.posture.contact)
        if np.hypot(*centroid(one.posture.contact)) < 1e-4:
            continue
        ahead, inwards, _ = one.axes @ middle
        assert np.arctan2(inwards, ahead) % (2.0 * np.pi) == pytest.approx(
            one.heading % (2.0 * np.pi), abs=1e-9
        )
        assert np.linalg.det(one.axes) == pytest.approx(
            1.0
        )  # y is inwards, z up: counter-clockwise from above
