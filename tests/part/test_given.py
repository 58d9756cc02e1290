"""Parts from memory: meshes, corners with facets, and solids of CAD libraries."""

import sys
from types import ModuleType

import numpy as np
import pytest
import trimesh
from command_lines import PARTS

import feederscrew as fs

BOX = trimesh.creation.box((0.012, 0.008, 0.003))  # [m]


def test_a_mesh_is_in_metres_unless_it_says_another_unit():
    part = fs.load(BOX, density=1000.0)
    assert part.volume * 1e9 == pytest.approx(288.0) and part.mass == pytest.approx(288e-6)
    assert (part.name, part.units, part.warnings) == ("part", "m", ())
    assert fs.load((BOX.vertices, BOX.faces)).volume == pytest.approx(part.volume)
    assert fs.load((BOX.vertices.tolist(), BOX.faces.tolist()), units="cm").volume == pytest.approx(288e-15)
    stated = trimesh.Trimesh(BOX.vertices * 1e3, BOX.faces)
    (warning,) = fs.load(stated).warnings  # 12 m
    assert "pass `units` mm" in warning
    stated.units = "millimeters"
    assert fs.load(stated).volume == pytest.approx(part.volume)
    assert fs.load(stated, units="cm").volume == pytest.approx(1e3 * part.volume)
    stated.metadata["name"] = "lid.stl"
    assert fs.load(stated).name == "lid"


def test_a_mesh_from_memory_is_the_part_of_its_file(tmp_path):
    """Same aspects and numbers; the hash is of the mesh, as there is no file."""
    of_file = fs.load(PARTS / "lbracket_30x20x15.stl")
    again = fs.load(of_file.mesh)
    found, other = fs.find_aspects(of_file), fs.find_aspects(again)
    assert other.names == found.names and other.heights == pytest.approx(found.heights)
    assert again.mass == pytest.approx(of_file.mass, rel=1e-12)
    assert again.sha256 != of_file.sha256 and again.sha256 == fs.load(of_file.mesh).sha256
    assert set(fs.rate(again, fs.read_bowl(), "A", rule="csa").save(tmp_path).glob("*.csv"))


WRONG = {
    "one": ((BOX.vertices,), "source: has 1 entries"),
    "flat": ((BOX.vertices[:, :2], BOX.faces), r"vertices have the shape \(8, 2\)"),
    "empty": ((BOX.vertices, np.empty((0, 3), int)), r"faces have the shape \(0, 3\)"),
    "far": ((BOX.vertices, BOX.faces + 1), "faces are not indices"),
    "floats": ((BOX.vertices, BOX.faces / 2.0), "faces are not indices"),
    "words": ((["a", "b"], BOX.faces), "corners that are not numbers"),
    "open": ((BOX.vertices, BOX.faces[1:]), "part: "),
    "endless": ((BOX.vertices * np.inf, BOX.faces), "part: "),
    "number": (3, "source: is 3 - give the path of a file, a mesh"),
}


@pytest.mark.filterwarnings("ignore:invalid value")
@pytest.mark.parametrize("source, line", WRONG.values(), ids=WRONG)
def test_what_is_no_mesh_is_a_line(source, line):
    with pytest.raises(fs.FeederError, match=line):
        fs.load(source)


def cad_library(name, written):
    """A module that writes a part as STL, in the two ways of the two libraries."""
    library = ModuleType(name)
    library.Solid = type("Solid", (), {"__module__": f"{name}.topology", "label": "cap"})
    if name == "build123d":
        library.export_stl = lambda solid, path, tolerance, angular_tolerance: written(path)
    else:
        library.exporters = ModuleType(f"{name}.exporters")
        library.exporters.export = lambda solid, path, tolerance, angularTolerance: written(path)
    return library


@pytest.mark.parametrize("name", ["build123d", "cadquery"])
def test_a_solid_of_a_cad_library_is_taken_by_its_stl_in_mm(monkeypatch, name):
    def write(path):
        trimesh.Trimesh(BOX.vertices * 1e3, BOX.faces).export(path)

    library = cad_library(name, write)
    monkeypatch.setitem(sys.modules, name, library)
    part = fs.load(library.Solid())
    assert (part.name, part.units) == ("cap", "mm") and part.volume * 1e9 == pytest.approx(288.0)
    monkeypatch.setitem(sys.modules, name, cad_library(name, lambda path: None))
    with pytest.raises(fs.FeederError, match=f"{name} has written nothing of it - give a solid"):
        fs.load(library.Solid())


def test_a_part_is_shown_on_a_page_of_its_own(monkeypatch):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    shown = fs.load(BOX).show()
    assert opened == [shown.path.as_uri()] and shown.path.read_text() == shown.page
    assert "THREE" in shown.page and shown.page.count('class="view"') == 3
    assert "&lt;canvas" in shown._repr_html_() and "<canvas" not in shown._repr_html_()
    monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    fs.load(BOX).show()  # the notebook shows it
    assert len(opened) == 1
    with pytest.raises(fs.MeshError, match="has no shape"):
        fs.load(PARTS / "magnet.yaml").show()
