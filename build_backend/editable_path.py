"""The build backend: setuptools, whose editable install also names the folder that the packages lie in.

The folder `cli` is installed as `feederscrew_cli`, so setuptools maps names to folders by an import hook.
mypy and pyright run no hook: without a path they find no `feederscrew`, and call every program that imports
it wrong.

A wheel begins without what an earlier one left in `build`: a module that is gone would be in it.
"""

import base64
import hashlib
import shutil
import zipfile
from pathlib import Path
from typing import Any

from setuptools import build_meta
from setuptools.build_meta import (
    build_sdist,
    get_requires_for_build_editable,
    get_requires_for_build_sdist,
    get_requires_for_build_wheel,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable", "build_sdist", "build_wheel", "get_requires_for_build_editable",
    "get_requires_for_build_sdist", "get_requires_for_build_wheel", "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]  # fmt: skip

PATH_FILE = "feederscrew_path.pth"


def build_wheel(
    wheel_directory: str,
    config_settings: Any = None,
    metadata_directory: str | None = None,
) -> str:
    """Return the name of the wheel that setuptools builds from the sources alone."""
    shutil.rmtree("build", ignore_errors=True)
    return build_meta.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str,
    config_settings: Any = None,
    metadata_directory: str | None = None,
) -> str:
    """Return the name of the wheel that setuptools builds, with the path of the project in it."""
    name = build_meta.build_editable(wheel_directory, config_settings, metadata_directory)
    _add_file(Path(wheel_directory, name), PATH_FILE, f"{Path.cwd()}\n".encode())
    return name


def _add_file(wheel: Path, name: str, content: bytes) -> None:
    """Write a wheel anew with one file more, which its RECORD lists."""
    with zipfile.ZipFile(wheel) as old:
        files = {info: old.read(info) for info in old.infolist()}
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as new:
        new.writestr(name, content)
        for info, data in files.items():
            if info.filename.endswith(".dist-info/RECORD"):
                data += f"{name},sha256={digest},{len(content)}\n".encode()
            new.writestr(info, data)
