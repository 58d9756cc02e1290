"""What the sliding pictures show: labels, units, drawn data, the bowl's own point; the same bytes twice."""

import math

import numpy as np
import pytest
from matplotlib.colors import to_rgba_array

from feederscrew import bowl
from feederscrew.mechanics.limits import published_ratio
from feederscrew.output import slide as slide_output
from feederscrew.output import style
from feederscrew.output.tables import regime_words
from feederscrew.studies.slide import sliding_map

SMALL = (61, 51)  # cells, for speed


def slide(beta=20, *overrides):
    return sliding_map(bowl.read(None, overrides), math.radians(beta), shape=SMALL)


def texts(figure):
    """Every text of a figure that is not a tick."""
    axes = figure.axes[0]
    found = [t.get_text() for t in axes.texts]
    legends = [axes.get_legend(), *figure.legends]
    return found + [t.get_text() for legend in legends if legend for t in legend.get_texts()]


def own_point(axes):
    (marker,) = [line for line in axes.lines if line.get_marker() == "o"]
    return marker.get_xydata()[0]


def test_maps_name_their_axes_and_their_angle():
    for draw in (slide_output.contours, slide_output.regimes):
        axes = draw(slide()).axes[0]
        assert axes.get_xlabel() == "α − θ, from heading to drive [deg]"
        assert axes.get_ylabel() == "acceleration ratio G = A ω² / g [1]"
        assert axes.get_title(loc="left").endswith("β = 20°")
        assert (axes.get_xlim(), axes.get_ylim()) == ((-90, 90), (0, 4))


def test_the_own_point_is_marked_where_the_bowl_works():
    one = slide(20, "drive.amplitude=0.05 mm", "drive.frequency=60 Hz", "drive.direction=25 deg")
    for draw in (slide_output.contours, slide_output.regimes):
        figure = draw(one)
        assert own_point(figure.axes[0]) == pytest.approx([25, one.ratio])
        assert "this bowl, G = 0.724" in texts(figure)


def test_the_regime_map_shows_its_codes_and_names_them():
    one = slide(20)
    figure = slide_output.regimes(one)
    (image,) = figure.axes[0].images
    colours = 255.0 * to_rgba_array([slide_output.SLIDE_COLOURS[name] for name in one.grid.names])
    assert (np.asarray(image.get_array()) == np.round(colours)[one.grid.codes.T]).all()
    named = texts(figure)
    for name, share in one.grid.shares().items():
        label = "no friction prevents forward slip (part hops)" if name == "hop" else regime_words(name)
        assert (label in [text.replace("\n", " ") for text in named]) == (share > 0), name


def test_the_hop_begins_at_its_ratio():
    for draw, start in ((slide_output.regimes, math.cos(math.radians(3))), (slide_output.contours, 1.0)):
        heights = [line.get_ydata()[0] for line in draw(slide(20)).axes[0].lines if line.get_marker() != "o"]
        assert heights == pytest.approx([start / math.sin(math.radians(20))])


def test_contour_lines_follow_4_27_and_carry_their_values():
    figure = slide_output.contours(
        sliding_map(bowl.default(), math.radians(20), shape=slide_output.MAP_SHAPE)
    )
    axes = figure.axes[0]
    assert {"μ = 0.1", "μ = 1", "μ = 2", "this bowl's μ = 0.6"} <= set(texts(figure))
    assert "μ = 0.6" not in texts(figure)
    (drawn,) = (collection for collection in axes.collections if hasattr(collection, "levels"))
    paths = [path for path in drawn.get_paths() if len(path.vertices)]
    angle, ratio = paths[list(drawn.levels).index(1.0)].vertices.T
    inner = np.abs(angle) < 60
    expected = published_ratio(1.0, math.radians(20), np.radians(angle[inner]))
    assert ratio[inner] == pytest.approx(expected, rel=1e-3)


def test_the_surface_is_cut_and_carries_the_bowls_friction():
    figure = slide_output.surface(slide(20))
    axes = figure.axes[0]
    assert axes.get_zlabel() == "limiting friction μ [1]"
    assert axes.get_zlim() == (0, 2)
    assert any("static friction of this bowl, 0.6" in text for text in texts(figure))
    _, _, height = axes.lines[0].get_data_3d()
    assert set(height) == {0.6}


def test_curves_are_4_28_for_each_angle():
    one, two = slide(10), slide(40)
    figure = slide_output.curves([one, two])
    axes, labels = figure.axes[0], [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["β = 10°", "β = 40°", "slips back, this track", slide_output.OWN_LABEL]
    line = next(line for line in axes.lines if line.get_label() == "β = 40°")
    ratio, friction = line.get_xydata()[np.isfinite(line.get_ydata())].T
    b = math.radians(40)
    assert friction == pytest.approx(ratio * math.cos(b) / (1 - ratio * math.sin(b)), rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("beta", [0, 1, 90])
def test_extreme_angles_draw_without_a_warning(beta):
    one = slide(beta, "friction.static=0", "drive.amplitude=0 mm")
    for draw in (slide_output.surface, slide_output.contours, slide_output.regimes):
        assert style.png(draw(one))[:4] == b"\x89PNG"
    assert style.png(slide_output.curves([one]))[:4] == b"\x89PNG"
