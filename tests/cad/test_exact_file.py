"""The bowl as STEP: opened again it is the bowl of the facets, its track nearer to the formula."""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from solids import CONICAL, TRACK, built

from feederscrew import bowl as bowls
from feederscrew import part as parts
from feederscrew.base.errors import FeederError
from feederscrew.cad import section as printed
from feederscrew.cad.exact import exact_body, exact_file
from feederscrew.cad.exact.exact_file import step_file
from feederscrew.cad.plan import SolidOptions
from feederscrew.resting.aspects import find
from feederscrew.sorting import solid
from feederscrew.sorting.orientations import orientations
from feederscrew.sorting.tooled_track import lay_out

PART = Path(__file__).parents[2] / "parts" / "lbracket_30x20x15.stl"
BANKED, STEEP = replace(TRACK, bank=np.radians(6.0)), replace(TRACK, climb=np.radians(6.24), width=29.1e-3)
TURNED = SolidOptions(left=True, outlet_angle=0.5)


def test_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "OCP.STEPControl", None)
    with pytest.raises(FeederError, match=r"^step: needs OpenCASCADE, which is not installed - pip install"):
        exact_body.check()


@pytest.mark.long
@pytest.mark.needs("OCP")
@pytest.mark.parametrize(
    ("chain", "track", "asked", "turns", "near", "faces"),
    [
        ("narrowed and rails", BANKED, TURNED, 0.6, 1e-3, {"cylinders": 10, "ruled": 20}),
        # lost wall and floor where edges had to meet exactly
        ("none", STEEP, CONICAL, 0.9, 1.5e-3, {"ruled": 40}),
    ],
)
def test_what_is_opened_again_is_the_bowl(chain, track, asked, turns, near, faces):
    facetted = built(chain, track, asked, turns=turns)
    file = step_file(facetted)
    assert file.volume == pytest.approx(facetted.volume, rel=near)
    assert file.volume > facetted.volume  # chords lie within an arc, and there is more outside than inside
    assert file.off < 1e-7 and file.faces["cones"] == 2
    assert all(file.faces[name] >= least for name, least in faces.items())
    assert file.data.startswith(b"ISO-10303-21;") and b"'bowl'" in file.data
    if chain != "none":
        assert step_file(facetted).data == file.data


def section_of(tmp_path, *devices):
    lines = "".join(f"  - {device}\n" for device in devices)
    (tmp_path / "bowl.yaml").write_text(f"track: {{width: 30 mm}}\ndevices:\n{lines}")
    part, bowl = parts.load(PART), bowls.read(tmp_path / "bowl.yaml")
    return lay_out(bowl.track, bowl.devices, orientations(part, find(part), bowl.track))


@pytest.mark.needs("OCP")
def test_a_narrowed_track_has_the_volume_of_its_annular_sectors(tmp_path):
    """Closed form: sectors of the plate, of what is cut away, and of the wall over it."""
    section = section_of(tmp_path, "narrowed_track: 16 mm")
    radius, length, wall, overlap = section.track.radius, section.length, solid.WALL, solid.WALL_OVERLAP_M

    def sector(inner, outer, along):
        return 0.5 * ((radius - outer) ** 2 - (radius - inner) ** 2) * along / radius

    begin, end = section.devices[0].span  # where it is cut, without the way about it
    plate = sector(0.03, -wall, length) - sector(0.03, 0.016, end - begin)
    upright = sector(0.0, overlap - wall, length) * (section.tallest + printed.WALL_MARGIN_M)
    body = printed.section_body(section, exact_body)
    assert exact_body.volume(body) == pytest.approx((plate * solid.PLATE + upright) * 1e9, rel=1e-6)
    assert set(exact_body.kinds(body)) == {"planes", "cylinders", "cones", "ruled"}  # and no others
    # A step, a gate and a groove are one body in the axes of the facets.
    section = section_of(tmp_path, "step: 4 mm", "pressure_break: 20 mm", "groove: {angle: 30 deg}")
    data = exact_file.section_file(section)  # it compares the volume with that of the facets
    assert data.startswith(b"ISO-10303-21;") and b"'track section'" in data
    assert data == exact_file.section_file(section)
    body = exact_file.exact_section(section)
    vertices, _ = printed.solid(section)
    highest = 1e3 * vertices[np.argmax(vertices[:, 2])]
    assert exact_body.below(body, highest + [0.0, 0.0, 6.0]) == pytest.approx(highest[2], abs=0.02)


@pytest.mark.needs("OCP")
def test_a_bare_track_and_the_wall_of_its_section_are_one_body(tmp_path):
    """The plate was lost: the annular sectors of wall and plate by hand, their common part once.

    The plate goes 1 mm further out than the wall of 2 mm, and the wall begins at the middle of the plate.
    """
    tooled = section_of(tmp_path, "height bar: 20 mm")
    plan, radius, width = printed.section_plan(tooled), tooled.track.radius, tooled.width
    tooled = replace(tooled, devices=())
    body = exact_file.exact_section(tooled)

    def sector(inner, outer, high):
        return 0.5 * (outer**2 - inner**2) * high * tooled.length / radius

    wall, plate = plan.material.wall, plan.material.plate
    assert tooled.track.bank == 0.0
    expected = sector(radius - width, radius + 3e-3, plate)
    expected += sector(radius, radius + wall, plan.top)
    assert exact_body.volume(body) * 1e-9 == pytest.approx(expected, rel=1e-6)
