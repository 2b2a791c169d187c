//! `report` with several studies and with measured points, and with other axes.

use serde_json::json;

use crate::cli::support::{Folder, rows, small, stderr};

/// Protects: two studies and measured points are in one report, with the differences, in a folder of their names; inputs that
/// differ are said. The report of one study with its own axes stays as it is.
#[test]
fn studies_and_measured_points_are_in_one_report() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.2], "omega_rpm": [2, 20] })));
    let mut second = small(&json!({ "mu": [0.2], "omega_rpm": [2, 40] }));
    second["scene"]["load"] = json!({ "force_n": 50.0 });
    second["report"] = json!({ "y": ["n_over_f_max"] });
    folder.add("second", &second);
    folder
        .write("rig.csv", "# a made-up rig\nomega_rpm,mu_star,mu_star_error\n2,0.19,0.01\n10,0.18,0.01\n\n");
    folder.ok("run first.json");
    folder.ok("run second.json");
    assert!(folder.path("reports/second/n_over_f_max.svg").is_file());

    let printed = folder.ok("report first second --data rig.csv");
    assert_eq!(printed.trim_end().replace('\\', "/"), "reports/first-vs-second-vs-rig/report.html");
    let read = |file: &str| folder.read(format!("reports/first-vs-second-vs-rig/{file}"));
    let differences = rows(&read("differences.csv"));
    let of = |source: &str| {
        let found =
            differences.iter().filter(|line| line["source"] == source && line["quantity"] == "mu_star");
        found.map(|line| (line["omega_rpm"].as_str(), line["interpolated"].as_str())).collect::<Vec<_>>()
    };
    assert_eq!(of("second"), [("2", "no")]);
    assert_eq!(of("rig"), [("2", "no"), ("10", "yes")]);
    let page = read("report.md");
    assert!(page.starts_with("# first vs second vs rig\n"), "{page}");
    for part in ["load_n: 30 N → 50 N", "1 of the 2 jobs of first have no counterpart in second"] {
        assert!(page.contains(part), "{part} in {page}");
    }
    folder.ok("report first --data rig.csv --out mine");
    assert_eq!(rows(&folder.read("mine/differences.csv")).len(), 2);
}

/// Protects: who compares a study with points of which none matches a job reads so on the terminal, and not on the page alone. One point that
/// matches is enough to say nothing.
#[test]
fn points_without_a_counterpart_are_said_at_once() {
    let folder = Folder::with("first", &small(&json!({ "mu": [0.2], "omega_rpm": [2, 20] })));
    folder.ok("run first.json");
    for (points, is_said) in [("50,0.2,0.19\n70,0.2,0.18\n", true), ("50,0.2,0.19\n2,0.2,0.18\n", false)] {
        folder.write("rig.csv", &format!("omega_rpm,mu,mu_star\n{points}"));
        let messages = stderr(&folder.command("report first --data rig.csv").assert().code(0));
        let warning = "warning: no point of rig is at the parameters of a job of first";
        assert_eq!(messages.contains(warning), is_said, "{messages}");
    }
}

/// Protects: a file of measured points that is not there is what the command complains about, even if there is no database either.
#[test]
fn a_missing_file_is_named_first() {
    let folder = Folder::new();
    let run = folder.command("report mine --data missing.csv").assert().code(2);
    assert!(stderr(&run).contains("missing.csv: cannot be read"), "{}", stderr(&run));
    assert_eq!(folder.files(), [""; 0]);
}

/// Protects: axes are those of the command line, then those of the study, and an unknown name or file is refused with advice.
#[test]
fn axes_are_those_that_were_asked_for() {
    let mut study = small(&json!({ "mu": [0.2, 0.3], "omega_rpm": [2, 20] }));
    study["report"] = json!({ "x": "mu", "by": "omega_rpm" });
    let folder = Folder::with("mine", &study);
    folder.write("bad.csv", "omega_rpm,mu_star\n2,0,19\n");
    folder.ok("run mine.json");
    let header = |folder: &Folder| {
        folder.read("reports/mine/mu_star.csv").lines().next().unwrap_or_default().to_owned()
    };
    assert_eq!(header(&folder), "mu,omega_rpm=2,omega_rpm=20");
    folder.ok("report mine --x omega_rpm --by mu");
    assert_eq!(header(&folder), "omega_rpm,mu=0.2,mu=0.3");
    for (arguments, expected) in [
        ("report mine --x omega", "--x omega: no such name; did you mean `omega_rpm`?"),
        ("report mine --by source", "--by source: no such name"),
        ("report mine --x mu --by mu", "--by mu: expected another parameter"),
        ("report mine --y mu_stra", "--y mu_stra: no such quantity; did you mean `mu_star`?"),
        ("report mine --y omega_rpm", "--y omega_rpm: this is a parameter; expected a result"),
        ("report mine --y regime", "--y regime: is no number"),
        ("report mine --y load_n", "--y load_n: this is a parameter; expected a result"),
        ("report mine --x mu_star", "--x mu_star: this is a result; expected a parameter"),
        ("report mine --by beta2", "--by beta2: does not vary between these jobs"),
        ("report mine mine", "mine is given twice"),
        ("report mine --data none.csv", "none.csv: cannot be read"),
        ("report mine --data bad.csv", "bad.csv:2: expected 2 cells as in the header; found 3"),
    ] {
        let refused = folder.command(arguments).assert().code(2);
        assert!(stderr(&refused).contains(expected), "{arguments}: {}", stderr(&refused));
    }
    study["report"] = json!({ "y": ["stick_shar"] });
    folder.add("wrong", &study);
    let refused = folder.command("validate wrong.json").assert().code(2);
    assert!(
        stderr(&refused).contains("report.y[0] = \"stick_shar\": no such quantity"),
        "{}",
        stderr(&refused)
    );
    assert!(stderr(&refused).contains("did you mean `stick_share`?"), "{}", stderr(&refused));
}
