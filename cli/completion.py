"""What the shell completes beyond commands, options and files; each is asked with what is typed so far."""


def keys(context, option, typed):
    """Keys of a bowl file, for KEY=VALUE."""
    from feederscrew.bowl.schema import BY_NAME

    return [f"{name}=" for name in BY_NAME if name.startswith(typed)]


def rules(context, option, typed):
    """Rules whose probabilities a rate can take."""
    from feederscrew.resting.rules.registry import CHOICES

    return [name for name in CHOICES if name.startswith(typed)]


def materials(context, option, typed):
    """Materials with a known density, without blanks that a shell would part."""
    from feederscrew.part.density import MATERIALS

    names = [material.name.replace(" ", "_") for material in MATERIALS]
    return [name for name in names if name.startswith(typed)]
