"""Tooling: which orientation passes a cut, and which cut lets only one orientation pass.

Source of its verdicts, derived there: docs/tooling.md; what trials say of them: docs/trial.md.
"""
