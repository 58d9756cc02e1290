"""Parts with their weight off the middle over a balance gap: trials beside the verdict."""

import numpy as np
import pytest
import shapes
import trimesh
from block_rides import lying, sent
from round_bodies import revolved

from feederscrew import bowl as bowls
from feederscrew.bowl.devices.kinds import KINDS, make_device
from feederscrew.sorting.orientations import add_travel
from feederscrew.sorting.verdicts import DeviceEncounter, verdict
from feederscrew.trials import course

FORK = [(0, 0), (40, 0), (40, 2), (14, 2), (14, 10), (40, 10), (40, 12), (0, 12)]  # [mm] seen from above
CAP = [(0, 0), (0, 4), (45, 4), (45, 3.2), (12, 3.2), (12, 0)]  # [mm] along its axis, and radius: of a pen
PARTS = {
    "fork": shapes.part(shapes.prism(FORK, 5)),
    "pen cap": shapes.part(trimesh.Trimesh(**trimesh.triangles.to_kwargs(revolved(CAP, 48)))),
}
DRIVES = {
    "two-axis": (),  # that of a bowl of the defaults
    "hops at 100 Hz": (
        "drive.amplitude=0.1 mm", "drive.frequency=100 Hz", "drive.vibration_angle=20 deg",
        "drive.phase=0 deg",
    ),
}  # fmt: skip


def both_ends(name, drive):
    """A bowl, the orientations of a part in it, and the rows with its light end and its heavy end ahead."""
    bank = 6.0 if name == "pen cap" else 0.0
    bowl = bowls.read(None, ["track.width=18 mm", f"track.bank={bank} deg", *DRIVES[drive]])
    every = add_travel(lying(PARTS[name], bowl), bowl)
    longest = max(one.length for one in every)
    along = [k for k, one in enumerate(every) if one.length > 0.9 * longest and one.height < 9e-3]
    light, *_, heavy = sorted(along, key=lambda k: -every[k].ahead)
    return bowl, every, light, heavy


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("drive", DRIVES)
def test_the_light_end_first_passes_and_the_heavy_end_first_falls(name, drive):
    """At the gap that a design proposes: 8 parts of each, and none at all passes a gap alone."""
    bowl, every, light, heavy = both_ends(name, drive)
    met = [[DeviceEncounter(every[k], every) for k in rows] for rows in ([light], [heavy])]
    (own,) = KINDS["balance gap"].proposals(*met, every, "test")
    rows, said = (light, heavy), [verdict(own, every[k], every) for k in (light, heavy)]
    assert said[0].margin > 0.0 > said[1].margin and all(one.sure for one in said)
    seen = sent(PARTS[name], bowl, rows, 16, [own], every=every, seed=11)
    for row, fate in zip(rows, (course.PASSED, course.RETURNED)):
        assert (seen.fates[seen.entry_rows == row] == fate).sum() == 8, seen.fates
    assert (seen.depths < 2.5e-4).all() and (seen.gains < 1e-5).all()
    alone = make_device("gap", "test", limit=own.limit)
    assert not (sent(PARTS[name], bowl, rows, 4, [alone], every=every, seed=11).fates == course.PASSED).any()


def test_a_nose_that_meets_the_far_edge_stands():
    """A cap of 12 x 40 mm, its weight 15.4 mm from its nose, swings sqrt(15.4^2 + 12^2) = 19.5 mm."""
    profile = [(0, 0), (0, 6), (40, 6), (40, 4.8), (10, 4.8), (10, 0)]
    part = shapes.part(trimesh.Trimesh(**trimesh.triangles.to_kwargs(revolved(profile, 48))))
    bowl = bowls.read(None, ["track.width=18 mm", "track.bank=6 deg"])
    every = add_travel(lying(part, bowl), bowl)
    heavy = min((k for k, one in enumerate(every) if one.length > 39e-3), key=lambda k: every[k].ahead)
    for length, fate, word in ((19e-3, course.STOPPED, "stopped"), (25.2e-3, course.RETURNED, "returned")):
        own = make_device("balance gap", "test", limit=length, clearance=12.5e-3, hold=10e-3)
        assert own.fate(DeviceEncounter(every[heavy])) == word
        assert verdict(own, every[heavy]).sure == (word == "returned")
        assert np.all(sent(part, bowl, [heavy], 4, [own], every=every, seed=11).fates == fate)
