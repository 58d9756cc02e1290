"""Parts of true shape on the vibrating, tooled track.

Source of its model and what it was checked against: docs/trial.md, sections 1 and 2.
"""
