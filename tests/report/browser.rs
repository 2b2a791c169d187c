//! The report's page in a browser, with a mouse, a touch screen, a keyboard and a printer.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;
use tribosweep_output::report::{JobRow, write};

use crate::chromium::Browser;
use crate::synthetic::{failed, partial_study, report, row};

/// A partial study with an error message that looks like markup.
fn study() -> Vec<JobRow> {
    let mut rows = partial_study();
    rows.push(row(75.0, 0.4, failed("<script>window.taken = true</script><img src=x onerror=alert(1)>")));
    rows
}

fn written(rows: &[JobRow]) -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    write(&report(rows), folder.path()).unwrap();
    let page = folder.path().canonicalize().unwrap().join("report.html");
    (folder, page)
}

type Line = BTreeMap<String, String>;

fn csv(folder: &Path, name: &str) -> Vec<Line> {
    csv::Reader::from_path(folder.join(name)).unwrap().deserialize().collect::<Result<_, _>>().unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

/// Finds the figure whose data are downloaded as NAME: its tooltip targets and texts, with positions in pixels of the
/// window, and its data.
const FIND_FIGURE: &str = r"(() => {
    const link = document.querySelector('figcaption a[download=\'NAME\']');
    const svg = link.closest('figure').querySelector('svg');
    svg.scrollIntoView({ block: 'center', behavior: 'instant' });
    const middle = (shape) => {
        const box = shape.getBoundingClientRect();
        return { x: box.x + box.width / 2, y: box.y + box.height / 2, width: box.width, height: box.height };
    };
    // A tick's text is anchored where the tick is.
    const anchor = (text) => {
        const at = new DOMPoint(text.getAttribute('x'), text.getAttribute('y')).matrixTransform(text.getScreenCTM());
        return { x: at.x, y: at.y, text: text.textContent.trim(), size: text.getBoundingClientRect().height };
    };
    return {
        targets: [...svg.querySelectorAll('.hits > *')].map((target) => ({ ...target.dataset, at: middle(target) })),
        texts: [...svg.querySelectorAll('text')].map(anchor),
        csv: decodeURIComponent(link.href.slice(link.href.indexOf(',') + 1)),
    };
})()";

fn figure_of(browser: &mut Browser, file: &str) -> Value {
    browser.evaluate(&FIND_FIGURE.replace("NAME", file))
}

fn texts(figure: &Value) -> impl Iterator<Item = (f64, f64, &str)> {
    let texts = figure["texts"].as_array().unwrap().iter();
    texts.map(|text| (number(&text["x"]), number(&text["y"]), text["text"].as_str().unwrap()))
}

/// The conversion from values to pixels, by the first and the last of these ticks.
fn scale(ticks: &[(f64, f64)]) -> impl Fn(f64) -> f64 {
    let ((from, from_pixel), (to, to_pixel)) = (ticks[0], ticks[ticks.len() - 1]);
    move |value| from_pixel + (value - from) / (to - from) * (to_pixel - from_pixel)
}

/// Protects: the page loads nothing but itself, has no errors, and shows the texts of a study as text.
#[test]
fn the_page_loads_nothing_and_has_no_errors() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&study());
    browser.open(&page);
    assert_eq!(browser.requests(), [format!("file://{}", page.display())]);
    assert!(browser.complaints().is_empty(), "{:?}", browser.complaints());
    assert_eq!(browser.evaluate("typeof window.taken"), "undefined");
    assert_eq!(browser.evaluate("document.querySelectorAll('img').length"), 0);
    let text = browser.evaluate("document.body.innerText");
    assert!(text.as_str().unwrap().contains("<script>window.taken = true</script>"), "{text}");
    let headings = browser.evaluate("document.querySelectorAll('h1').length");
    assert_eq!(headings, 1);
    // Every link within the page has a target.
    let lost = "[...document.querySelectorAll('a[href^=\"#\"]')].filter((a) => !document.querySelector(a.hash)).length";
    assert_eq!(browser.evaluate(lost), 0);
}

