"""STEP: faces that the kernel meshes on the wrong side of their edges are named; names and references."""

import math
from pathlib import Path

import numpy as np
import pytest
import step_files
from readings import loaded, mm3, refused

from feederscrew.base.errors import MeshError
from feederscrew.part.cad_faces import refuse_wrong_sides
from feederscrew.part.formats import CadFaces, Soup
from feederscrew.part.gate import Crossings

QUARTER_RING = (Path(__file__).parents[1] / "data/step/quarter_ring.step").read_bytes()
RING_LOOP = b"#18 = FACE_BOUND('',#19,.T.);"  # of its torus


def cap(radius, floor, unit="mm", **turned):
    file = step_files.StepFile(unit)
    file.product("cap", [file.cap(radius, floor, **turned)])
    return file.data


@pytest.mark.parametrize("unit", ["mm", "in"])
@pytest.mark.parametrize("floor", [0.3, -0.3])
def test_caps_of_a_ball_have_the_volume_of_the_formula(floor, unit):
    part = loaded(cap(1.0, floor, unit))
    height = 1.0 - floor
    volume = math.pi * height**2 * (3.0 - height) / 3.0 * {"mm": 1.0, "in": 25.4**3}[unit]
    assert mm3(part) == pytest.approx(volume, rel=0.03)  # facets of 0.01 mm, or 0.1 rad
    assert not [warning for warning in part.warnings if "face" in warning]


def test_a_face_that_the_kernel_turns_in_its_place_is_named():
    turned = [line for line in loaded(cap(10.0, 3.0, bound="F")).warnings if "the other way" in line]
    assert len(turned) == 1 and turned[0].startswith("face 1 of 2, a sphere of radius 10 mm, faces")


def test_a_quarter_of_a_ring_is_read():
    # a half round of radius 3 mm through 90 degrees about 10 mm: pi^2 R r^2 / 4
    assert mm3(loaded(QUARTER_RING)) == pytest.approx(math.pi**2 * 10.0 * 9.0 / 4.0, rel=2e-3)


def test_a_face_that_leaves_the_box_of_all_edges_is_refused_by_name():
    assert RING_LOOP in QUARTER_RING
    text = refused(QUARTER_RING.replace(RING_LOOP, RING_LOOP.replace(b".T.", b".F.")), allow_open=True)
    assert text.startswith("face 1 of 4, a torus of radius 3 mm, is meshed on the wrong side: ")


def assembly(*files, shape=False):
    file = step_files.StepFile()
    whole, kind = file.product("assembly"), file.add("DOCUMENT_TYPE('geometry')")
    for name in files:
        part = file.product(name.split(".")[0])
        file.place(whole, part, (0, 0, 0))
        document = file.add(f"DOCUMENT_FILE('{name}','','',{kind},'',$)")
        file.add(f"APPLIED_DOCUMENT_REFERENCE({document},'',({part[0]}))")
    if shape:
        file.place(
            whole, file.product("plate", [file.prism([(0, 0), (10, 0), (10, 5), (0, 5)], 3)]), (0, 0, 0)
        )
    return file.data


def test_files_that_an_assembly_refers_to_are_named():
    text = refused(assembly("gear.stp", "Shaft 2.STEP"))
    assert text == (
        "has no shape of its own, it refers to 'gear.stp' and 'Shaft 2.STEP' - give one of those files, or "
        "export the assembly as one file"
    )
    part = loaded(assembly("gear.stp", shape=True))
    assert mm3(part) == pytest.approx(150.0) and part.warnings == ("refers to 'gear.stp': left out",)


def test_bodies_of_a_step_file_have_the_names_of_their_products():
    file = step_files.StepFile()
    whole, square = file.product("assembly"), [(0, 0), (10, 0), (10, 5), (0, 5)]
    for k, (name, height) in enumerate({"gear": 3, "shaft": 8}.items()):
        file.place(whole, file.product(name, [file.prism(square, height)]), (20 * k, 0, 0), f"use {k}")
    assert mm3(loaded(file.data, body="shaft")) == pytest.approx(400.0)


def test_many_cuts_are_refused_with_the_face_that_most_are_on():
    x = np.arange(40.0)
    corners = np.stack([np.column_stack([x, 0 * x, 0 * x + z]) for z in (0.0, 0.1, 0.2)], axis=1)
    corners[:, 1, 1] = 1.0
    soup = Soup(
        corners.reshape(-1, 3), np.arange(120).reshape(-1, 3), "step", "mm",
        cad_faces=CadFaces(np.arange(40) // 20, ("face 1", "face 2"), np.zeros(2), *np.zeros((2, 2), bool)),
    )  # fmt: skip

    def check(count, allow_open=False):
        cuts = Crossings(np.zeros((count, 2), int), np.ones(count), corners[40 - count :].mean(axis=1))
        return refuse_wrong_sides(soup, cuts, "part.step", "mm", allow_open)

    with pytest.raises(MeshError, match="1 pair of facets cut each other, most of them on face 2 -"):
        check(1)
    assert check(0) == () and check(1, allow_open=True) == ()
