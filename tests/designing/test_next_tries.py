"""A design that does not hold ends in commands to paste: each asks for what it says, the likeliest first."""

import functools
import re
import shlex
from dataclasses import fields, replace
from html import unescape
from types import SimpleNamespace

import numpy as np
import pytest
import shapes
from command_lines import asked_by
from design_counts import attempt, design_of_nothing, design_study, heading_off, queue

from feederscrew.base.units import rounded_down
from feederscrew.bowl.verified import Status
from feederscrew.designing import calm_drive, texts, verdict_texts
from feederscrew.designing.calls import call_of, call_words
from feederscrew.designing.findings import Fault, FaultKind
from feederscrew.designing.next_tries import Evidence, TryKind, next_tries
from feederscrew.designing.record import DesignRequest, NearestDesign
from feederscrew.output import design_pages, designs, tables

PART = shapes.part(shapes.box(20, 12, 5))
TYPED = ("design", "my part.stl", "--target=60/min", "--set", "drive.frequency=50 Hz", "-o", "out")


nothing = functools.partial(design_of_nothing, PART)


def near(rate=0.25, **request):
    asked = DesignRequest(1.0, **request)
    return NearestDesign(rate, "a calmer drive", wanted=request.pop("wanted", "A@0"), request=asked)


CASES = {
    "nothing": nothing(),
    "typed": nothing(call=TYPED),
    "one asked for": nothing(request=DesignRequest(1.0, aspect="A", heading=np.radians(54.0))),
    "ruled out": nothing(
        request=DesignRequest(0.7, without=("vision reject", "wiper"), diameter=(0.2, 0.4), outcome="lying")
    ),
    "clean and slow": nothing(attempt("C", 20.5, ()), attempt()),
    "holds at less": nothing(nearest=near()),
    "another way up": nothing(request=DesignRequest(1.0, aspect="A"), nearest=replace(near(), wanted="C@86")),
    "any heading": nothing(nearest=near(up=("A",))),
    "hanging": nothing(request=DesignRequest(1.0, aspect="A"), nearest=replace(near(), wanted="hanging")),
    "stopped": nothing(partial=True, call=TYPED),
    "impure": design_study(PART, queue(100, 200, left_instead=((heading_off("A"), 100),))),
}


@pytest.mark.parametrize("study", CASES.values(), ids=CASES)
def test_each_command_asks_for_what_it_says(study):
    entries, tries = designs.document(study)["next"], next_tries(study)
    assert 1 <= len(entries) == len(tries) <= 3
    assert len({entry["command"] for entry in entries}) == len(entries)
    for entry, one in zip(entries, tries, strict=True):
        assert shlex.split(entry["command"]) == entry["words"]
        own = replace(one.request, jobs=1)
        again = asked_by(entry["words"])
        for field in fields(DesignRequest):
            value = getattr(own, field.name)
            assert getattr(again, field.name) == (
                pytest.approx(value) if isinstance(value, float) else value
            ), field.name
        assert entry["why"] and entry["words"][-2:] == ["-o", "results"]


@pytest.mark.parametrize(("name", "kinds"), [
    # C comes often and was not tried; B once, A five times
    ("nothing", (TryKind.ANOTHER_SIDE, TryKind.ANOTHER_DRIVE, TryKind.ANOTHER_SIDE)),
    ("ruled out", (TryKind.MORE_DEVICES, TryKind.ANY_OUTCOME, TryKind.ANY_DIAMETER)),
    ("clean and slow", (TryKind.ANOTHER_SIDE, TryKind.ANOTHER_SIDE, TryKind.LOWER_RATE)),
    ("holds at less", (TryKind.LOWER_RATE, TryKind.ANOTHER_SIDE, TryKind.ANOTHER_DRIVE)),
    ("another way up", (TryKind.ANOTHER_SIDE,) * 3),
    ("any heading", (TryKind.ANY_HEADING, TryKind.ANOTHER_SIDE, TryKind.ANOTHER_DRIVE)),
    ("stopped", (TryKind.PROOF,)),
    ("impure", (TryKind.ANY_HEADING, TryKind.LOWER_RATE, TryKind.ANOTHER_DRIVE)),
])  # fmt: skip
def test_the_likeliest_comes_first(name, kinds):
    assert tuple(one.kind for one in next_tries(CASES[name])) == kinds


