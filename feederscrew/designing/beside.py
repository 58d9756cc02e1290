"""What other commands make of a design: the chain as a study of tooling, the machine below the bowl."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.bowl import unbalance
from feederscrew.bowl.record import Bowl, Machine
from feederscrew.bowl.settings import Setting, of_device
from feederscrew.designing.proposals import Proposal
from feederscrew.designing.record import DesignRequest, DesignStudy
from feederscrew.errors import FeederError
from feederscrew.part.record import Part
from feederscrew.rates.stream import Orientations
from feederscrew.resting.aspects import Aspects
from feederscrew.solidbowl.materials import STEEL
from feederscrew.solidbowl.plan import CHORD
from feederscrew.studies import bowl as machines
from feederscrew.studies import solidbowl
from feederscrew.studies.bowl import MachineSheet
from feederscrew.studies.tooling import ToolingStudy
from feederscrew.tooling.isolating import proposal as static
from feederscrew.tooling.isolating.chain import Wishes

DRIVE = (
    ("frequency", 1.0, "Hz"),
    ("vibration_angle", np.radians(1.0), "deg"),
    ("phase", np.radians(1.0), "deg"),
)
TRACK = (
    ("climb", np.radians(1.0), "deg"),
    ("bank", np.radians(1.0), "deg"),
    ("radius", 1e-3, "mm"),
    ("width", 1e-3, "mm"),
)


def tooled(
    part: Part,
    bowl: Bowl,
    aspects: Aspects,
    ways: Orientations,
    weights: np.ndarray,
    proposal: Proposal,
    request: DesignRequest,
    margin: float,
) -> ToolingStudy | None:
    """Return a chain as `feeder tooling` would have found it; None without one.

    Parameters
    ----------
    part : Part
    bowl : Bowl
        With its devices.
    aspects : Aspects
    ways : Orientations
        Through the devices; M of them.
    weights : (M,) float [1]
        In which they come.
    proposal : Proposal
    request : DesignRequest
    margin : float [m]

    Returns
    -------
    ToolingStudy or None
    """
    if not proposal.cuts:
        return None
    given = static.task(
        ways.lying, weights, proposal.row, margin, 1.0, proposal.before, wishes=Wishes(up=request.up)
    )
    same = np.isin(ways.leaves_as, proposal.states(ways))
    found = static.told(given, proposal.cuts, ways.through < 0.5, same)
    designs = tuple(found if k == proposal.row else None for k in range(len(weights)))
    return ToolingStudy(
        part, bowl, aspects, request.rule, margin, ways.lying, weights, designs, proposal.row, request.up
    )


@dataclass(frozen=True, eq=False)
class Built:
    """What is built for a design: the machine below its bowl, and the bowl as a solid."""

    sheet: MachineSheet | None = None  # as it is driven; None where no machine can be
    drawn: MachineSheet | None = None  # the same with its order and its solid; None where there is no solid
    why: str = ""  # there is none


def built(study: DesignStudy, settings: Iterable[Setting]) -> Built:
    """Return the machine below the bowl of a design, sized for it, and that bowl as a solid of steel.

    Parameters
    ----------
    study : DesignStudy
    settings : sequence of Setting
        As the user gave them.

    Returns
    -------
    Built
    """
    if study.bowl is None:
        return Built()
    given = [f"{s.key.name}={s.text}" for s in settings if s.given and not s.key.name.startswith("devices")]
    own = [*_texts("drive", study.bowl.drive, DRIVE), *_texts("track", study.bowl.track, TRACK)]
    words = {line.partition("=")[0] for line in own} | {"drive.amplitude", "drive.peak_to_peak"}
    kept = [line for line in given if line.partition("=")[0] not in words]
    devices = tuple(of_device(k, one) for k, one in enumerate(study.devices, start=1))
    try:
        made = bowls.settings(None, (*kept, *own))
        sized, why = _sized((*made, *devices), study)
        under = [f"machine.{name}={text}" for name, text in _machine(sized.bowl.machine)]
        stroke = f"drive.amplitude={1e3 * study.bowl.drive.amplitude:.9g} mm"
        sheet = machines.machine(bowls.settings(None, (*kept, *own, stroke, *under)))
    except FeederError as fault:
        return Built(why=str(fault))
    return Built(sheet, _drawn(sheet, sized), why)


def _drawn(sheet: MachineSheet, sized: MachineSheet) -> MachineSheet | None:
    """The sheet with the solid, and how its mass lies about the axis; None without one."""
    if sized.solid is None:
        return None
    under = replace(sheet.bowl.machine, unbalance=sized.bowl.machine.unbalance)
    return replace(sheet, bowl=replace(sheet.bowl, machine=under), order=sized.order, solid=sized.solid)


def _sized(settings: Sequence[Setting], study: DesignStudy) -> tuple[MachineSheet, str]:
    """The bowl of a design, with its solid, or else why there is none."""
    wanted = solidbowl.asked(settings, solid=True, material=STEEL, chord=CHORD)
    try:
        return machines.bowl(settings, study.part, study.request.target, solid=wanted), ""
    except FeederError as fault:
        return machines.bowl(settings, study.part, study.request.target), str(fault)


def _texts(section: str, record: object, rows: Iterable[tuple[str, float, str]]) -> list[str]:
    return [f"{section}.{name}={getattr(record, name) / unit:.9g} {text}" for name, unit, text in rows]


def _machine(machine: Machine) -> Iterator[tuple[str, str]]:
    yield "bowl_mass", f"{machine.bowl_mass:.6g} kg"
    yield "bowl_inertia", f"{machine.bowl_inertia:.6g} kg m2"
    yield "base_mass", f"{machine.base_mass:.6g} kg"
    yield "base_inertia", f"{machine.base_inertia:.6g} kg m2"
    yield "spring_radius", f"{1e3 * machine.spring_radius:.6g} mm"
    yield "spring_angle", f"{np.degrees(machine.spring_angle):.6g} deg"
    yield "leaf_thickness", f"{1e3 * machine.leaf_thickness:.6g} mm"
    yield "leaves", f"{machine.leaves:.0f}"
    for word, value in unbalance.told(machine).items():
        yield word, f"{value:.12g} {'m' if word in unbalance.CENTRE else 'kg m2'}"
