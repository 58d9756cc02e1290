"""3MF projects by their meaning: parts, supports, modifiers, negative and unprintable parts, and bombs."""

import io
import zipfile

import numpy as np
import part_files as files
import pytest
from test_bodies import refused
from test_formats import loaded, mm3

from feederscrew.part import formats, threemf, topology

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
    'Target="/{}" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
BLOCK = files.box((10.0, 6.0, 4.0))
PIN = files.box((2.0, 2.0, 6.0), (4.0, 2.0, -1.0))  # through the block
SETTINGS, PRUSA = "Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config"


def mesh(*bodies):
    """The mesh element of triangles, each body's corners its own."""
    corners, faces, count = [], [], 0
    for triangles in bodies:
        vertices, own = topology.weld_corners(
            triangles.reshape(-1, 3), np.arange(len(triangles) * 3).reshape(-1, 3)
        )
        corners += vertices.tolist()
        faces += (own + count).tolist()
        count += len(vertices)
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in corners)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"


def thing(number, content, kind="model", more=""):
    """An object of a mesh, or of components where ``content`` is a tuple of object numbers."""
    if isinstance(content, tuple):
        inner = "".join(f'<component objectid="{one}"/>' for one in content)
        content = f"<components>{inner}</components>"
    return f'<object id="{number}" type="{kind}" {more}>{content}</object>'


def model(objects, items, head=""):
    """A model file."""
    built = "".join(f"<item {item}/>" for item in items)
    return (
        f'<?xml version="1.0"?>{head}<model unit="millimeter" xmlns="{CORE}" xmlns:p="{PRODUCTION}">'
        f"<resources>{''.join(objects)}</resources><build>{built}</build></model>"
    )


