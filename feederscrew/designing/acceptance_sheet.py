"""The acceptance sheet: a test plan that a buyer signs, filled in at the machine and judged by its demands.

A line has the demand (``low``, ``high``), the plan that shows it for 95 % confidence, what the computation
expects, and two cells for the buyer: what was measured, on which sample. Only the demand is judged.
"""

import csv
import enum
import io
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from feederscrew.base import documents, units
from feederscrew.base.errors import Faults, FeederError
from feederscrew.base.heavy import heavy
from feederscrew.base.units import HOUR, PER_MINUTE, counted
from feederscrew.bowl.verified import AGREED_JAMS, PURE
from feederscrew.designing import evidence
from feederscrew.trials.fills import FilledQueue

stats = heavy("scipy.stats")

REQUIRED_COLUMNS = ("quantity", "fill", "computed", "low", "high", "unit", "measured", "sample")
SHEET_COLUMNS = (
    "quantity",
    "fill",
    "low",
    "high",
    "unit",
    "plan",
    "computed",
    "computed_low",
    "computed_high",
    "measured",
    "sample",
)
TEXT_COLUMNS = ("quantity", "fill", "unit", "plan")
MAX_BYTES, MAX_HEAD_BYTES = 200_000, 1000  # of a sheet; of its first line
MAX_WRONG = 3  # wrong parts of the largest sample that a plan names
LIKELY_PASS = 0.8  # [1] chance that a feeder as computed passes the plan whose sample is written down
RATE_SECONDS = 600.0  # [s] for which good parts are counted at the least
UNBOUNDED_TOLERANCE = 0.1  # [1] of a computed value without a demand, from which a measured one is another
MIN_SECONDS, MAX_SECONDS = 1.0, 1e9  # [s] of a run


class Quantity(enum.StrEnum):
    """Quantity that a buyer measures of the parts; every other line is a setting of the machine."""

    RATE = "good parts at the discharge"
    YIELD = "yield, good of what leaves"
    JAMS = "jams"


UNITS = {Quantity.RATE: "1/min", Quantity.YIELD: "%", Quantity.JAMS: "1/h"}


class Judgement(enum.StrEnum):
    """Verdict of a measured value on its demand."""

    AGREES = "agrees"
    FAILS = "does not"
    UNSHOWN = "not shown"  # no worse than the demand, and too small a sample to show it
    UNMEASURED = "not measured"


