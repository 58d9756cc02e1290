"""Bowl and base on inclined leaf springs: stiffness, effective mass, natural frequency, gain.

How a bowl whose centre of mass is off its axis rocks; sets of leaves that tune a bowl to its drive.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from feederscrew.base.arrays import Floats
from feederscrew.base.columns import Column
from feederscrew.base.errors import FeederError
from feederscrew.base.geometry.vectors import cross, determinant, dot
from feederscrew.base.units import MM
from feederscrew.bowl.record import Bowl, Machine, Sizing, Track, direction, shares
from feederscrew.part.mass import shift_inertia

BASE_DENSITY = 7850.0  # [kg/m3] of the base, taken as a round plate of it
RIM_SAMPLES = 360  # round the bowl at which its stroke is computed


@dataclass(frozen=True)
class Rocking:
    """The stroke round a bowl, over that of one which is balanced."""

    least: float  # [1]
    greatest: float  # [1]
    angle: float  # [rad] about Z where it is greatest
    effective_mass: float  # [kg]


ROCKING_COLUMNS: tuple[Column[Rocking], ...] = (
    Column("stroke_round_least", lambda rocking: rocking.least),
    Column("stroke_round_greatest", lambda rocking: rocking.greatest),
)


@dataclass(frozen=True, eq=False)
class _Body:
    """A rigid body about a point of the bowl's axis at the upper ends of the leaves."""

    mass: float  # [kg]
    moment: Floats  # (3,) [kg m]
    inertia: Floats  # (3, 3) [kg m2]

    def momentum(self, speed: Floats, spin: Floats) -> tuple[Floats, Floats]:
        """Momentum (3,) [kg m/s] and moment of it (3,) [kg m2/s] of a motion."""
        along = self.mass * speed + cross(spin, self.moment)
        return along, cross(self.moment, speed) + dot(self.inertia, spin)

    def motion(self, along: Floats, around: Floats) -> tuple[Floats, Floats]:
        """Motion that has a momentum: speed (3,) of the point, spin (3,)."""
        centre = self.moment / self.mass
        columns = shift_inertia(self.inertia, -self.mass, centre).T
        right = around - cross(centre, along)  # solved by Cramer's rule
        rows = [[right if k == j else columns[k] for k in range(3)] for j in range(3)]
        spin = np.array([determinant(row) for row in rows]) / determinant(columns)
        return along / self.mass - cross(spin, centre), spin


def is_even(machine: Machine) -> bool:
    """Tell whether nothing is known of a bowl that would rock it.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    bool
    """
    unbalance = machine.unbalance
    return not any((*unbalance.moment[:2], *unbalance.products))


def unbalanced_effective_mass(machine: Machine) -> float:
    """Return the mass that moves against the springs, of a bowl whose centre may be off its axis.

    It is twice the energy of both bodies over the square of the speed between them along the springs.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [kg]

    References
    ----------
    Two bodies that move in a screw; docs/method/bowl.md.
    """
    rise, turn = _screw(machine)
    along, around = _bowl(machine).momentum(*_bowl_motion(machine, _bowl(machine)))
    return float(dot(rise, along) + dot(turn, around))


def rocking(
    machine: Machine, radius: float, height: float, weight: tuple[float, ArrayLike] | None = None
) -> Rocking:
    """Compute how the stroke of a bowl whose centre of mass is off its axis differs round that axis.

    Bowl and base have no momentum together: (M1 + M2) V1 = M2 S. M are the 6 x 6 inertias of bowl and base,
    V1 is the motion of the bowl, and S the screw between both, that of the leaves. The effective mass is S .
    M1 V1. The stroke is taken at ``RIM_SAMPLES`` places of a rim, over its root mean square.

    Parameters
    ----------
    machine : Machine
    radius : float [m]
        Of the rim.
    height : float [m]
        Of the rim over the upper ends of the leaves.
    weight : (float [kg], (3,) array_like [m]), optional
        Mass and place of what is put on the bowl to balance it; the place is from the same level.

    Returns
    -------
    Rocking

    Raises
    ------
    FeederError
        If the inertia of the bowl is less than its mass has off its axis.

    References
    ----------
    Own; two bodies that move in a screw.
    """
    bowl = _bowl(machine)
    if weight is not None:
        mass, place = weight[0], np.array(weight[1])
        inertia = shift_inertia(bowl.inertia, mass, place)
        bowl = _Body(bowl.mass + mass, bowl.moment + mass * place, inertia)
    speed, spin = _bowl_motion(machine, bowl)
    theta = 2.0 * np.pi * np.arange(RIM_SAMPLES) / RIM_SAMPLES
    places = np.column_stack([radius * np.cos(theta), radius * np.sin(theta), np.full(RIM_SAMPLES, height)])
    moved = speed + cross(spin, places)
    strokes = np.sqrt(dot(moved, moved))
    # the root mean square round the rim stands for the stroke of a balanced bowl
    mean = np.sqrt(dot(strokes, strokes) / RIM_SAMPLES)
    rise, turn = _screw(machine)
    along, around = bowl.momentum(speed, spin)
    return Rocking(
        least=float(strokes.min() / mean),
        greatest=float(strokes.max() / mean),
        angle=float(theta[int(np.argmax(strokes))]),
        effective_mass=float(dot(rise, along) + dot(turn, around)),
    )


