"""Arguments of the library by the names of their options, in what it says."""

import re

import click

MARKED = re.compile(r"`([a-z_]+)`")  # how the library names an argument within a sentence


def options(command):
    """The options of a command by the argument they are; those of 'config' are of 'show' and 'init'."""
    return {param.name: param.opts[0] for param in _params(command)}


def values(command):
    """The arguments of a command that are values, not files: a wrong one is a wrong call."""
    return {
        name
        for param in _params(command)
        if not isinstance(param.type, click.Path)
        for name in (param.name, *(word.lstrip("-").replace("-", "_") for word in param.opts))
    }


def _params(command):
    parts = (command, *getattr(command, "commands", {}).values())
    return [param for part in parts for param in getattr(part, "params", ())]


def translated(text, options_by_argument):
    """The text with `argument` as --option where the command has one, else bare."""
    return MARKED.sub(lambda found: options_by_argument.get(found[1], found[1]), text)
