"""One page on a part in a bowl: what is known of it, as an HTML file that needs no other, or as Markdown."""

import gc
import platform
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from importlib import metadata
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from feederscrew import __version__
from feederscrew import bowl as bowls
from feederscrew.arrivals.aspects_study import AspectsStudy
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import Column, Document, Frame, of_arrays
from feederscrew.base.errors import FeederError
from feederscrew.base.units import DEG, MM, MM_S
from feederscrew.bowl.record import Bowl
from feederscrew.feeding.well_oriented import Rate, fed
from feederscrew.motion.conveying import UnsteadyMotion
from feederscrew.motion.floor_balance import HOP
from feederscrew.motion.limits import Regime
from feederscrew.output import aspects as aspects_output
from feederscrew.output import convey as convey_output
from feederscrew.output import floor as floor_output
from feederscrew.output import headings as headings_output
from feederscrew.output import (
    inertia,
    machine,
    marking,
    poses,
    proof,
    shading,
    solidbowl_views,
    style,
    tables,
    tooling_views,
)
from feederscrew.output import rate as rate_output
from feederscrew.output import slide as slide_output
from feederscrew.output import tooling as tooling_output
from feederscrew.output import track as track_output
from feederscrew.output.folder import LIBRARIES, ResultFolder
from feederscrew.output.offers import Offer, RecordView, by_name
from feederscrew.output.offers import text as text_file
from feederscrew.output.page.as_html import NOTHING, SHORT, html
from feederscrew.output.page.as_markdown import markdown
from feederscrew.output.page.blocks import (
    Block,
    Chapter,
    Code,
    CsvSheet,
    Knob,
    Knobs,
    Notes,
    Page,
    Picture,
    ShareBar,
    Table,
    Text,
    Tile,
    Views,
)
from feederscrew.output.record_lines import aspects_text
from feederscrew.output.report import STROKE_RANGE, ReportStudy
from feederscrew.output.shading import short
from feederscrew.output.trial import rides
from feederscrew.output.trial import tables as trial_tables
from feederscrew.part.record import Part
from feederscrew.resting.aspects import Aspects
from feederscrew.sorting import tipping
from feederscrew.sorting.device_passages import Passage
from feederscrew.sorting.orientations import Orientation
from feederscrew.trials.course import Fate

PART_FACTS = (  # rows of the inertia that the chapter on the part shows
    "density_g_cm3",
    "mass_g",
    "volume_mm3",
    "bounding_box_x_mm",
    "bounding_box_y_mm",
    "bounding_box_z_mm",
    "centre_of_mass_x_mm",
    "centre_of_mass_y_mm",
    "centre_of_mass_z_mm",
    "principal_moment_1_g_mm2",
    "principal_moment_2_g_mm2",
    "principal_moment_3_g_mm2",
)
HEADINGS = (  # columns of the table of headings
    "aspect",
    "heading_deg",
    "share",
    "aspect_share",
    "length_mm",
    "width_mm",
    "overhang_mm",
    "falls_off",
)
SHARES = {"share": "of this aspect", "aspect_share": "of all drops"}  # words above two of them
WORDS = tables.REGIME_WORDS | {Regime.STICK: "sticks, does not travel"}  # of a regime
METHOD_LIMITS = (
    "How often a part lands on an aspect: the rules compute from the part's shape and mass alone; only "
    "p_recommended knows how the part is launched, and none considers other parts. They disagree, "
    "and on real parts each is right in some cases only. The interval of p_recommended holds for the launch "
    "it names. Where much depends on it, drop the part a few hundred times and let your own counts decide "
    "(feeder compare).",
    "The part is rigid and, unless its centre of mass was given, homogeneous. A mesh is a polyhedron: its "
    "curved sides are a little smaller than the part's. Two aspects that are mirror images have the same "
    "numbers.",
    "Friction is Coulomb's, with one static and one kinetic value. The limits of slip and hop are exact "
    "for that model; the coefficients are yours to measure, and velocity depends on them more than on "
    "anything else.",
    "The velocity is of a point mass on the track: tipping, turning and the push of the parts behind are "
    "left out. A flight ends in an impact with one coefficient of restitution.",
    "Forces on the floor and on the track are of one part alone, of the rigid body at each instant of the "
    "drive, as long as it keeps contact; what it does after it lifts off is not followed.",
    "The rate counts parts one behind the other with the gap given. A returned part is taken to land again "
    "like a fresh one; parts do not help or hinder each other at the devices.",
)
THROWN = "It is thrown: the reactions below are those of the contact; conveying follows its flights."
VERDICT_WORDS = {  # what the rate has it do
    tipping.STAYS: "It stays on its aspect through the stroke.",
    tipping.THROWN: THROWN,
    tipping.OVER: "The drive turns it over: it goes back into the bowl, and the rate is 0.",
    tipping.BACK: "It lies on its round side and rolls back down the climb, so the rate is 0.",
    tipping.ROCKS: (
        "It rocks: at an instant the line of action leaves the contact, a stroke tilts it by {:.2g} deg, and"
        " only from {:.3g} deg on would it turn over."
    ),
}
ChapterRow = tuple[str, str, Callable[[ReportStudy], Chapter | None]]
FORMATS = ("html", "md")
BESIDE = "report/"  # folder of the pictures, beside the text


