"""What ``feeder headings`` leaves in its folder."""

from feederscrew.output import style, tables
from feederscrew.output.headings import figures as heading_plots
from feederscrew.output.headings import tables as heading_tables


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
        folder.write(f"headings_{standing.name}.png", style.png(drawn))
