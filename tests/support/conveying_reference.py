"""The same point mass by SciPy's general solver, written from the forces; shares no code with ours."""

import math

from scipy.integrate import solve_ivp

GIVE_UP = 1e-7  # [A w] rebound below which the part stays down; the impact is then plastic


class Reference:
    """Part on a sinusoidally moved plate; units A and 1 / w. Phases 'stick', +1, -1 (slip), 'fly'."""

    def __init__(
        self, ratio, angle, climb, static, kinetic, restitution=0.0, bank=0.0, wall=0.0, lead=0.0, back=None,
        second=(0.0, 0.0, 0.0),
    ):  # fmt: skip
        self.gravity = 1.0 / ratio
        self.angle, self.climb, self.bank, self.lead = angle, climb, bank, lead
        self.wall, self.restitution, self.second = wall, restitution, second
        pairs = {1: (static, kinetic), -1: back or (static, kinetic)}  # by the direction of the slip
        self.static = {way: pair[0] for way, pair in pairs.items()}
        self.kinetic = {way: pair[1] for way, pair in pairs.items()}

    def shake(self, t, axis):
        """Acceleration of the plate, reversed, along an axis; each mode has its own direction."""
        share, phase, turn = self.second
        first, second = axis(self.angle), axis(self.angle + turn)
        return first * math.sin(t) + 4.0 * share * second * math.sin(2.0 * t + phase)

    def pressed(self, t):
        """Force that floor and upright wall carry together, square to the tangent, while in contact."""
        return self.gravity * math.cos(self.climb) - self.shake(t, math.sin)

    def held(self, pressed, coefficient):
        """Largest friction force of floor and wall that share a force; their normals are told apart here."""
        floor = pressed / math.cos(self.bank)  # the wall is level: it carries nothing upright
        wall = floor * math.sin(self.bank)  # and all of what the tilted floor pushes it with
        return coefficient * floor + self.wall * wall

    def needed(self, t):
        """Friction force that keeps the part from slipping."""
        return self.gravity * math.sin(self.climb) - self.shake(t + self.lead, math.cos)

    def most(self, t, coefficient):
        """Largest friction force of track and wall."""
        return self.held(self.pressed(t), coefficient)

    def rate(self, phase):
        """Right-hand side for (way, speed, height, rising speed)."""
        if phase == "stick":
            return lambda t, y: (0.0, 0.0, 0.0, 0.0)
        if phase == "fly":
            return lambda t, y: (y[1], -self.needed(t), y[3], -self.pressed(t))
        return lambda t, y: (y[1], -self.needed(t) - phase * self.most(t, self.kinetic[phase]), 0.0, 0.0)

    def ends(self, phase):
        """Event functions of a phase, each with the way it is crossed."""
        if phase == "fly":
            return [_event(lambda t, y: y[2], -1)]
        lift = _event(lambda t, y: self.pressed(t), -1)
        if phase == "stick":
            ahead = _event(lambda t, y: self.most(t, self.static[1]) + self.needed(t), -1)
            return [lift, ahead, _event(lambda t, y: self.most(t, self.static[-1]) - self.needed(t), -1)]
        return [lift, _event(lambda t, y: y[1], -phase)]

    def longest_step(self, t, y):
        """A small part of a bounce: the solver overlooks one that ends within its first step."""
        return min(0.2, 0.5 * y[3] / self.pressed(t)) if y[3] > 0.0 < self.pressed(t) else 0.2

    def touch(self, t, speed):
        """Phase of a part in contact."""
        lightening = self.pressed(t + 1e-6) < self.pressed(t - 1e-6)
        if self.pressed(t) < -1e-12 or (abs(self.pressed(t)) <= 1e-12 and lightening):
            return "fly"
        if speed != 0.0:
            return 1 if speed > 0.0 else -1
        if -self.needed(t) > self.most(t, self.static[1]):
            return 1
        return -1 if self.needed(t) > self.most(t, self.static[-1]) else "stick"

    def after(self, t, y, phase, which):
        """Phase and state after event number ``which`` of a phase."""
        way, speed, _, rising = y
        if phase == "fly":
            rebound = -self.restitution * rising
            rebound = rebound if rebound > GIVE_UP or (rebound > 0 > self.pressed(t)) else 0.0
            kinetic = self.kinetic[1 if speed > 0.0 else -1]
            speed -= math.copysign(min(abs(speed), self.held(rebound - rising, kinetic)), speed)
            return "fly" if rebound else self.touch(t, speed), (way, speed, 0.0, rebound)
        if which == 0:
            return "fly", (way, speed, 0.0, 0.0)
        if phase == "stick":
            return (1 if which == 1 else -1), (way, 0.0, 0.0, 0.0)
        return self.touch(t, 0.0), (way, 0.0, 0.0, 0.0)

    def velocity(self, periods, average):
        """Mean velocity over the last ``average`` of a number of periods, from rest; in units of A w."""
        t, y, phase, ways = 0.0, (0.0, 0.0, 0.0, 0.0), self.touch(0.0, 0.0), [0.0]
        while len(ways) <= periods:
            stop = 2.0 * math.pi * len(ways)
            leg = solve_ivp(
                self.rate(phase), (t, stop), y, "DOP853",
                events=self.ends(phase), rtol=1e-10, atol=1e-13, max_step=self.longest_step(t, y),
            )  # fmt: skip
            t, y = leg.t[-1], tuple(leg.y[:, -1])
            if leg.status == 1:
                which = next(i for i, times in enumerate(leg.t_events) if len(times))
                phase, y = self.after(t, y, phase, which)
            else:
                ways.append(y[0])
        return (ways[-1] - ways[-1 - average]) / (2.0 * math.pi * average)


def _event(function, direction):
    function.terminal, function.direction = True, direction
    return function


def random_settings(count, rng):
    """Columns ratio, angle, climb, friction of the box of settings that the project's claims are about."""
    low, high = (0.1, math.radians(5.0), 0.0, 0.15), (6.0, math.radians(60.0), math.radians(5.0), 0.8)
    return rng.uniform(low, high, (count, 4))
