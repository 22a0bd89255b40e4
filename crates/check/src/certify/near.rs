/// Points sorted into the boxes of a uniform grid.
pub(super) struct Grid {
    low: [f64; 3],
    step: f64,
    counts: [usize; 3],
    /// Where the points of each box start; x varies fastest.
    starts: Vec<u32>,
    points: Vec<u32>,
}

impl Grid {
    /// Sorts points into about as many boxes as there are points.
    pub(super) fn new(positions: &[[f64; 3]], points: Vec<u32>) -> Self {
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for &i in &points {
            for k in 0..3 {
                low[k] = low[k].min(positions[i as usize][k]);
                high[k] = high[k].max(positions[i as usize][k]);
            }
        }
        let extent: [f64; 3] = std::array::from_fn(|k| high[k] - low[k]);
        let longest = extent.iter().copied().fold(0.0, f64::max);
        let boxes = |step: f64| extent.map(|e| (e / step) as usize + 1);
        let (mut step, mut counts) = (f64::INFINITY, [1; 3]);
        if longest > 0.0 && longest.is_finite() {
            // Halving the step until the boxes outnumber the points; flat sets have flat grids.
            step = longest;
            counts = boxes(step);
            while step > f64::MIN_POSITIVE {
                let finer = boxes(step / 2.0);
                if finer.iter().product::<usize>() > 2 * points.len() {
                    break;
                }
                (step, counts) = (step / 2.0, finer);
            }
        }
        let mut grid = Self { low, step, counts, starts: Vec::new(), points: Vec::new() };
        let boxes = counts.iter().product::<usize>();
        let mut starts = vec![0; boxes + 1];
        for &i in &points {
            starts[grid.number(grid.at(positions[i as usize])) + 1] += 1;
        }
        for i in 0..boxes {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut sorted = vec![0; points.len()];
        for &i in &points {
            let slot = &mut next[grid.number(grid.at(positions[i as usize]))];
            sorted[*slot as usize] = i;
            *slot += 1;
        }
        (grid.starts, grid.points) = (starts, sorted);
        grid
    }

    /// Calls `visit` with every point within `radius` of `center`, and some beyond, until it
    /// returns a value.
    pub(super) fn within<T>(
        &self,
        center: [f64; 3],
        radius: f64,
        visit: impl Fn(u32) -> Option<T>,
    ) -> Option<T> {
        // Rounding is monotonic, so a point between two positions is in a box between theirs.
        let from = self.at(center.map(|x| (x - radius).next_down()));
        let to = self.at(center.map(|x| (x + radius).next_up()));
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let first = self.number([from[0], y, z]);
                let last = self.number([to[0], y, z]);
                let row = self.starts[first] as usize..self.starts[last + 1] as usize;
                if let Some(found) = self.points[row].iter().find_map(|&i| visit(i)) {
                    return Some(found);
                }
            }
        }
        None
    }

    /// Some point near a position, if there are points.
    pub(super) fn some_near(&self, position: [f64; 3]) -> Option<u32> {
        let center = self.at(position);
        let reach = *self.counts.iter().max().expect("three axes");
        (0..reach).find_map(|ring| {
            let from: [usize; 3] = std::array::from_fn(|k| center[k].saturating_sub(ring));
            let to: [usize; 3] =
                std::array::from_fn(|k| (center[k] + ring).min(self.counts[k] - 1));
            (from[2]..=to[2]).find_map(|z| {
                (from[1]..=to[1]).find_map(|y| {
                    let first = self.number([from[0], y, z]);
                    let last = self.number([to[0], y, z]);
                    self.points[self.starts[first] as usize..self.starts[last + 1] as usize]
                        .first()
                        .copied()
                })
            })
        })
    }

    fn at(&self, position: [f64; 3]) -> [usize; 3] {
        std::array::from_fn(|k| {
            // The cast turns negative numbers, and the NaN of an infinite box, into 0.
            (((position[k] - self.low[k]) / self.step) as usize).min(self.counts[k] - 1)
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}
