"""What was measured of a device that is not described: yield."""

import math

from feederscrew import units
from feederscrew import value_forms as forms
from feederscrew.tooling.devices import values
from feederscrew.tooling.devices.base import Device, Verdict, mapping_text


class Yield(Device):
    """A share that passes, by aspect."""

    kind = "yield"
    trade = "measured yield"
    form = forms.by_name(forms.quantity("number", "0", "1"))
    example = "{A: 0.9}"
    meaning = "share that passes, by aspect, as measured; aspects not named pass"
    placed = False

    @classmethod
    def read(cls, entry):
        return values.shares(entry)

    def value_text(self):
        return mapping_text((units.quoted(name), f"{share:.9g}") for name, share in self.shares)

    @property
    def value_words(self):
        return "passes " + ", ".join(f"{100.0 * share:.4g} % of {name}" for name, share in self.shares)

    def judged(self, met):
        shares = {name.casefold(): share for name, share in self.shares}
        return Verdict(shares.get(met.one.aspect.casefold(), 1.0), math.nan)
