use super::ffi::bridge;
use super::{CgalError, Lattice, flat};

/// The class number of an owned point that is no vertex.
pub const HIDDEN: u8 = 4;

/// The points of a slab and of its halo, ascending by input index.
#[derive(Clone, Debug, Default)]
pub struct SlabSites {
    /// Positions.
    pub positions: Vec<[f64; 3]>,
    /// Power weights.
    pub weights: Vec<f64>,
    /// Input indices.
    pub input: Vec<u32>,
    /// 1 for the slab's own points, 0 for those of the halo.
    pub owned: Vec<u8>,
}

/// A classified slab as C++ lends it.
pub struct RawSlab(cxx::UniquePtr<bridge::Slab>);

// SAFETY: the C++ class consists of std::vectors of numbers and owns them alone; nothing in it is
// bound to a thread.
unsafe impl Send for bridge::Slab {}
// SAFETY: what can be called through a shared reference is const and reads these vectors only.
unsafe impl Sync for bridge::Slab {}

/// What is asked about all slabs of a set.
#[derive(Clone, Copy, Debug)]
pub struct SlabQuestion {
    /// A squared length or +∞.
    pub alpha: f64,
    /// The lattice of the whole set.
    pub lattice: Lattice,
    /// Whether exterior simplices are wanted too, which mean something in a triangulation of all
    /// points only.
    pub exterior: bool,
    /// Whether memory that comes free goes back to the system at once. That takes a tenth of the
    /// time, as it must be asked for again.
    pub frugal: bool,
}

/// Triangulates a slab with its halo and classifies the simplices whose smallest vertex is the
/// slab's own.
///
/// # Errors
/// [`SitesError::Flat`](super::SitesError::Flat) when the points span no volume.
pub fn slab(sites: &SlabSites, question: &SlabQuestion) -> Result<RawSlab, CgalError> {
    let &SlabQuestion { alpha, lattice, exterior, frugal } = question;
    let (step, on_lattice) = (lattice.step, lattice.holds_weights);
    let question = bridge::Question { alpha, step, on_lattice, exterior, frugal };
    let raw = bridge::slab(
        sites.positions.as_flattened(),
        &sites.weights,
        &sites.input,
        &sites.owned,
        &question,
    );
    let raw = raw.map_err(|thrown| CgalError::Thrown {
        stage: "slabs engine",
        text: thrown.what().into(),
    })?;
    flat(raw.dimension(), sites.input.len()).map_or(Ok(RawSlab(raw)), |flat| Err(flat.into()))
}

impl SlabQuestion {
    /// Gives freed memory back to the system, where the allocator would keep it for itself (glibc);
    /// does nothing where time matters more.
    pub fn give_back(&self) {
        if self.frugal {
            bridge::give_back();
        }
    }
}

/// Rows of input indices in canonical order, without their smallest, which [`counts`](Self::counts)
/// tell, and with class numbers beside them.
impl RawSlab {
    /// Tetrahedra and their classes.
    pub fn cells(&self) -> (&[[u32; 3]], &[u8]) {
        (self.0.cells().as_chunks().0, self.0.cell_classes())
    }

    /// Triangles and their classes.
    pub fn facets(&self) -> (&[[u32; 2]], &[u8]) {
        (self.0.facets().as_chunks().0, self.0.facet_classes())
    }

    /// Edges and their classes.
    pub fn edges(&self) -> (&[[u32; 1]], &[u8]) {
        (self.0.edges().as_chunks().0, self.0.edge_classes())
    }

    /// The class of each owned point, [`HIDDEN`] for those that are no vertices.
    pub fn vertex_classes(&self) -> &[u8] {
        self.0.vertex_classes()
    }

    /// Gives the memory of what other slabs know too back.
    pub fn drop_shared(&mut self) {
        self.0.pin_mut().drop_shared();
    }

    /// Gives the memory of the cells back.
    pub fn drop_cells(&mut self) {
        self.0.pin_mut().drop_cells();
    }

    /// Gives the memory of the facets and their sheets back.
    pub fn drop_facets(&mut self) {
        self.0.pin_mut().drop_facets();
    }

    /// How many cells, facets and edges each owned point is the smallest vertex of.
    pub fn counts(&self) -> &[[u32; 3]] {
        self.0.counts().as_chunks().0
    }

    /// The number of sheets, named from 0 within the slab.
    pub fn sheets(&self) -> u32 {
        self.0.sheets()
    }

    /// The sheet of each regular facet and the two of each singular facet, in the order of the
    /// facets.
    pub fn facet_sheets(&self) -> &[u32] {
        self.0.facet_sheets()
    }

    /// The sheet of each singular edge, in the order of the edges.
    pub fn edge_sheets(&self) -> &[u32] {
        self.0.edge_sheets()
    }

    /// Sides of facets and singular edges that other slabs know too: three sorted input indices
    /// (an edge repeats its last), the side, the sheet.
    pub fn shared(&self) -> &[[u32; 5]] {
        self.0.shared().as_chunks().0
    }
}
