"""A quick look: a bound on the rate and a first chain, marked as not proved on every output."""

import json
from dataclasses import replace

import pytest
import shapes
from design_counts import design_study

import feederscrew as fs
from feederscrew.base.errors import ArgumentError
from feederscrew.bowl.verified import Status
from feederscrew.designing import exploring, loop, queues
from feederscrew.designing.policy import USUAL_POLICY
from feederscrew.designing.quick import QUICK_TRIALS
from feederscrew.designing.record import QuickAnswer
from feederscrew.output import design_pages, designs, tables
from feederscrew_cli.design import design as design_command

PART = shapes.part(shapes.box(20, 12, 5))
QUICK = QuickAnswer("A@0", 0.4, 0.2, 2.0, 1.5, True)


def quick_study(**more):
    """A quick look at a block of which a chain was clean at 90 a minute."""
    made = design_study(PART, queues=(), quick=QUICK, **more)
    return replace(made, request=replace(made.request, quick=True))


def test_a_quick_look_ends_with_a_clean_chain_and_runs_no_draw_and_no_queue(monkeypatch, block):
    def never(*_, **__):
        raise AssertionError("a quick look proves nothing")

    for module, name in ((loop, "prove_design"), (exploring, "robust_run"), (queues, "follow_fills")):
        monkeypatch.setattr(module, name, never)
    study = fs.design(block.part, "30/min", search=fs.DesignSearch(quick=True, rule="csa"))
    assert (study.status, study.partial) == (Status.NOT_PROVED, False) and study.bowl is not None
    assert len(study.attempts) <= QUICK_TRIALS and study.attempts[-1].clean
    # a row of parts that touch, at the fastest drive
    trial = study.trials[0]
    pitch = (trial.shares * trial.orientations.lengths).sum()
    quick = study.quick
    assert quick.rate_at_most == pytest.approx(quick.share * quick.fastest / pitch, rel=0.05)
    assert quick.short_trial < quick.rate_at_most and quick.clean


def test_a_quick_look_gives_no_head_all_of_its_trials(monkeypatch):
    """Of a bushing all eight went to rails; of a bolt six, two of them livelier, and none was clean."""
    asked, classes = [], []

    def candidates(search, cost_class):
        asked.append((search.request.budget, search.policy))
        classes.append(cost_class)
        return iter(())

    monkeypatch.setattr(exploring, "candidates", candidates)
    fs.design(PART, "30/min", search=fs.DesignSearch(quick=True, rule="csa"))
    assert classes == [1, 2, 3] and {budget for budget, _ in asked} == {QUICK_TRIALS}
    policy = asked[0][1]
    assert (policy.rails_trials, policy.rails_given_up, policy.livelier_trials) == (2, 2, 0)
    assert policy.tries_before_others == 1 and policy.mends == USUAL_POLICY.mends


def test_every_output_says_that_it_is_not_proved():
    study = quick_study()
    d = designs.document(study)
    assert (d["status"], d["delivered_per_minute"], d["purity"]) == ("not proved", None, None)
    assert d["quick"]["at_most_per_minute"] == pytest.approx(120.0)
    assert d["quick"]["short_trial_per_minute"] == pytest.approx(90.0)
    files = {offer.name: offer for offer in design_pages.offers(study, ())}
    assert set(files) == {"design.json", "design.yaml", "design.html"}  # nothing to build from
    for name, offer in files.items():
        assert "not proved" in tables.file_bytes(offer.make()).decode(), name
    assert "not proved" in tables.text(designs.summary(study), "table")
    assert "\nverified:" not in tables.file_bytes(files["design.yaml"].make()).decode()
    (entry,) = d["next"]  # what to do next is to prove it
    assert entry["change"] == "proof" and "--quick" not in entry["words"]


@pytest.mark.parametrize("found", [True, False])
def test_the_command_ends_with_status_0_and_leaves_a_proved_design_as_it_is(
    found, run, tmp_path, monkeypatch
):
    shapes.box(12.0, 10.0, 8.0).export(tmp_path / "box.stl")

    def looked(part, *_, **__):
        study = replace(quick_study(), part=part)
        return study if found else replace(study, bowl=None, wanted=None, quick=None)

    monkeypatch.setattr(loop, "design", looked)
    line = f"design {tmp_path}/box.stl --target 40/min --quick -o {tmp_path}/out"
    assert run(*line.split()).exit_code == 0
    folder = tmp_path / "out" / "box"
    assert json.loads((folder / "design.json").read_text())["status"] == "not proved"
    assert run(*line.split()).exit_code == 0  # one quick look takes the place of another
    (folder / "design.json").write_text('{"status": "holds"}')
    kept = run(*line.split())
    assert kept.exit_code == 0 and "keeps the files of an earlier design" in kept.stderr
    assert json.loads((folder / "design.json").read_text()) == {"status": "holds"}


def test_several_parts_have_no_quick_look(run, tmp_path):
    with pytest.raises(ArgumentError, match="one part"):
        fs.design([PART, PART], "30/min", search=fs.DesignSearch(quick=True))
    assert run("design", "a.stl", "b.stl", "--target", "30/min", "--quick").exit_code == 2
    assert design_command.make_context("design", ["a.stl", "--target", "30/min", "--quick"]).params["quick"]
