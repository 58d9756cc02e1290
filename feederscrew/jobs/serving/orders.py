"""Orders that a page may give, and the call of ``feeder design`` that each is."""

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from feederscrew.base.columns import Document
from feederscrew.base.signatures import Keywords
from feederscrew.bowl.devices.kinds import KINDS
from feederscrew.jobs.serving.refusal import Refusal
from feederscrew.jobs.serving.uploads import BowlUpload, Upload
from feederscrew.part.density import MATERIALS

MACHINES = {  # what a reader chooses: label, and the options of the design
    "50": ("leaf springs, 50 Hz mains", ("--drive", "leaf-spring", "--set", "machine.mains=50 Hz")),
    "60": ("leaf springs, 60 Hz mains", ("--drive", "leaf-spring", "--set", "machine.mains=60 Hz")),
    "two": ("two-axis drive", ("--drive", "two-axis")),
    "any": ("any drive", ("--drive", "any")),
}
OUTCOMES = {  # of --outcome, by what the page calls them
    "any": "lying or hanging",
    "lying": "lying on the track",
    "hanging": "hanging by the head between rails",
}
RATES = (0.1, 3000.0)  # [1/min] that may be asked for
DIAMETERS_MM = (20.0, 2000.0)  # of a bowl at hand
FOLDER = ("-o", "results")  # of the files of a design, beside its part
SIDE = ("--up", "--aspect", "--heading")
ANY_HEADING = "any"
BEST_HEADING = "best"


class MayUse(StrEnum):
    """Means that a design may use beside steel."""

    AIR = "air"
    CAMERA = "camera"

    @property
    def label(self) -> str:
        """Return the name that the page has for it."""
        return {"air": "steady air", "camera": "camera or sensor with an air valve"}[self]

    @property
    def kinds(self) -> tuple[str, ...]:
        """Return the kinds of devices that take it, as --without knows them."""
        return tuple(
            name for name, kind in KINDS.items() if kind.trade.cost_class == {"air": 2, "camera": 3}[self]
        )


