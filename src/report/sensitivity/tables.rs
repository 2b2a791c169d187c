//! Indices as a text and as CSV.

use super::design::Design;
use super::types::{Index, Indices, REGIME, Sensitivity};
use crate::publish::value::{self, count};
use crate::report::Scalar;
use std::fmt::Write;

/// With fewer points, estimates say little.
const FEW_POINTS: usize = 100;

/// The indices as a text with tables.
pub fn markdown(found: &[Sensitivity]) -> String {
    let mut text = String::new();
    for one in found {
        let index = |index: &Option<Index>| {
            let text = |index: &Index| match index.interval {
                Some(interval) => {
                    let [low, high] = interval.map(|bound| value::fixed(bound, 2));
                    format!("{} ({low} … {high})", value::fixed(index.value, 2))
                }
                None => value::fixed(index.value, 3),
            };
            index.as_ref().map_or_else(|| value::MISSING.to_owned(), text)
        };
        let is_regime = one.of == REGIME;
        let title = Scalar::find(&one.of).map_or_else(|| one.of.clone(), Scalar::title);
        let _ = writeln!(text, "# {title}: {} points\n", one.points);
        let mut ranked: Vec<_> = one.parameters.iter().collect();
        let of = |index: &Option<Index>| index.as_ref().map_or(-1.0, |index| index.value);
        ranked.sort_by(|a, b| of(&b.pawn).total_cmp(&of(&a.pawn)).then(a.name.cmp(&b.name)));
        let is_morris = one.parameters.iter().any(|own| own.effects.is_some());
        let columns: &[&str] = match (&one.design, is_regime) {
            _ if is_morris => &["mean size of effects", "their deviation"],
            (Design::Unknown(_), _) => &[],
            (_, true) => &["shares"],
            (Design::Grid(_), false) => &["first order", "total", "PAWN"],
            (Design::Sample, false) => &["first order", "PAWN"],
        };
        if !columns.is_empty() {
            let _ = writeln!(text, "| parameter | {} |", columns.join(" | "));
            let _ = writeln!(text, "| --- |{}", " --- |".repeat(columns.len()));
        }
        for Indices { name, first_order, total, pawn, effects } in ranked {
            let cells = match (&one.design, is_regime) {
                _ if is_morris => {
                    let size = |(index, deviation): &(Index, f64)| {
                        let number = |number: f64| value::significant(number, 3);
                        let interval = index.interval.map(|bounds| bounds.map(number));
                        let interval =
                            interval.map(|[low, high]| format!(" ({low} … {high})")).unwrap_or_default();
                        vec![number(index.value) + &interval, number(*deviation)]
                    };
                    effects.as_ref().map_or_else(|| vec![value::MISSING.to_owned(); 2], size)
                }
                (Design::Unknown(_), _) => continue,
                (_, true) => vec![index(pawn)],
                (Design::Grid(_), false) => vec![index(first_order), index(total), index(pawn)],
                (Design::Sample, false) => vec![index(first_order), index(pawn)],
            };
            let _ = writeln!(text, "| `{name}` | {} |", cells.join(" | "));
        }
        if !columns.is_empty() {
            text += "\n";
        }
        let what = if is_regime { "shares" } else { "PAWN" };
        let _ = match &one.design {
            Design::Grid(sizes) => {
                let sizes = sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(" × ");
                writeln!(text, "Exact on this grid of {sizes} points, each of which counts the same.")
            }
            Design::Unknown(why) => writeln!(
                text,
                "No {what}{}: {why}.",
                if is_regime { "" } else { " and no first-order index" }
            ),
            Design::Sample => Ok(()),
        };
        if let Some(chance) = one.chance {
            let chance = value::fixed(chance, 2);
            let _ = writeln!(text, "A parameter without effect has {what} up to {chance} by chance.");
            if one.points < FEW_POINTS {
                let points = one.points;
                let _ = writeln!(
                    text,
                    "Only {points} points: the indices say little; give at least {FEW_POINTS}."
                );
            }
        }
        if one.missing > 0 {
            let _ = writeln!(
                text,
                "{} without a value here: no index says anything of these points.",
                count(one.missing as u64, "job")
            );
        }
        for remark in &one.remarks {
            let _ = writeln!(text, "{remark}");
        }
        text += "\n";
    }
    text
}

/// The indices as CSV: quantity, points, parameter, index, its value and its interval.
pub fn csv(found: &[Sensitivity]) -> String {
    let mut text = "quantity,points,parameter,index,value,low,high,by_chance\n".to_owned();
    for one in found {
        for Indices { name, first_order, total, pawn, effects } in &one.parameters {
            let last_name = if one.of == REGIME { "shares" } else { "pawn" };
            let sizes = effects.map(|(index, _)| index);
            let deviations = effects.map(|(_, deviation)| Index { value: deviation, interval: None });
            let all = [
                ("first_order", first_order),
                ("total", total),
                (last_name, pawn),
                ("effects_mean_size", &sizes),
                ("effects_deviation", &deviations),
            ];
            for (kind, index) in all {
                if let Some(Index { value, interval }) = index {
                    let chance = one.chance.filter(|_| kind == last_name);
                    let [low, high] = interval.map_or([None; 2], |bounds| bounds.map(Some));
                    let [low, high, chance] = [low, high, chance]
                        .map(|number| number.map(|number| number.to_string()).unwrap_or_default());
                    let Sensitivity { of, points, .. } = one;
                    let _ = writeln!(text, "{of},{points},{name},{kind},{value},{low},{high},{chance}");
                }
            }
        }
    }
    text
}
