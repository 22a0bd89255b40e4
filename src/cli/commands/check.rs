//! `walpha check`: checks whether a complex is the α-complex of its points.

use std::fmt::{self, Display};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, ValueEnum};
use serde::{Serialize, Serializer};
use walpha_base::shown::{counted, number, shown};

use crate::check::meshes::{Mesh, MeshFormat};
use crate::check::schema::{
    AnyFile, Classes, ComplexFile, FiltrationFile, PlacedComplex, SchemaError,
};
use crate::check::{
    Claim, Comparison, Complex, Extent, FiltrationFinding, Finding, LikelyCause, Placed, Verdict,
    certify_filtration, compare, count_by_rule, enumerate, keep_causes, likely_cause,
    likely_cause_of_values,
};
use crate::export::{Target, UnknownFormat, write_findings};
use crate::pipeline::{AlphaRule, Input, Opened, Values};
use crate::points::{CellCount, Weighting};
use crate::progress::Stage;
use crate::shape::placed_complex;
use crate::volume::{OpenFile, OpenVolume};
use walpha_points::internal::{cells_of_file, read_complex_file};

use crate::cli::commands::compare;
use crate::cli::commands::pipeline;
use crate::cli::options::global::{DIFFERENT, Global, SUCCESS, UNDECIDED};
use crate::cli::options::{Declared, OfShape, Periodic, PipelineArgs, preset, refuse_gray_levels};
use crate::cli::process::errors::{CommandError, Result, command_error, fail, fail_usage};
use crate::cli::process::output::{name, print_summary};
use crate::cli::process::progress::Progress;
use crate::cli::report::SCHEMA_VERSION;
use crate::settings::Settings;

/// Check a complex exactly: one computed here, or one that another program wrote.
///
/// INPUT is a volume or points, from which an engine computes a shape; a complex or filtration
/// (.json, .npz); or a mesh of tetrahedra (.vtu, .vtk, .ply, .msh of Gmsh, .node and .ele of tetgen, .mesh of
/// Medit), whose cells are judged. A file that states no α is judged as a triangulation (α = ∞).
/// Coordinates in text are decimal numbers, each rounded to the nearest double. The checker shares
/// no arithmetic and no algorithm with the engines or CGAL.
///
/// The verdict is exact; or valid, if it differs from CGAL's answer only in how ties are broken (points
/// on one empty sphere, or equal points); or wrong. A file that lists cells but no facets, edges or vertices of
/// its own is judged by its cells. The exit code is 3 if the verdict is wrong (with --ties exact, also if it is
/// valid); 4 if nothing wrong was found, but too many points are near each other to search for missing simplices.
///
/// Examples:
///
/// walpha check ct.nii.gz --gray 0..1000 --gray-min 64 --threshold 30   # made here
///
/// walpha check skull.json   # a file
///
/// walpha check theirs.json --points skull.csv   # its points elsewhere
///
/// walpha check theirs.vtu --ties exact   # ties as in CGAL
///
/// walpha check theirs.msh -o findings.vtu   # what is wrong, to look at
#[derive(Args)]
#[command(mut_arg("input", |input| input.help(JUDGED)))]
pub(crate) struct Check {
    /// Points of the complex, filtration or mesh, if its file lists none or has rounded them, with their weights
    /// if they have any: .csv or .npy.
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Write the simplices and points that are wrong to FILE (.vtu), with the number of the finding and the rule of
    /// each.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also build the complex from the definition, and compare (at most 200 points).
    #[arg(long)]
    enumerate: bool,
    /// Which choices at ties are accepted: any, or only CGAL's (exact); any other is then a finding.
    #[arg(long, value_enum, default_value_t, value_name = "CHOICE")]
    ties: Ties,
    #[command(flatten)]
    pipeline: PipelineArgs,
    #[command(flatten)]
    shape: Declared<OfShape>,
    #[command(flatten)]
    periodic: Declared<Periodic>,
}

/// Which choices at ties are accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Ties {
    /// Any.
    #[default]
    Any,
    /// Only that of the perturbation.
    Exact,
}

/// What INPUT is.
const JUDGED: &str = "Complex, filtration or mesh to judge, or a volume or points whose shape is computed and judged";
/// The largest number of points for `--enumerate`: more would take hours.
const MOST_ENUMERATED: usize = 200;
/// The largest number of findings printed as text; all are counted.
const MOST_PRINTED: usize = 20;
/// The largest number of findings listed in JSON.
const MOST_LISTED: usize = 1000;

