from __future__ import annotations

import enum


class Class(enum.IntEnum):
    """What a simplex of the regular triangulation is to the shape.

    The names are those of CGAL's ``Fixed_alpha_shape_3::Classification_type``. Cells are
    ``INTERIOR`` or ``EXTERIOR`` only.

    Examples
    --------
    The boundary of the solid part of a shape:

    >>> shape = walpha.alpha_shape([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], alpha=1)
    >>> len(shape.facets[shape.facet_classes == walpha.Class.REGULAR])
    4
    """

    #: Not in the shape.
    EXTERIOR = 0
    #: In the shape, and not on its boundary.
    INTERIOR = 1
    #: On the boundary, and a face of a higher simplex of the shape.
    REGULAR = 2
    #: In the shape, and a face of no other simplex of it.
    SINGULAR = 3
