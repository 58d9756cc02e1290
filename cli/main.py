"""The ``feeder`` program: its commands and its one error fence."""

import contextlib
import difflib
import gc
import importlib
import os
import re
import signal
import sys
from collections.abc import Mapping

import click

from feederscrew import __version__
from feederscrew.errors import ArgumentError, Faults, FeederError
from feederscrew.units import printable
from feederscrew_cli import argument_names, end_while_loading
from feederscrew_cli.interrupt import INTERRUPTED

COMMANDS = {
    "aspects": "feederscrew_cli.aspects",
    "inertia": "feederscrew_cli.inertia",
    "compare": "feederscrew_cli.compare",
    "drop": "feederscrew_cli.drop",
    "calibrate": "feederscrew_cli.calibrate",
    "slide": "feederscrew_cli.slide",
    "convey": "feederscrew_cli.convey",
    "rate": "feederscrew_cli.rate",
    "tune": "feederscrew_cli.tune",
    "bowl": "feederscrew_cli.bowl",
    "tooling": "feederscrew_cli.tooling",
    "trial": "feederscrew_cli.trial",
    "design": "feederscrew_cli.design",
    "floor": "feederscrew_cli.floor",
    "track": "feederscrew_cli.track",
    "headings": "feederscrew_cli.headings",
    "batch": "feederscrew_cli.batch",
    "config": "feederscrew_cli.config",
    "report": "feederscrew_cli.report",
    "reproduce": "feederscrew_cli.reproduce",
    "doctor": "feederscrew_cli.doctor",
}
COLOUR = False if os.environ.get("NO_COLOR") else None  # None: on a terminal only
NO_CHOICE = re.compile(r"'([^']*)' is not one of")
SELDOM = 20_000  # objects made between two searches for garbage: libraries make hardly any as they load
PIPE_CLOSED = 141  # what a shell reports of any filter whose reader went away


class Commands(Mapping):
    """The commands by name, each imported when it is first asked for."""

    def __getitem__(self, name):
        return getattr(importlib.import_module(COMMANDS[name]), name)

    def __iter__(self):
        return iter(COMMANDS)

    def __len__(self):
        return len(COMMANDS)


class Fence(click.Group):
    """Turns every fault into its lines on stderr and the exit status that goes with it."""

    def list_commands(self, ctx):
        """In the order of the pipeline, not of the alphabet."""
        return list(self.commands)

    def main(self, args=None, **extra):  # type: ignore[override]  # it returns in no mode
        """Run one command line and leave the interpreter."""
        if signal.getsignal(signal.SIGINT) is end_while_loading:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        arguments = list(sys.argv[1:] if args is None else args)
        _take_any_name()
        gc.set_threshold(SELDOM)
        try:
            status = super().main(arguments, **{**extra, "standalone_mode": False, "obj": arguments})
        except click.Abort:
            _tell("Stopped.")
            status = INTERRUPTED
        except click.ClickException as error:
            _tell(
                "Error: " + " ".join(error.format_message().split()) + _near_miss(error) + _help_hint(error)
            )
            status = error.exit_code
        except BrokenPipeError:
            status = _without_stdout(PIPE_CLOSED)
        except (OSError, UnicodeError) as error:
            _tell("Error: " + _of_the_system(error))
            status = _without_stdout(1)
        sys.exit(status if isinstance(status, int) else 0)

    def invoke(self, ctx):
        """Run the command, each fault printed on a line of its own."""
        try:
            return super().invoke(ctx)
        except FeederError as error:
            for line in _lines(error, self.get_command(ctx, ctx.invoked_subcommand)):
                _tell(f"Error: {line}")
            return ctx.exit(1)
        except BrokenPipeError:  # before click takes it for its own
            return ctx.exit(_without_stdout(PIPE_CLOSED))


def _take_any_name():
    """Let stdout show an escape for what it cannot write, as stderr does: a byte of a file's name."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def _without_stdout(status):
    """The status, and what still waits for stdout thrown away: the last flush would fail as well."""
    with contextlib.suppress(OSError, ValueError):  # a stream of a test has no number
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return status


def _of_the_system(error):
    """One line of what the system refuses: a full disk, a folder gone, a name it cannot take."""
    if isinstance(error, UnicodeError):
        reason = getattr(error, "reason", error)  # only those of a codec have one
        return f"a name or text: cannot be converted ({reason}) - rename the file in plain letters"
    where = error.filename or "output"
    return f"{where}: cannot be read or written ({error.strerror or error}) - check the disk and permissions"


def _lines(error, command):
    """Every fault as its own line; an argument of the library goes by the name of its option."""
    options = argument_names.options(command)
    faults = error.faults if isinstance(error, Faults) else (error,)
    return tuple(
        argument_names.translated(line, options) for fault in faults for line in _of_options(fault, options)
    )


def _of_options(fault, options):
    if not isinstance(fault, ArgumentError):
        return fault.lines
    name, *rest = str(fault.where).split(" ", 1)
    where = " ".join([options.get(name, "--" + name.replace("_", "-")), *rest])
    return (f"{where}: {fault.what} - {fault.mend}",)


def _tell(line):
    with contextlib.suppress(OSError):  # stderr may be the full disk
        click.echo(printable(line), err=True)


def _near_miss(error):
    """The choice that a mistyped one was meant for, as click says it of commands and options."""
    typed, kind = (
        NO_CHOICE.match(getattr(error, "message", "")),
        getattr(getattr(error, "param", None), "type", None),
    )
    if not typed or not isinstance(kind, click.Choice):
        return ""
    near = difflib.get_close_matches(typed[1], [str(choice) for choice in kind.choices], n=1)
    return f" Did you mean '{near[0]}'?" if near else ""


def _help_hint(error):
    context = getattr(error, "ctx", None)
    return f" (see {context.command_path} --help)" if context else ""


@click.group(
    cls=Fence,
    commands=Commands(),
    invoke_without_command=True,
    context_settings={"color": COLOUR, "max_content_width": 100, "help_option_names": ["-h", "--help"]},
)
@click.version_option(__version__, prog_name="feeder")
@click.pass_context
def feeder(ctx):
    """Example: feeder aspects parts/lbracket_30x20x15.stl -o results

    Resting aspects, sliding limits and conveying of small parts in vibratory bowl feeders.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
