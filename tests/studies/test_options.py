"""The many keywords of a study stand in one record: with their defaults, and an end for what is none."""

import inspect
import typing
from dataclasses import fields

import pytest

from feederscrew import running
from feederscrew.studies import aspects, bowl, rate, report, solidbowl, tooling, trial, tune, wishes
from feederscrew.studies.simulated import drop, plate

STUDIES = {  # with the records of its keywords, and the names that it hands on
    aspects.aspects: ([running.OnCores], set()),
    bowl.bowl: ([solidbowl.SizingOptions], set()),
    drop.drop: ([running.RunSettings], set()),
    plate.plate: ([running.RunSettings], set()),
    rate.rate: ([rate.RateOptions], set()),
    rate.shares: ([running.OnCores], set()),
    report.report: ([rate.Spacing], report.ANSWER | report.PAGE),
    tooling.tooling: ([wishes.ToolingOptions], set()),
    trial.trial: ([trial.TrialOptions], set()),
    tune.tune: ([tune.TuneOptions], set()),
}


@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.__name__)
def test_a_keyword_that_a_study_does_not_know_is_a_wrong_call_of_that_study(study):
    named = inspect.signature(study).parameters.values()
    given = [None for one in named if one.kind is one.POSITIONAL_OR_KEYWORD and one.default is one.empty]
    with pytest.raises(
        TypeError, match=rf"^{study.__name__}\(\) got an unexpected keyword argument 'lunch'$"
    ):
        study(*given, lunch="feed")


@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.__name__)
def test_the_keywords_that_are_typed_are_those_that_are_known(study):
    records, handed_on = STUDIES[study]
    (gathered,) = (p for p in inspect.signature(study).parameters.values() if p.kind is p.VAR_KEYWORD)
    (keywords,) = typing.get_args(gathered.annotation)
    known = {one.name for record in records for one in fields(record)} | handed_on
    assert keywords.__optional_keys__ == known
    assert not keywords.__required_keys__
    assert all(name in study.__doc__ for name in known)
