"""The bowl as a solid as a document."""

from feederscrew.solidbowl import segments
from feederscrew.solidbowl.segments import overhangs
from feederscrew.units import DEG, MM

NOT_EXACT = (
    "what runs along the track is ruled between cubic splines through its helices every 0.1 rad",
    "the fillet below the track is six ruled strips",
    "slanted edges of cuts are splines",
)
WALL = "the wall is no surface of revolution: it is ruled between splines through 16 places a quarter turn"


def document(solid):
    """Return what a bowl as a solid measures and weighs.

    Parameters
    ----------
    solid : BowlSolid

    Returns
    -------
    dict
    """
    plan, extent = solid.plan, solid.vertices.max(axis=0) - solid.vertices.min(axis=0)
    return {
        "diameter_mm": 2.0 * plan.way.radius / MM,
        "solid_volume_mm3": solid.volume / MM**3,
        "solid_mass_kg": solid.mass,
        "solid_inertia_kg_m2": solid.inertia,
        "solid_centre_of_mass_mm": list(solid.centre / MM),
        "balance_weight_kg": solid.balance[0],
        "balance_angle_deg": solid.balance[1] / DEG,
        "balance_radius_mm": solid.balanced_at / MM,
        "solid_extent_mm": list(extent / MM),
        "solid_facets": len(solid.faces),
        "material": plan.material.name,
        "shape": "cylinder" if plan.stairs is None else plan.stairs.shape,
        "falls_to": solid.falls,
        "hand": "left" if plan.left else "right",
        "wall_mm": plan.material.wall / MM,
        "floor_mm": plan.material.floor / MM,
        "track_plate_mm": plan.material.plate / MM,
        "wall_height_mm": plan.top / MM,
        "dome_rise_mm": plan.dome / MM,
        "solid_turns": plan.turns,
        "outlet_height_mm": plan.outlet_height / MM,
        "outlet_angle_deg": plan.turned / DEG,
        "bolts": plan.bolts,
        "bolt_hole_mm": plan.bolt / MM,
        "bolt_circle_mm": plan.bolt_circle / MM,
        "chord_mm": plan.chord / MM,
        "separate_parts": [name for name, _, _ in solid.gates],
        "overhangs_mm2": {name: area / MM**2 for name, area in overhangs(solid).items()},
        **({} if solid.segments is None else _segments(solid.segments)),
        **({} if solid.step is None else {"step": _step(solid)}),
    }


def _step(solid):
    """What the STEP file was found to be when it was opened again."""
    found, leans = solid.step, solid.plan.stairs is not None
    return {
        "volume_mm3": found.volume / MM**3,
        "faces": found.faces,
        "track_off_mm": found.off / MM,
        "not_exact": [*NOT_EXACT, *([WALL] if leans else [])],
    }


def _segments(cut):
    return {
        "segments": [
            {"name": one.name, "size_mm": [x / MM for x in one.size], "volume_mm3": one.volume / MM**3}
            for one in cut.pieces
        ],
        "dowels": cut.dowels,
        "dowel_mm": cut.dowel / MM,
        "dowel_length_mm": cut.dowel_length / MM,
        "screws": len(cut.screws),
        "screw": segments.SCREW_NAME if len(cut.screws) else None,
        "seam_ends": cut.ends[1],
        "seam_ends_without_screw": cut.ends[0],
        "seams_deg": cut.turned / DEG,
    }
