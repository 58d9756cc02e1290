"""Leaf springs against printed values, closed forms and a time integration of two bodies."""

from dataclasses import replace

import numpy as np
import pytest
import space_frame
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize
from two_masses import GIVEN, amplitude, driven

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.record import Unbalance, direction, vibration_angle
from feederscrew.machine import checks, drive_sizing, sizing, springs
from feederscrew.machine import sheet as machines
from feederscrew.machine.springs import analyse_springs, gain, leaf_stiffness, leaf_stress, rocking

BOWL = bowls.read(None, GIVEN)
MACHINE = BOWL.machine
POISSON, SHEAR = 0.3, 5.0 / 6.0
MACHINE_UNBALANCED = bowls.read(None, ("machine.base_mass=20 kg", "machine.base_inertia=0.3 kg m2")).machine


def test_the_leaves_angles_gain_and_strokes_of_the_page():
    """Stiffness by thickness, frequency by number, stress, and twist: 0.128 (L / r_s)^2 at a level drive."""
    made = [replace(MACHINE, leaf_thickness=1e-3 * t) for t in (2.0, 2.5, 3.0, 3.5, 4.0)]
    thick = [leaf_stiffness(one) / 1e3 for one in made]
    assert thick == pytest.approx([128.75, 251.46, 434.53, 690.02, 1030.0], abs=0.005)
    for leaves, free, held in ((9, 99.1, 89.0), (10, 104.4, 93.8), (12, 114.4, 102.7)):
        found = analyse_springs(replace(MACHINE, leaves=leaves))
        frequencies = found.natural_frequency_without_twist, found.natural_frequency_held
        assert frequencies == pytest.approx((free, held), abs=0.05)
        assert (found.effective_mass, found.effective_mass_held) == pytest.approx((5.841, 7.243), abs=5e-4)
        twisted = found.natural_frequency / found.natural_frequency_without_twist
        assert twisted == pytest.approx(np.sqrt(springs.twist(MACHINE)), rel=1e-12)
    assert leaf_stress(MACHINE, 0.35e-3) / 1e6 == pytest.approx(84.5, abs=0.05)
    level = replace(MACHINE, spring_angle=0.0, spring_radius=MACHINE.leaf_length)
    assert springs.twist(level) == pytest.approx(1.128, abs=5e-4)
    # Leaf 40 x 2.5 x 80 mm at 20 deg: 1.68 times where its middle is nearest to the axis, 2.40 at an end
    found = analyse_springs(MACHINE)
    plain = found.natural_frequency_without_twist
    assert found.natural_frequency_rigid / plain == pytest.approx(1.68, abs=0.01)
    assert found.natural_frequency_rigid_end / plain == pytest.approx(2.40, abs=0.01)
    assert found.natural_frequency / plain == pytest.approx(1.039, abs=0.001)
    # Angle over radius; gain of a natural frequency, and what 3 % of mass do; makers' strokes in g
    found = np.degrees(direction(MACHINE, np.array([0.05, 0.09, 0.15, 0.2])))
    assert found == pytest.approx([33.2, 20.0, 12.3, 9.3], abs=0.05)
    radii, angles = springs.angles(MACHINE, BOWL.track)
    assert {round(1e3 * r) for r in radii} >= {90, 150} and np.all(np.diff(angles) < 0.0)
    for natural, quality, factor in ((102.0, 23.0, 1.95), (105.0, 10.5, 1.38), (110.0, 5.7, 1.16)):
        before, after = gain(100.0, np.array([natural, natural / np.sqrt(1.03)]), 0.01)
        assert before == pytest.approx(quality, abs=0.05)
        assert after / before == pytest.approx(factor, abs=0.005)
    makers = (50, 2.0, 10.06), (60, 1.5, 10.87), (100, 0.6, 12.07), (120, 0.4, 11.59)
    for frequency, stroke_mm, ratio in makers:
        one = bowls.read(None, (f"drive.frequency={frequency} Hz", f"drive.peak_to_peak={stroke_mm} mm"))
        assert springs.stroke(one).acceleration / 9.81 == pytest.approx(ratio, abs=0.005)
        assert one.drive.amplitude <= springs.greatest_amplitude(one)


