"""Quantities as people write them, '0.5 mm', in SI units: the one place for every factor."""

import json
import math
import re
from collections.abc import Iterable
from typing import Any, Protocol, TypeAlias, runtime_checkable

from feederscrew.base.errors import printable as printable  # of a user's text, as a whole line

# exact by definition
FOOT = 0.3048  # [m]
INCH = 0.0254  # [m]
POUND = 0.45359237  # [kg]
MINUTE = 60.0  # [s]
HOUR = 3600.0  # [s]
GRAVITY = 9.80665  # [m/s2] standard: 3rd General Conference on Weights and Measures, 1901
DEGREE = math.pi / 180.0  # [rad]
TURN = 2.0 * math.pi  # [rad]

UNITS_BY_DIMENSION = {  # dimension: {unit: SI units in it}, the unit we suggest first
    "number": {"": 1.0, "%": 0.01},
    "length": {"mm": 1e-3, "m": 1.0, "cm": 1e-2, "um": 1e-6, "in": INCH, "ft": FOOT},
    "area": {"mm2": 1e-6, "m2": 1.0, "cm2": 1e-4, "in2": INCH**2},
    "volume": {"mm3": 1e-9, "m3": 1.0, "cm3": 1e-6, "l": 1e-3, "ml": 1e-6, "in3": INCH**3},
    "angle": {"deg": DEGREE, "rad": 1.0, "mrad": 1e-3, "turn": TURN},
    "solid angle": {"sr": 1.0},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": MINUTE, "h": HOUR},
    "frequency": {
        "Hz": 1.0,
        "kHz": 1e3,
        "1/s": 1.0,
        "1/min": 1.0 / MINUTE,
        "rpm": 1.0 / MINUTE,
        "vpm": 1.0 / MINUTE,
        "cpm": 1.0 / MINUTE,
    },
    "rate": {
        "/min": 1.0 / MINUTE,
        "1/min": 1.0 / MINUTE,
        "/s": 1.0,
        "1/s": 1.0,
        "/h": 1.0 / HOUR,
        "1/h": 1.0 / HOUR,
    },
    "velocity": {"mm/s": 1e-3, "m/s": 1.0, "m/min": 1.0 / MINUTE, "in/s": INCH, "ft/min": FOOT / MINUTE},
    "angular velocity": {"rad/s": 1.0, "deg/s": DEGREE, "rpm": TURN / MINUTE},
    "acceleration": {"m/s2": 1.0, "mm/s2": 1e-3, "cm/s2": 1e-2, "in/s2": INCH, "ft/s2": FOOT},
    "mass": {"g": 1e-3, "kg": 1.0, "mg": 1e-6, "lb": POUND, "oz": POUND / 16.0},
    "density": {
        "g/cm3": 1e3,
        "kg/m3": 1.0,
        "kg/dm3": 1e3,
        "g/ml": 1e3,
        "t/m3": 1e3,
        "lb/in3": POUND / INCH**3,
    },
    "inertia": {"g mm2": 1e-9, "kg m2": 1.0, "kg mm2": 1e-6, "g cm2": 1e-7, "kg cm2": 1e-4},
    "force": {"N": 1.0, "mN": 1e-3, "kN": 1e3},
    "stress": {"MPa": 1e6, "GPa": 1e9, "Pa": 1.0, "N/mm2": 1e6},
    "pressure": {"bar": 1e5, "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "mbar": 1e2},
    "stiffness": {"N/mm": 1e3, "N/m": 1.0, "kN/m": 1e3},
    "count": {"": 1.0},
    "supply": {"Hz full wave": 2.0, "Hz half wave": 1.0},  # mains: hertz of the drive in one of the supply
    "energy": {"J": 1.0, "mJ": 1e-3, "uJ": 1e-6},
}
# [m], [rad], [m/s], [1/s], [kg], [m3], [Pa]: people read these most
MM = 1e-3  # [m]
DEG = DEGREE  # [rad]
MM_S = 1e-3  # [m/s]
PER_MINUTE = 1.0 / MINUTE  # [1/s]
GRAM = 1e-3  # [kg]
LITRE = 1e-3  # [m3]
MPA = 1e6  # [Pa]
SPELLINGS = {
    **{"°": "deg", "degree": "deg", "degrees": "deg", "µm": "um", "μm": "um", "inch": "in", '"': "in"},
    **{f"Hz {wave}{end}": f"Hz {wave} wave" for wave in ("full", "half") for end in ("", "-wave", "wave")},
}
NUMBER_PATTERN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?![\d._,+-])", re.ASCII)
COMMA = re.compile(r"[+-]?\d+,\d+", re.ASCII)
GROUPED = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}(?!\d)")  # a comma that may part thousands or decimals
PLAIN_YAML = re.compile(r"(?!- )[\w.+/-]([\w.+@/% -]*[\w.+@/%-])?")
UNIT_CHARACTERS = str.maketrans({"²": "2", "³": "3", "^": None, "*": " ", "·": " ", "\N{MINUS SIGN}": "-"})


