/// The result of one check.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What was checked.
    pub subject: &'static str,
    /// What was found and, if it is a problem, what to do about it.
    pub text: String,
    /// Whether somebody has to act on it.
    pub is_problem: bool,
}

impl Finding {
    pub(super) fn good(subject: &'static str, text: impl Into<String>) -> Self {
        Self { subject, text: text.into(), is_problem: false }
    }

    pub(super) fn bad(subject: &'static str, text: impl Into<String>) -> Self {
        Self { subject, text: text.into(), is_problem: true }
    }

    pub(super) fn judged(subject: &'static str, text: impl Into<String>, is_good: bool) -> Self {
        Self { subject, text: text.into(), is_problem: !is_good }
    }
}
