"""Damaged part files: each line says what is wrong in words for the user, not in those of Python."""

import io
import struct
import zipfile

import part_files as files
import pytest
import trimesh

AGAIN = "export the part again"


def exported(format):
    """Bytes of a box as trimesh writes it."""
    data = trimesh.creation.box((10, 20, 30)).export(file_type=format)
    return data if isinstance(data, bytes) else data.encode()


PLY = exported("ply")


def archived(model):
    """A 3MF of one model file."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", model)
        archive.writestr("_rels/.rels", "<Relationships/>")
    return file.getvalue()


def boxed(scene):
    """A GLB of a scene alone."""
    scene += b" " * (-len(scene) % 4)
    return b"glTF" + struct.pack("<4I", 2, 20 + len(scene), len(scene), 0x4E4F534A) + scene


def mesh(vertex='x="1" y="0" z="0"', item='objectid="1"'):
    return (  # one triangle
        '<model><resources><object id="1"><mesh><vertices>'
        f'<vertex x="0" y="0" z="0"/><vertex {vertex}/><vertex x="0" y="1" z="0"/></vertices><triangles>'
        '<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>'
        f"<build><item {item}/></build></model>"
    )


MOVED = 'objectid="1" transform="1 0 0"'


def locked(data):
    """An archive whose members say that a password locks them."""
    version = b"PK\x01\x02\x14\x03\x14\x00"
    return data.replace(version + b"\x00\x00", version + b"\x01\x00")


@pytest.mark.parametrize(
    ("name", "data", "reason"),
    [
        ("a.3mf", archived(mesh('x="one" y="0" z="0"')), "a value in it cannot be read"),
        ("a.3mf", archived(mesh('x="1" y="0"')), "something in it is missing"),
        ("a.3mf", archived(mesh(item='objectid="7"')), "something in it is missing"),
        ("a.3mf", archived(mesh(item=MOVED)), "a transform of 3 numbers, not of 12"),
        ("a.3mf", archived(mesh())[:-30], "its archive is damaged"),
        ("a.3mf", locked(archived(mesh())), "its archive is locked by a password"),
        ("a.glb", boxed(b"{,}"), "its scene is no JSON"),
        ("a.glb", boxed(b'{"nodes": [null]}'), "its scene has null out of place"),
        ("a.glb", boxed(b'{"nodes": [{"mesh": 3}]}'), "something in it is missing"),
        ("a.ply", PLY.replace(b"property float x", b"property real x"), "something in it is missing"),
        ("a.off", exported("off").replace(b"8 12 0", b"8 o2 0"), "a value in it cannot be read"),
    ],
)  # fmt: skip
def test_a_damaged_file_is_told_of_in_words_for_its_user(tmp_path, name, data, reason):
    """It was: 'could not convert string to float: 'one'', ''y'', 'list index out of range'."""
    title = {"3mf": "3MF", "glb": "GLB", "ply": "PLY", "off": "OFF"}[name[2:]]
    said = files.refused(files.written(tmp_path, data, name))
    assert said == f"is a damaged {title} ({reason}) - {AGAIN}"
