"""What ``feeder headings`` leaves in its folder."""

from feederscrew.output import heading_plots, heading_tables, plots, tables


def headings(folder, part, postures, found, track, document, *, pictures=True):
    """Write the table and a picture an aspect.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    postures : sequence of Posture
    found : sequence of Headings
        One a posture.
    track : Track
    document : dict
        Of the JSON file.
    pictures : bool
        Draw as well.
    """
    folder.write("headings.json", tables.json_text(document))
    folder.write("headings.csv", tables.text(heading_tables.frame(document["headings"]), "csv"))
    if not pictures:
        return
    for standing, one in zip(postures, found):
        title = f"{part.name}, aspect {standing.name}: heading, share"
        drawn = heading_plots.headings(standing, one, track, title)
        folder.write(f"headings_{standing.name}.png", plots.png(drawn))
