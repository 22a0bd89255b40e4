//! Complexes whose rows name copies of points, as those of a larger box.

use walpha_base::memory::afford;

use crate::period::Period;
use crate::schema::{BoxVectors, Classes, ComplexFile, PointCopy, SchemaError};

/// The largest number of copies of a box.
const MOST: usize = 1 << 15;

/// The complex of several copies of the box, as few along each vector as are needed for every edge to span less than half of them; and
/// the number of copies. Each row is repeated for each copy. Without copies of points it is the complex itself.
///
/// # Errors
/// Copies without a box, or of points that do not exist, or so far away that too many boxes would be needed; rows out of range.
pub(crate) fn repeated(file: ComplexFile) -> Result<(ComplexFile, usize), SchemaError> {
    let Some(copies) = &file.copies else { return Ok((file, 1)) };
    let Some(vectors) = file.periodic else { return Err(SchemaError::Missing("periodic")) };
    let named = Named::of(&file, copies, Period::new(vectors))?;
    let times = named.times(&file)?;
    let count = times.iter().product::<i32>() as usize;
    let each = size_of::<[u32; 4]>() + size_of::<[f64; 3]>();
    let rows = [&file.cells.as_ref().map(Vec::len), &file.facets.as_ref().map(Vec::len)];
    let all = rows.into_iter().flatten().sum::<usize>() + file.points.len();
    let too_far = || SchemaError::Value {
        name: "copies",
        value: format!("copies so far away that {count} boxes would be needed"),
        expected: "copies near the box",
    };
    let fits = u32::try_from(count.saturating_mul(file.points.len())).is_ok();
    if !fits || afford(count.saturating_mul(all).saturating_mul(each), || "copies".into()).is_err()
    {
        return Err(too_far());
    }
    let all = All { named: &named, times };
    let BoxVectors(vectors) = vectors;
    let times_vector = |k: usize| vectors[k].map(|x| f64::from(times[k]) * x);
    let mut repeated = ComplexFile::of_points(all.points(), file.alpha);
    repeated.cells = all.rows(file.cells.as_ref());
    repeated.facets = all.rows(file.facets.as_ref());
    repeated.edges = all.rows(file.edges.as_ref());
    repeated.vertices = all.list(file.vertices.as_ref());
    repeated.classes = all.classes(&file.classes);
    repeated.hidden = all.list(file.hidden.as_ref());
    repeated.duplicates = all.rows(file.duplicates.as_ref());
    repeated.weights = file.weights.as_ref().map(|weights| weights.repeat(count));
    repeated.periodic = Some(BoxVectors([0, 1, 2].map(times_vector)));
    (repeated.voxels, repeated.isovalue) = (file.voxels, file.isovalue);
    Ok((repeated, count))
}

/// The points and their copies, by the indices that rows have.
struct Named<'a> {
    points: &'a [[f64; 3]],
    copies: &'a [PointCopy],
    period: Period,
}

impl<'a> Named<'a> {
    fn of(
        file: &'a ComplexFile,
        copies: &'a [PointCopy],
        period: Period,
    ) -> Result<Self, SchemaError> {
        let points = &file.points[..];
        let wrong = copies.iter().find(|copy| {
            let is_far = copy[1..].iter().any(|shift| shift.unsigned_abs() as usize > MOST);
            is_far || usize::try_from(copy[0]).map_or(true, |v| v >= points.len())
        });
        if let Some(wrong) = wrong {
            return Err(SchemaError::Value {
                name: "copies",
                value: format!("{wrong:?}"),
                expected: "a point number, and three small multiples of the vectors",
            });
        }
        let all = points.len() + copies.len();
        SchemaError::in_range("cells", file.cells.iter().flatten().flatten(), all)?;
        SchemaError::in_range("facets", file.facets.iter().flatten().flatten(), all)?;
        SchemaError::in_range("edges", file.edges.iter().flatten().flatten(), all)?;
        SchemaError::in_range("vertices", file.vertices.iter().flatten(), points.len())?;
        SchemaError::in_range("hidden", file.hidden.iter().flatten(), points.len())?;
        let duplicates = file.duplicates.iter().flatten().flatten();
        SchemaError::in_range("duplicates", duplicates, points.len())?;
        Ok(Self { points, copies, period })
    }

