//! Suggestions for misspelt names.

/// Least similarity (Jaro–Winkler) of a suggestion; less similar names mislead more often than they help.
const LEAST_SIMILARITY: f64 = 0.75;

/// The candidate most similar to `wrong`, if one is similar enough.
///
/// A candidate is a name with the spellings by which it is recognised.
pub(super) fn nearest<'a>(
    wrong: &str,
    candidates: impl IntoIterator<Item = (&'a str, Vec<String>)>,
) -> Option<&'a str> {
    let wrong = wrong.to_lowercase();
    candidates
        .into_iter()
        .map(|(name, spellings)| {
            let score = |spelling: &String| strsim::jaro_winkler(&wrong, &spelling.to_lowercase());
            (name, spellings.iter().map(score).fold(0.0, f64::max))
        })
        .filter(|(_, score)| *score >= LEAST_SIMILARITY)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(name, _)| name)
}

/// The name most similar to `wrong`, if one is similar enough.
pub fn nearest_name<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    nearest(wrong, names.into_iter().map(|name| (name, vec![name.to_owned()])))
}