def both_rocking_modes(bowl: Bowl, solid: Any) -> tuple[Rocking, Rocking] | None:
    """Return the stroke round a bowl where its track ends, as it is and with the weight that balances it.

    Parameters
    ----------
    bowl : Bowl
    solid : BowlSolid
        Its outlet and the balancing weight.

    Returns
    -------
    (Rocking, Rocking) or None
        None where the machine was not computed with the BowlSolid: nothing is known then that would rock it.
    """
    plan, under = solid.plan, bowl.machine
    if is_even(under):
        return None
    at = bowl.track.radius, plan.outlet_height - plan.underside
    return rocking(under, *at), rocking(under, *at, solid.weight)


def _screw(machine: Machine) -> tuple[Floats, Floats]:
    """Speed and spin between bowl and base, of the unit of speed along the springs."""
    turn = machine.unbalance.turns * np.cos(machine.spring_angle) / machine.spring_radius
    return np.array([0.0, 0.0, np.sin(machine.spring_angle)]), np.array([0.0, 0.0, turn])


def _bowl(machine: Machine) -> _Body:
    unbalance = machine.unbalance
    yz, xz, xy = unbalance.products
    inertia = np.array(
        [[unbalance.upright[0], -xy, -xz], [-xy, unbalance.upright[1], -yz], [-xz, -yz, machine.bowl_inertia]]
    )
    moment = np.array(unbalance.moment)
    if (moment[:2] ** 2).sum() >= machine.bowl_mass * machine.bowl_inertia:
        what = f"{machine.bowl_inertia:.4g} kg m2 is less than the mass of the bowl has off its axis"
        raise FeederError("machine.bowl_inertia", what, "give that of the bowl as it is, or leave it out")
    return _Body(machine.bowl_mass, moment, inertia)


def _bowl_motion(machine: Machine, bowl: _Body) -> tuple[Floats, Floats]:
    """Motion of the bowl where it and its base together have no momentum: (M1 + M2) V1 = M2 screw."""
    # the base: a round plate of steel below the lower ends of the leaves
    mass, inertia = machine.base_mass, machine.base_inertia
    thick = mass**2 / (2.0 * np.pi * BASE_DENSITY * inertia)
    low = -machine.leaf_length * np.cos(machine.spring_angle) - 0.5 * thick
    across = 0.5 * inertia + mass * (thick**2 / 12.0 + low**2)
    base = _Body(mass, np.array([0.0, 0.0, mass * low]), np.diag([across, across, inertia]))
    both = _Body(bowl.mass + base.mass, bowl.moment + base.moment, bowl.inertia + base.inertia)
    return both.motion(*base.momentum(*_screw(machine)))


MAINS = (50.0, 60.0)  # [Hz]
HALF_WAVE = 0.75  # [1] of its amplitude: mean pull of a magnet on the half wave, (1 + 1 / 2) / 2
SHEAR_SHARE = 5.0 / 6.0  # [1] of a rectangle that carries shear, after Timoshenko
POISSON = 0.3  # [1] of steel; the twist of a leaf depends on it through G / E = 1 / (2 (1 + nu))


@dataclass(frozen=True)
class Springs:
    """Stiffness, moving mass and natural frequencies of bowl and base on their leaves."""

    leaf_stiffness: float  # [N/m] of one leaf, both ends guided
    stiffness: float  # [N/m] of all leaves, their twist included
    twist: float  # [1] stiffness with twist over that without
    effective_mass: float  # [kg] that moves against the springs
    effective_mass_centred: float  # [kg] were the centre of mass on the axis
    effective_mass_held: float  # [kg] the same with the base held fast
    natural_frequency: float  # [Hz]
    natural_frequency_without_twist: float  # [Hz]
    natural_frequency_held: float  # [Hz] without twist, the base held fast
    natural_frequency_rigid: float  # [Hz] with twist, were the clamps rigid in the plane of a leaf
    natural_frequency_rigid_end: float  # [Hz] the same where an end of a leaf is nearest to the axis


