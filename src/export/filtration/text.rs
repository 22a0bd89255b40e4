use std::io::{self, Write};

use walpha_base::Monitor;

use crate::ladder::Ordered;

/// Lines between two words on how far it is.
const STEP: usize = 1 << 16;

pub(super) fn write(
    ordered: &Ordered<'_>,
    out: &mut dyn Write,
    monitor: &Monitor,
) -> io::Result<()> {
    writeln!(out, "# value gabriel regular interior vertices")?;
    for (at, simplex) in ordered.iter().enumerate() {
        if at % STEP == 0 {
            monitor.report(at as u64, ordered.len() as u64).map_err(io::Error::other)?;
        }
        // With an exponent where a number would be hundreds of digits long.
        let (value, gabriel) = (simplex.value, u8::from(simplex.gabriel));
        write!(out, "{value:?} {gabriel} {:?} {:?}", simplex.regular, simplex.interior)?;
        simplex.vertices.iter().try_for_each(|v| write!(out, " {v}"))?;
        writeln!(out)?;
    }
    Ok(())
}
