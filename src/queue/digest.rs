//! Digests of what jobs leave behind. They are stored beside it and checked whenever it is read: a disk, a copy or an editor
//! may change a figure, and the figure would still look like one.

/// Hexadecimal digits of a digest. 128 bits are far more than chance can imitate.
const DIGITS: usize = 32;

/// Whether something that was stored is as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Integrity {
    /// It has its digest.
    Intact,
    /// It has no digest, because an earlier version stored it; or nothing is stored.
    #[default]
    WithoutDigest,
    /// It was changed, or belongs to another job.
    Damaged,
}

impl Integrity {
    /// Compares a stored digest with the one that it must be.
    pub(super) fn of(stored: Option<&str>, expected: impl FnOnce() -> String) -> Self {
        match stored {
            None => Self::WithoutDigest,
            Some(stored) if stored == expected() => Self::Intact,
            Some(_) => Self::Damaged,
        }
    }
}

/// The digest of a result of the job with that key: of its record or its error.
pub(super) fn of_result(key: &str, record: Option<&str>, error: Option<&str>) -> String {
    let (kind, text) = match (record, error) {
        (Some(record), _) => ("record", record),
        (None, error) => ("error", error.unwrap_or_default()),
    };
    digest(kind, key, text.as_bytes())
}

/// The digest of the state in which the job with that key ended.
pub(super) fn of_state(key: &str, bytes: &[u8]) -> String {
    digest("state", key, bytes)
}

fn digest(kind: &str, key: &str, content: &[u8]) -> String {
    let mut hasher = blake3::Hasher::new();
    for part in [kind, key] {
        // A separator, so that no text can be moved from one part to the next.
        hasher.update(part.as_bytes()).update(&[0]);
    }
    hasher.update(content).finalize().to_hex()[..DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: a digest belongs to one job, one content and one kind of content.
    #[test]
    fn digests_tell_contents_apart() {
        let own = of_result("a", Some("12"), None);
        for other in [
            of_result("a", Some("13"), None),
            of_result("a", None, Some("12")),
            of_result("b", Some("12"), None),
            of_result("a1", Some("2"), None),
            of_state("a", b"12"),
        ] {
            assert_ne!(own, other);
        }
        let check = |stored| Integrity::of(stored, || of_result("a", Some("12"), None));
        assert_eq!(check(Some(own.as_str())), Integrity::Intact);
        assert_eq!(check(Some("")), Integrity::Damaged);
        assert_eq!(check(None), Integrity::WithoutDigest);
    }
}
