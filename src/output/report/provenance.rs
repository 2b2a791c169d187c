//! Where a study and its results come from.

use crate::analysis::Build;

/// A study as it was submitted, and the programs and machines that its results come from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Provenance {
    /// The study's document, unchanged.
    pub document: String,
    /// When it was last submitted, in milliseconds since 1970-01-01 UTC.
    pub submitted_ms: i64,
    /// Its results, grouped by program and machine, the largest group first.
    pub groups: Vec<ResultGroup>,
}

/// Results of one program on one machine.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResultGroup {
    /// The program and the machine, without the process; none for jobs whose process died.
    pub build: Option<Build>,
    /// Number of results.
    pub jobs: u64,
    /// When the first of them was finished, in milliseconds since 1970-01-01 UTC.
    pub first_ms: i64,
    /// When the last of them was finished, in milliseconds since 1970-01-01 UTC.
    pub last_ms: i64,
}

impl Provenance {
    /// Merges groups of the same program on the same machine. Several processes of it are the same here.
    pub fn grouped(
        document: String,
        submitted_ms: i64,
        parts: impl IntoIterator<Item = ResultGroup>,
    ) -> Self {
        let mut groups: Vec<ResultGroup> = Vec::new();
        for mut part in parts {
            part.build = part.build.map(|build| Build { pid: 0, ..build });
            match groups.iter_mut().find(|group| group.build == part.build) {
                Some(group) => {
                    group.jobs += part.jobs;
                    group.first_ms = group.first_ms.min(part.first_ms);
                    group.last_ms = group.last_ms.max(part.last_ms);
                }
                None => groups.push(part),
            }
        }
        groups.sort_by_key(|group| std::cmp::Reverse(group.jobs));
        Self { document, submitted_ms, groups }
    }

    /// Sentences that say why the results may not be comparable to the last bit: they come from several builds or
    /// machines, or from sources that are in no commit.
    pub(super) fn warnings(&self) -> Vec<String> {
        let distinct = |key: fn(&Build) -> String| {
            let mut found: Vec<String> = self.builds().map(key).collect();
            found.sort();
            found.dedup();
            found.len()
        };
        let mut warnings = Vec::new();
        let programs = distinct(|build| format!("{} ({})", build.version, build.commit));
        if programs > 1 {
            warnings.push(format!("The results come from {programs} builds of the program."));
        }
        let machines = distinct(|build| {
            format!("{}\n{:?}\n{}\n{}", build.host, build.cpu, build.platform(), build.vectors)
        });
        if machines > 1 {
            warnings.push(format!(
                "The results come from {machines} machines: between machines the last bits may differ."
            ));
        }
        if self.builds().any(|build| build.commit.ends_with("+modified")) {
            warnings.push("Some results come from a build with changes that are in no commit.".to_owned());
        }
        warnings
    }

    fn builds(&self) -> impl Iterator<Item = &Build> {
        self.groups.iter().filter_map(|group| group.build.as_ref())
    }
}
