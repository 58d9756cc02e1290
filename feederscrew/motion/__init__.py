"""What moves a part: limits of slip and hop, balances of forces, headings along the wall, conveying, screws.

``limits``, ``floor_balance``, ``track_balance`` and ``headings`` treat a part of its shape; ``screws`` the
twists, wrenches and momenta that they are checked against.

A point mass on the vibrating track is integrated exactly from event to event: ``operating_point`` says what
goes in and holds the equations of motion, ``waves`` one closed-form phase and its end, ``point_motion``
chains the phases, ``steady`` finds the period, ``conveying`` goes from a bowl to velocities in SI units, also
compiled, for maps; ``hop`` is how high a part is thrown.

Source: chapter 4 of the thesis, docs/mechanics.md; of the point Sloot and Kruyt 1996, with what was added to
their model in docs/conveying.md, "The model".
"""
