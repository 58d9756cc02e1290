"""Sets of leaf springs: what one leaf more or less does, and which sets tune a bowl to its drive."""

from dataclasses import dataclass, replace

from feederscrew.bowl.record import Machine, Sizing
from feederscrew.machine.springs import (
    effective_mass,
    gain,
    leaf_stiffness,
    leaf_stress,
    natural_frequency,
    twist,
)

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

    Source: ``springs``; docs/bowl.md, "3. The machine".

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
    mass : float [kg], optional
        Effective mass of the machine, where it is known: it is that of every such set.

    Returns
    -------
    LeafSet
    """
    other = replace(machine, leaves=leaves, leaf_thickness=thickness)
    mass = effective_mass(machine) if mass is None else mass
    stiff, own = (one.leaves * leaf_stiffness(one) * twist(one) for one in (other, machine))
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


def changes(machine: Machine, frequency: float, amplitude: float, banks: int) -> tuple[LeafSet, ...]:
    """Return the set in use beside a leaf more and less in each bank, and leaves 0.5 mm thicker.

    Parameters
    ----------
    machine : Machine
    frequency, amplitude
        As for ``leaf_set``.
    banks : int
        That share the leaves.

    Returns
    -------
    tuple of LeafSet
    """
    n, t = int(machine.leaves), machine.leaf_thickness
    rows = [("as it is", n, t), ("a leaf more a bank", n + banks, t), ("a leaf less a bank", n - banks, t)]
    rows.append(("leaves 0.5 mm thicker", n, t + THICKER))
    return tuple(
        leaf_set(machine, frequency, amplitude, leaves=leaves, thickness=thickness, name=name)
        for name, leaves, thickness in rows
        if leaves > 0
    )


def sets(machine: Machine, frequency: float, amplitude: float, rules: Sizing) -> tuple[LeafSet, ...]:
    """Return the sets that put the natural frequency a few per cent above the drive.

    Parameters
    ----------
    machine : Machine
    frequency, amplitude
        As for ``leaf_set``.
    rules : Sizing
        Its least and greatest detuning, and its banks: each has as many leaves.

    Returns
    -------
    tuple of LeafSet
        Thin leaves first; at most ``MOST_A_BANK`` in each bank. Empty where no whole number of leaves does.
    """
    stocked, mass = sorted({*THICKNESSES, machine.leaf_thickness}), effective_mass(machine)
    found = (
        leaf_set(machine, frequency, amplitude, leaves=n, thickness=t, mass=mass)
        for t in stocked
        for n in range(int(rules.banks), MOST_A_BANK * int(rules.banks) + 1, int(rules.banks))
    )
    return tuple(one for one in found if rules.least_detuning <= one.detuning <= rules.greatest_detuning)
