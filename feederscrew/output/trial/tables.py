"""Files of ``feeder trial``: tables and documents in the units of the shop, pictures."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from feederscrew.arrivals.ensemble import wilson
from feederscrew.base.arrays import Floats, Ints
from feederscrew.base.columns import Cells, ColumnHead, Document, Frame, heads, of_arrays, share_head, values
from feederscrew.base.heavy import heavy
from feederscrew.base.units import MM, MM_S, PER_MINUTE
from feederscrew.designing.evidence import share_at_least
from feederscrew.output import offers as offer
from feederscrew.output import part_facts
from feederscrew.output.convey import restitution_entry
from feederscrew.output.offers import RecordView
from feederscrew.output.record_lines import trial_text
from feederscrew.sorting.orientations import ORIENTATION_TRIED_COLUMNS
from feederscrew.trials import course
from feederscrew.trials.course import LANDING_COLUMNS, Fate
from feederscrew.trials.fills import FILL_COLUMNS, FILL_COUNT_COLUMNS, FilledQueue
from feederscrew.trials.queue_counts import MAX_QUEUE_DEPTH_M, QUEUED_COLUMNS
from feederscrew.trials.result import OUTLET_COLUMNS, RUN_COLUMNS, RUN_DRIVE_COLUMNS, Outlet, TrialRun
from feederscrew.trials.trial import ENGINE, TRIAL_COLUMNS, TrialStudy

figures = heavy("feederscrew.output.trial.figures")
film = heavy("feederscrew.output.trial.film")

UM = 1e-3 * MM
ENGINE_FIGURES = ("penetration_mm", "energy_won_um")  # how closely the engine keeps to the laws: for -v
ROW_HEADS = heads(ORIENTATION_TRIED_COLUMNS)
ROW_HEADS |= {name: share_head(name) for name in ("share", "passed_low", "passed_high")}
ROW_HEADS |= {
    name: ColumnHead.of_name(name, unit)
    for unit, names in (
        ("mm", ("amplitude_mm", "margin_mm", "penetration_mm", "fell_mm")),
        ("um", ("energy_won_um",)),
        ("mm/s", ("velocity_mm_s",)),
    )
    for name in names
}
HIDDEN = ("fell_mm", "seconds", *ENGINE_FIGURES)


def offers(study: TrialStudy) -> list[offer.Offer]:
    """Offer the files of a trial.

    Parameters
    ----------
    study : TrialStudy

    Returns
    -------
    list of Offer
    """
    run = study.runs[0]
    files = [offer.table("trial.csv", frame, study), offer.table("trial_stations.csv", _stations, run)]
    if run.landing is not None:
        files.append(offer.table("trial_landing.csv", _landing_columns, study, run.landing))
    if (outlet := study.outlet(run)) is not None:
        files.append(offer.table("trial_outlet.csv", _outlet_table, outlet))
    return [*files, offer.document("trial.json", document, study), *pictures(study)]


def pictures(study: TrialStudy) -> list[offer.Offer]:
    """Offer the pictures of its first run: orientations in and out, paths, stills.

    Parameters
    ----------
    study : TrialStudy

    Returns
    -------
    list of Offer
    """
    run, over = study.runs[0], "Paths over each device, from above"
    stills = "A part that passes and one that does not"
    return [
        offer.picture("trial.png", "Orientations in and out", lambda ax=None: figures.matrix(run, ax)),
        offer.picture("trial_paths.png", over, lambda: figures.paths(run)),
        offer.picture("trial_stills.png", stills, lambda: film.stills(study.part, run)),
    ]


def document(study: TrialStudy) -> Document:
    """Return a trial as the JSON document: of the first amplitude, and of all where there are more.

    Parameters
    ----------
    study : TrialStudy

    Returns
    -------
    dict
    """
    entries = {
        **part_facts.part(study.part, study.warnings),
        **values(TRIAL_COLUMNS, study),
        **_run(study, study.runs[0]),
    }
    if len(study.runs) > 1:
        entries["highest_amplitude_mm"] = study.highest / MM
        entries["drives"] = [_run(study, run) for run in study.runs]
    return entries


def _run(study: TrialStudy, run: TrialRun) -> Document:
    fallen, landing, queue = run.landing, None, None
    if fallen is not None:  # what became of the parts that fell onto the track
        landing = values(LANDING_COLUMNS, fallen) | {
            "aspects": Frame.of(_landing_columns(study, fallen)),
            "leaves": dict(_leaving_counts(run, fallen.leaving_counts)),
        }
    if (queued := run.queue) is not None and (outlet := study.outlet(run)) is not None:
        whole, apart = int(queued.leaving_counts.sum()), outlet.distances.items()
        queue = values(QUEUED_COLUMNS, queued) | {
            "pressure_mn": queued.pressure * 1e3,
            "profile": {name: n / whole for name, n in _leaving_counts(run, queued.leaving_counts)},
            "outlet": _outlet_table(outlet),
            "apart": {name: {"deviation": d, "total_variation": total} for name, (d, total) in apart},
        }
    return {
        **values(RUN_DRIVE_COLUMNS, run),
        "point_restitution_doubt": restitution_entry(run.bowl, run.rebound),
        **values(RUN_COLUMNS, run),
        "engine": ENGINE,
        "sorts": bool(run.sorts),
        "part_seconds": float(run.course.seconds.sum()),
        "largest_penetration_mm": _most(run.course.depths) / MM,
        "energy_won_um": _most(run.course.gains) / UM,
        "wanted": _name(run, run.main_row),
        "stations": [station.device.kind for station in run.course.stations],
        "orientations": orientations(run),
        "matrix": run.matrix,
        "landing": landing,
        "queue": queue,
        "fill": None if run.filled is None else {"wanted": run.filled_wanted} | filled_entry(run.filled),
    }


def filled_entry(filled: FilledQueue) -> Document:
    """Return what a queue did at one fill as a dict: rate and purity of wanted parts, with their bounds.

    Parameters
    ----------
    filled : FilledQueue

    Returns
    -------
    dict
        Rates are None of one that was stopped. The purity has its one-sided lower bound (95 %).
    """
    rates: list[float | None] = [rate / PER_MINUTE for rate in (filled.rate, *filled.ends)]
    purity = filled.right / filled.left if filled.left else None
    shares: list[float | None] = [purity, share_at_least(filled.right, filled.left)]
    names = ("delivered_per_minute", "delivered_low", "delivered_high", "purity", "purity_low")
    figures = [None] * len(names) if filled.partial else [*rates, *shares]
    instead = (f"{pose.text}: {count} of {filled.left}" for pose, count in filled.left_instead)
    return {
        **values(FILL_COLUMNS, filled),
        **dict(zip(names, figures, strict=True)),
        **values(FILL_COUNT_COLUMNS, filled),
        "left_instead": ", ".join(instead),
        "partial": filled.partial,
    }


def queues_table(rows: Sequence[Mapping[str, Any]]) -> Frame:
    """Return rows of ``filled_entry`` as a table for people."""
    shares = {name: share_head(name) for name in ("purity", "purity_low")}
    names = ("delivered_per_minute", "delivered_low", "delivered_high")
    return Frame.of_rows(rows).headed(shares | {name: ColumnHead.of_name(name, "1/min") for name in names})


def orientations(run: TrialRun) -> list[Cells]:
    """Return one row an orientation tried, those that differ from the static rule first.

    Parameters
    ----------
    run : TrialRun

    Returns
    -------
    list of dict
    """
    margin, ends, counts, sent, rows = run.margin, run.ends, run.counts, run.course, []
    tried = np.flatnonzero(run.tried_counts).tolist()
    for k in sorted(tried, key=lambda k: (not run.is_odd[k], not run.differs[k], k)):
        orientation, own = run.orientations.lying[k], sent.entry_rows == k
        leaves = ", ".join(f"{_name(run, m)} {n}" for m, n in enumerate(run.matrix[k]) if n)
        rows.append(
            {
                **values(ORIENTATION_TRIED_COLUMNS, orientation),
                "share": float(run.shares[k]),
                "tried": int(run.tried_counts[k]),
                **{name: int(count) for name, count in zip(course.FATES, counts[k])},
                "passed_low": ends[k, 0],
                "passed_high": ends[k, 1],
                "leaves_as": leaves,  # 'A@0 9, other 1'
                "ended_at": _end_places(run, k),
                "predicted": "passes" if run.passes_by_rule[k] else "returned",
                "margin_mm": None if np.isnan(margin[k]) else float(margin[k]) / MM,
                "disagrees": bool(run.differs[k]),
                "penetration_mm": float(run.depths[k]) / MM,
                "energy_won_um": _most(sent.gains[own]) / UM,
                "velocity_mm_s": _mean(sent.velocities[own]) / MM_S,
                "seconds": _mean(sent.seconds[own]),
                "fell_mm": _mean(sent.end_places[own & (sent.fates == course.RETURNED)]) / MM,
            }
        )
    return rows


def spare(study: TrialStudy) -> tuple[Sequence[str], ...]:
    """Return groups of columns to leave out of a table that is too wide; fates of no part go first.

    Parameters
    ----------
    study : TrialStudy

    Returns
    -------
    tuple of sequences of str
    """
    counts = sum(run.counts.sum(axis=0) for run in study.runs)
    none = [fate.word for fate in Fate if not counts[fate] and fate is not Fate.PASSED]
    measures = (*ENGINE_FIGURES, "length_mm", "velocity_mm_s")
    return measures, none, ("passed_low", "passed_high"), ("predicted",), ("leaves_as",), ("share",)


def _leaving_counts(run: TrialRun, leaving: Ints) -> list[tuple[str | None, int]]:
    """Names of the orientations in which parts left, and how many in each; the last is none of the known."""
    return [(_name(run, k if k < len(leaving) - 1 else -1), int(n)) for k, n in enumerate(leaving) if n]


def _landing_columns(study: TrialStudy, landing: course.Landing) -> Cells:
    low, high = wilson(landing.landed_counts, landing.landed_counts.sum())
    shares = {"aspect": study.aspects.names, "landed": landing.landed_counts, "low": low, "high": high}
    return shares | dict(zip(course.FATES, landing.fates.T))


def _outlet_table(outlet: Outlet) -> Frame:
    own = of_arrays(OUTLET_COLUMNS, outlet)
    measured = {f"measured {column.name}": column.fractions for column in outlet.columns}
    return Frame.of(own | measured, own.heads | {name: share_head(name) for name in measured})


def frame(study: TrialStudy) -> Frame:
    """Return the rows of every amplitude as a table.

    Parameters
    ----------
    study : TrialStudy

    Returns
    -------
    Frame
    """
    rows = []
    for run in study.runs:
        lead = {"amplitude_mm": run.bowl.drive.amplitude / MM} if len(study.runs) > 1 else {}
        rows += [lead | row for row in orientations(run)]
    return Frame.of_rows(rows).headed(ROW_HEADS)


def _stations(run: TrialRun) -> Frame:
    sent, rows = run.course, []
    for place, station in enumerate(sent.stations):
        before, after = sent.orientations[place], sent.orientations[place + 1]
        for k in np.unique(before[before > -2]):
            came, head = before == k, (place, station.device.kind, _name(run, k))
            for m in np.unique(after[came & (after > -2)]):
                rows.append((*head, _name(run, m), int((came & (after == m)).sum())))
            for fate in range(course.RETURNED, len(course.FATES)):
                here = came & (sent.end_stations == place) & (sent.fates == fate)
                if here.any():
                    rows.append((*head, course.FATES[fate], int(here.sum())))
    return Frame.of_cells(("station", "device", "comes_as", "becomes", "parts"), rows)


def summary(study: TrialStudy) -> Iterator[str]:
    """Yield what is said beside the table, a sentence each.

    Parameters
    ----------
    study : TrialStudy

    Yields
    ------
    str
    """
    yield f"Orientation shares: {study.answer}"
    for run in study.runs:
        rolling = run.roll_back_velocity / MM_S
        rolling_words = f" (those that roll back {rolling:.4g} mm/s)" if np.isfinite(rolling) else ""
        moves = np.isfinite(run.velocity)
        speed = f"{run.velocity / MM_S:.4g} mm/s{rolling_words}" if moves else "no part moves on"
        yield (
            f"amplitude {run.bowl.drive.amplitude / MM:.4g} mm, throw number {run.throw_number:.3g}: "
            f"{speed}, {run.parts / PER_MINUTE:.4g} parts per minute, "
            f"efficiency {100.0 * run.efficiency:.4g} %, purity {100.0 * np.nan_to_num(run.purity):.4g} %"
        )
        if run.queue is None and run.jams:
            # which orientations stay, and where most of them do
            held = run.counts[:, [course.HANGING, course.STOPPED, course.STUCK]].sum(axis=1)
            rows = enumerate(zip(run.orientations.lying, held))
            staying = [f"{item.name} at {_end_places(run, k) or 'the track'}" for k, (item, n) in rows if n]
            parts = f"jams: {run.jams} of {run.tried_counts.sum()} parts stay at a device or hang"
            yield f"{parts} ({', '.join(staying)})"
        if run.landing is not None:
            fallen, along = run.landing, run.landing.leaving_counts[:-1]
            most = f", {along.max()} as {_name(run, int(np.argmax(along)))}" if along.any() else ""
            yield (
                f"of {fallen.parts} parts that fell onto the track (launch {fallen.launch}) {fallen.lost} "
                f"went over its edge, {fallen.leavers} left, {along.sum()} of them along the wall{most}"
            )
        if (queued := run.queue) is not None and (left := study.outlet(run)) is not None:
            how, force = "poured" if queued.is_poured else "in a row", 1e3 * queued.pressure.max(initial=0.0)
            deep = MAX_QUEUE_DEPTH_M / MM
            faults = f"{queued.overlaps} stood more than {deep:g} mm deep, which is no jam, "
            faults = faults if queued.overlaps else ""
            relieved = f" ({queued.relieved} backed up at a pressure break)" if queued.relieved else ""
            yield (
                f"queue of {queued.parts} {how}, {queued.on_track} on the track at a time: "
                f"{queued.delivered:.4g} delivered in the last {queued.counted_seconds:.4g} of "
                f"{queued.seconds:.4g} s, {queued.returned} returned{relieved}, {queued.jams} jams, "
                f"{faults}{queued.climbs} climbed on others; gap {queued.gap / MM:.3g} mm, "
                f"{100.0 * queued.touching:.3g} % pushed, "
                f"up to {force:.3g} mN on a part that stands at a device"
            )
            if run.filled is not None:
                yield f"{run.filled_wanted} {filled_text(run.filled)}"
            # what left by aspect beside each column that was measured
            if left.columns and not left.counts.any():
                yield "no part has left the queue yet: there is nothing to set beside what was measured"
                continue
            own = ", ".join(f"{name} {100.0 * share:.3g}" for name, share in zip(left.aspects, left.shares))
            for measured in left.columns:
                rms, total = left.distances[measured.name]
                shares = ", ".join(f"{100.0 * share:.3g}" for share in measured.fractions)
                yield (
                    f"at the outlet [%] {own} ({left.counts.sum()} parts, {left.other_count} on none); "
                    f"measured {measured.name} {shares}; deviation {rms:.3g}, total variation {total:.3g}"
                )
    if len(study.runs) > 1 and np.isfinite(study.highest):
        yield f"the tooling sorts up to an amplitude of {study.highest / MM:.4g} mm of those tried"


def filled_text(filled: FilledQueue) -> str:
    """Return what a queue did at one fill in a sentence.

    Parameters
    ----------
    filled : FilledQueue

    Returns
    -------
    str
    """
    low, high = (end / PER_MINUTE for end in filled.ends)
    shown = 100.0 * share_at_least(filled.right, filled.left)
    instead = ", ".join(f"{pose.text}: {count}" for pose, count in filled.left_instead[:3])
    return (
        f"at {filled.fill} fill: {filled.rate / PER_MINUTE:.4g} a minute (95 % interval {low:.4g} to "
        f"{high:.4g}); {filled.right} of {filled.left} left as wanted, lower bound (95 %, one-sided) "
        f"{shown:.4g} %{f'; what left instead: {instead}' if instead else ''}"
    )


def engine(study: TrialStudy) -> Iterator[str]:
    """Yield how closely each run of the engine kept to the laws, a sentence each: for those who check it.

    Parameters
    ----------
    study : TrialStudy

    Yields
    ------
    str
    """
    for run in study.runs:
        yield (
            f"in {run.course.seconds.sum():.4g} part-seconds the deepest penetration was "
            f"{_most(run.course.depths) / MM:.2g} mm, and the most energy that a part won would lift it by "
            f"{_most(run.course.gains) / UM:.2g} um"
        )


def _name(run: TrialRun, k: int | None) -> str | None:
    if k is None or k < 0 or k >= len(run.orientations.states):
        return None if k is None else "other"
    return run.orientations.states[k].name


def _end_places(run: TrialRun, k: int) -> str:
    """Where those ended that did not pass, with how many: 'gap 9'."""
    sent = run.course
    own = (sent.entry_rows == k) & ~np.isin(sent.fates, (course.PASSED, course.TURNED))
    places, counts = np.unique(sent.end_stations[own], return_counts=True)
    devices = [sent.stations[p].device for p in places]
    return ", ".join(f"{device.kind} {n}" for device, n in zip(devices, counts))


def _most(values: Floats) -> float:
    return float(values.max(initial=0.0))


def _mean(values: Floats) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if len(finite) else np.nan


TRIAL_VIEW = RecordView(trial_text, offers, "trial")
