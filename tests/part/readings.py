"""Bytes of part files, and what is read from them."""

import io
import zipfile

import part_files as files
import pytest
import trimesh

from feederscrew.base.errors import FeederError
from feederscrew.part import load

AGAIN = "export the part again"
BOX = files.box()  # 6000 mm3


def loaded(data, **options):
    return load("-", stdin=io.BytesIO(data if isinstance(data, bytes) else data.encode()), **options)


def mm3(part):
    return part.volume * 1e9


def refused(data, **options):
    with pytest.raises(FeederError) as caught:
        loaded(data, **options)
    assert len(caught.value.lines) == 1
    return str(caught.value).removeprefix("standard input: ")


def exported(format, triangles=BOX):
    data = trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles)).export(file_type=format)
    return data if isinstance(data, bytes) else data.encode()


def zipped(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()


def archived(model):
    return zipped({"3D/3dmodel.model": model, "_rels/.rels": "<Relationships/>"})
