"""The packages, by their folders: the folder `cli` is installed as `feederscrew_cli`.

A top-level `cli` in site-packages would collide with other tools', and the finder of pyproject.toml knows no
package that has another name than its folder.
"""

from setuptools import find_packages, setup

setup(
    packages=[*find_packages(include=["feederscrew", "feederscrew.*"]), "feederscrew_cli"],
    package_dir={"feederscrew_cli": "cli"},
)
