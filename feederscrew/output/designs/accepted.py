"""A filled-in acceptance sheet as a table: what agrees with what was computed."""

from feederscrew.output import tables

WORDS = {True: "agrees", False: "does not", None: "not measured"}


def summary(lines):
    """Return one row a line of the sheet."""
    rows = [
        {
            "quantity": one.quantity,
            "fill": one.fill,
            "computed": f"{one.computed:.4g}",
            "from": f"{one.ends[0]:.4g}",
            "to": f"{one.ends[1]:.4g}",
            "measured": "" if one.measured is None else f"{one.measured:.4g}",
            "unit": one.unit,
            "verdict": WORDS[one.agrees],
        }
        for one in lines
    ]
    return tables.frame({name: [row[name] for row in rows] for name in rows[0]})


def document(lines):
    """Return the sheet as the JSON document."""
    listed = [one.agrees for one in lines if one.agrees is not None]
    return {
        "accepted": all(listed),
        "measured": len(listed),
        "lines": [
            {
                "quantity": one.quantity,
                "fill": one.fill,
                "unit": one.unit,
                "computed": one.computed,
                "low": one.ends[0],
                "high": one.ends[1] if one.ends[1] < float("inf") else None,
                "measured": one.measured,
                "sample": one.sample,
                "agrees": one.agrees,
            }
            for one in lines
        ],
    }
