"""Tables of ``feeder compare --bowl``: what explains measured velocities, and what remains of each."""

from typing import Any

import numpy as np

from feederscrew.output import offers as offer
from feederscrew.output import tables
from feederscrew.output.tables import Frame
from feederscrew.studies.bowl_fit import QUANTITIES, BowlFit
from feederscrew.units import MM_S

UNDECIDED = "not decided by these velocities"


def quantities(study: BowlFit) -> Frame:
    """Return friction, restitution and stroke that explain the velocities, one a row."""
    return tables.frame(
        {
            "quantity": list(QUANTITIES),
            "bowl_file": study.assumed.tolist(),
            "fitted": study.values.tolist(),
            "low": study.low.tolist(),
            "high": study.high.tolist(),
            "decided": [UNDECIDED if open_end else "yes" for open_end in study.open_ended],
        }
    )


def velocities(study: BowlFit) -> Frame:
    """Return each measured velocity, ours beside it, and what remains."""
    return tables.frame(
        {
            "setting": [setting or "as the bowl file" for setting in study.settings],
            "measured_mm_s": (study.measured / MM_S).tolist(),
            "doubt_mm_s": (study.doubt / MM_S).tolist(),
            "bowl_file_mm_s": (study.file / MM_S).tolist(),
            "fitted_mm_s": (study.fitted / MM_S).tolist(),
            "remains_mm_s": ((study.measured - study.fitted) / MM_S).tolist(),
        }
    )


def remark(study: BowlFit) -> str:
    """Return whether the fit explains the velocities."""
    before, after = (
        float(np.sqrt(np.mean((velocities_of - study.measured) ** 2))) / MM_S
        for velocities_of in (study.file, study.fitted)
    )
    text = (
        f"remains {after:.3g} mm/s in the root of the mean square, {before:.3g} by the bowl file as it stands"
    )
    if study.misfit > 2.0:
        text += "; more than the velocities' errors: a point on this track does not explain them"
    return text


def document(study: BowlFit) -> dict[str, Any]:
    """Return the study as the JSON document."""
    return {
        "quantities": quantities(study).rows(),
        "velocities": velocities(study).rows(),
        "misfit": None if np.isnan(study.misfit) else study.misfit,
        "remark": remark(study),
    }


def offers(study: BowlFit) -> list[offer.Offer]:
    """Return its files."""
    return [
        offer.table("bowl_fit.csv", quantities, study),
        offer.table("velocities.csv", velocities, study),
    ]
