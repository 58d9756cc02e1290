"""The lead-in of rails: written, drawn, judged, and tried with a screw that lies askew."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from feederscrew import bowl as bowls
from feederscrew.part import load
from feederscrew.studies import tooling as tooling_study
from feederscrew.studies import trial
from feederscrew.tooling.orientations import neck
from feederscrew.tooling.verdicts import verdict
from feederscrew.trial import course

SCREW = Path(__file__).resolve().parents[2] / "parts/hexbolt_m8x25.stl"
LEAD = "lead_in: {from: 3 mm, to: 12 mm, length: 40 mm, taper: 30 mm}"


@pytest.fixture
def devices(tmp_path):
    def read(line, *settings):
        (tmp_path / "b.yaml").write_text(f"devices:\n  - {line}\n")
        return bowls.read(tmp_path / "b.yaml", settings)

    return read


def test_a_slot_begins_as_wide_as_its_lead_in_and_narrows(devices):
    (rails,) = devices(f"rails: {{from: 4.4 mm, to: 11.45 mm, {LEAD}}}").devices
    assert rails.lead == pytest.approx((3e-3, 12e-3, 40e-3, 30e-3))
    ring = 1e3 * rails.outline_on(None, 0.2)
    assert ring[:4] == pytest.approx(np.array([[0, 3], [40, 3], [70, 4.4], [200, 4.4]]))
    assert ring[4:] == pytest.approx(np.array([[200, 11.45], [70, 11.45], [40, 12], [0, 12]]))
    assert rails.document_values()["span_mm"] == pytest.approx([4.4, 11.45])
    assert rails.document_values()["lead_in"]["taper_mm"] == pytest.approx(30.0)


def test_rails_written_anew_are_read_as_they_were(devices):
    (rails,) = devices(f"rails: {{from: 4.4 mm, to: 11.45 mm, {LEAD}}}").devices
    wider = rails.with_span((2.5e-3, 12.5e-3))
    (again,) = devices(f"rails: {wider.text}").devices
    assert again.span == pytest.approx(wider.span)
    assert again.lead == pytest.approx((2.5e-3, 12.5e-3, 40e-3, 30e-3))


def test_a_shank_whose_tip_lies_on_the_rail_is_not_sure_to_go_down(devices):
    part, bowl = load(SCREW), devices("rails: {from: 4.4 mm, to: 11.45 mm}")
    study = tooling_study.tooling(part, bowl, rule="csa", verdicts=1, seconds=1e-3)
    one = next(one for one in study.orientations if one.name == "A@188")
    assert 1e3 * neck(one).tip == pytest.approx(-2.41, abs=0.05)  # nearer to the wall than its weight
    narrow = verdict(bowl.devices[0], one, study.orientations)
    wide = verdict(bowl.devices[0].with_span((4.4e-3, 11.45e-3), (3e-3, 11.45e-3, 0.05, 0.03)), one)
    assert narrow.hangs and not narrow.sure
    assert wide.hangs and wide.sure


def test_the_screw_is_fed_between_rails_and_its_trial_agrees(devices):
    part = load(SCREW)
    design = tooling_study.tooling(part, bowls.read(None, []), "A", rule="csa").design
    (rails,) = [cut.device for cut in design.cuts if cut.device.hangs]
    assert 0.2e-3 < rails.span[1] - rails.span[0] - 6.643e-3 < 0.6e-3
    assert rails.lead[0] < rails.span[0] and rails.lead[1] > rails.span[1]
    run = trial.trial(part, [devices(f"rails: {rails.text}")], rule="csa", parts=10, jobs=1).runs[0]
    rows = [k for k, one in enumerate(run.orientations.lying) if one.name in ("A@188", "A@354")]
    assert run.counts[rows, 0].tolist() == run.tried[rows].tolist()


def test_a_trial_says_where_a_head_at_the_wall_may_wedge(devices, tmp_path):
    """In MuJoCo, with a drive and soft contacts, it stands there."""
    profile = [(0, 0), (2.5, 0), (2.5, 13.2), (5.0, 15.7), (5.0, 16), (0, 16)]
    trimesh.creation.revolve(profile, sections=24).export(tmp_path / "screw.stl")
    part, told = load(tmp_path / "screw.stl"), []
    for near in (2.2, 3.0):
        bowl = devices(f"rails: {{from: {near} mm, to: {near + 5.4} mm}}")
        run = trial.trial(part, [bowl], rule="csa", parts=6, jobs=1).runs[0]
        row = next(k for k, one in enumerate(run.orientations.lying) if one.name == "A@189")
        assert run.counts[row, course.TURNED] > 0  # it hangs and goes on
        told.append((run.wedging[row], [line for line in run.remarks if "may wedge" in line]))
    (near, said), (far, nothing) = told
    assert near == pytest.approx(0.39e-3, abs=0.03e-3) and far == 0.0
    assert said[0].startswith("A@189: hangs with its head at the wall") and not nothing
