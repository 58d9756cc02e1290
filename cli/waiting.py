"""What is said to a person who must wait: for the compiler, and how far a long run is."""

import click

from feederscrew_cli.progress import Progress, StageBar


def drops(out):
    """Say so when the first drop on this machine must wait for the compiler."""
    from feederscrew.dropping import drop_test

    if not drop_test.compiled():
        out.say("Compiling the drop kernel, once on this machine: about ten seconds.")


def plate(out):
    """Say so when the first plate on this machine must wait for the compiler."""
    from feederscrew.dropping import plate_test

    if not plate_test.compiled():
        out.say("Compiling the plate's kernel, once on this machine: about ten seconds.")


def trial(out):
    """Say so when the first trial on this machine must wait for the compiler."""
    from feederscrew.trial import runs

    if not runs.compiled():
        out.say("Compiling the trial's kernel, once on this machine: about a minute.")


def conveying(out):
    """Say so when the first map on this machine must wait for the compiler."""
    from feederscrew.conveying import sweep

    if not sweep.compiled():
        out.say("Compiling the conveying kernel, once on this machine: about ten seconds.")


def design(out):
    """Return what shows how far the search for a design is: a StageBar, hidden where nobody waits."""
    return StageBar(not out.quiet)


def progress_in_bar(out, what):
    """Return a function of how many ``what`` are done and of how many, which shows it in a bar."""
    progress_bar = bar(out, what)
    click.get_current_context().with_resource(progress_bar)
    return progress_bar.reach


def bar(out, what):
    """Return a bar of the ``what`` that are done, where a person waits; hidden elsewhere."""
    return Progress(None, not out.quiet, what)
