//! Studies as people write them: with comments, from standard input, and with doubtful inputs.

use serde_json::{Value, json};

use crate::cli::support::{Folder, rows, small, stderr, stdout};

const COMMENTED: &str = r#"// A coarse pin.
{
  "$schema": "study.schema.json",
  "name": "mine",
  "scene": { "pin": { "elements": [3, 4, 3] }, "clamp": { "width_m": 0.004 }, }, /* one element */
  "run": { "limit_s": 0.012 },
  "grid": { "mu": [0.2, 0.4,] },
}
"#;

/// Protects: a study with comments goes through every command that reads what the database stores, and is stored as written.
#[test]
fn a_study_with_comments_is_stored_and_read() {
    let folder = Folder::new();
    folder.write("mine.json", COMMENTED);
    folder.ok("run mine.json --threads 1");
    let job = rows(&folder.ok("export mine"))[0]["job"].clone();
    let shown: Value = serde_json::from_str(&folder.ok(&format!("show {job} --json"))).unwrap();
    assert_eq!(shown["studies"][0]["document"]["grid"], json!({ "mu": [0.2, 0.4] }));
    folder.ok("report mine --out again");
    assert!(folder.read("again/report.html").contains("// A coarse pin."));
    folder.ok("--db other.db merge tribosweep.db");
    assert_eq!(folder.ok("--db other.db document mine"), COMMENTED);
    assert_eq!(folder.ok("--db other.db diff mine mine.json"), "mine and mine.json have the same 2 jobs\n");
    folder.ok("rename mine yours");
    assert_eq!(folder.ok("document yours"), COMMENTED.replace("\"mine\"", "\"yours\""));
}

/// Protects: `-` is standard input for every command that takes a study file. Errors name it, and a study without a name
/// is refused.
#[test]
fn a_study_comes_from_standard_input() {
    let folder = Folder::new();
    let from_stdin = |arguments: &str, text: &str| folder.command(arguments).write_stdin(text).assert();
    let mut study = small(&json!({ "mu": [0.2, 0.4] }));
    let nameless = stderr(&from_stdin("validate -", &study.to_string()).code(2));
    assert!(nameless.contains("<stdin>: name: ") && nameless.contains("add \"name\""), "{nameless}");
    study["name"] = json!("piped");
    let study = study.to_string();
    assert!(stdout(&from_stdin("validate -", &study).code(0)).contains("valid, 2 jobs"));
    from_stdin("submit -", &study).code(0);
    let solved = stdout(&from_stdin("solve - --set mu=0.4 --json", &study).code(0));
    assert!(serde_json::from_str::<Value>(&solved).unwrap()["mu_star"].is_f64());
    from_stdin("run - --threads 1", &study).code(0);
    assert_eq!(folder.counts("piped")["done"], 2);
    let broken = stderr(&from_stdin("run -", "{\n  \"name\" 1 }").code(2));
    assert!(broken.contains("<stdin>:2:10: not valid JSON: expected colon"), "{broken}");
}

/// Protects: the workers of a job array find the study that came from standard input.
#[cfg(unix)]
#[test]
fn a_job_array_keeps_the_study_from_standard_input() {
    let folder = Folder::new();
    folder.command("slurm - --workers 2").write_stdin(COMMENTED).assert().code(0);
    assert_eq!(folder.read("mine.slurm/study.json"), COMMENTED);
    let workers = folder.read("mine.slurm/workers.sbatch");
    let study = folder.path("mine.slurm/study.json");
    assert!(workers.contains(&format!("study={}", study.display())), "{workers}");
}

/// Protects: doubtful inputs are said by every command that begins with a study, on standard error, and on both pages of the
/// report; they stop nothing. Studies without doubts have no warning.
#[test]
fn doubtful_inputs_are_said_and_stop_nothing() {
    let folder = Folder::with("sound", &small(&json!({ "mu": [0.2] })));
    let mut study = small(&json!({ "omega_rpm": [10, 20], "load_n": [3000, 6000] }));
    study["scene"]["contact"] = json!({ "mu": 0.2 });
    folder.add("wrong", &study);
    let lines = |command: &str| -> Vec<String> {
        let said = stderr(&folder.command(command).assert().code(0));
        let is_said = |line: &&str| line.starts_with("warning: ") || line.starts_with("note: ");
        said.lines().filter(is_said).map(str::to_owned).collect()
    };
    for command in ["validate", "submit", "run --threads 1"] {
        let (sound, wrong) =
            (lines(&format!("{command} sound.json")), lines(&format!("{command} wrong.json")));
        assert_eq!(sound, [""; 0], "{command}");
        assert_eq!(wrong.len(), 2, "{command}: {wrong:?}");
        assert!(wrong[0].starts_with("warning: wrong.json:1:"), "{command}: {wrong:?}");
        assert!(
            wrong[0].contains("scene.load.force_n = 6000.0: the mean strain F/(E A) of the pin is 3.33 %"),
            "{wrong:?}"
        );
        // This changes no result.
        assert!(
            wrong[1].starts_with("note: ") && wrong[1].contains("1 of 4 jobs repeat others"),
            "{wrong:?}"
        );
    }
    assert_eq!(lines("solve wrong.json --set omega_rpm=10 --set load_n=3000").len(), 1);
    for page in ["report.html", "report.md"] {
        let text = folder.read(format!("reports/wrong/{page}"));
        for part in ["Check these inputs", "mean strain", "1 of 4 jobs repeat others"] {
            assert!(text.contains(part), "{page}: {part}");
        }
        assert!(!folder.read(format!("reports/sound/{page}")).contains("Check these inputs"), "{page}");
    }
}