# --- The part, and how it comes to rest ---


def the_part(case: ReportStudy) -> Chapter:
    """Return mass properties and warnings.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    part = case.part
    facets = "a part card: published data, no shape" if part.faces is None else f"{len(part.faces)} facets"
    lead = Text(f"{part.source}: {facets}, lengths in {part.units}. Material: {part.material}.")
    return Chapter((lead, Table(inertia.facts(case.inertia, PART_FACTS))), warnings=tuple(part.warnings))


def aspects(case: ReportStudy) -> Chapter:
    """Return views, tables and chart of the aspects: one table of shapes and heights, one of probabilities.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    part, study = case.part, case.resting
    table = study.table()
    views: list[Block] = list(aspect_views(part, study))
    if part.vertices is not None:
        drawn = by_name(aspects_output.offers(study))["aspects.png"]
        views.insert(1, _picture(drawn, printed=True))
        views += _notes(aspects_output.remarks(study))
    straight = () if np.isfinite(table["rolling_circle_mm"]).any() else ("rolling_circle_mm",)
    columns = table.without(("normal_x", "normal_y", "normal_z", *straight))
    chances = [name for name in columns if name.startswith("p_")]
    shapes = Table(columns.without(chances)), Table(columns.only(["aspect", *chances]))
    # which aspect, and how likely: the recommended answer with its interval; for a card, what its rules span
    answer, name = study.aspects.recommended, f"aspect {case.aspect}"
    rules = [p[case.row] for p in study.aspects.probabilities.values() if np.isfinite(p[case.row])]
    if answer is not None:
        share, low, high = (percent(ends[case.row]) for ends in (answer.p, answer.low, answer.high))
        likely = f"{share} % of drops ({low} to {high} %), {answer.words}"
    elif rules:
        likely = f"{percent(min(rules))} to {percent(max(rules))} % of drops, by {len(rules)} rules"
    else:
        likely = "no rule says how often"
    tile = Tile("rests most often on" if case.aspect == case.likeliest else "wanted", name, likely)
    return Chapter((*views, *shapes), tiles=(tile,), warnings=tuple(study.aspects.warnings))


def aspect_views(part: Part, study: AspectsStudy) -> Iterator[Views | Text]:
    """Yield the views of a part on each aspect, to be turned, and what is simplified of its surface.

    Parameters
    ----------
    part : Part
    study : AspectsStudy

    Yields
    ------
    Views or Text
    """
    if part.vertices is None:
        text = "A part card is published data without a shape: there is nothing to draw or to turn."
        yield Text(text, quiet=True)
        return
    resting, captions = study.aspects, []
    rows = range(min(len(resting.names), aspects_output.MOST_DRAWN_ASPECTS))
    for row in rows:
        kind, bars = "not stable", list[ShareBar]()
        if resting.stable[row]:
            kind, answer = f"{resting.lies[row]} ×{resting.faces[row]}", resting.recommended
            if answer is not None:  # the table has the rules
                share, low, high = (float(ends[row]) for ends in (answer.p, answer.low, answer.high))
                bars.append(ShareBar("recommended", style.ANSWER, share, (low, high)))
            else:
                looks = (style.method(rule, place) for place, rule in enumerate(resting.probabilities))
                shares = (float(values[row]) for values in resting.probabilities.values())
                bars += [ShareBar(label, colour, share) for (label, colour), share in zip(looks, shares)]
        captions.append((resting.names[row], kind, tuple(bars)))
    points = part.corners / MM
    radius = float(np.sqrt((points**2).sum(axis=1).max()))
    near, heights = shading.outer_points(points / radius), resting.heights / MM
    stances = [shading.stance(near, resting.normals[row], heights[row] / radius) for row in rows]
    scene = shading.scene_of_part(part, stances[0].floor_axes @ stances[0].camera.towards_viewer)
    scene["poses"] = [
        {
            "name": resting.names[row],
            "quaternion": quaternion(standing.floor_axes),
            "height": short(heights[row]),
            "contact": [short(x) for x in resting.polygons[row].ravel() / MM],
        }
        for row, standing in zip(rows, stances)
    ]
    yield Views(scene, tuple(captions))
    if scene["facets"] < scene["all"]:
        text = f"The views show a coarser surface of {scene['facets']} facets; "
        yield Text(f"{text}every number is of all {scene['all']}.", quiet=True)


