"""Imports made once, by the process that those of a batch are forked from."""

import gc

gc.disable()  # libraries make no garbage while they are imported; each process of the batch collects again

from feederscrew.jobs.batch import work  # noqa: E402, F401