def package(root, name="3D/3dmodel.model", **others):
    """A 3MF of a model and other files."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", RELATIONS.format(name))
        archive.writestr(name, root)
        for path, text in others.items():
            archive.writestr(path, text)
    return file.getvalue()


def bambu(*subtypes):
    """What Bambu Studio says of the parts of object 3."""
    parts = "".join(
        f'<part id="{k}" subtype="{kind}"><metadata key="name" value="{kind} {k}"/></part>'
        for k, kind in enumerate(subtypes, 1)
    )
    return {SETTINGS: f'<?xml version="1.0"?><config><object id="3">{parts}</object></config>'}


BOTH = [thing(1, mesh(BLOCK)), thing(2, mesh(PIN)), thing(3, (1, 2))]


@pytest.mark.parametrize(
    ("subtype", "volume", "word"),
    [
        ("negative_part", 240.0 - 16.0, "negative part: subtracted"),
        ("modifier_part", 240.0, "modifier"),
        ("support_enforcer", 240.0, "support"),
        ("support_blocker", 240.0, "support"),
    ],
)
def test_parts_of_a_slicer_by_their_meaning(subtype, volume, word):
    part = loaded(package(model(BOTH, ['objectid="3"']), **bambu("normal_part", subtype)))
    assert mm3(part) == pytest.approx(volume, rel=1e-9)
    assert len(part.warnings) == 1 and word in part.warnings[0]


@pytest.mark.parametrize(
    ("kind", "volume", "word"),
    [
        ("NegativeVolume", 224.0, "negative"),
        ("ParameterModifier", 240.0, "modifier"),
        ("SupportBlocker", 240.0, "support"),
    ],
)
def test_ranges_of_facets_by_their_meaning(kind, volume, word):
    """PrusaSlicer keeps all volumes of an object in one mesh."""
    notes = (
        '<?xml version="1.0"?><config><object id="1"><volume firstid="0" lastid="11"><metadata type="volume" '
        'key="volume_type" value="ModelPart"/></volume><volume firstid="12" lastid="23">'
        f'<metadata type="volume" key="volume_type" value="{kind}"/></volume></object></config>'
    )
    part = loaded(package(model([thing(1, mesh(BLOCK, PIN))], ['objectid="1"']), **{PRUSA: notes}))
    assert mm3(part) == pytest.approx(volume, rel=1e-9)
    assert word in part.warnings[0]


@pytest.mark.parametrize("kind", ["support", "solidsupport", "other"])
def test_objects_that_are_no_parts_are_left_out(kind):
    objects = [thing(1, mesh(BLOCK)), thing(2, mesh(PIN + 30.0), kind, 'name="tree"')]
    part = loaded(package(model(objects, ['objectid="1"', 'objectid="2"'])))
    assert mm3(part) == pytest.approx(240.0)
    assert "support" in part.warnings[0] and "'tree'" in part.warnings[0]


@pytest.mark.parametrize(("text", "volume"), [("True", 240.0), ("False", None)])
def test_meshes_that_cura_marks(text, volume):
    mark = f'<metadatagroup><metadata name="cura:support_mesh">{text}</metadata></metadatagroup>'
    objects = [thing(1, mesh(BLOCK)), thing(2, mark + mesh(PIN + 30.0))]
    data = package(model(objects, ['objectid="1"', 'objectid="2"']))
    if volume is None:
        assert "holds 2 bodies" in refused(data)
    else:
        assert mm3(loaded(data)) == pytest.approx(volume)


def test_what_is_not_printed_is_left_out():
    objects = [thing(1, mesh(BLOCK)), thing(2, mesh(PIN + 30.0))]
    part = loaded(package(model(objects, ['objectid="1"', 'objectid="2" printable="0"'])))
    assert mm3(part) == pytest.approx(240.0)
    assert "not printable" in part.warnings[0]


def test_a_file_of_supports_alone_says_so():
    data = package(model([thing(1, mesh(BLOCK), "support")], ['objectid="1"']))
    assert "support" in refused(data)


@pytest.mark.parametrize("name", ["3D/Größe.model", "odd/part.model", "3D/3DModel.model"])
def test_the_model_is_where_the_relations_say(name):
    data = package(
        model([thing(1, mesh(BLOCK))], ['objectid="1"']), name, **{"3D/other.model": model([], [])}
    )
    assert mm3(loaded(data)) == pytest.approx(240.0)


def test_components_of_other_files_are_placed():
    """The production extension; one instance is moved, one mirrored: each keeps its volume."""
    places = ('transform="1 0 0 0 1 0 0 0 1 50 0 0"', 'transform="-1 0 0 0 1 0 0 0 1 -50 0 0"')
    inner = "".join(f'<component p:path="/3D/Objects/a.model" objectid="7" {place}/>' for place in places)
    root = model([thing(1, f"<components>{inner}</components>", more='name="pair"')], ['objectid="1"'])
    data = package(root, **{"3D/Objects/a.model": model([thing(7, mesh(BLOCK, PIN[:0]))], [])})
    assert "holds 2 bodies" in refused(data)
    for body, low in (("1", 50.0), ("2", -60.0)):
        part = loaded(data, body=body)
        assert mm3(part) == pytest.approx(240.0)
        assert part.vertices[:, 0].min() * 1e3 == pytest.approx(low)


def test_a_body_of_a_project_is_taken_by_its_name():
    objects = [thing(1, mesh(BLOCK), more='name="block"'), thing(2, mesh(PIN + 30.0), more='name="pin"')]
    data = package(model(objects, ['objectid="1"', 'objectid="2"']))
    assert mm3(loaded(data, body="pin")) == pytest.approx(24.0)
    named = package(model(BOTH, ['objectid="3"']), **bambu("normal_part", "normal_part"))
    assert mm3(loaded(named, body="normal_part 2")) == pytest.approx(24.0)


def test_bodies_that_touch_can_be_taken_apart():
    """A face in common makes them one part where none is asked for."""
    top = files.box((10.0, 6.0, 4.0), (0.0, 0.0, 4.0))
    data = package(model([thing(1, mesh(BLOCK)), thing(2, mesh(top))], ['objectid="1"', 'objectid="2"']))
    assert mm3(loaded(data)) == pytest.approx(480.0)
    assert mm3(loaded(data, body="2")) == pytest.approx(240.0)


def test_a_negative_part_that_is_open_is_refused():
    objects = [thing(1, mesh(BLOCK)), thing(2, mesh(PIN[:-1])), thing(3, (1, 2))]
    line = refused(package(model(objects, ['objectid="3"']), **bambu("normal_part", "negative_part")))
    assert "negative" in line and "CAD" in line


def test_an_extension_that_changes_the_shape_is_refused():
    beams = '<beamlattice xmlns="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"/>'
    content = mesh(BLOCK).replace("</mesh>", beams + "</mesh>")
    assert "beamlattice" in refused(package(model([thing(1, content)], ['objectid="1"'])))


ENTITY = '<!DOCTYPE model [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'


@pytest.mark.parametrize(("unit", "size"), [("Millimetres", 10e-3), ("inch", 254e-3), ("", 10e-3)])
def test_a_unit_as_people_write_it(unit, size):
    root = model([thing(1, mesh(BLOCK))], ['objectid="1"']).replace("millimeter", unit, 1)
    assert np.ptp(loaded(package(root)).vertices[:, 0]) == pytest.approx(size)


@pytest.mark.parametrize("unit", ["furlong", "mil", "\u202emm"])
def test_a_unit_that_is_none_is_refused(unit):
    root = model([thing(1, mesh(BLOCK))], ['objectid="1"']).replace("millimeter", unit, 1)
    assert "unit" in refused(package(root))


MANY = "".join(f"<a{k}/>" for k in range(2_000))


@pytest.mark.parametrize(
    ("root", "word"),
    [
        (model([thing(1, mesh(BLOCK))], ['objectid="1"'], ENTITY), "document type"),
        (model([thing(1, mesh(BLOCK) + MANY)], ['objectid="1"']), "kinds of elements"),
        (model([thing(1, mesh(BLOCK) + " " * 30_000_000)], ['objectid="1"']), "times its size"),
    ],
    ids=["entities", "names", "packed"],
)
def test_bombs_are_refused(root, word):
    assert word in refused(package(root))


def test_an_archive_of_very_many_files_is_refused(monkeypatch):
    monkeypatch.setattr(formats, "MAX_ARCHIVE_MEMBERS", 50)
    assert "50 files" in refused(package("", **{f"{k}.txt": "" for k in range(51)}))


def test_reading_stops_at_the_limit_of_corners(monkeypatch):
    """0.97 MB of 3MF took 5.9 GB: it was read whole before anything was counted."""
    monkeypatch.setattr(threemf, "MAX_READ_FACETS", 1000)
    taken = []
    begin = threemf.ModelReader.begin
    monkeypatch.setattr(threemf.ModelReader, "begin", lambda *given: taken.append(1) or begin(*given))
    text = '<vertex x="0" y="0" z="0"/>' * 20_000
    line = refused(package(model([thing(1, f"<mesh><vertices>{text}</vertices></mesh>")], ['objectid="1"'])))
    assert "more than 1000 corners" in line
    assert len(taken) < 1100
