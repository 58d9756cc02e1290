"""A bowl file with the devices of a design, which every command reads back."""

from feederscrew.bowl.devices import DEVICES_SECTION, check_written, value_text
from feederscrew.tooling.isolating.chain import in_mm

TRACK, WIDTH = "track", "track.width"


def bowl_file(study, settings):
    """Return a bowl file: what the user gave, and the devices that isolate the orientation asked for.

    Parameters
    ----------
    study : ToolingStudy
        Of one orientation.
    settings : sequence of Setting
        Of its bowl.

    Returns
    -------
    str
    """
    check_written(study.design.devices, "tooling.yaml")
    width = study.design.width
    given = [s for s in settings if s.given and s.key.field != DEVICES_SECTION]
    given = [s for s in given if width is None or s.key.name != WIDTH]
    lines = [*_head(study), *(f"{s.key.word}: {s.text}" for s in given if not s.key.section)]
    for section in dict.fromkeys(s.key.section for s in given if s.key.section):
        lines += [f"{section}:"]
        lines += [f"  {s.key.word}: {s.text}" for s in given if s.key.section == section]
        lines += [_wide(width)] if width is not None and section == TRACK else []
    if width is not None and not any(s.key.section == TRACK for s in given):
        lines += [f"{TRACK}:", _wide(width)]
    lines += [f"{DEVICES_SECTION}:  # along the track, in the order parts meet them"]
    lines += [f"  - {device.kind}: {value_text(device)}" for device in study.design.before]
    lines += [f"  - {cut.device.kind}: {value_text(cut.device)}{_mark(cut)}" for cut in study.design.cuts]
    return "\n".join(lines) + "\n"


def _wide(width):
    return f"  width: {in_mm(width)}  # as the design asks for"


def _mark(cut):
    """What is not certain of a device."""
    return "  # quasi-static, until a trial confirms it" if cut.device.turns else ""


def _head(study):
    one, found = study.orientations[study.wanted], study.design
    return [
        f"# Tooling that lets aspect {one.aspect} at heading {one.name.partition('@')[2]} deg leave.",
        f"# By the static rule: efficiency {'at least ' * (found.least < found.efficiency)}"
        f"{100.0 * found.least:.4g} %, purity {'at least ' * bool(found.purity_is_least)}"
        f"{100.0 * found.purity:.4g} %, by {study.answer}.",
        *_tried(study.trial_of(study.wanted)),
    ]


def _tried(trial):
    """What the trial said, the first thing to know of a design that it denies."""
    if trial is None:
        return ["# By the static rule, not tried: see feeder trial."]
    if trial.faults:
        return [f"# DENIED by its trial: {'; '.join(trial.faults)}."]
    return [f"# Of {trial.parts} parts tried {trial.figures}."]
