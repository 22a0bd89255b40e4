from __future__ import annotations

from . import _alpha, _arrays, _settings, _walpha
from ._shape import AlphaShape
from ._typing import Arrays, Balls, Engine, Progress, Rule
from ._work import task


def alpha_shape(
    points: Arrays,
    alpha: float | Rule | None = "auto",
    *,
    alpha_radius: float | None = None,
    weights: Arrays | None = None,
    values: Arrays | None = None,
    engine: Engine = "auto",
    exterior: bool = False,
    hidden: bool = False,
    balls: Balls = "power",
    periodic: Arrays | None = None,
    progress: Progress = None,
    threads: int | None = None,
) -> AlphaShape:
    """The alpha shape of weighted points.

    The simplices of their regular triangulation whose smallest orthogonal sphere is empty and has
    a squared radius of at most α, and the faces of these. Every decision is exact.

    Parameters
    ----------
    points : array_like, (n, 3) or (n, 2), or a table
        x, y, z, or the points of a plane: whatever numpy takes or has DLPack, tensors among
        them, contiguous or not. Of frames and structured arrays the columns x, y, z, weight or radius, and
        value are taken by these names, as from CSV; others are skipped, with a warning. Rows that are masked
        are not points: they are left out, and indices count those that stay. Points in one plane or on one line get the shape that they have there:
        triangles or edges, no cells. Taken as float64; float32 is widened without error, so that the shape
        is exactly that of the places that float32 can hold.
    alpha : float, "auto" or "auto:connected"
        α, a **squared** length, as in CGAL and GUDHI; ``inf`` gives the convex hull. "auto" comes from
        the spacing of the points, so that a few strays do not matter: the squared distance within which
        nine of ten points have eight neighbours, less their weights. "auto:connected" is the smallest α
        at which all points are in one solid component.
    alpha_radius : float, optional
        √α instead of α, as Open3D and PyVista have it.
    weights : array_like, (n,), optional
        ω, squared lengths: at α a point is a ball of squared radius α + ω. By default 0.
    values : array_like, (n,), optional
        Values that :meth:`AlphaShape.at` interpolates.
    engine : {"auto", "cgal", "native", "both"}
        Which program computes it; both give the same answer. "auto" is "native", the fastest; "cgal" is CGAL.
        "both" computes it twice, and raises an error where a simplex differs.
    exterior : bool
        Keep the simplices outside the shape: the whole triangulation. Voids then know what fills
        them, and hidden points are known.
    hidden : bool
        Find the points that heavier ones hide (:attr:`AlphaShape.hidden`), which takes the whole triangulation, too.
    balls : {"power", "radius"}
        "radius": a point is a ball of radius α + ω instead.
    periodic : array_like, (3,) or (3, 3), or float, optional
        Sides of a box that repeats along x, y and z, or three vectors, as rows, along which it repeats: the
        points are those of a torus, moved into the box (:attr:`AlphaShape.points`). Vectors are reduced
        (:attr:`AlphaShape.periodic`). A row of input indices means the copies nearest to its first vertex,
        along each vector; where an edge spans half of the box, rows name copies instead (:attr:`AlphaShape.copies`).
        Points do not repeat along sides or vectors that are 0, as in ``atoms.cell[:] * atoms.pbc[:, None]`` of ASE.
        ``betti.b3`` is 1 where the shape is the whole torus.
    progress : callable or True, optional
        ``progress(stage, done, total)``, called in this thread, at most 20 times a second: so many
        of ``total`` equal parts of a stage ("alpha", "shape", …) are done. A total of 0 says that a
        stage begins. An exception ends the work. True writes a line on standard error.
    threads : int, optional
        How many threads work, at most four for each core; by default as many as ``RAYON_NUM_THREADS`` says, or as
        there are cores.

    Returns
    -------
    AlphaShape

    Raises
    ------
    ValueError
        Numbers that are NaN, infinite or absurd, no points, options that contradict each other.
    MemoryError
        The system gives no more.

    Warns
    -----
    UserWarning
        Once, where "auto" found another α than for an earlier shape: their volumes do not compare.

    References
    ----------
    H. Edelsbrunner and E. P. Mücke, Three-dimensional alpha shapes, ACM Transactions on Graphics
    13 (1994), doi:10.1145/174462.156635.

    H. Edelsbrunner, Weighted alpha shapes, UIUCDCS-R-92-1760 (1992).

    Examples
    --------
    >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    >>> walpha.alpha_shape(cube, 0.75).volume
    1.0
    >>> walpha.alpha_shape(cube, 0.5).betti
    Betti(b0=1, b1=0, b2=1)
    """
    cloud = _arrays.cloud(points, weights, values)
    rule = _alpha.rule(alpha, alpha_radius)
    settings = _settings.written(
        alpha=rule,
        engine=engine,
        balls=balls,
        exterior=exterior,
        hidden=hidden,
        periodic=_arrays.sides(periodic),
    )
    with task(progress, threads) as how:
        shape = AlphaShape._of(_walpha.alpha_shape(*cloud, settings, how))
    if not isinstance(rule, float):
        _alpha.compared(shape.alpha, stacklevel=3)
    return shape
