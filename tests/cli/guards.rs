//! Nothing is replaced or lost unnoticed: studies of the same name, comparison, names, previews, and names in place of
//! files.

use serde_json::{Value, json};

use crate::cli::support::{Folder, rows, small, stderr};

/// A study of the name `mine` with this load.
fn mine(load_n: f64, grid: &Value) -> Value {
    let mut study = small(grid);
    study["name"] = json!("mine");
    study["scene"]["load"] = json!({ "force_n": load_n });
    study
}

/// Protects: a copied file whose name was forgotten does not replace the study: it is refused, with what would change, and
/// jobs, results and report stay. `--replace` replaces it, and says the same.
#[test]
fn a_forgotten_name_replaces_nothing() {
    let folder = Folder::with("mine", &mine(30.0, &json!({ "mu": [0.2, 0.4] })));
    folder.ok("run mine.json");
    let (export, page) = (folder.ok("export mine"), folder.read("reports/mine/report.md"));
    folder.add("copy", &mine(40.0, &json!({ "mu": [0.2, 0.3, 0.5, 0.6] })));
    let changes = "mine: the database has a study of this name; what changes:\n  \
                   mu: 0.2, 0.4 → 4 values, 0.2 to 0.6\n  \
                   load_n: 30 N → 40 N\n  \
                   0 jobs kept, 4 new, 2 dropped, 2 of them with results\n";
    for command in ["run", "submit"] {
        let message = stderr(&folder.command(&format!("{command} copy.json")).assert().code(2));
        assert!(message.starts_with(&format!("{changes}error: ")), "{message}");
        assert!(message.contains("--replace") && message.contains("--name NAME"), "{message}");
    }
    // Who asks before the run learns the same.
    for command in ["validate", "submit --dry-run"] {
        let message = stderr(&folder.command(&format!("{command} copy.json")).assert().code(2));
        assert!(message.contains(changes) && message.contains("--replace"), "{message}");
        let message = stderr(&folder.command(&format!("{command} copy.json --replace")).assert().code(0));
        assert!(message.contains(changes), "{message}");
    }
    assert_eq!(folder.ok("export mine"), export);
    assert_eq!(folder.read("reports/mine/report.md"), page);
    let replaced = stderr(&folder.command("submit copy.json --replace").assert().code(0));
    assert_eq!(replaced, format!("{changes}mine: 4 jobs, 4 new, 0 already done\n"));
    // The study that is there now has no results, so nothing is asked; its pending jobs are cancelled.
    let back = stderr(&folder.command("submit mine.json").assert().code(0));
    assert!(
        back.contains("2 new, 4 dropped, 0 of them with results; 4 pending jobs are cancelled\n"),
        "{back}"
    );
    assert!(back.ends_with("mine: 2 jobs, 0 new, 2 already done\n"), "{back}");
}

/// Protects: an extended grid and a study that is submitted again need no permission. Only an extension says what changes.
#[test]
fn extending_needs_no_permission() {
    let folder = Folder::with("mine", &mine(30.0, &json!({ "mu": [0.2] })));
    folder.ok("run mine.json");
    let again = stderr(&folder.command("submit mine.json").assert().code(0));
    assert_eq!(again, "mine: 1 job, 0 new, 1 already done\n");
    folder.add("mine", &mine(30.0, &json!({ "mu": [0.2, 0.4] })));
    let extended = stderr(&folder.command("submit mine.json").assert().code(0));
    assert!(extended.contains("\n  mu: 0.2 → 0.2, 0.4\n  1 job kept, 1 new, 0 dropped\n"), "{extended}");
    // The other shard has none of the jobs with results.
    let other = stderr(&folder.command("submit mine.json --shard 2/2").assert().code(2));
    assert!(other.contains("no input takes other values"), "{other}");
}

/// Protects: `diff` compares studies and files by their jobs, however they are written, as text and as JSON.
#[test]
fn studies_are_compared() {
    let folder = Folder::with("mine", &mine(30.0, &json!({ "mu": [0.2, 0.4], "omega_rpm": [5, 7] })));
    folder.ok("submit mine.json");
    let mut other = mine(30.0, &json!({ "load_n": [30], "omega_rpm": [5, 7] }));
    other["scene"]["contact"] = json!({ "mu": 0.4 });
    folder.add("other", &other);
    assert_eq!(
        folder.ok("diff mine other.json"),
        "mine → other.json\n  mu: 0.2, 0.4 → 0.4\n  2 jobs in both, 2 only in mine, 0 only in other.json\n"
    );
    let json: Value = serde_json::from_str(&folder.ok("diff mine other.json --json")).unwrap();
    assert_eq!(json["inputs"], json!([{ "name": "mu", "unit": null, "a": [0.2, 0.4], "b": [0.4] }]));
    assert_eq!((&json["common"], &json["only_b"]), (&json!(2), &json!([])));
    let export = rows(&folder.ok("export mine"));
    let only: Vec<_> =
        export.iter().filter(|row| row["mu"] == "0.2").map(|row| row["job"].as_str()).collect();
    assert_eq!(json["only_a"], json!(only));
    assert_eq!(folder.ok("diff mine mine.json"), "mine and mine.json have the same 4 jobs\n");
    let missing = stderr(&folder.command("diff mine nothing").assert().code(2));
    assert!(missing.contains("no study `nothing`"), "{missing}");
}

