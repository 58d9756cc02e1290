"""The machine under the bowl: two masses on leaf springs, their tuning, and the size of a bowl for a part.

Source of its formulas and rules of thumb: docs/bowl.md.
"""
