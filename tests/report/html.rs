//! The page for a browser: its contents, what it leaves out, and that texts of a study are never markup.

use crate::synthetic::{failed, partial_study, periodic, report, row, with};
use std::fs;
use tribosweep::report::{BuildInfo, JobRow, Provenance, Report, ResultGroup, RowState, write};

fn page_of(report: &Report) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(report, folder.path()).expect("the report is written");
    fs::read_to_string(folder.path().join("report.html")).expect("the page is there")
}

fn page(rows: &[JobRow]) -> String {
    page_of(&report(rows))
}

/// The text of a page without the markup.
fn text(page: &str) -> String {
    let body = page.split_once("<main>").expect("a body").1.split("<script>").next().expect("its end");
    let mut text = String::new();
    for part in body.split('<') {
        text.push_str(part.split_once('>').map_or(part, |(_, text)| text));
    }
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").replace("&quot;", "\"")
}

/// Protects: the page has all sections, and it starts with what is missing.
#[test]
fn a_partial_study_says_what_is_missing() {
    let page = page(&partial_study());
    let text = text(&page);
    let missing = "This report is incomplete: 3 of 18 jobs are missing (1 running, 2 pending)";
    let at = |part: &str| text.find(part).unwrap_or_else(|| panic!("no {part:?} in {text}"));
    assert!(at(missing) < at("jobs done"));
    at("14 of 18");
    at("7 periodic, 6 decayed, 1 not periodic");
    at("1 job has failed");
    for heading in [
        "Macroscopic friction",
        "Frequency",
        "Contact regimes",
        "Stick, slip and separation",
        "Residuals",
        "Trouble",
        "Run times",
        "Failed jobs (1)",
        "Not periodic (1)",
        "Missing jobs (3)",
    ] {
        at(heading);
    }
    at("the mesh has no node row at the clamp's width");
    // 18 jobs of 12.5 s.
    at("3.8 min");
    assert_eq!(page.matches("<svg ").count(), 6);
    for file in ["figure7", "frequency_map", "regime_map", "shares", "residuals", "run_times"] {
        assert!(page.contains(&format!("download=\"{file}.csv\"")), "{file}");
    }
}

/// Protects: the page of a complete study has no warning and no empty sections.
#[test]
fn a_complete_study_has_nothing_to_warn_of() {
    let page = page(&[row(7.0, 0.4, periodic(0.35)), row(9.0, 0.4, periodic(0.35))]);
    for absent in ["incomplete", "Trouble", "Failed jobs", "Missing jobs", "class=\"warning\"", "Provenance"]
    {
        assert!(!page.contains(absent), "{absent}");
    }
}

/// Protects: the page is one file, which loads nothing.
#[test]
fn nothing_is_loaded() {
    let page = page(&partial_study());
    for loads in ["src=", "@import", "url(", "<iframe", "<object"] {
        assert!(!page.contains(loads), "{loads}");
    }
    let is_own = |address: &str| address.starts_with('#') || address.starts_with("data:");
    assert!(page.split("href=\"").skip(1).all(is_own));
    // The name of the SVG namespace is not loaded.
    let others = page.matches("http").count() - page.matches("http://www.w3.org/2000/svg").count();
    assert_eq!(others, page.matches("http-equiv").count());
}

/// Protects: names and messages of a study are shown as text everywhere.
#[test]
fn what_a_study_says_is_text() {
    let markup = "</title></svg><script>alert(1)</script>\"'&";
    let mut rows = partial_study();
    rows.push(row(20.0, 0.4, failed(markup)));
    let rows: Vec<JobRow> = rows.into_iter().map(|row| with(row, markup, markup)).collect();
    let provenance = Provenance { document: markup.to_owned(), ..Provenance::default() };
    let page = page_of(&Report { title: markup, provenance: Some(&provenance), ..report(&rows) });
    assert_eq!(page.matches("<script").count(), 1, "the page's own");
    assert_eq!(page.matches("</svg>").count(), page.matches("<svg ").count());
    assert!(text(&page).matches("alert(1)").count() > 5);
}

