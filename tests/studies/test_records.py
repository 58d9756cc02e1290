"""What the library hands over: a short text, the table and the picture of the command; faults by argument."""

import json

import pytest
import shapes

import feederscrew as fs
from feederscrew.output import tables

BOWL = fs.read_bowl(None, ("track.width=40 mm", "drive.amplitude=0.05 mm"))


@pytest.fixture(scope="module")
def part():
    return shapes.part(shapes.box(8.0, 12.0, 20.0))


STUDIES = {  # function: its record, and the pictures by name
    "aspects": (lambda part: fs.aspects(part, drops=0), ["probabilities"]),
    "inertia": (fs.inertia, []),
    "drop": (lambda part: fs.drop(part, drops=20), ["drop"]),
    "slide": (lambda _: fs.slide(BOWL, ["20 deg"]), ["slide_curves"]),
    "convey": (lambda _: fs.convey(BOWL), ["convey"]),
    "floor": (lambda part: fs.floor(part, BOWL, heading="10 deg"), ["floor_plan", "floor_heading"]),
    "track": (lambda part: fs.track(part, BOWL, "A"), ["track_part", "track_cycle"]),
    "headings": (lambda part: fs.headings(part, BOWL), ["headings_A"]),
}


@pytest.mark.parametrize("name", STUDIES)
def test_a_record_is_short_has_a_table_and_its_pictures(part, name):
    make, pictures = STUDIES[name]
    record = make(part)
    assert len(repr(record)) <= 400 and "\n" not in repr(record)
    frame = record.to_frame()
    assert len(frame) >= 1 and len(frame.columns) >= 2
    for picture in pictures:
        assert record.plot(picture).get_axes(), picture
    with pytest.raises(fs.FeederError, match=f"^name: {type(record).__name__} has no picture 'pie'"):
        record.plot("pie")
    with pytest.raises(fs.FeederError, match="has no table 'pie'"):
        record.to_frame("pie")


def test_a_table_is_the_file_of_its_command(run, tmp_path):
    shapes_file = tmp_path / "box.stl"
    shapes.box(8.0, 12.0, 20.0).export(shapes_file)
    drive = ("--set", "track.width=40 mm", "--set", "drive.amplitude=0.05 mm")
    said = run("headings", shapes_file, *drive, "--format", "csv", "-q").stdout
    table = fs.headings(fs.load(shapes_file), BOWL).to_frame()
    assert tables.text(tables.frame(dict(table)), "csv") == said
    told = json.loads(run("inertia", shapes_file, "--format", "json", "-q").stdout)
    assert told["mass_g"] == pytest.approx(1e3 * fs.load(shapes_file).mass)


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (
            lambda part: fs.load("x.stl", density=7.8),
            "density: is 7.8 kg/m3 - give kg/m3, 7850 for steel, or a text, '7.85 g/cm3'",
        ),
        (lambda part: fs.load(part), "source: is a Part - give the path of a file"),
        (lambda part: fs.load(3), "source: is 3 - give the path of a file"),
        (lambda part: fs.convey(None), "bowl: is None - give a Bowl, as read_bowl returns it"),
        (lambda part: fs.rate(BOWL, part), "part: is a Bowl - give a Part, as load returns it"),
        (lambda part: fs.aspects("x"), "part: is 'x' - give a Part, as load returns it"),
        (
            lambda part: fs.shake(part, None),
            "bowls: is None - give a Bowl, as read_bowl returns it, or several in a list",
        ),
        (lambda part: fs.shake(part, []), "bowls: is empty - give a Bowl, as read_bowl returns it"),
        (lambda part: fs.drop(part, drops=2.5), "drops: is 2.5 - give a whole number"),
        (
            lambda part: fs.rate(part, BOWL, "A", gap="2 s"),
            "gap: '2 s' is a time, not a length - give it in mm",
        ),
        (
            lambda part: fs.rate(part, BOWL, "A", aspect_shares=3),
            "aspect_shares: is 3 - give what shares returned",
        ),
        (lambda part: fs.tune(part, BOWL, "A", "60"), "target: '60' has no unit - write 60 /min"),
        (
            lambda part: fs.posture(part, 3, "A"),
            "aspects: is 3 - give Aspects, as find_aspects returns them",
        ),
        (lambda part: fs.size_bowl(part, "60/min", path=3), "path: is 3 - give the path of a file"),
    ],
)
def test_a_fault_names_the_argument(part, call, line):
    with pytest.raises(fs.FeederError) as caught:
        call(part)
    assert str(caught.value) == line
