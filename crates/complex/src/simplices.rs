use walpha_base::advice::Advise;

use super::{ByClass, Class};

/// Simplices of one dimension: rows of `N` vertices each, by input index, and a class for each row.
///
/// A facet over the input points 7, 2 and 5 is the row `[2, 5, 7]` if its winding has no
/// meaning; a regular facet that must be seen as 7 → 5 → 2 from outside is `[2, 7, 5]`.
///
/// ```
/// use walpha_complex::{Class, Simplices};
///
/// let mut edges = Simplices::new(vec![[0, 1], [0, 2]], vec![Class::Regular; 2])?;
/// edges.push([1, 2], Class::Singular);
/// assert_eq!(edges.rows()[2], [1, 2]);
/// assert_eq!(edges.of(Class::Singular).next(), Some(&[1, 2]));
/// # Ok::<(), walpha_complex::SimplicesError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Simplices<const N: usize> {
    rows: Vec<[u32; N]>,
    classes: Vec<Class>,
}

/// The numbers of rows and classes differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{rows} simplices but {classes} classes: each needs one")]
#[non_exhaustive]
pub struct SimplicesError {
    /// Number of rows.
    pub rows: usize,
    /// Number of classes.
    pub classes: usize,
}

impl Advise for SimplicesError {}

impl<const N: usize> Simplices<N> {
    /// Rows of input indices, and the class of each.
    ///
    /// # Errors
    /// [`SimplicesError`] unless there are as many classes as rows.
    pub fn new(rows: Vec<[u32; N]>, classes: Vec<Class>) -> Result<Self, SimplicesError> {
        if rows.len() == classes.len() {
            Ok(Self { rows, classes })
        } else {
            Err(SimplicesError { rows: rows.len(), classes: classes.len() })
        }
    }

    /// The number of simplices.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no simplices.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Input indices of the vertices, a row for each simplex.
    pub fn rows(&self) -> &[[u32; N]] {
        &self.rows
    }

    /// The rows, to change in place.
    pub fn rows_mut(&mut self) -> &mut [[u32; N]] {
        &mut self.rows
    }

    /// The class of each row.
    pub fn classes(&self) -> &[Class] {
        &self.classes
    }

    /// The classes, to change in place.
    pub fn classes_mut(&mut self) -> &mut [Class] {
        &mut self.classes
    }

    /// The rows, to change in place, with their classes.
    pub fn rows_mut_with_classes(&mut self) -> (&mut [[u32; N]], &[Class]) {
        (&mut self.rows, &self.classes)
    }

    /// Each simplex with its class.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&[u32; N], Class)> + '_ {
        self.rows.iter().zip(self.classes.iter().copied())
    }

    /// The simplices of one class.
    pub fn of(&self, class: Class) -> impl Iterator<Item = &[u32; N]> + '_ {
        self.iter().filter(move |&(_, c)| c == class).map(|(row, _)| row)
    }

    /// The number of simplices of each class. O(n).
    pub fn counts(&self) -> ByClass<usize> {
        let mut counts = ByClass::default();
        self.classes.iter().for_each(|&class| counts[class] += 1);
        counts
    }

    /// Appends a simplex.
    pub fn push(&mut self, row: [u32; N], class: Class) {
        self.rows.push(row);
        self.classes.push(class);
    }

    /// Drops exterior simplices.
    pub fn retain_shape(&mut self) {
        if !self.classes.contains(&Class::Exterior) {
            return;
        }
        let mut classes = self.classes.iter();
        self.rows.retain(|_| classes.next() != Some(&Class::Exterior));
        self.classes.retain(|&class| class != Class::Exterior);
    }
}

impl<const N: usize> FromIterator<([u32; N], Class)> for Simplices<N> {
    fn from_iter<I: IntoIterator<Item = ([u32; N], Class)>>(pairs: I) -> Self {
        let (rows, classes) = pairs.into_iter().unzip();
        Self { rows, classes }
    }
}

impl<const N: usize> IntoIterator for Simplices<N> {
    type Item = ([u32; N], Class);
    type IntoIter = std::iter::Zip<std::vec::IntoIter<[u32; N]>, std::vec::IntoIter<Class>>;

    fn into_iter(self) -> Self::IntoIter {
        self.rows.into_iter().zip(self.classes)
    }
}