/// The summary printed after checking a complex or filtration.
#[derive(Serialize)]
struct CheckSummary<F, C> {
    schema_version: u32,
    input: String,
    /// The subject in words: the complex of a file, or our own shape.
    judged: String,
    points: usize,
    /// The numbers of cells, facets, edges and vertices.
    simplices: [usize; 4],
    /// The extent of a complex; absent for a filtration.
    #[serde(skip_serializing_if = "Option::is_none")]
    extent: Option<&'static str>,
    verdict: Verdict,
    /// Whether the verdict counts as right; with --ties exact, whether it is exact. It is false if not everything was judged.
    valid: bool,
    findings_total: usize,
    /// The number of findings for each rule.
    #[serde(rename = "findings_by_rule", serialize_with = "as_map")]
    by_rule: Vec<(&'static str, usize)>,
    /// One mistake that explains many findings; null if none is known that does.
    likely_cause: Option<LikelyCause>,
    /// The first findings.
    findings: Vec<F>,
    /// Whether exact numbers are printed as fractions.
    #[serde(skip)]
    as_fractions: bool,
    certificate: C,
    /// Notes on the verdict: how numbers were read, and what was left out.
    notes: Vec<String>,
    /// The rules and points that were not judged, in words.
    #[serde(skip)]
    not_judged: Vec<String>,
    /// The verdict with its reason.
    #[serde(skip)]
    words: String,
    enumeration: Option<Comparison>,
    seconds: f64,
}

/// Writes pairs as an object, in their order.
fn as_map<S: Serializer>(pairs: &[(&str, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().copied())
}

impl Check {
    pub(crate) fn run(self, global: Global) -> Result<u8> {
        let input = self.pipeline.input.clone();
        // All steps read one file; standard input is copied to a temporary one.
        pipeline::with_file(&input, |file| {
            let mut check = self;
            check.pipeline.input.input = file.as_os_str().to_owned().into();
            check.judge(global, &input.input)
        })
    }

    /// Judges INPUT, and reports it under the name `input`.
    fn judge(self, global: Global, input: &str) -> Result<u8> {
        let file = self.pipeline.input.input.clone();
        let path = file.path();
        let mut progress = Progress::new(global);
        if compare::is_named(path) {
            return match progress.stage(Stage::Read, || compare::opened(path))? {
                AnyFile::Complex(complex) => {
                    let of = JudgedInput {
                        input,
                        kind: "the complex",
                        why: "is a complex, made already",
                    };
                    self.given(global, of, complex.into(), progress)
                }
                AnyFile::Filtration(filtration) => {
                    self.given_filtration(global, input, filtration, progress)
                }
            };
        }
        let recipe = self.pipeline.input.recipe()?;
        let open = || recipe.opened(path).map_err(pipeline::unread);
        // Contradicting options are reported even if the file does not exist.
        let opened = progress
            .stage(Stage::Read, open)
            .or_else(|error| self.pipeline.recipe().and(Err(error)))?;
        match &opened {
            Opened::Points(file) => {
                let cells = cells_of_file(file, &self.pipeline.input.point_options()?)?;
                if !cells.is_empty() {
                    return self.mesh(global, input, file, &cells, progress);
                }
            }
            Opened::Volume(OpenVolume::File(file)) => {
                if let Some(format) = mesh_format(path) {
                    let mesh = progress.stage(Stage::Read, || read_mesh(format, file))?;
                    let count = mesh.complex.cells.as_ref().map_or(0, Vec::len);
                    let kind = format!("the {count} tetrahedra");
                    let why = "lists tetrahedra, which are judged";
                    return self.given(
                        global,
                        JudgedInput { input, kind: &kind, why },
                        mesh,
                        progress,
                    );
                }
            }
            Opened::Made(..) | Opened::Volume(OpenVolume::Named(_)) => {}
        }
        let computed = self.compute(path, opened, &mut progress)?;
        let mut judged = format!("our own shape of {}", name(input));
        if computed.complex.lists_exterior() {
            judged += ", exterior simplices included";
        }
        let subject = Subject { input, judged, notes: Vec::new(), is_cells_alone: false };
        self.complex(global, subject, &computed, progress)
    }

    /// Judges the cells that a file of points lists.
    fn mesh(
        self,
        global: Global,
        input: &str,
        file: &OpenFile,
        cells: &[CellCount],
        mut progress: Progress,
    ) -> Result<u8> {
        let listed = cells.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let read = || {
            read_complex_file(file, &self.pipeline.input.point_options()?).map_err(|error| {
                let CommandError { why, next, .. } = CommandError::from(error);
                let csv = "write its points by `walpha points INPUT -o points.csv` to judge our own shape of them";
                let next = next.map_or(csv.to_owned(), |next| format!("{next}, or {csv}"));
                command_error!("{} lists {listed}: {why}", name(input) => "{next}")
            })
        };
        let mesh = progress.stage(Stage::Read, read)?;
        let (kind, why) = (format!("the {listed}"), format!("lists {listed}, which are judged"));
        self.given(global, JudgedInput { input, kind: &kind, why: &why }, mesh, progress)
    }

    /// Judges a complex or mesh in a file, together with the data that options add.
    fn given(
        self,
        global: Global,
        JudgedInput { input, kind, why }: JudgedInput,
        mesh: Mesh,
        progress: Progress,
    ) -> Result<u8> {
        let Mesh { complex: mut file, attribute, notes, .. } = mesh;
        let alpha = match self.pipeline.settings().parameter() {
            AlphaRule::Given(alpha) => Some(alpha),
            _ => None,
        };
        if alpha.is_some() && !file.states_no_alpha() {
            let states = match (&file.voxels, file.isovalue) {
                (Some(_), _) => "is of labels, without α",
                (None, Some(_)) => "is inside an isosurface, without α",
                (None, None) => "states its α",
            };
            fail_usage!("--alpha has no effect: {} {states}", name(input) => "omit it");
        }
        let takes_column = self.pipeline.settings().weights() == Some(&Weighting::Column);
        let mut used = vec!["alpha", "alpha_radius"];
        if attribute.is_some() && takes_column {
            file.weights = attribute;
            used.push("weights");
        }
        self.refuse_shape_options(&used, format!("{} {why}", name(input)))?;
        file.alpha = alpha.unwrap_or(file.alpha);
        if let Some(points) = &self.points {
            compare::replace_points(&mut file.points, &mut file.weights, points)?;
        }
        let mut judged = format!("{kind} of {}", name(input));
        if file.states_no_alpha() {
            judged += " as a triangulation (α = ∞; --alpha makes it a shape)";
        }
        if let Some(voxels) = &file.voxels {
            judged += &format!(", the solid of {} voxels", voxels.count());
        }
        if let Some(isovalue) = file.isovalue {
            judged += &format!(", the solid inside the isosurface at {}", number(isovalue));
        }
        let is_cells_alone = file.is_cells_alone();
        let path = self.pipeline.input.input.path();
        let complex =
            PlacedComplex::try_from(file).map_err(|error| compare::refusal(path, error))?;
        if complex.claim().extent == Extent::Shape && complex.lowest > 0 {
            judged += match complex.lowest {
                3 => ", by its cells",
                2 => ", by its cells and facets",
                _ => ", by its cells, facets and edges",
            };
        }
        let subject = Subject { input, judged, notes, is_cells_alone };
        self.complex(global, subject, &complex, progress)
    }

    /// Judges a filtration in a file.
    fn given_filtration(
        self,
        global: Global,
        input: &str,
        mut file: FiltrationFile,
        progress: Progress,
    ) -> Result<u8> {
        self.refuse_shape_options(&[], format!("{} is a filtration, made already", name(input)))?;
        if self.output.is_some() {
            fail_usage!("--output is for findings on a complex or mesh, and {} is a filtration", name(input) => "omit it, or check a complex");
        }
        if self.enumerate {
            fail_usage!("--enumerate belongs to a complex, and {} is a filtration", name(input) => "omit it");
        }
        if let Some(points) = &self.points {
            compare::replace_points(&mut file.points, &mut file.weights, points)?;
        }
        let path = self.pipeline.input.input.path();
        file.check().map_err(|error| compare::refusal(path, error))?;
        self.filtration(global, input, &file, progress)
    }

    /// Refuses the options that control how a shape is computed, except `except`.
    fn refuse_shape_options(&self, except: &[&str], why: String) -> Result<()> {
        let settings = Settings::NAMES.iter().map(|(name, _)| *name).chain([preset::OPTION]);
        let names: Vec<&str> = settings.filter(|name| !except.contains(name)).collect();
        self.pipeline.input.typed.refuse(&names, why)
    }

    /// Computes the shape of INPUT.
    fn compute(
        &self,
        path: &Path,
        opened: Opened,
        progress: &mut Progress,
    ) -> Result<PlacedComplex> {
        let mut recipe = self.pipeline.recipe()?;
        if self.points.is_some() {
            fail_usage!("--points belongs to a complex or a mesh, and {} is neither", shown(path) => "omit it");
        }
        let input = &self.pipeline.input;
        input.typed.refuse(&["refit"], "values are not judged")?;
        let read = pipeline::read_opened(opened, input, &mut recipe, progress)?;
        if let Input::Volume(volume) = &read {
            if recipe.labels.is_some() {
                refuse_gray_levels(input)?;
                let model = progress.watch(|| recipe.solid(volume))?;
                return Ok(placed_complex(&model.shape));
            }
            if let Some(surface) = recipe.surface {
                let model = progress.watch(|| recipe.solid_inside(volume, surface))?;
                return Ok(placed_complex(&model.shape));
            }
        }
        let (weighed, _) = pipeline::weigh(read, input, &recipe, Values::Written, progress)?;
        // In the whole triangulation every rule can be judged. Shapes made in several blocks are judged as they are; and on a
        // torus the whole triangulation may have an edge that is too long, unlike the shape.
        recipe.exterior |= recipe.blocks.is_none_or(|blocks| blocks.get() == 1)
            && recipe.memory.is_none()
            && recipe.periodic.is_none();
        let model = pipeline::shape(weighed, &recipe, progress)?;
        Ok(placed_complex(&model.shape))
    }

    /// Judges a complex.
    fn complex(
        &self,
        global: Global,
        Subject { input, judged: subject, notes, is_cells_alone }: Subject,
        judged: &PlacedComplex,
        mut progress: Progress,
    ) -> Result<u8> {
        let n = judged.positions.len();
        if self.enumerate && judged.periodic.is_some() {
            fail!("--enumerate does not support a periodic box" => "omit it");
        }
        if self.enumerate && judged.voxels.is_some() {
            fail!("--enumerate builds α-shapes, and this is the solid of labels" => "omit it");
        }
        if self.enumerate && judged.isovalue.is_some() {
            fail!("--enumerate builds α-shapes, and this is the solid inside an isosurface" => "omit it");
        }
        if self.enumerate && n > MOST_ENUMERATED {
            fail!("--enumerate takes at most {MOST_ENUMERATED} points, and there are {n}" => "omit it");
        }
        let target = self.output.as_deref().map(findings_target).transpose()?;
        let (claim, complex) = (judged.claim(), &judged.complex);
        let started = Instant::now();
        let (mut findings, mut certificate) = progress.watch(|| {
            Stage::Certify.begin()?;
            judged.findings()
        })?;
        if is_cells_alone {
            keep_causes(&mut findings, &mut certificate);
        }
        findings.retain(|finding| self.ties == Ties::Exact || !finding.is_tie());
        let seconds = started.elapsed().as_secs_f64();
        if let Some(target) = target {
            let write = || target.write(|out| write_findings(&findings, &judged.positions, out));
            progress.stage(Stage::Write, write)?;
        }
        let enumeration =
            if self.enumerate { Some(progress.watch(|| by_definition(judged))?) } else { None };
        progress.finish();
        let rules = certificate.not_judged.iter().map(ToString::to_string);
        // Enumeration breaks ties by CGAL's rule, so it may differ if other ways are right, too.
        let differing = enumeration.as_ref().filter(|comparison| {
            let is_excused = self.ties == Ties::Any && certificate.verdict == Verdict::Valid;
            !(comparison.is_equal() || is_excused)
        });
        let (verdict, words) = match differing {
            Some(comparison) if findings.is_empty() => {
                (Verdict::Wrong, differs_from_definition(comparison))
            }
            _ => (certificate.verdict, certificate.to_string()),
        };
        let facts = CheckSummary {
            schema_version: SCHEMA_VERSION,
            input: input.to_owned(),
            judged: subject,
            points: judged.points_in_box(),
            simplices: [
                complex.cells.len(),
                complex.facets.len(),
                complex.edges.len(),
                complex.vertices.len(),
            ]
            .map(|count| count / judged.copies),
            extent: Some(match claim.extent {
                _ if judged.voxels.is_some() => "labels",
                _ if judged.isovalue.is_some() => "isosurface",
                Extent::Whole => "whole",
                Extent::Shape => "shape",
            }),
            verdict,
            valid: findings.is_empty() && differing.is_none() && verdict.is_complete(),
            findings_total: findings.len(),
            by_rule: count_by_rule(findings.iter().map(Finding::rule)),
            likely_cause: likely_cause(&findings, claim.placed.alpha),
            findings,
            as_fractions: global.verbose,
            notes,
            not_judged: rules.collect(),
            words,
            certificate,
            enumeration,
            seconds,
        };
        facts.print(global)
    }

    /// Judges a filtration.
    fn filtration(
        &self,
        global: Global,
        input: &str,
        file: &FiltrationFile,
        mut progress: Progress,
    ) -> Result<u8> {
        let started = Instant::now();
        let (mut findings, certificate) = progress.watch(|| {
            Stage::Certify.begin()?;
            certify_filtration(file)
        })?;
        findings.retain(|finding| self.ties == Ties::Exact || !finding.is_tie());
        let seconds = started.elapsed().as_secs_f64();
        progress.finish();
        let of_triangulation = certificate.triangulation.not_judged.iter().map(ToString::to_string);
        let of_values = certificate.not_judged.iter().map(ToString::to_string);
        let facts = CheckSummary {
            schema_version: SCHEMA_VERSION,
            input: input.to_owned(),
            judged: format!("the filtration of {}", name(input)),
            points: file.points.len(),
            simplices: [file.cells.len(), file.facets.len(), file.edges.len(), file.vertices.len()],
            extent: None,
            verdict: certificate.verdict,
            valid: findings.is_empty(),
            findings_total: findings.len(),
            by_rule: count_by_rule(findings.iter().map(FiltrationFinding::rule)),
            likely_cause: likely_cause_of_values(&findings, file),
            findings,
            as_fractions: global.verbose,
            notes: Vec::new(),
            not_judged: of_triangulation.chain(of_values).collect(),
            words: certificate.to_string(),
            certificate,
            enumeration: None,
            seconds,
        };
        facts.print(global)
    }
}

/// The name of INPUT, the kind of its content that is judged, and the reason why it takes no options of a shape.
struct JudgedInput<'a> {
    input: &'a str,
    kind: &'a str,
    why: &'a str,
}

/// The name of INPUT, the subject in words, and notes on the verdict.
struct Subject<'a> {
    input: &'a str,
    judged: String,
    notes: Vec<String>,
    /// Whether only the cells of a triangulation are listed.
    is_cells_alone: bool,
}