def quaternion(axes: Floats) -> list[float]:
    """Return a rotation matrix as a quaternion for the viewer.

    Parameters
    ----------
    axes : (3, 3) array

    Returns
    -------
    list of float
        (x, y, z, w)
    """
    return [short(q) for q in Rotation.from_matrix(np.array(axes)).as_quat(canonical=True)]


TIPPING_COLUMNS: tuple[Column[Aspects], ...] = (
    Column("aspect", lambda aspects: aspects.names),
    Column("p_quasistatic", lambda aspects: aspects.probabilities["quasistatic"], "share", "quasistatic"),
    Column("lowest_lift_mm", lambda aspects: np.asarray(aspects.barriers), "mm"),
    Column("energy_uJ", lambda aspects: np.asarray(aspects.barrier_energies), "uJ"),
    Column("tilts_over_at_deg", lambda aspects: np.asarray(aspects.tip_angles), "deg"),
)


def tips(case: ReportStudy) -> Chapter:
    """Return the tipping graph, from exact tumbling.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study, sides, ways = case.resting, case.resting.aspects, case.resting.transitions
    rows = np.flatnonzero(sides.stable)[: aspects_output.MOST_GRAPH_ASPECTS]
    shares = np.where(sides.stable, sides.probabilities["quasistatic"], np.nan)
    table = of_arrays(TIPPING_COLUMNS, sides).at(rows)
    lead = Text(
        "How firmly each aspect holds: the least height by which its centre of mass must be lifted "
        "before the part tips over an edge, into an equal face too, what energy that is, and the tilt "
        "of the floor that does it without sliding. Quasistatic is the share of all orientations from "
        "which the part, let go without speed, ends there."
    )
    graph = style.png(aspects_output.draw_tipping_graph(study, ways, shares))
    picture = Picture("tipping.png", graph, aspects_output.TIPPING_ALT)
    return Chapter((lead, Table(table), picture), warnings=sides.ground.tips.doubts if sides.ground else ())


# --- What the bowl does with the part: along the wall, velocity, rate, track, floor, slip ---


def headings(case: ReportStudy) -> Chapter:
    """Return how the part lies along the wall.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study = case.headings
    result = study.table()
    lead = Text(
        "The directions in which the part is stable when pushed against the wall, the share of all "
        "directions of laying down that ends in each, and the room it takes."
    )
    table = Table(result.only(HEADINGS).with_headings(SHARES))
    pictures = _pictures_of(headings_output.offers(study.only(case.aspect)), "headings")
    return Chapter((lead, table, *pictures), warnings=tuple(headings_output.remarks(study)))


