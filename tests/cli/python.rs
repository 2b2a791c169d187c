//! The Python module: it calls the program, and its frames have what the program exports.

use std::path::Path;
use std::process::Command;

use crate::cli::support::Folder;
use crate::tools;

/// What the module promises, as Python's own assertions.
const CHECKS: &str = r#"
import json, math, os, subprocess, sys
import pandas
import tribosweep

program = tribosweep.program()
assert program == os.environ["TRIBOSWEEP_PROGRAM"], program
study = {
    "scene": {"pin": {"elements": [3, 4, 3]}, "clamp": {"width_m": 0.004}},
    "run": {"limit_s": 0.012},
    "grid": {"mu": [0.2, 0.4], "omega_rpm": [5, 20, 50]},
}
jobs = tribosweep.run(study, db="sweep.db", out="report", threads=1)
assert list(jobs["mu"]) == [0.2, 0.2, 0.2, 0.4, 0.4, 0.4], jobs
assert os.path.exists("report/report.html")
again = tribosweep.read("sweep.db", "study")
pandas.testing.assert_frame_equal(jobs, again)
exported = subprocess.run([program, "export", "study", "--all", "--db", "sweep.db"], capture_output=True, text=True).stdout
assert exported.splitlines()[0].split(",") == list(jobs.columns)

one = tribosweep.run(study, db="sweep.db", out="report", replace=True, settings={"mu": 0.4, "omega_rpm": [5, 20]})
assert len(one) == 2 and set(one["job"]) <= set(jobs["job"])

record = tribosweep.solve(study, mu=0.4, omega_rpm=20)
same = jobs[(jobs["mu"] == 0.4) & (jobs["omega_rpm"] == 20)].iloc[0]
assert math.isclose(record["mu_star"], same["mu_star"], rel_tol=1e-12), (record["mu_star"], same["mu_star"])

import warnings
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    soft = tribosweep.run({**study, "name": "soft"}, db="sweep.db", out="soft", settings={"mu": 0.4, "omega_rpm": 5, "load_n": 9000})
    tribosweep.solve(study, mu=0.4, omega_rpm=5, load_n=9000)
texts = [str(one.message) for one in said if one.category is tribosweep.InputWarning]
assert len(texts) == 2 and all("mean strain" in text for text in texts), texts
assert all(one.filename == "<string>" for one in said), [one.filename for one in said]
[text] = soft.attrs["warnings"]
assert "mean strain" in text and "\n  help: check the units" in text, text
assert jobs.attrs["warnings"] == [], jobs.attrs

for call, part, code in [
    (lambda: tribosweep.run({"grid": {"muu": [0.2]}}, db="sweep.db"), "did you mean `mu`?", 2),
    (lambda: tribosweep.run("missing.json", db="sweep.db"), "missing.json", 2),
    (lambda: tribosweep.read("missing.db", "study"), "missing.db", 2),
    (lambda: tribosweep.solve(study, mu=-1), "-1", 2),
]:
    try:
        call()
    except tribosweep.Error as error:
        assert part in str(error) and error.code == code, (error.code, str(error))
    else:
        raise AssertionError(part)
try:
    tribosweep.grid(jobs, ["mu_star"], over=["omega_rpm"])
except ValueError as error:
    assert "omega_rpm" in str(error)
else:
    raise AssertionError("two jobs at one place")
cube = tribosweep.grid(jobs, ["mu_star", "frequency_hz"])
assert cube["mu_star"].sel(mu=0.4, omega_rpm=20) == same["mu_star"]
assert dict(cube.sizes) == {"omega_rpm": 3, "mu": 2}, cube.sizes

import numpy
same_axis = tribosweep.run(study, db="sweep.db", out="report", replace=True, settings={"mu": numpy.float64(0.4), "omega_rpm": numpy.array([5, 20])})
assert list(same_axis["job"]) == list(one["job"])
assert tribosweep.validate({**study, "grid": {"mu": numpy.linspace(0.2, 0.4, 3)}})["jobs"] == 3

stored = tribosweep.solve(study, db="solved.db", mu=0.4, omega_rpm=20)
assert stored == record and tribosweep.solve(study, db="solved.db", mu=0.4, omega_rpm=20) == record
assert "<td>mu_star</td>" in record._repr_html_(), record._repr_html_()
[own] = json.loads(subprocess.run([program, "status", "--json", "--db", "solved.db"], capture_output=True, text=True).stdout)
assert own["jobs"]["total"] == 1, own
try:
    tribosweep.solve(study, db="solved.db", mu=0.4)
except tribosweep.Error as error:
    assert "the study has 3 jobs" in str(error) and error.code == 2
else:
    raise AssertionError("three jobs are one record")