/// The format of a file that contains nothing but a mesh. `.vtk` is excluded: such a file may also contain points or a volume, so
/// its content decides.
pub(crate) fn mesh_format(path: &Path) -> Option<&'static MeshFormat> {
    MeshFormat::of(path).filter(|format| !format.extensions.contains(&"vtk"))
}

/// The file for findings.
fn findings_target(path: &Path) -> Result<Target> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vtu")) {
        return Err(UnknownFormat::new(path, "findings", ["vtu"]).into());
    }
    Ok(Target::open(path)?)
}

/// Reads a mesh.
pub(crate) fn read_mesh(format: &MeshFormat, file: &OpenFile) -> Result<Mesh> {
    let mesh = format.read_bytes(file.path(), &file.bytes()?);
    mesh.map_err(|error| CommandError::from(error).context(shown(file.path())))
}

/// Compares a complex (A) with the one built from the definition (B).
fn by_definition(judged: &PlacedComplex) -> Result<Comparison> {
    Stage::Enumerate.begin()?;
    let claim = judged.claim();
    let judged = claim.placed;
    let made = enumerate(judged.positions, judged.weights, judged.alpha)?;
    let made = match claim.extent {
        Extent::Shape if claim.lowest > 0 => listed_from(claim.lowest, judged, made.complex)?,
        _ => made.complex,
    };
    Ok(compare(judged, judged.with_complex(&made))?)
}