@runtime_checkable
class PhysicalQuantity(Protocol):
    """A quantity of another library, such as pint: it turns itself into a unit."""

    @property
    def magnitude(self) -> Any:
        """Return its number in its own unit."""

    def to(self, other: Any, /) -> Any:
        """Return the same quantity in another unit.

        Parameters
        ----------
        other : object
            The unit, as the other library takes it: a text for pint.

        Returns
        -------
        object
            A quantity of the other library.
        """


Quantity: TypeAlias = str | float | PhysicalQuantity  # '2 mm', a number in SI units, or of pint


class QuantityError(ValueError):
    """A text that is not a quantity of the wanted dimension: what is wrong and how to mend it.

    ``value`` is the text that is likely meant, where there is one: '60/min' for '60'.
    """

    def __init__(self, what: str, mend: str, value: str | None = None) -> None:
        super().__init__(f"{what} - {mend}")
        self.what, self.mend, self.value = what, mend, value


def quantity(text: str, dimension: str, *, suggest: str | None = None, bare: str | None = None) -> float:
    """Return a quantity as typed, '0.5 mm', in SI units.

    Parameters
    ----------
    text : str
        Number and unit; a number alone where the dimension is 'number'.
    dimension : str
        Of ``UNITS_BY_DIMENSION``.
    suggest : str, optional
        Unit to name when one is missing; the first of the dimension without it.
    bare : str, optional
        Unit of a number without one, which is refused otherwise.

    Returns
    -------
    float [SI]

    Raises
    ------
    QuantityError
        If the text is not a finite number, or its unit is missing, unknown or of another dimension.
    """
    number, unit = split(text)
    if unit == "" and bare is not None:
        unit = bare
    if unit not in UNITS_BY_DIMENSION[dimension]:
        raise _wrong_unit(text.strip(), unit, dimension, suggest or next(iter(UNITS_BY_DIMENSION[dimension])))
    return number * UNITS_BY_DIMENSION[dimension][unit]


def from_quantity(value: object, dimension: str) -> object:
    """Return a quantity of another library as a number in SI units, and anything else as it is.

    Parameters
    ----------
    value : object
        What has ``to`` and ``magnitude``, as a quantity of pint; or any other value.
    dimension : str
        A dimension of ``UNITS_BY_DIMENSION``.

    Returns
    -------
    float [SI], or ``value``

    Raises
    ------
    QuantityError
        If the quantity is of another dimension.
    """
    if isinstance(value, type) or not isinstance(value, PhysicalQuantity):
        return value
    by_unit = UNITS_BY_DIMENSION[dimension]
    unit = next((unit for unit, scale in by_unit.items() if scale == 1.0), "")
    one = f"1{unit}" if unit.startswith("/") else unit
    try:
        # powers have two stars there: kg/m3 is kg/m**3
        return float(value.to(re.sub(r"(?<=[a-z])(?=\d)", "**", one)).magnitude)
    except (TypeError, ValueError, AttributeError):
        mend = f"give it in {next(iter(by_unit))}" if unit else "give a number"
        what = (
            f"{quantity_text(str(value))} is not {'a number' if dimension == 'number' else f'of {dimension}'}"
        )
        raise QuantityError(what, mend) from None


def factor(unit: str, dimension: str) -> float:
    """Return how many SI units one unit is.

    Parameters
    ----------
    unit : str
        'mm'.
    dimension : str
        'length'.

    Returns
    -------
    float [SI]
        0.001

    Raises
    ------
    KeyError
        If the unit is of another dimension.
    """
    return UNITS_BY_DIMENSION[dimension][unit]


def split(text: str) -> tuple[float, str]:
    """Return the number and the unit of a quantity as typed.

    Parameters
    ----------
    text : str
        '0.5 mm'. '°', '²' and the like are read as 'deg' and '2'.

    Returns
    -------
    number : float [as typed]
    unit : str
        'mm'; '' where there is none. It need not be a unit that is known.

    Raises
    ------
    QuantityError
        If no finite number leads, or it has a comma: '1,5' may mean 1.5, '1,250' 1.25 or 1250.
    """
    plain = text.strip().translate(UNIT_CHARACTERS)
    if COMMA.match(plain):
        whole, _, rest = plain.partition(",")
        value = None if "," in rest else f"{whole}.{rest}"
        mend = "write it without commas" if value is None else f"write {value}"
        if value is not None and GROUPED.match(plain):  # 1,250 may be 1.25 or 1250
            value, mend = None, f"write {value} or {whole}{rest}"
        raise QuantityError(f"{quantity_text(text)} has a comma", mend, value)
    match = NUMBER_PATTERN.match(plain)
    if match is None:
        raise _no_number(text)
    number = float(match.group())
    if not math.isfinite(number):
        raise QuantityError(f"{quantity_text(text)} is too large", "give a finite number")
    unit = " ".join(plain[match.end() :].split())
    return number, SPELLINGS.get(unit, unit)


