"""Files of ``feeder tooling``."""

from typing import Any

import numpy as np

from feederscrew.output import marking
from feederscrew.output import offers as offer
from feederscrew.output import tooling_tables as tables
from feederscrew.tooling.track_sections import build_section


def offers(study, settings, step=False, mark="", fields=None):
    """Offer the files of a ToolingStudy, as a list of Offer.

    Parameters
    ----------
    study : ToolingStudy
    settings : sequence of Setting
        Of its bowl.
    step : bool
        Offer the section of track as STEP as well, which needs OpenCASCADE.
    mark : str
        On every drawing, picture and solid.
    fields : marking.SheetFields, optional
        Date and revision of the drawing.

    Returns
    -------
    list of Offer
        Table, document and picture; of one orientation with devices that isolate it the bowl file and the
        drawings as well.
    """
    found = [
        offer.table("tooling.csv", tables.frame, study),
        offer.document("tooling.json", tables.document, study),
        offer.picture("tooling.png", "Orientations and what isolates them", picture, study),
    ]
    if study.design is None or not study.design.devices:
        return marking.pictures(found, mark)
    found = [
        *found,
        offer.text("tooling.yaml", tables.bowl_file, study, settings),
        offer.text("tooling.dxf", _drawn, "dxf", study, mark, fields),
        offer.text("tooling.svg", _drawn, "svg", study, mark, fields),
        offer.text(marking.file_name("tooling.stl", mark), _printed, study, mark),
        *([offer.text(marking.file_name("tooling.step", mark), _quoted, study, mark)] if step else []),
        *_views(study),
    ]
    return marking.pictures(found, mark)


def picture(study):
    """Return the figure of a study: the chain of the orientation asked for, or all with their limits."""
    from feederscrew.output import tooling_figures as figures

    if study.design is None or not study.design.devices:
        return figures.limits(study)
    return figures.chain(_devices(study), study.orientations, study.shares, study.wanted)


def chain_picture(devices, every, shares):
    """Offer the picture of a bowl's own devices.

    Parameters
    ----------
    devices : sequence of Device
    every : sequence of Orientation
    shares : (M,) float [1]

    Returns
    -------
    Offer
    """

    def draw():
        from feederscrew.output import tooling_figures as figures

        return figures.chain(devices, every, shares)

    return offer.picture("tooling.png", "Each orientation where each device bears least", draw)


def _views(study) -> list[Any]:
    """The part over the cuts in three dimensions, where there is a cut to see."""
    seen = [device.picture for device in study.design.devices if device.placed and not device.turns]
    if not any(seen):
        return []

    given = study.design.devices, study.orientations, study.shares, study.wanted
    return [solid_picture(*given)]


def solid_picture(devices, every, shares, wanted):
    """Offer the picture of a part over the cuts, in three dimensions.

    Parameters
    ----------
    devices : sequence of Device
    every : sequence of Orientation
    shares : (M,) float [1]
    wanted : int

    Returns
    -------
    Offer
    """

    def draw():
        from feederscrew.output import tooling_views

        return tooling_views.figure(devices, every, shares, wanted)

    text = "The part over the cut: what passes, and the nearest that falls"
    return offer.picture("tooling_3d.png", text, draw)


def _drawn(kind, study, mark, fields):
    from feederscrew.output import tooling_drawing as drawing

    made = _strip(study)
    one = study.orientations[study.wanted]
    outline = np.add(one.outline, [0.0, one.distance])
    places = [station.start + 0.5 * station.length for station in made.stations if station.hole is None]
    ghosts = [(outline, place) for place in (0.6 * one.length, *places)]
    titles = [("tooling for", study.part.name), ("leaves as", one.name)]
    return getattr(drawing, kind)(
        made, ghosts, mark, thickness=study.bowl.sizing.sheet, fields=fields, titles=titles
    )


def _printed(study, mark):
    from feederscrew.output import solid_files

    return solid_files.section_stl(_strip(study), mark)


def _quoted(study, mark):
    from feederscrew.solidbowl.exact import exact_section

    return marking.mark_step(exact_section.section_file(_strip(study)), mark)


def _strip(study):
    return build_section(study.bowl.track, _devices(study), study.orientations)


def _devices(study):
    return study.design.devices