def integrated(machine, frequency, periods):
    """Way along the springs, rise and turn of a machine that 50 N drive, as the integration has them."""
    found = analyse_springs(machine)
    damping = 2.0 * machine.damping * np.sqrt(found.stiffness * found.effective_mass)
    waves = driven(machine, found.stiffness, damping, 50.0, frequency, periods)
    return found, [amplitude(wave) for wave in waves]


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_gain_and_angle_against_two_bodies_in_time(share):
    """A bowl empty and full: the closed forms within 1e-6 of an integration of rise and turn."""
    machine = replace(MACHINE, damping=0.04, base_inertia=0.4)
    fill = sizing.full_bowl(0.15, 0.09, 7850.0, BOWL.sizing)
    machine = sizing.loaded_bowl(machine, fill, share * BOWL.sizing.carried)
    found, (way, rise, turn) = integrated(machine, 100.0, 90)
    magnified = gain(100.0, found.natural_frequency, machine.damping)
    assert way == pytest.approx(50.0 / found.stiffness * magnified, rel=1e-6)
    for radius in (0.09, 0.15):
        assert rise / (radius * turn) == pytest.approx(np.tan(direction(machine, radius)), rel=1e-6)


def test_the_stroke_at_the_springs_moves_the_track_and_a_magnet_works_by_their_angle():
    """Rise and turn of the bowl give the way along the springs, base included."""
    machine, moved = BOWL.machine, springs.stroke(BOWL)
    rise = BOWL.drive.amplitude * np.sin(moved.angle)
    assert moved.springs * np.sin(machine.spring_angle) * 25 / 31 == pytest.approx(rise, rel=1e-9)
    both = moved.acceleration * np.array([np.cos(moved.angle), np.sin(moved.angle)])
    assert (moved.horizontal, moved.vertical) == pytest.approx(both)
    heavy, held = replace(MACHINE, base_mass=1e9, base_inertia=1e9), springs.held_fast(MACHINE)
    masses = [analyse_springs(one).effective_mass for one in (heavy, held)]
    assert masses[0] == pytest.approx(masses[1], rel=1e-7)
    # its power is pull times rise: as much as damping takes from the way along the springs
    found, drive, at = analyse_springs(MACHINE), 100.0, 0.2e-3
    force = found.stiffness * at / gain(drive, found.natural_frequency, MACHINE.damping)
    pull = springs.upright_pull(force, MACHINE)
    assert pull == pytest.approx(2.9238 * force, rel=1e-4)
    phase = 2.0 * np.pi * np.arange(720) / 720
    along = np.cos(phase)  # velocity along the springs, of any amplitude
    rise = along * np.sin(np.radians(20))
    assert np.mean(pull * np.cos(phase) * rise) == pytest.approx(np.mean(force * np.cos(phase) * along))


@given(factor=st.floats(0.1, 10.0))
def test_a_machine_scaled_in_size_keeps_its_angles(factor):
    """Lengths times s, masses times s^3, inertias times s^5: the frequency falls as 1 / s."""
    power = {"bowl_mass": 3, "base_mass": 3, "bowl_inertia": 5, "base_inertia": 5}
    power |= dict.fromkeys(("spring_radius", "leaf_width", "leaf_thickness", "leaf_length"), 1)
    scaled = {name: getattr(MACHINE, name) * factor**exponent for name, exponent in power.items()}
    large = replace(MACHINE, **scaled)
    frequencies = [analyse_springs(one).natural_frequency for one in (large, MACHINE)]
    assert frequencies[0] * factor == pytest.approx(frequencies[1])
    assert direction(large, 0.1 * factor) == pytest.approx(direction(MACHINE, 0.1))


def test_the_sets_that_tune():
    found = springs.tuned_leaf_sets(MACHINE, 99.0, 1e-4, BOWL.sizing)
    assert all(0.03 <= one.detuning <= 0.08 for one in found)
    assert (2.5e-3, 9) in {(one.thickness, one.leaves) for one in found}
    assert {one.leaves % 3 for one in found} == {0}
    assert max(one.leaves for one in found) <= 3 * springs.MOST_A_BANK
    assert {one.thickness for one in found} <= {*springs.THICKNESSES, MACHINE.leaf_thickness}
    rules = replace(BOWL.sizing, banks=4.0)
    longer = [replace(MACHINE, leaf_length=length) for length in springs.LEAF_LENGTHS_M]
    fours = [one for machine in longer for one in springs.tuned_leaf_sets(machine, 100.0, 1e-4, rules)]
    assert fours and {one.leaves % 4 for one in fours} == {0}
    rows = springs.leaf_changes(MACHINE, 100.0, 1e-4, 3)
    assert [(one.name, one.leaves) for one in rows] == [
        ("as it is", 10), ("a leaf more a bank", 13), ("a leaf less a bank", 7), ("leaves 0.5 mm thicker", 10)
    ]  # fmt: skip
    assert len(springs.leaf_changes(replace(MACHINE, leaves=3), 100.0, 1e-4, 3)) == 3


