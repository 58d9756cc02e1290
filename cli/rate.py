"""``feeder rate``."""

import math

from feederscrew_cli import grouped, options, orientation


@grouped.command(
    short_help="Correctly oriented parts per minute, with each factor of the chain.",
    rare=("gap", "fill", "play", "tolerance"),
)
@options.part
@orientation.any_chain
@orientation.taken_of_a_seed
@orientation.DOUBT_OPTIONS[0]
@orientation.DOUBT_OPTIONS[1]
@options.bowl
@options.output
def rate(part, wanted, taken, play, tolerance, bowl, out):
    """Example: feeder rate parts/lbracket_30x20x15.stl --aspect A --config bowl.yaml

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
    from feederscrew import bowl as bowls
    from feederscrew.output import columns, offers, proof
    from feederscrew.output import rate as rate_output
    from feederscrew.rates.well_oriented import fed
    from feederscrew.studies.rate import rate as study

    solid, settings = out.part(part), out.settings(bowl)
    effective = columns.conditions(solid) | bowls.texts(settings)
    record = bowls.record(settings)
    aspect_shares = orientation.shares(out, solid, record, taken, wanted["rule"])
    with out.folder(solid.name, solid.inputs | aspect_shares.inputs, effective) as folder:
        result = study(
            solid, record, aspect_shares=aspect_shares, sigma=math.hypot(play, tolerance), **wanted
        )
        tried = bowls.verified(bowl["path"])
        own = solid, record, fed(result.rate.orientations, result.rate.row).name
        document = proof.with_trial(rate_output.document(result), tried, *own)
        out.warn(*result.warnings, *rate_output.remarks(result), *proof.warnings(tried, *own))
        offers.write(folder, rate_output.offers(result))
        out.show(rate_output.summary(document), document)
