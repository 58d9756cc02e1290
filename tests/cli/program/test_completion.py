"""What the shell completes: asked as bash asks it."""

import pytest
from click.testing import CliRunner

from feederscrew_cli.main import feeder


def completed(*words):
    """What the last of these words is completed to."""
    asked = {"_FEEDER_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": len(words) - 1}
    done = CliRunner().invoke(feeder, [], prog_name="feeder", env={k: str(v) for k, v in asked.items()})
    return [line.partition(",")[2] for line in done.stdout.splitlines() if line]


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (["slide", "--set", "drive.am"], ["drive.amplitude="]),
        (["batch", "--set", "grav"], ["gravity="]),
        (["convey", "--vary", "track.b"], ["track.bank="]),
        (["track", "--vary", "friction.wa"], ["friction.wall="]),
        (["rate", "--rule", "c"], ["csa", "crsa", "closed"]),
        (["batch", "--rule", "q"], ["quasistatic"]),
        (["aspects", "--density", "stainl"], ["stainless_steel", "stainless_steel_1.4401"]),
        (["slide", "--set", "nothing"], []),
    ],
    ids=str,
)
def test_values_are_completed(words, found):
    assert completed("feeder", *words) == found
