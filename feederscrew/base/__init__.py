"""What every stage needs: units, columns, faults, files, processes, geometry, compiled code."""

from feederscrew.base import errors as errors  # fs.errors
