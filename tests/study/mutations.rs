//! Protects: no text makes the parser panic, hang, or accept an unusable job. The fuzz targets in tests/fuzz try
//! millions of texts with a nightly compiler; these few thousand find most mistakes without one.

#[path = "../fuzz/checks.rs"]
mod checks;

use crate::random::Random;
use checks::{Fate, check_overrides, check_study};
use std::path::Path;
use tribosweep::study::Study;

/// Mutants of each seed.
const MUTANTS: usize = 400;

/// Pieces of the mutants, besides pieces of the seeds.
const PIECES: [&str; 27] = [
    "null",
    "true",
    "0",
    "-0.0",
    "1e308",
    "5e-324",
    "1e400",
    "\"\"",
    "[]",
    "{}",
    "[[1,1,1]]",
    "\\u0075",
    "\"mu\":",
    "é",
    "\"grid\":",
    "\"elements\"",
    "\"count\": 3",
    "\"step\": 1",
    "// é\n",
    "/* , */",
    "\"spacing\": \"log\"",
    ",",
    ":",
    "}",
    "]",
    "\"",
    "12x15x10",
];

fn seeds(target: &str) -> Vec<String> {
    let folder = Path::new("tests/fuzz/seeds").join(target);
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.iter().map(|path| std::fs::read_to_string(path).unwrap()).collect()
}

/// Random changes of texts.
struct Choices(Random);

impl Choices {
    fn below(&mut self, end: usize) -> usize {
        self.0.below(end)
    }

    /// A place in `text` between two characters.
    fn place(&mut self, text: &str) -> usize {
        let mut at = self.below(text.len() + 1);
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    }

    /// `text` with one to four pieces taken out, put in or replaced.
    fn mutant(&mut self, text: &str, others: &[String]) -> String {
        let mut text = text.to_owned();
        for _ in 0..=self.below(4) {
            let (a, b) = (self.place(&text), self.place(&text));
            let (from, to) = (a.min(b), a.max(b));
            let to = if self.below(2) == 0 { from } else { to.min(text.ceil_char_boundary(from + 12)) };
            let piece = if self.below(3) == 0 {
                let other = &others[self.below(others.len())];
                let (a, b) = (self.place(other), self.place(other));
                other[a.min(b)..a.max(b)].to_owned()
            } else {
                PIECES[self.below(PIECES.len())].to_owned()
            };
            text.replace_range(from..to, &piece);
        }
        text
    }
}

#[test]
fn mutated_studies_are_accepted_or_refused() {
    let seeds = seeds("study");
    let mut choices = Choices(Random::new(1));
    let mut fates = [0; 3];
    for seed in &seeds {
        for _ in 0..MUTANTS {
            fates[check_study(&choices.mutant(seed, &seeds)) as usize] += 1;
        }
    }
    // Both outcomes are frequent.
    let enough = seeds.len() * MUTANTS / 50;
    assert!(fates[Fate::Accepted as usize] > enough && fates[Fate::Refused as usize] > enough, "{fates:?}");
}

#[test]
fn mutated_overrides_are_accepted_or_refused() {
    let study = Study::parse(r#"{ "name": "x", "grid": { "mu": [0.2, 0.4] } }"#, "x.json").unwrap();
    let seeds = seeds("overrides");
    let mut choices = Choices(Random::new(2));
    let mut fates = [0; 3];
    for seed in &seeds {
        for _ in 0..MUTANTS {
            fates[check_overrides(&study, &choices.mutant(seed, &seeds)) as usize] += 1;
        }
    }
    let enough = seeds.len() * MUTANTS / 50;
    assert!(fates[Fate::Accepted as usize] > enough && fates[Fate::Refused as usize] > enough, "{fates:?}");
}

/// Protects: the memory for the positions of fields grows with the text and not with its square, which would be 40 GB
/// for this long key above many values.
#[test]
fn a_long_key_over_many_values_is_refused() {
    let key = "k".repeat(200_000);
    let values = "0,".repeat(200_000);
    let text = format!("{{ \"{key}\": {{ \"a\": 1, \"a\": 2, \"b\": [{values}0] }} }}");
    assert_eq!(check_study(&text), Fate::Refused);
}

/// Protects: a grid that is far too large is refused before its values are read, which would take minutes.
#[test]
fn a_grid_of_many_long_axes_is_refused_at_once() {
    let axis = |name: &str| format!("\"{name}\": {{ \"from\": 1, \"to\": 2, \"count\": 1000000 }}");
    let names =
        ["mu", "omega_rpm", "load_n", "ramp_s", "young_modulus_pa", "density_kg_m3", "beta_r_s", "limit_s"];
    let text = format!("{{ \"name\": \"x\", \"grid\": {{ {} }} }}", names.map(axis).join(", "));
    let error = Study::parse(&text, "x.json").unwrap_err().to_string();
    assert!(error.contains("mu 1000000 × omega_rpm 1000000") && error.contains("at most 1000000"), "{error}");
    let text = text.replace("\"count\": 1000000", "\"step\": 0.000002");
    let error = Study::parse(&text, "x.json").unwrap_err().to_string();
    assert!(error.contains("mu 500001 × omega_rpm 500001"), "{error}");
}
