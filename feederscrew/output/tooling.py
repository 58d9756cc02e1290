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
    files = [
        offer.table("tooling.csv", tables.frame, study),
        offer.document("tooling.json", tables.document, study),
        offer.picture("tooling.png", "Orientations and what isolates them", picture, study),
    ]
    if study.design is None or not study.design.devices:
        return marking.pictures(files, mark)
    files = [
        *files,
        offer.text("tooling.yaml", tables.bowl_file, study, settings),
        offer.text("tooling.dxf", _drawn, "dxf", study, mark, fields),
        offer.text("tooling.svg", _drawn, "svg", study, mark, fields),
        offer.text(marking.file_name("tooling.stl", mark), _printed, study, mark),
        *([offer.text(marking.file_name("tooling.step", mark), _quoted, study, mark)] if step else []),
        *_views(study),
    ]
    return marking.pictures(files, mark)


def picture(study):
    """Return the figure of a study: the chain of the orientation asked for, or all with their limits."""
    from feederscrew.output import tooling_figures as figures

    if study.design is None or not study.design.devices:
        return figures.limits(study)
    return figures.chain(_devices(study), study.orientations, study.shares, study.wanted)


def chain_picture(devices, orientations, shares):
    """Offer the picture of a bowl's own devices.

    Parameters
    ----------
    devices : sequence of Device
    orientations : sequence of Orientation
    shares : (M,) float [1]

    Returns
    -------
    Offer
    """

    def draw():
        from feederscrew.output import tooling_figures as figures

        return figures.chain(devices, orientations, shares)

    return offer.picture("tooling.png", "Each orientation where each device bears least", draw)


def _views(study) -> list[Any]:
    """The part over the cuts in three dimensions, where there is a cut to see."""
    pictures = [device.picture for device in study.design.devices if device.placed and not device.turns]
    if not any(pictures):
        return []

    arguments = study.design.devices, study.orientations, study.shares, study.wanted
    return [solid_picture(*arguments)]


def solid_picture(devices, orientations, shares, wanted):
    """Offer the picture of a part over the cuts, in three dimensions.

    Parameters
    ----------
    devices : sequence of Device
    orientations : sequence of Orientation
    shares : (M,) float [1]
    wanted : int

    Returns
    -------
    Offer
    """

    def draw():
        from feederscrew.output import tooling_views

        return tooling_views.figure(devices, orientations, shares, wanted)

    text = "The part over the cut: what passes, and the nearest that falls"
    return offer.picture("tooling_3d.png", text, draw)


def _drawn(kind, study, mark, fields):
    from feederscrew.output import tooling_drawing as drawing

    section = _strip(study)
    wanted = study.orientations[study.wanted]
    outline = np.add(wanted.outline, [0.0, wanted.distance])
    places = [station.start + 0.5 * station.length for station in section.stations if station.hole is None]
    ghosts = [(outline, place) for place in (0.6 * wanted.length, *places)]
    titles = [("tooling for", study.part.name), ("leaves as", wanted.name)]
    return getattr(drawing, kind)(
        section, ghosts, mark, thickness=study.bowl.sizing.sheet, fields=fields, titles=titles
    )


def _printed(study, mark):
    from feederscrew.output import solid_files

    return solid_files.section_stl(_strip(study), mark)


def _quoted(study, mark):
    from feederscrew.solidbowl.exact import exact_file

    return marking.mark_step(exact_file.section_file(_strip(study)), mark)


def _strip(study):
    return build_section(study.bowl.track, _devices(study), study.orientations)


def _devices(study):
    return study.design.devices
