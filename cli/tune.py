"""``feeder tune``."""

import click

from feederscrew_cli import grouped, options, orientation, progress


@grouped.command(short_help="Amplitude, angle or frequency that reaches a rate.", rare=("gap", "fill"))
@options.part
@options.target("Correctly oriented parts: 120/min.", required=True)
@orientation.chain
@orientation.taken_of_a_seed
@click.option("--worst", is_flag=True, help="Give the rate at the worst friction and restitution.")
@options.bowl
@options.output
def tune(part, target, wanted, taken, worst, bowl, out):
    """Example: feeder tune parts/lbracket_30x20x15.stl --aspect A --target 20/min

    Every setting of amplitude, vibration angle or frequency alone that gives the target to 3 %. One-way
    and gentle motions come first. Each has its regime, its hardest impact, and the margins to slip
    forward, slip back and hop (below 0: beyond it). It also has the rate if friction is a fifth lower
    or higher.

    Another drive lets other shares of the aspects arrive. Each setting is found with its own shares, so
    that `feeder rate` says the same of it. The rate is met at the bowl's friction. With --worst it is
    met at the worst of every start and of friction a fifth lower and higher. Where parts hop, the
    spread of restitution counts too. The table says which.

    With -o: tune.csv and tune.json.
    """
    from feederscrew import bowl as bowls
    from feederscrew.output import columns, offers, proof
    from feederscrew.output import tune as tune_output
    from feederscrew.studies.tune import tune as study

    solid, settings = out.part(part), out.settings(bowl)
    effective = columns.conditions(solid) | bowls.texts(settings)
    progress.conveying(out)
    record = bowls.record(settings)
    arriving = orientation.arriving(out, solid, taken, wanted["rule"])
    with out.folder(solid.name, solid.inputs | arriving(record).inputs, effective) as folder:
        result = study(
            solid, record, target=target, arriving=arriving, worst=worst,
            progress=progress.progress_in_bar(out, "settings"), **wanted,
        )  # fmt: skip
        tried = bowls.verified(bowl["path"])
        own = solid, record, orientation.name(wanted)
        out.warn(*result.warnings, *tune_output.remarks(result), *proof.warnings(tried, *own))
        offers.write(folder, tune_output.offers(result))
        document = proof.with_trial(tune_output.document(result), tried, *own)
        out.show(tune_output.printed(result, out.format), document, spare=())
