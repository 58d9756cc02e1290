"""``feeder rate`` and ``feeder tune``: parts per minute, and the drive for so many."""

import math
from dataclasses import replace

import click

from feederscrew_cli import grouped, options, orientation, progress
from feederscrew_cli.options import Output, Values


@grouped.command(
    short_help="Correctly oriented parts per minute, with each factor of the chain.",
    rare=("gap", "fill", "play", "tolerance"),
)
@options.part
@options.group(
    "chain_options",
    *orientation.any_chain(
        "Aspect on which the part must leave the bowl.  [default: the one that leaves most often]"
    ),
)
@orientation.share_options_and_seed
@options.quantity(
    "--position-deviation play",
    "length",
    "0 mm",
    "Standard deviation of where a part is over a cut.",
    former=("--play",),
)
@options.quantity(
    "--edge-deviation tolerance",
    "length",
    "0 mm",
    "Standard deviation of where a cut's edge is.",
    former=("--tolerance",),
)
@options.bowl
@options.output
def rate(
    part: Values,
    chain_options: Values,
    share_options: Values,
    play: float,
    tolerance: float,
    bowl: Values,
    out: Output,
) -> None:
    """Example: feeder rate lbracket_30x20x15.stl --aspect A --config bowl.yaml

    Parts per minute in the wanted aspect and heading. The queue before the devices holds every
    orientation that stays on the track. It offers velocity times fill over their mean pitch. Delivered
    is what is offered times the efficiency, the share that leaves correctly oriented. What is returned,
    or falls off the track at its entry, is offered again.

    Devices are a list in the bowl file, in the order parts meet them: 'devices:' with lines such as
    '- wiper: 6 mm' or '- gap: 9 mm'. Below '- yield:' stands the share of each aspect that passes.
    `feeder config init` lists every kind. --position-deviation and --edge-deviation give the share that
    passes a device by its margin, instead of all or none.

    With --config the shares of the aspects are those of what lies at the track's entry. Parts are fed from
    a hopper onto the moving floor of that bowl until the shares settle. Else they are the recommended
    answer for --launch, those of --rule, or those of a file (docs/counts.md).
    With -o: rate.json and orientations.csv, what each device does with each orientation.
    """
    orientation.check_heading(chain_options)
    from feederscrew.bowl import verified
    from feederscrew.feeding.rate import rate as study
    from feederscrew.feeding.well_oriented import fed
    from feederscrew.output import proof
    from feederscrew.output import rate as rate_output

    solid, settings, record = out.part_in_bowl(part, bowl)
    aspect_shares = orientation.shares(out, solid, record, share_options, chain_options)
    with out.folder_of(solid, aspect_shares.inputs, settings=settings) as folder:
        sigma = math.hypot(play, tolerance)
        result = study(solid, record, aspect_shares=aspect_shares, sigma=sigma, **chain_options)
        tried = verified(bowl["path"])
        own = solid, record, fed(result.rate.orientations, result.rate.row).name
        result = replace(result, as_tried=proof.holds(tried, *own))  # then none is sent to a trial
        document = proof.with_trial(rate_output.document(result), tried, *own)
        out.warn(*result.warnings, *rate_output.remarks(result), *proof.warnings(tried, *own))
        out.write(folder, rate_output.offers(result))
        out.show(rate_output.summary(document), document)


@grouped.command(short_help="Amplitude, angle or frequency that reaches a rate.", rare=("gap", "fill"))
@options.part
@options.target("Correctly oriented parts: 120/min.", required=True)
@orientation.chain
@orientation.share_options_and_seed
@options.flag("--worst", "Give the rate at the worst friction and restitution.")
@options.bowl
@options.output
def tune(
    part: Values,
    target: float,
    chain_options: Values,
    share_options: Values,
    worst: bool,
    bowl: Values,
    out: Output,
) -> None:
    """Example: feeder tune lbracket_30x20x15.stl --aspect A --target 20/min

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
    from feederscrew.bowl import verified
    from feederscrew.feeding.tune import tune as study
    from feederscrew.output import proof
    from feederscrew.output import rate as rate_output

    solid, settings, record = out.part_in_bowl(part, bowl)
    progress.tell_compiling(out, "conveying")
    find_shares = orientation.shares_finder(out, solid, share_options, chain_options)
    with out.folder_of(solid, find_shares(record).inputs, settings=settings) as folder:
        result = study(
            solid,
            record,
            target=target,
            aspect_shares=find_shares,
            worst=worst,
            progress=click.get_current_context().with_resource(progress.bar(out, "settings")).reach,
            **chain_options,
        )
        tried = verified(bowl["path"])
        own = solid, record, orientation.name(chain_options)
        out.warn(*result.warnings, *rate_output.tune_remarks(result), *proof.warnings(tried, *own))
        out.write(folder, rate_output.tune_offers(result))
        document = proof.with_trial(rate_output.tune_document(result), tried, *own)
        out.show(rate_output.tune_printed(result, out.format), document, spare=())