def analyse_springs(machine: Machine) -> Springs:
    """Compute what the springs of a machine make of it: stiffness, moving mass, natural frequencies.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    Springs
    """
    leaf = leaf_stiffness(machine)
    plain, twisted = machine.leaves * leaf, twist(machine)
    mass, held = effective_mass(machine), centred_mass(held_fast(machine))
    end = 0.5 * machine.leaf_length
    return Springs(
        leaf_stiffness=leaf,
        stiffness=plain * twisted,
        twist=twisted,
        effective_mass=mass,
        effective_mass_centred=centred_mass(machine),
        effective_mass_held=held,
        natural_frequency=natural_frequency(plain * twisted, mass),
        natural_frequency_without_twist=natural_frequency(plain, mass),
        natural_frequency_held=natural_frequency(plain, held),
        natural_frequency_rigid=natural_frequency(plain * (twisted + in_plane(machine)), mass),
        natural_frequency_rigid_end=natural_frequency(plain * (twisted + in_plane(machine, end)), mass),
    )


def leaf_stiffness(machine: Machine) -> float:
    """Return the stiffness of one leaf with both ends guided: E b t^3 / L^3.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [N/m]

    References
    ----------
    Euler and Bernoulli's beam.
    """
    ratio = machine.leaf_thickness / machine.leaf_length
    return machine.leaf_modulus * machine.leaf_width * ratio**3


def leaf_stress(machine: Machine, amplitude: float) -> float:
    """Return the amplitude of bending stress in a leaf, 3 E t delta / L^2.

    Both ends are guided: the bending moment is largest at the clamps, 6 E I delta / L^2, on a section of
    modulus b t^2 / 6.

    Parameters
    ----------
    machine : Machine
    amplitude : float [m]
        delta: half the stroke between bowl and base, at the springs and along their motion.

    Returns
    -------
    float [Pa]

    References
    ----------
    Euler and Bernoulli's beam.
    """
    return 3.0 * machine.leaf_modulus * machine.leaf_thickness * amplitude / machine.leaf_length**2


def upright_pull(force: float, machine: Machine) -> float:
    """Return the amplitude of the pull of an upright magnet that does what a force along the motion does.

    F / sin psi: the motion of the springs rises at their angle psi, so an upright pull works by its sine.

    Parameters
    ----------
    force : float [N]
        Amplitude along the motion of the springs.
    machine : Machine

    Returns
    -------
    float [N]

    References
    ----------
    Equal work of two forces along one motion.
    """
    return float(force / np.sin(machine.spring_angle))


def mean_pull(pull: float, frequency: float) -> float:
    """Return the mean of a magnet's pull.

    The mean is as large as the amplitude on the full wave. It is three quarters of it on the half wave, which
    drives at the frequency of the mains: there the flux goes with 1 - cos(w t), and its square is 3/2 - 2
    cos(w t) + cos(2 w t) / 2, whose constant part is three quarters of the part that drives. What a converter
    feeds is taken as the full wave.

    Parameters
    ----------
    pull : float [N]
        Amplitude at the frequency of the drive.
    frequency : float [Hz]
        Of the drive. 50 and 60 Hz are taken as the half wave of the mains.

    Returns
    -------
    float [N]

    References
    ----------
    The pull goes with the square of the flux, and the flux with the integral of the voltage.
    """
    return pull * (HALF_WAVE if any(abs(frequency - mains) < 1e-6 for mains in MAINS) else 1.0)


def twist(machine: Machine) -> float:
    """Return by how much the twist of its leaves stiffens a bank.

    1 + (G / 3 E) (L / r_s)^2 cos^4 psi. A bowl that moves by d along the springs turns by d cos psi / r_s.
    The leaf leans by psi from the bowl's axis: the component of the turn along it, which twists it, is less
    by another cos psi. It enters the energy with its square. The component across the leaf bends it in its
    own plane: ``in_plane``.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [1]

    References
    ----------
    Saint-Venant's torsion of a thin strip, G b t^3 / 3. A space frame of beam elements with six degrees of
    freedom a node gives the same (``tests/machine/test_springs.py``). What the strip leaves out:
    docs/method/bowl.md.
    """
    lever = machine.leaf_length / machine.spring_radius * np.cos(machine.spring_angle) ** 2
    return float(1.0 + lever**2 / (6.0 * (1.0 + POISSON)))


