//! The generated cases.

use crate::stress::corners::CORNERS;
use crate::stress::ending::{Ending, examine};
use crate::stress::simplify::simplest;
use crate::stress::{generator, summary};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::time::Instant;
use tribosweep_mechanics::spec::JobSpec;

/// Number of cases in the ordinary suite.
const CASES: u64 = 700;
/// Seed of the cases in the ordinary suite.
const SEED: u64 = 20_050_605;

/// A number from the environment, or else `default`.
fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| {
        text.parse().unwrap_or_else(|_| panic!("{name} = {text}: expected a whole number >= 0"))
    })
}

/// Describes a failing case and how to repeat it.
fn told(seed: u64, index: u64, spec: &JobSpec, wrong: &str) -> String {
    let job = |spec: &JobSpec| serde_json::to_string(spec).expect("a job is plain data");
    let simple = simplest(spec, |candidate| examine(candidate).is_err());
    let why = examine(&simple).err().unwrap_or_default();
    format!(
        "case {index} of seed {seed}: {wrong}\n  job: {}\n  simplest that fails, too: {}\n  because: {why}\n  repeat: \
         TRIBOSWEEP_STRESS_SEED={seed} TRIBOSWEEP_STRESS_ONLY={index} cargo test --release --test references every_case \
         -- --nocapture",
        job(spec),
        job(&simple)
    )
}

/// A line for the summary.
fn line(index: u64, ending: &Result<Ending, String>, wall_s: f64) -> Value {
    let ended = match ending {
        Ok(Ending::Result(closure)) => json!({
            "ending": "result",
            "outcome": closure.outcome,
            "steps": closure.steps,
            "imbalance_over_bound": closure.imbalance_over_bound,
            "residual": closure.residual,
            "bound_over_input": closure.bound_over_input,
            "sampled_residual": closure.sampled_residual,
            "highest_stored": closure.highest_stored,
            "highest_magnitude": closure.highest_magnitude,
        }),
        Ok(Ending::Refused { by, message }) => json!({ "ending": "refused", "by": by, "message": message }),
        Ok(Ending::Diverged { step, message }) => {
            json!({ "ending": "diverged", "step": step, "message": message })
        }
        Err(wrong) => json!({ "ending": "wrong", "message": wrong }),
    };
    json!({ "case": index, "wall_s": wall_s, "ended": ended })
}

/// Protects: a hostile scene ends in one of three ways. It has a result whose energies close within the
/// rounding of the run (`audited`) and whose record can be stored and read. Or it is refused before the first
/// step with an error that names the field. Or it is stopped with step and node. There is no panic, no
/// endless run, and no figure that is not a number.
#[test]
fn every_case_ends_as_it_may() {
    let seed = setting("TRIBOSWEEP_STRESS_SEED", SEED);
    let only = std::env::var("TRIBOSWEEP_STRESS_ONLY").is_ok();
    let indices = if only {
        let index = setting("TRIBOSWEEP_STRESS_ONLY", 0);
        index..index + 1
    } else {
        0..setting("TRIBOSWEEP_STRESS_CASES", CASES)
    };
    let ends: Vec<_> = indices
        .into_par_iter()
        .map(|index| {
            let spec = generator::job(seed, index);
            let begun = Instant::now();
            let ending = examine(&spec);
            (index, spec, ending, begun.elapsed().as_secs_f64())
        })
        .collect();
    summary::write("cases", &ends.iter().map(|(index, _, end, s)| line(*index, end, *s)).collect::<Vec<_>>());
    if only {
        for (index, spec, end, s) in &ends {
            println!("{}\n{}", serde_json::to_string_pretty(spec).unwrap(), line(*index, end, *s));
        }
    }
    let wrong: Vec<_> = ends
        .iter()
        .filter_map(|(index, spec, end, _)| end.as_ref().err().map(|why| told(seed, *index, spec, why)))
        .take(5)
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Protects: the test above covers enough. The cases of the ordinary suite reach every named corner, and most
/// of them are legal.
#[test]
fn the_cases_reach_every_corner() {
    let legal: Vec<_> =
        (0..CASES).map(|index| generator::job(SEED, index)).filter(|spec| spec.check().is_ok()).collect();
    assert!(legal.len() as u64 > CASES * 8 / 10, "{} of {CASES} cases are legal", legal.len());
    for (name, holds) in CORNERS {
        let count = legal.iter().filter(|spec| holds(spec)).count();
        assert!(count >= 3, "{name}: {count} of {} cases", legal.len());
    }
}