motion = tribosweep.inspect(study, db="sweep.db", mu=0.4, omega_rpm=20, nodes=["centre"], fields=True)
totals, face, fields = motion["totals"], motion["face"], motion["fields"]
assert totals.attrs["job"] == same["job"] and totals.attrs["period_s"] > 0, totals.attrs
total_n = totals["normal_n"].sel(time_s=face["time_s"], method="nearest")
assert numpy.allclose(face["normal_n"].sum("node"), total_n, rtol=1e-9), "the forces of the face are the total"
assert list(motion["nodes"]["node"].values) == ["centre"] and motion["nodes"]["state"].dims == ("node", "time_s")
# The files have single precision.
force_n = fields["contact_force_n"].isel(component_3=2).sum("point")
total_n = totals["normal_n"].sel(time_s=fields["time_s"], method="nearest")
assert numpy.allclose(force_n, total_n, rtol=1e-5), (force_n, total_n)
height_m = fields["position_m"].isel(time_s=0, component_3=2)
assert int((height_m == height_m.min()).sum()) == face.sizes["node"]

tribosweep.run(study, db="sweep.db", out="report", replace=True)
indices = tribosweep.sensitivity("study", of=["mu_star"], db="sweep.db")
assert {"mu_star"} <= set(indices["quantity"]) and {"omega_rpm", "mu"} <= set(indices["parameter"]), indices
measured = pandas.DataFrame({"omega_rpm": [5.0, 20.0], "mu": 0.4, "mu_star": [2.0, 2.0], "mu_star_error": 0.01})
apart = tribosweep.compare("study", measured, sensitivity="study", db="sweep.db")
assert (apart["difference"] < -1).all() and len(apart) == 2, apart
assert "below data at all 2 points" in apart.attrs["verdict"][0], apart.attrs
assert any(words in apart.attrs["verdict"][0] for words in ("raises it", "by a tenth of that", "is not known")), apart.attrs

# Files that a dictionary names are relative to the working folder.
with open("mu.csv", "w") as table:
    table.write("0,0.5\n0.1,0.3\n")
with_table = {**study, "scene": {**study["scene"], "contact": {"law": "table", "mu_of_speed": "mu.csv"}}}
assert tribosweep.validate(with_table, settings={"mu": 0.3})["jobs"] == 3

# An interrupt of Python ends the program in order: what is done stays, and the same call goes on.
import signal, threading
# A shell starts what it puts into the background without this.
signal.signal(signal.SIGINT, signal.default_int_handler)
long = {**study, "name": "long", "run": {"limit_s": 0.5, "stop_early": False}, "grid": {"mu": [0.4], "omega_rpm": list(range(1, 100))}}
threading.Timer(2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    tribosweep.run(long, db="long.db", out="long", settings={"stability": "simulate"})
except tribosweep.Error as error:
    assert error.code == 3 and "interrupted" in str(error), (error.code, str(error))
else:
    raise AssertionError("99 long jobs were done in two seconds")

modes = tribosweep.stability(study, db="sweep.db", out="modes", modes=2)
assert len(modes) == 12 and set(modes["omega_rpm"]) == {5, 20, 50}, modes

pin = {**study, "name": "pin", "samples": {"design": "sobol", "count": 1, "of": {"mu": {"uniform": [0.3, 0.6]}}}}
del pin["grid"]
truth = jobs[jobs["mu"] == 0.4][["omega_rpm", "mu_star", "frequency_hz"]]
truth = truth.assign(mu_star_error=0.02 * truth["mu_star"], frequency_error_hz=0.02 * truth["frequency_hz"])
found = tribosweep.calibrate(pin, truth, db="sweep.db", out="pin", at={"mu": 0.4}, most_points=14)
low, high = found["region"]["mu"]
assert low <= 0.4 <= high and high - low < 0.2 and not found["at"]["ruled_out"], found
try:
    tribosweep.calibrate(pin, truth.drop(columns="mu_star_error"), db="sweep.db", out="pin")
except tribosweep.Error as error:
    assert "mu_star_error is missing" in str(error) and error.code == 2, str(error)
else:
    raise AssertionError("data without errors")
print("checked")
"#;

/// Protects: `run`, `read`, `solve` and `grid` return what the program computes, and what it refuses becomes an exception with its message
/// and its exit code.
#[test]
fn the_module_returns_what_the_program_computes() {
    let folder = Folder::new();
    let python = std::env::var("TRIBOSWEEP_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has_packages = Command::new(&python).args(["-c", "import pandas, xarray"]).output();
    if !has_packages.is_ok_and(|done| done.status.success()) {
        return tools::missing(
            "there is no Python with pandas and xarray",
            "install pandas and xarray, and set TRIBOSWEEP_PYTHON to a Python that has them",
        );
    }
    let module = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/python");
    let done = Command::new(&python)
        .args(["-c", CHECKS])
        .env("PYTHONPATH", module)
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("TRIBOSWEEP_PROGRAM", env!("CARGO_BIN_EXE_tribosweep"))
        .current_dir(folder.path("."))
        .output()
        .unwrap();
    let [out, errors] = [done.stdout, done.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(out.contains("checked"), "{out}{errors}");
}
