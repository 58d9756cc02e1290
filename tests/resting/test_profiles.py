"""Measured profiles: what a column is taken for, each fault with its line, and distances between profiles."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from feederscrew.base.errors import FeederError
from feederscrew.resting import deviation as measure
from feederscrew.resting import profiles
from feederscrew.resting.profiles import AspectProfile

NAMES = ("A", "B", "C")
ROWS = "A,1\nB,2\nC,3\n"
HEADER = "give a header 'aspect,counts' and one row an aspect"
DIGITS = "write digits with a decimal point"
ORIENTED = "orientation,tray\nA@0,5\nA@90,3\nB@-180,2\nC@0,0\n"
NO_F = "the part has no aspect 'F' - known are A, B, C"
NOBODY = "the part has no aspect 'nobody' - known are A, B, C"
FAULTS = [
    ("", [f"c.csv: is empty - {HEADER}"]),
    ("# only\n", [f"c.csv: is empty - {HEADER}"]),
    ("aspect\nA\n", [f"c.csv:1: has no profile - {HEADER}"]),
    ("part,x\nA,1\n", [f"c.csv:1: the first column is 'part', not aspect - {HEADER}"]),
    ("aspect;x\nA;1\n", ["c.csv:1: the columns are not separated by commas - separate them by commas"]),
    ("#\naspect,x,x\n", ["c.csv:2: two columns are called 'x' - give each its own name"]),
    ("aspect,x,\n", ["c.csv:1: a column has no name - give each its own name"]),
    ("aspect,PMI\n", ["c.csv:1: column 'PMI' has the name of a rule - give it another name"]),
    (f"aspect,x\n{ROWS}F,4\n", [f"c.csv:5: {NO_F}"]),
    ("aspect,x\nA,1\nB,2\n", ["c.csv: has no row for aspect C - add it, 0 if never seen"]),
    (f"aspect,x\n{ROWS}A,4\n", ["c.csv:5: aspect 'A' is already in line 2 - keep one of them"]),
    ("aspect,x\nA,1,7\nB,2\nC,3\n", [
        "c.csv:2: has 2 values, the header names 1 - give one value a column"]),
    ("aspect,x\nA,one\nB,-2\nC,1e999\n", [
        f"c.csv:2: x: 'one' is not a number - {DIGITS}",
        "c.csv:3: x: '-2' is negative - give a number from 0",
        "c.csv:4: x: '1e999' is too large - give a number up to 1e+12"]),
    ('aspect,x\nA,"0,5"\nB,0.25\nC,0.25\n', [f"c.csv:2: x: '0,5' is not a number - {DIGITS}"]),
    ("aspect,x,y\nA,0.5,0\nB,0.3,0\nC,0.3,0\n", [
        "c.csv:1: column 'x' sums to 1.1 - "
        "give whole counts, fractions that sum to 1 or percents that sum to 100",
        "c.csv:1: column 'y' holds only zeros - give at least one count above 0"]),
    ("aspect,x\nA,nan\nB,0.5\nC,0.5\n", [f"c.csv:2: x: 'nan' is not a number - {DIGITS}"]),
    (ORIENTED.replace("A@90", "A90").replace("B@-180", "F@0"), [
        "c.csv:3: 'A90' is not an aspect at a heading - write it as feeder tooling does: A@180",
        f"c.csv:4: {NO_F}",
        "c.csv: has no row for aspect B - add it, 0 if never seen"]),
    (f"# launch: rol\n# mesh: 12\n# who:\n# part: a\n# part: b\naspect,x\n{ROWS}", [
        "c.csv:1: there is no launch 'rol' - did you mean roll?",
        "c.csv:2: mesh: '12' is not a sha256 - give its hexadecimal digits, at least 8, as in run.json",
        "c.csv:3: who has no value - give one, or remove the line",
        "c.csv:5: part is given twice - keep one of them"]),
    ("aspect,x\n" + "nobody,1\n" * 9000, [
        *(f"c.csv:{line}: {NOBODY}" for line in range(2, 22)),
        "c.csv: and 8981 more faults - mend these first"]),
    ("aspect,x\n" + "A,1\n" * 10_001, ["c.csv: has more than 10000 rows - give one row an aspect"]),
    ("aspect," + ",".join("x" * 300), ["c.csv:1: has more than 200 columns - split the file"]),
    ("aspect,x\nA," + "1" * 200_000, [
        "c.csv:2: is not CSV (field larger than field limit (131072)) - give a header 'aspect,counts' and "
        "one row an aspect"]),
]  # fmt: skip
SHARES = st.lists(st.floats(0.0, 1.0), min_size=2, max_size=8).filter(lambda p: sum(p) > 0.1)
FIRST, SECOND, FRACTIONS = np.array([30, 50, 20]), np.array([60, 70, 30]), np.array([0.25, 0.5, 0.25])
HOMOGENEITY = stats.chi2_contingency([FIRST, SECOND], correction=False)
FEW = stats.chisquare([60, 30, 10], [60, 33, 7])  # few expected are joined, the weakest first


def parsed(text, names=NAMES):
    sheet = profiles.parse_count_sheet(text, "c.csv")
    return profiles.parse_profiles(sheet, "c.csv", "", names, ("PMI", "CSA")).profiles


@pytest.fixture
def read(tmp_path):
    def call(text):
        (tmp_path / "c.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
        return profiles.read_profile(tmp_path / "c.csv", NAMES)

    return call


def test_columns_of_counts_and_rules():
    first, second = parsed("# mine\naspect,x,y\nC,5,0.2\n# between\nA,60,0.5\n\nB,35,0.3\n")
    assert (first.name, first.kind, second.kind) == ("x", "counts", "fractions")
    np.testing.assert_array_equal(first.values, [60, 35, 5])
    np.testing.assert_allclose(first.fractions, [0.6, 0.35, 0.05], rtol=1e-15)
    np.testing.assert_array_equal(second.fractions, [0.5, 0.3, 0.2])
    text = "aspect,height_mm,count,p_drop,p_drop_low\nA,1.5,30,0.75,0.6\nB,2.5,10,0.25,0.1\n"
    (counts,) = parsed(text, "BA")
    assert (counts.name, counts.kind, counts.values.tolist()) == ("count", "counts", [10.0, 30.0])
    chances = {"pmi": np.array([0.4, 0.6, np.nan]), "csa": np.array([np.nan] * 3)}
    stable = np.array([True, True, False])
    (rule,) = profiles.rule_profiles(SimpleNamespace(probabilities=chances, stable=stable))
    assert (rule.name, rule.kind, rule.fractions.tolist()) == ("PMI", "rule", [0.4, 0.6])


@pytest.mark.parametrize(
    ("column", "kind"),
    [
        ("60 35 5", "counts"), ("2 0 0", "counts"), ("60.0 35 5", "percent"), ("1 6 92.9", "percent"),
        ("0.6 0.35 0.05", "fractions"), ("1 0 0", "fractions"), ("0.6 0.35 0.046", "fractions"),
        (".6 3.5e-1 +0.05", "fractions"),
    ],
)  # fmt: skip
def test_what_a_column_is_taken_for(column, kind):
    rows = (f"{name},{value}\n" for name, value in zip(NAMES, column.split()))
    assert parsed("aspect,x\n" + "".join(rows))[0].kind == kind


@pytest.mark.parametrize("number", range(len(FAULTS)))
def test_a_fault_is_told_with_its_line(number):
    text, lines = FAULTS[number]
    with pytest.raises(FeederError) as caught:
        parsed(text)
    assert list(caught.value.lines) == lines


def test_files_that_cannot_be_read(tmp_path, read):
    large = "has more than 1 MB - name a CSV file with one row an aspect"
    missing = "no.csv: no such file - check the path"
    for name, words in (("no.csv", missing), (".", "(Is a directory)"), ("/dev/zero", large)):
        with pytest.raises(FeederError) as caught:
            profiles.read_profile(tmp_path / name, NAMES)
        assert words in str(caught.value)
    with pytest.raises(FeederError, match=r"c.csv:2: byte 0xff is not UTF-8"):
        read(b"aspect,x\nA,\xff\n")
    with pytest.raises(FeederError, match="has more than 1 MB"):
        read("aspect,x\n" + "nobody,1\n" * 1_300_000)
    # What is read of a file.
    profile = read(b"\xef\xbb\xbfaspect,x\r\nA,1\r\nB,2\r\nC,3\r\n")
    np.testing.assert_array_equal(profile.profiles[0].values, [1, 2, 3])
    assert len(profile.sha256) == 64
    where = tmp_path / "c.csv"
    assert read("aspect,n,p,q\nA,1,50.0,0.5\nB,2,25,0.25\nC,3,24.9,0.25\n").notes == (
        f"{where}: counts: n (sum 6)", f"{where}: fractions: q", f"{where}: percent: p (sum 99.9)",
    )  # fmt: skip
    sheet = read(ORIENTED)
    assert sheet.profiles[0].values.tolist() == [8.0, 2.0, 0.0] and sheet.profiles[0].has_counts
    assert [name for name, _ in sheet.orientations] == ["A", "A", "B", "C"]
    np.testing.assert_allclose([turn for _, turn in sheet.orientations], np.radians([0.0, 90.0, -180.0, 0.0]))
    assert sheet.by_orientation[:, 0].tolist() == [5.0, 3.0, 2.0, 0.0]
    head = "# part: a.stl\n# Mesh: sha256:0123ABCDef\n# launch: roll\n# Tossed: never\n# who: me\n"
    head = read(head + "# centre of mass: 0,0,1\naspect,x\nA,1\n# when: now\nB,2\nC,3\n").head
    assert (head.part, head.mesh, head.launch, head.who) == ("a.stl", "0123abcdef", "roll", "me")
    assert head.reading == {"centre_of_mass": "0,0,1"} and head.when == ""


def test_distances_by_hand():
    """Eq. [Table 3-12]."""
    assert measure.deviation([0.5, 0.5], [0.2, 0.8]) == pytest.approx(0.3, rel=1e-15)
    assert measure.deviation([1, 0, 0], [0, 1, 0]) == pytest.approx(np.sqrt(2 / 3), rel=1e-15)
    fit, between = measure.chi_square, measure.chi_square_between
    assert fit([30, 0, 70], [0.4, 0.0, 0.6]) == fit([30, 70], [0.4, 0.6])
    assert between([30, 0, 70], [40, 0, 60]) == between([30, 70], [40, 60])


@given(SHARES, st.randoms(use_true_random=False))
def test_distances_are_symmetric_and_blind_to_order(p, random):
    p = np.array(p) / sum(p)
    q, order = np.roll(p, 1), random.sample(range(len(p)), len(p))
    for distance in (measure.deviation, measure.total_variation):
        assert distance(p, q) == distance(q, p)
        assert distance(p[order], q[order]) == pytest.approx(distance(p, q), rel=1e-12, abs=1e-15)
        assert distance(p, p) == 0.0
    bound = 2.0 * measure.total_variation(p, q) / np.sqrt(len(p))
    assert measure.deviation(p, q) <= bound + 1e-12


@pytest.mark.parametrize(
    ("test", "statistic", "p_value", "degrees", "joined"),
    [
        (measure.chi_square(FIRST, FRACTIONS), *stats.chisquare(FIRST, 100 * FRACTIONS), 2, 0),
        (measure.chi_square_between(FIRST, SECOND), HOMOGENEITY.statistic, HOMOGENEITY.pvalue, 2, 0),
        (measure.chi_square([60, 30, 6, 4], [0.6, 0.33, 0.04, 0.03]), *FEW, 2, 2),
        (measure.chi_square([9, 1, 0], [0.5, 0.0, 0.5]), np.inf, 0.0, 2, None),  # it is impossible
    ],
    ids=["fit", "homogeneity", "few", "impossible"],
)
def test_chi_square_against_scipy(test, statistic, p_value, degrees, joined):
    assert test.statistic == pytest.approx(statistic, rel=1e-12)
    assert test.p_value == pytest.approx(p_value, rel=1e-10)
    assert test.degrees_of_freedom == degrees
    assert joined is None or test.joined_aspects == joined


def test_the_p_value_is_uniform_when_the_rule_is_true(rng):
    fractions = np.array([0.2, 0.3, 0.5])
    p = [measure.chi_square(rng.multinomial(400, fractions), fractions).p_value for _ in range(2000)]
    assert stats.kstest(p, "uniform").pvalue > 1e-3


@pytest.mark.parametrize(
    ("call", "values", "message"),
    [
        (measure.deviation, ([0.5, 0.5], [1.0]), "second has shape"),
        (measure.deviation, ([0.5, np.nan], [0.5, 0.5]), "first has an entry that is not finite"),
        (measure.chi_square, ([1, -1], [0.5, 0.5]), "negative entry or sums to zero"),
        (measure.chi_square, ([0, 0], [0.5, 0.5]), "negative entry or sums to zero"),
    ],
)
def test_a_wrong_call_is_refused(call, values, message):
    with pytest.raises(ValueError, match=message):
        call(*values)


def test_every_pair_is_compared_and_tested_where_there_are_counts():
    columns = {"drops": ("counts", [30, 70]), "again": ("counts", [35, 65]),
               "print": ("fractions", [0.4, 0.6]), "PMI": ("rule", [0.5, 0.5])}  # fmt: skip
    counts, other, printed, rule = (
        AspectProfile(name, kind, np.array(values, float), np.array(values) / sum(values))
        for name, (kind, values) in columns.items()
    )
    pairs = measure.compare([counts, other, printed, rule])
    assert [f"{pair.first.name} {pair.second.name}" for pair in pairs] == [
        "drops again", "drops print", "drops PMI", "again print", "again PMI", "print PMI",
    ]  # fmt: skip
    assert pairs[0].chi_square == measure.chi_square_between([30, 70], [35, 65])
    assert pairs[1].chi_square == measure.chi_square([30, 70], [0.4, 0.6])
    assert pairs[5].chi_square is measure.NO_TEST
    assert measure.compare([rule, counts])[0].chi_square == measure.chi_square([30, 70], [0.5, 0.5])
