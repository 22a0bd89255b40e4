//! The interface to C++: flat slices in, and out an opaque complex that lends flat slices.

#[cxx::bridge(namespace = "walpha")]
pub(super) mod bridge {
    unsafe extern "C++" {
        include!("walpha/cpp/bridge.h");
        include!("walpha/cpp/shape.h");

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

        fn prepare_thread();
        fn shape(positions: &[f64], weights: &[f64], alpha: f64) -> Result<UniquePtr<Complex>>;
    }
}
