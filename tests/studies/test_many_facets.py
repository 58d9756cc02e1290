"""One limit of facets, and one line, for every study that follows a part's true surface past devices."""

from dataclasses import replace

import pytest
import trimesh

import feederscrew as feeder
from feederscrew import bowl as bowls
from feederscrew.errors import FeederError
from feederscrew.part.record import MAX_FACETS
from feederscrew.studies.passages import passages
from feederscrew.studies.rate import rate
from feederscrew.studies.tooling import tooling
from feederscrew.tooling.devices.blades import Wiper


@pytest.fixture(scope="module")
def part(tmp_path_factory):
    mesh = trimesh.creation.icosphere(subdivisions=5)
    mesh.apply_scale([6.0, 5.0, 4.0])
    path = tmp_path_factory.mktemp("many") / "many.stl"
    mesh.export(path)
    return feeder.load(path)


BOWL = replace(bowls.default(), devices=(Wiper("bowl.yaml:1", limit=5e-3),))


@pytest.mark.parametrize(
    "study",
    [
        lambda part: tooling(part, BOWL, rule="csa"),
        lambda part: rate(part, BOWL, rule="csa"),
        lambda part: passages(part, BOWL, feeder.aspects(part, drops=0).aspects, "csa"),
        lambda part: feeder.design(part, "30/min"),
        lambda part: feeder.trial(part, BOWL, "A"),
    ],
    ids=["tooling", "rate", "passages", "design", "trial"],
)
def test_a_part_of_very_many_facets_is_refused_by_one_line(part, study):
    assert len(part.faces) > MAX_FACETS
    with pytest.raises(FeederError) as fault:
        study(part)
    assert fault.value.what == f"has {len(part.faces)} facets, too many to follow on the track"
    assert str(MAX_FACETS) in fault.value.mend


def test_a_rate_without_devices_takes_it(part):
    assert rate(part, bowls.default(), rule="csa").parts.value >= 0.0
