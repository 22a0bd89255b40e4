//! Writers of filtrations: every simplex with the values of α at which it enters and changes class.

use std::fmt;
use std::io::{self, Write};
use std::path::Path;

use walpha_base::{Monitor, memory};
use zip::ZipWriter;

use super::claim::point_copies;
use super::npz::Archive;
use walpha_check::schema::{Below, BoxVectors, FiltrationFile, PairsFile, SchemaError, Values};
use walpha_shape::Alpha;
use walpha_shape::ladder::{Entry, Interval, Loops, Ordered};
use walpha_volume::UnknownFormat;

/// A format that filtrations are written in, chosen by file name extension.
#[derive(Clone, Copy)]
pub struct FiltrationFormat {
    /// The name, as users know it.
    pub name: &'static str,
    /// The extension, without the dot.
    pub extension: &'static str,
    /// A description of the content.
    pub about: &'static str,
    /// Whether the file has persistence pairs, which are computed on writing unless they are known.
    pub pairs: bool,
    write: fn(&Ordered<'_>, &mut dyn Write, &Monitor) -> io::Result<()>,
}

/// All formats. NPZ and JSON follow the [`schema`](walpha_check::schema::FiltrationFile) that `walpha check` and
/// `walpha compare` read.
pub static FILTRATION_FORMATS: &[FiltrationFormat] = &[
    FiltrationFormat {
        name: "NPZ",
        extension: "npz",
        about: "NumPy arrays, compressed: points, simplices, their values and order, pairs.",
        pairs: true,
        write: write_npz,
    },
    FiltrationFormat {
        name: "JSON",
        extension: "json",
        about: "The same as text.",
        pairs: true,
        write: write_json,
    },
    FiltrationFormat {
        name: "text",
        extension: "txt",
        about: "A line for each simplex, in order: value, Gabriel or not, intervals, vertices.",
        pairs: false,
        write: write_text,
    },
    FiltrationFormat {
        name: "CSV",
        extension: "csv",
        about: "The persistence diagram as a table: dimension, birth, death, and the simplices.",
        pairs: true,
        write: write_csv,
    },
    #[cfg(feature = "render")]
    FiltrationFormat {
        name: "SVG",
        extension: "svg",
        about: "The persistence diagram as a figure.",
        pairs: true,
        write: |ordered, out, monitor| {
            let figure = diagram(ordered, monitor)?;
            out.write_all(figure.to_svg().map_err(io::Error::other)?.as_bytes())
        },
    },
    #[cfg(feature = "render")]
    FiltrationFormat {
        name: "PNG",
        extension: "png",
        about: "The same figure in pixels.",
        pairs: true,
        write: |ordered, out, monitor| {
            let figure = diagram(ordered, monitor)?;
            out.write_all(&figure.to_png().map_err(io::Error::other)?)
        },
    },
];

impl FiltrationFormat {
    /// The format for the extension of a path.
    ///
    /// # Errors
    /// [`UnknownFormat`], which lists the known extensions.
    pub fn of(path: impl AsRef<Path>) -> Result<&'static Self, UnknownFormat> {
        let path = path.as_ref();
        let all = FILTRATION_FORMATS.iter().map(|format| (format.extension, format));
        UnknownFormat::find(path, "a filtration", all)
    }

    /// Writes the whole file. The same filtration gives the same bytes. Only pairs of simplices with different
    /// values are written.
    ///
    /// # Errors
    /// Errors of `out`; not enough memory.
    pub fn write(&self, ordered: &Ordered<'_>, out: &mut dyn Write) -> io::Result<()> {
        let monitor = &*Monitor::current();
        (self.write)(ordered, out, monitor)
    }
}

impl fmt::Debug for FiltrationFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FiltrationFormat").field("name", &self.name).finish_non_exhaustive()
    }
}

/// The pairs whose simplices have different values.
fn lasting(ordered: &Ordered<'_>, pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    pairs.iter().copied().filter(|&pair| ordered.lasts(pair)).collect()
}

/// The prefixes of the names of arrays, by dimension.
const DIMENSIONS: [&str; 4] = ["vertex", "edge", "facet", "cell"];

