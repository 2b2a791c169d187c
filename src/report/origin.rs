//! Where a study and its results come from.

/// A study as it was submitted, and what its results were made with.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Origin {
    /// The study's document, unchanged.
    pub document: String,
    /// When it was last submitted, in milliseconds since 1970-01-01 UTC.
    pub submitted_ms: i64,
    /// What results were made with, and how many.
    pub made: Vec<Made>,
}

/// Results that were made alike.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Made {
    /// What they were made with; nothing is known of results of old versions and of jobs whose process died.
    pub with: Option<Maker>,
    /// How many they are.
    pub jobs: u64,
    /// When the first of them was finished, in milliseconds since 1970-01-01 UTC.
    pub first_ms: i64,
    /// When the last of them was finished.
    pub last_ms: i64,
}

/// A program on a machine. Which of its processes it was matters to nobody.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Maker {
    /// Version of the program.
    pub version: String,
    /// The commit it was built from.
    pub commit: String,
    /// The machine's name.
    pub host: String,
    /// The processor's name, if it is known.
    pub cpu: Option<String>,
    /// Kind of processor and of system.
    pub platform: String,
    /// Vector instructions.
    pub vectors: String,
    /// Number of threads.
    pub threads: u64,
}

impl Maker {
    /// The build, in words.
    pub(super) fn build(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }
}

impl Origin {
    /// Puts together what was made with the same program on the same machine, the most first.
    pub fn grouped(document: String, submitted_ms: i64, parts: impl IntoIterator<Item = Made>) -> Self {
        let mut made: Vec<Made> = Vec::new();
        for part in parts {
            match made.iter_mut().find(|known| known.with == part.with) {
                Some(known) => {
                    known.jobs += part.jobs;
                    known.first_ms = known.first_ms.min(part.first_ms);
                    known.last_ms = known.last_ms.max(part.last_ms);
                }
                None => made.push(part),
            }
        }
        made.sort_by_key(|part| std::cmp::Reverse(part.jobs));
        Self { document, submitted_ms, made }
    }

    /// Why a reader might not take all results for equal, in words: they come from several builds or machines, or from
    /// sources that no commit has.
    pub(super) fn doubts(&self) -> Vec<String> {
        let distinct = |of: fn(&Maker) -> String| {
            let mut found: Vec<String> = self.makers().map(of).collect();
            found.sort();
            found.dedup();
            found.len()
        };
        let mut doubts = Vec::new();
        let builds = distinct(Maker::build);
        if builds > 1 {
            doubts.push(format!("The results come from {builds} builds of the program."));
        }
        let machines = distinct(|maker| {
            format!("{}\n{:?}\n{}\n{}", maker.host, maker.cpu, maker.platform, maker.vectors)
        });
        if machines > 1 {
            doubts.push(format!(
                "The results come from {machines} machines: between machines the last bits may differ."
            ));
        }
        if self.makers().any(|maker| maker.commit.ends_with("+modified")) {
            doubts.push("Some results come from a build with changes that are in no commit.".to_owned());
        }
        doubts
    }

    fn makers(&self) -> impl Iterator<Item = &Maker> {
        self.made.iter().filter_map(|made| made.with.as_ref())
    }
}