@dataclass(frozen=True)
class SheetLine:
    """One line of the sheet; numbers in the unit of the line, None of an empty cell."""

    quantity: str
    fill: str
    unit: str
    low: float | None  # what is demanded at least
    high: float | None  # what is tolerated at most
    computed: float | None
    computed_low: float | None = None  # one-sided bounds of the computation, or ends of its interval
    computed_high: float | None = None
    plan: str = ""  # on how many parts, or for how long, and what is accepted
    measured: float | None = None  # None where nobody measured
    sample: float | None = None  # parts of a yield; seconds of a rate and of jams
    measured_step: float = 0.0  # half a unit of the last digit that was written

    @property
    def demand(self) -> tuple[float, float]:
        """The least and the greatest value that meets the demand.

        Of a yield without a low end it is ``PURE``, of jams without a high end ``AGREED_JAMS``. A setting of
        the machine is within 10 % of its computed value where the sheet says no more.
        """
        low, high = self.low, self.high
        if self.quantity == Quantity.YIELD:
            low, high = 100.0 * PURE if low is None else low, 100.0
        elif self.quantity == Quantity.JAMS:
            low, high = 0.0, AGREED_JAMS * HOUR if high is None else high
        elif self.quantity == Quantity.RATE:  # more is no fault
            low, high = self.computed if low is None else low, math.inf
        elif low is None and high is None and self.computed is not None:
            ends = sorted((1.0 + side * UNBOUNDED_TOLERANCE) * self.computed for side in (-1, 1))
            low, high = ends[0], ends[1]
        return -math.inf if low is None else low, math.inf if high is None else high

    @property
    def good(self) -> int | None:
        """Good parts of the sample of a yield, the fewest that round to what was written."""
        if self.measured is None or self.sample is None:
            return None
        share, step = 0.01 * self.measured, 0.01 * self.measured_step
        fewest = max(math.ceil((share - step) * self.sample - 1e-6), 0)
        return fewest if fewest <= (share + step) * self.sample + 1e-6 else None

    @property
    def judged(self) -> tuple[Judgement, str]:
        """Return the verdict of the measured value on the demand, and why where it does not agree."""
        if self.measured is None:
            return Judgement.UNMEASURED, ""
        low, high = self.demand
        if self.quantity == Quantity.YIELD:
            return self._judge_yield(0.01 * low)
        if self.quantity == Quantity.JAMS:
            return self._judge_jams(high)
        if low <= self.measured <= high:
            return Judgement.AGREES, ""
        side, end = ("at least", low) if self.measured < low else ("at most", high)
        return Judgement.FAILS, f"{end:.4g} {self.unit} {side} is demanded"

    @property
    def agrees(self) -> bool | None:
        """Tell whether the demand is met, and shown; None where nobody measured."""
        judgement, _ = self.judged
        return None if judgement is Judgement.UNMEASURED else judgement is Judgement.AGREES

    def _judge_yield(self, demand: float) -> tuple[Judgement, str]:
        """Judge a yield by the lower bound of the share of good parts; ``demand`` [1]."""
        measured, sample, good = self.measured or 0.0, self.sample, self.good
        if sample is None or good is None:
            if measured < 100.0 * demand:
                return Judgement.FAILS, f"{100.0 * demand:.4g} % at least is demanded"
            return Judgement.UNSHOWN, "write in 'sample' how many parts were looked at"
        wrong = int(sample) - good
        if evidence.share_at_least(good, int(sample)) >= demand:
            return Judgement.AGREES, ""
        more = evidence.parts_to_look_at(demand, wrong)
        why = (
            f"{wrong} wrong of {counted(int(sample), 'part')}: {100.0 * demand:.4g} % are shown by {more} "
            f"with {wrong} wrong"
        )
        return (Judgement.FAILS if good < demand * sample else Judgement.UNSHOWN), why

    def _judge_jams(self, high: float) -> tuple[Judgement, str]:
        """Judge jams by the upper bound of their rate; ``high`` [1/h]."""
        measured, sample = self.measured or 0.0, self.sample
        if measured > high:
            return Judgement.FAILS, f"{units.digits_text(high, 4)} an hour at most are agreed"
        if sample is None:
            return Judgement.UNSHOWN, "write in 'sample' for how many seconds it ran"
        jams = math.ceil(measured * sample / HOUR - 1e-6)
        if evidence.rate_at_most(jams, sample) * HOUR <= high:
            return Judgement.AGREES, ""
        minutes = math.ceil(evidence.time_to_run(high / HOUR, jams) / units.MINUTE)
        return Judgement.UNSHOWN, (
            f"{counted(jams, 'jam')} in {sample / units.MINUTE:.3g} min: less than "
            f"{units.digits_text(high, 4)} an hour is shown by {minutes} min with {jams}"
        )


# --- The plan, as the sheet has it before anything was measured ---


def lines_of_fill(queue: FilledQueue, target: float, agreed_jams: float = AGREED_JAMS) -> list[SheetLine]:
    """Return the lines of one fill: rate, yield and jams with their demands and plans.

    Parameters
    ----------
    queue : FilledQueue
        What the computation saw at that fill.
    target : float [1/s]
        Good parts that are asked for.
    agreed_jams : float [1/s]
        Jams that the buyer tolerates.

    Returns
    -------
    list of SheetLine
    """
    low, high = queue.ends
    good = 100.0 * queue.right / queue.left if queue.left else None
    minutes = f"{RATE_SECONDS / units.MINUTE:.4g} min"
    return [
        SheetLine(
            Quantity.RATE,
            queue.fill,
            UNITS[Quantity.RATE],
            target / PER_MINUTE,
            None,
            queue.rate / PER_MINUTE,
            low / PER_MINUTE,
            high / PER_MINUTE,
            f"count good parts for {minutes} at least",
            sample=RATE_SECONDS,
        ),
        SheetLine(
            Quantity.YIELD,
            queue.fill,
            UNITS[Quantity.YIELD],
            100.0 * PURE,
            None,
            good,
            100.0 * evidence.share_at_least(queue.right, queue.left),
            None,
            yield_plan(PURE),
            sample=float(planned_sample(PURE, (queue.right, queue.left))),
        ),
        SheetLine(
            Quantity.JAMS,
            queue.fill,
            UNITS[Quantity.JAMS],
            None,
            agreed_jams * HOUR,
            HOUR * queue.jams / queue.seconds,
            None,
            HOUR * evidence.rate_at_most(queue.jams, queue.seconds),
            jam_plan(agreed_jams),
            sample=units.MINUTE * minutes_to_run(agreed_jams, 0),
        ),
    ]


