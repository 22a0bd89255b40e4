/// Moves bits 0, 1, 2, … of a number below 2²¹ to positions 0, 3, 6, …: the codes of three coordinates are interleaved by shifts
/// and `|`.
pub fn spread_bits(mut x: u64) -> u64 {
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}