def in_plane(machine: Machine, offset: float = 0.0) -> float:
    """Return by how much in-plane bending stiffens a bank of rigid clamps, over that without twist.

    (b L / (t r_s))^2 sin^2 psi cos^2 psi / 12 times 1 + 12 e^2 / (L^2 (1 + Phi)), with Phi = 2 (1 + nu) b^2 /
    (kappa L^2). Real clamps yield, so the value is an upper end.

    Parameters
    ----------
    machine : Machine
    offset : float [m]
        e: from the middle of a leaf, along it, to the point that is nearest to the bowl's axis; half the
        length of the leaf where one of its ends is.

    Returns
    -------
    float [1]

    References
    ----------
    Timoshenko's beam, bent about its stiff axis.
    """
    wide, long, angle = machine.leaf_width, machine.leaf_length, machine.spring_angle
    lever = wide * long / (machine.leaf_thickness * machine.spring_radius)
    shear = 2.0 * (1.0 + POISSON) * wide**2 / (SHEAR_SHARE * long**2)
    half_width = 1.0 + 12.0 * offset**2 / (long**2 * (1.0 + shear))
    return float((lever * np.sin(angle) * np.cos(angle)) ** 2 / 12.0 * half_width)


def effective_mass(machine: Machine) -> float:
    """Return the mass that moves against the springs; the centre of mass may lie off the axis.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [kg]
    """
    return centred_mass(machine) if is_even(machine) else unbalanced_effective_mass(machine)


def centred_mass(machine: Machine) -> float:
    """Return the mass that moves against the springs where the centre of mass is on the axis.

    m1 m2 / (m1 + m2) sin^2 psi + [I1 I2 / (I1 + I2)] / r_s^2 cos^2 psi.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [kg]

    References
    ----------
    The kinetic energy of two free bodies.
    """
    rise, turn = shares(machine)
    along = machine.bowl_mass * rise * np.sin(machine.spring_angle) ** 2
    around = machine.bowl_inertia * turn * (np.cos(machine.spring_angle) / machine.spring_radius) ** 2
    return float(along + around)


def held_fast(machine: Machine) -> Machine:
    """Return the machine on a base that does not move: one of 1e12 times the bowl's mass and inertia.

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    Machine
    """
    return replace(machine, base_mass=1e12 * machine.bowl_mass, base_inertia=1e12 * machine.bowl_inertia)


def natural_frequency(stiffness: float, mass: float) -> float:
    """Return the natural frequency sqrt(K / m) / (2 pi).

    Parameters
    ----------
    stiffness : float or array [N/m]
    mass : float or array [kg]
        Both broadcast.

    Returns
    -------
    float or array [Hz]

    References
    ----------
    The harmonic oscillator.
    """
    return np.sqrt(stiffness / mass) / (2.0 * np.pi)


def gain(frequency: ArrayLike, natural: ArrayLike, damping: float) -> Any:
    """Return the stroke over that of the same force at rest, 1 / sqrt((1 - q^2)^2 + (2 zeta q)^2).

    q is the frequency of the drive over that of the machine.

    Parameters
    ----------
    frequency : array_like [Hz]
        Of the drive.
    natural : array_like [Hz]
        Of the machine; both broadcast.
    damping : float [1]
        zeta, share of the critical damping.

    Returns
    -------
    float or array [1]
        Infinite at resonance without damping.

    References
    ----------
    The harmonic oscillator with viscous damping, forced.
    """
    q = np.asarray(frequency) / np.asarray(natural)
    with np.errstate(divide="ignore"):
        return 1.0 / np.hypot(1.0 - q**2, 2.0 * damping * q)


THICKNESSES = (1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3, 4e-3)  # [m] that makers stock
LEAF_WIDTHS_M = (30e-3, 40e-3, 50e-3, 60e-3)  # [m] the same
LEAF_LENGTHS_M = tuple(1e-3 * n for n in range(60, 270, 10))  # [m] free, where it may be chosen
THICKER = 0.5e-3  # [m] step of the same
USUAL_A_BANK = 4  # leaves of one bank that makers stack; more only where nothing else does
MOST_A_BANK = 6  # leaves of one bank


