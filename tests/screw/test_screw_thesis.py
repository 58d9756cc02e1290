"""The screws that the thesis writes out for its two parts, against the dual Euler equation for any body.

The thesis turns a part by theta clockwise: the angular velocity is -theta' about the upright axis.
"""

import numpy as np
import pytest

from feederscrew.screw import Body, Point, Twist, spatial_triangle

CENTRE = Point("C", np.zeros(3))
MASS, SPIN, TURN = 1.982e-3, 3.7, -52.0  # [kg], theta' [rad/s], theta'' [rad/s2]
SPEED, RATE = np.array([0.11, -0.07]), np.array([-1.9, 2.3])  # [m/s], [m/s2] along the two axes of the floor
PARTS = {  # the inertia matrices of the two parts [g mm2]: I_yx and I_zx are their products
    "arc_chute": [[95.32, 0.0, -24.48], [0.0, 109.57, 0.0], [-24.48, 0.0, 114.75]],
    "magnet": [[755.91, -10.91, 0.0], [-10.91, 755.09, 0.0], [0.0, 0.0, 49.92]],
}


@pytest.fixture(params=sorted(PARTS))
def inertia(request):
    """Of one part [kg m2]."""
    return 1e-9 * np.array(PARTS[request.param])


def triangle(inertia, upright):
    """Of a part that turns about one axis and moves along the two others."""
    level = [axis for axis in range(3) if axis != upright]
    (spin, speed), (turn, rate) = np.zeros((2, 2, 3))
    spin[upright], turn[upright] = -SPIN, -TURN
    speed[level], rate[level] = SPEED, RATE
    body, twist = Body(MASS, inertia, CENTRE), Twist(spin, speed, CENTRE)
    return body.momentum(twist), spatial_triangle(body, twist, Twist(turn, rate, CENTRE))


def test_on_the_floor(inertia):
    """X upright: eqs. [4.7] to [4.12] of the Arc Chute, eqs. [4.38] to [4.42] of the Magnet."""
    (i_xx, i_yx, i_zx), (v_y, v_z), (a_y, a_z) = inertia[0], SPEED, RATE
    momentum, found = triangle(inertia, 0)
    np.testing.assert_allclose(momentum.linear, MASS * np.array([0.0, v_y, v_z]), rtol=1e-15)
    np.testing.assert_allclose(momentum.angular, -SPIN * inertia[0], rtol=1e-15)
    np.testing.assert_allclose(found.centripetal.force, MASS * SPIN * np.array([0, v_z, -v_y]), rtol=1e-14)
    np.testing.assert_allclose(found.centripetal.moment, SPIN**2 * np.array([0, -i_zx, i_yx]), rtol=1e-14)
    np.testing.assert_allclose(found.rate.force, MASS * np.array([0.0, a_y, a_z]), rtol=1e-14)
    np.testing.assert_allclose(found.rate.moment, -TURN * np.array([i_xx, i_yx, i_zx]), rtol=1e-14)
    total = MASS * np.array([0.0, a_y + v_z * SPIN, a_z - v_y * SPIN])
    np.testing.assert_allclose(found.force.force, total, rtol=1e-14)


def test_on_the_track(inertia):
    """X and Z change places: eqs. [4.30], [4.31] of the Arc Chute, eqs. [4.55], [4.56] of the Magnet.

    [4.56] prints the terms with theta' with the other sign than [4.31]; a wall makes them zero.
    """
    switched = inertia[::-1, ::-1]
    (i_xx, i_yx, i_zx), (v_x, v_y), (a_x, a_y) = inertia[0], SPEED, RATE
    _, found = triangle(switched, 2)
    np.testing.assert_allclose(found.rate.force, MASS * np.array([a_x, a_y, 0.0]), rtol=1e-14)
    np.testing.assert_allclose(found.rate.moment, -TURN * np.array([i_zx, i_yx, i_xx]), rtol=1e-14)
    total = MASS * np.array([a_x + v_y * SPIN, a_y - v_x * SPIN, 0.0])
    np.testing.assert_allclose(found.force.force, total, rtol=1e-14)
