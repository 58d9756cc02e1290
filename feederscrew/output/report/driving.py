"""The bowl that a part needs, or the machine of the bowl file."""

from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.output import machine, marking, offers, proof, solidbowl_views
from feederscrew.output import tables as plain
from feederscrew.output.page.blocks import Chapter, Notes, Picture, Table, Text, Tile
from feederscrew.output.page.numbers import SHORT, number

SIZED = (
    "The bowl that brings the rate asked for, by the rules of thumb of the section sizing: what the bowl "
    "file says of track, drive and machine is kept. The lines are those that a maker asks for in a quotation."
)
GIVEN = "The springs, the tuning and the drift of the machine of the bowl file."


def bowl(case) -> Chapter | None:
    """Bowl, springs and drift: of a target, or of the machine in the bowl file; None without either."""
    sheet = case.machine
    if sheet is None:
        return None
    mark = _mark(case)
    drawn = offers.by_name(machine.offers(sheet, mark=mark))["bowl.png"]
    sized = sheet.order is not None
    blocks = (
        Text(SIZED if sized else GIVEN),
        *_turned(case, mark),
        Picture(drawn.name, drawn.make(), drawn.alt),
        Table(machine.summary(sheet)),
        Table(machine.leaf_sets(sheet.changes)),
        Table(machine.leaf_sets(sheet.sets)),
        Table(_renamed(machine.emptying(sheet))),
    )
    return Chapter(blocks, tiles=(_tile(sheet),), warnings=sheet.remarks)


def _mark(case):
    """The mark of a bowl file whose trial falls short, as long as that trial holds."""
    tried = bowls.verified(case.path)
    return marking.of_trial(tried if proof.holds(tried, case.part, case.bowl, case.counted) else None)


def _turned(case, mark):
    """The bowl as a solid with parts on its track, to be turned, or why there is none."""
    try:
        return solidbowl_views.blocks(case.solid, case.part, mark=mark)
    except FeederError as fault:
        return [Notes(tuple(f"the bowl as a solid: {line}" for line in fault.lines))]


def _renamed(frame):
    """A table of velocities at the strokes of a bowl that empties, which are not that of the bowl file."""
    renamed = {"velocity_mm_s": "velocity_as_it_empties_mm_s"}
    return plain.frame({renamed.get(name, name): column for name, column in frame.items()})


def _tile(sheet) -> Tile:
    if sheet.order is None:
        above = number(100.0 * sheet.detuning, SHORT)
        note = f"{above} % above the drive; gain {number(sheet.gain, SHORT)}"
        return Tile("natural frequency", f"{number(sheet.springs.natural_frequency, SHORT)} Hz", note)
    size, moved = sheet.order.size, sheet.stroke
    stroke = f"{1e3 * moved.peak_to_peak:.3g} mm at {moved.frequency:.4g} Hz"
    note = f"track {1e3 * size.track_width:.3g} mm; stroke {stroke}"
    return Tile("needs a bowl of", f"{1e3 * size.diameter:.4g} mm", note)