@pytest.mark.parametrize(("frequency", "mean"), [(50.0, 0.75), (60.0, 0.75), (100.0, 1.0), (73.0, 1.0)])
def test_the_mean_of_a_magnets_pull_is_that_of_its_flux_squared(frequency, mean):
    """It was the amplitude on every supply. On the half wave flux is the integral of the mains' sine."""
    turn = 2.0 * np.pi * (np.arange(720) + 0.5) / 720
    pull = (1.0 - np.cos(turn)) ** 2 if frequency in (50.0, 60.0) else 1.0 - np.cos(turn)
    amplitude = -2.0 * np.mean(pull * np.cos(turn))
    assert springs.mean_pull(amplitude, frequency) == pytest.approx(np.mean(pull), rel=1e-9)
    assert springs.mean_pull(1.0, frequency) == mean


@pytest.mark.parametrize("frequency", [50.0, 60.0, 100.0, 120.0])
@pytest.mark.parametrize("radius", [0.1, 0.15, 0.25])
@pytest.mark.parametrize("degrees", [15.0, 20.0, 30.0])
def test_leaves_are_as_makers_stock_them(radius, frequency, degrees):
    """At most four in a bank, 1 to 4 mm thick, tuned 5.5 to 8 % above the drive, and they last."""
    track = replace(BOWL.track, radius=radius, climb=np.radians(3.0))
    omega = 2.0 * np.pi * frequency
    amplitude = 2.3 * BOWL.gravity / (omega**2 * np.sin(np.radians(degrees)))  # at a throw number of 2.3
    drive = replace(BOWL.drive, frequency=frequency, amplitude=amplitude, vibration_angle=np.radians(degrees))
    bowl = replace(BOWL, track=track, drive=drive)
    bowl = replace(bowl, machine=drive_sizing.machine_on(bowl, (), exact=True))
    made = drive_sizing.on_leaves(bowl, ())
    natural = analyse_springs(made).natural_frequency
    assert 1.055 <= natural / frequency <= 1.08
    assert made.leaves % 3 == 0 and made.leaves <= 12
    assert 1e-3 <= made.leaf_thickness <= 4e-3 and 60e-3 <= made.leaf_length <= 260e-3
    bowl = replace(bowl, machine=made)
    assert leaf_stress(made, springs.stroke(bowl).springs) <= BOWL.sizing.fatigue_stress
    assert drive_sizing.drive_shortfall(bowl, frozenset()) == "" == drive_sizing.leaf_shortfall(bowl)


@pytest.mark.parametrize(("part", "more", "given", "why"), [
    ("sizing", {}, (), None),
    ("sizing", {"fatigue_stress": 1.0}, (), "bend to"),
    ("drive", {"vibration_angle": np.radians(50.0)}, (), "at the track"),
    ("machine", {"leaves": 30.0}, ("machine.leaves",), "% above the drive"),
    ("machine", {"damping": 0.5}, (), "have to pull"),  # on a track of 400 mm
])  # fmt: skip
def test_a_drive_that_no_machine_makes_says_why(part, more, given, why):
    radius = 0.4 if "damping" in more else 0.15
    bowl = replace(BOWL, track=replace(BOWL.track, radius=radius, climb=np.radians(3.0)))
    other = replace(bowl, **{part: replace(getattr(bowl, part), **more)})
    said = drive_sizing.drive_shortfall(other, frozenset(given))
    assert said == "" if why is None else why in said


