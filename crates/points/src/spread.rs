use walpha_base::memory::try_with_capacity;
use walpha_base::spread_bits;

use super::{Points, PointsError, bounding_box};

/// How often space is halved along each axis: three times as many bits fit in 64.
const HALVINGS: u32 = 21;

/// An order of points in which each beginning is spread over all of them, and large differences L come first.
///
/// The least cube around the points is cut into eight, each of these into eight, and so on. Of the points in a cube the one of largest L stands for
/// it, ties by the index. Points that stand for larger cubes come first, those of equal cubes by L, ties by the index. So the first
/// n are nested for growing n, and between 8ᵏ cubes and the next 8ᵏ⁺¹ the distance of neighbours shrinks by no more than half. Without differences
/// the index alone decides. O(n log n), independent of the number of threads.
///
/// # Errors
/// Out of memory.
///
/// # Panics
/// If a coordinate is not finite, or the differences are not as many as the points.
pub fn spread_order(points: &Points) -> Result<Vec<u32>, PointsError> {
    let what = || "the order of points".to_owned();
    let [low, high] = bounding_box(&points.positions);
    let side = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    assert!(points.is_empty() || side.is_finite(), "coordinates are finite");
    let cubes = f64::from(1u32 << HALVINGS);
    let step = |x: f64| if side > 0.0 { (x / side * cubes).min(cubes - 1.0) as u64 } else { 0 };
    let mut places: Vec<(u64, u32)> = try_with_capacity(points.len(), what)?;
    places.extend((0..).zip(&points.positions).map(|(index, place)| {
        let [x, y, z] = [0, 1, 2].map(|k| spread_bits(step(place[k] - low[k])));
        (x | y << 1 | z << 2, index)
    }));
    places.sort_unstable();
    let difference = |index: u32| points.differences.as_ref().map_or(0.0, |l| l[index as usize]);
    let sooner = |a: u32, b: u32| difference(b).total_cmp(&difference(a)).then(a.cmp(&b));
    // The size of the largest cube that a point stands for, as a number of halvings.
    let mut halvings: Vec<u32> = try_with_capacity(points.len(), what)?;
    halvings.resize(points.len(), HALVINGS + 1);
    for level in (0..=HALVINGS).rev() {
        let cube = |(code, _): &(u64, u32)| code >> (3 * (HALVINGS - level));
        for within in places.chunk_by(|a, b| cube(a) == cube(b)) {
            let first = within.iter().map(|&(_, index)| index).min_by(|&a, &b| sooner(a, b));
            halvings[first.expect("a cube with points") as usize] = level;
        }
    }
    let mut order: Vec<u32> = try_with_capacity(points.len(), what)?;
    order.extend(0..points.len() as u32);
    order.sort_unstable_by(|&a, &b| {
        halvings[a as usize].cmp(&halvings[b as usize]).then_with(|| sooner(a, b))
    });
    Ok(order)
}

#[cfg(test)]
mod tests {
    use walpha_base::random::Random;

    use super::*;

    fn order(positions: Vec<[f64; 3]>, differences: Vec<f64>) -> Vec<u32> {
        spread_order(&Points::new(positions).with_differences(differences).unwrap()).unwrap()
    }

    /// In a row of eight: the best of all, the best of the other half, of the other quarters, and the rest.
    #[test]
    fn each_cube_has_its_point_of_largest_difference() {
        let row: Vec<[f64; 3]> = (0..8).map(|x| [f64::from(x), 5.0, -2.0]).collect();
        let found = order(row.clone(), vec![1.0, 9.0, 3.0, 2.0, 4.0, 4.0, 8.0, 7.0]);
        assert_eq!(found, [1, 6, 4, 2, 7, 5, 3, 0]);
        // Without differences it is the index that decides.
        assert_eq!(spread_order(&Points::new(row)).unwrap(), [0, 4, 2, 6, 1, 3, 5, 7]);
    }

    #[test]
    fn points_at_one_place_and_no_points() {
        assert_eq!(order(vec![[1.0; 3]; 3], vec![0.0, 2.0, 2.0]), [1, 2, 0]);
        assert_eq!(order(Vec::new(), Vec::new()), [] as [u32; 0]);
    }

    /// Where nearly all large differences are in one corner, the first points are everywhere all the same.
    #[test]
    fn beginnings_are_spread() {
        let mut random = Random::new(5);
        let positions: Vec<[f64; 3]> = (0..20_000).map(|_| [0; 3].map(|_| random.unit())).collect();
        let differences: Vec<f64> = positions
            .iter()
            .map(|place| if place.iter().all(|&x| x < 0.2) { 100.0 } else { 1.0 + place[0] })
            .collect();
        let order = order(positions.clone(), differences);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..20_000));
        // 4³ cubes are represented by the first 64 and those of larger cubes among them.
        let cube = |index: &u32| positions[*index as usize].map(|x| (4.0 * x) as usize);
        let mut cubes: Vec<[usize; 3]> = order[..64].iter().map(cube).collect();
        cubes.sort_unstable();
        cubes.dedup();
        assert!(cubes.len() >= 60, "{}", cubes.len());
    }
}
