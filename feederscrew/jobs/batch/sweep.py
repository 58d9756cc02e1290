"""A study over ranges of values of a bowl, or of its own keywords, as one table."""

import contextlib
import inspect
import itertools
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np

from feederscrew.base import processes, units
from feederscrew.base.errors import ArgumentError, FeederError
from feederscrew.base.records import ReadableRecord
from feederscrew.base.running import OnCores
from feederscrew.base.signatures import Keywords, with_shown_signature
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.values import BY_WORD, refuse_unknown
from feederscrew.output import record_views, tables

if TYPE_CHECKING:
    from pandas import DataFrame

MAX_STUDIES = 100_000  # of one call
RECORD_MEND = "give a function of this library that returns a record, fs.convey"


@with_shown_signature
def sweep(
    function: Callable[..., ReadableRecord],
    *arguments: Any,
    table: str | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    **ranges: Any,
) -> "DataFrame":
    """Return a study at each combination of values as one table, ``fs.sweep(fs.convey, bowl, climb=[...])``.

    Parameters
    ----------
    function : callable
        A function of this library: ``fs.convey``, ``fs.rate``, ``fs.trial`` ...
    *arguments
        Its arguments. A Bowl among them is given each combination of values.
    table : str, optional
        Name of a table of the study, as for ``to_frame``, whose rows are taken in place of its answer.
    jobs : int, optional
        Combinations that are computed at the same time, on Linux; as many as there are cores without it. The
        table does not depend on it.
    progress : callable, optional
        Called with how many are done, and of how many.
    **ranges : list or one value
        Keys of a bowl file by their last word, frequency=['40 Hz', '50 Hz'], or keywords of ``function``,
        heading=['0 deg', '90 deg']. A list is swept, and one value holds for all.

    Returns
    -------
    DataFrame
        A row a study, the last range fastest: a column for each list, then the numbers of the document that
        its command writes. A key of a bowl stands in the unit of its column, 'frequency_Hz'.

    Raises
    ------
    FeederError
        If a value cannot be used, or a study cannot be computed.
    TypeError
        If a keyword is neither a key of a bowl nor of the function.
    """
    own = inspect.signature(function).parameters
    refuse_unknown(
        getattr(function, "__name__", "sweep"), [name for name in ranges if name not in own], [*own]
    )
    of_bowl = [name for name in ranges if name not in own]
    bowls = [argument for argument in arguments if isinstance(argument, Bowl)]
    if of_bowl and not bowls:
        raise ArgumentError(of_bowl[0], "is a key of a bowl, and no bowl is given", "give a Bowl as well")
    lists = {name: _listed(name, values) for name, values in ranges.items()}
    swept = [name for name, values in ranges.items() if _is_list(values)]
    count = int(np.prod([len(values) for values in lists.values()], dtype=float))
    if count > MAX_STUDIES:
        raise ArgumentError(swept[0], f"gives {count} combinations", f"give at most {MAX_STUDIES} in all")
    combinations = [dict(zip(lists, values)) for values in itertools.product(*lists.values())]
    # every bowl first: a value that cannot be used is said before anything is computed
    calls = [_call(arguments, combination, of_bowl) for combination in combinations]
    frames: list[DataFrame] = []
    for place, frame in enumerate(_on_cores(function, table, calls, min(OnCores(jobs).cores, count))):
        for column, name in enumerate(swept):
            title, value = _column(name, combinations[place][name], name in of_bowl)
            if title in frame:  # the study says it as well
                frame = frame.drop(columns=title)
            frame.insert(column, title, [value] * len(frame))
        frames.append(frame)
        if progress is not None:
            progress(place + 1, count)
    return tables.joined(frames)


def _is_list(values: object) -> bool:
    return isinstance(values, (list, tuple, range, np.ndarray))


def _listed(name: str, values: Any) -> Sequence[Any]:
    if not _is_list(values):
        return (values,)
    if not len(values):
        raise ArgumentError(name, "is an empty list", "give values")
    return [value.item() if isinstance(value, np.generic) else value for value in values]


def _column(name: str, value: Any, is_of_bowl: bool) -> tuple[str, Any]:
    """The title of the column of a range, and a value as it stands there."""
    if not is_of_bowl:
        return name, value
    key = BY_WORD[name]
    if key.choices:
        return key.column, value
    in_si = key.value(value) if isinstance(value, str) else units.from_quantity(value, key.dimension)
    return key.column, float(cast(float, in_si)) / units.factor(key.unit, key.dimension)


def _call(
    arguments: Sequence[Any], combination: Mapping[str, Any], of_bowl: Collection[str]
) -> tuple[list[Any], Keywords]:
    """The arguments and keywords of a study at a combination."""
    values = {name: combination[name] for name in of_bowl}
    own = {name: value for name, value in combination.items() if name not in of_bowl}
    return [one.with_values(**values) if isinstance(one, Bowl) else one for one in arguments], own


Call: TypeAlias = tuple[list[Any], Keywords]


def _rows(function: Callable[..., ReadableRecord], table: str | None, call: Call) -> "DataFrame":
    record = function(*call[0], **call[1])
    if not isinstance(record, ReadableRecord):
        raise ArgumentError("function", f"returns a {type(record).__name__}", RECORD_MEND)
    return record_views.row(record) if table is None else record.to_frame(table)


def _on_cores(
    function: Callable[..., ReadableRecord], table: str | None, calls: Sequence[Call], cores: int
) -> Iterator["DataFrame"]:
    """Yield the rows of each call in turn; computed on several cores where the system can fork.

    Forked processes take any function, which those that are started anew do not. Where a thread of Python
    runs, or the system cannot fork, one call follows the other.
    """
    if cores < 2 or not processes.can_fork():
        yield from (_rows(function, table, call) for call in calls)
        return

    def outcome(place: int) -> "DataFrame | Exception":
        try:
            return _rows(function, table, calls[place])
        except Exception as fault:  # noqa: BLE001 - raised again by the process that asked
            return fault

    done: dict[int, DataFrame | Exception] = {}
    turn = 0
    work = processes.work_on(range(len(calls)), lambda: processes.forked_process(outcome), cores)
    try:
        with contextlib.closing(work):
            for place, made in work:
                done[place] = made
                while turn in done:
                    rows = done.pop(turn)
                    if isinstance(rows, Exception):
                        raise rows
                    yield rows
                    turn += 1
    except processes.ProcessEnded:
        what = "a process ended over a combination, perhaps for lack of memory"
        raise FeederError("sweep", what, "give fewer jobs") from None
