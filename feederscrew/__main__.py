"""``python -m feederscrew``: the program ``feeder``, where its folder is not on the path."""

from feederscrew_cli.main import feeder

feeder(prog_name="feeder")