def test_sides_that_were_tried_least_come_first_and_rare_ones_do_not():
    first, _, third = next_tries(CASES["nothing"])
    assert (first.aspect, first.share, first.trials, third.aspect, third.trials) == ("C", 0.08, 0, "B", 1)
    clean, side, _ = next_tries(CASES["clean and slow"])
    # half of 20.5 a minute, rounded down to two digits
    assert (clean.aspect, clean.evidence, 60.0 * clean.request.target) == ("C", Evidence.CLEAN, 10.0)
    assert side.aspect == "B"
    # of two sides of which nothing was clean, the one of which more parts left, for its share
    some = replace(attempt("B@0"), efficiency=0.06), replace(attempt("C@86"), efficiency=0.04)
    sides = [one.aspect for one in next_tries(nothing(attempt(), *some))]
    assert sides == ["C", "", "B"]
    held = next_tries(CASES["another way up"])[0]
    assert (held.request.aspect, held.request.target, held.evidence) == ("C", 0.25, Evidence.HOLDS)
    assert next_tries(CASES["hanging"])[0].request.outcome == "hanging"
    assert [rounded_down(rate) for rate in (20.5, 9.99, 0.0, 123.0)] == [20.0, 9.9, 0.0, 120.0]


def test_a_call_keeps_what_was_typed_and_changes_the_rest():
    asked = DesignRequest(1.0)
    words = call_of(replace(asked, target=0.5, up=("A", "B")), asked, TYPED)
    assert words == (
        "feeder", "design", "my part.stl", "--set", "drive.frequency=50 Hz", "--target", "30/min", "--up",
        "A,B", "-o", "results",
    )  # fmt: skip
    former = ("design", "p.stl", "--budget", "8", "--target", "60/min", "--alternatives", "-oout")
    words = call_of(replace(asked, budget=32), replace(asked, budget=8, alternatives=True), former)
    assert words == ("feeder", "design", "p.stl", "--target", "60/min", "--trials", "32", "-o", "results")
    assert call_words(replace(asked, up=("A",)), PART)[2:] == (
        "--density", PART.material, "--target", "60/min", "--up", "A",
    )  # fmt: skip


def test_what_brings_far_more_than_was_asked_names_a_calmer_drive():
    """Asked for 40 a minute a washer came at 190, and nothing was said of it."""
    fills = [queue(fill=fill) for fill in ("low", "normal", "high")]
    rate = 60.0 * design_study(PART, *fills).proof.delivered[0]
    study = design_study(PART, *fills, target=rate / 4.75, call=TYPED)
    assert study.status is Status.HOLDS
    robust, step = next_tries(study)
    assert study.request.target < step.rate < robust.rate < study.proof.delivered[0]
    kept = calm_drive.with_amplitude(study.bowl, float(robust.settings[0][1].split()[0]) * 1e-3)
    asked = 1.25 * 60.0 * study.request.target / rate * calm_drive.speed(study.bowl)
    assert calm_drive.slowest(kept) >= 0.6 * asked, "at the worst friction the first one conveys too"
    ((key, value),) = step.settings
    calmer = calm_drive.with_amplitude(study.bowl, float(value.split()[0]) * 1e-3)
    share = calm_drive.speed(calmer) / calm_drive.speed(study.bowl)
    assert (step.kind, key, value.split()[1]) == (TryKind.CALMER_DRIVE, "drive.amplitude", "mm")
    assert 60.0 * step.rate == pytest.approx(rate * share)
    assert 1.0 <= step.rate / study.request.target <= 1.5  # asked for 40: 40 to 60
    assert step.worst_rate > 0.0, "no call is named that stands still at the worst friction"
    assert step.worst_rate == pytest.approx(step.rate * calm_drive.velocity_kept(calmer))
    entry = designs.document(study)["next"][1]
    assert f"drive.amplitude={value}" in entry["words"] and "not tried" in entry["why"]
    typed = (*TYPED, "--set", "drive.amplitude=0.3 mm")  # who gave the stroke keeps it
    assert next_tries(replace(study, call=typed)) == ()
    near_enough = design_study(PART, *fills, target=rate / 1.4)
    assert next_tries(near_enough) == ()