def test_the_stroke_as_a_bowl_empties():
    """From full to empty it falls, and amplitude control holds it while the controller reaches."""
    fill = sizing.full_bowl(0.15, 0.09, 7850.0, replace(BOWL.sizing, fill_height=1 / 3))
    assert fill.volume == pytest.approx(np.pi * 0.15**2 * 0.03)
    assert fill.mass == pytest.approx(fill.volume * 0.5 * 7850.0)
    found = sizing.emptying(moved(leaves=12), fill)
    assert (found.levels[0], found.levels[-1], found.strokes[-1]) == (1.0, 0.0, 1.0)
    assert np.all(np.diff(found.strokes) < 0.0) and np.all(found.controlled == 1.0)
    below = sizing.emptying(moved(leaves=6), fill)
    assert below.strokes[0] < 1.0 and below.controlled[0] == pytest.approx(min(1.0, below.strokes[0] / 0.8))


@pytest.mark.parametrize("leaves, carried", [(12, 0.05), (6, 0.02)])
def test_a_bowl_whose_speed_drifts_as_it_empties_is_warned_of(leaves, carried):
    """Of its speed when empty, by more than it is to be tuned again for: a full one is faster, or slower."""

    def sheet_with(retune):
        texts = f"machine.leaves={leaves}", f"sizing.carried={carried}", f"sizing.retune={retune}"
        return machines.machine(bowls.settings(None, texts))

    speeds = sheet_with(0.15).velocities
    drift = speeds[0] / speeds[-1] - 1.0
    assert drift > 0.1 if leaves == 12 else drift < -0.1
    for limit, is_warned in ((0.97 * abs(drift), True), (1.03 * abs(drift), False)):
        warned = [one for one in checks.remarks(sheet_with(limit)) if one.startswith("sizing.carried: ")]
        assert bool(warned) == is_warned
        for speed in (speeds[0], speeds[-1]) if is_warned else ():
            assert f"{1e3 * speed:.3g} mm/s" in warned[0]


def moved(frequency=100.0, **more):
    """The bowl in the direction in which its springs move its track."""
    machine = replace(MACHINE, **more)
    angle = float(vibration_angle(machine, BOWL.track.radius, BOWL.track.climb))
    drive = replace(BOWL.drive, vibration_angle=angle, frequency=frequency)
    return replace(BOWL, machine=machine, drive=drive)


@pytest.mark.parametrize("frequency, leaves", [(100.0, 10), (50.0, 8)])
def test_the_stroke_of_the_bowl_from_full_to_empty_against_two_bodies_in_time(frequency, leaves):
    """Rise and turn of the bowl itself at its track: what parts in it take from its share is in neither."""
    bowl = moved(frequency, leaves=leaves, damping=0.04, base_inertia=0.4)
    fill = sizing.full_bowl(0.15, 0.09, 7850.0, bowl.sizing)
    told, ways = sizing.emptying(bowl, fill), []
    for share in (1.0, 0.0):
        machine = sizing.loaded_bowl(bowl.machine, fill, share * bowl.sizing.carried)
        ways.append(integrated(machine, frequency, 36)[1] * np.array([1.0, 1.0, bowl.track.radius]))
    full, empty = ways
    strokes = np.hypot(full[1], full[2]) / np.hypot(empty[1], empty[2])
    assert told.strokes[0] == pytest.approx(strokes, rel=2e-4)
    assert told.springs[0] == pytest.approx(full[0] / empty[0], rel=2e-4)
    assert abs(told.springs[0] / told.strokes[0] - 1.0) > 0.02
    assert told.angles[0] == pytest.approx(np.arctan2(full[1], full[2]) - bowl.track.climb, rel=2e-4)
    assert abs(told.angles[0] - told.angles[-1]) > 1e-4


def framed(machine, offset, clamps=1.0, turn=1.0):
    """Stiffness of one leaf as a space frame whose lower end is held and whose upper one moves on [N/m].

    ``offset`` [m] of its middle from the point that is nearest to the axis; ``clamps`` is the share of the
    leaf's stiffness in its own plane that they leave it, ``turn`` the share of the bowl's turn.
    """
    psi, radius, long = machine.spring_angle, machine.spring_radius, machine.leaf_length
    b, t, e = machine.leaf_width, machine.leaf_thickness, machine.leaf_modulus
    g = e / (2.0 * (1.0 + POISSON))
    outward, leaf = np.array([1.0, 0.0, 0.0]), np.array([0.0, -np.sin(psi), np.cos(psi)])
    nodes = radius * outward + (offset + long * np.linspace(-0.5, 0.5, 9))[:, None] * leaf
    about = np.array([0.0, 0.0, turn * np.cos(psi) / radius])  # of the axis, at 1 m/s along the springs
    moved = np.cross(about, nodes[-1]) + np.array([0.0, (1.0 - turn) * np.cos(psi), np.sin(psi)])
    own_plane = clamps * e * t * b**3 / 12.0
    section = e * b * t, SHEAR * g * b * t, g * b * t**3 / 3.0, own_plane, e * b * t**3 / 12.0
    return space_frame.energy(nodes, outward, section, [*moved, *about])


