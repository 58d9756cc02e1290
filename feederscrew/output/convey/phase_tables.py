"""The best phase of an elliptical drive as tables and documents."""

import numpy as np

from feederscrew.output import tables
from feederscrew.output.convey.tables import between, number
from feederscrew.units import MM_S


def document(found):
    """Return a BestPhase for the JSON document."""
    over = zip(found.frictions, found.best_over_friction, found.straight_over_friction)
    return {
        "phase_deg": float(np.degrees(found.phase)),
        "velocity_mm_s": found.velocity / MM_S,
        "straight_mm_s": found.straight / MM_S,
        "gain": found.velocity / found.straight if found.straight > 0.0 else np.nan,
        "nine_tenths_from_deg": float(np.degrees(found.lowest)),
        "nine_tenths_to_deg": float(np.degrees(found.highest)),
        "over_friction": [
            {"friction": share, "velocity_mm_s": best / MM_S, "straight_mm_s": straight / MM_S}
            for share, best, straight in over
        ],
    }


def summary(best):
    """Return the best phase as a frame for people; ``best`` is of ``document``."""
    low, high = best["nine_tenths_from_deg"], best["nine_tenths_to_deg"]
    rows = [
        ("best drive.phase [deg]", number(best["phase_deg"])),
        ("velocity there [mm/s]", number(best["velocity_mm_s"])),
        ("velocity of a straight drive [mm/s]", number(best["straight_mm_s"])),
        ("times as fast", number(best["gain"])),
        ("nine tenths of it at phases [deg]", between(low, high)),
        *(
            (
                f"at {row['friction']:g} times the friction, best / straight [mm/s]",
                f"{number(row['velocity_mm_s'])} / {number(row['straight_mm_s'])}",
            )
            for row in best["over_friction"]
        ),
    ]
    return tables.frame(dict(zip(("quantity", "value"), zip(*rows))))
