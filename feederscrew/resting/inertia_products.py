"""Effect of products of inertia on the PMI rule: chapter 6.2 of the thesis recommends to study it.

The rule weighs an aspect by the moment of inertia about the vertical through the centre of mass. Where that
is no principal axis, the part has products of inertia there: a part that turns about the vertical would also
swing. The moment about the nearest principal axis leaves them out. The two agree where a part is symmetric
about the vertical.
"""

from dataclasses import dataclass

import numpy as np

from feederscrew.base.arrays import Floats
from feederscrew.base.geometry import vectors
from feederscrew.resting.aspects import Aspects
from feederscrew.resting.rules import formulas

EQUAL_MOMENTS = 1e-6  # [1] of the largest: principal moments nearer than this have a plane of axes


@dataclass(frozen=True, eq=False)
class InertiaProducts:
    """Products of inertia of A aspects, and the PMI rule by the nearest principal moments."""

    products: Floats  # (A,) [kg m2] root of I_xz^2 + I_yz^2, with z the aspect's normal
    principal: Floats  # (A,) [kg m2] moment about the principal axis that is nearest to the normal
    probabilities: Floats  # (A,) [1] of the PMI rule with that moment in place of the one about the normal

    def largest_change(self, aspects: Aspects) -> float:
        """Return by how much the share of one aspect changes at most [1]."""
        change = np.abs(self.probabilities - aspects.probabilities["pmi"])
        return float(np.nanmax(change, initial=0.0))


def find_products(aspects: Aspects, inertia: Floats) -> InertiaProducts:
    """Return the products of inertia of each aspect, and PMI by the nearest principal moments.

    With z along a normal n the products are I n without its component along n.

    Parameters
    ----------
    aspects : Aspects
        Of a part with a shape: their normals are known.
    inertia : (3, 3) float [kg m2]
        Of the part, about its centre of mass, in the axes of the normals.

    Returns
    -------
    InertiaProducts

    References
    ----------
    Chapter 6.2 of the thesis recommends the study; the measure is own.
    """
    turned = vectors.product(aspects.normals, inertia)
    along = vectors.dot(turned, aspects.normals)
    across = turned - along[:, None] * aspects.normals
    products = np.sqrt(vectors.dot(across, across))
    moments, axes = vectors.eigen(inertia)
    # a normal in a plane of equal moments has that plane's share, whichever two axes the eigenvectors are
    shares = vectors.product(aspects.normals, axes) ** 2
    alike = np.abs(moments[:, None] - moments) <= EQUAL_MOMENTS * np.abs(moments).max()
    principal = moments[np.argmax(vectors.product(shares, alike.astype(float)), axis=1)]
    with np.errstate(divide="ignore", invalid="ignore"):
        weights = aspects.probabilities["pmi"] * principal / along
    shown = formulas.normalise(weights, aspects.stable)
    return InertiaProducts(products, principal, shown)
