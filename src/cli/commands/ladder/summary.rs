//! What `walpha ladder` prints: JSON, text, and tables.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;

use serde::Serialize;
use walpha_base::shown::rounded;

use crate::Coordinates;
use crate::ladder::{Curve, Filtration, Ladder, Level, Suggestions};
use crate::pipeline::{Parameter, Weighed};
use crate::shape::{Alpha, Betti, ByClass, Kept, Measures, Void};

use crate::cli::commands::pipeline::Domain;
use crate::cli::process::output::name;
use crate::cli::report::offsets::{FileOffset, print_offsets};
use crate::cli::report::{SCHEMA_VERSION, WeightsReport, ending, print_kept, rounded_up};

/// Summary of `walpha ladder` over α.
#[derive(Serialize)]
pub(super) struct LadderSummary {
    schema_version: u32,
    input: String,
    points: usize,
    hidden: usize,
    duplicates: usize,
    /// Unit of points and all lengths.
    coordinates: Coordinates,
    alpha_ref: Parameter,
    weights: WeightsReport,
    /// How many components of the shape at `alpha_ref` were kept, if not all were to be; the ladder is of their points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) kept: Option<Kept>,
    domain: Domain,
    /// Cells, facets, edges, vertices of the triangulation.
    simplices: [usize; 4],
    /// Number of critical values; those that no double separates count as one.
    critical_values: usize,
    suggested: Option<Suggestions>,
    levels: Vec<Row>,
    files: Vec<String>,
    /// What meshes in single precision have subtracted from coordinates, where they have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) offsets: Vec<FileOffset>,
    seconds: BTreeMap<&'static str, f64>,
}

#[derive(Serialize)]
struct Row {
    alpha: Alpha,
    cells: usize,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    facets: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    edges: ByClass<usize>,
    #[serde(serialize_with = "ByClass::serialize_shape")]
    vertices: ByClass<usize>,
    betti: Betti,
    solid_components: u64,
    #[serde(flatten)]
    measures: Measures,
    coverage: f64,
    void_volume: f64,
    /// The largest void; voids.csv lists all.
    largest_void: Option<Void>,
}

impl LadderSummary {
    pub(super) fn new(
        input: &str,
        weighed: &Weighed,
        alpha_ref: Parameter,
        domain: Domain,
    ) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            input: input.to_owned(),
            points: weighed.points.len(),
            hidden: 0,
            duplicates: 0,
            coordinates: weighed.origin.coordinates,
            alpha_ref,
            weights: WeightsReport::of(weighed),
            kept: None,
            domain,
            simplices: [0; 4],
            critical_values: 0,
            suggested: None,
            levels: Vec::new(),
            files: Vec::new(),
            offsets: Vec::new(),
            seconds: BTreeMap::new(),
        }
    }

    /// Adds the results.
    pub(super) fn add(
        &mut self,
        filtration: &Filtration,
        curve: &Curve,
        suggested: Suggestions,
        ladder: &Ladder,
    ) {
        let whole = filtration.whole();
        let complex = whole.complex();
        self.hidden = whole.hidden().map_or(0, <[u32]>::len);
        self.duplicates = whole.duplicates().len();
        self.simplices = [
            complex.cells.len(),
            complex.facets.len(),
            complex.edges.len(),
            complex.vertices.len(),
        ];
        self.critical_values = curve.len();
        self.suggested = Some(suggested);
        let row = |level: &Level| Row {
            alpha: level.alpha,
            cells: level.cells,
            facets: level.facets,
            edges: level.edges,
            vertices: level.vertices,
            betti: level.betti,
            solid_components: level.solid_components,
            measures: level.measures,
            coverage: level.coverage,
            void_volume: level.void_volume(),
            largest_void: level.voids.first().copied(),
        };
        self.levels = ladder.levels.iter().map(row).collect();
    }

    /// Adds the times, and the files written.
    pub(super) fn finish(&mut self, seconds: Vec<(&'static str, f64)>, files: Vec<String>) {
        self.seconds = seconds.into_iter().collect();
        self.files = files;
    }
}

impl Display for LadderSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [cells, facets, edges, vertices] = self.simplices;
        writeln!(f, "input     {}", name(&self.input))?;
        writeln!(
            f,
            "points    {}, {} duplicates, {} hidden",
            self.points, self.duplicates, self.hidden
        )?;
        writeln!(f, "lengths   in {}", self.coordinates)?;
        writeln!(f, "weights   {} (squared lengths), frozen at {}", self.weights, self.alpha_ref)?;
        if let Some(kept) = &self.kept {
            print_kept(f, kept, self.coordinates.unit)?;
        }
        writeln!(
            f,
            "whole     {cells} cells, {facets} facets, {edges} edges, {vertices} vertices"
        )?;
        writeln!(f, "domain    {}", self.domain)?;
        if let Some(suggested) = &self.suggested {
            self.print_suggested(f, suggested)?;
        }
        self.print_levels(f)?;
        print_offsets(&self.offsets, f)?;
        ending(f, &self.files, &STAGES, &self.seconds)
    }
}

