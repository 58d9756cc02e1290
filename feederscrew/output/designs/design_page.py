"""A design on one page to hand on: the answer first, then what it stands on."""

from feederscrew.designing import record
from feederscrew.output import marking, solidbowl_views
from feederscrew.output.designs import design_file, figures, risk_pictures, tables
from feederscrew.output.page.as_html import html
from feederscrew.output.page.blocks import (
    Chapter,
    CsvSheet,
    Heading,
    Notes,
    Page,
    Picture,
    Table,
    Text,
    Tile,
    Views,
)  # fmt: skip
from feederscrew.output.style import png
from feederscrew.output.tables import text
from feederscrew.output.trial import playback

MEASURE = (
    "Stroke: the sticker on the rim shows it peak to peak; below the computed one, raise the controller, and "
    "look for a part that touches the frame.",
    "Acceleration: an accelerometer on the bowl, along the vibration; where the stroke is right and the "
    "acceleration is not, the frequency is another one.",
    "Natural frequency: tap the bowl with the drive off and read the decay; it shall lie 3 to 8 % above the "
    "drive: add a leaf or take one off.",
    "Friction: lay a part on a strip of the track's sheet and tilt it until it slides; oil brings it down, "
    "and the rate with it.",
)


def page(study, built=None):
    """Return the page of a DesignStudy and its Built bowl as HTML that needs no other file."""
    return html(
        Page(
            study.part.name,
            f"design of a bowl: {study.status}",
            tuple(_sections(study, built)),
            kind="design",
        )
    )


def _sections(study, built):
    d = tables.document(study)
    answer = tuple(_answer(study, d))
    yield Chapter(answer, _tiles(d), study.warnings, anchor="answer", title="The answer")
    history = tables.short_attempts(study)
    picture = Picture("design_history.png", png(figures.history(study)), "Each short trial of the loop")
    lead = Text(
        "Each line is one short trial: a chain on its bowl, every orientation that comes often enough. What "
        "the trial denies is changed in the next. design_trials.csv has the dimensions of each device."
    )
    tried = (lead, Table(history), picture) if study.attempts else (lead,)
    yield Chapter(tried, anchor="loop", title="The loop")
    if study.trials:
        yield Chapter(tuple(_played(study)), anchor="trial", title="The trial")
    if study.queues:
        yield Chapter(tuple(_proof(study, d)), anchor="proof", title="The proof")
    if built is not None and study.delivers:
        mark = marking.of_trial(design_file.trial(study))
        shown = tuple(solidbowl_views.blocks(built.drawn and built.drawn.solid, study.part, built.why, mark))
        yield Chapter(shown, anchor="bowl", title="The bowl")
    if not study.delivers:  # nothing to build from, nothing to accept
        return
    sheet = tables.acceptance(study)
    blocks = (
        Text("Computed values, with empty cells for what is measured at the machine."),
        Table(sheet),
        CsvSheet("acceptance.csv", text(sheet, "csv"), shown=False),
        Heading("What to measure"),
        Notes(MEASURE),
    )
    yield Chapter(blocks, anchor="acceptance", title="Acceptance sheet")


def _answer(study, d):
    yield Text(_said(study))
    if d["machine"]:
        yield Text(f"The machine: {tables.machine_text(d['machine'])}.")
    yield Table(tables.two_columns(tables.outcome(d, study.devices)))
    if study.alternatives:
        yield Heading("Cheapest first: steel (1), steady air (2), a sensor with a valve (3)")
        yield Table(tables.alternatives(study))
    if d["bowl"]:
        yield Table(tables.two_columns(tables.dimensions(d)))
    if study.risks:
        yield Notes(tuple(one.text for one in study.risks), loud=True)
        yield from _pairs(study)


def _pairs(study):
    """Pictures of what may go wrong between two parts, or a part and two walls."""
    for one in study.risks:
        if one.pair is not None:
            yield Picture(
                f"risk_{one.kind}.png", png(risk_pictures.drawn(study.part, one)), one.text, printed=True
            )


def _said(study):
    """What the status says, in a sentence: what is missing, or what all was reached."""
    if study.status != record.HOLDS:
        return f"Status: {study.status}. {study.why}."
    least, draws = 60.0 * record.RATE_KEPT * study.request.target, 100.0 * record.DRAWS_HELD
    return (
        f"Status: {study.status}. The lower end of the rate is at least {least:.3g} a minute, the purity at "
        f"least {100.0 * record.PURE:.3g} %; nothing jams, and at least {draws:.3g} % of the draws sort."
    )


def _tiles(d):
    return (
        Tile("status", d["status"], d["wanted"] or "no orientation"),
        Tile(
            "parts per minute",
            f"{d['delivered_per_minute']:.3g}",
            f"{d['delivered_low']:.3g} to {d['delivered_high']:.3g}, asked {d['target_per_minute']:.3g}",
        ),
        Tile(
            "purity", "-" if d["purity"] is None else f"{100.0 * d['purity']:.3g} %", "of what left the queue"
        ),
        Tile("jams", f"{d['jams']}", f"in {d['queue_seconds']:.3g} s of queue"),
    )


def _played(study):
    yield Text("Parts of the short trial at the device that decides.")
    scene, captions = playback.scene(study.part, *study.trials)
    yield Views(
        scene, tuple((*one, ()) for one in captions), "trial-views", "Orientation", plays=True, printed=True
    )


def _proof(study, d):
    yield Text(
        "A queue of parts that push each other, at three fills, and draws of part, friction, drive and cuts, "
        "each tried with parts of its own."
    )
    from feederscrew.output.tables import frame

    if d["long_ride"]:
        yield Text(
            "Parts of each orientation that comes often first ride along the bare track to the tooling. They "
            f"begin a little off and ride {1e3 * study.long_ride.distance:.3g} mm. What turns, leaves the "
            "track or rolls back changes the mix that arrives."
        )
        yield Table(tables.long_ride(d["long_ride"]))
    rows = d["queues"]
    yield Table(frame({name: [row[name] for row in rows] for name in rows[0]}))
    worst = f"; most often: {study.robust.worst}" if study.robust.worst else ""
    yield Text(f"{study.robust.held} of {study.robust.draws} draws sort{worst}.")