fn write_npz(ordered: &Ordered<'_>, out: &mut dyn Write, monitor: &Monitor) -> io::Result<()> {
    let loops = monitor.watch(|| ordered.loops()).map_err(io::Error::other)?;
    let pairs = ordered.pairs();
    let mut archive = Archive::compressed(ZipWriter::new_stream(out));
    let whole = ordered.filtration().whole();
    let copies = point_copies(whole);
    let own = whole.own_points();
    archive.rows("points", &whole.points().positions()[..own])?;
    archive.list("weights", &whole.power_weights()[..own])?;
    if let Some(copies) = copies {
        archive.rows("copies", &copies)?;
    }
    archive.list("vertices", ordered.vertices().as_flattened())?;
    archive.rows("edges", ordered.edges())?;
    archive.rows("facets", ordered.facets())?;
    archive.rows("cells", ordered.cells())?;
    let mut first = 0;
    for (dimension, name) in DIMENSIONS.into_iter().enumerate() {
        monitor.report(dimension as u64, DIMENSIONS.len() as u64).map_err(io::Error::other)?;
        let count = ordered.count(dimension) as u32;
        let numbers = first..first + count;
        first += count;
        let doubles = |of: fn(Entry<'_>) -> f64| -> Vec<f64> {
            numbers.clone().map(|number| of(ordered.simplex(number))).collect()
        };
        archive.list(&format!("{name}_values"), &doubles(|simplex| simplex.value))?;
        // A cell needs only its value, which is that of its own sphere: from there on it is interior.
        if name != "cell" {
            archive.list(&format!("{name}_regular"), &doubles(|simplex| simplex.regular))?;
            archive.list(&format!("{name}_interior"), &doubles(|simplex| simplex.interior))?;
            let gabriel = numbers.clone().map(|number| ordered.simplex(number).gabriel);
            archive.list(&format!("{name}_gabriel"), &gabriel.collect::<Vec<_>>())?;
        }
    }
    archive.list("order", ordered.order())?;
    archive.rows("component_pairs", &lasting(ordered, &pairs.components))?;
    archive.list("lasting_components", &pairs.lasting)?;
    archive.rows("loop_pairs", &lasting(ordered, &loops.pairs))?;
    archive.rows("void_pairs", &lasting(ordered, &pairs.voids))?;
    if let Some(torus) = ordered.filtration().torus() {
        archive.list("lasting_loops", &loops.lasting)?;
        archive.list("lasting_voids", &pairs.lasting_voids)?;
        archive.list("last_cell", pairs.last.as_slice())?;
        archive.box_vectors(torus)?;
    }
    archive.list("hidden", whole.hidden().unwrap_or_default())?;
    archive.rows("duplicates", whole.duplicates())?;
    archive.finish().map(drop)
}

fn write_json(ordered: &Ordered<'_>, out: &mut dyn Write, monitor: &Monitor) -> io::Result<()> {
    let loops = monitor.watch(|| ordered.loops()).map_err(io::Error::other)?;
    // A simplex needs at most four vertices, three numbers, and its position in the order.
    let each = size_of::<[u32; 4]>() + size_of::<[f64; 3]>() + size_of::<u32>();
    let bytes = ordered.len().saturating_mul(each);
    memory::afford(bytes, || format!("the JSON of {} simplices", ordered.len()))
        .map_err(io::Error::other)?;
    filtration_file(ordered, loops).write_json(out).map_err(|error| match error {
        SchemaError::Io(error) => error,
        other => io::Error::other(other),
    })
}

