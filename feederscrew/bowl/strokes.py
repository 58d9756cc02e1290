"""``--amplitude 78%,80%,82%``: bowls at several strokes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from feederscrew import units
from feederscrew.bowl.reading import checked
from feederscrew.bowl.record import Bowl
from feederscrew.bowl.schema import BY_NAME
from feederscrew.errors import ArgumentError, ConfigError

AMPLITUDES_KEY = "amplitudes"
MAX_STROKES = 50  # strokes of one call
FULL = 5.0  # of the bowl's own amplitude, at most


def strokes(bowl: Bowl, text: str | None = None) -> tuple[Bowl, ...]:
    """Return the bowl at each amplitude of its drive.

    Parameters
    ----------
    bowl : Bowl
    text : str or None
        '78%,80%,82%' of the bowl's own amplitude, or '0.3 mm,0.4 mm'; None for that one alone.

    Returns
    -------
    tuple of Bowl

    Raises
    ------
    ConfigError
        If an entry is neither, or out of range.
    """
    if text is None:
        return (bowl,)
    entries = text.split(",")
    if len(entries) > MAX_STROKES:
        raise ArgumentError(AMPLITUDES_KEY, f"{len(entries)} amplitudes", f"give at most {MAX_STROKES}")
    amplitudes = [_amplitude(bowl.drive.amplitude, entry) for entry in entries]
    return tuple(replace(bowl, drive=replace(bowl.drive, amplitude=amplitude)) for amplitude in amplitudes)


def named(paths: Sequence[str | None]) -> list[str]:
    """Return what bowl files are called side by side: their stems, their paths where two stems are the same.

    Parameters
    ----------
    paths : sequence of (str or None)
        None for the defaults.

    Returns
    -------
    list of str
    """
    stems = ["defaults" if path is None else Path(path).stem for path in paths]
    if len(set(stems)) == len(stems):
        return stems
    return [stem if path is None else str(path) for stem, path in zip(stems, paths)]


def _amplitude(full: float, entry: str) -> float:
    if not entry.strip().endswith("%"):
        try:
            return checked(BY_NAME["drive.amplitude"], entry, AMPLITUDES_KEY).value
        except ConfigError as fault:
            raise ArgumentError(fault.where, fault.what, fault.mend) from None
    try:
        share = units.quantity(entry, "number")
    except units.QuantityError as fault:
        raise ArgumentError(AMPLITUDES_KEY, fault.what, fault.mend) from None
    if not 0.0 <= share <= FULL:
        raise ArgumentError(
            AMPLITUDES_KEY,
            f"{units.shown(entry)} is out of range",
            f"give 0% to {FULL:.0%} of drive.amplitude",
        )
    return share * full
