"""3MF projects by their meaning: parts, supports, modifiers, negative and unprintable parts, and bombs."""

import time

import numpy as np
import part_files as files
import pytest
from readings import AGAIN, loaded, mm3, refused, zipped

from feederscrew.part import formats, threemf, topology

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship '
    'Target="/{}" Id="r0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'
)
BLOCK = files.box((10.0, 6.0, 4.0))
PIN = files.box((2.0, 2.0, 6.0), (4.0, 2.0, -1.0))  # through the block
ELSEWHERE = f'<model unit="millimeter" xmlns="{CORE}"><resources>{{}}</resources><build/></model>'
SETTINGS, PRUSA = "Metadata/model_settings.config", "Metadata/Slic3r_PE_model.config"
CURA = '<metadatagroup><metadata name="cura:support_mesh">{}</metadata></metadatagroup>'
NEGATIVE, NO_PARTS = 240.0 - 16.0, ("support", "solidsupport", "other")
MANY = "".join(f"<a{k}/>" for k in range(2_000))
ENTITY = '<!DOCTYPE model [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
BEAMS = '<beamlattice xmlns="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"/></mesh>'
OPEN = '<config><object id="3"><part id="2" subtype="negative_part"/></object></config>'


def mesh(*bodies):
    corners, faces, count = [], [], 0
    for triangles in bodies:
        loose = np.arange(len(triangles) * 3).reshape(-1, 3)
        vertices, own = topology.weld_corners(triangles.reshape(-1, 3), loose)
        corners += vertices.tolist()
        faces += (own + count).tolist()
        count += len(vertices)
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in corners)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"


def thing(number, content, kind="model", more=""):
    """An object of a mesh, or of components where ``content`` is a tuple of object numbers."""
    if isinstance(content, tuple):
        inner = "".join(f'<component objectid="{k}"/>' for k in content)
        content = f"<components>{inner}</components>"
    return f'<object id="{number}" type="{kind}" {more}>{content}</object>'


def package(*objects, built=(1,), name="3D/3dmodel.model", unit="millimeter", head="", others=None):
    """A 3MF of objects, the numbers of those that are built, and other files by their names."""
    items = "".join(f'<item objectid="{k}"/>' if isinstance(k, int) else k for k in built)
    root = (
        f'<?xml version="1.0"?>{head}<model unit="{unit}" xmlns="{CORE}" xmlns:p="{PRODUCTION}">'
        f"<resources>{''.join(objects)}</resources><build>{items}</build></model>"
    )
    return zipped({"_rels/.rels": RELATIONS.format(name), name: root, **(others or {})})


def bambu(*subtypes):
    """A project of Bambu Studio: block and pin as parts of object 3, and what it says of them."""
    parts = "".join(
        f'<part id="{k}" subtype="{kind}"><metadata key="name" value="{kind} {k}"/></part>'
        for k, kind in enumerate(subtypes, 1)
    )
    notes = f'<?xml version="1.0"?><config><object id="3">{parts}</object></config>'
    return package(thing(1, mesh(BLOCK)), thing(2, mesh(PIN)), thing(3, (1, 2)), built=(3,),
                   others={SETTINGS: notes})  # fmt: skip


def prusa(kind):
    """A project of PrusaSlicer, which keeps all volumes of an object in one mesh."""
    notes = (
        '<?xml version="1.0"?><config><object id="1"><volume firstid="0" lastid="11"><metadata type="volume" '
        'key="volume_type" value="ModelPart"/></volume><volume firstid="12" lastid="23">'
        f'<metadata type="volume" key="volume_type" value="{kind}"/></volume></object></config>'
    )
    return package(thing(1, mesh(BLOCK, PIN)), others={PRUSA: notes})


FAR = mesh(PIN + 30.0)


def beside(kind="model", more="", mark="", item=2):
    """The block, and a pin that does not touch it."""
    return package(thing(1, mesh(BLOCK)), thing(2, mark + FAR, kind, more), built=(1, item))


@pytest.mark.parametrize(
    ("data", "volume", "words"),
    [
        (bambu("normal_part", "negative_part"), NEGATIVE, "negative part: subtracted"),
        (bambu("normal_part", "modifier_part"), 240.0, "modifier"),
        *((bambu("normal_part", f"support_{kind}"), 240.0, "support") for kind in ("enforcer", "blocker")),
        (prusa("NegativeVolume"), NEGATIVE, "negative"),
        (prusa("ParameterModifier"), 240.0, "modifier"),
        (prusa("SupportBlocker"), 240.0, "support"),
        *((beside(kind, 'name="tree"'), 240.0, "support|'tree'") for kind in NO_PARTS),
        (beside(mark=CURA.format("True")), 240.0, "support"),
        (beside("surface", mark=CURA.format("True")), 240.0, "support"),
        (package(thing(1, mesh(BLOCK), "surface")), 240.0, "type surface|read as a part"),  # of FreeCAD 0.20
        (package(thing(1, mesh(BLOCK)), thing(2, mesh(PIN[1:]), "surface"), built=(1, 2)), 240.0, "open sur"),
        (beside(item='<item objectid="2" printable="0"/>'), 240.0, "not printable"),
    ],
)  # fmt: skip
def test_parts_of_a_slicer_by_their_meaning(data, volume, words):
    part = loaded(data)
    assert mm3(part) == pytest.approx(volume, rel=1e-9)
    assert len(part.warnings) == 1 and all(word in part.warnings[0] for word in words.split("|"))


