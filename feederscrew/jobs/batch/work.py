"""The whole pipeline for one part, from the bytes of its file to the bytes of its results."""

import functools
import gc
import io
from collections.abc import Iterable

import numpy as np

from feederscrew.arrivals.aspects_study import AspectsStudy, with_drops
from feederscrew.arrivals.drop import drop
from feederscrew.arrivals.entry import Shares, shares
from feederscrew.base.columns import Cells, Document
from feederscrew.base.errors import FeederError
from feederscrew.base.signatures import Keywords
from feederscrew.base.units import GRAM
from feederscrew.feeding import well_oriented
from feederscrew.feeding.rate import rate
from feederscrew.jobs.batch.task import DONE, THUMBNAIL, Conditions, Outcome, Task
from feederscrew.motion.convey import convey
from feederscrew.output import aspects, batch, offers, part_facts, proof, tables
from feederscrew.output import convey as convey_output
from feederscrew.output import drop as drop_output
from feederscrew.output import rate as rate_output
from feederscrew.part import Part, load
from feederscrew.resting.aspects import Aspects, find
from feederscrew.resting.rules.recommended import launch_of_name

SEED_DIGITS = 8  # hexadecimal, of the file's sha256


class Files(dict):
    """Results by name, as a folder would take them."""

    def __init__(self) -> None:
        super().__init__()
        self.left_out: list[str] = []

    def write(self, name: str, content: str | bytes) -> None:
        """Keep one file, text or bytes."""
        self[name] = tables.file_bytes(content)


def work(task: Task) -> Outcome:
    """Compute everything that is asked of one part: the same bytes wherever it is computed.

    A part that cannot be used gives a reason, never a fault.
    """
    try:
        return _results(task)
    except FeederError as fault:
        return Outcome.failed(task, "; ".join(fault.lines))
    except Exception as bug:  # noqa: BLE001 - our bug on one part must not stop the others
        return Outcome.failed(task, f"unexpected {type(bug).__name__}: {bug} - please report it")
    finally:
        gc.collect()  # figures hold themselves: a process would grow with every part


def _results(task: Task) -> Outcome:
    request, choices, files = task.request, task.choices, Files()
    options: Keywords = dict(request.options)
    part = load(request.source, **options, names=request.names, stdin=io.BytesIO(task.data))
    if choices.drops and part.vertices is not None:
        # its random numbers hang on the part's file alone; its answer is then the recommended one
        drops, seed = find(part, launch=choices.launched), int(task.sha256[:SEED_DIGITS], 16)
        dropped = drop(part, choices.launched, drops=choices.drops, seed=seed, aspects=drops)
        offers.write(files, drop_output.offers(dropped), pictures=choices.pictures)
        tally = dropped.result.tally
        first = int(np.argmax(tally.p))
        tested = {"drops": choices.drops, "drop_aspect": drops.names[first], "p_drop": tally.p[first]}
        study = with_drops(drops, dropped, launch_of_name(choices.launched))
    else:  # that of ``feeder rate`` for the same part and bowl
        bowl, tested = request.conditions.bowl, {}
        fed_shares = shares(part, bowl, launch=choices.launch, rule=choices.rule, jobs=1)
        study = AspectsStudy(part, fed_shares.aspects)
    results = study.aspects
    offers.write(files, aspects.offers(study), pictures=choices.pictures)
    conveying = travel(request.conditions)
    files.write("convey.json", tables.json_text(conveying))
    rated, rate_warnings = _rate(part, results, task, files)
    own: Cells = {"config": request.conditions.name, "material": part.material}
    own |= {"mass_g": part.mass / GRAM, "aspects": int(results.stable.sum())}
    own |= {name: conveying[name] for name in ("velocity_mm_s", "regime")}
    row = own | rated | tested
    if choices.pictures and part.vertices is not None:
        files.write(THUMBNAIL, batch.thumbnail(part, results, row.get("aspect")))
    effective = part_facts.conditions(part) | dict(request.conditions.texts)
    effective |= {"rule": choices.rule, "drops": choices.drops, "launch": choices.launch or "fed"}
    effective |= {"names": request.names.source} if request.names else {}
    warnings = (*part.warnings, *request.conditions.warnings, *results.warnings, *rate_warnings)
    return Outcome(
        name=request.name,
        key=task.key,
        source=request.source,
        sha256=task.sha256,
        status=DONE,
        row=row,
        effective=effective,
        warnings=tuple(dict.fromkeys(warnings)),
        files=dict(files),  # who takes it need not import this module
    )


@functools.lru_cache(maxsize=64)
def travel(conditions: Conditions) -> Document:
    """Return the document of ``convey.json``: the same for every part, a point mass."""
    well_oriented.velocity(conditions.bowl)  # raises where there is no steady state
    return convey_output.document(convey(conditions.bowl))


def _rate(part: Part, aspects: Aspects, task: Task, files: Files) -> tuple[Cells, Iterable[str]]:
    """Rate the aspect wanted, else the orientation that leaves most often; what ``feeder rate`` warns of."""
    conditions, rule = task.request.conditions, task.choices.rule
    tried = conditions.tried, part, conditions.bowl  # what the bowl file says of its trial
    if part.vertices is None:
        return {"note": "a part card has no outline: no rate"}, proof.warnings(*tried)
    study = rate(part, conditions.bowl, task.request.aspect, rule=rule, aspect_shares=Shares(aspects))
    path = study.rate.orientations.lying[study.rate.row].name
    leaves_as = well_oriented.fed(study.rate.orientations, study.rate.row).name
    document = proof.with_trial(rate_output.document(study), *tried, leaves_as)
    offers.write(files, rate_output.offers(study))
    wanted = ("aspect", "heading_deg", "pitch_mm", "p_orientation", "passes_devices")
    rates = ("parts_per_minute", "parts_per_minute_low", "parts_per_minute_high")
    named = {"orientation": path, "rule": rule, "answer": study.answer}
    remarks = rate_output.remarks(study)
    why = "; ".join(remarks) if document["parts_per_minute"] <= 0.0 else ""
    noted = {"note": why} if why else {}
    warnings = (*study.warnings, *remarks, *proof.warnings(*tried, leaves_as))
    return named | noted | {name: document[name] for name in (*wanted, *rates)}, warnings
