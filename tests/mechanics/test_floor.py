"""A part on the floor: closed forms, Newton and Euler, rolling, the cycle against the two-burst velocity."""

from dataclasses import replace

import numpy as np
import pytest
from mechanics_samples import DEG, bowl, box_posture, rolling_posture
from scipy.optimize import brentq

from feederscrew.mechanics import cycle, floor_balance
from feederscrew.mechanics import motion_maps as floor_cells
from feederscrew.mechanics.floor_balance import solve_rolling
from feederscrew.screw import Wrench

G = 9.81


def drive_acceleration(settings):
    return settings.drive.amplitude * (2 * np.pi * settings.drive.frequency) ** 2


def test_normal_force_at_both_reversals():
    """Eqs. [4.14], [4.20]."""
    posture, settings = box_posture(), bowl()
    lift = drive_acceleration(settings) * np.sin(20 * DEG)
    found = floor_balance.motion(posture, settings, 0.0, np.array([0.5, 1.5]) * np.pi)
    assert found.normal_force == pytest.approx(posture.mass * np.array([G - lift, G + lift]))


def test_sliding_against_kinetic_friction():
    """Eqs. [4.16], [4.26], [4.28]."""
    settings = bowl(static=0.4, kinetic=0.25)
    push, lift = (drive_acceleration(settings) * f(20 * DEG) for f in (np.cos, np.sin))
    found = floor_balance.motion(box_posture(), settings, 0.0)
    assert floor_balance.MOTION_STATES[found.state] == "slide"
    assert found.acceleration == pytest.approx([push - 0.25 * (G - lift), 0.0])
    assert found.limiting_friction == pytest.approx(push / (G - lift))


def test_static_friction_holds_up_to_the_limit():
    posture = box_posture()
    limit = float(floor_balance.motion(posture, bowl(), 0.0).limiting_friction)
    for static, state in ((limit * (1 + 1e-9), "stick"), (limit * (1 - 1e-9), "slide")):
        found = floor_balance.motion(posture, bowl(static=static, kinetic=0.1), 0.0)
        assert floor_balance.MOTION_STATES[found.state] == state
    held = floor_balance.motion(posture, bowl(static=2.0), 0.7)
    assert held.acceleration == pytest.approx([0.0, 0.0], abs=1e-15)
    assert held.turning == 0.0


def test_friction_is_a_vector_against_the_drive():
    """A free part slides along the drive however it is turned; only its own axes turn."""
    settings = bowl(direction=25 * DEG)
    aligned = floor_balance.motion(box_posture(), settings, 25 * DEG)
    turned = floor_balance.motion(box_posture(), settings, -40 * DEG)
    size = np.hypot(*turned.acceleration)
    assert size == pytest.approx(np.hypot(*aligned.acceleration))
    assert np.arctan2(turned.acceleration[1], turned.acceleration[0]) == pytest.approx(65 * DEG)
    assert turned.limiting_friction == pytest.approx(aligned.limiting_friction)


def test_alignment_turns_towards_the_drive():
    """Eqs. [4.17], [4.23]."""
    posture, settings = box_posture(offset=2e-3), bowl(direction=30 * DEG)
    headings = np.radians(np.linspace(-170, 170, 35))
    turning = floor_balance.motion(posture, settings, headings).turning
    push = posture.mass * drive_acceleration(settings) * np.cos(20 * DEG)
    want = 2e-3 * push * np.sin(30 * DEG - headings) / posture.turning_inertia
    np.testing.assert_allclose(turning, want, rtol=1e-12, atol=1e-9)
    assert floor_balance.stable_heading(posture, settings) == pytest.approx(30 * DEG)
    behind = replace(posture, offset=-2e-3)
    assert floor_balance.stable_heading(behind, settings) == pytest.approx(30 * DEG + np.pi)
    assert np.isnan(floor_balance.stable_heading(box_posture(), settings))


@pytest.mark.parametrize("seed", range(5))
def test_newton_and_euler(seed):
    """All wrenches on the part make its momentum rate, whatever the inertia, the drive and the phase.

    Eqs. [4.14] to [4.19].
    """
    rng = np.random.default_rng(seed)
    base = rng.normal(size=(3, 3))
    inertia = 1e-7 * (base @ base.T + 3 * np.eye(3))
    posture = replace(box_posture(offset=rng.uniform(0, 3e-3)), inertia=inertia)
    settings = bowl(
        direction=rng.uniform(-3, 3), vibration_angle=rng.uniform(0, 0.5), static=rng.uniform(0.1, 0.9)
    )
    heading, phase = rng.uniform(-3, 3), cycle.phases(36)
    found = floor_balance.motion(posture, settings, heading, phase)
    drive = floor_balance.drive_force(posture, settings, heading, phase)
    nothing, weight = np.zeros((36, 1)), np.array([0.0, 0.0, -posture.mass * settings.gravity])
    normal = np.column_stack([np.zeros((36, 2)), found.normal_force])
    at_d = np.column_stack([found.offset, np.full(36, -posture.height)])
    friction = np.concatenate([found.friction, nothing], axis=1)
    below = np.array([0.0, 0.0, -posture.height])
    couple = np.column_stack([np.zeros((36, 2)), found.turning * posture.turning_inertia])
    total = (
        Wrench(drive + weight, np.zeros((36, 3)))
        + Wrench(normal, np.cross(at_d, normal))
        + Wrench(friction, np.cross(below, friction) + couple)
    )
    accelerated = posture.mass * np.concatenate([found.acceleration, nothing], axis=1)
    spun = found.turning[:, None] * inertia[:, 2]
    largest = np.abs(np.cross(at_d, normal)).max()
    np.testing.assert_allclose(
        total.resultant, accelerated, rtol=0, atol=1e-12 * np.abs(drive + weight).max()
    )
    np.testing.assert_allclose(total.moment, spun, rtol=0, atol=1e-10 * max(largest, np.abs(spun).max()))


