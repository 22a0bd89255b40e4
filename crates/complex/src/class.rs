use std::fmt;
use std::ops::{Index, IndexMut};

use serde::{Deserialize, Serialize, Serializer};

/// The class of a simplex of the regular triangulation relative to the shape, as in CGAL's
/// `Fixed_alpha_shape_3::Classification_type`. Cells are only [`Class::Interior`] or
/// [`Class::Exterior`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[repr(u8)]
pub enum Class {
    /// Not in the shape.
    Exterior = 0,
    /// In the shape, and not on its boundary.
    Interior = 1,
    /// On the boundary of the shape, and a face of a higher simplex of the shape.
    Regular = 2,
    /// In the shape, and not a face of any other simplex of the shape.
    Singular = 3,
}

impl Class {
    /// All classes, in the order of their numbers.
    pub const ALL: [Self; 4] = [Self::Exterior, Self::Interior, Self::Regular, Self::Singular];

    /// The class with this number, which is also used by CGAL and NPZ files; `None` above 3.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }
}

/// The name in lower case, as in JSON.
impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Exterior => "exterior",
            Self::Interior => "interior",
            Self::Regular => "regular",
            Self::Singular => "singular",
        })
    }
}

/// A value for each class, such as the number of simplices. The fields are public because there are always four classes.
///
/// ```
/// use walpha_complex::{ByClass, Class};
///
/// let mut counts = ByClass::<usize>::default();
/// counts[Class::Regular] += 12;
/// counts[Class::Exterior] += 1;
/// assert_eq!((counts.regular, counts.in_shape()), (12, 12));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize)]
pub struct ByClass<T> {
    /// The value of [`Class::Interior`].
    pub interior: T,
    /// The value of [`Class::Regular`].
    pub regular: T,
    /// The value of [`Class::Singular`].
    pub singular: T,
    /// The value of [`Class::Exterior`].
    pub exterior: T,
}

impl<T> ByClass<T> {
    /// Each class with its value: interior, regular, singular, exterior.
    pub fn iter(&self) -> impl Iterator<Item = (Class, &T)> {
        use Class::{Exterior, Interior, Regular, Singular};
        [Interior, Regular, Singular, Exterior].into_iter().map(|class| (class, &self[class]))
    }
}

impl ByClass<usize> {
    /// The number of simplices in the shape: all but the exterior ones.
    pub fn in_shape(&self) -> usize {
        self.interior + self.regular + self.singular
    }

    /// Serializes the counts of the shape alone, without the exterior ones, which are only known if the whole triangulation is.
    /// For `#[serde(serialize_with)]`.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize_shape<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Shape {
            interior: usize,
            regular: usize,
            singular: usize,
        }
        let Self { interior, regular, singular, .. } = *self;
        Shape { interior, regular, singular }.serialize(serializer)
    }
}

impl<T> Index<Class> for ByClass<T> {
    type Output = T;

    fn index(&self, class: Class) -> &T {
        match class {
            Class::Interior => &self.interior,
            Class::Regular => &self.regular,
            Class::Singular => &self.singular,
            Class::Exterior => &self.exterior,
        }
    }
}

impl<T> IndexMut<Class> for ByClass<T> {
    fn index_mut(&mut self, class: Class) -> &mut T {
        match class {
            Class::Interior => &mut self.interior,
            Class::Regular => &mut self.regular,
            Class::Singular => &mut self.singular,
            Class::Exterior => &mut self.exterior,
        }
    }
}
