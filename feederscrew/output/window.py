"""Tables folded to the width of a window."""

GAP, LEAST = "  ", 12  # between columns; letters that a column always has
MOST_NAMING = 3  # columns that name a row, at most


def folded(columns, width):
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
        Pieces that fit, each headed by the columns that name its rows; texts too long are cut.
    """
    names = list(columns)
    count = _naming(list(columns.values()), width)
    head = [_cut(columns[name], max(width // (2 * count), LEAST)) for name in names[:count]]
    room = max(width - _wide(head), LEAST)
    pieces = [[*head]]
    for group in _groups(names[count:]):
        added = [_cut(columns[name], room - len(GAP)) for name in group]
        if _wide([*pieces[-1], *added]) > width and len(pieces[-1]) > count:
            pieces.append([*head])
        pieces[-1] += added
    return pieces


def _naming(columns, width):
    """How many columns, the first ones, it takes to name a row."""
    for count in range(1, min(MOST_NAMING, len(columns)) + 1):
        told = list(zip(*columns[:count]))
        if len(set(told)) == len(told) and _wide(columns[:count]) <= width // 2:
            return count
    return 1


def _groups(names):
    """Names of columns that stay together: a value and the ends of its interval."""
    groups = []
    for name in names:
        if groups and name.endswith(("_low", "_high")):
            groups[-1].append(name)
        else:
            groups.append([name])
    return groups


def _wide(columns):
    return sum(len(column[0]) for column in columns) + len(GAP) * (len(columns) - 1)


def _cut(column, most):
    return [cell if len(cell) <= most else f"{cell[: most - 1]}…" for cell in column]
