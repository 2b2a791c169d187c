//! The inspections of jobs in the folder of a report.

use crate::publish::html;
use serde::Deserialize;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// The folder of inspections inside of a report's folder.
pub const INSPECTIONS: &str = "inspect";
/// The file of an inspection with the key of its job.
const SUMMARY: &str = "inspection.json";
/// The page of an inspection.
const PAGE: &str = "index.html";

/// An inspection of a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundInspection {
    /// Key of the job.
    pub job: String,
    /// The folder of the inspection, relative to that of the report, with `/` between its parts.
    pub folder: String,
    /// Whether it has a page. An inspection of the spectrum alone has none.
    pub has_page: bool,
}

impl FoundInspection {
    /// The address of its page, relative to the folder of the report.
    pub fn page(&self) -> Option<String> {
        self.has_page.then(|| html::address(&format!("{}/{PAGE}", self.folder)))
    }
}

/// The part of `inspection.json` that is read.
#[derive(Deserialize)]
struct Summary {
    /// Empty if it is not known.
    key: String,
}

/// The inspections below the folder of a report, in its folders and in those of its folder `inspect`, sorted by folder. A
/// folder that cannot be read, or whose inspection does not name its job, is none.
pub fn inspections(report_folder: &Path) -> Vec<FoundInspection> {
    let all = folders(report_folder).chain(folders(&report_folder.join(INSPECTIONS)));
    let mut found: Vec<FoundInspection> =
        all.filter_map(|folder| inspection(report_folder, &folder)).collect();
    found.sort_by(|a, b| a.folder.cmp(&b.folder));
    found
}

fn folders(of: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let entries = fs::read_dir(of).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(|path| path.is_dir())
}

fn inspection(report_folder: &Path, folder: &Path) -> Option<FoundInspection> {
    let file = File::open(folder.join(SUMMARY)).ok()?;
    let summary: Summary = serde_json::from_reader(BufReader::new(file)).ok()?;
    let relative = folder.strip_prefix(report_folder).ok()?;
    let parts: Option<Vec<&str>> = relative.iter().map(|part| part.to_str()).collect();
    let has_page = folder.join(PAGE).is_file();
    Some(FoundInspection { job: summary.key, folder: parts?.join("/"), has_page })
}
