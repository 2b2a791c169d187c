//! The report's page as a reader meets it: in a browser, with a mouse, a finger, a keyboard and a printer.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;
use tempfile::TempDir;
use tribosweep::report::{JobRow, write};

use crate::chromium::Browser;
use crate::synthetic::{failed, partial_study, report, row};

/// A partial study with a message that must stay text.
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

/// The figure whose data are downloaded under that name: where its points and its texts are, in pixels of the window.
const LOOK: &str = r"(() => {
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
        hits: [...svg.querySelectorAll('.hits > *')].map((hit) => ({ ...hit.dataset, at: middle(hit) })),
        texts: [...svg.querySelectorAll('text')].map(anchor),
        csv: decodeURIComponent(link.href.slice(link.href.indexOf(',') + 1)),
    };
})()";

fn look(browser: &mut Browser, file: &str) -> Value {
    browser.evaluate(&LOOK.replace("NAME", file))
}

fn texts(figure: &Value) -> impl Iterator<Item = (f64, f64, &str)> {
    let texts = figure["texts"].as_array().unwrap().iter();
    texts.map(|text| (number(&text["x"]), number(&text["y"]), text["text"].as_str().unwrap()))
}

/// From values to pixels, by the first and the last of these ticks.
fn scale(ticks: &[(f64, f64)]) -> impl Fn(f64) -> f64 {
    let ((from, from_pixel), (to, to_pixel)) = (ticks[0], ticks[ticks.len() - 1]);
    move |value| from_pixel + (value - from) / (to - from) * (to_pixel - from_pixel)
}

/// Protects: the page needs nothing but itself, nothing in it is an error, and what a study says stays text.
#[test]
fn the_page_is_alone_and_quiet() {
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
    // Links within the page lead somewhere.
    let lost = "[...document.querySelectorAll('a[href^=\"#\"]')].filter((a) => !document.querySelector(a.hash)).length";
    assert_eq!(browser.evaluate(lost), 0);
}

/// Protects: every point of Figure 7 is where its value is on the axes, and carries the values of the data behind it;
/// these are the file beside the page and in it.
#[test]
fn points_are_where_their_values_are() {
    let Some(mut browser) = Browser::start() else { return };
    let (folder, page) = written(&study());
    browser.resize(1200, 900, false);
    browser.open(&page);
    let figure = look(&mut browser, "figure7.csv");
    assert_eq!(
        figure["csv"].as_str().unwrap(),
        fs::read_to_string(folder.path().join("figure7.csv")).unwrap()
    );

    let mut lines = csv(folder.path(), "figure7.csv");
    lines.retain(|line| !line["mu_star"].is_empty());
    let hits = figure["hits"].as_array().unwrap();
    assert_eq!(hits.len(), lines.len());

    // Ticks of the abscissa share a height, those of the ordinate end at the same place.
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
        let hit = hits.iter().find(|hit| hit["job"] == *line["job"]).expect("every job has a point");
        assert_eq!(
            (&hit["x"], &hit["y"]),
            (&line["omega_rpm"].as_str().into(), &line["mu_star"].as_str().into())
        );
        let off = [
            number(&hit["at"]["x"]) - x_of(number(&hit["x"]).log10()),
            number(&hit["at"]["y"]) - y_of(number(&hit["y"])),
        ];
        // Points and ticks are at whole pixels of a drawing of twice the size.
        assert!(off.iter().all(|off| off.abs() < 1.5), "{line:?}: {off:?}");
    }
}

/// Points of a figure: all, or those of a kind; and for each of their values its name, the column that has it, and
/// how many times what is there it is.
type Points = (Option<&'static str>, &'static [(&'static str, &'static str, f64)]);

/// Protects: in every other figure each job that has a result has its points, with the values of the data behind it.
#[test]
fn every_figure_tells_its_data() {
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
        let figure = look(&mut browser, file);
        let hits = figure["hits"].as_array().unwrap();
        let mut compared = 0;
        for (line, (kind, values)) in
            csv(folder.path(), file).iter().flat_map(|line| kinds.iter().map(move |k| (line, k)))
        {
            let of_job = hits.iter().filter(|hit| hit["job"] == *line["job"]);
            let found: Vec<&Value> =
                of_job.filter(|hit| kind.is_none_or(|kind| hit["kind"] == *kind)).collect();
            // What has no number has no point; a map has a cell for every job.
            let has_values = values.iter().all(|(_, column, _)| !line[*column].is_empty());
            assert_eq!(found.len(), usize::from(has_values), "{file}: {line:?}");
            for ((name, column, factor), hit) in
                values.iter().flat_map(|value| found.iter().map(move |hit| (value, hit)))
            {
                let (shown, written) = (number(&hit[*name]), line[*column].parse::<f64>().unwrap() * factor);
                // The residuals' figure shows their size; percent are rounded once.
                assert!(
                    (shown - written.abs()).abs() <= 4.0 * f64::EPSILON * shown.abs(),
                    "{file}: {line:?} {hit}"
                );
                compared += 1;
            }
        }
        assert!(compared > 5, "{file}: {compared}");
    }
}

