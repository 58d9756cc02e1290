"""Quantities as typed: their values, and what is said of the ones that cannot be used."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from feederscrew.base import units


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("0.5 mm", "length", 0.5e-3), ("0.5mm", "length", 0.5e-3), ('2 "', "length", 0.0508),
        ("  1e2   um ", "length", 1e-4), ("-.5 deg", "angle", -math.pi / 360),
        ("\N{MINUS SIGN}3°", "angle", -math.pi / 60), ("3600 1/min", "frequency", 60.0),
        ("9.81 m/s^2", "acceleration", 9.81), ("386.0886 in/s²", "acceleration", 9.80665044),
        ("7.85 g/cm³", "density", 7850.0), ("95.32 g·mm²", "inertia", 95.32e-9), ("120/min", "rate", 2.0),
        ("3000 vpm", "frequency", 50.0), ("90 cpm", "frequency", 1.5),
        ("30 %", "number", 0.3), ("0.4", "number", 0.4),
    ],
)  # fmt: skip
def test_quantities(text, dimension, value):
    assert units.quantity(text, dimension) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "dimension", "told"),
    [
        ("60", "frequency", "'60' has no unit - write 60 Hz"),
        ("20 mm", "angle", "'20 mm' is a length, not an angle - give it in deg"),
        ("3 %", "length", "'3 %' is a percentage, not a length - give it in mm"),
        ("5 MM", "length", "'5 MM': 'MM' is not a unit of length - did you mean mm?"),
        ("5 ell", "length", "'5 ell': 'ell' is not a unit of length - known are mm, m, cm, um, in, ft"),
        ("0,5", "number", "'0,5' has a comma - write 0.5"),
        ("0,5 mm", "length", "'0,5 mm' has a comma - write 0.5 mm"),
        ("1,250 mm", "length", "'1,250 mm' has a comma - write 1.250 mm or 1250 mm"),  # it ran with 1.25
        ("-12,000", "number", "'-12,000' has a comma - write -12.000 or -12000"),
        ("0,125 mm", "length", "'0,125 mm' has a comma - write 0.125 mm"),
        ("1,2500 mm", "length", "'1,2500 mm' has a comma - write 1.2500 mm"),
        ("1,000,000", "number", "'1,000,000' has a comma - write it without commas"),
        ("0.4 mm", "number", "'0.4 mm' has a unit, and this is a plain number - write the number alone"),
        ("yes", "number", "'yes' is not a number - write digits with a decimal point, as in 0.4"),
        ("inf mm", "length", "'inf mm' is not a number - write digits with a decimal point, as in 0.4"),
        ("1e999 mm", "length", "'1e999 mm' is too large - give a finite number"),
    ],
)
def test_faults(text, dimension, told):
    with pytest.raises(units.QuantityError) as caught:
        units.quantity(text, dimension)
    assert str(caught.value) == told


def test_a_missing_unit_is_suggested_or_supplied():
    with pytest.raises(ValueError, match=r"write 5 m$"):
        units.quantity("5", "length", suggest="m")
    assert units.quantity("5", "length", bare="m") == 5.0
    assert units.quantity("5 mm", "length", bare="m") == 0.005


@given(
    st.floats(-1e9, 1e9),
    st.sampled_from([(d, u) for d, table in units.UNITS_BY_DIMENSION.items() for u in table]),
)
def test_every_unit_is_its_factor(number, pair):
    dimension, unit = pair
    assert units.quantity(f"{number!r} {unit}", dimension) == number * units.factor(unit, dimension)


@given(st.text(max_size=30), st.sampled_from(sorted(units.UNITS_BY_DIMENSION)))
def test_any_text_is_a_finite_quantity_or_a_fault(text, dimension):
    try:
        assert math.isfinite(units.quantity(text, dimension))
    except units.QuantityError as fault:
        assert "\n" not in str(fault)


@pytest.mark.parametrize("text", ["", "nan", "inf", "1e999", "1_0", "\u0663", "\u00b2", "0x10", "1 2", "1,5"])
def test_a_number_of_a_file_is_of_plain_digits(text):
    with pytest.raises(units.QuantityError):
        units.decimal(text)


def test_a_number_for_people_has_no_exponent():
    """The page of a short queue said 'jams an hour, upper bound: 3.59e+03'."""
    said = [units.digits_text(value) for value in (3594.9, 85.62, 0.0, 0.00123, 1e6)]
    assert said == ["3590", "85.6", "0", "0.00123", "1000000"]
    assert units.digits_text(12345.6, 4) == "12350"
