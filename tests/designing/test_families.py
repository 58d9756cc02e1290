"""Several parts for one bowl: one chain where one suits all, else what is changed."""

import re
from dataclasses import replace
from types import SimpleNamespace

import pytest
import shapes
from design_counts import design_study

from feederscrew import bowl as bowls
from feederscrew.base.errors import FeederError
from feederscrew.bowl.devices.kinds import make_device
from feederscrew.designing import families
from feederscrew.designing.record import DesignRequest
from feederscrew.output import design_pages
from feederscrew.sorting.isolating.chain import Cut

SMALL, LARGE = shapes.part(shapes.box(10, 8, 4), "small"), shapes.part(shapes.box(14, 11, 6), "large")
BOWL = bowls.default()


def cut(kind, *values):
    """A device of a design whose value [mm] may lie between two others."""
    first, least, most = (make_device(kind, "design", limit=1e-3 * one, text=f"{one:g} mm") for one in values)
    return Cut(first, 5e-4, 5e-4, least, most, ())


def design(part, *cuts, bowl=BOWL, held=20, **more):
    own = replace(bowl, devices=tuple(one.device for one in cuts))
    return design_study(part, target=30.0, bowl=own, cuts=cuts, held=held, **more)


@pytest.mark.parametrize(("windows", "common"), [
    (((4.0, 3.0, 5.0), (4.5, 3.5, 6.0)), [4e-3]),  # the first one's own
    (((4.0, 3.0, 5.0), (4.5, 4.2, 6.0)), [4.5e-3]),  # the second one's
    (((4.0, 3.0, 5.0), (5.5, 4.6, 6.0)), [4.8e-3]),  # the middle of 4.6 to 5
    (((4.0, 5.0, 3.0), (5.5, 6.0, 4.6)), [4.8e-3]),  # ends the other way round
    (((4.0, 3.0, 5.0), (5.5, 5.1, 6.0)), None),
])  # fmt: skip
def test_a_value_suits_all_where_their_windows_meet(windows, common):
    found = families.common_limits([[cut("gap", *one)] for one in windows])
    assert found == (common if common is None else pytest.approx(common))


def test_what_has_no_number_is_common_only_where_it_is_the_same():
    first, second = (
        make_device("spacing section", "design", text=f"{{climb: {deg} deg}}") for deg in (-6, -9)
    )
    one, other = (Cut(device, 0.0, 0.0, device, device, ()) for device in (first, second))
    assert families.common_limits([[one], [one]]) == [None]
    assert families.common_limits([[one], [other]]) is None


def test_one_track_and_one_chain_are_shared_whatever_the_drive():
    gap = cut("gap", 4.0, 3.0, 5.0)

    def shared_with(held=20, **other):
        pair = design(SMALL, gap), design(LARGE, gap, bowl=replace(BOWL, **other), held=held)
        study = families.FamilyStudy(pair)
        (row,) = design_pages.family_document(study)["changeover"]
        return study.shared, study.status, row["what"], row["how"], set(row["values"])

    slow = replace(BOWL.drive, amplitude=0.5 * BOWL.drive.amplitude)
    wide = replace(BOWL.track, width=1.5 * BOWL.track.width)
    assert shared_with(drive=slow) == (True, "holds", "drive.amplitude", "set", {"small", "large"})
    assert shared_with(10, track=wide)[:3] == (False, "falls short", "track.width")


def test_what_is_swapped_is_listed_device_by_device_and_on_the_page():
    gap, other = cut("gap", 4.0, 3.0, 5.0), (cut("gap", 6.0, 5.5, 7.0), cut("canyon", 9.0, 8.0, 10.0))
    first = design(SMALL, gap)
    second = design(LARGE, *other, held=10, machine_warnings=("it strikes",))
    study = families.FamilyStudy((first, second))
    assert design_pages.changeover(study) == {
        "what": ["gap 1", "canyon 1"], "how": ["swapped", "swapped"], "small": ["4 mm", "-"],
        "large": ["6 mm", "9 mm"],
    }  # fmt: skip
    assert not study.shared
    said = dict(zip(*design_pages.family_summary(study).values(), strict=True))
    assert said["one bowl for all"] == "no" and said["swapped: gap 1"] == "4 mm; 6 mm"
    assert "leaf-spring drive" in said["machine of large"]
    page = design_pages.family_page(study)
    for text in (
        "one bowl for several parts: falls short", "do not share one chain", "gap 1", "swapped", "4 mm",
        "6 mm", "large: it strikes",
    ):  # fmt: skip
        assert text in page
    assert page.partition("<footer>")[0].lower().count("throw number") == 2
    # each part can be turned, and each name is of its part
    for name in ("small", "large"):
        assert f'id="opening-{name}"' in page and re.search(rf'class="pose [^>]*>A@\d+ of {name}<', page)
    same = design_pages.family_page(families.FamilyStudy((first, replace(first, part=LARGE))))
    assert "Nothing is changed from one part to the next." in same
    assert "One track and one chain of devices suit all parts" in same


def test_the_widest_is_designed_first_and_its_kinds_are_offered_to_the_others(monkeypatch):
    gap, other = cut("gap", 4.0, 3.0, 5.0), cut("gap", 4.5, 4.2, 6.0)
    asked, tried, known = [], [], SimpleNamespace(orientations=())
    results = [replace(design(*one), tooling=known) for one in ((LARGE, other), (SMALL, gap))]

    def search(part, plain, given, request, **more):
        asked.append((part.name, plain.track, set(given), request.without))
        return results.pop(0)

    def again(study, cuts, *more, **named):
        tried.append((study.part.name, [one.device.limit for one in cuts]))
        return replace(study, cuts=tuple(cuts), bowl=replace(study.bowl, devices=(cuts[0].device,)))

    def moved(one, limit, every, row):
        return replace(one, device=make_device("gap", "design", limit=limit, text=f"{1e3 * limit:g} mm"))

    monkeypatch.setattr(families.loop, "design", search)
    monkeypatch.setattr(families, "prove_with_cuts", again)
    monkeypatch.setattr(families.proposals, "move_cut", moved)
    study = families.family([SMALL, LARGE], BOWL, {"drive.phase"}, DesignRequest(0.5, without=("wiper",)))
    (first, common, given, _), (second, track, more, without) = asked
    assert (first, second) == ("large", "small") and given == {"drive.phase", "track.radius", "track.width"}
    assert common.width > 14e-3 and track == BOWL.track  # that of the first one's design
    assert more == given | {"track.bank", "track.climb"}
    assert "gap" not in without and {"wiper", "canyon", "vision reject"} <= set(without)
    assert study.shared and [one.part.name for one in study.members] == ["small", "large"]
    assert tried == [("small", pytest.approx([4.5e-3]))]  # the other one holds at that value already


def test_parts_of_one_name_are_refused():
    for names in ((SMALL, SMALL), (SMALL, replace(LARGE, name="Family"))):
        with pytest.raises(FeederError, match=r"results would be overwritten - rename a file$"):
            families.check_names(names)
