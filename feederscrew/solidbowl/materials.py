"""What a bowl is made of, and how thick its walls are then."""

from dataclasses import dataclass

STEEL_NAME = "steel"


@dataclass(frozen=True)
class BowlMaterial:
    """Thicknesses and density of one way to make a bowl."""

    name: str
    wall: float  # [m]
    floor: float  # [m]
    plate: float  # [m] of the track
    density: float  # [kg/m3]
    supported: bool  # every face may hang free: welded, or held up by the powder around it
    flat: bool  # the underside of the floor is flat, to stand on a printer's bed


PRINTED_MATERIALS = (
    BowlMaterial("pla", 4e-3, 5e-3, 4e-3, 1240.0, supported=False, flat=True),
    BowlMaterial("pa12", 3e-3, 4e-3, 3e-3, 1010.0, supported=True, flat=False),
)
NAMES = (*(one.name for one in PRINTED_MATERIALS), STEEL_NAME)


def material(name, rules):
    """Return a material by name.

    Parameters
    ----------
    name : str
        Of ``NAMES``; 'steel' is the sheet of the bowl file.
    rules : Sizing
        Its thickness and density of the sheet.

    Returns
    -------
    BowlMaterial
    """
    if name == STEEL_NAME:
        sheet = rules.sheet
        return BowlMaterial(STEEL_NAME, sheet, sheet, sheet, rules.sheet_density, supported=True, flat=False)
    return next(one for one in PRINTED_MATERIALS if one.name == name)
