"""A point mass on a vibrating track, integrated exactly from event to event.

``operating_point`` says what goes in and holds the equations of motion, ``waves`` one closed-form phase and
its end, ``point_motion`` chains the phases, ``steady`` finds the period, ``answer`` goes from a bowl to
velocities in SI units, also compiled, for maps; ``hop`` is how high a part is thrown.

Source: Sloot and Kruyt 1996, with what was added to their model in docs/conveying.md, "The model".
"""
