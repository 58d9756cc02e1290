"""Air that blows all the time: jet."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from feederscrew import units
from feederscrew import value_forms as forms
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import (
    MM,
    RETURNED,
    UNSURE,
    Device,
    length_text,
    length_words,
    mapping_text,
    room_of,
)
from feederscrew.tooling.devices.nozzles import SPREAD, Nozzles, thrust
from feederscrew.tooling.devices.pieces import Standing

RESERVE = 1.1  # beyond that, of a jet that a design proposes
HEIGHTS = 6  # of the nozzle that a design tries, evenly up to the tallest orientation
SUPPLY, PRESSURE_STEP = 4e5, 5e3  # [Pa] of a usual compressed-air net, and to which a regulator is set
CLEAR = 2.0  # times the force that just moves a part off: within it, to either side, nothing is sure
PLACES = 9  # along a part at which a jet meets it
BORE, PRESSURE = 2e-3, 2e4  # [m], [Pa]
BAR = units.factor("bar", "pressure")


@dataclass(frozen=True)
class SteadyJet(Device):
    """A nozzle in the wall that blows all the time: it moves off what offers it enough area at its height."""

    nozzle: float = BORE  # [m]
    pressure: float = PRESSURE  # [Pa] above the ambient
    height: float = 0.0  # [m] of the nozzle over the track

    kind = "jet"
    trade = "air jet"
    form = forms.mapping(nozzle=forms.LENGTH, pressure=forms.quantity("pressure"), height=forms.LENGTH)
    example = "{nozzle: 2 mm, pressure: 0.2 bar, height: 8 mm}"
    meaning = (
        "nozzle in the wall that blows all the time, at a height over the track: returns what it moves over "
        "the free edge while it passes; sure where the force is twice as large or half as large as that takes"
    )
    feature = "area that it offers a jet"
    picture = "above"
    layer = "NOZZLE"
    cost_class = 2
    proposed = True

    @classmethod
    def read(cls, entry):
        return values.nozzle(entry, needed=("nozzle", "pressure", "height"))

    def value_text(self):
        entries = (("nozzle", length_text(self.nozzle)), ("pressure", f"{self.pressure / BAR:.9g} bar"))
        return mapping_text((*entries, ("height", length_text(self.height))))

    @property
    def value_words(self):
        bore, high = length_words(self.nozzle), length_words(self.height)
        return f"nozzle of {bore} at {self.pressure / BAR:.4g} bar, {high} over the track"

    @property
    def jet(self):
        """Its Nozzles, one."""
        return Nozzles(self.nozzle, self.pressure, self.height)

    @classmethod
    def proposals(cls, wanted, others, every, where):
        """Return the jets that blow surely off some orientations and surely leave others, one a height.

        Parameters
        ----------
        wanted, others : sequence of Meeting
            That shall stay, and that shall be blown off where they can.
        every : sequence of Orientation
            Of the part.
        where : str

        Returns
        -------
        list of SteadyJet
            Of the least pressure that blows off as many as the greatest one that leaves all that are wanted.
        """
        found, top = [], max(one.height for one in every)
        for height in np.round(top * (np.arange(HEIGHTS) + 0.5) / HEIGHTS, 4):
            jet = cls(where, height=float(height))
            own, full = jet.jet.thrust, thrust(jet.nozzle, SUPPLY)
            most = max(jet.most(met) for met in wanted) / own
            greatest = min(full, 1.0 / (CLEAR * RESERVE * most) if most > 0.0 else full)
            needed = [CLEAR * RESERVE * own / max(jet.factor(met), 1e-12) for met in others]
            enough = [one for one in needed if one <= greatest]
            if enough:
                pressure = math.ceil(_pressure(jet.nozzle, max(enough)) / PRESSURE_STEP - 1e-6)
                found.append(replace(jet, pressure=pressure * PRESSURE_STEP).rewritten())
        return found

    def fate(self, met):
        return RETURNED

    def factor(self, met):
        """Return its mean force on an orientation that passes, over the one that just moves it off [1]."""
        return float(np.mean(self._factors(met)))

    def most(self, met):
        """Return the greatest such factor [1] at any place along an orientation."""
        return float(self._factors(met).max())

    def _factors(self, met):
        """The same (PLACES,) at places along its length: it may offer more ahead or behind than amid."""
        one = met.one
        wide = self.nozzle + SPREAD * one.width + one.length
        ends = one.outline[:, 0].min(), one.outline[:, 0].max()
        shares = (np.arange(PLACES) + 0.5) / PLACES
        pushes = [
            self.jet.push(one, met.every or (one,), -float(ends[0] + share * (ends[1] - ends[0])))
            for share in shares
        ]
        force = met.force_to_clear(wide, self.height)
        return np.array([out - met.grip * max(down, 0.0) for out, down in pushes]) / force

    def judged(self, met):
        """Return what it does: what hangs between rails is held by them, and may be pressed on them."""
        if met.hanging:
            return met.verdict(0.0)
        factor, most = self.factor(met), self.most(met)
        way = met.one.track.width - met.one.distance
        margin = way * (1.0 - (most if factor < 1.0 else factor))
        if most > 1.0 / CLEAR and factor < CLEAR:
            margin = 0.0 if factor < 1.0 else -UNSURE
        return met.verdict(max(margin, -way))

    def standing(self, track, every):
        room = room_of(every)
        return Standing(room, jets=self.jet.jets(0.5 * room, every))

    def edge(self, start, length, width):
        """Return its beam, unrolled."""
        middle, near = start + 0.5 * length, 0.5 * self.nozzle
        far = near + SPREAD * width
        return np.array(
            [[middle - near, 0.0], [middle + near, 0.0], [middle + far, width], [middle - far, width]]
        )

    def told(self):
        return {"nozzle_mm": self.nozzle / MM, "pressure_bar": self.pressure / 1e5,
                "height_mm": self.height / MM, "thrust_N": self.jet.thrust}  # fmt: skip

    @property
    def label(self):
        return f"{self.kind} {self.text}"


def _pressure(nozzle, force):
    """The pressure [Pa] at which a nozzle [m] has a thrust [N], which the supply makes."""
    return float(brentq(lambda pressure: thrust(nozzle, pressure) - force, 0.0, SUPPLY))
