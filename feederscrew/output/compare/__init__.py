"""Tables and figures of ``compare``."""

from feederscrew.studies.passages import FeedingStudy


def of_kind(study):
    """Return the modules with the files and with the tables of a CompareStudy or a FeedingStudy."""
    from feederscrew.output.compare import feeding, files, tables

    return (feeding, feeding) if isinstance(study, FeedingStudy) else (files, tables)