/// Protects: a page that is going to be written again reloads itself, and the last one does not.
#[test]
fn only_a_page_that_changes_refreshes() {
    let rows = partial_study();
    assert!(!page(&rows).contains("http-equiv=\"refresh\""));
    let refreshed = page_of(&Report { refresh_s: Some(7), ..report(&rows) });
    assert!(refreshed.contains("<meta http-equiv=\"refresh\" content=\"7\">"));
}

fn group(commit: &str, host: &str, jobs: u64, first_ms: i64, last_ms: i64) -> ResultGroup {
    let build = BuildInfo {
        version: "0.1.0".to_owned(),
        commit: commit.to_owned(),
        host: host.to_owned(),
        cpu: Some("Quick 9000".to_owned()),
        platform: "x86_64 linux".to_owned(),
        vectors: "Avx2".to_owned(),
        threads: 4,
    };
    ResultGroup { build: Some(build), jobs, first_ms, last_ms }
}

/// Protects: the provenance has one line for each program and machine, and a warning if there are several.
#[test]
fn results_have_their_provenance() {
    let day = 86_400_000;
    let alike = [group("aaaa", "one", 2, 2 * day, 3 * day), group("aaaa", "one", 3, day, 2 * day)];
    let provenance = Provenance::grouped("{ \"name\": \"mine\" }".to_owned(), 0, alike.clone());
    assert_eq!(provenance.groups, [group("aaaa", "one", 5, day, 3 * day)]);
    let rows = partial_study();
    let page =
        |provenance: &Provenance| text(&page_of(&Report { provenance: Some(provenance), ..report(&rows) }));
    let text = page(&provenance);
    for part in [
        "Submitted 1970-01-01 00:00 UTC",
        "1970-01-02 00:00 UTCto 1970-01-04 00:00 UTC",
        "0.1.0aaaa",
        "Quick 9000 (x86_64 linux)",
        "Avx2",
        "{ \"name\": \"mine\" }",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    assert!(!text.contains("The results come from"));

    let several =
        [group("bbbb+modified", "one", 1, 0, 0), group("aaaa", "two", 1, 0, 0), ResultGroup::default()];
    let text = page(&Provenance::grouped(String::new(), 0, alike.into_iter().chain(several)));
    for part in ["come from 2 builds", "come from 2 machines", "changes that are in no commit", "unknown"] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

/// Protects: of many combinations the page shows the first ones, says how many are left out, and stays small.
#[test]
fn many_combinations_are_left_out() {
    let rows: Vec<JobRow> = (0..40)
        .flat_map(|load| partial_study().into_iter().map(move |row| with(row, "load_n", load)))
        .collect();
    let page = page(&rows);
    assert_eq!(page.matches("data-value=\"K\"").count(), 6 * 5, "six maps of regimes");
    assert!(text(&page).contains("34 more combinations of parameters, 612 jobs, are left out of this page"));
    assert!(page.contains("<h3>load_n = 5</h3>") && !page.contains("<h3>load_n = 6</h3>"));
}

/// Protects: the page of a study of a hundred thousand jobs is small enough for a browser. It has no figures, and says
/// so.
#[test]
fn a_huge_study_has_a_small_page() {
    let rows: Vec<JobRow> = (0..100_000)
        .map(|i| row(f64::from(i % 1000), 0.1 + f64::from(i / 1000) * 0.005, RowState::Pending))
        .collect();
    let page = page(&rows);
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    assert!(text(&page).contains("100000 jobs are too many for this page"));
    assert!(text(&page).contains("99900 more"), "missing jobs are summed up");
}

/// Protects: a study of some thousand jobs is drawn, but without tooltips.
#[test]
fn a_large_study_is_drawn() {
    let rows: Vec<JobRow> =
        (0..5_000).map(|i| row(f64::from(i % 100), 0.1 + f64::from(i / 100) * 0.01, periodic(0.3))).collect();
    let page = page(&rows);
    assert!(page.len() < 12_000_000, "{} bytes", page.len());
    assert!(page.matches("<svg ").count() == 6 && !page.contains("data-job"));
    assert!(text(&page).contains("There are too many jobs for tooltips"));
}