@pytest.mark.parametrize("name", ["3D/Größe.model", "odd/part.model", "3D/3DModel.model"])
def test_the_model_is_where_the_relations_say(name):
    data = package(thing(1, mesh(BLOCK)), name=name, others={"3D/other.model": ELSEWHERE.format("")})
    assert mm3(loaded(data)) == pytest.approx(240.0)


def test_components_of_other_files_are_placed():
    """The production extension; one instance is moved, one mirrored: each keeps its volume."""
    places = ('transform="1 0 0 0 1 0 0 0 1 50 0 0"', 'transform="-1 0 0 0 1 0 0 0 1 -50 0 0"')
    inner = "".join(f'<component p:path="/3D/Objects/a.model" objectid="7" {place}/>' for place in places)
    other = ELSEWHERE.format(thing(7, mesh(BLOCK)))
    root = thing(1, f"<components>{inner}</components>", more='name="pair"')
    data = package(root, others={"3D/Objects/a.model": other})
    assert "holds 2 bodies" in refused(data)
    for body, low in (("1", 50.0), ("2", -60.0)):
        part = loaded(data, body=body)
        assert mm3(part) == pytest.approx(240.0)
        assert part.vertices[:, 0].min() * 1e3 == pytest.approx(low)


def test_bodies_of_a_project():
    assert mm3(loaded(beside(more='name="pin"'), body="pin")) == pytest.approx(24.0)
    assert mm3(loaded(bambu("normal_part", "normal_part"), body="normal_part 2")) == pytest.approx(24.0)
    # A face in common makes them one part where none is asked for.
    top = files.box((10.0, 6.0, 4.0), (0.0, 0.0, 4.0))
    data = package(thing(1, mesh(BLOCK)), thing(2, mesh(top)), built=(1, 2))
    assert [mm3(loaded(data)), mm3(loaded(data, body="2"))] == pytest.approx([480.0, 240.0])


@pytest.mark.parametrize(("unit", "size"), [("Millimetres", 10e-3), ("inch", 254e-3), ("", 10e-3)])
def test_a_unit_as_people_write_it(unit, size):
    assert np.ptp(loaded(package(thing(1, mesh(BLOCK)), unit=unit)).vertices[:, 0]) == pytest.approx(size)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (package(thing(1, mesh(BLOCK), "support")), "support"),
        (beside(mark=CURA.format("False")), "holds 2 bodies"),
        (package(thing(1, mesh(BLOCK)), thing(2, mesh(PIN[:-1])), thing(3, (1, 2)), built=(3,),
                 others={SETTINGS: OPEN}), "negative|CAD"),
        (package(thing(1, mesh(BLOCK).replace("</mesh>", BEAMS))), "beamlattice"),
        *((package(thing(1, mesh(BLOCK)), unit=unit), "unit") for unit in ("furlong", "mil", "\u202emm")),
        (package(thing(1, mesh(BLOCK[1:]), "surface")), "no facets|open surface"),
        (package(thing(1, mesh(BLOCK).replace('x="10.0"', 'x="10,0"'))), "comma|decimal point"),
        (package(thing(1, mesh(BLOCK)), head=ENTITY), "document type"),
        (package(thing(1, mesh(BLOCK) + MANY)), "kinds of elements"),
        (package(thing(1, mesh(BLOCK) + " " * 30_000_000)), "times its size"),
    ],
    ids=["supports alone", "bodies", "open negative", "extension", "furlong", "mil", "bidi", "open surface",
         "commas", "entities",
         "names", "packed"],
)  # fmt: skip
def test_projects_that_are_refused(data, words):
    line = refused(data)
    assert all(word in line for word in words.split("|"))


@pytest.mark.parametrize(
    ("components", "reason"),
    [
        ([(k - 1,) * 10 for k in range(2, 9)], "its components stand for more than 5000 bodies"),
        ([(k - 1,) for k in range(2, 60)], "components within components more than 50 deep"),
        ([(3,), (2,)], "components within components more than 50 deep"),
    ],
    ids=["wide", "deep", "round"],
)
def test_nested_components_are_counted_before_they_are_placed(components, reason):
    start, things = time.perf_counter(), [thing(k, inner) for k, inner in enumerate(components, 2)]
    data = package(thing(1, mesh(BLOCK)), *things, built=(2 if components[0] == (3,) else len(things) + 1,))
    assert refused(data) == f"is a damaged 3MF ({reason}) - {AGAIN}"
    assert time.perf_counter() - start < 5.0


def test_limits_of_what_is_read(monkeypatch):
    monkeypatch.setattr(formats, "MAX_ARCHIVE_MEMBERS", 50)
    assert "50 files" in refused(package(others={f"{k}.txt": "" for k in range(51)}))
    # 0.97 MB of 3MF took 5.9 GB: it was read whole before anything was counted.
    monkeypatch.setattr(threemf, "MAX_READ_FACETS", 1000)
    elements, begin = [], threemf.ModelReader.begin
    monkeypatch.setattr(threemf.ModelReader, "begin", lambda *given: elements.append(1) or begin(*given))
    text = '<vertex x="0" y="0" z="0"/>' * 20_000
    line = refused(package(thing(1, f"<mesh><vertices>{text}</vertices></mesh>")))
    assert "more than 1000 corners" in line
    assert len(elements) < 1100