def yield_plan(demand: float) -> str:
    """Return how many parts show a share of good ones, and how many of them may be wrong, as a text.

    Parameters
    ----------
    demand : float [1]
        The share that is to be shown.

    Returns
    -------
    str
        'accept 299 parts with none wrong; or ...'
    """
    samples = [evidence.parts_to_look_at(demand, wrong) for wrong in range(MAX_WRONG + 1)]
    first, *rest = (f"{sample} parts with {wrong or 'none'} wrong" for wrong, sample in enumerate(samples))
    return "; or ".join((f"accept {first}", *rest))


def planned_sample(demand: float, seen: tuple[int, int]) -> int:
    """Return the smallest sample of ``yield_plan`` that a feeder as computed is likely to pass.

    A sample of n parts with k wrong ones at most is passed with the binomial probability of k or fewer.

    Parameters
    ----------
    demand : float [1]
        The share that is to be shown.
    seen : (int, int)
        The right parts of the computation, and all of them.

    Returns
    -------
    int
        The largest where none of the samples is likely (``LIKELY_PASS``) to be passed.
    """
    right, left = seen
    wrong_share = 1.0 - right / left if left else 0.0
    sample = 0
    for wrong in range(MAX_WRONG + 1):
        sample = evidence.parts_to_look_at(demand, wrong)
        if stats.binom.cdf(wrong, sample, wrong_share) >= LIKELY_PASS:
            break
    return sample


def minutes_to_run(agreed_jams: float, jams: int) -> int:
    """Return for how many whole minutes no more than so many jams show fewer than agreed.

    Parameters
    ----------
    agreed_jams : float [1/s]
    jams : int

    Returns
    -------
    int
    """
    return math.ceil(evidence.time_to_run(agreed_jams, jams) / units.MINUTE - 1e-9)


def jam_plan(agreed_jams: float) -> str:
    """Return for how long a feeder runs, and how many jams are accepted, as a text.

    Parameters
    ----------
    agreed_jams : float [1/s]

    Returns
    -------
    str
        'accept 180 min with no jam; or ...'
    """
    first, *rest = (f"{minutes_to_run(agreed_jams, jams)} min with {jams or 'no jam'}" for jams in range(3))
    return "; or ".join((f"accept {first}", *rest))


# --- The sheet, filled in ---


def is_sheet(path: str | Path) -> bool:
    """Tell whether a file is an acceptance sheet: its first line names all columns that one needs.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    bool
        False of a file that cannot be read.
    """
    try:
        with Path(path).open("rb") as file:
            first = file.read(MAX_HEAD_BYTES).decode("utf-8-sig", errors="replace").splitlines()
        return set(REQUIRED_COLUMNS) <= {cell.strip() for cell in next(csv.reader(first[:1]), ())}
    except (OSError, csv.Error):
        return False


def sheet(path: str | Path) -> tuple[SheetLine, ...]:
    """Read an acceptance sheet, as ``feeder design`` writes it and someone has filled it in.

    Parameters
    ----------
    path : str or Path
        Sheets without the columns of the plan are read as well; what their columns ``low`` and ``high`` say
        is the demand.

    Returns
    -------
    tuple of SheetLine

    Raises
    ------
    FeederError
        If it cannot be read or is too large, or nothing was measured. Every cell that cannot be true is a
        fault, with its line and column: a text in place of a number, a number out of range, a contradiction.
    """
    data = documents.content(path, MAX_BYTES, "an acceptance sheet", FeederError)
    if len(data) > MAX_BYTES:
        raise FeederError(path, f"has more than {MAX_BYTES // 1000} kB", "give an acceptance sheet")
    lines, faults = list[SheetLine](), list[FeederError]()
    try:
        table = csv.DictReader(io.StringIO(documents.decoded(data, str(path)), newline=""))
        table.fieldnames = [name.strip() for name in table.fieldnames or ()]
        for row in table:
            try:
                lines.append(_line(f"{path}:{table.line_num}", row))
            except FeederError as fault:
                faults.append(fault)
    except csv.Error as error:
        raise FeederError(path, f"is not CSV ({error})", "check its quotes and commas") from None
    if faults:
        raise Faults(faults)
    if all(line.measured is None for line in lines):
        raise FeederError(str(path), "nothing was measured", "fill in the column 'measured'")
    return tuple(lines)


