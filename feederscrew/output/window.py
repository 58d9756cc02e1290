"""Tables folded to the width of a window."""

import textwrap
from typing import Any

Columns = dict[str, list[str]]
GAP, LEAST = "  ", 12  # between columns; letters that a column always has
SLENDER = 20  # letters of a column of texts that is never made narrower so that the others fit beside it
MOST_NAMING = 3  # columns that name a row, at most


def folded(columns: Columns, width: int) -> list[Any]:
    """Fold a table to a window.

    Parameters
    ----------
    columns : dict of str to list of str
        Cells of one width by the name of the column, in order.
    width : int
        Letters of a line.

    Returns
    -------
    list of list of list of str
        Pieces that fit, each headed by the columns that name its rows; texts too long go on below.
    """
    names = list(columns)
    count = _naming(list(columns.values()), width)
    widest = max((len(columns[name][0]) for name in names[count:]), default=0)
    room = max(width - count * len(GAP) - min(widest, width // 2), width // 2)
    head = [_broken(columns[name], max(room // count, LEAST)) for name in names[:count]]
    room = max(width - _wide(head), LEAST)
    groups: list[list[str]] = []  # a value and the ends of its interval stay together
    for name in names[count:]:
        if groups and name.endswith(("_low", "_high")):
            groups[-1].append(name)
        else:
            groups.append([name])
    pieces = [[*head]]
    for group in groups:
        added = [_broken(columns[name], room - len(GAP)) for name in group]
        if _wide([*pieces[-1], *added]) > width and len(pieces[-1]) > count:
            pieces.append([*head])
        pieces[-1] += added
    return [_in_lines(piece) for piece in pieces]


def narrowed(columns: Columns, texts: Any, width: int) -> list[Any] | None:
    """Return columns that fit a width, the widest of ``texts`` made narrower until all stand side by side.

    Texts too long go on below; None where that takes columns too narrow to read.
    """
    wide = {name: len(cells[0]) for name, cells in columns.items()}
    excess = sum(wide.values()) + len(GAP) * (len(wide) - 1) - width
    while excess > 0:
        widest = max(texts, key=wide.__getitem__, default=None)
        if widest is None or wide[widest] <= SLENDER:
            return None
        wide[widest] -= 1
        excess -= 1
    return _in_lines([_broken(cells, wide[name]) for name, cells in columns.items()])


def spared(wide: dict[str, int], spare: Any, width: int) -> list[str]:
    """Return the names of columns to leave out so that the others fit; ``wide`` has the letters of each.

    ``spare`` are columns that may go, in groups that go together, the first group first.
    """
    gone: list[str] = []
    for group in spare:
        letters_left = [letters for name, letters in wide.items() if name not in gone]
        if sum(letters_left) + len(GAP) * (len(letters_left) - 1) <= width:
            break
        gone += [name for name in group if name in wide]
    return gone


def _naming(columns: list[list[str]], width: int) -> int:
    """How many columns, the first ones, it takes to name a row."""
    for count in range(1, min(MOST_NAMING, len(columns)) + 1):
        listed = list(zip(*columns[:count]))
        wide = sum(len(column[0]) + len(GAP) for column in columns[:count])
        if len(set(listed)) == len(listed) and wide <= width // 2:
            return count
    return 1


def _wide(columns: list[Any]) -> int:
    return sum(len(column[0][0]) for column in columns) + len(GAP) * (len(columns) - 1)


def _broken(column: list[str], most: int) -> list[list[str]]:
    """The lines of each cell of a column, all of one width."""
    if len(column[0]) <= most:
        return [[cell] for cell in column]
    listed = [textwrap.wrap(cell, most, break_on_hyphens=False) or [""] for cell in column]
    width = max(len(line) for lines in listed for line in lines)
    return [[line.ljust(width) for line in lines] for lines in listed]


def _in_lines(columns: list[Any]) -> list[Any]:
    """The columns with as many lines for each row as its longest cell has."""
    heights = [max(map(len, cells)) for cells in zip(*columns)]

    def filled(lines: list[str], high: int) -> list[str]:
        return [*lines, *[" " * len(lines[0])] * (high - len(lines))]

    return [[line for c, high in zip(column, heights) for line in filled(c, high)] for column in columns]