/// The stages whose times are printed.
const STAGES: [&str; 8] =
    ["read", "haar", "points", "filtration", "curve", "ladder", "write", "total"];

impl LadderSummary {
    fn print_suggested(&self, f: &mut fmt::Formatter<'_>, s: &Suggestions) -> fmt::Result {
        writeln!(f, "curve     {} critical values; α to try:", self.critical_values)?;
        let shown = |alpha: Alpha| rounded_up(alpha.squared());
        let [all, one, none] = [s.all_points, s.one_region, s.no_void].map(shown);
        writeln!(f, "          {all:<12} the first with every point in a cell")?;
        writeln!(f, "          {one:<12} the first with that and one solid component")?;
        writeln!(f, "          {none:<12} the first with that and no void")?;
        let [low, high] = s.plateau;
        let low = shown(low);
        if high == Alpha::INFINITE {
            writeln!(f, "          {low:<12} to inf: b0, b1, b2 no longer change")?;
        } else {
            let high = rounded(high.squared());
            writeln!(
                f,
                "          {low:<12} to {high}: the longest stretch without a change of b0, b1, b2, from {all} on"
            )?;
        }
        Ok(())
    }

    fn print_levels(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:>12} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>12} {:>9} {:>12}",
            "α",
            "cells",
            "facets",
            "edges",
            "b0",
            "b1",
            "b2",
            "solids",
            "volume",
            "coverage",
            "voids"
        )?;
        for level in &self.levels {
            let Betti { b0, b1, b2, .. } = level.betti;
            // All digits are in the files.
            let [alpha, volume, voids] =
                [level.alpha.squared(), level.measures.volume, level.void_volume].map(rounded);
            writeln!(
                f,
                "{alpha:>12} {:>8} {:>8} {:>8} {b0:>6} {b1:>6} {b2:>6} {:>6} {volume:>12} {:>8.2}% {voids:>12}",
                level.cells,
                level.facets.in_shape(),
                level.edges.in_shape(),
                level.solid_components,
                100.0 * level.coverage,
            )?;
        }
        Ok(())
    }
}

/// `ladder.csv`: a row for each level. α, volumes and areas are in the units of the points, squared
/// and cubed.
pub(super) fn write_levels(ladder: &Ladder, out: &mut dyn io::Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "alpha",
        "cells",
        "facets_interior",
        "facets_regular",
        "facets_singular",
        "edges_interior",
        "edges_regular",
        "edges_singular",
        "vertices_interior",
        "vertices_regular",
        "vertices_singular",
        "b0",
        "b1",
        "b2",
        "solid_components",
        "volume",
        "area",
        "regular_area",
        "singular_area",
        "coverage",
        "void_volume",
        "largest_void",
        "filling_alpha",
    ])?;
    for level in &ladder.levels {
        let classes = [level.facets, level.edges, level.vertices]
            .map(|c| [c.interior, c.regular, c.singular]);
        let counts = std::iter::once(level.cells).chain(classes.into_iter().flatten());
        let topology = <[u64; 3]>::from(level.betti).into_iter().chain([level.solid_components]);
        let Measures { volume, area, regular_area, singular_area } = level.measures;
        let sizes =
            [volume, area, regular_area, singular_area, level.coverage, level.void_volume()];
        // Without a void both fields are empty.
        let largest = level.voids.first().map(|void| [void.volume, void.filling_alpha.squared()]);
        let field = |k: usize| largest.map_or(String::new(), |largest| largest[k].to_string());
        let record = std::iter::once(level.alpha.to_string())
            .chain(counts.map(|count| count.to_string()))
            .chain(topology.map(|count| count.to_string()))
            .chain(sizes.map(|size| size.to_string()))
            .chain([field(0), field(1)]);
        csv.write_record(record)?;
    }
    csv.flush()
}

/// `voids.csv`, the hole ledger: a row for each void of each level, largest first.
pub(super) fn write_voids(ladder: &Ladder, out: &mut dyn io::Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record([
        "alpha",
        "cells",
        "volume",
        "x_low",
        "y_low",
        "z_low",
        "x_high",
        "y_high",
        "z_high",
        "filling_alpha",
    ])?;
    for level in &ladder.levels {
        for void in &level.voids {
            let numbers =
                [&[void.volume][..], &void.low, &void.high, &[void.filling_alpha.squared()]]
                    .concat();
            let record = [level.alpha.to_string(), void.cells.to_string()]
                .into_iter()
                .chain(numbers.iter().map(ToString::to_string));
            csv.write_record(record)?;
        }
    }
    csv.flush()
}