@dataclass(frozen=True)
class PageOrder:
    """Order of a page: a part, and the values of its fields."""

    upload: Upload
    rate: float  # [1/min]
    material: str
    machine: str  # of MACHINES
    up: str = ""  # aspect on which parts leave; '' for the one that delivers most
    heading: str = ANY_HEADING  # of that aspect: any, best, or degrees as a number
    outcome: str = "any"  # of OUTCOMES
    may_use: tuple[MayUse, ...] = tuple(MayUse)
    diameter: float | None = None  # [mm] of the bowl at hand; None for any
    bowl: BowlUpload | None = None  # of the bowl at hand
    # that a step to try asks for beside the fields of the page, each with its value
    more: tuple[tuple[str, str], ...] = ()
    settings: tuple[tuple[str, str], ...] = ()

    @classmethod
    def of(cls, values: Mapping[str, Any], upload: Upload, bowl: BowlUpload | None = None) -> "PageOrder":
        """Return the order of a page.

        Parameters
        ----------
        values : mapping of str to object
            What the page sent, not checked: 'rate' [1/min], 'material', 'machine', and the optional fields.
        upload : Upload
            The part.
        bowl : BowlUpload, optional
            The file of the bowl at hand.

        Returns
        -------
        PageOrder

        Raises
        ------
        Refusal
            If a value is not of its list or a number is out of range.
        """
        may_use = values.get("may_use", list(MayUse))
        if not isinstance(may_use, list) or not all(name in list(MayUse) for name in may_use):
            raise Refusal(400, "what may be used: is not of the list - tick what is there")
        up = _choice(values, "up", "", ["", *upload.headings], "this side up")
        headings = [ANY_HEADING, BEST_HEADING, *upload.headings.get(up, ())]
        diameter = values.get("diameter")
        return cls(
            upload,
            _number(values.get("rate"), RATES, "parts a minute"),
            _choice(values, "material", None, [density.name for density in MATERIALS], "material"),
            _choice(values, "machine", None, list(MACHINES), "machine"),
            up,
            _choice(values, "heading", ANY_HEADING, headings, "heading"),
            _choice(values, "outcome", "any", list(OUTCOMES), "outcome"),
            tuple(use for use in MayUse if use in may_use),
            None if diameter is None else _number(diameter, DIAMETERS_MM, "diameter of the bowl"),
            bowl,
        )

    @property
    def options(self) -> tuple[str, ...]:
        """Return the options of ``feeder design``, without the folder and a bowl file."""
        own = ["--target", f"{self.rate:g}/min", "--density", self.material, "--units", self.upload.units]
        own += [word for name, value in self._side.items() for word in (name, value)]
        own += [] if self.outcome == "any" else ["--outcome", self.outcome]
        without = [kind for use in MayUse if use not in self.may_use for kind in use.kinds]
        own += ["--without", ",".join(without)] if without else []
        own += [] if self.diameter is None else ["--diameter", f"{self.diameter:g}mm:{self.diameter:g}mm"]
        own += [word for name, value in self.more for word in (name, value) if word]
        own += [word for key, value in self.settings for word in ("--set", f"{key}={value}")]
        return (*own, *MACHINES[self.machine][1])

    @property
    def _side(self) -> dict[str, str]:
        """The options that say which side is up."""
        if not self.up:
            return {}
        if self.heading == ANY_HEADING:
            return {"--up": self.up}
        heading = {} if self.heading == BEST_HEADING else {"--heading": f"{self.heading}deg"}
        return {"--aspect": self.up, **heading}

    def after(self, options: Mapping[str, str | None], settings: Mapping[str, str]) -> "PageOrder":
        """Return the order with what a step to try changes, in the fields of the page where it has them.

        Parameters
        ----------
        options : mapping of str to str or None
            Of ``feeder design``, with their values; None of one that is left out.
        settings : mapping of str to str
            Keys of the bowl, with their values.

        Returns
        -------
        PageOrder
        """
        other, fields = dict(options), Keywords()
        if target := other.pop("--target", None):
            fields["rate"] = float(target.removesuffix("/min"))
        if "--outcome" in other:
            fields["outcome"] = other.pop("--outcome") or "any"
        if drive := other.pop("--drive", None):
            fields["machine"] = next(name for name, (_, words) in MACHINES.items() if words[1] == drive)
        # a step rules out nothing that was allowed: either is left out, or as it was
        for option, field, free in (
            ("--without", "may_use", tuple(MayUse)),
            ("--diameter", "diameter", None),
        ):
            if other.get(option, "") is None:
                del other[option]
                fields[field] = free
        if any(name in other for name in SIDE):
            fields |= self._with_side({name: other.pop(name) for name in SIDE if name in other})
        more = {**dict(self.more), **other}
        kept = tuple((name, value) for name, value in more.items() if value is not None)
        return replace(self, **fields, more=kept, settings=(*{**dict(self.settings), **settings}.items(),))

    def _with_side(self, options: Mapping[str, str | None]) -> Keywords:
        """The fields of the side up, with some of the options that say it changed."""
        side = {**self._side, **options}
        aspect, heading = side.get("--aspect"), side.get("--heading")
        up = aspect or side.get("--up") or ""
        if heading:
            return {"up": up, "heading": heading.removesuffix("deg")}
        return {"up": up, "heading": BEST_HEADING if aspect else ANY_HEADING}

    @property
    def arguments(self) -> tuple[str, ...]:
        """Return the arguments of the program, to be run where the files lie."""
        config = () if self.bowl is None else ("--config", self.bowl.path.name)
        return "design", self.upload.path.name, *self.options, *config, *FOLDER

    @property
    def command(self) -> str:
        """Return the same on a command line, with the files by their own names."""
        config = () if self.bowl is None else ("--config", self.bowl.name)
        return shlex.join(["feeder", "design", self.upload.name, *self.options, *config, *FOLDER])

    @property
    def values(self) -> Document:
        """Return the values of the page's fields for this order, and ``also``, what it asks beside them."""
        own = ("rate", "material", "machine", "up", "heading", "outcome", "may_use", "diameter")
        bowl = None if self.bowl is None else self.bowl.id
        also = " ".join(" ".join(filter(None, pair)) for pair in (*self.more, *self.settings))
        fields = {name: getattr(self, name) for name in own}
        return {"part": self.upload.id, "bowl": bowl, **fields, "also": also}


def _choice(values: Mapping[str, Any], name: str, default: str | None, allowed: list[str], label: str) -> str:
    value = values.get(name, default)
    if not isinstance(value, str) or value not in allowed:
        raise Refusal(400, f"{label}: is not one of the list - choose one")
    return value


def _number(value: object, ends: tuple[float, float], label: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not ends[0] <= value <= ends[1]:
        raise Refusal(400, f"{label}: is not from {ends[0]:g} to {ends[1]:g} - give another number")
    return float(value)
