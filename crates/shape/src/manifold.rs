use walpha_base::UnionFind;

use super::Surface;
use super::solid::join;

/// Numbers of edges and vertices where the boundary of a shape is not a manifold. Other programs expect that a solid has none;
/// alpha shapes often have some.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct ManifoldDefects {
    /// Edges on more than two regular facets, along which parts of the shape touch.
    pub edges: usize,
    /// Other vertices around which the regular facets form more than one fan, at which parts touch.
    pub vertices: usize,
}

impl ManifoldDefects {
    /// Whether there are no defects.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl Surface {
    /// The defects of the surface of regular facets. Singular simplices, which bound nothing, do not count.
    /// O(n log n).
    pub fn manifold_defects(&self) -> ManifoldDefects {
        let fans = UnionFind::new(3 * self.regular.len());
        let mut on_defect = vec![false; self.vertex_count()];
        let mut edges = 0;
        self.each_edge(|around| {
            if let [(_, a), (_, b)] = around {
                join(&fans, *a, *b);
            } else {
                edges += 1;
                around[0].0.iter().for_each(|&v| on_defect[v as usize] = true);
            }
        });
        let mut fans_of = vec![0usize; self.vertex_count()];
        for (corner, &v) in self.regular.as_flattened().iter().enumerate() {
            let corner = corner as u32;
            fans_of[v as usize] += usize::from(fans.find(corner) == corner);
        }
        let pinched = |(&fans, &defect): (&usize, &bool)| fans > 1 && !defect;
        let vertices = fans_of.iter().zip(&on_defect).filter(|&pair| pinched(pair)).count();
        ManifoldDefects { edges, vertices }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The facets of a tetrahedron, outward.
    fn tetrahedron([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 4] {
        [[a, c, b], [a, b, d], [b, c, d], [a, d, c]]
    }

    fn defects(facets: &[[u32; 3]]) -> [usize; 2] {
        let vertices = facets.as_flattened().iter().max().map_or(0, |&v| v + 1);
        let surface = Surface {
            vertices: (0..vertices).collect(),
            regular: facets.to_vec(),
            ..Surface::default()
        };
        let ManifoldDefects { edges, vertices } = surface.manifold_defects();
        [edges, vertices]
    }

    #[test]
    fn touching_solids_are_found() {
        let one = tetrahedron([0, 1, 2, 3]);
        assert_eq!(defects(&[]), [0, 0]);
        assert_eq!(defects(&one), [0, 0]);
        assert_eq!(defects(&[one, tetrahedron([4, 5, 6, 7])].concat()), [0, 0]);
        assert_eq!(defects(&[one, tetrahedron([3, 4, 5, 6])].concat()), [0, 1]);
        assert_eq!(defects(&[one, tetrahedron([2, 3, 4, 5])].concat()), [1, 0]);
        assert_eq!(defects(&one[..3]), [3, 0], "an open boundary");
    }
}
