"""The packages to install; all else is in pyproject.toml, which cannot rename one and find the others."""

from setuptools import find_packages, setup

setup(packages=[*find_packages(include=["feederscrew", "feederscrew.*"]), "feederscrew_cli"])
