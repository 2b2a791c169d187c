//! A reader who follows a page in a folder that has the program, the studies and what the page needs.

use std::collections::BTreeMap;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;

use super::steps::{Step, steps, whole_study};
use crate::cli::support::{Folder, TRIBOSWEEP};
use crate::server::ServerDatabase;
use crate::tools;

/// The server in the pages.
const URL: &str = "postgres://me@dbhost/sweeps";

/// A stand-in for Slurm, where each task is run at once.
const SBATCH: &str = r#"#!/bin/bash
script=${*: -1}
case $script in
    *workers*)
        for i in 0 1; do
            SLURM_ARRAY_TASK_ID=$i SLURM_ARRAY_JOB_ID=11 SLURM_JOB_ID=11 SLURM_CPUS_PER_TASK=1 bash "$script" > "11_$i.log" 2>&1
        done
        echo 11 ;;
    *) SLURM_JOB_ID=12 bash "$script" > report-12.log 2>&1; echo 12 ;;
esac
"#;

/// The file of `solve --history` in the examples. It is the only table of the program that stands in the current folder.
const HISTORY: &str = "history.csv";

/// The files that a page wrote below folders, its history, and the first line of each that is a table in CSV.
pub type Written = BTreeMap<String, Option<String>>;

/// What a reader has.
pub struct Copy {
    /// The folder with the pages and the studies.
    pub root: PathBuf,
    program: PathBuf,
    /// The folder with the Python module; `None` if Python has it.
    module: Option<PathBuf>,
    /// Where the reader's shell looks for other programs.
    path: String,
}

impl Copy {
    /// The archive that `TRIBOSWEEP_ARCHIVE` names, unpacked, with the wheel in the Python of `TRIBOSWEEP_PYTHON`, in a system without a toolchain.
    /// Without that variable, the sources and what was built of them.
    pub fn of_reader() -> Self {
        if let Some(archive) = std::env::var_os("TRIBOSWEEP_ARCHIVE") {
            let root = PathBuf::from(archive);
            let path = "/usr/local/bin:/usr/bin:/bin".to_owned();
            return Self { program: root.join("tribosweep"), root, module: None, path };
        }
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let path = std::env::var("PATH").unwrap_or_default();
        Self { program: TRIBOSWEEP.into(), module: Some(root.join("src/python")), root, path }
    }
}

/// Follows a page. `None` where a server or Python is missing.
pub fn follow(copy: &Copy, name: &str, page: &str) -> Option<Written> {
    let folder = Folder::new();
    symlink(copy.root.join("studies"), folder.path("studies")).unwrap();
    symlink(copy.root.join("studies/pad.msh"), folder.path("pad.msh")).unwrap();
    folder.write("base.csv", &height_map());
    std::fs::create_dir(folder.path("bin")).unwrap();
    for (program, text) in [("sbatch", SBATCH), ("squeue", "#!/bin/sh\n"), ("scancel", "#!/bin/sh\n")] {
        folder.write(&format!("bin/{program}"), text);
        let executable = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(folder.path("bin").join(program), executable).unwrap();
    }
    let database = if page.contains(URL) { Some(ServerDatabase::new()?) } else { None };
    let url = database.as_ref().map_or_else(|| URL.to_owned(), ServerDatabase::url);
    let python = std::env::var("TRIBOSWEEP_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let all = steps(page);
    if all.iter().any(|step| matches!(step, Step::Python(_))) && !has_packages(&python) {
        tools::missing(
            "there is no Python with pandas, xarray and matplotlib",
            "install them, and set TRIBOSWEEP_PYTHON to a Python that has them",
        );
        return None;
    }

    let run = |program: &Path, arguments: [&str; 2]| {
        let programs = copy.program.parent().unwrap().display();
        let mut command = Command::new(program);
        command
            .args(arguments)
            .current_dir(folder.path("."))
            .env("PATH", format!("{}:{programs}:{}", folder.path("bin").display(), copy.path))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("MPLBACKEND", "agg")
            .env("TMPDIR", folder.path("bin"))
            .env_remove("TRIBOSWEEP_DB");
        if let Some(module) = &copy.module {
            command.env("PYTHONPATH", module).env("TRIBOSWEEP_PROGRAM", &copy.program);
        }
        let done = command.output().unwrap();
        let [out, errors] = [done.stdout, done.stderr].map(|text| String::from_utf8(text).unwrap());
        assert!(done.status.success(), "{name}: {}{out}{errors}", arguments[1]);
        out
    };
    let mut output = String::new();
    for step in all {
        match step {
            Step::Save(file, text) => folder.write(file, text),
            Step::Check(part) => {
                folder.write("part.json", &whole_study(part));
                run(&copy.program, ["validate", "part.json"]);
            }
            Step::Run(commands) => output = run(Path::new("bash"), ["-euc", &commands.replace(URL, &url)]),
            Step::Python(program) => output = run(Path::new(&python), ["-c", program]),
            Step::Compare(text) => {
                assert!(output.contains(text), "{name} shows\n{text}the program\n{output}");
            }
        }
    }
    let is_written = |file: &String| {
        let is_given = ["bin/", "studies/"].iter().any(|folder| file.starts_with(folder));
        file.contains('/') && !is_given || file == HISTORY
    };
    let header = |file: &String| {
        file.strip_suffix(".csv").map(|_| folder.read(file).lines().next().unwrap_or_default().to_owned())
    };
    let files = folder.files().into_iter().filter(is_written);
    let with_header = files.map(|file| {
        let first_line = header(&file);
        (file, first_line)
    });
    Some(with_header.collect())
}

fn has_packages(python: &str) -> bool {
    let done = Command::new(python).args(["-c", "import pandas, xarray, matplotlib"]).output();
    done.is_ok_and(|done| done.status.success())
}

/// Heights at a distance of 0.1 mm that cover the base of the reference pin, 12 × 15 mm: a crown of 1 µm.
fn height_map() -> String {
    let height = |i: i32, half: i32| 1e-6 * (1.0 - (f64::from(i - half) / f64::from(half)).powi(2));
    let line = |j: i32| {
        (0..=120).map(|i| format!("{:e}", height(i, 60) + height(j, 75))).collect::<Vec<_>>().join(",")
    };
    (0..=150).map(line).collect::<Vec<_>>().join("\n")
}