def decimal(text: str) -> float:
    """Return a plain finite number of the digits 0 to 9, as a file writes it.

    Parameters
    ----------
    text : str
        '-1.5e-3', blanks around it are left out.

    Returns
    -------
    float [as written]

    Raises
    ------
    QuantityError
        If it is anything else: 'nan', '1_000', '1,5'.
    """
    match = NUMBER_PATTERN.fullmatch(text.strip())
    number = float(match.group()) if match else math.nan
    if not math.isfinite(number):
        raise _no_number(text)
    return number


def one_line(text: str) -> str:
    """Return a user's text fit for a message.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        Printable, on one line, of 40 letters at most: longer ones end in '...'.
    """
    line = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return line if len(line) <= 40 else f"{line[:37]}..."


def quoted(text: str) -> str:
    """Return a text as YAML takes it on one line.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        As it is where it is plain, else in double quotes.
    """
    return text if PLAIN_YAML.fullmatch(text) else json.dumps(text, ensure_ascii=False)


def counted(number: int, noun: str, several: str | None = None) -> str:
    """Return a number of things for people: '1 part', '2 parts'.

    Parameters
    ----------
    number : int
    noun : str
        In the singular.
    several : str, optional
        The plural where an s is not all.

    Returns
    -------
    str
    """
    return f"{number} {noun if number == 1 else several or f'{noun}s'}"


def digits_text(value: float, digits: int = 3) -> str:
    """Return a number of so many significant digits without an exponent: '3590' of 3594.9.

    Parameters
    ----------
    value : float
        From 0.0001 to 1e15, or 0.
    digits : int, optional

    Returns
    -------
    str
    """
    return f"{float(f'{value:.{digits}g}'):.15g}"


def rounded_down(rate: float) -> float:
    """Return a rate [1/min] of two digits that is not above another one.

    Parameters
    ----------
    rate : float [1/min]

    Returns
    -------
    float [1/min]
        0 of 0.
    """
    if not rate > 0.0:
        return 0.0
    step = 10.0 ** (math.floor(math.log10(rate)) - 1)
    return float(f"{math.floor(rate / step + 1e-9) * step:.6g}")


def listed(names: Iterable[str]) -> str:
    """Return names for people: 'A', 'A and B', 'A, B and C'.

    Parameters
    ----------
    names : iterable of str
        One at least.

    Returns
    -------
    str
    """
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def quantity_text(text: str) -> str:
    """Return a user's text fit for a message, in quotes.

    Parameters
    ----------
    text : str

    Returns
    -------
    str
        ``one_line`` of it between single quotes.
    """
    return f"'{one_line(text)}'"


def _no_number(text: str) -> QuantityError:
    mend = "write digits with a decimal point, as in 0.4"
    return QuantityError(f"{quantity_text(text)} is not a number", mend)


def _wrong_unit(text: str, unit: str, dimension: str, suggest: str) -> QuantityError:
    wanted = UNITS_BY_DIMENSION[dimension]
    wrong_unit = next((other for other, units in UNITS_BY_DIMENSION.items() if unit in units), None)
    if dimension in ("number", "count"):
        what = f"{quantity_text(text)} has a unit, and this is a plain number"
        alone = _with_unit(text, "")
        return QuantityError(what, "write the number alone", alone) if wrong_unit else _no_number(text)
    suggested = _with_unit(text, suggest)
    if unit == "":
        return QuantityError(f"{quantity_text(text)} has no unit", f"write {suggested}", suggested)
    if wrong_unit:
        what = f"{quantity_text(text)} is {_with_article(wrong_unit)}, not {_with_article(dimension)}"
        longer = [text + item[len(unit) :] for item in wanted if item.startswith(f"{unit} ")]
        if longer:
            return QuantityError(what, f"write {' or '.join(longer)}", longer[0])
        return QuantityError(what, f"give it in {suggest}", suggested)
    folded = {item.lower(): item for item in wanted}
    near = folded.get(unit.lower())
    what = f"{quantity_text(text)}: {quantity_text(unit)} is not a unit of {dimension}"
    if near is None:
        return QuantityError(what, f"known are {', '.join(wanted)}")
    return QuantityError(what, f"did you mean {near}?", _with_unit(text, near))


def _with_unit(text: str, unit: str) -> str:
    """The number that a text begins with, as typed, and a unit: '0.5 mm', '60/min'."""
    match = NUMBER_PATTERN.match(text.strip().translate(UNIT_CHARACTERS))
    number = match.group() if match else text
    return f"{number}{unit}" if unit.startswith("/") else f"{number} {unit}".strip()


def _with_article(dimension: str) -> str:
    name = "percentage" if dimension == "number" else dimension
    return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"
