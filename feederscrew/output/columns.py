"""Records as tables in the units of the shop: mm, g, degrees; the one place that converts them."""

import numpy as np

from feederscrew.output import tables
from feederscrew.resting.rules import recommended
from feederscrew.units import factor

MM, MM2, MM3 = factor("mm", "length"), factor("mm2", "area"), factor("mm3", "volume")
UJ, DEG = factor("uJ", "energy"), factor("deg", "angle")
GRAM, G_MM2, G_CM3 = factor("g", "mass"), factor("g mm2", "inertia"), factor("g/cm3", "density")

NORMALS = ("normal_x", "normal_y", "normal_z")
HIDDEN = (*NORMALS, "barrier_uJ", "p_hops")  # left out of the table for people


def aspects(found, solid, tally=None):
    """The classes of resting aspects, one row each.

    Parameters
    ----------
    found : Aspects
    solid : Part
        Whose they are; an open surface is labelled in every row, and tumbling that fails a self-check.
    tally : Tally, optional
        Of a drop test.

    Returns
    -------
    DataFrame
        The columns of ``aspects.csv``.
    """
    normals = dict(zip(NORMALS, found.normals.T))
    chances = {f"p_{rule}": chance for rule, chance in found.probabilities.items()}
    return tables.frame(
        {
            "aspect": found.names,
            "kind": found.kinds,
            "faces": found.faces,
            "stable": found.stable,
            **normals,
            "height_mm": found.heights / MM,
            "contact_area_mm2": found.contact_areas / MM2,
            "solid_angle_sr": found.solid_angles,
            "polar_inertia_g_mm2": found.polar_inertias / G_MM2,
            **chances,
            **_barriers(found),
            **_dropped(tally),
            **_recommended(_answer(found, tally)),
            **({"surface": ["open"] * len(found.names)} if solid.open_surface else {}),
            **({"tumbling": ["doubtful"] * len(found.names)} if _doubtful(found) else {}),
        }
    )


def _doubtful(found):
    return found.ground is not None and bool(found.ground.tips.doubts)


def _barriers(found):
    if found.barriers is None:
        return {}
    return {
        "barrier_mm": found.barriers / MM,
        "barrier_uJ": found.barrier_energies / UJ,
        "tip_angle_deg": found.tip_angles / DEG,
    }


def _dropped(tally):
    if tally is None:
        return {}
    return {"p_drop": tally.p, "p_drop_low": tally.low, "p_drop_high": tally.high}


def _answer(found, tally):
    """The recommended answer: the drop test where there is one, else the closed form; None for a card."""
    return found.recommended if tally is None else recommended.dropped(tally, found.stable)


def _recommended(known):
    if known is None:
        return {}
    return {"p_recommended": known.p, "p_recommended_low": known.low, "p_recommended_high": known.high}


def document(found, solid, tally=None):
    """All that is told of a part and its aspects.

    Parameters
    ----------
    found, solid, tally
        As in `aspects`.

    Returns
    -------
    dict
        That of `part`; ``recommended``, the rule of the columns ``p_recommended...``, None for a card;
        ``aspects``, the table.
    """
    known, table = _answer(found, tally), aspects(found, solid, tally)
    rule = None if known is None else known.rule
    return part(solid, found.warnings) | {"recommended": rule, "aspects": table}


def part(solid, warnings=()):
    """What every document says of its part.

    Parameters
    ----------
    solid : Part
    warnings : sequence of str
        Told since it was read.

    Returns
    -------
    dict
    """
    return {
        "part": solid.name,
        "units": solid.units,
        "material": solid.material,
        "density_g_cm3": _in(solid.density, G_CM3),
        "mass_g": solid.mass / GRAM,
        "volume_mm3": _in(solid.volume, MM3),
        "centre_of_mass_mm": np.asarray(solid.centre_of_mass) / MM,
        "inertia_g_mm2": np.asarray(solid.inertia) / G_MM2,
        "open_surface": solid.open_surface,
        "warnings": [*solid.warnings, *warnings],
    }


def conditions(solid):
    """What was assumed of a part, for ``run.json``.

    Parameters
    ----------
    solid : Part

    Returns
    -------
    dict
    """
    known = part(solid)
    names = ("units", "material", "density_g_cm3", "centre_of_mass_mm", "open_surface")
    return {name: known[name] for name in names}


def _in(value, unit):
    return None if value is None else value / unit