def _line(where: str, row: dict) -> SheetLine:
    """Return one row of the file; raises FeederError for its first cell that cannot be true."""
    if row.get(None):
        raise FeederError(where, "has more cells than columns", "write decimals with a point")
    texts = {name: units.printable((row.get(name) or "").strip()) for name in TEXT_COLUMNS}
    number_columns = [name for name in SHEET_COLUMNS if name not in TEXT_COLUMNS]
    read = {name: _number(where, name, row.get(name)) for name in number_columns}
    value = {name: number for name, (number, _) in read.items()}
    line = SheetLine(
        texts["quantity"],
        texts["fill"],
        texts["unit"],
        value["low"],
        value["high"],
        value["computed"],
        value["computed_low"],
        value["computed_high"],
        texts["plan"],
        value["measured"],
        value["sample"],
        measured_step=read["measured"][1],
    )
    for column, what, mend in _contradictions(line):
        raise FeederError(where, f"column '{column}': {what}", mend)
    return line


def _number(where: str, name: str, text: str | None) -> tuple[float | None, float]:
    """Return a cell as a number, None where it is empty, and half a unit of its last digit."""
    text = (text or "").strip()
    if not text:
        return None, 0.0
    whole, comma, digits = text.partition(",")
    if comma and len(digits) == 3 and "." not in text:  # 1,250: one and a quarter, or a thousand and more
        what = f"column '{name}': {units.quantity_text(text)} may be {whole}.{digits} or {whole}{digits}"
        raise FeederError(where, what, "write it without a comma")
    plain = text.replace(",", ".")
    try:
        value = units.decimal(plain)
    except units.QuantityError as fault:
        mend = "write a number alone, the unit is in its own column"
        raise FeederError(where, f"column '{name}': {fault.what}", mend) from fault
    mantissa, _, exponent = plain.lower().partition("e")
    decimals = len(mantissa.partition(".")[2]) - int(exponent or 0)
    return value, 0.5 * 10.0 ** -min(max(decimals, -300), 300)


def _contradictions(line: SheetLine) -> Iterator[tuple[str, str, str]]:
    """Yield each column that cannot be true, what is wrong with it, and how to mend it."""
    quantity = Quantity(line.quantity) if line.quantity in set(Quantity) else None
    if not line.quantity:
        yield "quantity", "is empty", "write what was measured, or leave the line out"
    if quantity is not None and line.unit != UNITS[quantity]:
        yield "unit", f"is {line.unit!r}", f"write {UNITS[quantity]}, and the values in it"
    is_demanded = quantity in (Quantity.YIELD, Quantity.JAMS) or (line.low, line.high) != (None, None)
    if not is_demanded and line.computed is None:
        yield "computed", "is empty, and nothing is demanded", "leave that column as it was"
    # ranges
    most = 100.0 if quantity is Quantity.YIELD else math.inf
    for column in ("computed", "computed_low", "computed_high", "low", "high", "measured"):
        value = getattr(line, column)
        if value is not None and quantity is not None and not 0.0 <= value <= most:
            mend = "write 0 or more" if math.isinf(most) else f"write 0 to {most:g}"
            yield column, f"{value:.6g} {line.unit} cannot be", mend
    for names in (("low", "high"), ("computed_low", "computed", "computed_high")):
        given = [(name, getattr(line, name)) for name in names if getattr(line, name) is not None]
        for (low, less), (high, more) in itertools.pairwise(given):
            if less > more:
                yield low, f"{less:.6g} is above {more:.6g} in '{high}'", "exchange the two"
    # demands that no sample shows
    demand = line.demand
    if quantity is Quantity.YIELD and not 0.0 < demand[0] < 100.0:
        yield "low", f"a yield of {demand[0]:g} % is shown by no sample", f"write {100.0 * PURE:g}"
    if quantity is Quantity.JAMS and not demand[1] > 0.0:
        yield "high", "no run shows that there are no jams at all", f"write {AGREED_JAMS * HOUR:g}"
    # the sample
    sample = line.sample
    if sample is None:
        return
    if quantity in (Quantity.RATE, Quantity.JAMS):
        if not MIN_SECONDS <= sample <= MAX_SECONDS:
            yield "sample", f"a run of {sample:.6g} s cannot be", f"write {MIN_SECONDS:g} s or more"
    elif not 1.0 <= sample <= evidence.MAX_SAMPLE or sample != math.floor(sample):
        yield "sample", f"{sample:.6g} parts cannot be", "write how many were looked at, a whole number"
    elif quantity is Quantity.YIELD and line.measured is not None and line.good is None:
        near = math.floor(0.01 * line.measured * sample)
        ends = " or ".join(f"{100.0 * good / sample:.6g} ({good} good)" for good in (near, near + 1))
        what = f"{line.measured:.6g} % of {sample:.0f} parts is no whole number of parts"
        yield "measured", what, f"write {ends}"