    /// A point, and its shift.
    fn vertex(&self, v: u32) -> (usize, [i32; 3]) {
        match (v as usize).checked_sub(self.points.len()) {
            None => (v as usize, [0; 3]),
            Some(copy) => {
                let [v, a, b, c] = self.copies[copy];
                (v as usize, [a, b, c])
            }
        }
    }

    fn place(&self, v: u32) -> [f64; 3] {
        let (v, shift) = self.vertex(v);
        self.period.moved(self.points[v], shift)
    }

    /// The smallest number of copies of the box along each vector with which each edge spans less than half of them.
    fn times(&self, file: &ComplexFile) -> Result<[i32; 3], SchemaError> {
        let mut times = [1; 3];
        let cells = file.cells.iter().flatten().map(|row| &row[..]);
        let facets = file.facets.iter().flatten().map(|row| &row[..]);
        let edges = file.edges.iter().flatten().map(|row| &row[..]);
        for row in cells.chain(facets).chain(edges) {
            for (i, &a) in row.iter().enumerate() {
                for &b in &row[..i] {
                    let [from, to] = [a, b].map(|v| self.place(v));
                    // The checker reports those that are not finite.
                    if from.iter().chain(&to).all(|x| x.is_finite()) {
                        self.period.lengthen(&mut times, from, to, MOST as i32);
                    }
                    if times.iter().map(|&n| n as usize).product::<usize>() > MOST {
                        return Err(SchemaError::Value {
                            name: "copies",
                            value: "an edge across many boxes".into(),
                            expected: "copies near the box",
                        });
                    }
                }
            }
        }
        Ok(times)
    }
}

/// All copies of the box.
struct All<'a> {
    named: &'a Named<'a>,
    times: [i32; 3],
}

impl All<'_> {
    fn shifts(&self) -> impl Iterator<Item = [i32; 3]> {
        let [a, b, c] = self.times;
        (0..c).flat_map(move |k| (0..b).flat_map(move |j| (0..a).map(move |i| [i, j, k])))
    }

    fn points(&self) -> Vec<[f64; 3]> {
        let Named { points, period, .. } = self.named;
        let moved = |shift| points.iter().map(move |&point| period.moved(point, shift));
        self.shifts().flat_map(moved).collect()
    }

    /// The index of a vertex, moved further.
    fn index(&self, v: u32, by: [i32; 3]) -> u32 {
        let (v, shift) = self.named.vertex(v);
        let [i, j, k] = [0, 1, 2].map(|k| (shift[k] + by[k]).rem_euclid(self.times[k]));
        let [a, b, _] = self.times;
        ((i + a * (j + b * k)) as usize * self.named.points.len() + v) as u32
    }

    fn rows<const N: usize>(&self, rows: Option<&Vec<[u32; N]>>) -> Option<Vec<[u32; N]>> {
        let of = |by| rows.into_iter().flatten().map(move |row| row.map(|v| self.index(v, by)));
        rows.map(|_| self.shifts().flat_map(of).collect())
    }

    fn list(&self, list: Option<&Vec<u32>>) -> Option<Vec<u32>> {
        let of = |by| list.into_iter().flatten().map(move |&v| self.index(v, by));
        list.map(|_| self.shifts().flat_map(of).collect())
    }

    fn classes(&self, classes: &Classes) -> Classes {
        let count = self.shifts().count();
        let mut all = classes.clone();
        let of_each = [&mut all.cells, &mut all.facets, &mut all.edges, &mut all.vertices];
        of_each.into_iter().flatten().for_each(|classes| *classes = classes.repeat(count));
        all
    }
}
