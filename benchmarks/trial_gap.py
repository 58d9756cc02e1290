"""How far parts are carried over a gap across the track: trials beside the way that the static rule allows.

Example: python benchmarks/trial_gap.py

For orientations of parts that the rule was not found on, gaps wider than the closed form by shares of the way
that a part travels in two time constants of its tipping.
"""

import trial_parts

from feederscrew import bowl as bowls
from feederscrew.resting.aspects import find
from feederscrew.running import RunSettings
from feederscrew.tooling.devices.kinds import made
from feederscrew.tooling.orientations import orientations, travelling
from feederscrew.trial import course

LYING = {
    "block_22x13x6": ("A@0", "A@90", "B@0"), "u_20x12x9": ("A@90", "B@0"), "t_20x15x7": ("A@90", "B@0"),
    "z_18x10x6": ("A@39",), "wedge_16x8x11": ("A@1", "C@1"), "disc_14x5": ("A@101",),
}  # fmt: skip
SHARES, TRIED = (-0.25, 0.25, 0.5, 0.75, 1.0, 1.25), 4


def passed(part, bowl, every, place, gap):
    """How many of some parts laid in one orientation pass a gap [m]."""
    device = made("gap", "here", limit=gap)
    seen = course.course(part, bowl, every, course.Sending([place], TRIED), [device], run=RunSettings(2))
    return int((seen.fates == course.PASSED).sum())


def main():
    bowl = bowls.read(None, [])
    print(f"passed of {TRIED}, the gap beyond the closed form by so many times the way carried: {SHARES}")
    for name, wanted in LYING.items():
        part = trial_parts.made(name)
        every = travelling(orientations(part, find(part), bowl.track), bowl)
        for place, one in enumerate(every):
            if one.name in wanted:
                found = [
                    passed(part, bowl, every, place, one.gap + share * one.carry_ahead) for share in SHARES
                ]
                print(f"{name} {one.name}: {1e3 * one.gap:.2f} mm, {1e3 * one.carry_ahead:.2f} mm: {found}")


if __name__ == "__main__":
    main()
