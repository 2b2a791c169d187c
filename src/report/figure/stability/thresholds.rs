//! Thresholds: the friction coefficients at which modes begin to grow, over ω.

use super::GREY;
use super::boundary::{self, Sign};
use super::key::draw_dot;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart};
use crate::publish::plot::panel::Scale;
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{CURVE_WIDTH, DrawError, FONT, MARGIN, TEXT, palette};
use crate::publish::value;
use crate::report::figure::marker;
use crate::report::figure::panels::{self, SMALL, TITLE};
use crate::report::layout::{Group, Layout};
use crate::report::parameters::MU;
use crate::report::stability::{GroupModes, Onset, Speed};
use plotters::chart::ChartBuilder;
use plotters::prelude::{BLACK, PathElement, RGBColor};
use plotters::style::Color;

const LEGEND_WIDTH: u32 = 440;
/// Height of a panel among others [px].
const PANEL: u32 = 520;
const DOT: i32 = 9;
/// The line of the lowest threshold, below the dots.
const EMPHASIS: RGBColor = RGBColor(0xC4, 0xC4, 0xC4);
const EMPHASIS_WIDTH: u32 = 18;
/// Radius of the tooltip area around a dot [px].
const TOOLTIP_RADIUS: i32 = 16;

/// What all panels share.
struct Frame<'a> {
    layout: &'a Layout<'a>,
    x: Axis,
    y: Scale,
    is_alone: bool,
}

/// Draws a panel for each group, with the same axes.
pub(super) fn draw(layout: &Layout, groups: &[Group], modes: &[GroupModes]) -> Result<String, FigureError> {
    let speeds = || modes.iter().flat_map(|group| &group.speeds);
    let along = layout.dimension(layout.by);
    let ends = speeds().flat_map(|speed| speed.mus).map(|at| along.scaled(at));
    let label =
        if layout.by == MU { "threshold μ_c".to_owned() } else { format!("threshold: {}", along.title) };
    let frame = Frame {
        layout,
        x: layout.x_axis(),
        y: Scale::spanning(&label, ends, 0.02),
        is_alone: groups.len() == 1,
    };
    let columns = panels::columns(groups.len());
    let rows = groups.len().div_ceil(columns) as u32;
    let height = if frame.is_alone { canvas::HEIGHT } else { rows * (PANEL + TITLE) };
    let caption = if frame.is_alone { groups[0].caption() } else { String::new() };
    let height = height.max(canvas::HEIGHT * 2 / 3) + canvas::caption_height(&caption);
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &caption)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        let mut targets = Vec::new();
        let parts = left.split_evenly((rows as usize, columns));
        for ((group, modes), part) in groups.iter().zip(modes).zip(parts) {
            let area = if frame.is_alone {
                part
            } else {
                panels::title(&part, &group.caption(), part.dim_in_pixel().0 as i32 / 2 + 40)?
            };
            targets.extend(frame.fill(&area, modes)?);
        }
        boundary::draw_signs(&right, MARGIN, &signs(modes))?;
        Ok(targets)
    })
}

/// The colour of a family of modes.
fn colour(onset: &Onset, modes: &GroupModes) -> RGBColor {
    palette::colour(onset.family, modes.families.len())
}

