//! Axes: ticks, their labels, and names.

use super::marks::Plot;
use super::measures::{TICK, tick_width, ticks_width, width_of};
use crate::publish::chart::palette::{GREY, GRID, INK};
use crate::publish::chart::svg::{Anchor, At, Pen, Svg};
use crate::publish::chart::{Axis, Panel, Scale};

/// What a panel shows of its axes, because its neighbours do not.
#[expect(clippy::struct_excessive_bools, reason = "each of both axes has ticks and a name, or not")]
#[derive(Debug, Clone, Copy)]
pub(super) struct Labels {
    pub x_ticks: bool,
    pub x_name: bool,
    pub y_ticks: bool,
    pub y_name: bool,
}

/// Draws both axes of a panel with their ticks, and a second ordinate. `is_alone` says that no panel stands beside it.
pub(super) fn draw(svg: &mut Svg, panel: &Panel, plot: Plot, labels: Labels, text: f64, is_alone: bool) {
    let Plot { from, to } = plot;
    let ticks: Vec<(f64, String)> = panel.x.labelled_ticks();
    let ticks: Vec<(f64, String)> =
        ticks.into_iter().map(|(at, label)| (plot.x(&panel.x.axis, at), label)).collect();
    let inside = ticks.iter().filter(|(x, _)| *x > from.0 - 0.1 && *x < to.0 + 0.1);
    let ticks: Vec<&(f64, String)> = inside.collect();
    let is_named = matches!(panel.x.axis, Axis::Names(_));
    for (x, _) in &ticks {
        if panel.x.has_grid && !is_named {
            svg.lines(&[(*x, from.1), (*x, to.1)], Pen::solid(GRID, 1.0));
        }
        svg.lines(&[(*x, to.1), (*x, to.1 + TICK)], Pen::solid(INK, 1.0));
    }
    // Names are written smaller where they are long; other labels are left out where there is no room for them.
    let pitch = (to.0 - from.0) / ticks.len().max(1) as f64;
    let longest = ticks.iter().map(|(_, label)| width_of(label, text)).fold(0.0, f64::max);
    let size = if is_named { (text * (pitch / longest.max(1.0)).min(1.0)).max(9.0) } else { text };
    let y = to.1 + TICK + 2.0 + text / 2.0;
    // A label may reach beyond the plot, but not to the neighbouring panel.
    let beyond = if is_alone { 22.0 } else { 12.0 };
    let fits = |(x, label): &&(f64, String)| {
        let half = tick_width(label, size) / 2.0;
        is_named || x - half > from.0 - beyond && x + half < to.0 + beyond
    };
    let ticks: Vec<&(f64, String)> = ticks.into_iter().filter(fits).collect();
    let mut shown = with_room(&ticks, size);
    if matches!(panel.x.axis, Axis::Log(_)) && panel.x.ticks.is_empty() && shown.len() < ticks.len() {
        // Whole decades are easier to read than what room is left for.
        let decades: Vec<_> = ticks.iter().copied().filter(|(_, label)| is_decade(label)).collect();
        shown = if decades.len() > 1 { with_room(&decades, size) } else { shown };
    }
    for (x, label) in shown.into_iter().filter(|_| labels.x_ticks) {
        svg.plain((*x, y), Anchor::Middle, INK, size, label);
    }
    if labels.x_name {
        let y = to.1 + 1.5 * text + 12.0;
        svg.plain(((from.0 + to.0) / 2.0, y), Anchor::Middle, INK, text, &panel.x.label);
    }
    draw_ordinate(svg, &panel.y, plot, text, labels, false);
    if let Some(right) = &panel.right {
        let all = Labels { y_ticks: true, y_name: true, ..labels };
        draw_ordinate(svg, right, plot, text, all, true);
    }
}

/// Whether a label is that of a power of ten.
fn is_decade(label: &str) -> bool {
    !label.contains('·') && label.chars().filter(char::is_ascii_digit).all(|c| matches!(c, '0' | '1'))
}

/// The labels that do not cover one another: from left to right, and in any case the last one.
fn with_room<'a>(ticks: &[&'a (f64, String)], size: f64) -> Vec<&'a (f64, String)> {
    let covers = |(a, left): &(f64, String), (b, right): &(f64, String)| {
        b - a < (tick_width(left, size) + tick_width(right, size)) / 2.0 + 4.0
    };
    let mut kept: Vec<&(f64, String)> = Vec::new();
    for (number, tick) in ticks.iter().enumerate() {
        let is_last = number + 1 == ticks.len();
        while is_last && kept.len() > 1 && kept.last().is_some_and(|last| covers(last, tick)) {
            kept.pop();
        }
        if kept.last().is_none_or(|last| !covers(last, tick)) {
            kept.push(tick);
        }
    }
    kept
}

fn draw_ordinate(svg: &mut Svg, scale: &Scale, plot: Plot, text: f64, labels: Labels, is_right: bool) {
    let Plot { from, to } = plot;
    let (edge, side, anchor) =
        if is_right { (to.0, 1.0, Anchor::Start) } else { (from.0, -1.0, Anchor::End) };
    let mut ticks: Vec<(f64, String)> = scale.labelled_ticks();
    let is_named = matches!(scale.axis, Axis::Names(_));
    // Zero is labelled in any case, because it says where the sign changes.
    ticks.sort_by_key(|(at, _)| *at != 0.0);
    let mut taken: Vec<f64> = Vec::new();
    for (at, label) in ticks {
        let y = plot.y(&scale.axis, at);
        if y < from.1 - 0.1 || y > to.1 + 0.1 {
            continue;
        }
        if scale.has_grid && !is_right && !is_named {
            let is_zero = at == 0.0 && matches!(scale.axis, Axis::Signed { .. });
            svg.lines(&[(from.0, y), (to.0, y)], Pen::solid(if is_zero { GREY } else { GRID }, 1.0));
        }
        svg.lines(&[(edge, y), (edge + side * TICK, y)], Pen::solid(INK, 1.0));
        if labels.y_ticks && taken.iter().all(|other| (y - other).abs() >= 0.9 * text) {
            svg.plain((edge + side * (TICK + 3.0), y), anchor, INK, text, &label);
            taken.push(y);
        }
    }
    if labels.y_name {
        let x = edge + side * (TICK + 9.0 + ticks_width(scale, text) + text / 2.0);
        upwards(svg, (x, (from.1 + to.1) / 2.0), to.1 - from.1 + 40.0, text, &scale.label);
    }
}

/// Writes a name upwards, smaller if it is longer than `room`.
pub(super) fn upwards(svg: &mut Svg, middle: At, room: f64, text: f64, name: &str) {
    svg.upwards(middle, text * (room / width_of(name, text)).min(1.0), name);
}
