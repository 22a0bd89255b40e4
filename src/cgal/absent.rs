//! Replaces the bridge where the crate is built without CGAL: every question is answered by
//! [`TriangulationError::WithoutCgal`], and results have no values.

use crate::triangulation::{Sites, TriangulationError};

const ABSENT: TriangulationError = TriangulationError::WithoutCgal;

pub(crate) enum RawComplex {}

pub(crate) enum Regular {}

pub(crate) fn give_back() {}

pub(crate) fn reference(_: &Sites<'_>, _: f64) -> Result<RawComplex, TriangulationError> {
    Err(ABSENT)
}

pub(crate) fn regular(_: &[[f64; 3]], _: &[f64], _: &[u32]) -> Result<Regular, TriangulationError> {
    Err(ABSENT)
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

impl Regular {
    pub(crate) fn cells(&self) -> usize {
        match *self {}
    }

    pub(crate) fn copy(
        &self,
        _: &mut [[u32; 4]],
        _: &mut [[u32; 4]],
    ) -> Result<(), TriangulationError> {
        match *self {}
    }
}
