//! Settings whose values are a few names.

use crate::interpolate::Refit;
use walpha_points::Units;
use walpha_points::haar::Decomposition;
use walpha_shape::{Balls, Engine};
use walpha_volume::Space;

/// A type whose values have names.
pub(super) trait Named: Copy + 'static {
    /// The values, each with its name and its help.
    const NAMES: &'static [(Self, &'static str, &'static str)];
}

/// The method of choosing samples as points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Select {
    /// The samples of largest gray difference.
    #[default]
    Difference,
    /// One after another, the samples where the interpolant of the previous ones is worst.
    Adaptive,
}

impl Named for Select {
    const NAMES: &'static [(Self, &'static str, &'static str)] =
        &[(Self::Difference, "difference", ""), (Self::Adaptive, "adaptive", "")];
}

impl Named for Engine {
    const NAMES: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self::Auto,
            "auto",
            "CGAL for up to 20 000 points selected from a volume, as in the paper; native for everything else",
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
        (
            Self::Both,
            "both",
            "Both, one after the other, to cross-check: the exit code is 3 where a simplex differs",
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

/// The names of the values of a setting, with their help, if it has such names.
pub(super) fn of(setting: &str) -> Option<Vec<[&'static str; 2]>> {
    fn names<T: Named>() -> Vec<[&'static str; 2]> {
        T::NAMES.iter().map(|&(_, name, help)| [name, help]).collect()
    }
    Some(match setting {
        "balls" => names::<Balls>(),
        "engine" => names::<Engine>(),
        "haar" => names::<Decomposition>(),
        "refit" => names::<Refit>(),
        "select" => names::<Select>(),
        "space" => names::<Space>(),
        "units" => names::<Units>(),
        _ => return None,
    })
}
