"""The figures of a design from what was counted, against closed forms."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapes
from scipy.stats import binom

from feederscrew import bowl as bowls
from feederscrew.designing import queues
from feederscrew.designing.record import (
    Attempt,
    DesignRequest,
    DesignStudy,
    FilledQueue,
    RobustRun,
)
from feederscrew.output import tables as tables_of
from feederscrew.output.designs import design_file, design_page, tables
from feederscrew.output.page import blocks
from feederscrew.output.page.as_html import html

PART = shapes.part(shapes.box(10, 10, 10))


def study(queue, held=20, **more):
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
    assert "1 jam in 60 s of queue" in study(queue(jams=1)).why
    assert "purity 88.9 %, 98 % are asked for" in study(queue(right=40)).why
    assert "18 of 20 draws of part, friction and drive sort: A@0 is lost" in study(queue(), held=18).why
    assert "of the 40/min asked for" in study(queue(right=30, left=30, returned=20)).why


def test_the_bowl_file_says_what_counted_as_one(tmp_path):
    for up, said in (((), "of A@0, purity"), (("A", "B"), "of A@0, A, B at any heading counted in: a rule")):
        made = replace(study(queue()), request=DesignRequest(40.0 / 60.0, up=up))
        (tmp_path / "design.yaml").write_text(design_file.bowl_file(made, ()))
        assert said in bowls.verified(tmp_path / "design.yaml").sentence


def test_what_was_stopped_early_says_so():
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None, partial=True)
    assert (none.status, none.why) == ("none", "stopped before a design was proved")
    for held, draws, said in (
        (0, 0, "no draw was tried"),
        (1, 1, "1 of 1 draws sort"),
        (3, 7, "3 of 7 draws sort"),
    ):
        some = replace(study(queue()), queues=(), robust=RobustRun(draws, held, ""), partial=True)
        assert (some.status, some.why) == ("falls short", f"stopped before a queue was followed: {said}")


def test_what_no_queue_was_followed_of_verifies_nothing(tmp_path):
    some = replace(study(queue()), queues=(), partial=True)
    (tmp_path / "design.yaml").write_text(design_file.bowl_file(some, ()))
    assert bowls.verified(tmp_path / "design.yaml") is None
    assert "Nothing is verified" in (tmp_path / "design.yaml").read_text()


def fills(right, left, returned, **more):
    """Queues at each fill; those at low and high fill are a sixth of it."""
    few = [(name, parts, right // 6, right // 6, returned // 6) for name, parts, _ in queues.FILLS]
    few[1] = ("normal", 12, right, left, returned)
    return tuple(
        FilledQueue(name, parts, seconds, seconds, float(leaves), good, leaves, back, more.get("jams", 0), 0)
        for (name, parts, good, leaves, back), (_, _, seconds) in zip(few, queues.FILLS, strict=True)
    )


def test_a_queue_is_followed_for_longer_only_where_that_decides():
    def asked(*counts, **more):
        return queues.minutes(study(queue(), queues=fills(*counts, **more)))

    assert asked(43, 43, 182) == 2  # 43 a minute, at least 34, of which 36 are needed
    assert asked(60, 60, 182) == 0  # holds as it is
    assert asked(37, 37, 182) == 0  # what is so near to it is not told apart in four minutes
    assert asked(43, 43, 182, jams=1) == 0
    assert asked(59, 61, 182) == queues.MORE  # 97.5 % pure, at most 99.3
    assert asked(54, 61, 182) == 0


def test_what_is_followed_for_longer_is_one_queue_of_other_seeds():
    seeds = []

    class Known(queues.FollowedRow):
        def followed(self, fill, parts, seconds, seed):
            seeds.append((fill, parts, seconds, seed))
            return FilledQueue(fill, parts, seconds, 58.0, 40.0, 40, 41, 180, 0, 1)

    row = Known(PART, None, None, None, None, (0,), seed=7)
    found = queues.longer(row, study(queue(), queues=fills(43, 43, 182)))
    assert seeds == [("normal", 12, 60.0, 8), ("normal", 12, 60.0, 9)]
    low, normal, high = found
    assert (low.seconds, normal.seconds, high.seconds) == (20.0, 180.0, 20.0)
    assert (normal.counted, normal.delivered, normal.climbs) == (60.0 + 2 * 58.0, 123.0, 2)
    assert (normal.right, normal.left, normal.returned) == (123, 125, 542)


def test_each_chapter_of_the_page_to_hand_on_says_something_and_is_reached():
    page = design_page.page(study(queue()))
    chapters = dict(re.findall(r'<section id="(\w+)">\n<h2>.*?</h2>(.*?)</section>', page, re.DOTALL))
    assert list(chapters) == ["answer", "loop", "proof", "acceptance"]
    least = "lower end of the rate is at least 36 a minute, the purity at least 98 %"
    assert least in chapters["answer"] and "20 of 20 draws sort" in chapters["proof"]
    assert all("<table" in chapters[name] for name in ("answer", "proof", "acceptance"))
    assert re.findall(r'<a href="#(\w*)">', page)[:4] == list(chapters)


def test_no_line_of_the_answer_is_longer_than_a_hundred_letters():
    long = "its leading side rises from the track by 17.6 deg only, and friction holds up to 31 deg " * 2
    lines = tables_of.text(tables.summary(study(queue(), risks=(long,))), "table").splitlines()
    assert max(map(len, lines)) <= 100
    assert " ".join(" ".join(lines).split()).count(long.strip()) == 1


def test_the_page_names_the_devices_of_a_trial_and_leaves_their_dimensions_to_the_file():
    chain = (
        "separation: {climb: -6 deg}",
        "gap: 9.5 mm",
        "cut_out: [[1 mm, 2 mm], [3 mm, 4 mm], [5 mm, 1 mm]]",
    )
    tried = Attempt("A@0", chain, "proposed", 0.0, 0.1, 8, 0.4, 1.0, 0.0, 1.0, ())
    one = study(queue(), attempts=(tried,))
    assert tables.short_attempts(one)["chain"][0] == "separation, gap 9.5 mm, cut_out"
    assert tables.attempts(one)["chain"][0] == ", ".join(chain)


def test_what_no_picture_stands_in_for_is_printed():
    """The bowl of a design on paper: its view, as the page has no picture of it."""
    view = blocks.Views({"poses": []}, (("bowl", "", ()),), "solid-bowl", "The")
    for printed in (False, True):
        page = blocks.Page("a", "", (blocks.Chapter((replace(view, printed=printed),)),))
        assert ('class="turnable on-paper"' in html(page)) == printed


def test_no_jam_is_at_most_three_in_the_time_it_was_looked_for():
    assert study(queue()).jams_per_hour_high == pytest.approx(3.0 / 60.0 * 3600.0)
    none = DesignStudy(PART, DesignRequest(1.0), None, None, None)
    assert none.status == "none" and none.why and np.isinf(none.jams_per_hour_high)
