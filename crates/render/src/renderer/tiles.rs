use crate::pixels::{PixelBox, Size};
use crate::primitives::Primitive;

/// Which primitives may touch which tile, in rows of one array.
pub(super) struct Tiles {
    size: Size,
    across: usize,
    down: usize,
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Tiles {
    /// 32×32 pixels: nearness and names of all samples fit in a second-level cache.
    const SIDE: usize = 32;

    pub(super) fn new(primitives: &[Primitive], size: Size) -> Self {
        let across = (size.width() as usize).div_ceil(Self::SIDE);
        let down = (size.height() as usize).div_ceil(Self::SIDE);
        let touched = |primitive: &Primitive| {
            let b = primitive.bounds();
            let side = Self::SIDE as i32;
            let tiles =
                |low: i32, high: i32| (low / side) as usize..((high + side - 1) / side) as usize;
            let columns = if b.is_empty() { 0..0 } else { tiles(b.x0, b.x1) };
            tiles(b.y0, b.y1).flat_map(move |y| columns.clone().map(move |x| y * across + x))
        };
        let mut starts = vec![0; across * down + 1];
        for tile in primitives.iter().flat_map(touched) {
            starts[tile + 1] += 1;
        }
        for tile in 0..across * down {
            starts[tile + 1] += starts[tile];
        }
        let mut free = starts.clone();
        let mut members = vec![0; starts[across * down]];
        for (name, primitive) in primitives.iter().enumerate() {
            for tile in touched(primitive) {
                members[free[tile]] = name as u32;
                free[tile] += 1;
            }
        }
        Self { size, across, down, starts, members }
    }

    pub(super) fn count(&self) -> usize {
        self.across * self.down
    }

    pub(super) fn members(&self, tile: usize) -> &[u32] {
        &self.members[self.starts[tile]..self.starts[tile + 1]]
    }

    pub(super) fn area(&self, tile: usize) -> PixelBox {
        let (x, y) = (tile % self.across * Self::SIDE, tile / self.across * Self::SIDE);
        PixelBox {
            x0: x as i32,
            y0: y as i32,
            x1: (x + Self::SIDE).min(self.size.width() as usize) as i32,
            y1: (y + Self::SIDE).min(self.size.height() as usize) as i32,
        }
    }
}