/// Protects: a study can be renamed, and its document agrees with its new name. A name that is taken or impossible is
/// refused.
#[test]
fn a_study_is_renamed() {
    let folder = Folder::with("mine", &mine(30.0, &json!({ "mu": [0.2] })));
    folder.add("plain", &small(&json!({ "mu": [0.4] })));
    folder.ok("run mine.json");
    folder.ok("submit plain.json");
    for (name, expected) in
        [("plain", "there is a study `plain` already"), ("a.b", "expected a name of letters")]
    {
        let message = stderr(&folder.command(&format!("rename mine {name}")).assert().code(2));
        assert!(message.contains(expected), "{message}");
    }
    let text = folder.read("mine.json");
    let renamed = stderr(&folder.command("rename mine other").assert().code(0));
    assert!(renamed.contains("its report stays in the folder"), "{renamed}");
    assert_eq!(folder.ok("document other"), text.replace("\"mine\"", "\"other\""));
    assert_eq!(folder.counts("other")["done"], 1);
    folder.command("status mine").assert().code(2);
    // A document without a name has that of the study.
    folder.ok("rename plain.json simple");
    folder.write("simple.json", &folder.ok("document simple"));
    let again = stderr(&folder.command("submit simple.json").assert().code(0));
    assert_eq!(again, "simple: 1 job, 0 new, 0 already done\n");
}

/// Protects: `--dry-run` of `rm` and `gc` says what they remove, and changes nothing.
#[test]
fn removals_can_be_tried() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2, 0.4] })));
    folder.add("other", &small(&json!({ "mu": [0.4] })));
    folder.ok("run mine.json");
    folder.ok("submit other.json");
    let what = "2 rows of 2 jobs (results that no study has any more: 1; results that other studies have too: 1; pending jobs \
                cancelled: 0)";
    assert_eq!(
        folder.ok("rm mine --dry-run"),
        format!("mine: `rm` would remove {what}; nothing has been changed\n")
    );
    assert_eq!(folder.counts("mine")["done"], 2);
    let removed = stderr(&folder.command("rm mine").assert().code(0));
    assert!(removed.starts_with(&format!("mine: removed {what}; results stay")), "{removed}");
    let preview = folder.ok("gc --dry-run");
    assert!(preview.starts_with("`gc` would drop 1 job, 1 result and 1 ended worker, with 0.0"), "{preview}");
    assert!(preview.ends_with(" MB of data; nothing has been changed\n"), "{preview}");
    assert_eq!(folder.ok("gc --dry-run"), preview);
    let collected = folder.ok("gc");
    assert!(
        collected.starts_with("dropped 1 job, 1 result and 1 ended worker; the database is "),
        "{collected}"
    );
}

/// Protects: who gives the name of a study where a file is expected learns what to do.
#[test]
fn a_name_is_no_file() {
    let folder = Folder::with("mine", &small(&json!({ "mu": [0.2] })));
    for command in ["run", "submit", "validate", "solve", "slurm --workers 1"] {
        let message = stderr(&folder.command(&format!("{command} mine")).assert().code(2));
        assert!(
            message.contains("mine: cannot be read") && message.contains("did you mean mine.json?"),
            "{message}"
        );
        let message = stderr(&folder.command(&format!("{command} nothing")).assert().code(2));
        assert!(message.contains("help: expected the path of a study file"), "{message}");
    }
    assert_eq!(folder.files(), ["mine.json"], "no database is created");
    folder.ok("submit mine.json");
    std::fs::remove_file(folder.path("mine.json")).unwrap();
    for file in ["mine", "mine.json"] {
        let message = stderr(&folder.command(&format!("run {file}")).assert().code(2));
        assert!(
            message.contains("the database tribosweep.db has a study mine: `tribosweep work`"),
            "{message}"
        );
    }
    folder.write("mine.json", &folder.ok("document mine"));
    folder.ok("run mine.json");
}
