"""``feeder trial``."""

import os
from typing import Any

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.interrupt import hold_interrupts
from feederscrew_cli.options import Number, Output, Place, Values

FILMS = (".gif", ".mp4", ".webm")


class FilmFile(Place):
    """The name of a film, whose ending says its format."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return the name as typed, or refuse another ending as a wrong call.

        Parameters
        ----------
        value, param, ctx
            As click gives them.

        Returns
        -------
        str
        """
        if not str(value).lower().endswith(FILMS):
            self.fail(f"{value!r} is not a name for a film - end it in {', '.join(FILMS)}", param, ctx)
        return super().convert(value, param, ctx)


@grouped.command(
    short_help="A trial run: parts of true shape on the vibrating, tooled track.",
    rare=("landing", "poured", "measured", "amplitudes"),
)
@options.part
@options.aspect("Send only orientations of this aspect, or one, A@354.  [default: every one]")
@options.rule
@orientation.share_options
@options.whole("--parts", 1, 10**6, "Parts that are sent one at a time.  [default: 200; with --queue 60]")
@options.whole("--landing", 1, 10**6, "Let N parts fall onto the track as well.")
@options.whole("--queue", 1, 1000, "Send a queue of N parts as well, which push each other.")
@options.choice(
    "--fill",
    ["low", "normal", "high"],
    "Parts of the queue come as in the proof of feeder design at that fill.",
)
@options.flag("--poured", "The parts of the queue fall onto the track; without it they lie in a row.")
@options.option(
    "--seconds",
    None,
    "Simulated time of the queue, in seconds.",
    type=Number(0.05, 3600.0),
    default=10.0,
    show_default=True,
)
@options.path("--with measured", "CSV", "Counts of a feeding test, set beside the profile of the queue.")
@options.option(
    "--amplitude amplitudes", "LIST", "A trial at each, '60%,80%,100%' of the bowl's or '0.3 mm,0.4 mm'."
)
@options.seed("Seed of the play and the phases that are drawn.")
@options.jobs
@options.option(
    "--film",
    "FILE",
    type=FilmFile(),
    text="Write a film of ten seconds, FILE.gif, or FILE.mp4 or FILE.webm where ffmpeg is installed.",
)
@options.bowl
@options.drawn_output
def trial(
    part: Values,
    share_options: Values,
    amplitudes: str | None,
    film: str | None,
    bowl: Values,
    out: Output,
    **run_options: Any,
) -> None:
    """Example: feeder trial lbracket_30x20x15.stl --config tooling.yaml --parts 100 -o results

    Send PART, its true mesh, along the bowl's track and through its devices, cut as they are listed.
    The track vibrates with the drive. Parts go one at a time, their orientations in turn. Each part
    passes, is turned, returned, hangs, is stopped, rolls back or is stuck.

    Orientations count in the
    shares in which they arrive from the moving floor of the bowl file, or as --launch, --rule or a file
    (docs/counts.md) says. Beside each stands what the static rule of feeder tooling says, and its
    margin. Those that do something else come first.

    --landing adds parts that fall onto the moving track as --launch says, anywhere over its width. They
    go through the devices as they then lie, against the wall or not. A table by aspect says what became
    of them. --amplitude gives the greatest drive at which the tooling still sorts. --queue adds parts
    that touch, push and climb each other on the same track. What leaves or falls off enters again at
    the end of the row. Parts per minute are then those that the queue delivers. --with sets what a
    feeding test counted by aspect (docs/counts.md) beside the profile at its outlet. --fill runs the
    queue of `feeder design` again: as far apart, in the mix that a ride along the track leaves, with as
    many parts where --queue gives no number. What the block verified of the bowl file names as wanted
    counts, else the orientation in which most parts leave. The same seed
    gives the same numbers whatever the number of jobs. Ctrl-C ends the trial early with
    exit status 130: what is finished is given, marked partial.

    With -o: trial.csv, trial_stations.csv, trial.json, trial.png (orientations in and out),
    trial_paths.png (paths from above), trial_stills.png and run.json; trial_landing.csv, and
    trial_outlet.csv of a queue. --film shows a part that passes and one that does not at the device that
    decides, then the queue, with the bowl around them, its sensors and their air.
    """
    for option, value in (("--poured", run_options["poured"]), ("--with", run_options["measured"])):
        if value and not (run_options["queue"] or run_options["fill"]):
            raise click.UsageError(f"{option} is for a queue - give --queue N as well")
    if run_options["poured"] and run_options["fill"]:
        raise click.UsageError("--poured goes with no fill - leave one of them out")
    with hold_interrupts():
        from feederscrew.bowl import at_strokes, verified
        from feederscrew.bowl.verified import Verified
        from feederscrew.output.trial import tables
        from feederscrew.trials import trial as studies

        if film:
            from feederscrew.output.trial import film as films

            films.require_writer(film)
    solid, settings, record = out.part_in_bowl(part, bowl)
    driven = at_strokes(record, amplitudes)
    path = run_options.pop("measured")
    measured = studies.at_outlet(path, solid) if path else None
    aspect_shares = orientation.shares(out, solid, driven[0], share_options, run_options)
    tried = verified(bowl["path"]) if run_options["fill"] else None
    wanted, up = (tried.wanted, tried.up) if isinstance(tried, Verified) else ("", "")  # by its design
    if level := run_options.pop("fill"):
        run_options["queue"] = studies.TrialQueue(level, run_options["queue"], wanted, up)
    inputs = aspect_shares.inputs | ({path: measured.sha256} if measured else {})
    with out.folder_of(solid, inputs, settings=settings) as folder:
        with progress.bar(out, "runs") as bar:
            study = studies.trial(
                solid,
                driven,
                aspect_shares=aspect_shares,
                measured=measured,
                progress=bar.reach,
                before=lambda: progress.tell_compiling(out, "trial"),
                frames=films.QUEUE_FRAMES if film else 0,
                **run_options | {"jobs": run_options["jobs"] or os.cpu_count()},
            )
        document = tables.document(study)
        out.warn(*study.warnings)
        out.say(*tables.summary(study))
        for line in tables.engine(study):
            out.detail(line)
        if film:
            films.write_film(film, study)
            out.say(f"Wrote {film}")
        out.write(folder, tables.offers(study))
        hidden = tables.HIDDEN if not out.verbose else ("fell_mm", "seconds")
        out.show(tables.frame(study), document, hidden=hidden, spare=tables.spare(study))