impl Frame<'_> {
    fn fill(&self, area: &Area, modes: &GroupModes) -> Result<Vec<TooltipTarget>, DrawError> {
        let text = if self.is_alone { TEXT } else { SMALL };
        let (margin, x_labels, y_labels) = if self.is_alone { (MARGIN, 104, 150) } else { (12, 84, 120) };
        let mut chart = ChartBuilder::on(area)
            .margin(margin)
            .x_label_area_size(x_labels)
            .y_label_area_size(y_labels)
            .build_cartesian_2d(self.x.clone(), self.y.axis.clone())?;
        let mut mesh = canvas::mesh(&mut chart);
        mesh.x_label_style((FONT, text)).y_label_style((FONT, text)).axis_desc_style((FONT, text));
        mesh.x_desc(self.layout.axis_name()).y_desc(self.y.label.as_str()).draw()?;
        canvas::frame(&chart)?;
        let x = |speed: &Speed| self.layout.position(&self.x, &speed.omega);
        let along = self.layout.dimension(self.layout.by);
        let place = |onset: &Onset| along.scaled(onset.mu);
        let lowest = |speed: &Speed| speed.lowest().filter(|onset| onset.below.is_some()).map(place);
        join(&mut chart, modes, &x, lowest, EMPHASIS, EMPHASIS_WIDTH)?;
        for family in 0..modes.families.len() {
            let own = |speed: &Speed| {
                let mut own = speed.onsets.iter().filter(|onset| onset.family == family);
                own.find(|onset| onset.below.is_some()).map(place)
            };
            let colour = palette::colour(family, modes.families.len());
            join(&mut chart, modes, &x, own, colour, CURVE_WIDTH)?;
        }
        let mut targets = Vec::new();
        for speed in &modes.speeds {
            if let Some(x) = x(speed) {
                targets.extend(self.draw_speed(area, &chart, speed, modes, x)?);
            }
        }
        Ok(targets)
    }

    /// Draws the thresholds at one speed, and arrows where there is none between the points.
    fn draw_speed(
        &self,
        area: &Area,
        chart: &Chart,
        speed: &Speed,
        modes: &GroupModes,
        x: f64,
    ) -> Result<Vec<TooltipTarget>, DrawError> {
        let (left, top) = area.get_base_pixel();
        let along = self.layout.dimension(self.layout.by);
        let pixel = |at: f64| {
            let (x, y) = chart.backend_coord(&(x, along.scaled(at)));
            (x - left, y - top)
        };
        let is_lowest = |onset: &Onset| speed.lowest() == Some(onset);
        let mut targets = Vec::new();
        for onset in &speed.onsets {
            let at = pixel(onset.mu);
            if onset.below.is_none() {
                if is_lowest(onset) {
                    marker::draw_outside(area, at, false, BLACK)?;
                }
                continue;
            }
            let colour = if onset.is_converged { colour(onset, modes) } else { GREY };
            draw_dot(area, at, DOT + 3 * i32::from(is_lowest(onset)), colour, !onset.is_converged)?;
            let note = if onset.is_converged { "" } else { "\nnot converged" };
            targets.push(TooltipTarget {
                shape: Shape::Around { at: (at.0 + left, at.1 + top), radius: TOOLTIP_RADIUS },
                title: format!(
                    "{}\nthreshold: {}\n{}{note}",
                    self.layout.dimension(self.layout.axis).assignment(&speed.omega),
                    along.near(onset.mu),
                    value::quantity(onset.frequency_hz, "Hz")
                ),
                data: vec![
                    ("x", value::text(&speed.omega)),
                    ("y", value::number(onset.mu)),
                    ("frequency", value::number(onset.frequency_hz)),
                    ("family", onset.family.to_string()),
                ],
            });
        }
        // Where a mode ceases to grow, the dot is hollow.
        for (onset, end) in speed.onsets.iter().filter_map(|onset| Some((onset, onset.ends?))) {
            draw_dot(area, pixel(end.at), DOT, colour(onset, modes), true)?;
        }
        if speed.onsets.is_empty() && speed.mus[1].is_finite() {
            marker::draw_outside(area, pixel(speed.mus[1]), true, BLACK)?;
        }
        Ok(targets)
    }
}

/// Joins the thresholds that `of` chooses at neighbouring speeds. A speed without one interrupts the line.
fn join(
    chart: &mut Chart,
    modes: &GroupModes,
    x: &impl Fn(&Speed) -> Option<f64>,
    of: impl Fn(&Speed) -> Option<f64>,
    colour: RGBColor,
    width: u32,
) -> Result<(), DrawError> {
    let places: Vec<Option<(f64, f64)>> =
        modes.speeds.iter().map(|speed| Some((x(speed)?, of(speed)?))).collect();
    let lines: Vec<Vec<(f64, f64)>> = places
        .split(Option::is_none)
        .filter(|line| line.len() > 1)
        .map(|line| line.iter().flatten().copied().collect())
        .collect();
    chart.draw_series(lines.into_iter().map(|line| PathElement::new(line, colour.stroke_width(width))))?;
    Ok(())
}

/// The legend: what occurs. Several panels have families of their own, so that their colours are the order of the thresholds.
fn signs(modes: &[GroupModes]) -> Vec<Sign> {
    let speeds = || modes.iter().flat_map(|group| &group.speeds);
    let crossings = || speeds().flat_map(|speed| &speed.onsets).filter(|onset| onset.below.is_some());
    let mut signs = Vec::new();
    if crossings().next().is_some() {
        signs.push(Sign::Line(
            EMPHASIS,
            EMPHASIS_WIDTH,
            "first: steady sliding\nbecomes unstable".to_owned(),
        ));
    }
    if let [group] = modes {
        let occurs = |number: usize| crossings().any(|onset| onset.family == number);
        let own = group.families.iter().enumerate().filter(|(number, _)| occurs(*number));
        let lines = own.map(|(number, frequency_hz)| {
            let colour = palette::colour(number, group.families.len());
            Sign::Line(colour, CURVE_WIDTH, format!("mode at {}", value::quantity(*frequency_hz, "Hz")))
        });
        signs.extend(lines);
    } else if crossings().next().is_some() {
        signs.push(Sign::Heading("A colour is a mode, in each\npanel in the order of the\nthresholds."));
    }
    if crossings().any(|onset| !onset.is_converged) {
        signs.push(Sign::Dot { is_hollow: true, label: "not converged" });
    }
    if speeds().any(|speed| speed.lowest().is_some_and(|onset| onset.below.is_none())) {
        signs.push(Sign::Arrow { is_up: false, label: "unstable at the\nfirst point already" });
    }
    if speeds().flat_map(|speed| &speed.onsets).any(|onset| onset.ends.is_some()) {
        signs.push(Sign::Dot { is_hollow: true, label: "ceases to grow" });
    }
    if speeds().any(|speed| speed.onsets.is_empty()) {
        signs.push(Sign::Arrow { is_up: true, label: "no mode grows\nat any point" });
    }
    signs
}
