"""Rules that give the probability of each resting aspect, a module a family.

Source of each rule, with its paper: docs/resting.md; ``registry`` lists them.
"""
