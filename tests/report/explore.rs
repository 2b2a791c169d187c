//! The page to explore in a browser: thousands of jobs, charts that a reader chooses, a table that sorts and filters.

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;
use tribosweep_output::publish::{Sheet, SheetGroup, SheetLine};
use tribosweep_output::report::{JobRow, Report, write};

use crate::chromium::Browser;
use crate::synthetic::{failed, measured, partial_study, periodic, report, row, with};

const JOBS: i32 = 5_000;

/// Jobs over ω and μ, and a failed one whose message looks like markup.
fn many() -> Vec<JobRow> {
    let job = |i: i32| {
        let (omega_rpm, mu) = (1.0 + f64::from(i % 100), 0.1 + 0.01 * f64::from(i / 100));
        with(row(omega_rpm, mu, periodic(0.2 + 0.001 * f64::from(i % 70))), "load_n", i % 7)
    };
    let mut rows: Vec<JobRow> = (0..JOBS - 1).map(job).collect();
    rows.push(with(row(200.0, 0.7, failed("</script><script>window.taken = true</script>")), "load_n", 3));
    rows
}

fn written(rows: &[JobRow]) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    write(&report(rows), folder.path()).unwrap();
    let page = folder.path().canonicalize().unwrap().join("explore.html");
    (folder, page)
}

fn pressed(name: &str) -> String {
    format!(
        "[...document.querySelectorAll('#explore .tabs button')].find((tab) => tab.textContent === '{name}').click()"
    )
}

/// Protects: the page is one file that loads nothing, and the texts of a study are data and no markup.
#[test]
fn the_page_loads_nothing() {
    let rows = [row(7.0, 0.4, failed("</script><script>alert(1)</script>")), row(9.0, 0.4, periodic(0.3))];
    let (_folder, page) = written(&rows);
    let page = fs::read_to_string(page).unwrap();
    assert!(!page.contains("<script>alert") && page.contains("default-src 'none'"));
    assert!(!page.contains("<script src") && !page.contains("<link rel=\"stylesheet\""));
}

/// Protects: with 5 000 jobs every view is drawn without an error, a filter leaves exactly the jobs that it names, a click on a
/// head sorts by numbers, and a line leads to all values of its job.
#[test]
fn thousands_of_jobs_can_be_explored() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&many());
    browser.open(&page);
    for view in ["parallel coordinates", "plot"] {
        browser.evaluate(&pressed(view));
        let drawn = "(() => { const c = document.querySelector('#explore canvas'); return c !== null && c.width > 300; })()";
        assert_eq!(browser.evaluate(drawn), true, "{view}");
    }
    browser.evaluate(&pressed("table"));
    let note = "document.querySelector('#explore .note').textContent";
    assert_eq!(browser.evaluate(note), format!("The first 250 of {JOBS} jobs: filter them."));
    let filter = "(() => { const f = document.querySelector('[aria-label=\"filter mu\"]'); f.value = '0.1..0.115'; \
                  f.dispatchEvent(new Event('input')); })()";
    browser.evaluate(filter);
    assert_eq!(browser.evaluate(note), format!("200 of {JOBS} jobs"), "two values of μ with 100 speeds each");
    let speeds = "[...document.querySelectorAll('#explore tbody tr')].map((line) => Number(line.cells[0].textContent))";
    browser.evaluate("document.querySelector('#explore thead th').click()");
    let ascending = browser.evaluate(speeds);
    let found: Vec<f64> = ascending.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!(found.len() == 200 && found.is_sorted() && found[0] < found[199], "{found:?}");
    browser.evaluate("document.querySelector('#explore tbody tr').click()");
    let job = browser.evaluate("document.querySelector('#job').textContent");
    assert!(job.as_str().unwrap().contains("tribosweep show"), "{job}");
    assert_eq!(browser.evaluate("window.taken === undefined"), true);
}

/// Protects: on a full grid the importance of both parameters can be seen, which is exact there.
#[test]
fn importance_is_that_of_the_grid() {
    let Some(mut browser) = Browser::start() else { return };
    let point = |omega: i32, mu: i32| {
        let mu = f64::from(mu) / 10.0;
        row(f64::from(omega), mu, periodic(mu - 0.01 * f64::from(omega)))
    };
    let rows: Vec<JobRow> = (1..9).flat_map(|omega| (2..7).map(move |mu| point(omega, mu))).collect();
    let (_folder, page) = written(&rows);
    browser.open(&page);
    browser.evaluate(&pressed("importance"));
    let bars = "JSON.parse(document.getElementById('data').textContent).importance[0].bars.map((bar) => [bar.name, bar.value])";
    let bars = browser.evaluate(bars);
    let share = |at: usize| bars[at][1].as_f64().unwrap();
    // The variance of a sum of both is the sum of those of μ, 0.02, and of 0.01 ω, 1e-4 · 5.25.
    let expected = 1e-4 * 5.25 / (0.02 + 1e-4 * 5.25);
    assert_eq!((&bars[0][0], &bars[1][0]), (&"omega_rpm".into(), &"mu".into()));
    assert!((share(0) - expected).abs() < 1e-9 && (share(1) - (1.0 - expected)).abs() < 1e-9, "{bars}");
}

