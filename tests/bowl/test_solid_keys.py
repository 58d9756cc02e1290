"""Keys that are words, and those of the bowl as a solid."""

import pytest

from feederscrew import bowl as bowls
from feederscrew.errors import FeederError


@pytest.mark.parametrize("text", ["left", " Left ", "LEFT"])
def test_a_word_is_read_however_it_is_written(text):
    assert bowls.record(bowls.settings(None, (f"track.hand={text}",))).sizing.hand == "left"


def test_another_word_is_refused():
    with pytest.raises(FeederError) as fault:
        bowls.settings(None, ("track.hand=up",))
    assert str(fault.value) == "overrides track.hand: 'up' is not known - write right or left"


def test_a_word_cannot_be_varied():
    with pytest.raises(FeederError) as fault:
        bowls.key_ranges(("track.hand=0:1:5",))
    assert str(fault.value) == "vary track.hand: is a word, not a number - set it to right or left"


def test_bolts_do_not_make_a_machine():
    plain, bolted = (bowls.record(bowls.settings(None, over)) for over in ((), ("machine.bolts=4",)))
    assert bolted.drive == plain.drive and bolted.sizing.bolts == 4