def test_what_holds_has_nothing_to_try():
    held = design_study(PART, *(queue(fill=fill) for fill in ("low", "normal", "high")))
    held = replace(held, request=replace(held.request, target=held.proof.delivered[0] / 1.2))
    assert held.status is Status.HOLDS and next_tries(held) == ()
    assert designs.document(held)["next"] == []


def test_the_page_of_what_hangs_begins_with_the_pose_in_which_it_arrives():
    """It began with the one part of 157 that left otherwise: 'hanging' is no pose on a face."""
    poses = [SimpleNamespace(name=name) for name in ("B@0", "A@354")]
    queues = (queue(fill=fill) for fill in ("low", "normal", "high"))
    tooling = SimpleNamespace(wanted=1, orientations=poses)
    study = replace(design_study(PART, *queues), wanted="hanging", tooling=tooling)
    assert study.delivers and design_pages.first_seen(study)[0][0] == "A@354"
    tried = nothing(attempt("hanging", aspect=""), attempt("B@0"), tooling=tooling)
    tried = replace(tried, wanted="hanging")
    assert not tried.delivers
    (name, words), *_ = design_pages.first_seen(tried)
    assert name == "A@354" and words.startswith("arrives so; ")


def test_the_answer_says_each_thing_once_and_ends_in_commands():
    """The same fault of eight trials of three orientations is three lines; no command is broken."""
    study = CASES["nothing"]
    rows = list(zip(*designs.summary(study).values(), strict=True))
    text = tables.text(designs.summary(study), "table")
    assert text.count("returned at gap") == 3 and "A@270, 4 trials" in text
    commands = [value for _, value in rows if str(value).startswith("feeder ")]
    assert commands == [entry["command"] for entry in designs.document(study)["next"]]
    assert [name for name, value in rows if value in commands] == ["try first", "then", "or"]
    assert "0 (95 %" not in text  # no figures of a queue that was not followed


def test_the_page_begins_with_the_pose_that_was_wanted_where_it_was_lost_and_what_to_try():
    study = CASES["nothing"]
    page = unescape(design_pages.page(study))
    seen = design_pages.first_seen(study)
    assert [name for name, _ in seen] == ["A@270", "A@54", "C"]
    assert "returned at gap" in seen[0][1] and "to try" in seen[2][1]
    plain = re.sub("<[^>]*>", "", page)
    places = [plain.index(text) for text in ("A@270, 4 trials: lost", "What to try", "Why it does not hold")]
    assert places == sorted(places)
    for entry in designs.document(study)["next"]:
        assert f"<pre>{entry['command']}</pre>" in page


def test_a_trial_in_which_nothing_went_wrong_is_no_loss():
    """A quick look named one that was clean at 71.9 a minute, 60 asked for, among the lost: 'too slow'."""
    clean, slower = (attempt("A@270", rate, ()) for rate in (71.9, 20.0))
    quick = nothing(clean, slower, attempt("C"), request=DesignRequest(1.0, quick=True))
    [words, other] = verdict_texts.shortfall_texts(quick)
    assert words == "A@270, 2 trials: clean, 71.9/min" and "lost (returned at gap)" in other
    assert words in re.sub("<[^>]*>", "", unescape(design_pages.page(quick)))
    [mixed] = verdict_texts.shortfall_texts(nothing(clean, attempt("A@270")))
    assert mixed == "A@270, 2 trials: lost (returned at gap), clean, 71.9/min"


@pytest.mark.parametrize("kind", [FaultKind.NOT_RUN, FaultKind.IMPURE, FaultKind.NOTHING_LEAVES])
def test_a_trial_that_fails_as_a_whole_says_how(kind):
    fault = Fault(kind, reason="the part does not fit", shares=(0.5, 0.4, 0.6, 0.98))
    [words] = verdict_texts.shortfall_texts(nothing(attempt("A@270", 0.0, (fault,))))
    assert words == f"A@270, 1 trial: {texts.fault_text(fault)}"
