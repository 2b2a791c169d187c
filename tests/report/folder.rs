//! The report as a folder: it has all files, and a page that says what is missing.

use crate::report_files::{LIST, REPORT};
use crate::synthetic::{failed, partial_study, periodic, report, row, with};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tribosweep_output::publish::PublishError;
use tribosweep_output::report::{JobRow, RowState, write};

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

fn page(rows: &[JobRow]) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(rows), folder.path()).expect("the report is written");
    fs::read_to_string(folder.path().join("report.md")).expect("the page is there")
}

/// Protects: all files exist, the return value names all of them, and there are no temporary files.
#[test]
fn writes_exactly_the_documented_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = folder.path().join("new").join("deeper");
    let written = write(&report(&partial_study()), &inside).expect("the report is written");
    let mut expected: BTreeSet<String> = REPORT.map(str::to_owned).into();
    assert_eq!(names(&inside), expected);
    // The list of the files is for the program, and no part of the report.
    expected.remove(LIST);
    let returned: BTreeSet<String> = written
        .iter()
        .map(|path| path.strip_prefix(&inside).expect("inside").display().to_string())
        .collect();
    assert_eq!(returned, expected);
    assert_eq!(written.len(), expected.len());
}

/// Protects: a second report in the same folder replaces the files of the first one, and leaves other files alone.
#[test]
fn an_existing_folder_is_updated() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("notes.txt"), "mine").expect("a file");
    let study = |state: &RowState| -> Vec<JobRow> {
        [0.3, 0.4].into_iter().flat_map(|mu| [7.0, 9.0].map(|omega| row(omega, mu, state.clone()))).collect()
    };
    write(&report(&study(&RowState::Pending)), folder.path()).expect("the first report");
    write(&report(&study(&periodic(0.35))), folder.path()).expect("the second report");
    let jobs = fs::read_to_string(folder.path().join("jobs.csv")).expect("the export");
    assert!(jobs.contains(",periodic,") && !jobs.contains(",pending,"), "{jobs}");
    assert_eq!(fs::read_to_string(folder.path().join("notes.txt")).expect("a file"), "mine");
    assert_eq!(names(folder.path()).len(), REPORT.len() + 1);
}

/// Protects: the page of a running study has counts, reasons and the missing jobs.
#[test]
fn the_page_says_what_is_missing_and_why() {
    let page = page(&partial_study());
    assert!(
        page.contains(
            "- jobs done: 14 of 18 (7 periodic, 6 decayed, 1 not periodic)\n- failed: 1\n- missing: 3"
        ),
        "{page}"
    );
    assert!(page.contains("This report is incomplete"));
    let below = |heading: &str| {
        let section = page.split_once(heading).unwrap_or_else(|| panic!("no {heading}")).1;
        section.split("\n##").next().unwrap_or_default().trim().to_owned()
    };
    let failed = below("### Failed jobs (1)\n");
    assert!(
        failed.contains("ω = 50 rpm, μ = 0.3") && failed.contains("the mesh has no node row"),
        "{failed}"
    );
    let not_periodic = below("### Not periodic (1)\n");
    assert!(not_periodic.contains("ω = 10 rpm, μ = 0.4"), "{not_periodic}");
    assert!(not_periodic.contains("after 87.5 ms"), "{not_periodic}");
    let missing = below("### Missing jobs (3)\n");
    assert!(missing.contains("ω = 1 rpm, μ = 0.4") && missing.contains("| running"), "{missing}");
    assert_eq!(missing.matches("| pending").count(), 2, "{missing}");
}

/// Protects: the page links every file of the report.
#[test]
fn the_page_links_every_file() {
    let rows: Vec<JobRow> = ["inner_side", "outer_side"]
        .into_iter()
        .flat_map(|side| partial_study().into_iter().map(move |row| with(row, "clamp_side", side)))
        .collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = write(&report(&rows), folder.path()).expect("the report is written");
    let page = fs::read_to_string(folder.path().join("report.md")).expect("the page is there");
    let message = "both combinations are panels of the same figures, but for three that fill a sheet";
    assert_eq!(written.len(), REPORT.len() - 1 + 3, "{message}");
    for path in written.iter().filter(|path| !path.ends_with("report.md")) {
        let name = path.file_name().expect("a name").to_string_lossy();
        assert!(page.contains(&format!("]({name})")), "{name}");
    }
}

/// Protects: after a report with fewer figures the folder has the files of that report alone, and the files of others.
#[test]
fn figures_of_an_earlier_grid_are_removed() {
    let many: Vec<JobRow> = (0..30)
        .flat_map(|load| {
            [row(7.0, 0.4, periodic(0.35)), row(9.0, 0.3, periodic(0.25))]
                .map(|row| with(row, "load_n", load))
        })
        .collect();
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&report(&many), folder.path()).expect("the first report");
    assert!(folder.path().join("mu_star-3.svg").is_file(), "{:?}", names(folder.path()));
    let foreign = ["shares-new.svg", "mu_star-9.svg", "notes.txt"];
    for name in foreign {
        fs::write(folder.path().join(name), "mine").expect("a file");
    }
    let expected = || REPORT.into_iter().chain(foreign).map(str::to_owned).collect::<BTreeSet<_>>();
    write(&report(&partial_study()), folder.path()).expect("the second report");
    assert_eq!(names(folder.path()), expected());
}

/// Protects: the report of a complete study has no warning.
#[test]
fn a_complete_study_has_nothing_missing() {
    let page = page(&[row(7.0, 0.4, periodic(0.35))]);
    assert!(page.contains("jobs done: 1 of 1"), "{page}");
    for absent in ["incomplete", "## Trouble", "Failed jobs", "Missing jobs"] {
        assert!(!page.contains(absent), "{absent}");
    }
}

/// Protects: an error message of several lines with Markdown in it becomes one line of text.
#[test]
fn an_error_stays_on_its_line() {
    let page = page(&[row(7.0, 0.4, failed("bad\n## not a heading `x`"))]);
    assert!(page.contains("| bad ## not a heading \\`x\\` |"), "{page}");
}

/// Protects: the page of a large study does not list thousands of pending jobs.
#[test]
fn many_missing_jobs_are_summed_up() {
    let rows: Vec<JobRow> = (1..=120).map(|k| row(f64::from(k), 0.4, RowState::Pending)).collect();
    let page = page(&rows);
    assert!(page.contains("### Missing jobs (120)"));
    assert_eq!(page.matches("| pending").count(), 100);
    assert!(page.contains("… and 20 more: see `jobs.csv`."), "{page}");
}

/// Protects: if a file cannot be written, the error names it, and no temporary file is left.
#[test]
fn an_error_names_the_path() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    // A file cannot replace a folder of the same name.
    let blocked = folder.path().join("jobs.csv");
    fs::create_dir(&blocked).expect("a folder");
    let error = write(&report(&partial_study()), folder.path()).expect_err("jobs.csv is a folder");
    assert!(matches!(&error, PublishError::File { path, .. } if *path == blocked), "{error:?}");
    assert!(error.to_string().contains(&blocked.display().to_string()), "{error}");
    assert!(
        names(folder.path()).iter().all(|name| REPORT.contains(&name.as_str())),
        "{:?}",
        names(folder.path())
    );

    let file = folder.path().join("explore.html");
    let error = write(&report(&[]), &file).expect_err("a file is not a folder");
    assert!(matches!(&error, PublishError::Folder { path, .. } if *path == file), "{error:?}");
}
