"""Output of a call: data to stdout, talk to stderr, files to the folder of ``-o``."""

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

from feederscrew.base.errors import Detail
from feederscrew.base.units import printable
from feederscrew_cli import progress
from feederscrew_cli.interrupt import hold_interrupts

if TYPE_CHECKING:
    from feederscrew.base.columns import Frame
    from feederscrew.bowl import Bowl
    from feederscrew.bowl.reading import Setting
    from feederscrew.output.folder import ResultFolder
    from feederscrew.output.offers import Offer
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
    """The way in which one call wants its answer; every command prints and writes through it."""

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
        """Return the output of the command that is running.

        Parameters
        ----------
        **options : object
            Values of the options of the output, as fields of this class.

        Returns
        -------
        Output

        Raises
        ------
        click.UsageError
            If ``--depfile`` is given without ``-o``.
        """
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
        """Tell each warning on stderr and keep it for run.json.

        Parameters
        ----------
        *texts : str
            Sentences; a ``Detail`` is told with ``-v`` only.
        """
        for text in texts:
            tell = self.detail if isinstance(text, Detail) else self.say
            warning = translate(text, self.options)
            self.warnings.append(warning)
            tell(f"Warning: {warning}")

    def say(self, *texts: str) -> None:
        """Print each text as a line on stderr, folded where that is a terminal, unless ``-q``.

        Parameters
        ----------
        *texts : str
            With `argument` for an option of the command.
        """
        width = min(shutil.get_terminal_size().columns, PAGE) if sys.stderr.isatty() else None
        for text in texts:
            if not self.quiet:
                progress.end_line()
                with contextlib.suppress(OSError):  # a full disk under stderr must not cost the answer
                    click.echo(fold_text(printable(translate(text, self.options)), width), err=True)

    def fault(self, *texts: object) -> None:
        """Print each fault of one part of many as a line on stderr, also with ``-q``: the status is 1 then.

        Parameters
        ----------
        *texts : object
        """
        replace(self, quiet=False).say(*(f"Error: {text}" for text in texts))

    def detail(self, text: str) -> None:
        """Print one line on stderr, with ``-v`` only.

        Parameters
        ----------
        text : str
        """
        if self.verbose:
            self.say(text)

    @contextlib.contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Time the block; said with ``-v``.

        Parameters
        ----------
        name : str
            Of the step.

        Yields
        ------
        None
        """
        start = time.perf_counter()
        yield
        self.detail(f"{name}: {time.perf_counter() - start:.2f} s")

    def part(self, keywords: Mapping[str, Any]) -> "Part":
        """Read a part and tell its warnings.

        Parameters
        ----------
        keywords : mapping of str to object
            Values of ``options.part``.

        Returns
        -------
        Part

        Raises
        ------
        FeederError
            If it cannot be read, or the folder of ``-o`` cannot take its results.
        """
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
            from feederscrew.arrivals import simulation_cache
            from feederscrew.base import caches

            self.say(*filter(None, [simulation_cache.refusal()]), *caches.kernel_refusals())
        return solid

    def check_folder(self, name: str, identity: Mapping[str, str] | None = None) -> None:
        """Refuse before any work what ``folder`` refuses after it.

        Parameters
        ----------
        name : str
            Of the part or the bowl file.
        identity : mapping of str to str, optional
            As of ``folder``; without it only the place is checked.

        Raises
        ------
        FeederError
        """
        if self.directory is not None:
            from feederscrew.output.folder import ResultFolder, check_place, safe_name

            if identity is None:
                check_place(Path(self.directory) / safe_name(name))
            else:
                ResultFolder(self.directory, name, identity)
            if self.depfile:
                check_place(Path(self.depfile).parent, "give another `depfile`")

    def tell_unread(self, *paths: object) -> None:
        """Say that a bowl file lies in the folder and is not read, where none is named.

        Parameters
        ----------
        *paths : object
            Bowl files that the call names, None where it names none.
        """
        if not any(paths) and Path(UNREAD).is_file():
            self.say(f"{UNREAD} in this folder is not read: add --config {UNREAD} to use it")

    def settings(self, bowl: Mapping[str, Any]) -> tuple["Setting", ...]:
        """Read the bowl file and tell what a machine makes of its drive.

        Parameters
        ----------
        bowl : mapping of str to object
            Values of ``options.bowl``.

        Returns
        -------
        tuple of Setting

        Raises
        ------
        FeederError
            If the file cannot be read, or a value is wrong.
        """
        from feederscrew import bowl as bowls

        self.tell_unread(bowl["path"])
        settings = bowls.settings(**bowl)
        self.warn(*bowls.remarks(settings))
        return settings

    def part_in_bowl(
        self, part: Mapping[str, Any], bowl: Mapping[str, Any]
    ) -> tuple["Part", tuple["Setting", ...], "Bowl"]:
        """Read a part and a bowl file; say what the table of friction has for the part's material.

        Parameters
        ----------
        part, bowl : mapping of str to object
            Values of ``options.part`` and ``options.bowl``.

        Returns
        -------
        part : Part
        settings : tuple of Setting
        bowl : Bowl
        """
        from feederscrew.bowl import friction_remarks, record, with_part_material

        solid, settings = self.part(part), self.settings(bowl)
        settings = with_part_material(settings, solid.material)
        self.warn(*friction_remarks(settings, solid.material))
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

        Parameters
        ----------
        frame : Frame
        document : mapping of str to object
        hidden : iterable of str, optional
            Columns that a table for people leaves out.
        spare : sequence of sequence of str, optional
            Where it is given, a table for people is no wider than a page. Of these columns, from the first
            on, as many as that takes are left out, and it says which. Texts of a table that is still wider go
            on below.
        """
        from feederscrew.output import tables

        progress.end_line()
        if self.format == "json":
            click.echo(tables.json_text(document), nl=False)
            return
        for_people = self.format == "table"
        printed = frame.for_people().without(hidden) if for_people else frame
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
        """Write the rule of ``--depfile``, where it is given: files and what they are made from.

        Parameters
        ----------
        targets : iterable of Path
            Files that were written.
        inputs : iterable of str, optional
            Files that they are made from; those named on the command line without it.
        """
        if self.depfile:
            from feederscrew.output import folder

            folder.write_rule(self.depfile, targets, self.inputs if inputs is None else inputs)

    @contextlib.contextmanager
    def folder(
        self, name: str, identity: Mapping[str, str], effective: Mapping[str, Any] | None = None
    ) -> Iterator["ResultFolder | None"]:
        """Yield the folder for this call's files, kept only if all goes well.

        Parameters
        ----------
        name : str
            Of the part or the bowl file: that of the folder below ``-o``.
        identity : mapping of str to str
            The sha256 of each input by its path, the one that names the folder first.
        effective : mapping of str to object, optional
            The parameters that led to the numbers, for run.json.

        Yields
        ------
        ResultFolder or None
            None without ``-o``.

        Raises
        ------
        KeyboardInterrupt
            If the user stopped it while it was drawing, once what is there has been written.
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
        """Return ``folder`` of a part.

        Parameters
        ----------
        solid : Part
        *inputs : mapping of str to str
            The sha256 of further inputs by their paths.
        settings : sequence of Setting, optional
            Of a bowl file.
        values : mapping of str to object, optional
            Further parameters that led to the numbers.

        Returns
        -------
        context manager of ResultFolder or None
        """
        from feederscrew.bowl import texts
        from feederscrew.output.part_facts import conditions

        identity = dict(item for each in (solid.inputs, *inputs) for item in each.items())
        return self.folder(solid.name, identity, conditions(solid) | texts(settings) | dict(values or {}))

    def write(self, folder: "ResultFolder | None", files: Iterable["Offer"], *, jobs: int = 1) -> None:
        """Make the files that are offered and put them into a folder.

        Parameters
        ----------
        folder : ResultFolder or None
            None: nothing is made.
        files : iterable of Offer
        jobs : int, optional
            Cores to draw on.
        """
        from feederscrew.output import offers

        offers.write(folder, files, pictures=self.pictures, jobs=jobs)


def options_by_argument(command: click.Command | None) -> dict[str, str]:
    """Return the options of a command by the argument they are.

    Parameters
    ----------
    command : click.Command or None
        Of a group, 'config', with those of its commands, 'show' and 'init'.

    Returns
    -------
    dict of str to str
        {'centre_of_mass': '--centre-of-mass'}
    """
    parts = (command, *getattr(command, "commands", {}).values())
    return {param.name: param.opts[0] for part in parts for param in getattr(part, "params", ())}


def typed(names: Sequence[str], value: str) -> str:
    """Return an option with its value as one types it.

    Parameters
    ----------
    names : sequence of str
        Of the option, in any order; a long one is taken where there is one.
    value : str

    Returns
    -------
    str
        '--target 60/min', '--set drive.frequency="50 Hz"'
    """
    name = next((name for name in names if name.startswith("--")), names[0])
    key, equals, rest = value.partition("=")
    if SAFE_WORD.fullmatch(value):
        return f"{name} {value}"
    if not QUOTED_SAFE.fullmatch(value):
        return f"{name} {shlex.quote(value)}"
    return f'{name} {key}="{rest}"' if equals and SAFE_WORD.fullmatch(key) else f'{name} "{value}"'


def translate(text: str, options: Mapping[str, str]) -> str:
    """Return a text of the library with `argument` as --option where the command has one, else bare.

    Parameters
    ----------
    text : str
    options : mapping of str to str
        As ``options_by_argument`` returns them.

    Returns
    -------
    str
    """
    return MARKED.sub(lambda mark: options.get(mark[1], mark[1]), text)


def fold_text(text: str, width: int | None) -> str:
    """Return a text in lines of so many letters, those behind the first set in.

    Parameters
    ----------
    text : str
    width : int or None
        Letters of a line; None leaves the text as it stands.

    Returns
    -------
    str
    """
    if width is None or len(text) <= width:
        return text
    return textwrap.fill(text, width, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)


def placeless(arguments: Iterable[str]) -> list[str]:
    """Return arguments as typed without the folder of ``-o``: the same wherever the results are put.

    Parameters
    ----------
    arguments : iterable of str

    Returns
    -------
    list of str
    """
    words, skip = [], False
    for argument in arguments:
        if not (skip or argument in FOLDER or argument.startswith(("--output=", "-o="))):
            words.append(argument)
        skip = argument in FOLDER
    return words
