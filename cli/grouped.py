"""Help of commands: on one screen what most calls need, and everything with --help-all."""

import inspect
import textwrap
from collections.abc import Callable, Iterable
from typing import Any

import click

OPTION_GROUPS = {  # heading: names of the options that commands share
    "The part": ("units", "density", "centre_of_mass", "names", "body", "allow_open"),
    "The bowl": ("path", "paths", "overrides"),
    "How parts arrive": ("launch", "rule", "probabilities", "fed", "surface", "surface_exponent"),
    "The run": ("seed", "jobs"),
    "Output": ("pictures", "directory", "depfile", "format", "quiet", "verbose"),
}
OPTION_HEADINGS = {name: heading for heading, names in OPTION_GROUPS.items() for name in names}
OWN_OPTIONS = "Options"
GLOSSARY = "Words (aspect, heading, purity ...): docs/glossary.md"
COMMON = "Options of most commands"
HELP_RECORD = ("-h, --help, --help-all", "Show this help, or every option.")
# shared options that few calls need
RARE_OPTIONS = {
    "centre_of_mass",
    "names",
    "allow_open",
    "body",
    "rule",
    "launch",
    "probabilities",
    "fed",
    "surface",
    "surface_exponent",
    "lining",
    "date",
    "revision",
    "seed",
    "jobs",
    "pictures",
    "depfile",
    "quiet",
    "verbose",
}


class Grouped(click.Command):
    """A command whose help fits a screen; ``rare`` names its own options that stand in --help-all only."""

    def __init__(self, *arguments: Any, rare: Iterable[str] = (), **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        self.rare = RARE_OPTIONS | set(rare)

        def show(ctx: click.Context, _: click.Parameter, value: bool) -> None:
            if value and not ctx.resilient_parsing:
                ctx.meta["help_all"] = True
                click.echo(ctx.get_help(), color=ctx.color)
                ctx.exit()

        text = "Show every option and the whole text."
        flag = {"is_flag": True, "is_eager": True, "expose_value": False}
        self.help_all = click.Option(["--help-all"], help=text, callback=show, **flag)
        self.params.append(self.help_all)

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the example and the first paragraph, or with --help-all every one.

        Parameters
        ----------
        ctx, formatter
            As click gives them.
        """
        paragraphs = inspect.cleandoc(self.help or "").split("\n\n")
        whole, self.help = self.help, "\n\n".join(paragraphs if _is_whole(ctx) else paragraphs[:2])
        try:
            super().format_help_text(ctx, formatter)
        finally:
            self.help = whole

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the command's own options, then those that it shares; the rare ones with --help-all.

        Parameters
        ----------
        ctx, formatter
            As click gives them.
        """
        whole = _is_whole(ctx)
        left_out = () if whole else (self.get_help_option(ctx), self.help_all)
        listed = [
            option
            for option in self.get_params(ctx)
            if isinstance(option, click.Option) and option not in left_out
        ]
        headings = (OWN_OPTIONS, *OPTION_GROUPS) if whole else (OWN_OPTIONS, COMMON)
        sections: dict[str, list[tuple[str, str]]] = {heading: [] for heading in headings}
        for option in listed:
            heading = OPTION_HEADINGS.get(option.name, OWN_OPTIONS)
            record = option.get_help_record(ctx) if whole or option.name not in self.rare else None
            if record:
                sections[heading if whole or heading == OWN_OPTIONS else COMMON].append(record)
        if not whole:
            sections[OWN_OPTIONS].append(HELP_RECORD)
        for heading, records in sections.items():
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)
        rare = self._rare_options(ctx)
        if rare and not whole:
            formatter.write_paragraph()
            text = f"Rare, see --help-all: {', '.join(rare)}"
            formatter.write(textwrap.fill(text, formatter.width, break_on_hyphens=False) + "\n")

    def _rare_options(self, ctx: click.Context) -> list[str]:
        """The options that only --help-all explains."""
        listed = (option for option in self.get_params(ctx) if isinstance(option, click.Option))
        return [max(option.opts, key=len) for option in listed if option.name in self.rare]

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write where words are explained.

        Parameters
        ----------
        ctx, formatter
            As click gives them.
        """
        super().format_epilog(ctx, formatter)
        _write_glossary(formatter, apart=_is_whole(ctx) or not self._rare_options(ctx))


class Words(click.Group):
    """A group of commands whose help ends in where words are explained."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write where words are explained.

        Parameters
        ----------
        ctx, formatter
            As click gives them.
        """
        super().format_epilog(ctx, formatter)
        _write_glossary(formatter)


def _write_glossary(formatter: click.HelpFormatter, *, apart: bool = True) -> None:
    if apart:
        formatter.write_paragraph()
    formatter.write(f"{GLOSSARY}\n")


def _is_whole(ctx: click.Context) -> bool:
    return bool(ctx.meta.get("help_all"))


def command(**keywords: Any) -> Callable:
    """Return the decorator ``click.command`` for a ``Grouped`` command.

    Parameters
    ----------
    **keywords : object
        As of ``click.command``; ``rare`` are names of parameters that only --help-all lists.

    Returns
    -------
    callable
    """
    return click.command(cls=Grouped, **keywords)
