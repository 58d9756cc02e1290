"""Gates with an opening: profile."""

from feederscrew import value_forms as forms
from feederscrew.tooling.devices import named, values
from feederscrew.tooling.devices.base import STOPPED, Device, corners_text, length_text, mapping_text

MAX_OPENING_HEIGHT_M = 1.0  # [m] no opening is higher


class Profile(Device):
    """A gate across the track with an opening."""

    kind = "profile"
    trade = "profile gate"
    form = forms.either(forms.POLYGON, forms.mapping(of=forms.NAMED, play=forms.LENGTH_FORM))
    example = "{of: A@90, play: 0.2 mm}"
    meaning = (
        "gate with an opening: a polygon of distances from the wall and heights, or an orientation's own "
        "outline with play; what does not fit stops before it: for parts that come one by one"
    )
    feature = "outline seen along the track"
    picture = "ahead"

    @classmethod
    def read(cls, entry):
        return values.opening(entry)

    def value_text(self):
        if not self.like:
            return corners_text(self.corners)
        aspect, heading, play = self.like
        return mapping_text((("of", named.written(aspect, heading)), ("play", length_text(play))))

    @property
    def across(self):
        return 0.0

    def opening(self, every, width):
        import shapely

        free = self.free(every)
        return free.intersection(shapely.box(0.0, 0.0, width, MAX_OPENING_HEIGHT_M)) if self.like else free

    def free(self, every):
        """Return the opening however wide the track is, in distances from the wall and heights [m]."""
        import shapely

        if not self.like:
            return shapely.Polygon(self.corners)
        aspect, heading, play = self.like
        return every[named.place_of(every, aspect, heading, self.where, "profile names")].seen.buffer(play)

    def fate(self, met):
        return STOPPED

    def judged(self, met):
        return met.verdict(met.through(self.free(met.every)))
