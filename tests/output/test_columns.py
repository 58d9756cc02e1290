"""Columns of results: each declared once beside its record, and printed once in the unit declared."""

import importlib
import pkgutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import feederscrew
from feederscrew.base.columns import (
    UNITS,
    Column,
    ColumnHead,
    Frame,
    of_arrays,
    of_pieces,
    of_records,
    values,
)
from feederscrew.output import tables

ROOT = Path(feederscrew.__file__).parent


@dataclass(frozen=True)
class Span:
    """A value with an interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Ride:
    """A record of a test."""

    name: str
    pitch: float  # [m]
    purity: float  # [1]
    pace: Span  # [1/s]
    seen: float | None = None  # [rad]


RIDE_COLUMNS: tuple[Column[Ride], ...] = (
    Column("name", lambda ride: ride.name),
    Column("pitch_mm", lambda ride: ride.pitch, "mm"),
    Column("purity", lambda ride: ride.purity, "share"),
    Column("pace_per_minute", lambda ride: ride.pace, "1/min", interval=True),
    Column("seen_deg", lambda ride: ride.seen, "deg", "seen at", hidden=True),
)
RIDES = [Ride("first", 0.012, 0.00299, Span(1.0, 0.5, 2.0)), Ride("second", 0.03, 1.0, Span(2.0, 1.0, 3.0))]


def declared():
    """Every tuple of columns that a module of the library declares, by module and name."""
    for module in pkgutil.walk_packages(feederscrew.__path__, "feederscrew."):
        source = Path(importlib.util.find_spec(module.name).origin)
        if "Column(" not in source.read_text():
            continue
        for name, value in vars(importlib.import_module(module.name)).items():
            if isinstance(value, tuple) and value and all(isinstance(item, Column) for item in value):
                yield f"{module.name}.{name}", value


DECLARED = dict(declared())


def test_a_row_holds_each_column_once_in_its_unit():
    table = of_records(RIDE_COLUMNS, RIDES)
    assert list(table) == [
        "name", "pitch_mm", "purity", "pace_per_minute", "pace_per_minute_low", "pace_per_minute_high",
        "seen_deg",
    ]  # fmt: skip
    assert table["pitch_mm"].tolist() == [12.0, 30.0] and table["pace_per_minute_high"].tolist() == [120, 180]
    assert values(RIDE_COLUMNS, RIDES[0])["seen_deg"] is None


def test_people_read_shares_and_their_ends_in_percent_files_as_fractions():
    """A bare 0.97 stood beside 99 %."""
    table = of_records(RIDE_COLUMNS, RIDES)
    heads, units, first, _ = tables.text(table.for_people(), "table").splitlines()
    assert "0.2990" in first and "[%]" in units and units.count("[1/min]") == 3 and "seen" not in heads
    assert tables.text(table, "csv").splitlines()[1] == "first,12,0.00299,60,30,120,"


def test_a_name_says_nothing_of_a_unit_that_is_not_declared():
    table = Frame.of({"purity": [0.5], "height_mm": [2.0]})
    assert tables.text(table, "table").split() == ["purity", "height", "mm", "0.5000", "2.000"]


def test_single_values_stand_in_every_row_of_a_piece():
    columns = (Column("part", lambda xs: len(xs)), Column("x_mm", lambda xs: xs, "mm"))
    assert of_arrays(columns, np.array([0.001, 0.002])).rows() == [
        {"part": 2, "x_mm": 1.0}, {"part": 2, "x_mm": 2.0},
    ]  # fmt: skip
    assert len(of_pieces(columns, [np.array([0.001]), np.array([0.002, 0.003])])["part"]) == 3


def test_tables_are_declared():
    assert len(DECLARED) > 20


@pytest.mark.parametrize("where", DECLARED)
def test_declared_columns_have_names_of_their_own_that_end_in_their_unit(where):
    names = [name for column in DECLARED[where] for name in column.heads]
    assert len(names) == len(set(names))
    for column in DECLARED[where]:
        ends = [label for label in LABELS if ColumnHead.of_name(column.name, label).heading != _words(column)]
        # 'velocity_mm_s' ends in 's' as well: the longest is its unit
        assert not ends or max(ends, key=len) == UNITS[column.unit].label, column.name


LABELS = {unit.label for unit in UNITS.values() if len(unit.label) > 1} - {"", "l", "g"}


def _words(column):
    return column.name.replace("_", " ")
