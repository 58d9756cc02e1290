"""The options that say which parts are wanted, and whose shares of the aspects are taken."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import click

from feederscrew_cli import options, progress
from feederscrew_cli.options import Output, Values

if TYPE_CHECKING:
    from feederscrew.arrivals.entry import Shares
    from feederscrew.bowl import Bowl
    from feederscrew.part.record import Part

CHAIN_OPTIONS = (
    options.aspect("Aspect on which the part must leave the bowl.", required=True),
    options.heading(
        "DEG",
        "Heading it is laid down in; the wall turns it to a stable one.  [default: the most frequent]",
    ),
    options.rule,
    options.quantity("--gap", "length", "0 mm", "Gap between one part and the next."),
    options.quantity(
        "--fill", "number", "1", "Share of the track that is occupied.", positive=True, most=1.0
    ),
)
# the wanted orientation, and what the rate depends on: aspect, heading, rule, gap and fill
chain = options.group("chain_options", *CHAIN_OPTIONS)


def any_chain(text: str) -> tuple[Callable, ...]:
    """Return the options of ``chain`` where ``--aspect`` may be left out.

    Parameters
    ----------
    text : str
        The help of ``--aspect``.

    Returns
    -------
    tuple of callable
    """
    return (options.aspect(text), *CHAIN_OPTIONS[1:])


LAUNCHED = options.choice(
    "--launch",
    options.LAUNCHES,
    "What is done to the part, on a floor at rest.  [default: fed onto the bowl's moving floor]",
)
SHARE_OPTIONS = (
    LAUNCHED,
    options.path("--probabilities", "CSV", "Take the shares of a file of counts, or of drop.csv."),
    options.whole(
        "--fed",
        1,
        10**6,
        "Feed N parts onto the moving floor.  [default: until every share is known to 2.5 %]",
    ),
)
# whose shares of the aspects are taken; with a seed for a command that has none of its own
share_options = options.group("share_options", *SHARE_OPTIONS)
FED_SEED = options.seed("Seed of the parts that are fed.")
share_options_and_seed = options.group("share_options", *SHARE_OPTIONS, FED_SEED)


def check_heading(request: Values) -> None:
    """Refuse a heading without the aspect that it is a heading of.

    Parameters
    ----------
    request : dict of str to object
        Values of the chain's options.

    Raises
    ------
    click.UsageError
    """
    if request["heading"] is not None and request["aspect"] is None:
        raise click.UsageError("--heading is given without --aspect - name the aspect as well")


def name(request: Values) -> str | None:
    """Return the name of the orientation that is asked for, or of its aspect.

    Parameters
    ----------
    request : dict of str to object
        Values of the chain's options.

    Returns
    -------
    str or None
        'A@90', 'A'; None where neither is asked for.
    """
    if request["aspect"] is None or request["heading"] is None:
        return request["aspect"]
    return f"{request['aspect']}@{round(math.degrees(request['heading'])) % 360}"


def shares_finder(
    out: Output, part: "Part", share_options: Values, request: Values
) -> Callable[["Bowl"], "Shares"]:
    """Return a function from a bowl to the shares of the aspects that the options name.

    Where the options name none, parts are fed onto the moving floor of the bowl; a bar shows how far the
    first bowl is.

    Parameters
    ----------
    out : Output
    part : Part
    share_options : dict of str to object
        Values of ``SHARE_OPTIONS``.
    request : dict of str to object
        With the rule, and an aspect and a heading.

    Returns
    -------
    callable
        From a Bowl to ``arrivals.entry.Shares``; each bowl is answered once.

    Raises
    ------
    ArgumentError
        If the part has no such aspect or heading.
    """
    from feederscrew.arrivals import entry

    entry.check_wanted(part, request["aspect"], request.get("heading"))
    shares_by_bowl: dict[Bowl, Shares] = {}

    def shares_of(bowl: "Bowl") -> "Shares":
        if bowl not in shares_by_bowl:
            values = share_keywords(share_options) | ({} if shares_by_bowl else progress_keywords(out))
            shares_by_bowl[bowl] = entry.shares(part, bowl, rule=request["rule"], **values)
        return shares_by_bowl[bowl]

    return shares_of


def shares(out: Output, part: "Part", bowl: "Bowl", share_options: Values, request: Values) -> "Shares":
    """Return what arrives in one bowl: ``shares_finder`` called once.

    Parameters
    ----------
    out : Output
    part : Part
    bowl : Bowl
    share_options, request : dict of str to object
        As of ``shares_finder``.

    Returns
    -------
    Shares
    """
    return shares_finder(out, part, share_options, request)(bowl)


def share_keywords(share_options: Values) -> Values:
    """Return the keywords of ``arrivals.entry.shares`` that the options name.

    Parameters
    ----------
    share_options : dict of str to object
        Values of ``SHARE_OPTIONS``.

    Returns
    -------
    dict of str to object

    Raises
    ------
    click.UsageError
        If two of them clash.
    """
    launch, fed = share_options["launch"], share_options["fed"]
    own_answers = {"--launch": launch, "--rule": options.is_typed("rule"), "--fed": fed}
    names = [name for name, value in own_answers.items() if value]
    if share_options["probabilities"] is not None and names:
        raise click.UsageError(f"--probabilities takes the place of {names[0]} - leave one of them out")
    if launch is not None and fed is not None:
        raise click.UsageError("--fed is for parts on the moving floor - leave out --fed or --launch")
    return share_options


def progress_keywords(out: Output) -> Values:
    """Return the keywords of ``arrivals.entry.shares`` that tell how far it is.

    Parameters
    ----------
    out : Output
        Nothing is shown where it is quiet.

    Returns
    -------
    dict of str to callable
        'before' and 'progress'.
    """
    bar = progress.bar(out, "parts")

    def before(drops: int | None) -> None:
        progress.tell_compiling(out, "plate" if drops is None else "drops")
        click.get_current_context().with_resource(bar)

    return {"before": before, "progress": bar.reach}
