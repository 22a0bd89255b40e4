//! Replaces the bridge where the crate is built without CGAL: every question is answered by
//! [`CgalError::Absent`], and results have no values.

use walpha_regular::Sites;

use crate::shape::ShapeError;

mod error;

pub use error::CgalError;

pub(crate) enum RawComplex {}

pub(crate) fn shape(_: &Sites<'_>, _: f64) -> Result<RawComplex, ShapeError> {
    Err(CgalError::Absent.into())
}

impl RawComplex {
    pub(crate) fn cells(&self) -> (&[[u32; 4]], &[u8]) {
        match *self {}
    }

    pub(crate) fn facets(&self) -> (&[[u32; 3]], &[u8]) {
        match *self {}
    }

    pub(crate) fn edges(&self) -> (&[[u32; 2]], &[u8]) {
        match *self {}
    }

    pub(crate) fn vertices(&self) -> (&[[u32; 1]], &[u8]) {
        match *self {}
    }
}
