"""A flat block on a track that is straight but for its radius, and rides of one part in the trial."""

from dataclasses import replace
from functools import cache

import numpy as np
import shapes

from feederscrew import bowl as bowls
from feederscrew.base.running import RunSettings
from feederscrew.resting.aspects import find
from feederscrew.sorting.orientations import orientations
from feederscrew.trials import course, part_poses, runs, shape, staging

OWN = (
    "drive.amplitude=0.15 mm", "drive.frequency=60 Hz", "drive.vibration_angle=20 deg", "restitution=0.2",
    "friction.static=0.4", "track.radius=50 m", "track.width=60 mm", "track.climb=2 deg", "track.bank=0 deg",
)  # fmt: skip
BOWL = bowls.read(None, OWN)
PART = shapes.part(shapes.box(20, 12, 5))
ASPECTS = find(PART)
EVERY = orientations(PART, ASPECTS, BOWL.track)
ALONG = next(k for k, one in enumerate(EVERY) if one.height < 6e-3 and one.length > 0.015)
FLAT = EVERY[ALONG]  # lengthwise along the wall
SHARES = np.array([one is FLAT for one in EVERY], float)
SOLID, LENGTH, PRINCIPAL = shape.solid_of(PART)
HEAD = [(-2.5, 0), (2.5, 0), (2.5, 14), (5, 14), (5, 17), (-5, 17), (-5, 14), (-2.5, 14)]
HEADED = shapes.part(shapes.prism(HEAD, 5))  # a flat headed part: shank 5, head 10 mm wide


def still(bowl=BOWL, **track):
    return replace(bowl, drive=replace(bowl.drive, amplitude=0.0), track=replace(bowl.track, **track))


@cache
def aspects_of(part):
    return find(part)


def lying(part, bowl):
    return orientations(part, aspects_of(part), bowl.track)


def laid(part, one, bowl, *, place=0.0, **own):
    """State (13,) of a part in an orientation at a place [m] along the wall."""
    _, length, principal = shape.solid_of(part)
    return part_poses.pose_on_track(one, principal, length, bowl.track, place=place, **own)


def ridden(part, bowl, states, seconds, stage=None, *, back=10.0, interval=1.0, places=1, **known):
    """What the kernel knows of a part in a bowl, and its ride from a state over the bare track or a device.

    ``back`` is how far [m] it may go back; ``known`` replaces what the kernel knows of it.
    """
    solid, length, _ = shape.solid_of(part)
    setting = replace(runs.setting(solid, length, bowl), **known)
    stage = stage or staging.stage_bare_track(bowl.track, lying(part, bowl), 0.5)
    limits = runs.RideLimits(seconds, 2.0 * seconds, 0.0, back, interval, places)
    follow = runs.make_plain_follower(setting, stage, limits)
    states = np.atleast_2d(states)
    return setting, runs.ride(follow, states, np.zeros(len(states)))


def sent(part, bowl, rows, parts, devices=(), *, seed=1, every=None, **more):
    """What became of so many parts, sent in some orientations past devices."""
    every, run = every or lying(part, bowl), RunSettings(seed)
    return course.course(part, bowl, every, course.SentParts(rows, parts), devices, run=run, **more)
