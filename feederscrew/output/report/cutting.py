"""What the bowl's devices do with each orientation of the part."""

from feederscrew.output.page.blocks import Picture, Section, Table, Text
from feederscrew.output.tooling import files, tables


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
    return Section((lead, Table(tables.passages(study)), picture))
