//! `tribosweep diff`: what two studies have in common and what not.

use super::error::CliError;
use super::output::print;
use crate::exit;
use crate::publish::value;
use crate::queue::Location;
use crate::solver;
use crate::study::Job;
use crate::sweep::{self, Difference, InputDifference};
use serde_json::{Value, json};

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// The first study's name or file.
    a: String,
    /// The second study's name or file.
    b: String,
    /// Print JSON, with the keys of the jobs that only one of the studies has.
    #[arg(long)]
    json: bool,
}

/// Prints the inputs that differ and the numbers of jobs.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let (a, b) = sweep::block_on(async {
        let mut both = Vec::new();
        for study in [&args.a, &args.b] {
            both.push(sweep::load_study(study, db).await?.expand(solver::VERSION)?);
        }
        let b = both.pop().unwrap_or_default();
        Ok::<_, CliError>((both.pop().unwrap_or_default(), b))
    })?;
    let difference = Difference::between(&a, &b);
    print(&if args.json { as_json(args, &difference, [&a, &b]) } else { as_text(args, &difference) })?;
    Ok(exit::SUCCESS)
}

fn as_text(Args { a, b, .. }: &Args, difference: &Difference) -> String {
    let common = value::count(difference.common, "job");
    if difference.is_empty() {
        return format!("{a} and {b} have the same {common}\n");
    }
    let lines: Vec<String> =
        difference.inputs.iter().map(|input| format!("  {}\n", input.in_words())).collect();
    format!(
        "{a} → {b}\n{}  {common} in both, {} only in {a}, {} only in {b}\n",
        lines.concat(),
        difference.only_a.len(),
        difference.only_b.len()
    )
}

fn as_json(Args { a, b, .. }: &Args, difference: &Difference, jobs: [&[Job]; 2]) -> String {
    let inputs: Vec<Value> = difference
        .inputs
        .iter()
        .map(|InputDifference { parameter, a, b }| {
            json!({ "name": parameter.name, "unit": Some(parameter.unit).filter(|unit| !unit.is_empty()), "a": a, "b": b })
        })
        .collect();
    let json = json!({
        "a": { "study": a, "jobs": jobs[0].len() },
        "b": { "study": b, "jobs": jobs[1].len() },
        "inputs": inputs,
        "common": difference.common,
        "only_a": difference.only_a,
        "only_b": difference.only_b,
    });
    format!("{json}\n")
}
