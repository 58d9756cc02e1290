"""The files of each command, put together for its folder."""

import numpy as np

from feederscrew.output import tables

MOST = 24  # rows that a picture shows


def aspects(folder, part, found, document, *, graph=False, pictures=True):
    """Write the table of aspects and its pictures.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    found : Aspects
    document : dict
        Of the JSON file; its ``aspects`` is the table.
    graph : bool
        Write the tipping graph as well.
    pictures : bool
        False for the tables only.

    Returns
    -------
    list of str
        What the user should know of files that are not there.
    """
    folder.write("aspects.csv", tables.text(document["aspects"], "csv"))
    folder.write("aspects.json", tables.json_text(document))
    if graph:
        _graph(folder, part, found, pictures)
    if not pictures:
        return []
    from feederscrew.output import style
    from feederscrew.output.aspects import bars

    stable = np.flatnonzero(found.stable)[:MOST]
    names = [found.names[row] for row in stable]
    profiles = {rule: chance[stable] for rule, chance in found.probabilities.items()}
    title = f"{part.name} (open surface)" if part.open_surface else part.name
    folder.write("probabilities.png", style.png(bars.probabilities(names, profiles, title=title)))
    if part.vertices is None:
        return ["a part card has no shape to draw: no aspects.png"]
    from feederscrew.output.aspects import picture

    count = len(found.names)
    folder.write("aspects.png", style.png(picture.aspects(part, found, range(min(count, MOST)))))
    return [f"aspects.png shows the first {MOST} of {count} rows"] if count > MOST else []


def _graph(folder, part, found, pictures):
    from feederscrew.output.graph import files as graph_sheets
    from feederscrew.resting.tumbling.by_class import ground, transitions

    ways = transitions(ground(part, found))
    shares = found.probabilities["quasistatic"]
    graph_sheets.write(folder, part, found, ways, shares, pictures=pictures)
