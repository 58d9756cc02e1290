"""Exact tumbling by class of aspect: columns, barriers and the tipping graph."""

import numpy as np
import pytest
import shapes

from feederscrew.errors import MeshError
from feederscrew.output import aspects as aspects_output
from feederscrew.output import tables, tipping_graph
from feederscrew.resting.aspects import find
from feederscrew.resting.exact_tumbling import exact, require_ground, transitions
from feederscrew.studies.aspects import AspectsStudy


def everything(mesh, **exponent):
    part = shapes.part(mesh)
    aspects = find(part)
    found = require_ground(part, aspects)
    return part, aspects, found, exact(found, part, aspects, **exponent)


def test_a_box_by_class():
    part, aspects, _, result = everything(shapes.box(10.0, 20.0, 30.0))
    share = aspects.faces * aspects.solid_angles / (4.0 * np.pi)
    assert result.probabilities["quasistatic"] == pytest.approx(share, rel=1e-9)
    assert all(p.sum() == pytest.approx(1.0) for p in result.probabilities.values())
    assert 1e3 * result.barriers == pytest.approx(
        [np.hypot(10, 20) / 2 - 5, np.hypot(10, 20) / 2 - 10, np.hypot(10, 30) / 2 - 15]
    )
    assert result.barrier_energies == pytest.approx(part.mass * 9.80665 * result.barriers)
    assert np.degrees(result.tip_angles) == pytest.approx(np.degrees(np.arctan([20 / 10, 10 / 20, 10 / 30])))
    assert not result.doubts


def test_the_surface_exponent_reaches_the_column():
    soft, hard = (everything(shapes.box(10, 20, 30), exponent=a)[3] for a in (0.0, 2.0))
    assert soft.probabilities["surface"] == pytest.approx(soft.probabilities["quasistatic"])
    assert hard.probabilities["surface"][0] > soft.probabilities["surface"][0]


@pytest.mark.parametrize("sections", [16, 64, 200])
def test_a_cylinder_rolls_and_stands(sections):
    _, aspects, found, result = everything(shapes.cylinder(5.0, 20.0, sections))
    ends = aspects.kinds.index("flat")
    assert result.probabilities["quasistatic"][ends] == pytest.approx(
        1 - 10 / np.hypot(10, 5), rel=1.5 / sections
    )
    assert 1e3 * result.barriers[ends] == pytest.approx(np.hypot(10, 5) - 10, rel=2.0 / sections)
    assert len(transitions(found)) == 2


def test_a_cube_tips_into_its_equals():
    _, _, found, result = everything(shapes.box(8.0, 8.0, 8.0))
    assert [(way.start, way.end) for way in transitions(found)] == [(0, 0)]
    assert 1e3 * result.barriers == pytest.approx([np.sqrt(32.0) - 4.0])


def test_the_graph_is_a_table(rng):
    part, aspects, _, result = everything(shapes.box(10.0, 20.0, 30.0))
    study = AspectsStudy(part, aspects)
    frame = tipping_graph.transitions(study)
    assert list(frame) == ["from", "to", "barrier_mm", "barrier_uJ", "axis_x", "axis_y", "axis_z"]
    assert list(zip(frame["from"], frame["to"])) == [(a, b) for a in "ABC" for b in "ABC" if a != b]
    assert np.hypot(np.hypot(frame["axis_x"], frame["axis_y"]), frame["axis_z"]) == pytest.approx(1.0)
    assert tables.data_frame(frame).groupby("from")["barrier_mm"].min().to_numpy() == pytest.approx(
        1e3 * result.barriers
    )
    assert aspects_output.aspects(study)["tip_angle_deg"][0] == pytest.approx(np.degrees(np.arctan(2.0)))


def test_no_arrow_of_the_graph_ends_under_a_disc():
    from feederscrew.output import tipping_graph

    _, aspects, found, _ = everything(shapes.box(10.0, 20.0, 30.0))
    axes = tipping_graph.graph("box", aspects.names, transitions(found), np.array([1.0, 0.0, 0.0])).axes[0]
    discs = {tuple(disc.get_offsets()[0]): np.sqrt(disc.get_sizes()[0]) / 2.0 for disc in axes.collections}
    arrows = [text for text in axes.texts if getattr(text, "arrow_patch", None)]
    assert len(arrows) == 6
    for arrow in arrows:
        assert arrow.arrow_patch.shrinkA > discs[tuple(arrow.xyann)]
        assert arrow.arrow_patch.shrinkB > discs[tuple(arrow.xy)]


def test_noise_and_turning_change_little(rng):
    box = shapes.box(10.0, 20.0, 30.0)
    clean = everything(box)[3]
    for mesh in (shapes.turned(box, rng), shapes.noisy(box.subdivide(), 2e-3, rng)):
        result = everything(mesh)[3]
        for rule, p in clean.probabilities.items():
            assert result.probabilities[rule] == pytest.approx(p, abs=0.01), rule


def assert_alike(first, second, scale):
    """Classes, probabilities, barriers and the graph of a part are those of another, scaled."""
    (_, aspects, found, result), (_, others, beside, again) = first, second
    assert (others.names, others.kinds) == (aspects.names, aspects.kinds)
    assert others.faces.tolist() == aspects.faces.tolist()
    for rule, p in result.probabilities.items():
        assert again.probabilities[rule] == pytest.approx(p, rel=1e-6), rule
    assert again.barriers == pytest.approx(scale * result.barriers, rel=1e-6)
    assert again.barrier_energies == pytest.approx(scale**4 * result.barrier_energies, rel=1e-6)
    assert again.tip_angles == pytest.approx(result.tip_angles, rel=1e-6)
    ways = [{(way.start, way.end): way.lift for way in transitions(one)} for one in (found, beside)]
    assert ways[1] == pytest.approx({pair: scale * lift for pair, lift in ways[0].items()}, rel=1e-6)


def test_a_heavy_bottom_takes_the_sides_that_a_micrometre_holds():
    """Sides with the foot 0.1 mm from their edge have a barrier of 1 um: the part rolls off them."""
    part = shapes.part(shapes.box(10.0, 10.0, 10.0))
    object.__setattr__(part, "centre_of_mass", np.array([0.0, 0.0, -4.9e-3]))
    aspects = find(part)
    assert aspects.faces.tolist() == [1, 1]
    top = np.arcsin(10.0**2 / (10.0**2 + 4 * 9.9**2)) / np.pi  # its solid angle from 9.9 mm, over the sphere
    assert aspects.probabilities["quasistatic"] == pytest.approx([1.0 - top, top], rel=1e-9)


def test_a_card_has_no_shape():
    from feederscrew.thesis import parts

    card = parts.card("magnet")
    with pytest.raises(MeshError, match=r"is a part card, it has no shape to tumble - give a mesh file$"):
        require_ground(card, find(card))
