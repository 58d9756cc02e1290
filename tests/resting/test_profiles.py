"""Reading measured profiles: what a column is taken for, and every fault with its line."""

from types import SimpleNamespace

import numpy as np
import pytest

from feederscrew.errors import FeederError
from feederscrew.resting import profiles

NAMES = ("A", "B", "C")


def parsed(text, names=NAMES):
    return profiles.measured(
        profiles.parse_count_sheet(text, "c.csv"), "c.csv", "", names, ("PMI", "CSA")
    ).profiles


def fault(text, names=NAMES):
    with pytest.raises(FeederError) as caught:
        parsed(text, names)
    return list(caught.value.lines)


def test_columns_come_in_the_order_of_the_aspects():
    first, second = parsed("# mine\naspect,x,y\nC,5,0.2\n# between\nA,60,0.5\n\nB,35,0.3\n")
    assert (first.name, first.kind, second.kind) == ("x", "counts", "fractions")
    np.testing.assert_array_equal(first.values, [60, 35, 5])
    np.testing.assert_allclose(first.fractions, [0.6, 0.35, 0.05], rtol=1e-15)
    np.testing.assert_array_equal(second.fractions, [0.5, 0.3, 0.2])


@pytest.mark.parametrize(
    ("column", "kind"),
    [
        (("60", "35", "5"), "counts"),
        (("0.6", "0.35", "0.05"), "fractions"),
        (("60.0", "35", "5"), "percent"),
        (("1", "0", "0"), "fractions"),
        (("2", "0", "0"), "counts"),
        (("1", "6", "92.9"), "percent"),
        (("0.6", "0.35", "0.046"), "fractions"),
        ((".6", "3.5e-1", "+0.05"), "fractions"),
    ],
)
def test_what_a_column_is_taken_for(column, kind):
    text = "aspect,x\n" + "".join(f"{name},{value}\n" for name, value in zip(NAMES, column))
    assert parsed(text)[0].kind == kind


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("", ["c.csv: is empty - give a header 'aspect,counts' and one row an aspect"]),
        ("# only\n", ["c.csv: is empty - give a header 'aspect,counts' and one row an aspect"]),
        ("aspect\nA\n", ["c.csv:1: has no profile - give a header 'aspect,counts' and one row an aspect"]),
        (
            "part,x\nA,1\n",
            [
                "c.csv:1: the first column is 'part', not aspect - "
                "give a header 'aspect,counts' and one row an aspect"
            ],
        ),
        ("aspect;x\nA;1\n", ["c.csv:1: the columns are not separated by commas - separate them by commas"]),
        ("#\naspect,x,x\n", ["c.csv:2: two columns are called 'x' - give each its own name"]),
        ("aspect,x,\n", ["c.csv:1: a column has no name - give each its own name"]),
        ("aspect,PMI\n", ["c.csv:1: column 'PMI' has the name of a rule - give it another name"]),
        ("aspect,x\nA,1\nB,2\nC,3\nF,4\n", ["c.csv:5: the part has no aspect 'F' - known are A, B, C"]),
        ("aspect,x\nA,1\nB,2\n", ["c.csv: has no row for aspect C - add it, 0 if never seen"]),
        ("aspect,x\nA,1\nB,2\nC,3\nA,4\n", ["c.csv:5: aspect 'A' is already in line 2 - keep one of them"]),
        (
            "aspect,x\nA,1,7\nB,2\nC,3\n",
            ["c.csv:2: has 2 values, the header names 1 - give one value a column"],
        ),
        (
            "aspect,x\nA,one\nB,-2\nC,1e999\n",
            [
                "c.csv:2: x: 'one' is not a number - write digits with a decimal point",
                "c.csv:3: x: '-2' is negative - give a number from 0",
                "c.csv:4: x: '1e999' is too large - give a number up to 1e+12",
            ],
        ),
        (
            'aspect,x\nA,"0,5"\nB,0.25\nC,0.25\n',
            ["c.csv:2: x: '0,5' is not a number - write digits with a decimal point"],
        ),
        (
            "aspect,x,y\nA,0.5,0\nB,0.3,0\nC,0.3,0\n",
            [
                "c.csv:1: column 'x' sums to 1.1 - "
                "give whole counts, fractions that sum to 1 or percents that sum to 100",
                "c.csv:1: column 'y' holds only zeros - give at least one count above 0",
            ],
        ),
        (
            "aspect,x\nA,nan\nB,0.5\nC,0.5\n",
            ["c.csv:2: x: 'nan' is not a number - write digits with a decimal point"],
        ),
    ],
)
def test_a_fault_is_told_with_its_line(text, lines):
    assert fault(text) == lines


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(FeederError, match=r"no.csv: no such file - check the path"):
        profiles.read_profile(tmp_path / "no.csv", NAMES)
    with pytest.raises(FeederError, match=r"cannot be read \(Is a directory\)"):
        profiles.read_profile(tmp_path, NAMES)


def test_bytes_that_are_no_text(tmp_path):
    (tmp_path / "c.csv").write_bytes(b"aspect,x\nA,\xff\n")
    with pytest.raises(FeederError, match=r"c.csv:2: byte 0xff is not UTF-8"):
        profiles.read_profile(tmp_path / "c.csv", NAMES)


