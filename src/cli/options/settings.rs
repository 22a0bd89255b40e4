//! The settings of a recipe as options: their help, and how they are given. Their meaning is defined in [`Settings`].

use std::marker::PhantomData;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use super::preset;
use crate::Weighting;
use crate::cli::process::errors::CommandError;
use crate::settings::{Group, Settings};
use crate::volume::Dtype;

/// The name on the command line, the name of the value (empty for a switch), and the help.
const HELP: &[(&str, &str, &str)] = &[
    (
        "input-format",
        "EXTENSION",
        "Format of INPUT where neither its content nor its name shows it, given as a file extension, as in --input-format xyz",
    ),
    (
        "gray",
        "LO..HI",
        "Values mapped to gray 0 and 255 [default: unchanged for unsigned 8-bit samples, otherwise min..max]",
    ),
    ("gray-out", "", "Write gray levels 0..255 instead of the values of INPUT"),
    (
        "columns",
        "NAME,NAME,…",
        "Columns of a table of points (CSV, XYZ, PTS, NPY): x, y, z, optionally weight (or radius) and value, and any other name for the remaining columns, as in x,y,z,nx,ny,nz. If z and other columns are absent, points lie in the plane z = 0 [default: from the header, otherwise guessed from the numbers; a fourth column is a value]",
    ),
    (
        "class",
        "CLASS,…",
        "Classes of points to read from LAS and LAZ: ground, vegetation, building, water, unclassified, or their numbers, as in 2,9 [default: all]",
    ),
    (
        "withheld",
        "",
        "Also take points of LAS and LAZ that are flagged as withheld, which are not to be processed",
    ),
    (
        "value",
        "COLUMN",
        "Column of points whose numbers are the values F: height (z), or a column of LAS, PLY, NPY or a table, as walpha info lists them [default: value, or intensity]",
    ),
    ("thin", "SIDE", "Keep the first point in each cube of this side, in the unit of the points"),
    (
        "radii",
        "SET",
        "Radii of atoms, whose squares are weights: bondi (van der Waals, by element), protor (amino acids, hydrogens included), column (of the file), none, or a FILE with lines as 'C 1.70' and 'ALA CB 1.88' [default: of the file, otherwise bondi]",
    ),
    ("hydrogens", "", "Also take hydrogens of PDB, mmCIF and GRO"),
    ("waters", "", "Also take water of PDB, mmCIF and GRO"),
    ("hetero", "", "Also take ligands, ions and modified residues of PDB and mmCIF (HETATM)"),
    ("chains", "A,B,…", "Chains to read from PDB, mmCIF and PQR [default: all]"),
    (
        "models",
        "N",
        "Model to read from PDB, mmCIF and PQR by its number, or all of them together (all) [default: the first]",
    ),
    (
        "level",
        "N",
        "Level of a pyramid (OME-Zarr), or of points in layers (WVM); 0 is the finest [default: 0]",
    ),
    (
        "array",
        "NAME",
        "Array to read from a file with several (VTK, NPZ) [default for VTK: the first point array]",
    ),
    (
        "frame",
        "K",
        "Volume to read from a file with several (a fourth axis; times, echoes or stacks of DICOM), or scan or step of points (PTS, XYZ, GRO, LAMMPS dump), counted from 0",
    ),
    (
        "series",
        "N",
        "Series to read from a folder with several (DICOM): its number in walpha info, or the end of its UID",
    ),
    ("skip-damaged", "", "Skip damaged slices of a series (DICOM), with a warning for each"),
    (
        "no-resample",
        "",
        "Refuse unevenly spaced slices (DICOM) instead of resampling them linearly to the finest spacing",
    ),
    (
        "nan",
        "VALUE",
        "Value that replaces samples that are NaN or infinite, or padding (DICOM); without a value they are masked: they become no points and are ignored when errors are measured. Padding is masked even without this option",
    ),
    (
        "roi",
        "X0:X1,Y0:Y1,Z0:Z1",
        "Read a part: of a volume a range of indices along x, y and z, each end exclusive; of points those in a box, in their unit. Ends may be omitted, as in 20:40,:,10:",
    ),
    (
        "downsample",
        "N",
        "Average blocks of N×N×N samples; of labels take the most frequent one. Samples at the end that fill no block are left out",
    ),
    ("dims", "X,Y,Z", "Sizes of a raw file along x, y and z (x fastest)"),
    ("dtype", "TYPE", ""),
    ("endian", "ORDER", "Byte order of a sample: little or big"),
    ("offset", "BYTES", "Bytes to skip at the start of the file"),
    (
        "label",
        "N,N,…",
        "Make the solid of labels of a segmentation, as in 3 or 3,5, or of all that are not 0 (all): its cells fill their voxels, without α [default: all, where values are labels and no option says what to look for]",
    ),
    (
        "surface",
        "VALUE",
        "Make the solid inside the isosurface of a volume at this value of INPUT, as in --surface 250 for Hounsfield units. The vertices of its boundary lie where edges of the grid cross the value; the samples, not α, decide which cells it has. auto takes the value that best divides the histogram; the suffix :closed keeps the largest part and fills its cavities, as in --surface auto:closed",
    ),
    ("haar", "KIND", "Decomposition: all axes once per level, or each axis fully"),
    ("rms", "E", "Root mean square error allowed, in gray levels"),
    ("epsilon", "E", "L² norm of the error allowed, in gray levels"),
    ("coefficients", "N", "Coefficients to keep"),
    (
        "select",
        "HOW",
        "Select the samples of largest gray difference, or adaptively: starting from the corners of the volume, those where the interpolant of the previous ones is worst",
    ),
    (
        "target-rmse",
        "E",
        "Adaptive: stop when the RMSE of the interpolant over all samples is at most E gray levels (--rms belongs to the wavelet stage). With --count or --ratio: at whichever comes first",
    ),
    (
        "max-error",
        "E",
        "Adaptive: stop when no sample is further than E gray levels from the interpolant, choosing points by that error. With --count or --ratio: at whichever comes first",
    ),
    (
        "exchange",
        "",
        "Adaptive: exchange points that contribute little for samples that contribute more, until no exchange gains anything. The error is that of fitted values: give --refit, too",
    ),
    ("count", "N", "Keep N samples"),
    (
        "ratio",
        "R",
        "Keep this share of all samples, 0 < R ≤ 1 [default: 0.0609, or all samples that differ from a neighbour if these are fewer]",
    ),
    ("threshold", "T", "Keep the samples whose gray difference is at least T gray levels"),
    ("gray-min", "G", "Drop samples below this gray level after truncation"),
    (
        "value-min",
        "V",
        "Drop samples below this value of INPUT: in Hounsfield units, 300 leaves bone",
    ),
    (
        "units",
        "UNITS",
        "Coordinates, α, weights and sizes in voxels, or in the unit of the file [default: world where the file states a spacing or an origin, otherwise voxel]",
    ),
    (
        "space",
        "SPACE",
        "Direction of world coordinates, where the file states the patient's orientation: x to the left and y to the back (lps), or to the right and the front (ras) [default: lps]",
    ),
    (
        "refit",
        "TO",
        "Fit the values of points to the volume by least squares: to all its samples, on the triangulation that interpolate --fill uses, or to those that the shape covers. Otherwise points have the values of their samples",
    ),
    (
        "alpha",
        "A",
        "The parameter α, a squared length in the units of the points: auto takes it from the spacing of the points, auto:connected is the smallest at which all points lie in one solid component, and inf gives the convex hull [default: auto for scattered points; 10·h² for a volume, where h³ is the volume of a voxel, and for its levels of detail no less than auto]",
    ),
    ("alpha-radius", "R", "Radius of the ball: the parameter α is its square"),
    (
        "alpha-ref",
        "A",
        "The α, a squared length, for which weights are computed; they are the same at every level, so that levels are nested [default: as --alpha of walpha shape]",
    ),
    (
        "weights",
        "KIND",
        "Weights ω: common=C, min-max, barycentric, barycentric-n or column; none unless the input has a column",
    ),
    (
        "balls",
        "READING",
        "A point is a ball of squared radius α + ω (power) or of radius α + ω (radius)",
    ),
    ("engine", "ENGINE", "Engine that computes the shape; all give the same answer"),
    ("blocks", "N", "Number of blocks [default: from threads and memory]"),
    (
        "memory",
        "SIZE",
        "Memory limit to size blocks for, as in 2G or 500M; not with options that need the whole triangulation (α = inf, --exterior, --hidden, --engine cgal)",
    ),
    ("exterior", "", "Keep the simplices outside the shape, too: the whole triangulation"),
    ("hidden", "", "Count and list the points that heavier ones hide: the whole triangulation"),
    (
        "periodic",
        "BOX",
        "Periodic box, in the unit of the points, which then lie on a torus: its sides, as in 10,10,20; lengths and angles, as in 10,10,15,90,90,120; three vectors, as nine numbers; or cell, the cell that the file states. If points repeat only along some vectors, append these, as in 10,10,20:xy; xy alone means the cell of the file along its first two vectors",
    ),
    (
        "keep",
        "N",
        "Keep the N largest components of the shape, compared by volume, or the largest one, as in --keep largest [default: all]",
    ),
    (
        "min-volume",
        "V",
        "Keep the components of at least this volume, in cubes of the unit of the points [default: all]",
    ),
];

