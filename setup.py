"""The packages, by their folders: the folder `cli` is installed as `feederscrew_cli`, `parts` within samples.

A top-level `cli` in site-packages would collide with other tools', and the finder of pyproject.toml knows no
package that has another name than its folder.
"""

from setuptools import find_packages, setup

SAMPLE_PARTS = "feederscrew.samples.parts"  # data alone, named in pyproject.toml as well

setup(
    packages=[*find_packages(include=["feederscrew", "feederscrew.*"]), "feederscrew_cli", SAMPLE_PARTS],
    package_dir={"feederscrew_cli": "cli", SAMPLE_PARTS: "parts"},
)
