"""``feeder aspects`` and ``feeder inertia``."""

from dataclasses import replace
from typing import Any

import click

from feederscrew_cli import grouped, options, progress
from feederscrew_cli.options import Output, Values

CLASS_COUNTS_ONCE = (
    "PMI counts an aspect once, as Tables 3-8 and 3-9: without --as-published each of its equal faces counts."
)
EACH_FACE_COUNTS = (
    "PMI counts each of the equal faces of an aspect: --as-published counts it once, as Tables 3-8 and 3-9."
)


@grouped.command(
    short_help="Resting aspects of a part and how often it lands on each.",
    rare=("unstable", "as_published", "surface_exponent", "heap", "graph"),
)
@options.part
@options.flag("--all unstable", "List the facets that it rolls off too.")
@options.as_published("Count each class once in p_pmi, as Tables 3-8 and 3-9 do.")
@options.launch
@options.choice(
    "--surface",
    ["soft", "medium", "hard"],
    "What it lands on: p_surface is then the answer.  [default: hard]",
)
@options.option(
    "--surface-exponent", None, "The same as a number, 0 to about 3.", type=options.Number(-10, 10)
)
@options.whole(
    "--drops",
    0,
    10**7,
    "How many drops; 0 for none.  [default: until every share is known to 1.6 %]",
    former=("--drop",),
)
@options.choice(
    "--rule",
    ["recommended", "closed"],
    default="recommended",
    text="closed: a closed form is the answer, at once, as with --drops 0.",
)
@options.flag("--heap", "Pour a heap of 16 parts, shake it, and say how many come single (about 5 s).")
@options.flag("--graph", "With -o: what tips into what over which barrier, CSV and PNG.")
@options.option(
    "--columns",
    "NAMES",
    "Columns to print, with commas between, or all.  [default: all of them as CSV; in the table "
    "height, recommended answer, rules of the thesis]",
)
@options.drawn_output
def aspects(part: Values, columns: str | None, heap: bool, graph: bool, out: Output, **chosen: Any) -> None:
    """Example: feeder aspects lbracket_30x20x15.stl --launch feed -o results

    List the resting aspects of PART, with equal ones joined into classes. Each has its geometry, its
    probability by every rule, and what it takes to tip it.

    p_recommended is the answer for --launch. It is a drop test until every share is known to 1.6 %.
    --launch says what is done to the part: place (set down by hand), drop (let fall), flip (spun as a
    coin), roll (cast or poured), feed (from a hopper into a bowl). --rule closed gives a quick look
    without a drop test.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, 3MF, STEP), a part card (YAML), or - for standard
    input. With -o: aspects.csv, aspects.json, aspects.png, probabilities.png, names.yaml (for --names) and
    run.json.
    """
    from feederscrew.arrivals.aspects_study import aspects as aspects_study
    from feederscrew.output import aspects as aspects_output
    from feederscrew.resting.aspects import waits

    if graph and out.directory is None:
        raise click.UsageError("--graph writes files: give -o DIR as well")
    solid = out.part(part)
    exponent = chosen.pop("surface_exponent")
    chosen["surface"] = chosen["surface"] if exponent is None else exponent
    values = chosen | ({"surface": "hard"} if chosen["surface"] is None else {})
    with out.folder_of(solid, values=values) as folder:
        if chosen.pop("rule") == "closed":
            chosen["drops"] = 0
        if waits(solid):
            out.say("Compiling what large hulls need, once on this machine: about ten seconds.")
        out.say(f"Material: {solid.material}")
        if columns is not None:
            aspects_output.check_columns(aspects_study(solid, **{**chosen, "drops": 0}), columns)
        with out.step("aspects"), progress.bar(out, "drops") as bar:
            study = aspects_study(
                solid, **chosen, progress=bar.reach, before=lambda _: progress.tell_compiling(out, "drops")
            )
        if heap:
            from feederscrew.trials.heap import heap as heap_of

            with out.step("heap"):
                count = heap_of(solid)
            study = replace(study, heap=count)
            out.say(f"Heap: {count.words}")
        if study.recommended is not None:
            out.say(f"Recommended: {study.recommended.words}")
        out.warn(*study.aspects.warnings)
        if out.format == "table" and study.recommended is not None:
            out.say("PMI, CSA and stability are published rules, to compare with: go by recommended.")
        if out.format == "table" and (study.aspects.faces > 1).any():
            out.say(CLASS_COUNTS_ONCE if chosen["as_published"] else EACH_FACE_COUNTS)
        frame, table = study.table(), out.format == "table"
        printed = aspects_output.select_columns(frame, columns) if columns is not None or table else frame
        out.write(folder, aspects_output.offers(study, with_graph=graph))
        out.say(*aspects_output.remarks(study) if folder and out.pictures else ())
    out.show(printed, aspects_output.document(study))


@grouped.command(short_help="Volume, mass, centre of mass and inertia of a part.")
@options.part
@options.output
def inertia(part: Values, out: Output) -> None:
    """Example: feeder inertia hexbolt_m8x25.stl --density brass

    Volume, mass, centre of mass, inertia about the centre of mass and about the file's origin,
    principal moments and axes, convex hull and bounding box of PART.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, 3MF, STEP), a part card (YAML), or - for standard
    input; what a card does not give stays empty. With -o: inertia.csv, or inertia.json with
    --format json, and run.json.
    """
    from feederscrew.output import inertia as inertia_output
    from feederscrew.part.inertia import inertia as inertia_study

    solid = out.part(part)
    study = inertia_study(solid)
    with out.folder_of(solid) as folder:
        out.say(f"Material: {solid.material}")
        out.write(folder, inertia_output.offers(study, out.format))
    out.show(inertia_output.rows(study), inertia_output.document(study))