/// Protects: the page has what all jobs have in common too, and counts measured points apart.
#[test]
fn the_page_has_what_does_not_vary() {
    let line = SheetLine {
        name: "load".to_owned(),
        value: "30 N".to_owned(),
        key: "load_n",
        ..SheetLine::default()
    };
    let several = SheetLine { name: "time step".to_owned(), varies: true, ..SheetLine::default() };
    let varied = SheetLine { name: "friction coefficient".to_owned(), key: "mu", ..SheetLine::default() };
    let groups = vec![SheetGroup { heading: "pin", lines: vec![line, several, varied] }];
    let sheet = Sheet { groups, ..Sheet::default() };
    let rows = [row(7.0, 0.4, periodic(0.3)), row(9.0, 0.5, periodic(0.3)), measured(9.0, 0.4, 0.33, None)];
    let folder = TempDir::new().unwrap();
    write(&Report { sheet: Some(&sheet), ..report(&rows) }, folder.path()).unwrap();
    let page = fs::read_to_string(folder.path().join("explore.html")).unwrap();
    assert!(page.contains("All 2 jobs and 1 measured point."), "jobs and points");
    assert!(page.contains(r#""setup":[{"name":"load","value":"30 N"}]"#), "the load alone");
    let Some(mut browser) = Browser::start() else { return };
    browser.open(&folder.path().canonicalize().unwrap().join("explore.html"));
    browser.evaluate(&pressed("table"));
    browser.evaluate("document.querySelector('#explore tbody tr').click()");
    let job = browser.evaluate("document.querySelector('#job').textContent");
    assert!(job.as_str().unwrap().contains("load30 N"), "{job}");
}

/// Protects: a measured point is a mark of its own and in no line of jobs, and a click on it names no command; jobs without the coloured
/// value come last.
#[test]
fn measured_points_are_in_no_line() {
    let Some(mut browser) = Browser::start() else { return };
    let mut rows: Vec<JobRow> =
        [2.0, 7.0, 20.0].map(|omega| row(omega, 0.4, periodic(0.3 + 0.001 * omega))).into();
    rows.push(row(30.0, 0.4, failed("diverged")));
    rows.push(measured(7.0, 0.4, 0.33, None));
    let (_folder, page) = written(&rows);
    browser.open(&page);
    let series = "echarts.getInstanceByDom(document.querySelector('#explore .chart')).getOption().series";
    let kinds = browser.evaluate(&format!("{series}.map((own) => [own.type, own.data.length])"));
    assert_eq!(kinds, serde_json::json!([["line", 3], ["scatter", 1]]));
    let note = browser.evaluate("document.querySelector('#explore .left').textContent");
    assert!(note.as_str().unwrap().starts_with("1 of 5 points"), "{note}");
    let choose = "(() => { const c = document.querySelector('[aria-label=colour]'); c.value = 'mu_star_contact'; \
                  c.dispatchEvent(new Event('change')); })()";
    browser.evaluate(choose);
    let names = browser.evaluate(&format!("{series}.map((own) => own.name)"));
    assert_eq!(
        names,
        serde_json::json!(["0.302", "0.307", "0.32", "–"]),
        "the measured point has no such value"
    );
    browser.evaluate(&pressed("table"));
    browser.evaluate("document.querySelector('#explore tbody tr:last-child').click()");
    let job = browser.evaluate("document.querySelector('#job').textContent");
    let job = job.as_str().unwrap();
    assert!(job.starts_with("measured point") && !job.contains("tribosweep show"), "{job}");
}

/// Protects: a study in progress has a page without errors.
#[test]
fn few_jobs_can_be_explored() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&partial_study());
    browser.open(&page);
    assert_eq!(browser.evaluate("document.querySelector('#explore canvas') !== null"), true);
    let names = "[...document.querySelector('[aria-label=y]').options].map((option) => option.value).includes('mu_star')";
    assert_eq!(browser.evaluate(names), true);
}
