//! "Did you mean …?"

/// Below this similarity a suggestion misleads more often than it helps.
const SIMILAR: f64 = 0.75;

/// The candidate most like `wrong`, if any is like it.
///
/// A candidate is a name with the spellings it is recognised by.
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
        .filter(|(_, score)| *score >= SIMILAR)
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(name, _)| name)
}