@dataclass(frozen=True)
class LeafSet:
    """A number of leaves of one thickness in the machine."""

    name: str  # what it is beside the set in use
    thickness: float  # [m]
    leaves: int
    natural_frequency: float  # [Hz]
    by_square: float  # [Hz] the same where a leaf's force is reckoned with t^2, as RNA does
    detuning: float  # [1] natural frequency above the drive
    gain: float  # [1]
    stress: float  # [Pa] amplitude, at the stroke in use


LEAF_SET_COLUMNS: tuple[Column[LeafSet], ...] = (
    Column("change", lambda leaves: leaves.name),
    Column("leaf_thickness_mm", lambda leaves: leaves.thickness, "mm"),
    Column("leaves", lambda leaves: leaves.leaves),
    Column("natural_frequency_hz", lambda leaves: leaves.natural_frequency, "Hz"),
    Column("by_t_squared_hz", lambda leaves: leaves.by_square, "Hz"),
    Column("above_drive_percent", lambda leaves: leaves.detuning, "%"),
    Column("gain", lambda leaves: leaves.gain),
    Column("leaf_stress_mpa", lambda leaves: leaves.stress, "MPa"),
)


def leaf_set(
    machine: Machine,
    frequency: float,
    amplitude: float,
    *,
    leaves: int,
    thickness: float,
    name: str = "",
    mass: float | None = None,
) -> LeafSet:
    """Compute what other leaves of the same width and length do.

    Parameters
    ----------
    machine : Machine
    frequency : float [Hz]
        Of the drive.
    amplitude : float [m]
        At the springs, for the stress.
    leaves : int
    thickness : float [m]
    name : str
        What the set is beside the one in use.
    mass : float [kg], optional
        Effective mass of the machine, where it is known: every such set has the same.

    Returns
    -------
    LeafSet

    References
    ----------
    ``leaf_stiffness``, ``twist``, ``gain``, ``leaf_stress``; docs/bowl.md, "3. The machine".
    """
    other = replace(machine, leaves=leaves, leaf_thickness=thickness)
    mass = effective_mass(machine) if mass is None else mass
    stiff, own = (sprung.leaves * leaf_stiffness(sprung) * twist(sprung) for sprung in (other, machine))
    natural = natural_frequency(stiff, mass)
    square = leaves / machine.leaves * (thickness / machine.leaf_thickness) ** 2
    return LeafSet(
        name=name,
        thickness=thickness,
        leaves=int(leaves),
        natural_frequency=float(natural),
        by_square=float(natural_frequency(own * square, mass)),
        detuning=float(natural / frequency - 1.0),
        gain=float(gain(frequency, natural, machine.damping)),
        stress=float(leaf_stress(other, amplitude)),
    )


def leaf_changes(machine: Machine, frequency: float, amplitude: float, banks: int) -> tuple[LeafSet, ...]:
    """Return the set in use beside a leaf more and less in each bank, and leaves 0.5 mm thicker.

    Parameters
    ----------
    machine : Machine
    frequency : float [Hz]
        Of the drive.
    amplitude : float [m]
        At the springs.
    banks : int
        That share the leaves.

    Returns
    -------
    tuple of LeafSet
        Without a set of no leaves.
    """
    n, t = int(machine.leaves), machine.leaf_thickness
    rows = [("as it is", n, t), ("a leaf more a bank", n + banks, t), ("a leaf less a bank", n - banks, t)]
    rows.append(("leaves 0.5 mm thicker", n, t + THICKER))
    return tuple(
        leaf_set(machine, frequency, amplitude, leaves=leaves, thickness=thickness, name=name)
        for name, leaves, thickness in rows
        if leaves > 0
    )


def tuned_leaf_sets(
    machine: Machine, frequency: float, amplitude: float, rules: Sizing
) -> tuple[LeafSet, ...]:
    """Return the sets that put the natural frequency a few per cent above the drive, thin leaves first.

    Parameters
    ----------
    machine : Machine
    frequency : float [Hz]
        Of the drive.
    amplitude : float [m]
        At the springs.
    rules : Sizing
        Least and greatest detuning, and the banks: each has as many leaves, at most ``MOST_A_BANK``.

    Returns
    -------
    tuple of LeafSet
        Of thicknesses that makers stock, and of that in use. Empty where no whole number of leaves does.
    """
    stocked, mass = sorted({*THICKNESSES, machine.leaf_thickness}), effective_mass(machine)
    banks = int(rules.banks)
    sets = (
        leaf_set(machine, frequency, amplitude, leaves=n, thickness=t, mass=mass)
        for t in stocked
        for n in range(banks, MOST_A_BANK * banks + 1, banks)
    )
    return tuple(one for one in sets if rules.least_detuning <= one.detuning <= rules.greatest_detuning)