/// A complex without those simplices below a dimension that are not faces of one of that dimension.
fn listed_from(
    lowest: usize,
    judged: Placed,
    mut complex: Complex,
) -> Result<Complex, SchemaError> {
    complex.retain_shape();
    let mut file = ComplexFile::from(Claim::new(judged.with_complex(&complex)));
    file.classes = Classes::default();
    file.vertices = None;
    file.edges = file.edges.filter(|_| lowest < 2);
    file.facets = file.facets.filter(|_| lowest < 3);
    Ok(PlacedComplex::try_from(file)?.complex)
}

/// The verdict on a complex (A) that breaks no rule but differs from that of the definition (B), with the differences.
fn differs_from_definition(comparison: &Comparison) -> String {
    let names = ["vertices", "edges", "facets", "cells"].into_iter().zip(&comparison.dimensions);
    let counts = names.map(|(name, differences)| {
        let (only_a, only_b) = (differences.only_a.len(), differences.only_b.len());
        (name, only_a, only_b, differences.classes.len())
    });
    let differing = counts.filter(|(_, a, b, classes)| a + b + classes > 0).map(
        |(name, only_a, only_b, classes)| {
            format!("{name} ({only_a} too many, {only_b} missing, {classes} of another class)")
        },
    );
    let differing: Vec<String> = differing.collect();
    format!(
        "{}: no rule is broken, but the complex made from the definition has other {}",
        Verdict::Wrong,
        differing.join(", ")
    )
}

