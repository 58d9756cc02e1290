"""``feeder report``."""

import gc
import shlex
from collections.abc import Iterable
from dataclasses import replace

from feederscrew_cli import grouped, options, orientation, progress, talk
from feederscrew_cli.options import Output, Values

TALK = {"-q", "--quiet", "-v", "--verbose"}
REQUEST = (
    *orientation.any_chain(
        "Aspect to leave the bowl on.  [default: the likeliest; for the rate, what leaves most often]"
    ),
    options.target("Size a bowl for this rate as well: 120/min."),
    options.whole(
        "--parts sent",
        1,
        10**4,
        "Send N parts along the track and through the devices, to be played.",
        former=("--trial",),
    ),
)
PLACE = (
    options.path(
        "-o --output directory",
        "DIR",
        "Write the page to DIR/<name>/.",
        default="results",
        show_default=True,
    ),
    options.choice("--format", ["html", "md"], "One HTML file, or Markdown and pictures.", "html"),
    options.QUIET,
    options.flag("-v --verbose", "Say what is read and how long each chapter takes."),
)


@grouped.command(short_help="Everything about a part in a bowl, on one page to read, print and keep.")
@options.part
@options.group("request_options", *REQUEST)
@orientation.share_options_and_seed
@options.bowl
@options.group("out", *PLACE, pack=Output.of_call)
def report(part: Values, request_options: Values, share_options: Values, bowl: Values, out: Output) -> None:
    """Example: feeder report lbracket_30x20x15.stl --config bowl.yaml -o results

    Everything the other commands say of PART in a bowl. The page shows its aspects in 3-D views that can be
    turned, how often it lands on each, and how it tips, slides and travels. It has the reactions on the
    track, the rate, the limitations and the inputs to reproduce it.

    With --config, how often it lands on each aspect is what arrives from the bowl's own moving floor, as for
    `feeder rate`. PART is a mesh or a part card. report.html needs no other file and no network. --format
    md writes report.md with its pictures beside it. A chapter that cannot be computed says why.
    """
    orientation.check_heading(request_options)
    from feederscrew.bowl import friction_remarks, read, verified
    from feederscrew.output import proof
    from feederscrew.output.report import report as study
    from feederscrew.output.report_page import page, write

    out.tell_unread(bowl["path"])
    solid = out.part(part)
    progress.tell_compiling(out, "conveying")
    chosen = orientation.share_keywords(share_options) | orientation.progress_keywords(out)
    bowl_record = read(bowl["path"], bowl["overrides"])
    result = study(
        solid, bowl=bowl_record, **request_options, **chosen, command=repeat_command(out.arguments)
    )
    tried = verified(bowl["path"])
    own = solid, bowl_record, orientation.name(request_options)
    result = replace(result, as_tried=proof.holds(tried, *own))
    out.warn(*friction_remarks(result.settings, solid.material))
    gc.freeze()  # what is loaded stays: it need not be looked through after every chapter
    with out.folder_of(solid, result.inputs, settings=result.settings) as folder:
        built_page = page(result, out.step)
        lines = dict.fromkeys((*built_page.warnings, *proof.warnings(tried, *own)))  # each once
        out.warn(*(line for line in lines if line not in solid.warnings))
        if folder:
            write(folder, built_page, out.format)


def repeat_command(arguments: Iterable[str]) -> str:
    """Return the command line that gives the same page wherever it is written.

    Parameters
    ----------
    arguments : iterable of str
        As typed.

    Returns
    -------
    str
        Without the folder of ``-o`` and the options of what is told.
    """
    words = [argument for argument in talk.placeless(arguments) if argument not in TALK]
    return shlex.join(["feeder", *words])