def convey(case: ReportStudy) -> Chapter:
    """Return operating point and velocity, the drive as knobs, and the map of velocities.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study, mapped = case.convey, case.velocity_map
    d = convey_output.document(study)
    blocks: list[Block] = [Table(convey_output.summary(d))]
    if not study.answer.unsteady:
        (cycle,) = _pictures_of(convey_output.offers(study), "convey")
        title = convey_output.cycle_title(study.trace(), study.answer)
        blocks.append(replace(cycle, alt=f"Plate and part: {title}"))
    try:
        rate = case.rate.rate
    except FeederError:  # the chapter on the rate says why
        rate = None
    blocks += knobs(case, rate)
    if np.isfinite(mapped.grid.values["velocity"]).any():
        blocks += _pictures_of(convey_output.map_offers(mapped), "convey_map")
    else:
        text = "No drive of 5 to 60 deg and up to 2.5 times this stroke has a steady velocity here."
        blocks.append(Text(text))
    tile = Tile("travels", NOTHING, d["status"])
    if not np.isnan(d["velocity_mm_s"]):
        doubt, regime = d["friction_doubt"], WORDS.get(d["regime"], d["regime"])
        around = [d["velocity_mm_s"], doubt["velocity_less_mm_s"], doubt["velocity_more_mm_s"]]
        ends = f"{_short(np.nanmin(around))} to {_short(np.nanmax(around))} mm/s"
        note = f"{regime}; {ends} for friction {doubt['change_percent']:g} % off"
        tile = Tile("travels", f"{_short(d['velocity_mm_s'])} mm/s", note)
    warnings = (*bowls.remarks(case.settings), *convey_output.remarks(d), *study.warnings)
    return Chapter(tuple(blocks), tiles=(tile,), warnings=warnings)


def rate(case: ReportStudy) -> Chapter:
    """Return well-oriented parts a minute.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study, tried = case.rate, bowls.verified(case.path)
    own = case.part, case.bowl, study.rate.orientations.lying[study.rate.row].name
    d = proof.with_trial(rate_output.document(study), tried, *own)
    lead = Text(
        "The chain from velocity to rate. The range in brackets is over all starts, friction a fifth off, "
        "restitution where the part hops, and the interval of the shares. The second table has what the "
        "track and each device do with each orientation."
    )
    frame = d["orientations"]  # sizes stand in the chapter before
    empty = () if np.isfinite(frame["margin_mm"]).any() else ("margin_mm",)
    passing = frame.without(("length_mm", "width_mm", *empty))
    what = f"{d['aspect']} at {d['heading_deg']:.3g} deg, {percent(d['p_orientation'])} % of drops"
    if d.get("verified") and d["verified"]["parts_per_minute"] == d["parts_per_minute"]:
        what = f"as its trial showed; the rule says {_short(d['parts_per_minute_static'])}; {what}"
    value, low, high = (_short(d[f"parts_per_minute{end}"]) for end in ("", "_low", "_high"))
    tile = Tile("leaves correctly oriented", f"{value} a minute", f"{low} to {high}; {what} ({d['answer']})")
    warnings = (*rate_output.remarks(study), *study.warnings, *proof.warnings(tried, *own))
    blocks = (lead, Table(rate_output.summary(d)), Table(passing))
    return Chapter(blocks, tiles=(tile,), warnings=warnings)


def track(case: ReportStudy) -> Chapter:
    """Return reactions on the track, against the wall.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study = case.track
    grid, lying, row = study.over(case.settings), study.headings, study.row
    table = Table(track_output.summary(track_output.document(study)))
    pictures = _pictures_of(track_output.offers(study, grid), "track_part", "track_map", "track_cycle")
    lines = _notes(track_output.remarks(study) + track_output.map_remarks(grid))
    tiles: tuple[Tile, ...] = ()
    if lying is not None:
        length, width, wide = np.array([lying.lengths[row], lying.widths[row], study.bowl.track.width]) / MM
        note = f"{length:.3g} mm long, covers {width:.3g} of the track's {wide:.3g} mm"
        tiles = (Tile("lies along the wall at", f"{np.degrees(study.seat.heading):.3g} deg", note),)
    return Chapter((Text(on_track(case)), *lines, table, *pictures), tiles=tiles)


def on_track(case: ReportStudy) -> str:
    """Return what a part does on the track, in sentences.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    str
    """
    answer, stands = case.convey.answer, case.track.stands
    if answer.unsteady == UnsteadyMotion.KEEPS_SPEED:
        return "Without friction on a level track a part keeps whatever speed it has: it does not travel."
    if answer.unsteady:
        return "On this track the part slides down continuously: it does not travel."
    travels = f"{_short(answer.velocity / MM_S)} mm/s and {WORDS.get(answer.regime, answer.regime)}"
    sentences = [f"On this track the part travels at {travels}: the rate is computed with that."]
    if HOP in case.track.cycle.state and stands and stands.verdict != tipping.THROWN:
        sentences.append(THROWN)
    if stands:
        sentences.append(VERDICT_WORDS[stands.verdict].format(*np.degrees((stands.tilt, stands.lean))))
    return " ".join(sentences)


def floor(case: ReportStudy) -> Chapter:
    """Return forces and regimes on the bowl's floor.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study = case.floor
    lead = Text(
        f"Aspect {study.posture.name}, heading {np.degrees(study.heading):.4g} deg, at the upper reversal of "
        "the drive; the maps show the same instant for other drives and other friction."
    )
    lines = _notes(floor_output.map_remarks(study) + floor_output.remarks(study))
    table = Table(floor_output.summary(floor_output.document(study)))
    names = "floor_plan", "floor_frequency_amplitude", "floor_beta_friction"
    return Chapter((lead, *lines, table, *_pictures_of(floor_output.offers(study), *names)))


