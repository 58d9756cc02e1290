"""Bowl and base on inclined leaf springs: stiffness, effective mass, natural frequency, gain.

The base stands on soft rubber feet, taken as free. Every formula is of small motions of two rigid bodies
between which the leaves leave one way to move: rise and turn together, in the direction of the springs.

Source: leaves clamped at both ends (Euler and Bernoulli), two masses on a spring; docs/bowl.md,
"How it is computed".
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from feederscrew.bowl.direction import shares
from feederscrew.bowl.record import Machine
from feederscrew.machine import unbalanced

MAINS = (50.0, 60.0)  # [Hz]
HALF_WAVE = 0.75  # [1] of its amplitude: mean pull of a magnet on the half wave, (1 + 1 / 2) / 2
SHEAR_SHARE = 5.0 / 6.0  # [1] of a rectangle that carries shear, after Timoshenko
POISSON = 0.3  # [1] of steel; the twist of a leaf depends on it through G / E = 1 / (2 (1 + nu))


@dataclass(frozen=True)
class Springs:
    """What the leaves make of bowl and base."""

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


def springs(machine: Machine) -> Springs:
    """Compute what the springs of a machine make of it.

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
    """Return the stiffness of one leaf with both ends guided, E b t^3 / L^3 [N/m].

    Source: Euler and Bernoulli's beam; docs/bowl.md, "How it is computed".
    """
    ratio = machine.leaf_thickness / machine.leaf_length
    return machine.leaf_modulus * machine.leaf_width * ratio**3


def leaf_stress(machine: Machine, amplitude: float) -> float:
    """Return the amplitude of bending stress in a leaf, 3 E t delta / L^2.

    Source: Euler and Bernoulli's beam; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
    amplitude : float [m]
        Half the stroke between bowl and base, at the springs and along their motion.

    Returns
    -------
    float [Pa]
    """
    return 3.0 * machine.leaf_modulus * machine.leaf_thickness * amplitude / machine.leaf_length**2


def upright_pull(force: float, machine: Machine) -> float:
    """Return the amplitude of the pull of an upright magnet that does what a force along the motion does [N].

    Source: equal work of two forces along one motion.

    Parameters
    ----------
    force : float [N]
        Amplitude along the springs' motion, which rises at their angle: an upright pull works by its sine.
    machine : Machine

    """
    return float(force / np.sin(machine.spring_angle))


def mean_pull(pull: float, frequency: float) -> float:
    """Return the mean of a magnet's pull [N], of its amplitude [N] at the frequency of the drive [Hz].

    Source: pull goes with the square of the flux, and flux with the integral of the voltage.

    Notes
    -----
    A magnet only pulls. On the full wave its pull goes with 1 + cos(w t): the mean is as large as the
    amplitude, and the peak twice that. The half wave drives at the frequency of the mains. Its flux goes with
    1 - cos(w t), and the constant part of its square is three quarters of the part that drives. What a
    converter feeds is taken as the full wave.
    """
    return pull * (HALF_WAVE if any(abs(frequency - mains) < 1e-6 for mains in MAINS) else 1.0)


def twist(machine: Machine) -> float:
    """Return by how much the twist of its leaves stiffens a bank, 1 + (G / 3 E) (L / r_s)^2 cos^2 psi [1].

    Source: Saint-Venant's torsion of a thin strip, G b t^3 / 3; docs/bowl.md, "How it is computed".

    Notes
    -----
    The leaf is taken to twist by the whole turn of the bowl. By the turn's component along the leaf alone the
    last factor would be cos^4 psi, a few per mille of the frequency less. Ends that cannot warp make a leaf
    twice as long as wide 1.3 times as stiff in twist, a per cent of the frequency. In-plane bending of a leaf
    whose clamps turn with the bowl is left out here: ``in_plane`` says what it would add.
    """
    lever = machine.leaf_length / machine.spring_radius * np.cos(machine.spring_angle)
    return 1.0 + lever**2 / (6.0 * (1.0 + POISSON))


def in_plane(machine: Machine, offset: float = 0.0) -> float:
    """Return by how much in-plane bending stiffens a bank of rigid clamps, over that without twist [1].

    Source: Timoshenko's beam, bent about its stiff axis; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine
    offset : float [m]
        From the middle of a leaf, along it, to the point that is nearest to the bowl's axis; half the length
        of the leaf where one of its ends is.

    Returns
    -------
    float [1]
        (b L / t r_s)^2 sin^2 psi cos^2 psi / 12 times 1 + 12 e^2 / (L^2 (1 + Phi)), with
        Phi = 2 (1 + nu) b^2 / (kappa L^2).

    Notes
    -----
    The bowl turns the upper clamp against the lower one by theta sin psi in the leaf's own plane. Where the
    middle of the leaf is nearest to the axis this is pure bending. A clamp that yields takes most of it: of a
    leaf of 40 x 2.5 x 80 mm a clamp softer than some 5 kN m/rad leaves a few per cent of the frequency.
    """
    wide, long, angle = machine.leaf_width, machine.leaf_length, machine.spring_angle
    lever = wide * long / (machine.leaf_thickness * machine.spring_radius)
    shear = 2.0 * (1.0 + POISSON) * wide**2 / (SHEAR_SHARE * long**2)
    apart = 1.0 + 12.0 * offset**2 / (long**2 * (1.0 + shear))
    return float((lever * np.sin(angle) * np.cos(angle)) ** 2 / 12.0 * apart)


def effective_mass(machine: Machine) -> float:
    """Return the mass that moves against the springs [kg].

    Parameters
    ----------
    machine : Machine
        Of a bowl whose centre of mass may be known to lie off its axis.
    """
    return centred_mass(machine) if unbalanced.is_even(machine) else unbalanced.effective_mass(machine)


def centred_mass(machine: Machine) -> float:
    """Return the mass that moves against the springs [kg] where the centre of mass is on the axis.

    Source: the kinetic energy of two free bodies; docs/bowl.md, "How it is computed".

    Parameters
    ----------
    machine : Machine

    Returns
    -------
    float [kg]
        m1 m2 / (m1 + m2) sin^2 psi + [I1 I2 / (I1 + I2)] / r_s^2 cos^2 psi.
    """
    rise, turn = shares(machine)
    along = machine.bowl_mass * rise * np.sin(machine.spring_angle) ** 2
    around = machine.bowl_inertia * turn * (np.cos(machine.spring_angle) / machine.spring_radius) ** 2
    return float(along + around)


def held_fast(machine: Machine) -> Machine:
    """Return the machine on a base that does not move."""
    return replace(machine, base_mass=1e12 * machine.bowl_mass, base_inertia=1e12 * machine.bowl_inertia)


def natural_frequency(stiffness: float, mass: float) -> float:
    """Return sqrt(K / m) / (2 pi) [Hz]; arrays broadcast.

    Source: the harmonic oscillator.
    """
    return np.sqrt(stiffness / mass) / (2.0 * np.pi)


def gain(frequency: Any, natural: Any, damping: float) -> Any:
    """Return the stroke over that of the same force at rest.

    Source: the harmonic oscillator with viscous damping, forced.

    Parameters
    ----------
    frequency, natural : array_like [Hz]
        Of the drive, and of the machine.
    damping : float [1]
        Of the critical damping.

    Returns
    -------
    array_like [1]
        1 / sqrt((1 - q^2)^2 + (2 zeta q)^2), q = f / f_n; infinite at resonance without damping.
    """
    q = np.asarray(frequency) / np.asarray(natural)
    with np.errstate(divide="ignore"):
        return 1.0 / np.hypot(1.0 - q**2, 2.0 * damping * q)
