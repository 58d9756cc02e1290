"""The figures of a design from what was counted, against closed forms."""

import re

import numpy as np
import pytest
import shapes
from scipy.stats import binom

from feederscrew.designing.record import (
    DesignRequest,
    DesignStudy,
    FilledQueue,
    RobustRun,
)
from feederscrew.output.designs import design_page

PART = shapes.part(shapes.box(10, 10, 10))


def study(queue, held=20, **more):
    from feederscrew import bowl as bowls

    known = {"robust": RobustRun(20, held, "A@0 is lost"), "queues": (queue,), **more}
    return DesignStudy(PART, DesignRequest(40.0 / 60.0), bowls.default(), "A@0", 0, **known)


def queue(right=45, left=45, returned=5, jams=0):
    return FilledQueue("normal", 12, 60.0, 60.0, float(left), right, left, returned, jams, 0)


def test_the_rate_counts_what_is_wanted_and_its_interval_is_that_of_the_share():
    found = queue(right=40, left=45)
    assert 60.0 * found.rate == pytest.approx(40.0)
    low, high = (end / found.rate * 40.0 / 50.0 for end in found.ends)
    for end, tail in ((low, 1.0 - binom.cdf(39, 50, low)), (high, binom.cdf(40, 50, high))):
        assert 0.01 < tail < 0.05, end  # a two-sided interval of 95 %, as near as Wilson's is


def test_it_holds_only_where_nothing_is_missing():
    assert study(queue()).status == "holds" and study(queue()).why == ""
    assert study(queue(jams=1)).status == "falls short"
    assert "1 jams in 60 s of queue" in study(queue(jams=1)).why
    assert "purity 88.9 %, 98 % are asked for" in study(queue(right=40)).why
    assert "18 of 20 draws of part, friction and drive sort: A@0 is lost" in study(queue(), held=18).why
    assert "of the 40/min asked for" in study(queue(right=30, left=30, returned=20)).why


def test_each_chapter_of_the_page_to_hand_on_says_something_and_is_reached():
    page = design_page.page(study(queue()))
    chapters = dict(re.findall(r'<section id="(\w+)">\n<h2>.*?</h2>(.*?)</section>', page, re.DOTALL))
    assert list(chapters) == ["answer", "loop", "proof", "acceptance"]
    assert "Status: holds" in chapters["answer"] and "20 of 20 draws sort" in chapters["proof"]
    assert all("<table" in chapters[name] for name in ("answer", "proof", "acceptance"))
    assert re.findall(r'<a href="#(\w*)">', page)[:4] == list(chapters)


def test_no_jam_is_at_most_three_in_the_time_it_was_looked_for():
    assert study(queue()).jams_per_hour_high == pytest.approx(3.0 / 60.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.jams_per_hour_high)