def test_a_spreadsheets_file_reads_as_well(tmp_path):
    (tmp_path / "c.csv").write_bytes(b"\xef\xbb\xbfaspect,x\r\nA,1\r\nB,2\r\nC,3\r\n")
    found = profiles.read_profile(tmp_path / "c.csv", NAMES)
    np.testing.assert_array_equal(found.profiles[0].values, [1, 2, 3])
    assert len(found.sha256) == 64


def test_what_columns_are_taken_for_is_said(tmp_path):
    (tmp_path / "c.csv").write_text("aspect,n,p,q\nA,1,50.0,0.5\nB,2,25,0.25\nC,3,24.9,0.25\n")
    where = str(tmp_path / "c.csv")
    assert profiles.read_profile(where, NAMES).notes == (
        f"{where}: counts: n (sum 6)",
        f"{where}: fractions: q",
        f"{where}: percent: p (sum 99.9)",
    )


def test_a_rule_without_data_is_left_out():
    chances = {"pmi": np.array([0.4, 0.6, np.nan]), "csa": np.array([np.nan] * 3)}
    aspects = SimpleNamespace(probabilities=chances, stable=np.array([True, True, False]))
    (found,) = profiles.of_rules(aspects)
    assert (found.name, found.kind) == ("PMI", "rule")
    np.testing.assert_array_equal(found.fractions, [0.4, 0.6])


def test_of_a_drop_table_the_counts_are_taken():
    text = "aspect,height_mm,count,p_drop,p_drop_low\nA,1.5,30,0.75,0.6\nB,2.5,10,0.25,0.1\n"
    (found,) = profiles.measured(profiles.parse_count_sheet(text, "drop.csv"), "drop.csv", "", "BA").profiles
    assert (found.name, found.kind, found.values.tolist()) == ("count", "counts", [10.0, 30.0])


ORIENTED = "orientation,tray\nA@0,5\nA@90,3\nB@-180,2\nC@0,0\n"


def test_orientations_are_kept_and_summed_up_by_aspect(tmp_path):
    (tmp_path / "c.csv").write_text(ORIENTED)
    found = profiles.read_profile(tmp_path / "c.csv", NAMES)
    assert found.profiles[0].values.tolist() == [8.0, 2.0, 0.0] and found.profiles[0].counted
    assert [name for name, _ in found.lying] == ["A", "A", "B", "C"]
    np.testing.assert_allclose([turn for _, turn in found.lying], np.radians([0.0, 90.0, -180.0, 0.0]))
    assert found.by_orientation[:, 0].tolist() == [5.0, 3.0, 2.0, 0.0]


def test_an_orientation_that_is_none():
    assert fault(ORIENTED.replace("A@90", "A90").replace("B@-180", "F@0")) == [
        "c.csv:3: 'A90' is not an aspect at a heading - write it as feeder tooling does: A@180",
        "c.csv:4: the part has no aspect 'F' - known are A, B, C",
        "c.csv: has no row for aspect B - add it, 0 if never seen",
    ]


HEAD = "# part: a.stl\n# Mesh: sha256:0123ABCDef\n# launch: roll\n# Tossed: never\n# who: me\n"


def test_the_head_says_what_was_launched_how(tmp_path):
    (tmp_path / "c.csv").write_text(HEAD + "# centre of mass: 0,0,1\naspect,x\nA,1\n# when: now\nB,2\nC,3\n")
    head = profiles.read_profile(tmp_path / "c.csv", NAMES).head
    assert (head.part, head.mesh, head.launch, head.who) == ("a.stl", "0123abcdef", "roll", "me")
    assert head.reading == {"centre_of_mass": "0,0,1"} and head.when == ""


def test_a_head_that_cannot_be_understood():
    assert fault("# launch: rol\n# mesh: 12\n# who:\n# part: a\n# part: b\naspect,x\nA,1\nB,2\nC,3\n") == [
        "c.csv:1: there is no launch 'rol' - did you mean roll?",
        "c.csv:2: mesh: '12' is not a sha256 - give its hexadecimal digits, at least 8, as in run.json",
        "c.csv:3: who has no value - give one, or remove the line",
        "c.csv:5: part is given twice - keep one of them",
    ]


def test_of_many_faults_the_first_are_told():
    lines = fault("aspect,x\n" + "nobody,1\n" * 9000)
    assert len(lines) == 21
    assert lines[0] == "c.csv:2: the part has no aspect 'nobody' - known are A, B, C"
    assert lines[-2:] == [
        "c.csv:21: the part has no aspect 'nobody' - known are A, B, C",
        "c.csv: and 8981 more faults - mend these first",
    ]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("aspect,x\n" + "A,1\n" * 10_001, "c.csv: has more than 10000 rows - give one row an aspect"),
        ("aspect," + ",".join("x" * 300), "c.csv:1: has more than 200 columns - split the file"),
        ("aspect,x\nA," + "1" * 200_000, "c.csv:2: is not CSV (field larger than field limit (131072)) - "),
    ],
)
def test_a_file_has_limits(text, line):
    assert fault(text)[0].startswith(line)


def test_a_stream_without_an_end_is_refused_after_a_megabyte(tmp_path):
    line = "/dev/zero: has more than 1 MB - name a CSV file with one row an aspect"
    with pytest.raises(FeederError) as caught:
        profiles.read_profile("/dev/zero", NAMES)
    assert str(caught.value) == line
    (tmp_path / "c.csv").write_text("aspect,x\n" + "nobody,1\n" * 1_300_000)
    with pytest.raises(FeederError, match="has more than 1 MB"):
        profiles.read_profile(tmp_path / "c.csv", NAMES)