def test_a_tall_part_tips_before_it_slides():
    """Tips where h R / N leaves the contact polygon: mu > half length / h."""
    tall = box_posture(length=0.004, width=0.004, height=0.02)
    state = floor_balance.motion(tall, bowl(static=0.9, kinetic=np.array([0.19, 0.21])), 0.0).state
    assert [floor_balance.MOTION_STATES[code] for code in state] == ["slide", "tip"]
    found = floor_balance.motion(tall, bowl(static=0.9, kinetic=0.15), 0.0)
    assert found.offset[0] == pytest.approx(0.01 * 0.15)
    assert found.inside == pytest.approx(0.002 - 0.0015)


def test_a_rolling_cylinder_needs_a_third_of_the_drive():
    posture, settings = rolling_posture(), bowl(direction=90 * DEG, static=0.4)
    push = posture.mass * drive_acceleration(settings) * np.cos(20 * DEG)
    found = floor_balance.motion(posture, settings, 0.0)
    assert found.friction == pytest.approx([0.0, -push / 3], abs=1e-15)
    assert found.acceleration == pytest.approx([0.0, push / posture.mass * 2 / 3], abs=1e-12)
    assert found.limiting_friction == pytest.approx(push / 3 / found.normal_force)
    assert floor_balance.MOTION_STATES[found.state] == "stick"
    assert np.abs(found.friction).max() < 0.4 * found.normal_force


def test_slip_of_a_rolling_part_opposes_its_friction():
    """The contact line accelerates exactly against friction of mu N."""
    posture, settings = rolling_posture(), bowl(direction=35 * DEG, static=0.2, kinetic=0.15)
    force = floor_balance.drive_force(posture, settings, 0.0)
    normal = np.array(posture.mass * 9.81 - force[2])
    found = solve_rolling(posture, settings.friction, force[:2], normal)
    spin = found.rolling_acceleration
    contact = found.acceleration + spin * posture.height * np.array([0.0, 1.0])
    assert np.hypot(*found.friction) == pytest.approx(0.15 * float(normal))
    assert contact @ found.friction == pytest.approx(-np.hypot(*contact) * np.hypot(*found.friction))
    about = -float(np.cross([0.0, 0.0, -posture.height], [*found.friction, 0.0])[0]) / posture.inertia[0, 0]
    assert abs(spin) == pytest.approx(abs(about))


def test_a_rolling_part_swings_with_the_drive():
    """v = -(2/3) A w cos(b) cos(w t) across its axis."""
    settings = bowl(direction=90 * DEG, static=0.9)
    over, course = floor_balance.over_cycle(rolling_posture(), settings, 0.0)
    want = -2 / 3 * 0.05e-3 * 2 * np.pi * 60 * np.cos(20 * DEG) * np.cos(cycle.phases())
    np.testing.assert_allclose(course.velocity, want, rtol=0, atol=1e-4 * want.max())
    assert floor_balance.regime(over.state) == "stick"


def two_burst_velocity(mu, beta, ratio):
    """v / (A w) of a level plate with sticking between the bursts, in closed form."""

    def burst(p):
        if p >= 1.0:
            return 0.0
        start = np.arcsin(p)
        end = brentq(lambda t: np.cos(start) - np.cos(t) - p * (t - start), np.pi - start, start + 2 * np.pi)
        swept = end - start
        return (np.sin(start) - np.sin(end) + np.cos(start) * swept - p * swept**2 / 2) / (2 * np.pi)

    onward, back = np.cos(beta) + mu * np.sin(beta), np.cos(beta) - mu * np.sin(beta)
    return onward * burst(mu / onward / ratio) - back * burst(mu / back / ratio)


@pytest.mark.parametrize("mu", [0.5, 0.6, 0.7])
def test_cycle_follows_the_two_burst_velocity(mu):
    settings = floor_balance.with_friction(bowl(), mu)
    ratio = drive_acceleration(settings) / G
    want = two_burst_velocity(mu, 20 * DEG, ratio) * settings.drive.amplitude * 2 * np.pi * 60
    for samples in (60, 360):
        _, course = floor_balance.over_cycle(box_posture(), settings, 0.0, samples)
        assert course.settled
        assert course.mean == pytest.approx(want, rel=1e-9)


def test_a_map_cell_is_the_single_answer():
    beta, mu = np.radians([10.0, 20.0, 30.0])[:, None], np.array([[0.1, 0.3]])
    posture, settings = box_posture(offset=1e-3), bowl(direction=10 * DEG, vibration_angle=beta)
    cells = floor_cells.floor_cells(posture, floor_balance.with_friction(settings, mu), 0.2)
    one = floor_balance.motion(
        posture, bowl(direction=10 * DEG, vibration_angle=30 * DEG, static=0.1, kinetic=0.1), 0.2
    )
    assert cells["acceleration_z_m_s2"][2, 0] == pytest.approx(float(one.acceleration[0]))
    assert cells["regime"][2, 0] == one.state


def test_a_map_past_the_hop_is_empty():
    """Figure 5-6's own values hop above asin(g / A w^2) = 7.9 deg."""
    settings = bowl(amplitude=0.5e-3, gravity=9.8, vibration_angle=np.radians([7.8, 8.0]))
    cells = floor_cells.floor_cells(box_posture(), settings, 0.0)
    assert np.isnan(cells["acceleration_z_m_s2"]).tolist() == [False, True]
    assert [floor_balance.MOTION_STATES[code] for code in cells["regime"]][1] == "hop"
