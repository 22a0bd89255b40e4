//! Options that take one of a few names, for types of the libraries, which know nothing of the command.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::interpolate::Refit;
use crate::shape::Engine;
use crate::{Balls, Decomposition, Space, Units};

/// A type whose values have names on the command line.
pub(super) trait Named: Copy + Send + Sync + 'static {
    /// The values, each with its name and its help.
    const NAMES: &'static [(Self, &'static str, &'static str)];
}

/// Parses one of the names.
pub(super) fn choice<T: Named>() -> impl TypedValueParser<Value = T> {
    let names = T::NAMES.iter().map(|(_, name, help)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(names).map(|given| {
        let named = T::NAMES.iter().find(|(_, name, _)| *name == given);
        named.expect("the parser lets only these names through").0
    })
}

impl Named for Engine {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::Auto,
            "auto",
            "CGAL for up to 20 000 points; native for more, and for what only it can do",
        ),
        (
            Self::Cgal,
            "cgal",
            "CGAL's Regular_triangulation_3 and Fixed_alpha_shape_3, as in the paper, on one thread",
        ),
        (
            Self::Native,
            "native",
            "Triangulation and classes in Rust: without C++, on all cores, in bounded memory, and the fastest",
        ),
    ];
}

impl Named for Balls {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::Power,
            "power",
            "A ball of squared radius α + ω: the usual definition (Edelsbrunner 1992; CGAL), the default",
        ),
        (
            Self::Radius,
            "radius",
            "A ball of radius α + ω, as a sentence of the paper's section 4.2 reads: the power weight \
             (α + ω)² at parameter 0",
        ),
    ];
}

impl Named for Decomposition {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::NonStandard,
            "non-standard",
            "All axes step once per level, then the octant of means continues: cubes of 2ˡ samples a side",
        ),
        (Self::Standard, "standard", "Each axis is transformed fully: boxes of any powers of two"),
    ];
}

impl Named for Refit {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Whole, "whole", "All samples, with F on the whole triangulation, as with --fill"),
        (Self::Shape, "shape", "The samples on the shape"),
    ];
}

impl Named for Units {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Voxel, "voxel", "Indices of samples, as in the paper"),
        (
            Self::World,
            "world",
            "World coordinates, by the spacing, origin and direction of the file's grid",
        ),
    ];
}

impl Named for Space {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Lps, "lps", "x to the left, y to the back, z to the head, as in DICOM and ITK"),
        (Self::Ras, "ras", "x to the right, y to the front, z to the head, as in NIfTI"),
    ];
}