@pytest.mark.parametrize("psi, thick", [(10.0, 2.5), (20.0, 2.5), (30.0, 2.5), (20.0, 1.0), (45.0, 1.5)])
@pytest.mark.parametrize("at_an_end", [0.0, 1.0, -1.0])
def test_a_leaf_twists_and_rigid_clamps_bend_it_in_its_own_plane(psi, thick, at_an_end):
    """As a space frame has it. The twist was 1 + (G / 3 E) (L / r)^2 cos^2 psi: of the whole turn."""
    one = replace(MACHINE, spring_angle=np.radians(psi), leaf_thickness=1e-3 * thick)
    offset = 0.5 * at_an_end * one.leaf_length
    plain, twisted = leaf_stiffness(one), springs.twist(one)
    sheared = 1.0 / (1.0 + 2.0 * (1.0 + POISSON) / SHEAR * (thick / 80.0) ** 2)  # E b t^3 / L^3: 1
    soft = 1e-9  # the clamps that the program takes do not hold a leaf in its own plane
    assert framed(one, offset, soft, turn=0.0) == pytest.approx(plain * sheared, rel=1e-6)
    assert framed(one, offset, soft) == pytest.approx(plain * (sheared + twisted - 1.0), rel=1e-6)
    rigid = plain * (sheared + twisted - 1.0 + springs.in_plane(one, offset))
    assert framed(one, offset) == pytest.approx(rigid, rel=1e-6)


def test_the_twist_of_the_sixty_degree_example():
    """Leaf of 90 mm at 96 mm, 30 deg: 1.0634, where the whole turn gave 1.0845; 104.6 Hz for 105.6."""
    one = replace(MACHINE, spring_angle=np.radians(30.0), leaf_length=90e-3, spring_radius=96e-3)
    assert springs.twist(one) == pytest.approx(1.0634, abs=5e-5)
    assert np.sqrt(springs.twist(one) / 1.0845) * 105.6 == pytest.approx(104.6, abs=0.05)


def cloud(rng, turns=1.0):
    """Points of a lopsided bowl [m] with their masses [kg], and the machine that knows them."""
    at = rng.uniform(-0.15, 0.15, (40, 3)) + [0.02, -0.03, 0.15]
    kg = rng.uniform(0.05, 0.25, 40)
    x, y, z = at.T
    known = Unbalance(
        moment=tuple((kg[:, None] * at).sum(axis=0)),
        upright=(float((kg * (y**2 + z**2)).sum()), float((kg * (x**2 + z**2)).sum())),
        products=(float((kg * y * z).sum()), float((kg * x * z).sum()), float((kg * x * y).sum())),
        turns=turns,
    )
    inertia = float((kg * (x**2 + y**2)).sum())
    return at, kg, replace(MACHINE_UNBALANCED, bowl_mass=kg.sum(), bowl_inertia=inertia, unbalance=known)


def base(machine):
    """Points of the base: eight of a round plate of steel, that has its inertia about every axis."""
    mass, inertia = machine.base_mass, machine.base_inertia
    thick = mass / (springs.BASE_DENSITY * np.pi * 2.0 * inertia / mass)
    low = -machine.leaf_length * np.cos(machine.spring_angle) - 0.5 * thick
    r, h = np.sqrt(inertia / mass), thick / np.sqrt(12.0)
    theta = 0.5 * np.pi * np.arange(4)
    ring = np.column_stack([r * np.cos(theta), r * np.sin(theta), np.zeros(4)])
    return np.concatenate([ring + [0, 0, low - h], ring + [0, 0, low + h]]), np.full(8, mass / 8.0)


