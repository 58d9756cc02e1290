"""The ``feeder`` program: its commands and its one error fence."""

import contextlib
import difflib
import gc
import importlib
import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NoReturn, TextIO

import click

from feederscrew import __version__
from feederscrew.base.errors import ArgumentError, Faults, FeederError, MissingPackage
from feederscrew.base.units import printable
from feederscrew_cli.interrupt import exit_status, note_every_interrupt, was_heard
from feederscrew_cli.talk import options_by_argument, translate, typed

COMMAND_GROUPS = {  # heading: commands, in the order of a job
    "Design": ("design", "tooling", "trial", "bowl", "report"),
    "Part": ("advise", "aspects", "drop", "inertia", "compare", "calibrate"),
    "Bowl": ("rate", "tune", "convey", "slide", "floor", "track", "headings"),
    "Files": ("sample", "batch", "config", "cache", "serve", "doctor", "reproduce"),
}
MODULES = {  # of commands that share one, else it has their name
    "floor": "motion",
    "track": "motion",
    "headings": "motion",
    "slide": "motion",
    "inertia": "aspects",
    "calibrate": "compare",
    "tune": "rate",
}
COMMANDS = {
    name: f"feederscrew_cli.{MODULES.get(name, name)}" for names in COMMAND_GROUPS.values() for name in names
}
COLOUR = False if os.environ.get("NO_COLOR") else None  # None: on a terminal only
NO_CHOICE = re.compile(r"'([^']*)' is not one of")
GARBAGE_THRESHOLD = 20_000  # objects between two searches for garbage: libraries make hardly any as they load
WRONG_DATA = 1
WRONG_CALL = 2  # as click ends for a value that it checks itself
PIPE_CLOSED = 141  # what a shell reports of any filter whose reader went away


class Commands(Mapping):
    """The commands by name, each imported when it is first asked for."""

    def __getitem__(self, name: str) -> click.Command:
        return getattr(importlib.import_module(COMMANDS[name]), name)

    def __iter__(self) -> Iterator[str]:
        return iter(COMMANDS)

    def __len__(self) -> int:
        return len(COMMANDS)


