"""The track chapter of a report says one thing, in the reader's words."""

import shapes

from feederscrew import bowl as bowls
from feederscrew.output.report import SLIDES_DOWN, THROWN, WORDS, on_track
from feederscrew.resting.aspects import find
from feederscrew.studies.aspects import AspectsStudy
from feederscrew.studies.rate import Shares
from feederscrew.studies.report import ReportStudy


def told(mesh, *overrides):
    part, settings = shapes.part(mesh), bowls.settings(None, overrides)
    found = find(part)
    case = ReportStudy(
        resting=AspectsStudy(part, found), settings=settings, bowl=bowls.record(settings), path=None,
        aspect="A", heading=None, rule="csa", gap=0.0, fill=1.0, target=None, counted=None,
        shares=Shares(found),
    )  # fmt: skip
    return on_track(case, WORDS), case


def test_what_slides_has_the_velocity_of_the_rate():
    said, case = told(shapes.box(20, 14, 5))
    speed = 1e3 * case.rate.rate.velocity.value
    assert said == f"On this track the part travels at {speed:.1f} mm/s and slips both ways:" + (
        " the rate is computed with that. It stays on its aspect through the stroke."
    )


def test_what_is_thrown_rolls_back_or_slides_down_is_said():
    assert THROWN in told(shapes.box(20, 14, 5), "drive.amplitude=0.4 mm")[0]
    ball = told(shapes.ball(5.0, 3))[0]
    assert ball.endswith("It lies on its round side and rolls back down the climb, so the rate is 0.")
    assert told(shapes.box(20, 14, 5), "track.climb=40 deg")[0] == SLIDES_DOWN


def test_what_rocks_says_why_it_tips_and_travels_on():
    said = told(shapes.box(2, 2, 8), "friction.static=0.9", "track.climb=1 deg")[0]
    assert "travels at" in said and "turns it over" not in said