/// Protects: every point of Figure 7 is at the position of its value on the axes, and has the values of the data behind
/// it. The page and the folder have the same data.
#[test]
fn points_are_where_their_values_are() {
    let Some(mut browser) = Browser::start() else { return };
    let (folder, page) = written(&study());
    browser.resize(1200, 900, false);
    browser.open(&page);
    let figure = figure_of(&mut browser, "mu_star_points.csv");
    assert_eq!(
        figure["csv"].as_str().unwrap(),
        fs::read_to_string(folder.path().join("mu_star_points.csv")).unwrap()
    );

    let mut lines = csv(folder.path(), "mu_star_points.csv");
    lines.retain(|line| !line["mu_star"].is_empty());
    let targets = figure["targets"].as_array().unwrap();
    assert_eq!(targets.len(), lines.len());

    // The labels of the abscissa have the same height, and those of the ordinate end at the same position.
    let numbers: Vec<(f64, f64, f64)> =
        texts(&figure).filter_map(|(x, y, text)| Some((x, y, text.parse().ok()?))).collect();
    let lowest = numbers.iter().map(|tick| tick.1).fold(f64::MIN, f64::max);
    let leftmost = numbers.iter().map(|tick| tick.0).fold(f64::MAX, f64::min);
    let x_ticks: Vec<(f64, f64)> =
        numbers.iter().filter(|tick| tick.1 == lowest).map(|tick| (tick.2.log10(), tick.0)).collect();
    let y_ticks: Vec<(f64, f64)> =
        numbers.iter().filter(|tick| tick.0 == leftmost).map(|tick| (tick.2, tick.1)).collect();
    assert!(x_ticks.len() >= 3 && y_ticks.len() >= 3, "{numbers:?}");
    let (x_of, y_of) = (scale(&x_ticks), scale(&y_ticks));
    for line in &lines {
        let target =
            targets.iter().find(|target| target["job"] == *line["job"]).expect("every job has a point");
        assert_eq!(
            (&target["x"], &target["y"]),
            (&line["omega_rpm"].as_str().into(), &line["mu_star"].as_str().into())
        );
        let off = [
            number(&target["at"]["x"]) - x_of(number(&target["x"]).log10()),
            number(&target["at"]["y"]) - y_of(number(&target["y"])),
        ];
        // Points and ticks are at whole pixels of a drawing that is twice as large.
        assert!(off.iter().all(|off| off.abs() < 1.5), "{line:?}: {off:?}");
    }
}

/// Points of a figure, all or those of one kind. Each of their values has a name, the column of the data that has it, and
/// the factor between the two.
type Points = (Option<&'static str>, &'static [(&'static str, &'static str, f64)]);

/// Protects: in every other figure, each job with a result has its points, and they have the values of the data.
#[test]
fn every_figure_has_the_values_of_its_data() {
    let Some(mut browser) = Browser::start() else { return };
    let (folder, page) = written(&study());
    browser.open(&page);
    let figures: [(&str, &[Points]); 4] = [
        ("regime_map.csv", &[(None, &[("x", "omega_rpm", 1.0), ("y", "mu", 1.0)])]),
        ("frequency_map.csv", &[(None, &[("x", "omega_rpm", 1.0), ("y", "frequency_hz", 1.0)])]),
        (
            "residuals.csv",
            &[
                (Some("energy_residual"), &[("y", "energy_residual", 1.0)]),
                (Some("identity_residual"), &[("y", "identity_residual", 1.0)]),
            ],
        ),
        (
            "shares.csv",
            &[(
                None,
                &[
                    ("mu", "mu", 1.0),
                    ("stick", "stick_share", 100.0),
                    ("slip", "slip_share", 100.0),
                    ("separated", "separated_share", 100.0),
                ],
            )],
        ),
    ];
    for (file, kinds) in figures {
        let figure = figure_of(&mut browser, file);
        let targets = figure["targets"].as_array().unwrap();
        let mut compared = 0;
        for (line, (kind, values)) in
            csv(folder.path(), file).iter().flat_map(|line| kinds.iter().map(move |k| (line, k)))
        {
            let of_job = targets.iter().filter(|target| target["job"] == *line["job"]);
            let found: Vec<&Value> =
                of_job.filter(|target| kind.is_none_or(|kind| target["kind"] == *kind)).collect();
            // A job without a value has no point; a map has a cell for every job.
            let has_values = values.iter().all(|(_, column, _)| !line[*column].is_empty());
            assert_eq!(found.len(), usize::from(has_values), "{file}: {line:?}");
            for ((name, column, factor), target) in
                values.iter().flat_map(|value| found.iter().map(move |target| (value, target)))
            {
                let (shown, written) =
                    (number(&target[*name]), line[*column].parse::<f64>().unwrap() * factor);
                // The figure of residuals shows absolute values; percentages are rounded once.
                assert!(
                    (shown - written.abs()).abs() <= 4.0 * f64::EPSILON * shown.abs(),
                    "{file}: {line:?} {target}"
                );
                compared += 1;
            }
        }
        assert!(compared > 5, "{file}: {compared}");
    }
}