/// What the tooltip says; nothing if it is not there.
fn tip(browser: &mut Browser) -> String {
    let told = browser.evaluate(
        "(() => { const t = document.getElementById('tip'); return t.hidden ? '' : t.textContent; })()",
    );
    told.as_str().unwrap().to_owned()
}

/// Protects: a mouse, a key and a finger on a point show the values of its job, and of no other.
#[test]
fn pointing_at_a_job_tells_its_values() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&study());
    browser.resize(1200, 900, false);
    browser.open(&page);
    let figure = look(&mut browser, "figure7.csv");
    let find = |figure: &Value, job: &str| {
        figure["hits"].as_array().unwrap().iter().find(|hit| hit["job"] == job).unwrap()["at"].clone()
    };
    assert_eq!(tip(&mut browser), "");
    // 0.3 · (0.8 + 5/50)
    let at = find(&figure, "job-5-0.3");
    browser.move_mouse(number(&at["x"]), number(&at["y"]));
    let told = tip(&mut browser);
    assert!(
        told.starts_with("ω = 5 rpm, μ = 0.3\nμ* = 0.2700 ± 0.0005\n14512 Hz\nstick–slip, periodic"),
        "{told}"
    );
    assert!(told.ends_with("job job-5-0.3"), "{told}");
    let inside = "(() => { const b = document.getElementById('tip').getBoundingClientRect(); \
                  return b.left >= 0 && b.top >= 0 && b.right <= innerWidth && b.bottom <= innerHeight; })()";
    assert_eq!(browser.evaluate(inside), true);
    leave_picture(&mut browser, "report-tip.png");
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
    let map = look(&mut browser, "regime_map.csv");
    let at = find(&map, "job-2-0.3");
    browser.tap(number(&at["x"]), number(&at["y"]));
    let told = tip(&mut browser);
    assert!(told.starts_with("ω = 2 rpm, μ = 0.3\n"), "{told}");
    assert_eq!(browser.evaluate(inside), true);
}

/// Leaves a picture of the page in the folder that `TRIBOSWEEP_PICTURES` names, for people to look at.
fn leave_picture(browser: &mut Browser, name: &str) {
    if let Some(folder) = std::env::var_os("TRIBOSWEEP_PICTURES") {
        fs::write(Path::new(&folder).join(name), browser.screenshot()).unwrap();
    }
}

/// Protects: a phone shows the page without moving it sideways, with text that can be read; wide things move in
/// their own boxes. And paper has it all.
#[test]
fn phones_and_printers_show_it_all() {
    let Some(mut browser) = Browser::start() else { return };
    let (_folder, page) = written(&study());
    browser.resize(390, 844, true);
    browser.open(&page);
    let widths =
        browser.evaluate("[innerWidth, document.documentElement.scrollWidth, document.body.scrollWidth]");
    assert_eq!(widths, serde_json::json!([390, 390, 390]));
    leave_picture(&mut browser, "report-phone.png");
    let figure = look(&mut browser, "figure7.csv");
    let smallest = figure["texts"].as_array().unwrap().iter().map(|text| number(&text["size"]));
    assert!(smallest.clone().fold(f64::MAX, f64::min) > 10.0, "{:?}", smallest.collect::<Vec<_>>());

    browser.resize(1200, 900, false);
    browser.open(&page);
    leave_picture(&mut browser, "report-desktop.png");
    let pdf = browser.print();
    assert!(pdf.starts_with(b"%PDF-"));
    let pages = pdf.windows(b"/Type /Page\n".len()).filter(|part| part.starts_with(b"/Type /Page\n")).count();
    assert!((3..20).contains(&pages), "{pages} pages");
    // What is folded away on the screen is open on paper, and as it was afterwards.
    let mut open_after = |event: &str| {
        let script = format!(
            "(() => {{ dispatchEvent(new Event('{event}')); return document.querySelectorAll('details[open]').length; }})()"
        );
        number(&browser.evaluate(&script))
    };
    assert!(open_after("beforeprint") >= 2.0);
    assert_eq!(open_after("afterprint"), 0.0);
}