/// The defaults that the help and `--print-config` show.
const DEFAULTS: [(&str, &str); 7] = [
    ("haar", "non-standard"),
    ("rms", "1"),
    ("select", "difference"),
    ("endian", "little"),
    ("offset", "0"),
    ("balls", "power"),
    ("engine", "auto"),
];

/// The option for a setting.
fn option(name: &'static str, heading: &'static str) -> Arg {
    let long = name.replace('_', "-");
    let described = HELP.iter().find(|(known, ..)| *known == long);
    let (long, value, help) = described.expect("a test looks for all of them");
    let arg = Arg::new(name).long(*long).help_heading(heading).help(*help);
    if value.is_empty() {
        return arg.action(ArgAction::SetTrue);
    }
    let default = DEFAULTS.iter().find(|(known, _)| *known == name).map(|(_, default)| *default);
    let arg = arg.value_name(*value).default_value(default);
    let arg = match Settings::choices(name) {
        Some(names) => {
            arg.value_parser(PossibleValuesParser::new(names.into_iter().map(|[name, help]| {
                let value = PossibleValue::new(name);
                if help.is_empty() { value } else { value.help(help) }
            })))
        }
        None => arg.value_parser(checked(name)),
    };
    match name {
        "gray" | "label" | "periodic" | "roi" | "surface" => arg.allow_hyphen_values(true),
        "weights" => arg.allow_hyphen_values(true).long_help(weights_help()),
        "class" => arg.action(ArgAction::Append).value_delimiter(','),
        "nan" => arg.num_args(0..=1).default_missing_value("mask"),
        "refit" => arg.num_args(0..=1).require_equals(true).default_missing_value("whole"),
        "alpha_radius" => arg.visible_alias("radius"),
        "dims" => arg.requires("dtype"),
        "dtype" => arg
            .requires("dims")
            .help(format!("Type of a sample: {}", Dtype::ALL.map(Dtype::name).join(", "))),
        "endian" | "offset" => arg.requires("dims"),
        _ => arg,
    }
}

