"""What the shell completes beyond commands, options and files; each is asked with what is typed so far."""


def keys(context, option, typed):
    """Keys of a bowl file, for KEY=VALUE."""
    from feederscrew.bowl.schema import BY_NAME

    return [f"{name}=" for name in BY_NAME if name.startswith(typed)]


def rules(context, option, typed):
    """Rules whose probabilities a rate can take."""
    return [name for name in known_rules() if name.startswith(typed)]


def known_rules():
    """Every rule by name."""
    from feederscrew.resting.rules.registry import CHOICES

    return CHOICES


def materials(context, option, typed):
    """Materials with a known density, without blanks that a shell would part."""
    names = [name.replace(" ", "_") for name in known_materials()]
    return [name for name in names if name.startswith(typed)]


def known_materials():
    """Every material by name."""
    from feederscrew.part.density import MATERIALS

    return [material.name for material in MATERIALS]
