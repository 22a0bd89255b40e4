//! Near misses: which of a few names a mistyped one was meant to be.

/// The known name most like `given`, if a slip or two of the fingers explains the difference: a letter
/// left out, put in, wrong, or exchanged with its neighbour, one for every three letters. Letter case is
/// passed over; the first of equals is taken. One comparison for each name.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let given = given.to_lowercase();
    let slips = |name: &str| strsim::osa_distance(&given, &name.to_lowercase());
    let most = (given.chars().count() / 3).max(1);
    known
        .into_iter()
        .map(|name| (slips(name), name))
        .filter(|&(slips, _)| slips <= most)
        .min_by_key(|&(slips, _)| slips)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistyped_name_is_meant() {
        assert_eq!(nearest("nrd", ["nrrd", "nii"]), Some("nrrd"));
        assert_eq!(nearest("docx", ["nrrd", "nii"]), None);
    }
}
