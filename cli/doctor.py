"""``feeder doctor``: read from the installation itself, importing nothing heavy."""

import os
import platform
import re
import sys
from importlib import metadata
from pathlib import Path

import click

import feederscrew
from feederscrew.base import caches
from feederscrew_cli import grouped

DISTRIBUTION = "feederscrew"
EXTRA = re.compile(r"extra\s*==\s*['\"]([^'\"]+)['\"]")
PACKAGE_NAME = re.compile(r"[A-Za-z0-9._-]+")
DEVELOPERS = ("test", "oracle", "docs")  # extras that a user has no need of
KERNELS = "*.kernel"  # a file each compiled function
SHELLS = ("bash", "zsh", "fish")


@grouped.command(short_help="What is installed here, what is missing, and how to get it.")
def doctor() -> None:
    """Example: feeder doctor

    Print the versions of Python and of every library, and which extras are there. Of one that is not, the
    line that installs it is printed. Then where compiled kernels and simulations are kept, and how to turn on
    completion.
    """
    needed, extras = requirements()
    shell = Path(os.environ.get("SHELL", "")).name
    completion = f'eval "$(_FEEDER_COMPLETE={shell}_source feeder)" in ~/.{shell}rc'
    if shell not in SHELLS:
        completion = "for bash, zsh and fish: see docs/examples.md"
    elif shell == "fish":
        completion = "_FEEDER_COMPLETE=fish_source feeder > ~/.config/fish/completions/feeder.fish"
    colours = "on" if sys.stdout.isatty() else "off: not a terminal"
    report = {
        "Program": [
            ("feeder", feederscrew.__version__),
            ("python", f"{platform.python_version()} ({sys.executable})"),
            ("system", platform.platform()),
        ],
        "Libraries": [
            (name, installed_version(name) or "missing: pip install feederscrew") for name in needed
        ],
        "Extras": [(extra, _state(extra, names)) for extra, names in extras.items()],
        "Compiled kernels": kernels(),
        "Cache": simulations(),
        "Shell": [
            ("completion", completion),
            ("colours", "off: NO_COLOR is set" if os.environ.get("NO_COLOR") else colours),
        ],
    }
    for title, lines in report.items():
        click.echo(click.style(title, bold=True))
        for name, value in lines:
            click.echo(f"  {name:<20} {value}")


def requirements() -> tuple[list[str], dict[str, list[str]]]:
    """Return the libraries that the program needs.

    Returns
    -------
    needed : list of str
        Those that are always needed.
    extras : dict of str to list of str
        Those of each extra, by its name; extras for developers are left out.
    """
    extras: dict[str, list[str]] = {}
    needed = []
    for line in metadata.requires(DISTRIBUTION) or []:
        named, extra = PACKAGE_NAME.match(line), EXTRA.search(line)
        name = named[0] if named else line
        if extra is None:
            needed.append(name)
        elif name != DISTRIBUTION and extra[1] not in DEVELOPERS:
            extras.setdefault(extra[1], []).append(name)
    return sorted(needed), extras


def installed_version(name: str) -> str | None:
    """Return the version of a library.

    Parameters
    ----------
    name : str
        Of its distribution.

    Returns
    -------
    str or None
        None where it is not installed.
    """
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _state(extra: str, names: list[str]) -> str:
    versions = {name: installed_version(name) for name in names}
    missing = [name for name, version in versions.items() if version is None]
    if missing:
        return f"missing {', '.join(missing)}: pip install '{DISTRIBUTION}[{extra}]'"
    return ", ".join(f"{name} {version}" for name, version in versions.items())


def kernels() -> list[tuple[str, str]]:
    """Return how many compiled functions are kept, and where; they are compiled on first use.

    Returns
    -------
    list of (str, str)
        Lines of the report: name and value.
    """
    home = caches.kernel_folder()
    refused = [("not used", reason) for reason in caches.kernel_refusals()]
    if home is None:
        mend = f"name a folder of your own in {caches.KERNELS_VARIABLE}"
        return [("state", f"compiled in every run: no folder can be written - {mend}"), *refused]
    count = sum(1 for _ in home.glob(KERNELS))
    state = f"{count} functions kept" if count else "none yet: the first map or drop test compiles them"
    return [("state", state), ("place", str(home)), *refused]


def simulations() -> list[tuple[str, str]]:
    """Return how many simulations of earlier runs are kept, and where.

    Returns
    -------
    list of (str, str)
        Lines of the report: name and value.
    """
    try:
        from feederscrew.arrivals import simulation_cache
    except ImportError:  # of a library that is missing: the report says so above
        return [("state", "not known: a library is missing")]
    folder = caches.simulation_folder()
    if folder is None:
        return [("state", "none is kept: FEEDER_CACHE is empty")]
    count, refused = len(simulation_cache.entries()), simulation_cache.refusal()
    return [
        ("state", refused or f"{count} simulations kept; feeder cache clear deletes them"),
        ("folder", str(folder)),
    ]
