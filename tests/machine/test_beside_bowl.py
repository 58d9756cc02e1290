"""Camera, lens, valve and inline track beside a bowl, against the thin lens, the drive and the part."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.bowl.devices.pneumatics import REACTION
from feederscrew.bowl.record import Track
from feederscrew.feeding.stream import follow_orientations
from feederscrew.machine import after_outlet, vision_station
from feederscrew.machine.vision_station import CAMERAS, choose_lens, plan_vision_stations
from feederscrew.motion.conveying import answer
from feederscrew.output import beside_bowl
from feederscrew.resting.aspects import find

TRACK = Track(climb=np.radians(3.0), bank=0.0, radius=0.15, width=0.016)


@pytest.mark.parametrize("field", [(16e-3, 14e-3), (14e-3, 16e-3), (60e-3, 30e-3), (110e-3, 60e-3)])
def test_a_lens_images_the_field_onto_the_chip_and_resolves_it(field):
    lens = choose_lens(field, 1e-4)
    image = 1.0 / (1.0 / lens.focal_length - 1.0 / lens.distance)  # 1 / f = 1 / a + 1 / b
    assert image / lens.distance == pytest.approx(lens.magnification)
    on_chip = sorted(lens.magnification * size for size in field)
    chip = sorted(lens.camera.size)
    assert all(a <= b * (1 + 1e-9) for a, b in zip(on_chip, chip))
    assert any(a == pytest.approx(b) for a, b in zip(on_chip, chip))  # and none of it is wasted
    assert lens.pixel <= 5e-5
    cheaper = CAMERAS[: CAMERAS.index(lens.camera)]
    for camera in cheaper:  # each of them resolves less than that
        least = max(max(field) / camera.columns, min(field) / camera.rows)
        assert least > 5e-5
    assert vision_station.LEAST_DISTANCE_M <= lens.distance <= vision_station.GREATEST_DISTANCE_M


def reject(sees="outline", drop=0.0, amplitude=0.21e-3):
    """The vision station of a block and its bowl; the track goes down by ``drop`` [deg] before it."""
    part = shapes.part(shapes.box(12.0, 8.0, 5.0), "block")
    before = (
        (make_device("spacing section", "b", angle=np.radians(-drop), text=f"-{drop} deg"),) if drop else ()
    )
    bare = follow_orientations(part, find(part), TRACK)
    wanted = next(one for one in bare.lying if one.posture.lies == "on its largest face")
    device = make_device("vision reject", "b", like=(wanted.aspect, wanted.heading, 1e-3), sees=sees)
    plain = bowls.default()
    drive = replace(plain.drive, amplitude=amplitude)
    bowl = replace(plain, track=TRACK, drive=drive, devices=(*before, device))
    (station,) = plan_vision_stations(bowl, bare.lying)
    return station, bowl, wanted, bare.lying


def test_the_valve_waits_for_the_way_to_the_nozzles_less_what_it_takes_itself():
    station, bowl, wanted, _ = reject()
    speed = answer(bowl).velocity
    assert station.speed == pytest.approx(speed)
    assert station.valve_delay == pytest.approx(10e-3 / speed)
    assert station.valve_setting == pytest.approx(10e-3 / speed - REACTION)
    steep, *_ = reject(drop=4.0)  # parts are faster down a spacing section: the valve is set for that speed
    assert steep.number == 2 and steep.speed > 1.2 * station.speed
    assert steep.valve_delay == pytest.approx(10e-3 / steep.speed)
    # the front of the wanted part meets the light barrier as its weight is at the sensor, or so long before
    way = station.sensor_at + float(wanted.outline[:, 0].max()) - station.trigger_at
    assert station.trigger_delay == pytest.approx(way / speed)
    assert station.trigger_at < station.sensor_at + station.valve_way


def test_ten_millimetres_at_77_mm_a_second_are_130_ms(monkeypatch):
    monkeypatch.setattr(vision_station, "travel_speed", lambda bowl: 0.077)
    station, bowl, wanted, _ = reject()
    inline = after_outlet.plan_inline_track(bowl, wanted, 0.077, 0.08)
    beside = beside_bowl.Beside((station,), (0.0,), inline)
    values = {row["what"]: row["value"] for row in beside_bowl.rows(beside)}
    assert values["valve delay"].startswith("10.0 mm at 77 mm/s: 130 ms; set 120 ms")
    (written,) = beside_bowl.document(beside)["vision_stations"]
    assert written["valve_delay_ms"] == pytest.approx(129.87, abs=0.01)
    assert written["optics"]["distance_mm"] == pytest.approx(1e3 * station.lens.distance)


def test_nothing_moves_by_half_the_resolution_while_the_shutter_is_open():
    for amplitude in (0.1e-3, 0.3e-3):
        station, bowl, *_ = reject(amplitude=amplitude)
        fastest = max(station.speed, 2.0 * np.pi * bowl.drive.frequency * amplitude)
        assert station.exposure * fastest == pytest.approx(0.5 * station.resolution)


def test_fibres_and_lasers_have_beams_and_profiles_in_place_of_a_lens():
    fibre, _, wanted, _ = reject("height")
    assert fibre.lens is None and fibre.beams == pytest.approx((wanted.height - 1e-3, wanted.height + 1e-3))
    laser, *_ = reject("relief")
    assert laser.lens is None and laser.profiles == pytest.approx(laser.speed / laser.resolution)


def test_brackets_are_screwed_on_above_every_part():
    station, *_, rows = reject()
    threaded = [hole for hole in station.holes if hole.thread]
    assert len(threaded) == 2 and all(hole.height > max(one.height for one in rows) for hole in threaded)


def test_the_gap_to_the_inline_track_leaves_room_for_the_stroke():
    _, bowl, wanted, _ = reject()
    for amplitude in (0.1e-3, 0.5e-3):
        moved = replace(bowl, drive=replace(bowl.drive, amplitude=amplitude))
        inline = after_outlet.plan_inline_track(moved, wanted, 0.05, 0.08)
        psi = bowl.drive.vibration_angle + bowl.track.climb
        assert inline.gap - amplitude * np.cos(psi) == pytest.approx(after_outlet.GAP_CLEARANCE_M)
        assert inline.step - amplitude * np.sin(psi) == pytest.approx(after_outlet.STEP_CLEARANCE_M)
        assert inline.height == pytest.approx(0.08 - inline.step)
    assert inline.width > np.ptp(wanted.outline[:, 1]) and not inline.lacks
    assert inline.gap < inline.low_at < inline.full_at < inline.length
    assert inline.dwell > wanted.length / 0.05  # one part that passes is not a full track
    # a part that bridges less than that needs another way across
    short = SimpleNamespace(
        **{name: getattr(wanted, name) for name in ("kind", "outline", "length", "height")}
    )
    short.gap = 1.5 * inline.gap
    assert "tongue" in after_outlet.plan_inline_track(moved, short, 0.05, 0.08).lacks
