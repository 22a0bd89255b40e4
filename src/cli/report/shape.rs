//! What is reported of a shape.

use std::fmt::{self, Display};

use serde::Serialize;

use crate::AlphaShape;
use crate::outofcore::Merged;
use crate::shape::{Betti, ByClass, Component, Void};

#[derive(Serialize)]
pub(super) struct ShapeReport {
    pub(super) cells: Cells,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) facets: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) edges: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    pub(super) vertices: ByClass<usize>,
    pub(super) betti: Option<Betti>,
    pub(super) volume: f64,
    pub(super) area: f64,
    pub(super) singular_area: f64,
    /// The largest by volume, each with what its boundary shuts in.
    pub(super) components: Vec<Component>,
    /// Null unless the simplices outside the shape are kept.
    pub(super) voids: Option<Vec<Void>>,
}

#[derive(Serialize)]
pub(super) struct Cells {
    pub(super) interior: usize,
}

/// The simplices of a dimension in a line.
pub(super) struct Line<'a>(&'a ByClass<usize>);

impl Display for Line<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ByClass { interior, regular, singular, .. } = self.0;
        write!(f, "{interior:>9} interior {regular:>9} regular {singular:>9} singular")
    }
}

impl ShapeReport {
    /// What a shape is.
    pub(super) fn of(shape: &AlphaShape) -> Self {
        let complex = shape.complex();
        Self {
            cells: Cells { interior: complex.cells.counts().interior },
            facets: complex.facets.counts(),
            edges: complex.edges.counts(),
            vertices: complex.vertices.counts(),
            betti: shape.betti(),
            volume: shape.measures().volume,
            area: shape.measures().area,
            singular_area: shape.measures().singular_area,
            components: largest(shape.components()),
            voids: shape.voids(),
        }
    }

    /// What a shape made in blocks is.
    pub(super) fn of_blocks(merged: &Merged) -> Self {
        Self {
            cells: Cells { interior: merged.cells },
            facets: merged.facets,
            edges: merged.edges,
            vertices: merged.vertices,
            betti: Some(merged.betti),
            volume: merged.measures.volume,
            area: merged.measures.area,
            singular_area: merged.measures.singular_area,
            components: largest(merged.components.clone()),
            voids: None,
        }
    }

    /// Prints what the shape is, lengths in `unit`.
    pub(super) fn print(&self, f: &mut fmt::Formatter<'_>, unit: &str) -> fmt::Result {
        writeln!(f, "cells     {:>9} interior", self.cells.interior)?;
        writeln!(f, "facets    {}", Line(&self.facets))?;
        writeln!(f, "edges     {}", Line(&self.edges))?;
        writeln!(f, "vertices  {}", Line(&self.vertices))?;
        match self.betti {
            None => {}
            Some(Betti { b0, b1, b2, b3: None }) => {
                writeln!(f, "topology  {b0} components, {b1} tunnels, {b2} voids")?;
            }
            Some(Betti { b0, b1, b2, b3: Some(b3) }) => {
                writeln!(f, "topology  b0 = {b0}, b1 = {b1}, b2 = {b2}, b3 = {b3} on the torus")?;
            }
        }
        writeln!(f, "volume    {:.6} {unit}³", self.volume)?;
        let (area, singular) = (self.area, self.singular_area);
        writeln!(f, "area      {area:.6} {unit}², singular facets {singular:.6} {unit}²")?;
        if let [largest, _, ..] = &self.components[..] {
            let Component { vertices, volume, .. } = largest;
            writeln!(f, "largest   component: {vertices} vertices, volume {volume:.6} {unit}³")?;
        }
        if let Some(voids) = &self.voids
            && let Some(largest) = voids.first()
        {
            let sum = voids.iter().fold(0.0, |sum, void| sum + void.volume);
            let Void { volume, filling_alpha, .. } = largest;
            writeln!(
                f,
                "voids     {sum:.6} {unit}³ in all, the largest {volume:.6} {unit}³, filled at α = \
                 {filling_alpha} {unit}²"
            )?;
        }
        Ok(())
    }
}

/// Components listed at most.
const TOLD: usize = 20;

fn largest(mut components: Vec<Component>) -> Vec<Component> {
    components.sort_by(|a, b| b.volume.total_cmp(&a.volume).then(b.vertices.cmp(&a.vertices)));
    components.truncate(TOLD);
    components
}
