"""Parts below 1 mm: studies say where margins are of their size, or the track is as narrow as they are."""

from dataclasses import replace

import numpy as np
import part_files as files
import pytest
import trimesh

import feederscrew as feeder
from feederscrew import bowl as bowls
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.errors import FeederError
from feederscrew.output import headings as headings_output
from feederscrew.output import rate as rate_output
from feederscrew.output import tooling as tooling_output
from feederscrew.part.record import MAX_FACETS, small_part_remarks
from feederscrew.studies.headings import headings
from feederscrew.studies.rate import passages, rate
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.blades import Wiper

BOWL = replace(bowls.default(), devices=(Wiper("bowl.yaml:1", limit=2e-4),))


def chip(folder, scale=1.0):
    """A chip of 0.6 x 0.3 x 0.23 mm, times a scale."""
    return feeder.load(files.written(folder, files.box(np.array([0.6, 0.3, 0.23]) * scale)))


def test_margin_play_and_tolerance_are_compared_with_the_part(tmp_path):
    study = tooling(chip(tmp_path), bowls.default(), "A", rule="csa", verdicts=50)
    for lines in (study.warnings, tooling_output.document(study)["warnings"]):
        text = next(line for line in lines if "tolerance" in line)
        assert "0.6 x 0.3 x 0.23 mm" in text
        assert "margin 0.15 mm" in text
        assert "0.25 mm" in text  # together: 42 % of 0.6 mm, and more than 0.23 mm
        assert "42 %" in text
        assert "more than its least" in text


def test_rate_and_design_say_so(tmp_path):
    part = chip(tmp_path)
    study = rate(part, BOWL, "A", rule="csa", sigma=1e-4)
    assert any("play and tolerance 0.1 mm" in line for line in study.warnings)
    assert any("play and tolerance 0.1 mm" in line for line in rate_output.document(study)["warnings"])
    design = DesignStudy(part, DesignRequest(0.5, tolerance=1e-4), None, None, None)
    assert any("tolerance 0.1 mm, together 0.25 mm" in line for line in design.warnings)


@pytest.mark.parametrize(("width", "narrow"), [(0.25e-3, True), (0.5e-3, False)])
def test_a_track_no_wider_than_one_part(tmp_path, width, narrow):
    bowl = replace(bowls.default(), track=replace(bowls.default().track, width=width))
    part = chip(tmp_path)
    for lines in (
        rate(part, bowl, "A", rule="csa").warnings,
        headings_output.remarks(headings(part, bowl)),
    ):
        assert any("no wider than one part" in line for line in lines) == narrow


def test_nothing_is_said_of_usual_parts(tmp_path):
    allowances = {"margin": 1.5e-4, "play": 5e-5, "tolerance": 5e-5}
    assert small_part_remarks(chip(tmp_path, 10.0), allowances, 25e-3) == ()


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    mesh = trimesh.creation.icosphere(subdivisions=5)
    mesh.apply_scale([6.0, 5.0, 4.0])
    path = tmp_path_factory.mktemp("many") / "many.stl"
    mesh.export(path)
    return feeder.load(path)


MANY_BOWL = replace(bowls.default(), devices=(Wiper("bowl.yaml:1", limit=5e-3),))


@pytest.mark.parametrize(
    "study",
    [
        lambda part: tooling(part, MANY_BOWL, rule="csa"),
        lambda part: rate(part, MANY_BOWL, rule="csa"),
        lambda part: passages(part, MANY_BOWL, feeder.aspects(part, drops=0).aspects, "csa"),
        lambda part: feeder.design(part, "30/min"),
        lambda part: feeder.trial(part, MANY_BOWL, "A"),
    ],
    ids=["tooling", "rate", "passages", "design", "trial"],
)
def test_a_part_of_very_many_facets_is_refused_by_one_line(part, study):
    assert len(part.faces) > MAX_FACETS
    with pytest.raises(FeederError) as fault:
        study(part)
    assert fault.value.what == f"has {len(part.faces)} facets, too many to follow on the track"
    assert str(MAX_FACETS) in fault.value.mend


def test_a_rate_without_devices_takes_it(part):
    assert rate(part, bowls.default(), rule="csa").parts.value >= 0.0
