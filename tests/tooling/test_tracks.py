"""Bank, groove, width and sweep are found where they give a chain more."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.output import tooling as tooling_output
from feederscrew.part import load
from feederscrew.resting.aspects import find
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.kinds import make_device
from feederscrew.tooling.isolating import design
from feederscrew.tooling.isolating.chain import DesignConstraints
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.tooling.verdicts import DeviceEncounter

BOWL = bowls.read(None, [])
BLOCK = shapes.part(shapes.box(20, 12, 5))


def coming(part, bowl=BOWL):
    every = travelling(orientations(part, find(part), bowl.track), bowl)
    return every, np.array([one.chances["csa"] for one in every])


@pytest.fixture(scope="module")
def block():
    return coming(BLOCK)


def leaning(angle):
    groove = make_device("groove", "design", angle=math.radians(angle), text=f"{{angle: {angle} deg}}")
    return groove, make_device("bank", "design", angle=math.radians(6.0), text="6 deg")


def test_a_dowel_leaves_out_of_the_groove_in_which_what_lies_across_turns():
    dowel = load("parts/dowel_6x20.stl")
    study = tooling(dowel, BOWL, "A", heading=0.0, rule="csa", verdicts=1)
    level = tooling(dowel, BOWL, "A", heading=0.0, rule="csa", verdicts=1, vary=False)
    assert [cut.device.text for cut in study.design.cuts] == ["{angle: 55 deg}"]
    assert study.design.isolated and study.design.efficiency == pytest.approx(0.9927, abs=2e-4)
    assert level.design.efficiency == pytest.approx(0.8559, abs=2e-4)
    every, shares = coming(dowel)
    found = {angle: design.coming(every, shares, leaning(angle))[0] for angle in (15.0, 45.0, 55.0)}
    assert found[45.0] == pytest.approx(shares[0])  # there what lies across stands on its end
    assert found[15.0] == pytest.approx(shares[0], abs=8e-3)  # and there it rolls back first
    assert found[55.0] == pytest.approx(
        shares.sum() - shares[[one.returned for one in every]].sum(), abs=8e-3
    )


def test_a_track_gives_more_that_isolates_or_is_purer_or_brings_more():
    best = SimpleNamespace(isolated=False, purity=0.5, efficiency=0.2)

    def other(**values):
        return SimpleNamespace(**vars(best) | values)

    assert design.gains(other(isolated=True, purity=0.4), best)
    assert not design.gains(best, other(isolated=True))
    assert design.gains(other(purity=0.52, efficiency=0.1), best)
    assert not design.gains(other(purity=0.48, efficiency=0.4), best)
    assert not design.gains(other(efficiency=0.205), best) and design.gains(other(efficiency=0.22), best)
    assert not design.gains(None, best) and not design.gains(best, best)


def test_other_tracks_are_tried_for_what_rolls_or_is_not_isolated(block):
    every, _ = block
    free = DesignConstraints()
    loose = SimpleNamespace(isolated=False, cuts=())
    assert [one[0].text for one in design.other_stretches(every[0], loose, free)] == [
        "6 deg",
        "10 deg",
        "15 deg",
    ]
    assert design.other_stretches(every[0], SimpleNamespace(isolated=True, cuts=()), free) == []
    assert design.other_stretches(every[0], loose, DesignConstraints(without=("bank",))) == []
    steep = replace(every[0], track=replace(every[0].track, bank=0.01))
    assert design.other_stretches(steep, loose, free) == []


def test_what_falls_off_has_a_track_as_wide_as_it_is(tmp_path):
    narrow = bowls.read(None, ["track.width=9 mm"])
    study = tooling(BLOCK, narrow, "A", heading=math.pi / 2, rule="csa", verdicts=1)  # 20 mm across
    found, one = study.design, study.orientations[study.wanted]
    assert found.isolated and found.width == study.bowl.track.width
    assert one.width + 1e-3 <= found.width < one.width + 2.1e-3 and not one.falls_off
    assert f"the track has to be {1e3 * found.width:g} mm wide" in found.reasons
    path = tmp_path / "tooling.yaml"
    path.write_text(
        tooling_output.bowl_file(study, bowls.settings(None, ["track.width=9 mm", "track.bank=0 deg"]))
    )
    assert bowls.read(path).track.width == pytest.approx(found.width, abs=1e-12)
    path.write_text(tooling_output.bowl_file(study, bowls.settings(None, [])))
    assert bowls.read(path).track.width == pytest.approx(found.width, abs=1e-12)
    assert (
        tooling(BLOCK, narrow, "A", heading=math.pi / 2, rule="csa", verdicts=1, vary=False).design.width
        is None
    )


def test_a_narrower_track_lets_a_pulse_blow_off_what_is_heavy(block):
    every, shares = block
    assert design.widths(every, shares, 0, 2.5e-4) == []  # 9.4 g fly off 25 mm
    heavy = tuple(replace(one, posture=replace(one.posture, mass=0.1)) for one in every)
    (width,) = design.widths(heavy, shares, 0, 2.5e-4)
    sorter = make_device("sorter", "design", like=(heavy[0].aspect, heavy[0].heading, 2.5e-4))
    ways = [
        one.track.width + DeviceEncounter(one, heavy).blown(*sorter.jet.push(one, heavy), sorter.time)
        for one in heavy[1:]
    ]
    assert width == pytest.approx(math.floor(1e3 * min(ways)) * 1e-3) and heavy[0].width < width < 25e-3
    there = [replace(one, track=replace(one.track, width=width)) for one in heavy]
    blown = [
        DeviceEncounter(one, there).blown(*sorter.jet.push(one, tuple(there)), sorter.time)
        for one in there[1:]
    ]
    assert min(blown) > 0.0
    wide = [DeviceEncounter(one, heavy).blown(*sorter.jet.push(one, heavy), sorter.time) for one in heavy[1:]]
    assert min(wide) < 0.0


def test_a_jet_meets_the_end_of_a_part_that_is_higher_than_its_middle():
    steps = [(0, 0), (16, 0), (16, 4), (4, 4), (4, 9), (0, 9)]  # [mm] a tall end behind or ahead
    every, _ = coming(shapes.part(shapes.prism(steps, 8.0)))
    one = max((k for k in every if k.height < 9.5e-3 and k.length > 15e-3), key=lambda k: k.height)
    jet = make_device("jet", "j", nozzle=2e-3, pressure=5e4, height=7e-3)
    met = DeviceEncounter(one, every)
    assert jet.jet.push(one, every)[0] == 0.0 and jet.most(met) > 2.0 * jet.factor(met) > 0.0
    pressures = [replace(jet, pressure=float(pressure)) for pressure in np.geomspace(1e2, 1e5, 60)]
    some = next(one for one in pressures if 0.6 < one.most(met) < 1.8)
    weak = next(one for one in pressures if 0.2 < one.most(met) < 0.5)
    assert not some.judged(met).sure and weak.judged(met).sure and weak.judged(met).passes == 1.0


def test_other_sweeps_are_those_at_which_a_face_clears_itself(block):
    every, _ = block
    sweeps = [
        round(math.degrees(one.sweep)) for one in design.varied_devices(every, 0, 2.5e-4, DesignConstraints())
    ]
    assert sweeps == [20, 45, 55]  # friction 0.6: below 59 deg
    rough = [replace(one, grip=0.9) for one in every]
    assert [
        round(math.degrees(one.sweep)) for one in design.varied_devices(rough, 0, 2.5e-4, DesignConstraints())
    ] == [
        20,
        45,
    ]