impl<F: Serialize + Display, C: Serialize> CheckSummary<F, C> {
    /// Prints the summary, and returns the exit code.
    fn print(mut self, global: Global) -> Result<u8> {
        self.findings.truncate(MOST_LISTED);
        print_summary(global, &self)?;
        Ok(match self.verdict {
            _ if self.valid => SUCCESS,
            verdict if self.findings_total == 0 && !verdict.is_complete() => UNDECIDED,
            _ => DIFFERENT,
        })
    }
}

impl<F: Display, C> Display for CheckSummary<F, C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [cells, facets, edges, vertices] = self.simplices;
        writeln!(f, "judged    {}, over {}", self.judged, counted(self.points as u64, "point"))?;
        writeln!(
            f,
            "          {cells} cells, {facets} facets, {edges} edges, {vertices} vertices"
        )?;
        for note in &self.notes {
            writeln!(f, "note      {note}")?;
        }
        for rule in &self.not_judged {
            writeln!(f, "not judged: {rule}")?;
        }
        if self.findings_total > 1 {
            let counts: Vec<String> =
                self.by_rule.iter().map(|(rule, count)| format!("{count} {rule}")).collect();
            writeln!(f, "by rule   {}", counts.join(", "))?;
        }
        if let Some(cause) = &self.likely_cause {
            writeln!(f, "likely    {cause}")?;
        }
        for finding in self.findings.iter().take(MOST_PRINTED) {
            if self.as_fractions {
                writeln!(f, "found     {finding:#}")?;
            } else {
                writeln!(f, "found     {finding}")?;
            }
        }
        if self.findings_total > MOST_PRINTED {
            writeln!(f, "          and {} more", self.findings_total - MOST_PRINTED)?;
        }
        if let Some(enumeration) = &self.enumeration {
            writeln!(f, "against the definition (A: judged, B: made from the definition)")?;
            writeln!(f, "{enumeration}")?;
        }
        writeln!(f, "verdict   {} ({:.2} s)", self.words, self.seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Alpha;
    use crate::check::enumerate;

    /// The verdict names the findings of the enumeration alone.
    #[test]
    fn the_verdict_says_in_what_the_definition_differs() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let alpha = Alpha::from_squared(1.0).unwrap();
        let made = enumerate(&positions, &[0.0; 4], alpha).unwrap().complex;
        let mut less = made.clone();
        less.cells = [].into_iter().collect();
        let placed = |complex| Placed::new(&positions, &[0.0; 4], alpha, complex);
        let comparison = compare(placed(&less), placed(&made)).unwrap();
        assert_eq!(
            differs_from_definition(&comparison),
            "wrong: no rule is broken, but the complex made from the definition has other \
             cells (0 too many, 1 missing, 0 of another class)"
        );
    }
}
