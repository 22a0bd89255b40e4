//! Checks outputs that contain outlines, which only points in a plane have: they are refused before the work if they cannot be
//! written.

use crate::cli::process::errors::{CommandError, Result, fail_usage};
use crate::export::Format;
use crate::shape::Outline;

/// Refuses points that have no outline, if one of the formats needs one.
pub(crate) fn check<'a>(
    formats: impl IntoIterator<Item = &'a Format>,
    positions: &[[f64; 3]],
) -> Result<()> {
    let Some(format) = formats.into_iter().find(|format| format.outline) else { return Ok(()) };
    Outline::check(positions).map_err(|error| {
        CommandError::from(error).context(format!("{} needs an outline", format.name))
    })
}

/// Refuses formats of outlines for shapes that never have one; `why` gives the reason.
pub(crate) fn refuse<'a>(formats: impl IntoIterator<Item = &'a Format>, why: &str) -> Result<()> {
    if let Some(format) = formats.into_iter().find(|format| format.outline) {
        let name = format.name;
        fail_usage!("{name} holds the outline of points in a plane: {why}" => "name another format");
    }
    Ok(())
}