class Fence(click.Group):
    """Turns every fault into its lines on stderr and the exit status that goes with it."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of the commands in the order of a job, not of the alphabet.

        Parameters
        ----------
        ctx
            As click gives it; not used.

        Returns
        -------
        list of str
        """
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the commands by group.

        Parameters
        ----------
        ctx, formatter
            As click gives them.
        """
        for heading, names in COMMAND_GROUPS.items():
            with formatter.section(heading):
                formatter.write_dl([(name, self.commands[name].short_help or "") for name in names])

    def main(self, args: Sequence[str] | None = None, **extra: Any) -> NoReturn:  # type: ignore[override]
        """Run one command line and leave the interpreter, in any mode of click.

        Parameters
        ----------
        args : sequence of str, optional
            Words of the command line; those of the program without it.
        **extra : object
            Keywords of ``click.Group.main``.

        Raises
        ------
        SystemExit
            Always: 0, 1 for wrong data, 2 for a wrong call, 128 and the signal of a run that was stopped.
        """
        arguments = list(sys.argv[1:] if args is None else args)
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):  # an escape for what cannot be written, as in a file's name
                stream.reconfigure(errors="backslashreplace")
        gc.set_threshold(GARBAGE_THRESHOLD)
        with note_every_interrupt(ends=args is None) as finish:
            try:
                status = self._status(arguments, extra)
                finish()
            except KeyboardInterrupt:  # after the last line of the command
                status = exit_status()
            status = status if isinstance(status, int) else 0
            if was_heard() and status in (0, 1):  # what is there was given; make must not take it as done
                status = exit_status()
        try:
            sys.stderr.flush()
        except (OSError, ValueError):
            _to_nowhere(sys.stderr)  # else the status would be 120
        if args is None:  # the interpreter ends: its last search for garbage looks through all libraries
            gc.freeze()
        sys.exit(status)

    def _status(self, arguments: list[str], extra: Mapping[str, Any]) -> Any:
        """Run one command line; the exit status."""
        try:
            return super().main(arguments, **{**extra, "standalone_mode": False, "obj": arguments})
        except (click.Abort, KeyboardInterrupt):
            _tell("Stopped.")
            return exit_status()
        except click.ClickException as error:
            context = getattr(error, "ctx", None)
            hint = f" (see {context.command_path} --help)" if context else ""
            _tell("Error: " + " ".join(error.format_message().split()) + _near_miss(error) + hint)
            return error.exit_code
        except BrokenPipeError:
            _to_nowhere(sys.stdout)
            return PIPE_CLOSED
        except UnicodeError as error:
            reason = getattr(error, "reason", error)  # only those of a codec have one
            _tell(f"Error: a name or text: cannot be converted ({reason}) - rename the file in plain letters")
        except OSError as error:  # a full disk, a folder gone, a name it cannot take
            what = f"{error.filename or 'output'}: cannot be read or written ({error.strerror or error})"
            _tell(f"Error: {what} - check the disk and permissions")
        except Exception:  # a library that an interrupt has hit while it loads fails in any way
            if not was_heard():
                raise
            _tell("Stopped.")
            return exit_status()
        _to_nowhere(sys.stdout)
        return WRONG_DATA

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command, each fault printed on a line of its own.

        Parameters
        ----------
        ctx
            As click gives it.

        Returns
        -------
        object
            The exit status where it is an int.
        """
        try:
            return super().invoke(ctx)
        except FeederError as error:
            command = self.get_command(ctx, ctx.invoked_subcommand or "")
            options = options_by_argument(command)
            parts = (command, *getattr(command, "commands", {}).values())
            values = {  # by the names that faults have of them
                name
                for param in (param for part in parts for param in getattr(part, "params", ()))
                if not isinstance(param.type, click.Path)
                for name in (param.name, *(word.lstrip("-").replace("-", "_") for word in param.opts))
            }
            status = WRONG_CALL  # where every fault is that of a value, none that of a file or the machine
            for fault in error.faults if isinstance(error, Faults) else (error,):
                lines = fault.lines
                is_of_value = isinstance(fault, ArgumentError) and not isinstance(fault, MissingPackage)
                if isinstance(fault, ArgumentError):  # an argument goes by the name of its option
                    name, *rest = str(fault.where).split(" ", 1)
                    option = options.get(name, "--" + name.replace("_", "-"))
                    if name in COMMANDS and name not in options:  # of a command, for what it needs
                        option = f"feeder {name}"
                    where = " ".join([option, *rest])
                    value = fault.value if option in options.values() else None
                    mend = fault.mend if value is None else f"write {typed([option], value)}"
                    lines = (f"{where}: {fault.what} - {mend}",)
                    is_of_value = is_of_value and name in values
                status = status if is_of_value else WRONG_DATA
                for line in lines:
                    _tell(f"Error: {translate(line, options)}")
            return ctx.exit(status)
        except BrokenPipeError:  # before click takes it for its own
            _to_nowhere(sys.stdout)
            return ctx.exit(PIPE_CLOSED)


def _to_nowhere(stream: TextIO) -> None:
    """Throw away what still waits for a stream that takes no more: Python's last flush would fail as well."""
    with contextlib.suppress(OSError, ValueError):  # a stream of a test has no number
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _tell(line: str) -> None:
    with contextlib.suppress(OSError):  # stderr may be the full disk
        click.echo(printable(line), err=True)


def _near_miss(error: click.ClickException) -> str:
    """The choice that a mistyped one was meant for, or what a missing option looks like, to be typed."""
    example = getattr(getattr(error, "param", None), "example", None)
    if isinstance(error, click.MissingParameter) and example and error.param is not None:
        return f" - add {typed(error.param.opts, example)}"
    mistyped, param = NO_CHOICE.match(getattr(error, "message", "")), getattr(error, "param", None)
    kind = getattr(param, "type", None)
    if not mistyped or not isinstance(kind, click.Choice):
        return ""
    near = difflib.get_close_matches(mistyped[1], [str(choice) for choice in kind.choices], n=1)
    if not near:
        return ""
    return f" Did you mean '{near[0]}'?" + (
        f" - write {typed(param.opts, near[0])}" if isinstance(param, click.Option) else ""
    )


@click.group(
    cls=Fence,
    commands=Commands(),
    invoke_without_command=True,
    context_settings={"color": COLOUR, "max_content_width": 100, "help_option_names": ["-h", "--help"]},
)
@click.version_option(__version__, "-V", "--version", prog_name="feeder")
@click.pass_context
def feeder(ctx: click.Context) -> None:
    """Example: feeder design washer_m6.stl --target 40/min -o results

    Vibratory bowl feeders from the CAD file of a part: how it lies and travels, which cuts let one way up
    leave, how many a minute, and in which bowl, tried part by part.

    feeder sample writes the files of the examples. docs/glossary.md explains the words, with pictures.
    A variable FEEDER_<OPTION> gives an option that is not typed: FEEDER_FORMAT=json.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