def slide(case: ReportStudy) -> Chapter:
    """Return when a part slips, over its heading and the drive.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    study = case.slide
    pictures = _pictures_of(slide_output.offers(study), "slide_regimes", "slide_contours")
    return Chapter((*_notes(slide_output.remarks(study)), Table(slide_output.summary(study.maps)), *pictures))


def knobs(case: ReportStudy, rate: Rate | None) -> list[Text | Knobs]:
    """Return a lead and the knobs of a report's bowl; one sentence where its drive has a second harmonic.

    Parameters
    ----------
    case : ReportStudy
    rate : Rate or None
        Whose factors the knobs keep; without one they show no rate.

    Returns
    -------
    list of Text or Knobs
    """
    if case.bowl.drive.second_harmonic:
        text = "The drive has a second harmonic, which the knobs do not know: feeder convey computes it."
        return [Text(text, quiet=True)]
    drive, friction, climb = case.bowl.drive, case.bowl.friction.static, case.bowl.track.climb
    top = max(STROKE_RANGE * drive.amplitude / MM, 1.0)  # [mm]
    sliders = (
        ("amplitude", "amplitude", "mm", 0.01, top, drive.amplitude / MM),
        ("frequency", "frequency", "Hz", 20.0, 150.0, drive.frequency),
        ("angle", "vibration angle", "deg", 2.0, 60.0, drive.vibration_angle / DEG),
        ("phase", "phase", "deg", -180.0, 180.0, drive.phase / DEG),
        ("friction", "static friction", "", 0.05, 1.2, friction),
        ("climb", "climb", "deg", 0.0, 12.0, climb / DEG),
    )
    regimes = [
        (name, colour, tables.regime_words(name)) for name, colour in convey_output.CONVEY_COLOURS.items()
    ]
    factors = None
    if rate is not None:  # what of it does not depend on the velocity
        density = rate.fill / rate.pitch  # [1/m] of the queue before the devices
        freely = rate.velocity.value * density
        moves = freely > 0.0 and rate.offered.value > 0.0
        # [s] for which a part blocks the track, in the mean
        blocked = max(0.0, float(1.0 / rate.offered.value - 1.0 / freely)) if moves else 0.0
        length = float(fed(rate.orientations, rate.row).length)  # [m] that one takes behind the devices
        efficiency = float(rate.efficiency)
        factors = {"density": float(density), "blocked": blocked, "efficiency": efficiency, "length": length}
    values = {"bowl": bowl_values(case.bowl), "rate": factors, "regimes": regimes, "top": top}
    # ends that include the bowl's own value; of the amplitude the least is fixed
    turned = tuple(
        Knob(name, label, unit, low if name == "amplitude" else min(low, own), max(high, own), own)
        for name, label, unit, low, high, own in sliders
    )
    lead = (
        "Turn the drive and see at once what a part does. Friction turns all coefficients by the same "
        "factor. The rate keeps the mix of orientations and the verdicts that the devices have at the bowl "
        "file's own drive, so it is a guide; feeder rate and feeder trial compute it."
    )
    return [Text(lead, quiet=True, printed=False), Knobs(turned, values)]


def bowl_values(bowl: Bowl) -> dict[str, float]:
    """Return a bowl as the script computes with it, in SI units: one setting, no arrays."""
    drive, track, friction = bowl.drive, bowl.track, bowl.friction
    values = {
        "amplitude": drive.amplitude,
        "frequency": drive.frequency,
        "angle": drive.vibration_angle,
        "phase": drive.phase,
        "climb": track.climb,
        "bank": track.bank,
        "static": friction.static,
        "kinetic": friction.kinetic,
        **dict(zip(("staticBack", "kineticBack"), friction.backward)),
        "wall": friction.wall,
        "restitution": bowl.restitution,
        "gravity": bowl.gravity,
    }
    return {name: float(value) for name, value in values.items()}


# --- What the devices do with each orientation, by the rule and in a trial ---


def tooling(case: ReportStudy) -> Chapter | None:
    """Return where each orientation passes or falls.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter or None
        None in a bowl without devices.
    """
    study = case.passages
    if study is None:
        return None
    lead = (
        "Each orientation at each device that it meets, until one returns it; the margin is by how much "
        "it passes or fails. Verdicts are quasi-static: they hold while the part slides without hopping."
    )
    blocks: list[Block] = [Text(lead)]
    if kinds := dict.fromkeys(device.kind for device in study.devices if device.action.turns):
        turned = f"Where parts land that {' and '.join(kinds)} turn over"
        blocks.append(Text(f"{turned} is quasi-static, until a trial confirms it."))
    # the part over the track, to be turned: the most frequent that leaves, and the nearest that falls
    chain = study.devices, study.orientations, study.shares, study.wanted
    if passages := tooling_views.poses(*chain):
        over = over_cuts(case.part, [p for p, _ in passages], study.orientations)
        captions = tuple((passage.orientation.name, result, ()) for passage, result in passages)
        blocks.append(Views(over, captions, "cuts", "Orientation"))
        blocks.append(_picture(tooling_output.solid_picture(*chain), printed=True))
    drawn = tooling_output.chain_picture(study.devices, study.orientations, study.shares)
    blocks += [Table(tooling_output.passages(study)), _picture(drawn)]
    return Chapter(tuple(blocks), warnings=tuple(tipping.remark(study.orientations)))


def over_cuts(part: Part, passages: Sequence[Passage], orientations: Sequence[Orientation]) -> Document:
    """Return what the viewer draws of a part over the cuts of a track, a pose for each passage.

    Parameters
    ----------
    part : Part
        From a mesh.
    passages : sequence of Passage
    orientations : sequence of Orientation

    Returns
    -------
    dict
        ``tracks`` are the sections in mm, ahead, inwards and up from the foot of the centre of mass;
        ``reach`` is how far the view goes, in radii of the part.
    """
    tracks = [shading.track(*tooling_views.track_below(passage, orientations)) for passage in passages]
    poses = []
    for place, passage in enumerate(passages):
        orientation, hull = passage.orientation, np.zeros((0, 3))
        if passage.picture == "above" and orientation.kind != "hanging" and len(passage.supported) > 3:
            flat = passage.supported[:-1] - [0.0, orientation.distance]
            hull = np.column_stack([flat, np.full(len(flat), -orientation.posture.height)])
            hull = np.einsum("ni,ij->nj", hull, orientation.axes) / MM
        poses.append(
            {
                "name": orientation.name,
                "quaternion": quaternion(orientation.axes),
                "height": short(orientation.posture.height / MM),
                "contact": [short(x) for x in hull.ravel()],
                "track": place,
            }
        )
    view = shading.scene_of_part(part, tooling_views.TO_VIEWER)
    return view | {"reach": 1.25, "tracks": tracks, "poses": poses}


def trial(case: ReportStudy) -> Chapter | None:
    """Return parts that were sent along the track one by one.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter or None
        None where no trial was asked for.
    """
    study = case.trial
    if study is None:
        return None
    run = study.runs[0]
    lead = Text(
        f"{len(run.course.entry_rows)} parts of true shape, one at a time and their orientations in turn, on "
        "the track as it is cut while it vibrates; beside each orientation what the static rule says."
    )
    played, captions = rides.scene(study.part, run)
    views = Views(played, tuple((*item, ()) for item in captions), "trial-views", "Orientation", plays=True)
    matrix, paths, stills = map(_picture, trial_tables.pictures(study))
    table = Table(trial_tables.frame(study).only(columns(run.counts)))
    result = Notes(tuple(trial_tables.summary(study)))
    blocks = (lead, result, views, replace(stills, printed=True), table, matrix, paths)
    return Chapter(blocks, warnings=study.warnings)


def columns(counts: Ints) -> list[str]:
    """Return the columns of a trial's table that a page has room for: a fate has one where a part met it.

    Parameters
    ----------
    counts : (M, F) array of int
        Parts of each orientation by their fate.

    Returns
    -------
    list of str
    """
    met = counts.sum(axis=0)
    fates = [fate.word for fate in Fate if met[fate] or fate is Fate.PASSED]
    went = ("leaves_as", "ended_at", "predicted", "margin_mm", "disagrees")
    return ["aspect", "heading_deg", "share", "tried", *fates, *went]


def bowl(case: ReportStudy) -> Chapter | None:
    """Return bowl, springs and drift: of a target, or of the machine in the bowl file.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter or None
        None without either.
    """
    sheet = case.machine
    if sheet is None:
        return None
    # the mark of a bowl file whose trial falls short, as long as that trial holds
    tried = bowls.verified(case.path)
    mark = marking.of_trial(tried if proof.holds(tried, case.part, case.bowl, case.counted) else None)
    try:
        views = solidbowl_views.blocks(case.solid, case.part, mark=mark)
    except FeederError as fault:
        views = [Notes(tuple(f"the bowl as a solid: {line}" for line in fault.lines))]
    # velocities at the strokes of a bowl that empties, which are not that of the bowl file
    emptying = sheet.emptying_table().with_headings({"velocity_mm_s": "velocity as it empties"})
    frames = (
        machine.summary(sheet),
        machine.leaf_sets(sheet.changes),
        machine.leaf_sets(sheet.sets),
        emptying,
    )
    if sheet.order is None:
        lead = "The springs, the tuning and the drift of the machine of the bowl file."
        note = f"{_short(100.0 * sheet.detuning)} % above the drive; gain {_short(sheet.gain)}"
        tile = Tile("natural frequency", f"{_short(sheet.springs.natural_frequency)} Hz", note)
    else:
        lead = (
            "The bowl that brings the rate asked for, by the rules of thumb of the section sizing: what the "
            "bowl file says of track, drive and machine is kept. The lines are those that a maker asks for "
            "in a quotation."
        )
        size, moved = sheet.order.size, sheet.stroke
        stroke = f"{1e3 * moved.peak_to_peak:.3g} mm at {moved.frequency:.4g} Hz"
        note = f"track {1e3 * size.track_width:.3g} mm; stroke {stroke}"
        tile = Tile("needs a bowl of", f"{1e3 * size.diameter:.4g} mm", note)
    drawn = _picture(by_name(machine.offers(sheet, mark=mark))["bowl.png"])
    return Chapter((Text(lead), *views, drawn, *map(Table, frames)), tiles=(tile,), warnings=sheet.remarks)


# --- Limits, how to repeat it, and the page ---


def how_to_repeat(case: ReportStudy) -> Chapter:
    """Return the inputs: command, files, bowl values, versions, and the table of aspects to the last digit.

    Parameters
    ----------
    case : ReportStudy

    Returns
    -------
    Chapter
    """
    hashes = Frame.of({"input": list(case.inputs), "sha256": list(case.inputs.values())})
    versions = {"feeder": __version__, "python": platform.python_version()}
    versions |= {name: metadata.version(name) for name in LIBRARIES}
    usual = {setting.key.name: setting.text for setting in bowls.settings()}
    values: list[Block] = []
    for is_changed, name in ((True, "that are not the default"), (False, "by default")):  # on a screen alone
        chosen = [
            setting
            for setting in case.settings
            if (setting.is_own and setting.text != usual.get(setting.key.name)) == is_changed
        ]
        if chosen:
            frame = slide_output.settings(chosen).only(("key", "value", "from", "meaning"))
            frame["from"] = [Path(origin).name for origin in frame["from"]]  # the inputs have their folders
            lead = Text(f"The bowl: the values {name}.", printed=is_changed)
            values += [lead, Table(frame, printed=is_changed)]
    return Chapter(
        (
            *((Code(case.command),) if case.command else ()),
            Text("The same program and inputs give this page again, byte for byte."),
            Table(hashes),
            Text(f"Versions: {', '.join(f'{name} {version}' for name, version in versions.items())}."),
            *values,
            Text("A key that is not listed has its default (feeder config show)."),
            Text("The aspects to six digits, as feeder aspects writes them."),
            CsvSheet("aspects.csv", tables.text(case.resting.table(), "csv")),
        ),
    )


CHAPTERS: tuple[ChapterRow, ...] = (  # anchor, title, what computes it
    ("aspects", "How it comes to rest", aspects),
    ("tipping", "How it tips", tips),
    ("headings", "How it lies along the wall", headings),
    ("velocity", "How fast it travels", convey),
    ("rate", "How many leave a minute", rate),
    ("tooling", "Which orientations the devices return", tooling),
    ("trial", "What parts did that were sent through", trial),
    ("bowl", "The bowl and its drive", bowl),
    ("track", "On the track, against the wall", track),
    ("floor", "On the bowl floor", floor),
    ("slip", "When a part slips", slide),
    ("part", "The part", the_part),
    ("limits", "Limitations", lambda _: Chapter((Notes(METHOD_LIMITS),))),
    ("repeat", "Reproducibility", how_to_repeat),
)


def page(
    case: ReportStudy,
    step: Callable[[str], AbstractContextManager[object]] = nullcontext,
    chapters: Iterable[ChapterRow] = CHAPTERS,
) -> Page:
    """Return everything known of a part in a bowl as a page.

    ``step`` gives a context manager round the computation of the chapter of a title. ``chapters`` are
    rows of ``CHAPTERS``; one that cannot be computed says why.
    """
    sections = []
    for anchor, title, compute in chapters:
        try:
            with step(title):
                chapter = compute(case)
        except FeederError as fault:
            listed = tuple(f"{title}: {line}" for line in fault.lines)
            chapter = Chapter((Notes(fault.lines, loud=True),), warnings=listed)
        gc.collect()  # figures hold themselves: they would pile up
        if chapter is not None:  # else it was not asked for
            sections.append(replace(chapter, anchor=anchor, title=title))
    where = f"{case.part.material}, in {case.path or 'the default bowl'} · feeder {__version__}"
    aspects = case.resting.aspects
    opening = poses.opening(case.part, aspects, _first_seen(case) if chapters is CHAPTERS else ())
    return Page(
        case.part.name, where, tuple(sections), "report", opening, poses.pose_finder(case.part, aspects)
    )


def _first_seen(case: ReportStudy) -> list[tuple[str, str]]:
    """The orientation that leaves, or without a rate that of the track, each with a few words."""
    with suppress(FeederError):
        row, lying = case.rate.rate.row, case.rate.rate.orientations
        return [(lying.lying[row].name, "leaves correctly oriented")]
    with suppress(FeederError):
        heading = round(float(np.degrees(case.track.seat.heading))) % 360
        return [(f"{case.aspect}@{heading}", "on the track")]
    return []


def write(folder: ResultFolder, page: Page, format: str) -> None:
    """Write a page into a folder.

    Parameters
    ----------
    folder : ResultFolder
    page : Page
    format : str
        'html' for one HTML file, 'md' for Markdown with its pictures beside it.
    """
    if format == "html":
        folder.write("report.html", html(page))
        return
    folder.write("report.md", markdown(page, BESIDE))
    for section in page.sections:
        for block in section.blocks:
            if isinstance(block, Picture):
                folder.write(f"{BESIDE}{block.file}", block.content)
            elif isinstance(block, CsvSheet):
                folder.write(f"{BESIDE}{block.file}", block.csv)


def _short(value: float) -> str:
    return tables.number(value, SHORT, NOTHING)


def percent(share: float) -> str:
    """Return a share as a percentage without its sign.

    Parameters
    ----------
    share : float [1]

    Returns
    -------
    str
    """
    return _short(100.0 * share)


def _picture(offer: Offer, printed: bool = False) -> Picture:
    return Picture(offer.name, tables.file_bytes(offer.make()), offer.alt, printed)


def _pictures_of(offers: Iterable[Offer], *starts: str) -> list[Picture]:
    listed = [offer for offer in offers if offer.is_picture]
    return [_picture(offer) for start in starts for offer in listed if offer.name.startswith(start)]


def _notes(lines: Sequence[str]) -> list[Notes]:
    return [Notes(tuple(lines))] if lines else []


REPORT_VIEW = RecordView(
    lambda study: f"{study.part.name} {aspects_text(study.shares.aspects)}",
    command="report",
    files=lambda study: [text_file("report.html", lambda: html(page(study)))],
)
