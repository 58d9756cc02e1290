"""Comparisons of profiles as a table and as a document."""

from feederscrew.output import tables

TESTS = ("chi_square", "degrees_of_freedom", "p_value")  # columns of the test, which needs counts


def comparisons(study):
    """Return every pair of profiles, a row each.

    Parameters
    ----------
    study : CompareStudy

    Returns
    -------
    Frame
        The columns of ``compare.csv``; those of the test are empty where neither profile holds counts.
    """
    return _frame(study.comparisons)


def shown(study, format):
    """Return what is printed: for people each measured profile with the rules, the nearest one first.

    Parameters
    ----------
    study : CompareStudy
    format : str
        Of what is printed; the table leaves out how far rules are from each other, which the files hold.

    Returns
    -------
    Frame
    """
    if format != "table":
        return comparisons(study)
    order = [one.name for one in study.measured.profiles]
    own = [each for each in study.comparisons if each.first.name in order]
    beside = [each for each in own if each.second.name not in order]
    beside.sort(key=lambda each: (order.index(each.first.name), each.total_variation))
    return _frame([*beside, *(each for each in own if each.second.name in order)])


def _frame(compared):
    tests = [each.chi_square for each in compared]
    return tables.frame(
        {
            "first": [each.first.name for each in compared],
            "second": [each.second.name for each in compared],
            "deviation": [each.deviation for each in compared],
            "total_variation": [each.total_variation for each in compared],
            "chi_square": [test.statistic for test in tests],
            "degrees_of_freedom": [test.degrees_of_freedom or None for test in tests],
            "p_value": [test.p_value for test in tests],
        }
    )


def hidden(study):
    """Return the columns that a table for people leaves out, as they hold nothing."""
    return () if any(each.chi_square.degrees_of_freedom for each in study.comparisons) else TESTS


def document(study):
    """Return the comparison as one JSON document.

    Parameters
    ----------
    study : CompareStudy

    Returns
    -------
    dict
    """
    listed = [
        {"name": p.name, "kind": p.kind, "values": p.values, "fractions": p.fractions} for p in study.profiles
    ]
    return {
        "part": study.part.name,
        "aspects": list(study.aspects.names),
        "profiles": listed,
        "comparisons": comparisons(study),
    }
