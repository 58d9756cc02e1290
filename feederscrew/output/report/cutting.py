"""What the bowl's devices do with each orientation of the part."""

from feederscrew.bowl.devices import KINDS
from feederscrew.output.page.blocks import Picture, Section, Table, Text, Views
from feederscrew.output.report.scene import over_cuts
from feederscrew.output.tooling import files, relief, tables


def tooling(case):
    """Where each orientation passes or falls; None in a bowl without devices."""
    study = case.passages
    if study is None:
        return None
    lead = Text(
        "Each orientation at each device that it meets, until one returns it; the margin is by how much it "
        "passes or fails. Verdicts are quasi-static: they hold while the part slides without hopping."
    )
    drawn = files.chain_picture(study.devices, study.orientations, study.shares)
    picture = Picture(drawn.name, drawn.make(), drawn.alt)
    return Section((lead, *_turning(study), *_views(study), Table(tables.passages(study)), picture))


def _turning(study):
    """What is not certain of the devices."""
    kinds = [device.kind for device in study.devices if KINDS[device.kind].turns]
    if kinds:
        yield Text(
            f"Where parts land that {' and '.join(dict.fromkeys(kinds))} turn over is quasi-static, until a "
            "trial confirms it."
        )


def _views(study):
    """The part over the track, to be turned: the most frequent that leaves, and the nearest that falls."""
    given = study.devices, study.orientations, study.shares, study.wanted
    shown = relief.poses(*given)
    if not shown:
        return
    part = study.orientations[0].posture.solid
    scene = over_cuts(part, [met for met, _ in shown], study.orientations)
    yield Views(scene, tuple((met.orientation.name, told, ()) for met, told in shown), "cuts", "Orientation")
    offered = files.solid_picture(*given)
    yield Picture(offered.name, offered.make(), offered.alt, printed=True)
