"""A name that the part or the program does not have is refused: it must not read as 'cannot be fed'."""

import pytest
import shapes

from feederscrew import bowl as bowls
from feederscrew.designing import loop
from feederscrew.designing.record import DesignRequest
from feederscrew.errors import FeederError

CUBE = shapes.part(shapes.box(10, 10, 10))


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"aspect": "Q"}, "there is no aspect 'Q' - choose one of A"),
        ({"aspect": ""}, "there is no aspect '' - choose one of A"),
        ({"up": "A,Q"}, "has no aspect 'Q' - choose one of A"),
        ({"without": "wipr"}, "unknown device 'wipr'"),
        ({"aspect": "a", "heading": 0.7}, "has no stable heading"),
    ],
)
def test_design_refuses_it_before_anything_is_tried(asked, said):
    tried = []
    with pytest.raises(FeederError) as fault:
        loop.design(CUBE, bowls.default(), frozenset(), DesignRequest(0.5, **asked), tell=tried.append)
    assert said in str(fault.value) and not tried


@pytest.mark.parametrize(
    "line",
    [
        ("design", "--target", "30/min"),
        ("tooling",),
        ("rate",),
        ("trial", "--parts", "1"),
        ("tune", "--target", "30/min"),
    ],
)
def test_every_command_refuses_an_aspect_alike(line, run):
    shapes.box(10, 10, 10).export("cube.stl")
    command, *more = line
    done = run(command, "cube.stl", *more, "--aspect", "Q", "--rule", "csa")
    assert done.exit_code == 2 and done.stdout == ""
    assert (
        done.stderr.splitlines()[-1]
        == "Error: --aspect of cube.stl: there is no aspect 'Q' - choose one of A"
    )
