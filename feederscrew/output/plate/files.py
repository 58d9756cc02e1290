"""The files of a dynamic bowl test."""

from feederscrew.output import tables
from feederscrew.output.plate import tables as plate_tables


def write(folder, part, aspects, results, names, document, *, pictures=True):
    """The files of ``feeder drop --plate``.

    Parameters
    ----------
    folder : ResultFolder
    part : Part
    aspects : Aspects
    results : sequence of feederscrew.dropping.plate.runs.Shaken
    names : sequence of str
        Of the bowl of each result.
    document : dict
        Of the JSON file.
    pictures : bool
        False for the tables only.
    """
    for name, table in (("plate", "plates"), ("plate_rates", "rates"), ("plate_time", "course")):
        frame = getattr(plate_tables, table)(aspects, results, names)
        folder.write(f"{name}.csv", tables.text(frame, "csv"))
    folder.write("plate_drives.csv", tables.text(plate_tables.drives(results, names), "csv"))
    folder.write("plate.json", tables.json_text(document))
    if pictures:
        from feederscrew.output import style
        from feederscrew.output.plate import figures as plate_plots

        figure = (
            plate_plots.one(_title(part, results[0]), aspects, results[0])
            if len(results) == 1
            else plate_plots.trend(_over(part, results), aspects, results, names)
        )
        folder.write("plate.png", style.png(figure))


def _title(part, result):
    return f"{part.name}: {result.parts} parts, throw number {result.throw_number:.3g}"


def _over(part, results):
    return f"{part.name} on {len(results)} plates" + ", partial" * results[-1].partial