def least_energy(machine, at, kg):
    """Motion of the bowl (6,) and energy [J] of both bodies where that is least, at 1 m/s between them."""
    psi, upwards = machine.spring_angle, np.array([0.0, 0.0, 1.0])
    along = np.sin(psi) * upwards
    spin = machine.unbalance.turns * np.cos(psi) / machine.spring_radius * upwards
    feet, weights = base(machine)

    def energy(base_moves):
        v, w = base_moves[:3], base_moves[3:]
        below = v + np.cross(w, feet)
        above = v + along + np.cross(w + spin, at)
        return 0.5 * (weights[:, None] * below**2).sum() + 0.5 * (kg[:, None] * above**2).sum()

    found = minimize(energy, np.zeros(6), method="BFGS", options={"gtol": 1e-12, "maxiter": 500})
    return np.concatenate([found.x[:3] + along, found.x[3:] + spin]), found.fun


@pytest.mark.filterwarnings("ignore:.*precision loss")
@pytest.mark.parametrize("turns", [1.0, -1.0])
def test_the_motion_of_least_energy(turns, rng):
    at, kg, machine = cloud(rng, turns)
    motion, energy = least_energy(machine, at, kg)
    assert springs.unbalanced_effective_mass(machine) == pytest.approx(2.0 * energy, rel=1e-8)
    found = rocking(machine, 0.15, 0.08)
    theta = 2.0 * np.pi * np.arange(3600) / 3600
    ring = np.column_stack([0.15 * np.cos(theta), 0.15 * np.sin(theta), np.full(3600, 0.08)])
    strokes = np.sqrt(((motion[:3] + np.cross(motion[3:], ring)) ** 2).sum(axis=1))
    strokes /= np.sqrt((strokes**2).mean())
    assert (found.least, found.greatest) == pytest.approx((strokes.min(), strokes.max()), rel=1e-4)
    assert found.greatest > 1.05  # it is a bad one
    assert abs((found.angle - theta[strokes.argmax()] + np.pi) % (2 * np.pi) - np.pi) < 0.02
    weight = 0.4, (-0.1, 0.12, 0.05)  # a weight is a point more of the cloud
    _, energy = least_energy(machine, np.concatenate([at, [weight[1]]]), np.append(kg, weight[0]))
    assert rocking(machine, 0.15, 0.08, weight).effective_mass == pytest.approx(2.0 * energy, rel=1e-8)


def test_an_uneven_bowl_moves_less_mass_and_a_weight_steadies_it(rng):
    """On a base that is held, a screw is all that is left: the place of the mass is in the inertia."""
    _, kg, machine = cloud(rng)
    found = analyse_springs(machine)
    assert found.effective_mass < springs.centred_mass(machine)
    assert found.effective_mass_held == pytest.approx(
        springs.centred_mass(springs.held_fast(machine)), rel=1e-12
    )
    balanced = analyse_springs(replace(machine, unbalance=Unbalance()))
    assert found.natural_frequency > balanced.natural_frequency
    x, y, z = machine.unbalance.moment
    off = np.hypot(x, y)
    weight = off / 0.2, (-0.2 * x / off, -0.2 * y / off, z / kg.sum())
    as_is, balanced = rocking(machine, 0.15, 0.08), rocking(machine, 0.15, 0.08, weight)
    assert balanced.greatest - balanced.least < 0.5 * (as_is.greatest - as_is.least)
    full = sizing.loaded_bowl(machine, sizing.Fill(1e-3, 2.0, 0.02), 0.5)  # a fill lies evenly
    assert full.unbalance.moment == machine.unbalance.moment
    gained = np.subtract(full.unbalance.upright, machine.unbalance.upright)
    assert gained == pytest.approx([0.005, 0.005])
    with pytest.raises(FeederError, match=r"^machine.bowl_inertia: 0.0001 kg m2 is less than"):
        springs.unbalanced_effective_mass(replace(machine, bowl_inertia=1e-4))
    even = replace(MACHINE_UNBALANCED, unbalance=Unbalance((0.0, 0.0, 0.3), (0.05, 0.05)))
    assert springs.is_even(even) and analyse_springs(even) == analyse_springs(MACHINE_UNBALANCED)
    assert springs.unbalanced_effective_mass(even) == pytest.approx(springs.centred_mass(even), rel=1e-12)
    found = rocking(even, 0.1, 0.05)
    assert (found.least, found.greatest) == pytest.approx((1.0, 1.0), abs=1e-12)