def fewest_leaves(sets: Iterable[LeafSet]) -> list[str]:
    """Return the set of fewest leaves of each thickness.

    Parameters
    ----------
    sets : iterable of LeafSet
        Of one thickness the first counts.

    Returns
    -------
    list of str
        In the order of the sets: '4 of 2.5 mm'.
    """
    fewest: dict[float, str] = {}
    for own in sets:
        fewest.setdefault(own.thickness, f"{own.leaves} of {own.thickness / MM:g} mm")
    return list(fewest.values())


FULL_TURN_RAD = 2.0 * np.pi  # [rad]
INNERMOST = 0.5  # of the track's radius, where the list of angles starts
RADII = 6  # in it, besides the springs'


@dataclass(frozen=True)
class Stroke:
    """Motion of a bowl, and what is read on it where its track runs."""

    frequency: float  # [Hz]
    peak_to_peak: float  # [m] along the motion: what a sticker shows
    angle: float  # [rad] of the motion to the horizontal
    springs: float  # [m] half the stroke between bowl and base, at the springs
    acceleration: float  # [m/s2] peak, along the motion
    rms: float  # [m/s2] of the same
    horizontal: float  # [m/s2] peak
    vertical: float  # [m/s2] peak


ACCELEROMETER_COLUMNS: tuple[Column[Stroke], ...] = (  # what an accelerometer on the bowl shows
    Column("peak", lambda stroke: stroke.acceleration, "m/s2"),
    Column("rms", lambda stroke: stroke.rms, "m/s2"),
    Column("peak_horizontal", lambda stroke: stroke.horizontal, "m/s2"),
    Column("peak_vertical", lambda stroke: stroke.vertical, "m/s2"),
)


def stroke(bowl: Bowl) -> Stroke:
    """Compute how a bowl with a machine moves at its track, and how far its springs bend.

    The bowl turns by A cos psi / R. The springs take the turn between bowl and base, which is that over I2 /
    (I1 + I2), at their radius and along their slope.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    Stroke

    References
    ----------
    ``bowl.record.shares``; docs/bowl.md, "How it is computed".
    """
    drive, machine = bowl.drive, bowl.machine
    angle = drive.vibration_angle + bowl.track.climb
    peak = drive.amplitude * (FULL_TURN_RAD * drive.frequency) ** 2
    turn = drive.amplitude * np.cos(angle) / bowl.track.radius  # [rad] of the bowl
    against_base = turn / shares(machine)[1] * machine.spring_radius
    return Stroke(
        frequency=drive.frequency,
        peak_to_peak=2.0 * drive.amplitude,
        angle=angle,
        springs=float(against_base / np.cos(machine.spring_angle)),
        acceleration=peak,
        rms=peak / np.sqrt(2.0),
        horizontal=float(peak * np.cos(angle)),
        vertical=float(peak * np.sin(angle)),
    )


def angles(machine: Machine, track: Track) -> tuple[Floats, Floats]:
    """Return the direction of the bowl's motion over its radius.

    Parameters
    ----------
    machine : Machine
    track : Track

    Returns
    -------
    (N,) float [m]
        Radii, outwards: from the smaller of the springs' radius and half the track's, to the track's.
    (N,) float [rad]
        Angle of the motion to the horizontal at each.

    References
    ----------
    ``bowl.record.direction``.
    """
    evenly = track.radius * np.linspace(INNERMOST, 1.0, RADII)
    off_springs = np.abs(evenly - machine.spring_radius) > 1e-9 * track.radius
    radii = np.sort(np.append(evenly[off_springs], machine.spring_radius))
    return radii, direction(machine, radii)


def greatest_amplitude(bowl: Bowl) -> float:
    """Return the largest amplitude that drives are built for at the frequency of a bowl's drive.

    min(a_max g / w^2, s_max / 2): half the greatest stroke, or less where the acceleration ends it.

    Parameters
    ----------
    bowl : Bowl

    Returns
    -------
    float [m]

    References
    ----------
    Trade; the keys ``sizing.greatest_acceleration`` and ``sizing.greatest_stroke``.
    """
    rules = bowl.sizing
    by_acceleration = rules.greatest_acceleration * bowl.gravity / (FULL_TURN_RAD * bowl.drive.frequency) ** 2
    return min(by_acceleration, 0.5 * rules.greatest_stroke)
