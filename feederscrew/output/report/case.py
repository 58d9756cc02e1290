"""What a report is of: a part, the aspect wanted of it, and a bowl."""

import shlex
from dataclasses import dataclass, field

import numpy as np

from feederscrew import bowl as bowls
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.settings import Setting
from feederscrew.errors import FeederError
from feederscrew.part.record import Part
from feederscrew.rates import devices
from feederscrew.resting import aspects
from feederscrew.resting.posture import posture

TALK = {"-q", "--quiet", "-v", "--verbose"}
PLACE = {"-o", "--output"}


@dataclass(frozen=True, eq=False)
class Case:
    """The inputs of a report, checked."""

    part: Part
    found: aspects.Aspects
    settings: tuple[Setting, ...]
    bowl: Bowl
    path: str | None  # of the bowl file
    chain: tuple[devices.Device, ...]
    aspect: str  # the wanted one
    heading: float | None  # [rad]
    rule: str
    gap: float  # [m]
    fill: float  # [1]
    inputs: dict[str, str] = field(default_factory=dict)  # sha256 by path
    command: str = ""  # that repeats it
    target: float | None = None  # [1/s] that a bowl is sized for
    counted: str | None = None  # aspect that counts for it; None: whatever passes

    @classmethod
    def of(
        cls,
        part,
        path,
        overrides,
        *,
        aspect=None,
        heading=None,
        rule="pmi",
        gap=0.0,
        fill=1.0,
        command="",
        target=None,
    ):
        """Everything that can be wrong with the inputs, found before anything is computed.

        Parameters
        ----------
        part : Part
        path, overrides
            As for ``bowl.read``.
        aspect : str, optional
            The wanted one; without it, the likeliest by the rule that ranks them (CSA).
        heading : float [rad], optional
        rule : str
            Whose probabilities count for the rate.
        gap : float [m]
        fill : float [1]
        command : str
            That repeats it.
        target : float [1/s], optional
            Rate that a bowl is sized for.

        Returns
        -------
        Case

        Raises
        ------
        FeederError
            If there is no such aspect or rule, or the bowl file has faults.
        """
        settings = bowls.settings(path, overrides)
        found = aspects.find(part)
        if rule not in found.chances:
            known = ", ".join(found.chances)
            raise FeederError(f"--rule {rule}", "has no probabilities of this part", f"choose one of {known}")
        return cls(
            part=part,
            found=found,
            settings=settings,
            bowl=bowls.record(settings),
            path=path,
            chain=tuple(devices.read(path)),
            aspect=posture(part, found, likeliest(found) if aspect is None else aspect).name,
            heading=heading,
            rule=rule,
            gap=gap,
            fill=fill,
            inputs={part.source: part.sha256} | bowls.identity(path),
            command=command,
            target=target,
            counted=aspect,
        )

    @property
    def row(self):
        """Of the wanted aspect."""
        return self.found.names.index(self.aspect)


def likeliest(found):
    """Name of the aspect the part rests on most often by CSA; of the first where no rule tells."""
    return found.names[int(np.argmax(np.nan_to_num(found.probabilities["csa"])))]


def repeated(arguments):
    """The command line that gives the same page, wherever it is written.

    Parameters
    ----------
    arguments : sequence of str
        As typed.

    Returns
    -------
    str
    """
    kept, skip = ["feeder"], False
    for argument in arguments:
        if not (skip or argument in TALK | PLACE or argument.startswith(("--output=", "-o="))):
            kept.append(argument)
        skip = argument in PLACE
    return shlex.join(kept)
