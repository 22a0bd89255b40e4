/** Points: rows of two or three coordinates, or an array of numbers with three for each point. */
export type Points = ReadonlyArray<ArrayLike<number>> | Float64Array | Float32Array;

export interface Options {
  /**
   * The radius of the balls that carve the shape out, a length. By default the smallest one at which all points are in one solid component, with no point
   * outside and nothing loose.
   */
  radius?: number;
  /** The square of `radius`, as papers have it: give one of both. Negative values, as weighted points may need, and Infinity are possible. */
  alpha?: number;
  /** Weights of the points, squared lengths: those of the power distance. By default 0. */
  weights?: ArrayLike<number>;
}

/** An alpha shape. Points are named by their indices, from 0. */
export interface AlphaShape {
  /** The squared length α of the shape. */
  readonly alpha: number;
  /** Its square root, the radius; NaN where α is negative. */
  readonly radius: number;
  /** 3 of points that span a volume, 2 in a plane, 1 on a line, 0 in one place. */
  readonly dimension: number;
  /** The volume of the tetrahedra. */
  readonly volume: number;
  /** In space the area of the boundary, in a plane that of the polygons. */
  readonly area: number;
  /** In a plane the length of all rings of polygons; otherwise 0. */
  readonly perimeter: number;
  /** Betti numbers: components, tunnels (holes in a plane), voids. */
  readonly betti: readonly [number, number, number];
  /** The tetrahedra, four indices each, positively oriented. */
  readonly tetrahedra: Uint32Array;
  /** In space triangles, three indices each, counter-clockwise seen from outside; in a plane edges, two each, with the shape on their left. */
  readonly boundary: Uint32Array;
  /** In a plane the triangles that fill the shape; in space those that hang loose, on no tetrahedron. Three indices each. */
  readonly triangles: Uint32Array;
  /** The edges on no triangle, two indices each. */
  readonly edges: Uint32Array;
  /** The points on no edge. */
  readonly isolated: Uint32Array;
  /** In a plane: polygons, each of rings of indices, the outer one first (counter-clockwise), then its holes (clockwise). */
  readonly polygons: Uint32Array[][];
}

/**
 * The alpha shape of points: those simplices of their Delaunay (or, with weights, regular) triangulation whose smallest empty spheres have radii of at most
 * `radius`, with their faces. Exact for any points, duplicates and grids included.
 *
 * @throws TypeError for arguments of the wrong kind, RangeError for numbers that are not finite or too large.
 */
export function alphaShape(points: Points, options?: Options): Promise<AlphaShape>;
