"""What a part does on its track, in the words of tables and legends; documents keep the short names."""

PHASE_WORDS = {"stick": "sticks", "forward": "slips forward", "backward": "slips back", "flight": "flies"}
REGIME_WORDS = {"backward": "slips back only"}  # whose short name does not say that it is the part that slips


def regime_words(regime: str) -> str:
    """Return a regime as people read it: 'slips back only' for 'backward'."""
    return REGIME_WORDS.get(regime, regime)