/// The text of the tooltip; empty if it is hidden.
fn tip(browser: &mut Browser) -> String {
    let text = browser.evaluate(
        "(() => { const t = document.getElementById('tip'); return t.hidden ? '' : t.textContent; })()",
    );
    text.as_str().unwrap().to_owned()
}

/// Protects: the mouse, the keyboard and a touch on a point show the values of its job and of no other.
#[test]
fn pointing_at_a_job_shows_its_values() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&study());
    browser.resize(1200, 900, false);
    browser.open(&page);
    let figure = figure_of(&mut browser, "mu_star_points.csv");
    let find = |figure: &Value, job: &str| {
        figure["targets"].as_array().unwrap().iter().find(|target| target["job"] == job).unwrap()["at"]
            .clone()
    };
    assert_eq!(tip(&mut browser), "");
    // 0.3 · (0.8 + 5/50)
    let at = find(&figure, "job-5-0.3");
    browser.move_mouse(number(&at["x"]), number(&at["y"]));
    let text = tip(&mut browser);
    assert!(text.starts_with("ω = 5 rpm, μ = 0.3\nμ* = 0.270\n14510 Hz\nstick–slip, periodic"), "{text}");
    assert!(text.ends_with("job job-5-0.3"), "{text}");
    let inside = "(() => { const b = document.getElementById('tip').getBoundingClientRect(); \
                  return b.left >= 0 && b.top >= 0 && b.right <= innerWidth && b.bottom <= innerHeight; })()";
    assert_eq!(browser.evaluate(inside), true);
    save_picture(&mut browser, "report-tip.png");
    browser.move_mouse(2.0, 2.0);
    assert_eq!(tip(&mut browser), "");

    browser.evaluate("document.querySelector('figure svg .hits > *').focus()");
    assert!(tip(&mut browser).starts_with("ω = 1 rpm, μ = 0.2"));
    browser.press("ArrowRight");
    assert!(tip(&mut browser).starts_with("ω = 2 rpm, μ = 0.2"), "{}", tip(&mut browser));
    browser.press("Escape");
    assert_eq!(tip(&mut browser), "");

    browser.resize(390, 844, true);
    browser.open(&page);
    let map = figure_of(&mut browser, "regime_map.csv");
    let at = find(&map, "job-2-0.3");
    browser.tap(number(&at["x"]), number(&at["y"]));
    let text = tip(&mut browser);
    assert!(text.starts_with("ω = 2 rpm, μ = 0.3\n"), "{text}");
    assert_eq!(browser.evaluate(inside), true);
}

/// Saves a picture of the page in the folder that `TRIBOSWEEP_PICTURES` names, for a visual check.
fn save_picture(browser: &mut Browser, name: &str) {
    if let Some(folder) = std::env::var_os("TRIBOSWEEP_PICTURES") {
        fs::write(Path::new(&folder).join(name), browser.screenshot()).unwrap();
    }
}

/// Protects: on a phone the page does not scroll sideways and a figure is as wide as the screen; wide tables scroll in
/// their own boxes. The printed page has all content.
#[test]
fn phones_and_printers_show_the_whole_page() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&study());
    browser.resize(390, 844, true);
    browser.open(&page);
    let widths =
        browser.evaluate("[innerWidth, document.documentElement.scrollWidth, document.body.scrollWidth]");
    assert_eq!(widths, serde_json::json!([390, 390, 390]));
    save_picture(&mut browser, "report-phone.png");
    let figure = figure_of(&mut browser, "mu_star_points.csv");
    // A figure of 780 px with text of 15 px is as wide as the screen of 390 px, so that its text has half that size.
    let sizes = figure["texts"].as_array().unwrap().iter().map(|text| number(&text["size"]));
    assert!(sizes.clone().all(|size| size >= 7.5), "{:?}", sizes.collect::<Vec<_>>());

    browser.resize(1200, 900, false);
    browser.open(&page);
    save_picture(&mut browser, "report-desktop.png");
    let pdf = browser.print();
    assert!(pdf.starts_with(b"%PDF-"));
    let pages = pdf.windows(b"/Type /Page\n".len()).filter(|part| part.starts_with(b"/Type /Page\n")).count();
    assert!((3..20).contains(&pages), "{pages} pages");
    // Details that are folded on the screen are open on paper, and folded again afterwards.
    let mut open_after = |event: &str| {
        let script = format!(
            "(() => {{ dispatchEvent(new Event('{event}')); return document.querySelectorAll('details[open]').length; }})()"
        );
        number(&browser.evaluate(&script))
    };
    assert!(open_after("beforeprint") >= 2.0);
    assert_eq!(open_after("afterprint"), 0.0);
}