/// A parser for text that must be a value of a setting.
fn checked(name: &'static str) -> impl TypedValueParser<Value = String> {
    clap::builder::StringValueParser::new().try_map(move |text| {
        Settings::default().set(name, &text).map(|()| text).map_err(CommandError::from)
    })
}

fn weights_help() -> String {
    format!(
        "Weights ω (squared lengths): {} [default: column where the input has weights, else common=0]; column \
         takes the values as weights if no column is called weight or radius",
        Weighting::known()
    )
}

/// The groups of settings that a command takes.
pub(crate) trait Groups {
    /// The groups, each with the heading of its options in the help.
    const GROUPS: &[(Group, &str)];
}

/// Declares the options of some groups. Their values are in [`Given`].
pub(crate) struct Declared<G>(PhantomData<G>);

impl<G> Clone for Declared<G> {
    fn clone(&self) -> Self {
        Self(PhantomData)
    }
}

impl<G: Groups> Args for Declared<G> {
    fn augment_args(mut command: Command) -> Command {
        for &(group, heading) in G::GROUPS {
            for name in Settings::names(group) {
                let mut arg = option(name, heading);
                for other in Settings::excluded_by(name) {
                    if command.get_arguments().any(|known| known.get_id() == other) {
                        arg = arg.conflicts_with(other);
                    }
                }
                command = command.arg(arg);
            }
        }
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<G: Groups> FromArgMatches for Declared<G> {
    fn from_arg_matches(_: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self(PhantomData))
    }

    fn update_from_arg_matches(&mut self, _: &ArgMatches) -> Result<(), clap::Error> {
        Ok(())
    }
}

/// The settings given to a command: those typed take precedence over those of the file of `--config`, and these over those of the
/// preset.
#[derive(Clone, Default)]
pub(crate) struct Given {
    pub settings: Settings,
    /// Whether a preset was named.
    pub preset: bool,
}

impl FromArgMatches for Given {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut settings = Settings::default();
        let is_declared = |name: &str| matches.try_contains_id(name).is_ok();
        for &(name, _) in Settings::NAMES {
            if is_declared(name) && matches.value_source(name) == Some(ValueSource::CommandLine) {
                let values = matches.get_raw(name).into_iter().flatten();
                let text: Vec<_> = values.map(|value| value.to_string_lossy()).collect();
                settings.set(name, &text.join(",")).expect("its parser let it through");
            }
        }
        let preset = matches.try_get_one::<String>(preset::OPTION).ok().flatten();
        if let Some(name) = preset {
            let mut of_command = Settings::default();
            for (name, text) in Settings::preset(name).expect("the parser knows it").iter() {
                if is_declared(name) {
                    of_command.set(name, text).expect("presets are settings");
                }
            }
            settings = settings.over(&of_command);
        }
        Ok(Self { settings, preset: preset.is_some() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for Given {
    fn augment_args(command: Command) -> Command {
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Recipe;

    /// The defaults in the help are the defaults of the recipe: giving one changes nothing.
    #[test]
    fn every_setting_has_help_and_defaults_are_those_of_the_recipe() {
        let of_help: Vec<String> = HELP.iter().map(|(name, ..)| name.replace('-', "_")).collect();
        let names: Vec<&str> = Settings::NAMES.iter().map(|(name, _)| *name).collect();
        assert_eq!(of_help, names);
        for (name, default) in DEFAULTS {
            let mut settings = Settings::default();
            settings.set(name, default).unwrap();
            assert_eq!(settings.recipe().unwrap(), Recipe::default(), "{name}");
        }
    }
}
