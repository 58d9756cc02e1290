"""``feeder advise``."""

from feederscrew_cli import grouped, options, progress
from feederscrew_cli.interrupt import heed_interrupts
from feederscrew_cli.options import Output, Values


@grouped.command(short_help="How hard a part is to feed, and which change of it would help.")
@options.part
@options.rule
@options.flag("--grade-only", "Grade the part, and look for no changes of it.")
@options.flag("--static", "Judge all by the static rule: no parts are tried.")
@options.quantity(
    "--limit seconds",
    "time",
    "10 min",
    positive=True,
    text="Time after which no further change is tried; the answer then says so.",
)
@options.seed("Seed of the trials.")
@options.bowl
@options.output
def advise(
    part: Values,
    rule: str,
    grade_only: bool,
    static: bool,
    seconds: float,
    seed: int,
    bowl: Values,
    out: Output,
) -> None:
    """Example: feeder advise lbracket_30x20x15.stl -o results

    What makes PART hard to feed, and what change of its shape would make it easy. The grade goes from A to
    E: A is steel alone with most parts right, C takes a camera, E is no way found. Its reasons say what
    costs a grade: few parts that come right, a low rate, parts that hook or nest.

    Then small changes that the shape allows are made on the mesh: a wider flange, a thicker head, a flat, a
    chamfer, a lug, a moved hole, a closed slot, both ends alike. Each changed part is judged as PART is, by
    the static rule. The three that gain most are tried with parts of true shape, and so is PART.

    Rates are those of the bowl file (--config), with its devices left out. Which changes the function of
    the part allows is yours to judge. With -o: advice.html with pictures before and after, advice.json,
    changes.csv, and each changed part that was tried as change_1.stl, for feeder design.
    """
    from feederscrew.designing.advice import advise as study
    from feederscrew.output import advise as tables

    solid, settings, record = out.part_in_bowl(part, bowl)
    with out.folder_of(solid, settings=settings) as folder:
        with progress.bar(out, "parts") as bar:
            result = study(
                solid,
                record,
                rule=rule,
                seed=seed,
                seconds=seconds,
                with_changes=not grade_only,
                with_trials=not static,
                progress=heed_interrupts(bar.reach),
            )
        out.warn(*result.warnings)
        out.say(*tables.remarks(result))
        out.write(folder, tables.offers(result))
        out.show(tables.summary(result), tables.document(result))