fn filtration_file(ordered: &Ordered<'_>, loops: &Loops) -> FiltrationFile {
    let pairs = ordered.pairs();
    let whole = ordered.filtration().whole();
    let mut first = [0; 4];
    for dimension in 1..4 {
        first[dimension] = first[dimension - 1] + ordered.count(dimension - 1) as u32;
    }
    let copies = point_copies(whole);
    let own = whole.own_points();
    let entries = |dimension: usize| {
        let numbers = first[dimension]..first[dimension] + ordered.count(dimension) as u32;
        numbers.map(|number| ordered.simplex(number))
    };
    let values = |dimension| entries(dimension).map(|simplex| alpha(simplex.value)).collect();
    fn below<'a, T, I: Iterator<Item = Entry<'a>>>(
        entries: impl Fn(usize) -> I,
        of: fn(Entry<'_>) -> T,
    ) -> Below<T> {
        let [vertices, edges, facets] =
            [0, 1, 2].map(|dimension| entries(dimension).map(of).collect());
        Below { vertices, edges, facets }
    }
    FiltrationFile {
        points: whole.points().positions()[..own].to_vec(),
        weights: Some(whole.power_weights()[..own].to_vec()),
        copies,
        vertices: ordered.vertices().as_flattened().to_vec(),
        edges: ordered.edges().to_vec(),
        facets: ordered.facets().to_vec(),
        cells: ordered.cells().to_vec(),
        values: Values {
            vertices: values(0),
            edges: values(1),
            facets: values(2),
            cells: values(3),
        },
        gabriel: Some(below(entries, |simplex| simplex.gabriel)),
        regular: Some(below(entries, |simplex| alpha(simplex.regular))),
        interior: Some(below(entries, |simplex| alpha(simplex.interior))),
        order: ordered.order().to_vec(),
        pairs: Some(PairsFile {
            components: lasting(ordered, &pairs.components),
            lasting: pairs.lasting.clone(),
            loops: Some(lasting(ordered, &loops.pairs)),
            lasting_loops: loops.lasting.clone(),
            voids: lasting(ordered, &pairs.voids),
            lasting_voids: pairs.lasting_voids.clone(),
            last: pairs.last,
        }),
        periodic: ordered.filtration().torus().map(|torus| BoxVectors(torus.vectors())),
        hidden: whole.hidden().map(<[u32]>::to_vec),
        duplicates: Some(whole.duplicates().to_vec()),
        info: Some(serde_json::json!({
            "program": concat!("walpha ", env!("CARGO_PKG_VERSION")),
            "coordinates": whole.coordinates(),
        })),
    }
}

fn alpha(squared: f64) -> Alpha {
    Alpha::from_squared(squared).expect("radii are numbers")
}

/// The number of lines between two reports of progress.
const REPORT_STEP: usize = 1 << 16;

fn write_text(ordered: &Ordered<'_>, out: &mut dyn Write, monitor: &Monitor) -> io::Result<()> {
    writeln!(out, "# value gabriel regular interior vertices")?;
    for (at, simplex) in ordered.iter().enumerate() {
        if at % REPORT_STEP == 0 {
            monitor.report(at as u64, ordered.len() as u64).map_err(io::Error::other)?;
        }
        // The debug format uses an exponent for numbers that would have hundreds of digits.
        let (value, gabriel) = (simplex.value, u8::from(simplex.gabriel));
        write!(out, "{value:?} {gabriel} {:?} {:?}", simplex.regular, simplex.interior)?;
        out.write_all(b" ")?;
        write_vertices(ordered, simplex.vertices, out)?;
        writeln!(out)?;
    }
    Ok(())
}

/// Writes the persistence diagram of all dimensions.
fn write_csv(ordered: &Ordered<'_>, out: &mut dyn Write, monitor: &Monitor) -> io::Result<()> {
    writeln!(out, "dimension,birth,death,birth_simplex,death_simplex")?;
    for (dimension, intervals) in persistence(ordered, monitor)?.into_iter().enumerate() {
        for Interval { birth, death, begins, ends, .. } in intervals {
            write!(out, "{dimension},{birth:?},{death:?},")?;
            write_vertices(ordered, ordered.simplex(begins).vertices, out)?;
            out.write_all(b",")?;
            let ends = ends.map(|ends| ordered.simplex(ends).vertices);
            write_vertices(ordered, ends.unwrap_or_default(), out)?;
            writeln!(out)?;
        }
    }
    Ok(())
}

/// Writes the vertices of a simplex, separated by spaces. `3:0:0:1` is the copy of point 3 that is moved by the third vector of a periodic box.
fn write_vertices(ordered: &Ordered<'_>, vertices: &[u32], out: &mut dyn Write) -> io::Result<()> {
    let whole = ordered.filtration().whole();
    vertices.iter().enumerate().try_for_each(|(at, &v)| {
        let space = if at == 0 { "" } else { " " };
        match whole.copied(v) {
            (v, [0, 0, 0]) => write!(out, "{space}{v}"),
            (v, [a, b, c]) => write!(out, "{space}{v}:{a}:{b}:{c}"),
        }
    })
}

/// The intervals of each dimension. Points in space have none of dimension 3.
fn persistence(ordered: &Ordered<'_>, monitor: &Monitor) -> io::Result<[Vec<Interval>; 4]> {
    monitor.watch(|| ordered.loops()).map_err(io::Error::other)?;
    let mut all = [const { Vec::new() }; 4];
    for (dimension, intervals) in all.iter_mut().enumerate() {
        *intervals = ordered.persistence(dimension).map_err(io::Error::other)?;
    }
    Ok(all)
}

#[cfg(feature = "render")]
fn diagram(ordered: &Ordered<'_>, monitor: &Monitor) -> io::Result<walpha_render::Figure> {
    let [components, loops, voids, _] = persistence(ordered, monitor)?
        .map(|intervals| intervals.iter().map(|i| [i.birth, i.death]).collect::<Vec<_>>());
    Ok(walpha_render::persistence_figure("Persistence", [&components, &loops, &voids]))
}
