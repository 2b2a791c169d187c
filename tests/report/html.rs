//! The page for a browser: its contents, what it leaves out, and that texts of a study are never markup.

use crate::charts::drawings;
use crate::synthetic::{after, done, failed, numerics, partial_study, periodic, report, row, with};
use std::fs;
use tribosweep_mechanics::analysis::{Build, JobRecord, Outcome, Regime};
use tribosweep_output::report::{
    JobNumerics, JobRow, Provenance, Report, ResultGroup, RowState, inspections, trouble, write,
};

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
    assert!(at(missing) < at("Macroscopic friction"), "first what a reader must know");
    assert!(at("μ* falls furthest below μ at") < at(missing), "and before it what was found");
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
    assert_eq!(drawings(&page), 9 + 2, "with the drawings of the scene");
    for file in [
        "mu_star_points",
        "frequency_map",
        "regime_map",
        "bifurcation",
        "growth_rate",
        "shares",
        "residuals",
        "run_times",
    ] {
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
    // Links lead to sections, and on request to files beside the page.
    let is_own = |address: &str| {
        let address = address.split('"').next().unwrap_or_default();
        address.starts_with('#') || address.starts_with("data:") || !address.contains([':', '/'])
    };
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

/// Protects: doubtful inputs stand on the page before the navigation, as text.
#[test]
fn doubtful_inputs_stand_at_the_head() {
    let rows = [row(7.0, 0.4, periodic(0.35))];
    let warnings = ["scene.load.force_n = 30000: <much>".to_owned()];
    let remarks = ["numerics.beta_r_s: damping shortens the time step".to_owned()];
    let page = page_of(&Report { warnings: &warnings, remarks: &remarks, ..report(&rows) });
    let (head, _) = page.split_once("<nav").unwrap();
    // A remark about the cost is in no box.
    let (boxed, after) = head.split_once("</ul>").unwrap();
    assert!(!boxed.contains("shortens the time step") && after.contains("shortens the time step"), "{head}");
    let remark_alone = page_of(&Report { remarks: &remarks, ..report(&rows) });
    assert!(!remark_alone.contains("Check these inputs") && remark_alone.contains("shortens the time step"));
    assert!(
        text(head)
            .contains("Check these inputs before you use the results:scene.load.force_n = 30000: <much>"),
        "{head}"
    );
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
    let build = Build {
        program: "tribosweep".to_owned(),
        version: "0.1.0".to_owned(),
        commit: commit.to_owned(),
        host: host.to_owned(),
        cpu: Some("Quick 9000".to_owned()),
        architecture: "x86_64".to_owned(),
        system: "linux".to_owned(),
        vectors: "Avx2".to_owned(),
        threads: 4,
        pid: 0,
    };
    ResultGroup { build: Some(build), jobs, first_ms, last_ms }
}

/// Protects: the provenance has one line for each program and machine, and a warning if there are several.
#[test]
fn results_have_their_provenance() {
    let day = 86_400_000;
    let mut alike = [group("aaaa", "one", 2, 2 * day, 3 * day), group("aaaa", "one", 3, day, 2 * day)];
    alike[1].build.as_mut().expect("a build").pid = 7;
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
    let message = "two figures with twelve maps of regimes, and two maps on true axes";
    assert_eq!(page.matches("data-value=\"K\"").count(), (24 + 2) * 5, "{message}");
    assert!(text(&page).contains("left out of this page: 16 more combinations of parameters, 288 jobs"));
    assert!(text(&page).contains("left out of this page: 34 more combinations of parameters, 612 jobs"));
    assert!(page.contains(">load = 5 N</th>") && !page.contains(">load = 6 N</th>"));
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
    assert!(drawings(&page) == 9 + 2 && !page.contains("data-job"));
    assert!(text(&page).contains("There are too many jobs for tooltips"));
}

/// Protects: the page says what the study is for and what was simulated, as text, in both forms.
#[test]
fn what_was_simulated_is_on_the_page() {
    let rows = partial_study();
    let described = Report { description: Some("Softer pins, <i>for brakes</i>"), ..report(&rows) };
    let page = text(&page_of(&described));
    for part in [
        "Softer pins, <i>for brakes</i>",
        "What was simulated",
        "drawing of scene",
        "drawing of track",
        "Ed",
        "Young's modulus <b>",
        "0.5 GPa",
        "disk_young_modulus_pa",
    ] {
        assert!(page.contains(part), "{part} in {page}");
    }
    let folder = tempfile::tempdir().unwrap();
    write(&described, folder.path()).unwrap();
    let markdown = fs::read_to_string(folder.path().join("report.md")).unwrap();
    for part in ["Softer pins, &lt;i>for brakes", "![drawing of scene](scene.svg)", "| 0.5 GPa"] {
        assert!(markdown.contains(part), "{part} in {markdown}");
    }
    assert!(fs::read_to_string(folder.path().join("track.svg")).unwrap().starts_with("<svg"));
}

/// Protects: the first sentence has an error only where that of the mesh is known, because the spread over the cycles alone would claim
/// more than is known.
#[test]
fn the_first_sentence_claims_no_error_that_is_not_known() {
    let job = || row(7.0, 0.4, periodic(0.263_429));
    let sentence = |job: JobRow| {
        let text = text(&page(&[job]));
        text.split("μ* falls furthest below μ").nth(1).unwrap().split(" % of μ.").next().unwrap().to_owned()
    };
    let known = sentence(after(job(), 0.262, 14_500.0));
    assert!(known.contains("0.263 ±"), "{known}");
    let unknown = sentence(job());
    assert!(unknown.contains("to 0.263") && !unknown.contains('±'), "{unknown}");
}

/// Protects: the first sentence speaks of jobs that settled alone, and says so where others did not.
#[test]
fn the_first_sentence_says_which_jobs_settled() {
    let stable = |omega| row(omega, 0.4, done(Outcome::Decayed, Regime::Stable, 0.3995));
    let open = row(9.0, 0.4, done(Outcome::NotPeriodic, Regime::StickSlip, 0.23));
    let all = text(&page(&[stable(5.0), stable(7.0)]));
    assert!(all.contains("μ* is μ within half a per cent in all jobs."), "{all}");
    let some = text(&page(&[stable(5.0), stable(7.0), open]));
    assert!(some.contains("μ* is μ within half a per cent in the 2 jobs that settled."), "{some}");
}

/// Protects: the head names the damping of the material, that of the time scheme, or both and their sum; jobs of several dampings have no
/// such sentence.
#[test]
fn the_damping_is_named_with_all_its_parts() {
    let job = |beta2: f64, beta_r_s: f64| {
        let RowState::Done(mut record) = periodic(0.3) else { panic!("a result") };
        record.time_step_s = 1.0e-7;
        let numerics = Some(JobNumerics { beta2, beta_r_s, ..numerics(4, 0.7) });
        JobRow { numerics, ..row(7.0, 0.4, RowState::Done(record)) }
    };
    for (beta2, beta_r_s, sentence) in [
        (
            0.5,
            2.75e-8,
            "Damping: β_R = 27.5 ns, that of β₂ = 1 at Δt = 55 ns. At the frequencies of the limit cycles the loss factor is 0.0025.",
        ),
        (1.0, 0.0, "Damping: that of the time scheme, which is β_R = 50 ns."),
        (1.0, 2.0e-8, "Damping: β_R = 20 ns of the material and 50 ns of the time scheme, 70 ns in all."),
        (0.5, 0.0, "The pin has no damping."),
    ] {
        let text = text(&page(&[job(beta2, beta_r_s)]));
        assert_eq!(text.contains("loss factor"), sentence.starts_with("Damping"), "{text}");
        assert!(text.contains(sentence), "{sentence}: {text}");
    }
    let text = text(&page(&[job(0.5, 2.0e-8), job(1.0, 2.0e-8)]));
    assert!(!text.contains("Damping:"), "{text}");
}

/// Protects: the largest mesh error is in the head, and tables do not promise digits that it does not leave. The CSV keeps them.
#[test]
fn digits_follow_the_error() {
    let job = |omega| row(omega, 0.4, periodic(0.263_429));
    let cases = [
        (Some((0.163, 14_500.0)), "0.26", "14510", "of μ*, at ", "Mesh: the error of μ* is at most 0."),
        (
            None,
            "0.263",
            "14510",
            "unknown",
            "the error of 2 of 2 jobs is unknown: no run on a coarser mesh (2 jobs)",
        ),
        (Some((0.263_429, 14_512.4)), "0.263", "14510", "of μ*, at ", "Mesh: the error of μ* is at most 0.0"),
    ];
    for (coarser, mu_star, frequency, tile, sentence) in cases {
        let rows = [7.0, 9.0].map(|omega| match coarser {
            Some((mu_star, hz)) => after(job(omega), mu_star, hz),
            None => job(omega),
        });
        let page = page(&rows);
        for part in [format!("<td>{mu_star}</td>"), format!("<td>{frequency}</td>")] {
            assert_eq!(page.matches(&part).count(), 2, "{part}");
        }
        let text = text(&page);
        assert!(text.contains(tile) && text.contains(sentence), "{text}");
        let folder = tempfile::tempdir().unwrap();
        write(&report(&rows), folder.path()).unwrap();
        let read = |file: &str| fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(read("jobs.csv").contains("0.263429") && read("mu_star.csv").contains("7,0.2634"));
        let sentence = sentence.replace('*', "\\*");
        assert!(read("report.md").contains(&sentence), "{sentence}");
        assert!(read("report.md").contains(&format!(" {mu_star} |")));
    }
}

/// Protects: a result whose balances do not close, or whose pin hops, is listed with its reason and warned of, although it is periodic. Results
/// like those of `figure7` are not.
#[test]
fn doubtful_results_are_listed() {
    let changed = |omega, change: fn(&mut JobRecord)| {
        let mut row = row(omega, 0.4, periodic(0.3));
        let RowState::Done(record) = &mut row.state else { panic!("{row:?}") };
        change(record);
        row
    };
    let rows = [
        changed(2.0, |record| (record.n_over_f_min, record.n_over_f_max) = (0.01, 9.9)),
        changed(3.0, |record| {
            (record.n_over_f_min, record.n_over_f_max, record.separated_share) = (0.0, 145.0, 0.93);
        }),
        // A load that rises in the window has large forces, and the pin stays on the disk.
        changed(7.0, |record| (record.n_over_f_min, record.n_over_f_max) = (0.3, 12.0)),
        changed(4.0, |record| record.macroscopic_identity_residual = -0.15),
        changed(5.0, |record| (record.energy_residual, record.energy_identity_residual) = (0.02, 0.03)),
        changed(6.0, |record| record.energy_residual = 0.009),
    ];
    let warnings = trouble::warnings(&rows);
    let [balances, hops] = &warnings[..] else { panic!("{warnings:?}") };
    assert!(
        balances.starts_with("in 2 jobs (the first one at ω = 4 rpm, μ = 0.4) a residual is above 0.01"),
        "{balances}"
    );
    assert!(hops.starts_with("in the job at ω = 3 rpm, μ = 0.4 the pin hops"), "{hops}");
    let found = text(&page(&rows));
    for part in [
        "Doubt the results of 3 of 6 jobs: a residual is large (2), the pin hops (1).",
        "Large residuals (2)",
        "the identities of the window have a residual of 0.15",
        "the energies of the run have a residual of 0.02, and the identities of the window have a residual of 0.03",
        "The pin hops (1)",
        "the normal force reaches 145 times the load, and the nodes of the base are apart from the disk for 93 % of the time on average: the whole pin flies and lands, and the frequency is that with which its flights repeat",
    ] {
        assert!(found.contains(part), "{part}: {found}");
    }
    assert_eq!(trouble::warnings(&rows[..1]), Vec::<String>::new());
}

/// Protects: the page says in how many jobs the accuracy that is asked for is not reached, and lists these with their errors.
#[test]
fn jobs_that_are_not_accurate_are_listed() {
    let asked = |omega, reached, coarser: Option<f64>| {
        let mut row = row(omega, 0.4, periodic(0.3));
        if let Some(mu_star) = coarser {
            row = after(row, mu_star, 14_500.0);
        }
        if let RowState::Done(record) = &mut row.state {
            record.accuracy_reached = Some(reached);
        }
        row
    };
    let mixed = [asked(2.0, true, Some(0.301)), asked(3.0, false, Some(0.33)), asked(4.0, false, None)];
    let text_of = |rows: &[JobRow]| text(&page(rows));
    let found = text_of(&mixed);
    for part in [
        "what is asked for is not reached in 2 of 3 jobs",
        "Accuracy not reached (2)",
        "the error of μ* may be 0.042, 14 % of it",
        "the error of μ* is unknown: no run on a coarser mesh",
    ] {
        assert!(found.contains(part), "{part}: {found}");
    }
    assert!(
        trouble::warnings(&mixed)[0]
            .starts_with("in 2 jobs (the first one at ω = 3 rpm, μ = 0.4) the accuracy")
    );
    let all = text_of(&mixed[..1]);
    assert!(all.contains("reached in all jobs that ask (1 job)") && !all.contains("Accuracy not"), "{all}");
    assert_eq!(trouble::warnings(&mixed[..1]), Vec::<String>::new());
    let nobody = text_of(&[row(2.0, 0.4, periodic(0.3))]);
    assert!(!nobody.contains("Accuracy"), "{nobody}");
}

/// Protects: a study says in how many jobs the mesh error is unknown, and why.
#[test]
fn unknown_errors_are_counted() {
    let job = |omega| row(omega, 0.4, periodic(0.3));
    let mut other = after(job(3.0), 0.3, 14_500.0);
    if let RowState::Done(record) = &mut other.state {
        record.regime = Regime::SlipSeparation;
    }
    let text = text(&page(&[after(job(2.0), 0.29, 14_500.0), other, job(4.0)]));
    for part in [
        "the error of 2 of 3 jobs is unknown: another regime on the coarser mesh (1 job); no run on a coarser mesh (1 job)",
        "unknown in 2 of 3 jobs",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

/// Protects: a table explains the marks that it has, and no others.
#[test]
fn only_marks_that_occur_are_explained() {
    let complete = text(&page(&[row(7.0, 0.4, periodic(0.35)), row(9.0, 0.4, periodic(0.35))]));
    let partial = text(&page(&partial_study()));
    for words in
        ["the last part of the run", "no result yet", "the oscillation decays", "did not become periodic"]
    {
        assert!(!complete.contains(words) && partial.contains(words), "{words}");
    }
}

/// Protects: the cells and marks of a job lead to its inspection if the folder has one, with an address that no folder's
/// name can break out of. Other inspections and unreadable files are no error.
#[test]
fn jobs_lead_to_their_inspections() {
    let folder = tempfile::tempdir().unwrap();
    let add = |at: &str, summary: &str| {
        let inside = folder.path().join(at);
        fs::create_dir_all(&inside).unwrap();
        fs::write(inside.join("inspection.json"), summary).unwrap();
        fs::write(inside.join("index.html"), "").unwrap();
    };
    add("mu-0.4", r#"{ "job": {}, "key": "job-7-0.4" }"#);
    add("inspect/a \"><b>", r#"{ "key": "job-9-0.4" }"#);
    add("broken", "{");
    add("old", r#"{ "job": {} }"#);
    add("other", r#"{ "key": "of another study" }"#);
    let found: Vec<String> = inspections(folder.path()).into_iter().map(|found| found.job).collect();
    assert_eq!(found, ["job-9-0.4", "job-7-0.4", "of another study"]);

    let rows = [7.0, 9.0, 12.0].map(|omega| row(omega, 0.4, periodic(0.35)));
    write(&report(&rows), folder.path()).unwrap();
    let page = fs::read_to_string(folder.path().join("report.html")).unwrap();
    let links: Vec<&str> = page
        .split("<a href=\"")
        .skip(1)
        .filter(|link| link.split('"').next().is_some_and(|address| address.ends_with("/index.html")))
        .collect();
    assert_eq!(links.len(), 3 * 2, "two jobs in three tables: {links:?}");
    for address in ["mu-0.4/index.html", "inspect/a%20%22%3E%3Cb%3E/index.html"] {
        assert_eq!(links.iter().filter(|link| link.starts_with(&format!("{address}\""))).count(), 3);
    }
    for (job, address) in
        [("job-7-0.4", "mu-0.4/index.html"), ("job-9-0.4", "inspect/a%20%22%3E%3Cb%3E/index.html")]
    {
        let mark = format!("data-job=\"{job}\"");
        let with_page = format!("{mark} data-page=\"{address}\"");
        assert!(
            page.matches(&mark).count() > 5
                && page.matches(&mark).count() == page.matches(&with_page).count()
        );
    }
}
