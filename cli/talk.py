"""What goes where: data to stdout, talk to stderr, files to the folder of ``-o``."""

import contextlib
import re
import shlex
import shutil
import sys
import textwrap
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from feederscrew.errors import Detail
from feederscrew.units import printable
from feederscrew_cli import progress
from feederscrew_cli.interrupt import hold_interrupts

if TYPE_CHECKING:
    from feederscrew.bowl import Bowl
    from feederscrew.bowl.reading import Setting
    from feederscrew.output.folder import ResultFolder
    from feederscrew.output.offers import Offer
    from feederscrew.output.tables import Frame
    from feederscrew.part.record import Part

MARKED = re.compile(r"`([a-z_]+)`")  # how the library names an argument within a sentence
PRINT_FORMATS = ("table", "csv", "json")
UNREAD = "bowl.yaml"  # the name that every page gives a bowl file
PAGE = 100  # letters of a line that people read, at most
FOLDER = ("-o", "--output")
SAFE_WORD = re.compile(r"[\w.+:,@%/=-]+")  # of a value that every shell takes as it stands
QUOTED_SAFE = re.compile(r"[\w.+:,@%/=() -]+")  # within double quotes
OUTPUT_OPTIONS = ("directory", "depfile")  # options that name what is written, not what is read


@dataclass(frozen=True, eq=False)
class Output:
    """How one call wants its answer; every command prints and writes through it."""

    command: str  # the command's name, as run.json records it
    arguments: tuple[str, ...]  # as typed
    format: str  # of what goes to stdout: one of FORMATS
    directory: str | None = None  # of -o
    quiet: bool = False
    verbose: bool = False
    depfile: str | None = None  # of --depfile
    pictures: bool = True  # without --no-pictures
    inputs: tuple[str, ...] = ()  # the files named on the command line
    options: dict[str, str] = field(default_factory=dict)  # of the command, by the argument they are
    warnings: list[str] = field(default_factory=list)  # said so far, for run.json
    notes: list[str] = field(default_factory=list)  # what was explained so far: each thing once

    @classmethod
    def of_call(cls, **options: Any) -> "Output":
        """The output of the command that is running."""
        context = click.get_current_context()
        name = context.command_path.removeprefix(context.find_root().command_path).strip()
        if options.get("depfile") and not options["directory"]:
            raise click.UsageError("--depfile says what the files of -o depend on - give -o as well")
        inputs: list[str] = []  # files named on the command line, apart from where results go
        for option in context.command.params:
            value = context.params.get(option.name or "")
            is_input = isinstance(option.type, click.Path) and option.name not in OUTPUT_OPTIONS
            if is_input and value not in (None, "-"):
                inputs += value if isinstance(value, tuple) else (value,)
        known = options_by_argument(context.command)
        out = cls(name, tuple(context.obj or ()), inputs=tuple(inputs), options=known, **options)
        for option in context.command.params:
            if context.get_parameter_source(option.name or "") is click.core.ParameterSource.ENVIRONMENT:
                out.say(f"{option.envvar} in the environment gives {option.opts[0]}")
        return out

    def warn(self, *texts: str) -> None:
        """Tell each warning on stderr and keep it for run.json; a detail is told with ``-v`` only."""
        for text in texts:
            tell = self.detail if isinstance(text, Detail) else self.say
            warning = translate(text, self.options)
            self.warnings.append(warning)
            tell(f"Warning: {warning}")

    def say(self, *texts: str) -> None:
        """Each text as a line on stderr, folded where that is a terminal, unless ``-q``."""
        width = min(shutil.get_terminal_size().columns, PAGE) if sys.stderr.isatty() else None
        for text in texts:
            if not self.quiet:
                progress.end_line()
                with contextlib.suppress(OSError):  # a full disk under stderr must not cost the answer
                    click.echo(fold_text(printable(translate(text, self.options)), width), err=True)

    def fault(self, *texts: object) -> None:
        """Each fault of one part of many as a line on stderr, with ``-q`` as well: it makes the status 1."""
        replace(self, quiet=False).say(*(f"Error: {text}" for text in texts))

    def detail(self, text: str) -> None:
        """One line on stderr, with ``-v`` only."""
        if self.verbose:
            self.say(text)

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Time what happens inside; said with ``-v``."""
        start = time.perf_counter()
        yield
        self.detail(f"{name}: {time.perf_counter() - start:.2f} s")

    def part(self, keywords: Mapping[str, Any]) -> "Part":
        """Read the part of ``options.part`` and tell its warnings; the ``Part``."""
        typed = keywords["source"] == "-"  # one who waits for standard input can give it up
        with (
            contextlib.nullcontext() if typed else hold_interrupts(),
            self.step(f"read {keywords['source']}"),
        ):
            from feederscrew.part import load

            solid = load(**keywords)
        self.warn(*solid.warnings)
        self.check_folder(solid.name, solid.inputs)
        if self.verbose:
            from feederscrew import caches
            from feederscrew.studies import simulation_cache

            self.say(*filter(None, [simulation_cache.refusal()]), *caches.kernel_refusals())
        return solid

    def check_folder(self, name: str, identity: Mapping[str, str] | None = None) -> None:
        """Refuse before any work what ``folder`` refuses after it; without ``identity`` its place only."""
        if self.directory is not None:
            from feederscrew.output.folder import ResultFolder, check_place, safe_name

            if identity is None:
                check_place(Path(self.directory) / safe_name(name))
            else:
                ResultFolder(self.directory, name, identity)
            if self.depfile:
                check_place(Path(self.depfile).parent, "give another `depfile`")

    def tell_unread(self, *paths: object) -> None:
        """Say that a bowl file lies in the folder and is not read, where none is named."""
        if not any(paths) and Path(UNREAD).is_file():
            self.say(f"{UNREAD} in this folder is not read: add --config {UNREAD} to use it")

    def settings(self, bowl: Mapping[str, Any]) -> tuple["Setting", ...]:
        """Read the bowl file of ``options.bowl`` and tell what a machine makes of its drive; the settings."""
        from feederscrew import bowl as bowls

        self.tell_unread(bowl["path"])
        settings = bowls.settings(**bowl)
        self.warn(*bowls.remarks(settings))
        return settings

    def part_in_bowl(
        self, part: Mapping[str, Any], bowl: Mapping[str, Any]
    ) -> tuple["Part", tuple["Setting", ...], "Bowl"]:
        """Read both; the ``Part``, the settings and the ``Bowl``."""
        from feederscrew.bowl import record

        solid, settings = self.part(part), self.settings(bowl)
        return solid, settings, record(settings)

    def show(
        self,
        frame: "Frame",
        document: Mapping[str, Any],
        *,
        hidden: Iterable[str] = (),
        spare: Sequence[Sequence[str]] | None = None,
    ) -> None:
        """Print the document with ``--format json``, else the frame as a table or as CSV.

        A table for people leaves out ``hidden`` columns. Where ``spare`` is given it is no wider than a page.
        Of these columns, from the first on, as many as that takes are left out, and it says which. Texts of
        a table that is still wider go on below.
        """
        from feederscrew.output import tables

        progress.end_line()
        if self.format == "json":
            click.echo(tables.json_text(document), nl=False)
            return
        for_people = self.format == "table"
        printed = frame.without(hidden) if for_people else frame
        if for_people and spare is not None:
            printed, left_out = tables.to_page(printed, spare)
            if left_out:
                those = "it" if len(left_out) == 1 else "them"
                self.say(f"Left out of the table: {', '.join(left_out)}; --format csv prints {those} too")
        width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None  # of a page or a window
        text = tables.text(printed, self.format, width or (None if spare is None else tables.PAGE))
        click.echo(text, nl=False)
        note = tables.heading_note(text) if for_people and not self.notes else ""
        if note:  # what the headings of orientations are turned from: once
            self.notes.append(note)
            self.say(note)

    def depend(self, targets: Iterable[Path], inputs: Iterable[str] | None = None) -> None:
        """Write the rule of ``--depfile``, where it is given: files and what they are made from."""
        if self.depfile:
            from feederscrew.output import folder

            folder.write_rule(self.depfile, targets, self.inputs if inputs is None else inputs)

    @contextlib.contextmanager
    def folder(
        self, name: str, identity: Mapping[str, str], effective: Mapping[str, Any] | None = None
    ) -> Iterator["ResultFolder | None"]:
        """The folder for this call's files, kept only if all goes well; None without ``-o``.

        ``name`` is of the part or the bowl file: the folder below ``-o``. ``identity`` has the sha256 of each
        input by its path, the one that names the folder first; ``effective`` the parameters that led to the
        numbers, for run.json.
        """
        if self.directory is None:
            yield None
            return
        from feederscrew.output.folder import ResultFolder

        folder = ResultFolder(self.directory, name, identity)
        yield folder
        if folder.untouched:
            return
        if folder.left_out:
            self.warn(f"stopped while drawing: without {', '.join(folder.left_out)}")
        with hold_interrupts():  # all of them or none
            words = placeless(self.arguments)
            folder.keep(self.command, arguments=words, effective=effective or {}, warnings=self.warnings)
        if not folder.left_out:  # else not done: no rule for make, the status of what was stopped
            self.depend(folder.path / name for name in sorted(folder.staged))
        self.say(f"Wrote {folder.path} ({', '.join(sorted(folder.staged))}, run.json)")
        if folder.left_out:
            raise KeyboardInterrupt

    def folder_of(
        self,
        solid: "Part",
        *inputs: Mapping[str, str],
        settings: Sequence["Setting"] = (),
        values: Mapping[str, Any] | None = None,
    ) -> contextlib.AbstractContextManager["ResultFolder | None"]:
        """``folder`` of a part, with further ``inputs``, settings of a bowl file and values of its own."""
        from feederscrew.bowl import texts
        from feederscrew.output.columns import conditions

        identity = dict(item for each in (solid.inputs, *inputs) for item in each.items())
        return self.folder(solid.name, identity, conditions(solid) | texts(settings) | dict(values or {}))

    def write(self, folder: "ResultFolder | None", files: Iterable["Offer"], *, jobs: int = 1) -> None:
        """Make what is offered and put it into ``folder``, unless that is None."""
        from feederscrew.output import offers

        offers.write(folder, files, pictures=self.pictures, jobs=jobs)


def options_by_argument(command: click.Command | None) -> dict[str, str]:
    """Return the options of a command by the argument they are; of 'config' those of 'show' and 'init'."""
    parts = (command, *getattr(command, "commands", {}).values())
    return {param.name: param.opts[0] for part in parts for param in getattr(part, "params", ())}


def typed(names: Sequence[str], value: str) -> str:
    """Return an option with its value as one types it: '--target 60/min', '--set drive.frequency="50 Hz"'."""
    name = next((name for name in names if name.startswith("--")), names[0])
    key, equals, rest = value.partition("=")
    if SAFE_WORD.fullmatch(value):
        return f"{name} {value}"
    if not QUOTED_SAFE.fullmatch(value):
        return f"{name} {shlex.quote(value)}"
    return f'{name} {key}="{rest}"' if equals and SAFE_WORD.fullmatch(key) else f'{name} "{value}"'


def translate(text: str, options: Mapping[str, str]) -> str:
    """Return a text of the library with `argument` as --option where the command has one, else bare."""
    return MARKED.sub(lambda mark: options.get(mark[1], mark[1]), text)


def fold_text(text: str, width: int | None) -> str:
    """Return a text in lines of so many letters, what follows set in; as it stands without a width."""
    if width is None or len(text) <= width:
        return text
    whole: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}
    return textwrap.fill(text, width, subsequent_indent="  ", **whole)


def placeless(arguments: Iterable[str]) -> list[str]:
    """Return arguments as typed without the folder of ``-o``: the same wherever the results are put."""
    words, skip = [], False
    for argument in arguments:
        if not (skip or argument in FOLDER or argument.startswith(("--output=", "-o="))):
            words.append(argument)
        skip = argument in FOLDER
    return words
