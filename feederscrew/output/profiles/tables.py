"""Comparisons of profiles as tables and documents."""

from feederscrew.output import style, tables
from feederscrew.output.profiles import figures as profile_plots


def comparisons(compared, format="csv"):
    """Every pair of profiles, a row each.

    Parameters
    ----------
    compared : sequence of Comparison
    format : str
        What it is for; 'table' leaves out columns that hold nothing.

    Returns
    -------
    DataFrame
        The columns of ``compare.csv``; empty where neither profile holds counts.
    """
    tests = [each.chi_square for each in compared]
    columns = {
        "first": [each.first.name for each in compared],
        "second": [each.second.name for each in compared],
        "deviation": [each.deviation for each in compared],
        "total_variation": [each.total_variation for each in compared],
        "chi_square": [test.statistic for test in tests],
        "degrees_of_freedom": [test.degrees_of_freedom or None for test in tests],
        "p_value": [test.p_value for test in tests],
    }
    if format != "table":
        return tables.frame(columns)
    if not any(test.degrees_of_freedom for test in tests):
        columns = dict(list(columns.items())[:4])
    return tables.frame(columns)


def document(names, profiles, compared):
    """The comparison as one JSON document.

    Parameters
    ----------
    names : sequence of str
        The A aspects.
    profiles : sequence of Profile
    compared : sequence of Comparison

    Returns
    -------
    dict
    """
    listed = [
        {"name": p.name, "kind": p.kind, "values": p.values, "fractions": p.fractions} for p in profiles
    ]
    return {"aspects": list(names), "profiles": listed, "comparisons": comparisons(compared)}


def write(folder, title, names, profiles, compared, *, pictures=True):
    """The files of ``feeder compare``.

    Parameters
    ----------
    folder : ResultFolder
    title : str
        The part's name.
    names, profiles, compared
        As in `document`.
    pictures : bool
        False for the table only.
    """
    folder.write("compare.csv", tables.text(comparisons(compared), "csv"))
    if pictures:
        measured = {p.name: p.fractions for p in profiles if p.kind != "rule"}
        rules = {p.name: p.fractions for p in profiles if p.kind == "rule"}
        pairs = {(each.first.name, each.second.name): each.deviation for each in compared}
        drawn = profile_plots.comparison(title, names, measured, rules, pairs)
        folder.write("compare.png", style.png(drawn))
