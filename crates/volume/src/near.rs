//! Finds the known name that a mistyped one was meant to be.

/// The known name most similar to `given`, if typing errors explain the difference: letters that are missing, extra, wrong, or
/// exchanged with their neighbour, at most one for every three letters. Letter case is ignored. The first of equally similar
/// names is returned. Makes one comparison for each name.
pub fn nearest<'a>(given: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let given = given.to_lowercase();
    let errors = |name: &str| strsim::osa_distance(&given, &name.to_lowercase());
    let most = (given.chars().count() / 3).max(1);
    known
        .into_iter()
        .map(|name| (errors(name), name))
        .filter(|&(errors, _)| errors <= most)
        .min_by_key(|&(errors, _)| errors)
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
