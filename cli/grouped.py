"""Help of commands: on one screen what most calls need, and everything with --help-all."""

import inspect
import textwrap

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
COMMON = "Options of most commands"
# shared options that few calls need
RARE_OPTIONS = {
    "centre_of_mass", "names", "allow_open", "body", "rule", "launch", "probabilities", "fed", "surface",
    "surface_exponent", "seed", "jobs", "pictures", "depfile", "quiet", "verbose",
}  # fmt: skip


class Grouped(click.Command):
    """A command whose help fits a screen; ``rare`` names its own options that stand in --help-all only."""

    def __init__(self, *arguments, rare=(), **keywords):
        super().__init__(*arguments, **keywords)
        self.rare = RARE_OPTIONS | set(rare)
        self.params.append(_help_all())

    def format_help_text(self, ctx, formatter):
        """Write the example and the first paragraph, or with --help-all every one."""
        paragraphs = inspect.cleandoc(self.help or "").split("\n\n")
        whole, self.help = self.help, "\n\n".join(paragraphs if _is_whole(ctx) else paragraphs[:2])
        try:
            super().format_help_text(ctx, formatter)
        finally:
            self.help = whole

    def format_options(self, ctx, formatter):
        """Write the command's own options, then those that it shares; the rare ones with --help-all."""
        listed = [option for option in self.get_params(ctx) if isinstance(option, click.Option)]
        if _is_whole(ctx):
            self._write(
                ctx, formatter, {heading: _of(listed, heading) for heading in (OWN_OPTIONS, *OPTION_GROUPS)}
            )
            return
        often = [option for option in listed if option.name not in self.rare]
        shared = [option for option in often if option.name in OPTION_HEADINGS]
        self._write(ctx, formatter, {OWN_OPTIONS: _of(often, OWN_OPTIONS), COMMON: shared})
        rare = [max(option.opts, key=len) for option in listed if option.name in self.rare]
        if rare:
            formatter.write_paragraph()
            text = f"Rare, see --help-all: {', '.join(rare)}"
            formatter.write(textwrap.fill(text, formatter.width, break_on_hyphens=False) + "\n")

    def _write(self, ctx, formatter, sections):
        for heading, options in sections.items():
            records = [record for option in options if (record := option.get_help_record(ctx))]
            if records:
                with formatter.section(heading):
                    formatter.write_dl(records)


def _of(options, heading):
    """Those of a heading."""
    return [option for option in options if OPTION_HEADINGS.get(option.name, OWN_OPTIONS) == heading]


def _is_whole(ctx):
    return bool(ctx.meta.get("help_all"))


def _help_all():
    """The option that shows the whole help."""

    def show(ctx, _, value):
        if value and not ctx.resilient_parsing:
            ctx.meta["help_all"] = True
            click.echo(ctx.get_help(), color=ctx.color)
            ctx.exit()

    return click.Option(
        ["--help-all"], is_flag=True, is_eager=True, expose_value=False, callback=show,
        help="Show every option and the whole text.",
    )  # fmt: skip


def command(**keywords):
    """Return the decorator ``click.command`` for a ``Grouped`` command; ``rare`` are names of parameters."""
    return click.command(cls=Grouped, **keywords)
