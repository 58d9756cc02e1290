"""Parts below 1 mm and parts of very many facets: what studies say of them."""

from dataclasses import replace

import numpy as np
import part_files as files
import pytest
import trimesh

import feederscrew as feeder
from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.blades import Wiper
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.feeding.rate import passages, rate
from feederscrew.output import headings as headings_output
from feederscrew.output import rate as rate_output
from feederscrew.output import tooling as tooling_output
from feederscrew.part.record import MAX_FACETS, small_part_remarks
from feederscrew.sorting.headings import headings
from feederscrew.sorting.tooling import ToolingSearch, tooling

BOWL, MANY_BOWL = (replace(bowls.default(), devices=(Wiper("bowl.yaml:1", limit=h),)) for h in (2e-4, 5e-3))


def chip(folder, scale=1.0):
    """A chip of 0.6 x 0.3 x 0.23 mm, times a scale."""
    return feeder.load(files.written(folder, files.box(np.array([0.6, 0.3, 0.23]) * scale)))


def test_margin_play_and_tolerance_are_compared_with_the_part(tmp_path):
    part = chip(tmp_path)
    study = tooling(part, bowls.default(), "A", search=ToolingSearch(rule="csa", verdicts=50))
    for lines in (study.warnings, tooling_output.document(study)["warnings"]):
        text = next(line for line in lines if "tolerance" in line)
        # together 0.25 mm: 42 % of 0.6 mm, and more than 0.23 mm
        for word in ("0.6 x 0.3 x 0.23 mm", "margin 0.15 mm", "0.25 mm", "42 %", "more than its least"):
            assert word in text
    study = rate(part, BOWL, "A", rule="csa", sigma=1e-4)
    design = DesignStudy(part, DesignRequest(0.5, tolerance=1e-4), None, None, None)
    for lines in (study.warnings, rate_output.document(study)["warnings"]):
        assert any("play and tolerance 0.1 mm" in line for line in lines)
    assert any("tolerance 0.1 mm, together 0.25 mm" in line for line in design.warnings)
    allowances = {"margin": 1.5e-4, "play": 5e-5, "tolerance": 5e-5}
    assert small_part_remarks(chip(tmp_path, 10.0), allowances, 25e-3) == ()
    # a track no wider than one part
    for width, narrow in ((0.25e-3, True), (0.5e-3, False)):
        bowl = replace(bowls.default(), track=replace(bowls.default().track, width=width))
        remarks = headings_output.remarks(headings(part, bowl))
        for lines in (rate(part, bowl, "A", rule="csa").warnings, remarks):
            assert any("no wider than one part" in line for line in lines) == narrow


def test_a_part_of_very_many_facets_is_refused_by_one_line_where_it_would_travel(tmp_path):
    mesh = trimesh.creation.icosphere(subdivisions=5)
    mesh.apply_scale([6.0, 5.0, 4.0])
    mesh.export(tmp_path / "many.stl")
    part = feeder.load(tmp_path / "many.stl")
    for study in (
        lambda: tooling(part, MANY_BOWL, search=ToolingSearch(rule="csa")),
        lambda: rate(part, MANY_BOWL, rule="csa"),
        lambda: passages(part, MANY_BOWL, feeder.aspects(part, drops=0).aspects, "csa"),
        lambda: feeder.design(part, "30/min"),
        lambda: feeder.trial(part, MANY_BOWL, "A"),
    ):
        with pytest.raises(FeederError) as fault:
            study()
        assert fault.value.what == f"has {len(part.faces)} facets, too many to follow on the track"
        assert str(MAX_FACETS) in fault.value.mend
    assert rate(part, bowls.default(), rule="csa").parts.value >= 0.0  # without devices it is taken
