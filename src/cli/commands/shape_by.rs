//! `walpha shape --by`: a shape for each group of points, with a table, outlines from above, or meshes.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::io;

use serde::Serialize;
use serde_json::{Map, Value, json};
use walpha_base::shown::{rounded, shown};
use walpha_files::put_all;

use crate::Recipe;
use crate::cli::commands::folder::Folder;
use crate::cli::commands::ladder::Mesh;
use crate::cli::commands::pipeline;
use crate::cli::commands::shape::{Shape, unused};
use crate::cli::commands::shape_of_labels::write_part;
use crate::cli::options::global::Global;
use crate::cli::process::errors::{Result, fail_usage};
use crate::cli::process::output::{OF_OUTPUTS, name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::offsets::{FileOffset, Told, print_offsets};
use crate::cli::report::{SCHEMA_VERSION, ending};
use crate::export::{EmptyShape, FeatureFormat, OutlineFeature, Target};
use crate::pipeline::{GroupShape, Groups, Input, Parameter, Values};
use crate::points::Attributes;
use crate::progress::Stage;
use crate::{Alpha, Coordinates};

/// The largest number of groups that are printed as text.
const MOST_PRINTED: usize = 30;

/// What is written of the groups.
enum Output {
    /// A table with a row for each.
    Table(Target),
    /// Outlines from above, with a feature for each.
    Outlines(Target, FeatureFormat),
    /// A folder with meshes of each.
    Meshes(Folder),
}

impl Shape {
    /// Whether meshes of groups are written: to outputs that are no table and no outlines.
    pub(crate) fn writes_groups(&self) -> Result<bool> {
        let names = self.names()?;
        Ok(self.by.is_some() && names.iter().any(|name| kind(name) == Some(Kind::Meshes)))
    }

    /// Computes a shape for each value of a column, and writes what is asked for.
    pub(crate) fn by_column(&self, column: &str, recipe: &Recipe, global: Global) -> Result<()> {
        unused("--require-3d", self.require_3d, "groups may be flat")?;
        unused("--flat", self.flat, "outlines of groups are from above as it is")?;
        let given = &self.pipeline.input.typed;
        given.refuse(&["periodic"], "groups of points are shapes in space")?;
        given.refuse(&["hidden"], "hidden points of groups are not listed")?;
        if !self.writes_groups()? {
            given.refuse(&["exterior"], "no meshes of groups are written")?;
        }
        unused("--allow-empty", self.allow_empty, "a group of which nothing is left has a row")?;
        let meshes = if self.writes_groups()? { self.meshes()? } else { Vec::new() };
        let outputs = self.outputs_of_groups()?;
        let mut progress = Progress::new(global);
        let input = &self.pipeline.input;
        let asked = vec![column.to_owned()];
        let mut recipe = recipe.clone().attributes(Attributes::Named(asked));
        let read = pipeline::read_suited(input, &mut recipe, &mut progress)?;
        pipeline::accept(&read, input)?;
        let Input::Points(points, facts) = &read else {
            fail_usage!("{} holds a volume, which has no columns", input.input => "omit --by; --each-label makes the solid of each label");
        };
        let crs = facts.crs.clone();
        let values = points.column(column).expect("the reader refuses a file without it");
        let groups = Groups::of(column, &values)?;
        drop(values);
        let (mut weighed, _) =
            pipeline::weigh(read, input, &recipe, Values::Written, &mut progress)?;
        let shapes = progress.watch(|| recipe.finish_groups(&mut weighed, &groups))?;
        let parameter = weighed.parameter.expect("it was found for the shapes");
        let all = shapes.iter().map(|group| &group.shape);
        let meshes = Mesh::together(meshes, self.export(), all);
        let mut rows: Vec<GroupRow> =
            progress.stage(Stage::Measure, || shapes.iter().map(GroupRow::of).collect());
        let (mut filled, mut folders) = (Vec::new(), Vec::new());
        let (mut files, mut empty) = (Vec::new(), 0);
        let unit = weighed.origin.coordinates.unit.symbol();
        for output in outputs {
            match output {
                Output::Table(target) => {
                    files.push(target.path().display().to_string());
                    let write = |out: &mut dyn io::Write| write_table(column, &rows, out);
                    filled.push(progress.stage(Stage::Write, || target.fill(write))?);
                }
                Output::Outlines(target, format) => {
                    files.push(target.path().display().to_string());
                    let features = shapes.iter().zip(&rows).map(|(shape, row)| OutlineFeature {
                        shape: &shape.from_above,
                        properties: row.properties(column, unit),
                    });
                    let features: Vec<_> = features.collect();
                    let crs = crs.as_ref();
                    let write = |out: &mut dyn io::Write| format.write(&features, crs, out);
                    if let Some(text) = format.remark(crs) {
                        tracing::info!(target: OF_OUTPUTS, "{}: {text}", shown(target.path()));
                    }
                    filled.push(progress.stage(Stage::Write, || target.fill(write))?);
                }
                Output::Meshes(mut folder) => {
                    let mut told = Told::default();
                    for (GroupShape { value, shape, .. }, row) in shapes.iter().zip(&mut rows) {
                        let is_empty = |exporter: &dyn crate::export::Exporter| {
                            EmptyShape::check(shape, exporter.needs()).is_err()
                        };
                        empty += u32::from(meshes.iter().any(|mesh| is_empty(&*mesh.exporter)));
                        let whole = meshes.iter().filter(|mesh| !is_empty(&*mesh.exporter));
                        let stem = format!("{}-{value}", plain(column));
                        let (written, offsets) =
                            write_part(&mut folder, whole, &stem, shape, &mut told, &mut progress)?;
                        row.files.extend(written);
                        row.offsets.extend(offsets);
                    }
                    folders.push(folder);
                }
            }
        }
        put_all(filled)?;
        folders.into_iter().try_for_each(Folder::finish)?;
        if empty > 0 {
            tracing::warn!("groups without a file, as a mesh would be empty: {empty}");
        }
        print_summary(
            global,
            &GroupsReport {
                schema_version: SCHEMA_VERSION,
                input: input.input.to_string(),
                column: column.to_owned(),
                coordinates: weighed.origin.coordinates,
                alpha: parameter,
                points: weighed.points.len(),
                left_out: groups.left_out,
                volume: rows.iter().map(|row| row.volume).sum(),
                groups: rows,
                files,
                seconds: progress.finish().into_iter().collect(),
            },
        )
    }

    /// Opens the outputs, which must be a table, outlines, or a folder.
    fn outputs_of_groups(&self) -> Result<Vec<Output>> {
        let mut outputs = Vec::new();
        for path in &self.output {
            outputs.push(match kind(&self.format.named(path)?) {
                Some(Kind::Table) => Output::Table(Target::open(path)?),
                Some(Kind::Outlines(format)) => Output::Outlines(Target::open(path)?, format),
                Some(Kind::Meshes) => Output::Meshes(Folder::open(path, "--output", &[])?),
                None => {
                    fail_usage!("{} is one file, and --by makes a shape for each value", shown(path) => "name a table (.csv), outlines from above (.geojson, .gpkg), or a folder for meshes, as in -o trees")
                }
            });
        }
        Ok(outputs)
    }
}

#[derive(PartialEq)]
enum Kind {
    Table,
    Outlines(FeatureFormat),
    Meshes,
}

/// The kind of an output, by its extension: a folder has none.
fn kind(path: &std::path::Path) -> Option<Kind> {
    let extension = path.extension().map(|own| own.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        _ if path.is_dir() => Some(Kind::Meshes),
        Some("csv") => Some(Kind::Table),
        None => Some(Kind::Meshes),
        Some(extension) => FeatureFormat::of(extension).map(Kind::Outlines),
    }
}

/// The name of a column as a part of a file name.
fn plain(column: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || c == '_' { c } else { '_' };
    column.chars().map(kept).collect()
}

/// The facts about a group.
#[derive(Serialize)]
struct GroupRow {
    value: i64,
    points: usize,
    /// α as a squared length.
    alpha: Alpha,
    volume: f64,
    area: f64,
    /// The extent along z.
    height: f64,
    /// The area and perimeter of the outline from above, at the same α.
    outline_area: f64,
    outline_perimeter: f64,
    low: [f64; 3],
    high: [f64; 3],
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<String>,
    /// The offsets that files in single precision have subtracted from coordinates, if they have.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    offsets: Vec<FileOffset>,
}

impl GroupRow {
    fn of(group: &GroupShape) -> Self {
        let GroupShape { value, points, bounds: [low, high], shape, from_above, .. } = group;
        let measures = shape.measures();
        // Points on a line have no outline.
        let outline = from_above.outline().ok();
        Self {
            value: *value,
            points: *points,
            alpha: shape.options().alpha,
            volume: measures.volume,
            area: measures.area,
            height: if *points == 0 { 0.0 } else { high[2] - low[2] },
            outline_area: outline.map_or(0.0, |outline| outline.area),
            outline_perimeter: outline.map_or(0.0, |outline| outline.perimeter),
            low: *low,
            high: *high,
            files: Vec::new(),
            offsets: Vec::new(),
        }
    }

    /// The columns of a table beside the group's number, by name.
    fn columns(&self) -> [(&'static str, Value); 13] {
        let Self { low, high, .. } = self;
        [
            ("points", json!(self.points)),
            ("alpha", json!(self.alpha)),
            ("volume", json!(self.volume)),
            ("area", json!(self.area)),
            ("height", json!(self.height)),
            ("outline_area", json!(self.outline_area)),
            ("outline_perimeter", json!(self.outline_perimeter)),
            ("xmin", json!(low[0])),
            ("ymin", json!(low[1])),
            ("zmin", json!(low[2])),
            ("xmax", json!(high[0])),
            ("ymax", json!(high[1])),
            ("zmax", json!(high[2])),
        ]
    }

    fn properties(&self, column: &str, unit: &str) -> Map<String, Value> {
        let value = std::iter::once((column, json!(self.value)));
        let all = value.chain(self.columns()).chain([("unit", json!(unit))]);
        all.map(|(name, value)| (name.to_owned(), value)).collect()
    }
}

/// Writes a table with a row for each group. The column has its own name.
fn write_table(column: &str, rows: &[GroupRow], out: &mut dyn io::Write) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let Some(first) = rows.first() else { return Ok(()) };
    let names = std::iter::once(column).chain(first.columns().map(|(name, _)| name));
    table.write_record(names)?;
    for row in rows {
        let numbers = row.columns().map(|(_, number)| match number {
            Value::String(text) => text,
            Value::Null => String::new(),
            number => number.to_string(),
        });
        table.write_record(std::iter::once(row.value.to_string()).chain(numbers))?;
    }
    table.flush()
}

/// The summary printed after making a shape for each group.
#[derive(Serialize)]
struct GroupsReport {
    schema_version: u32,
    input: String,
    column: String,
    coordinates: Coordinates,
    /// The α of all groups.
    alpha: Parameter,
    /// The number of all points.
    points: usize,
    /// The number of points without a number in the column.
    left_out: usize,
    /// The volume of all groups together.
    volume: f64,
    groups: Vec<GroupRow>,
    files: Vec<String>,
    seconds: BTreeMap<&'static str, f64>,
}

impl Display for GroupsReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { column, points, left_out, groups, .. } = self;
        let unit = self.coordinates.unit.symbol();
        writeln!(f, "input     {}", name(&self.input))?;
        write!(f, "points    {points} in {} groups by {column}", groups.len())?;
        match left_out {
            0 => writeln!(f)?,
            left_out => writeln!(f, "; {left_out} have no {column}, and are in none")?,
        }
        writeln!(f, "lengths   in {}", self.coordinates)?;
        writeln!(f, "parameter {}, the same for all groups", self.alpha)?;
        for row in groups.iter().take(MOST_PRINTED) {
            writeln!(
                f,
                "group     {}: {} points, {} {unit}³, surface {} {unit}², height {} {unit}, outline {} {unit}²",
                row.value,
                row.points,
                rounded(row.volume),
                rounded(row.area),
                rounded(row.height),
                rounded(row.outline_area)
            )?;
        }
        if let more @ 1.. = groups.len().saturating_sub(MOST_PRINTED) {
            writeln!(
                f,
                "          and {more} more, which --json and -o {}.csv list",
                plain(column)
            )?;
        }
        writeln!(f, "volume    {} {unit}³ together", rounded(self.volume))?;
        print_offsets(groups.iter().flat_map(|group| &group.offsets), f)?;
        let written = groups.iter().flat_map(|group| group.files.clone());
        let files: Vec<String> = self.files.iter().cloned().chain(written).collect();
        let stages = ["read", "points", "alpha", "shape", "measure", "write", "total"];
        match &files[..] {
            all if all.len() > MOST_PRINTED => {
                let (first, last) = (name(&all[0]), name(&all[all.len() - 1]));
                writeln!(f, "wrote     {} files, {first} to {last}", all.len())?;
                ending(f, &[], &stages, &self.seconds)
            }
            all => ending(f, all, &stages, &self.seconds),
        }
    }
}
