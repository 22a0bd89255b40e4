//! What crosses to C++: flat slices in, an opaque complex that lends flat slices out.

#[cxx::bridge(namespace = "walpha")]
pub(super) mod bridge {
    /// What is asked about a slab.
    struct Question {
        /// A squared length or +infinity.
        alpha: f64,
        /// A lattice step of all coordinates, or 0.
        step: f64,
        /// Whether all weights are multiples of its square.
        on_lattice: bool,
        /// Whether exterior simplices are wanted too.
        exterior: bool,
        /// Whether memory matters more than time.
        frugal: bool,
    }

    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/plane.h");
        include!("walpha/cpp/reference.h");
        include!("walpha/cpp/slab.h");

        /// A classified complex as flat arrays of input indices and class numbers.
        type Complex;

        fn dimension(self: &Complex) -> i32;
        fn cells(self: &Complex) -> &[u32];
        fn facets(self: &Complex) -> &[u32];
        fn edges(self: &Complex) -> &[u32];
        fn vertices(self: &Complex) -> &[u32];
        fn cell_classes(self: &Complex) -> &[u8];
        fn facet_classes(self: &Complex) -> &[u8];
        fn edge_classes(self: &Complex) -> &[u8];
        fn vertex_classes(self: &Complex) -> &[u8];

        fn reference(positions: &[f64], weights: &[f64], alpha: f64) -> Result<UniquePtr<Complex>>;

        /// A triangulation of the plane as flat arrays of input indices.
        type PlaneTriangulation;

        fn triangles(self: &PlaneTriangulation) -> &[u32];
        fn edges(self: &PlaneTriangulation) -> &[u32];
        fn vertices(self: &PlaneTriangulation) -> &[u32];

        fn regular_plane(
            positions: &[f64],
            weights: &[f64],
        ) -> Result<UniquePtr<PlaneTriangulation>>;
        fn farthest_plane(positions: &[f64]) -> Result<UniquePtr<PlaneTriangulation>>;

        fn give_back();

        /// The simplices a slab owns, classified.
        type Slab;

        fn dimension(self: &Slab) -> i32;
        fn cells(self: &Slab) -> &[u32];
        fn facets(self: &Slab) -> &[u32];
        fn edges(self: &Slab) -> &[u32];
        fn cell_classes(self: &Slab) -> &[u8];
        fn facet_classes(self: &Slab) -> &[u8];
        fn edge_classes(self: &Slab) -> &[u8];
        fn vertex_classes(self: &Slab) -> &[u8];
        fn counts(self: &Slab) -> &[u32];
        fn facet_sheets(self: &Slab) -> &[u32];
        fn edge_sheets(self: &Slab) -> &[u32];
        fn shared(self: &Slab) -> &[u32];
        fn sheets(self: &Slab) -> u32;
        fn drop_shared(self: Pin<&mut Slab>);
        fn drop_cells(self: Pin<&mut Slab>);
        fn drop_facets(self: Pin<&mut Slab>);

        fn slab(
            positions: &[f64],
            weights: &[f64],
            input: &[u32],
            owned: &[u8],
            question: &Question,
        ) -> Result<UniquePtr<Slab>>;
    }
}
