use walpha_base::advice::{Advice, Advise, Category};

use crate::render::{Colours, Mesh, Rgb, Scene, Shading};

/// The triangles of an OFF file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OffMesh {
    /// Vertices, (x, y, z).
    pub positions: Vec<[f64; 3]>,
    /// Vertices of each facet.
    pub facets: Vec<[u32; 3]>,
    /// The colour of each facet.
    pub colours: Vec<Rgb>,
}

/// A text is not an OFF file of coloured triangles.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: expected {expected}, got {got:?}")]
pub struct OffError {
    line: usize,
    expected: &'static str,
    got: String,
}

/// walpha reads only its own files.
impl Advise for OffError {
    fn advice(&self) -> Option<Advice> {
        Some("this is a fault of walpha, please report it".into())
    }

    fn category(&self) -> Category {
        Category::Program
    }
}

impl OffMesh {
    /// Reads the OFF files that [`Off`](crate::export::Off) writes, as Geomview would: the word
    /// OFF, three counts, vertices, and triangles with a colour each; `#` starts a comment.
    ///
    /// # Errors
    /// [`OffError`] names the line that is wrong or missing.
    pub fn parse(text: &str) -> Result<Self, OffError> {
        let mut lines = text
            .lines()
            .enumerate()
            .map(|(k, line)| (k + 1, line.split('#').next().unwrap_or("").trim()))
            .filter(|(_, line)| !line.is_empty());
        let mut next = |expected| {
            let missing = || OffError { line: text.lines().count(), expected, got: String::new() };
            lines.next().ok_or_else(missing)
        };
        let (line, word) = next("the word OFF")?;
        if word != "OFF" {
            return Err(OffError { line, expected: "the word OFF", got: word.into() });
        }
        let counts = numbers::<usize, 3>(next("three counts")?, "three counts")?;
        let mut mesh = Self::default();
        for _ in 0..counts[0] {
            mesh.positions.push(numbers(next("a vertex")?, "three coordinates")?);
        }
        for _ in 0..counts[1] {
            const FACET: &str = "3, three vertices below the count, and a colour";
            let (line, row) = next(FACET)?;
            let [corners, a, b, c, rgb @ ..] = numbers::<u32, 7>((line, row), FACET)?;
            let known = [a, b, c].iter().all(|&v| (v as usize) < counts[0]);
            if corners != 3 || !known || rgb.iter().any(|&part| part > 255) {
                return Err(OffError { line, expected: FACET, got: row.into() });
            }
            mesh.facets.push([a, b, c]);
            mesh.colours.push(Rgb(rgb.map(|part| part as u8)));
        }
        Ok(mesh)
    }

    /// A scene of the facets as Geomview shows them: flat-shaded, in the colours of the file, and visible
    /// from both sides.
    pub fn scene(&self) -> Scene {
        let mut colours: Vec<Rgb> = self.colours.clone();
        colours.sort_by_key(|colour| colour.0);
        colours.dedup();
        let mesh = |colour: Rgb| {
            let coloured = self.facets.iter().zip(&self.colours).filter(|(_, c)| **c == colour);
            Mesh {
                colours: Colours::Uniform(colour),
                shading: Shading::Flat,
                two_sided: true,
                ..Mesh::new(self.positions.clone(), coloured.map(|(&facet, _)| facet).collect())
            }
        };
        Scene { meshes: colours.into_iter().map(mesh).collect(), ..Scene::default() }
    }
}

fn numbers<T: std::str::FromStr, const N: usize>(
    (line, row): (usize, &str),
    expected: &'static str,
) -> Result<[T; N], OffError> {
    let wrong = || OffError { line, expected, got: row.into() };
    let numbers: Vec<T> =
        row.split_whitespace().map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
    numbers.try_into().map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read() {
        let text = "OFF\n# a comment\n3 1 0\n0 0 0\n1 0 0 # corner\n\n0 1.5 -2e1\n3 0 2 1 9 8 7\n";
        let mesh = OffMesh::parse(text).unwrap();
        assert_eq!(mesh.positions[2], [0.0, 1.5, -20.0]);
        assert_eq!((mesh.facets, mesh.colours), (vec![[0, 2, 1]], vec![Rgb([9, 8, 7])]));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let cases = [
            ("", "the word OFF"),
            ("PLY\n", "line 1: expected the word OFF"),
            ("OFF\n1 0\n", "line 2: expected three counts"),
            ("OFF\n2 0 0\n0 0 0\n", "expected a vertex"),
            ("OFF\n1 0 0\n0 x 0\n", "line 3: expected three coordinates"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 1 1 1 1\n", "line 4"),
            ("OFF\n1 1 0\n0 0 0\n3 0 0 0 1 1 256\n", "line 4"),
        ];
        for (text, part) in cases {
            let said = OffMesh::parse(text).unwrap_err().to_string();
            assert!(said.contains(part), "{text:?}: {said}");
        }
    }
}
