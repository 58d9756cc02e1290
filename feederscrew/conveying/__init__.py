"""A point mass on a vibrating track, integrated exactly from event to event.

``setting`` says what goes in; ``waves``, ``harmonic``, ``law`` and ``events`` hold one closed-form phase
and its end; ``motion`` chains the phases, ``steady`` finds the period, ``onset`` the limits of slip, and
``sweep`` compiles the same functions for maps.

Source: Sloot and Kruyt 1996, with what was added to their model in docs/conveying.md, "The model".
"""
