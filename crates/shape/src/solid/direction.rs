//! A direction into a fan of facets.

type Vector = [f64; 3];

/// The direction whose largest angle with these directions is smallest: the axis of the narrowest cone about them. `None` if they
/// are in no cone narrower than a half-space. Computed in doubles: the caller tests exactly where it leads. Linear time if the
/// order of the directions is arbitrary (Welzl 1991, doi:10.1007/BFb0038202), and never more than cubic.
pub(super) fn axis(directions: &[Vector]) -> Option<Vector> {
    let holds = |cone: &Cone, direction: &Vector| dot(cone.axis, *direction) >= cone.cosine - 1e-12;
    let mut cone = Cone { axis: *directions.first()?, cosine: 1.0 };
    for (i, &a) in directions.iter().enumerate() {
        if holds(&cone, &a) {
            continue;
        }
        cone = Cone { axis: a, cosine: 1.0 };
        for (j, &b) in directions[..i].iter().enumerate() {
            if holds(&cone, &b) {
                continue;
            }
            cone = Cone::of_two(a, b)?;
            for &c in &directions[..j] {
                if !holds(&cone, &c) {
                    cone = Cone::of_three(a, b, c)?;
                }
            }
        }
    }
    // Directions all around leave a cone that does not contain all of them.
    directions
        .iter()
        .all(|direction| holds(&cone, direction) && dot(cone.axis, *direction) > 0.0)
        .then_some(cone.axis)
}

struct Cone {
    axis: Vector,
    cosine: f64,
}

impl Cone {
    fn of_two(a: Vector, b: Vector) -> Option<Self> {
        let axis = unit([0, 1, 2].map(|k| a[k] + b[k]))?;
        Some(Self { axis, cosine: dot(axis, a) })
    }

    fn of_three(a: Vector, b: Vector, c: Vector) -> Option<Self> {
        let from_a = |p: Vector| [0, 1, 2].map(|k| p[k] - a[k]);
        let axis = unit(cross(from_a(b), from_a(c)))?;
        let cosine = dot(axis, a);
        Some(if cosine < 0.0 {
            Self { axis: axis.map(|x| -x), cosine: -cosine }
        } else {
            Self { axis, cosine }
        })
    }
}

/// The unit normal of a triangle, on the side from which it turns counter-clockwise.
pub(super) fn normal([a, b, c]: [[f64; 3]; 3]) -> Option<Vector> {
    let from_a = |p: Vector| [0, 1, 2].map(|k| p[k] - a[k]);
    // Scaled, so that products neither overflow nor vanish.
    let (u, v) = (unit(from_a(b))?, unit(from_a(c))?);
    unit(cross(u, v))
}

/// The length of a vector. Its roots are rounded equally on every machine, unlike those of `hypot`.
pub(super) fn length(v: Vector) -> f64 {
    let most = v.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if most == 0.0 {
        return 0.0;
    }
    let [x, y, z] = v.map(|x| x / most);
    most * (x * x + y * y + z * z).sqrt()
}

fn unit(v: Vector) -> Option<Vector> {
    let length = length(v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_is_as_near_to_all_as_can_be() {
        let near = |found: Vector, wanted: Vector| {
            assert!(length([0, 1, 2].map(|k| found[k] - wanted[k])) < 1e-9, "{found:?}");
        };
        let corner = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        near(axis(&corner).unwrap(), unit([1.0; 3]).unwrap());
        near(axis(&corner[..2]).unwrap(), unit([1.0, 1.0, 0.0]).unwrap());
        // A direction between the others changes nothing.
        let between = [corner[0], unit([1.0, 1.0, 0.2]).unwrap(), corner[1], corner[0]];
        let found = axis(&between).unwrap();
        assert!(between.iter().all(|&d| dot(found, d) > 0.7), "{found:?}");
        let around = [corner[0], corner[1], corner[2], unit([-1.0; 3]).unwrap()];
        assert_eq!(axis(&around), None);
        assert_eq!(axis(&[corner[0], [-1.0, 0.0, 0.0]]), None);
        assert_eq!(axis(&[]), None);
    }
}
