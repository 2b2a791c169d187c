//! The lock-in plot: frequencies of the modes over μ (or what is varied in its place) and, below them, their growth rates, at up to six speeds.

use super::GREY;
use super::boundary::{self, Sign};
use super::key::draw_dot;
use crate::publish::FigureError;
use crate::publish::plot::axis::Axis;
use crate::publish::plot::canvas::{self, Area, Chart};
use crate::publish::plot::panel::Scale;
use crate::publish::plot::tooltip::{Shape, TooltipTarget};
use crate::publish::plot::{CURVE_WIDTH, DASH, DrawError, FONT, GUIDE_WIDTH, MARGIN, palette};
use crate::publish::value;
use crate::report::figure::panels::{self, SMALL, TITLE};
use crate::report::layout::{Group, Layout};
use crate::report::stability::{GroupModes, Speed};
use plotters::chart::ChartBuilder;
use plotters::prelude::{BLACK, DashedLineSeries, PathElement, RGBColor};
use plotters::style::Color;

const LEGEND_WIDTH: u32 = 400;
const Y_LABELS: u32 = 130;
const X_LABELS: u32 = 84;
/// Largest number of speeds.
const MAX_SPEEDS: usize = 6;
/// Height of the frequencies and of the growth rates in a panel [px], alone and beside other panels.
const HEIGHTS: [(u32, u32); 2] = [(560, 480), (400, 380)];
const DOT: i32 = 6;
/// Width of the line of a mode that never grows [px].
const FINE: u32 = 2;
/// Radius of the tooltip area around a dot [px].
const TOOLTIP_RADIUS: i32 = 12;
/// Figures with more dots have no tooltips.
const MAX_TOOLTIPS: usize = 1_500;

/// What all panels share.
struct Frame<'a> {
    layout: &'a Layout<'a>,
    modes: &'a GroupModes,
    mu: Axis,
    frequency: Scale,
    /// Hertz per unit of the frequency axis.
    per_unit_hz: f64,
    growth: Scale,
}

/// Draws the panels of a group: of all speeds, or of some that are spread over them.
pub(super) fn draw(layout: &Layout, group: &Group, modes: &GroupModes) -> Result<String, FigureError> {
    let speeds = chosen(&modes.speeds);
    let points = || speeds.iter().flat_map(|speed| &speed.branches).flat_map(|branch| &branch.points);
    let largest_hz = points().map(|point| point.mode.frequency_hz).fold(0.0, f64::max);
    let (per_unit_hz, unit) = if largest_hz >= 1000.0 { (1000.0, "kHz") } else { (1.0, "Hz") };
    let frequencies = points().map(|point| point.mode.frequency_hz / per_unit_hz);
    let rates = points().map(|point| point.mode.growth_rate_per_s).chain([0.0]);
    let frame = Frame {
        layout,
        modes,
        mu: layout.dimension(layout.by).axis(false),
        frequency: Scale::spanning(
            &format!("frequency [{unit}]"),
            frequencies,
            0.02 * largest_hz / per_unit_hz,
        ),
        per_unit_hz,
        growth: Scale::spanning("growth rate [1/s]", rates, 1.0),
    };
    let caption = group.caption();
    let across = panels::columns(speeds.len()).min(3);
    let down = speeds.len().div_ceil(across).max(1) as u32;
    let (upper, lower) = HEIGHTS[usize::from(speeds.len() > 1)];
    let height = canvas::caption_height(&caption) + down * (TITLE + upper + lower) + MARGIN as u32;
    canvas::sheet((canvas::WIDTH, height), |root| {
        let below = canvas::caption(root, &caption)?;
        let (left, right) = below.split_horizontally(canvas::WIDTH - LEGEND_WIDTH);
        let (left, _) = left.split_vertically(down * (TITLE + upper + lower));
        let mut targets = Vec::new();
        for (speed, part) in speeds.iter().zip(left.split_evenly((down as usize, across))) {
            let axis = layout.dimension(layout.axis);
            // A speed that moves with what is varied is none.
            let words = if speed.omega.is_null() { String::new() } else { axis.assignment(&speed.omega) };
            let middle = (part.dim_in_pixel().0 as i32 + Y_LABELS as i32) / 2;
            let below = panels::title(&part, &words, middle)?;
            let (top, bottom) = below.split_vertically(upper);
            targets.extend(frame.fill(&top, speed, false)?);
            targets.extend(frame.fill(&bottom, speed, true)?);
        }
        boundary::draw_signs(&right, MARGIN, &frame.signs(&speeds))?;
        Ok(if targets.len() <= MAX_TOOLTIPS { targets } else { Vec::new() })
    })
}

/// Up to six speeds, the lowest and the highest among them.
fn chosen(speeds: &[Speed]) -> Vec<&Speed> {
    let count = speeds.len().min(MAX_SPEEDS);
    let at = |k: usize| k * (speeds.len() - 1) / (count - 1).max(1);
    (0..count).map(|k| &speeds[at(k)]).collect()
}

impl Frame<'_> {
    /// A place on the axis of the parameter along which modes are followed.
    fn x(&self, at: f64) -> f64 {
        self.layout.dimension(self.layout.by).scaled(at)
    }

    /// The colour and the width of a branch.
    fn look(&self, speed: &Speed, branch: usize) -> (RGBColor, u32) {
        match speed.onset_of(branch) {
            Some(onset) => (palette::colour(onset.family, self.modes.families.len()), CURVE_WIDTH),
            None => (GREY, FINE),
        }
    }

    /// Draws frequencies or growth rates between their axes.
    fn fill(&self, area: &Area, speed: &Speed, is_growth: bool) -> Result<Vec<TooltipTarget>, DrawError> {
        let scale = if is_growth { &self.growth } else { &self.frequency };
        let mut chart = ChartBuilder::on(area)
            .margin_right(24)
            .margin_left(8)
            .margin_bottom(if is_growth { 0 } else { 16 })
            .x_label_area_size(if is_growth { X_LABELS } else { 0 })
            .y_label_area_size(Y_LABELS)
            .build_cartesian_2d(self.mu.clone(), scale.axis.clone())?;
        let mut mesh = canvas::mesh(&mut chart);
        mesh.x_labels(5).x_label_style((FONT, SMALL)).y_label_style((FONT, SMALL));
        mesh.axis_desc_style((FONT, SMALL)).y_desc(scale.label.as_str());
        if is_growth {
            mesh.x_desc(self.layout.dimension(self.layout.by).title.as_str());
        }
        mesh.draw()?;
        canvas::whole_frame(&chart)?;
        if is_growth {
            let ends = chart.x_range();
            let ends = [(ends.start, 0.0), (ends.end, 0.0)];
            chart.draw_series(DashedLineSeries::new(ends, DASH, DASH, BLACK.stroke_width(GUIDE_WIDTH)))?;
        }
        for onset in speed.onsets.iter().filter(|onset| onset.below.is_some()) {
            let up = chart.y_range();
            let colour = palette::colour(onset.family, self.modes.families.len());
            let ends = onset.ends.map(|ends| ends.at);
            for at in [Some(onset.mu), ends].into_iter().flatten().map(|at| self.x(at)) {
                let line = PathElement::new([(at, up.start), (at, up.end)], colour.stroke_width(FINE));
                chart.draw_series([line])?;
            }
        }
        self.draw_branches(area, &mut chart, speed, is_growth)
    }

    fn draw_branches(
        &self,
        area: &Area,
        chart: &mut Chart,
        speed: &Speed,
        is_growth: bool,
    ) -> Result<Vec<TooltipTarget>, DrawError> {
        let (left, top) = area.get_base_pixel();
        let mut targets = Vec::new();
        // Modes that grow are drawn over the other ones.
        let mut order: Vec<usize> = (0..speed.branches.len()).collect();
        order.sort_by_key(|branch| speed.onset_of(*branch).is_some());
        for number in order {
            let branch = &speed.branches[number];
            let (colour, width) = self.look(speed, number);
            let place = |point: &crate::analysis::branches::BranchPoint| {
                let mode = &point.mode;
                let y = if is_growth { mode.growth_rate_per_s } else { mode.frequency_hz / self.per_unit_hz };
                (self.x(point.mu), y)
            };
            let line: Vec<(f64, f64)> = branch.points.iter().map(place).collect();
            chart.draw_series([PathElement::new(line, colour.stroke_width(width))])?;
            for point in &branch.points {
                let (x, y) = chart.backend_coord(&place(point));
                let mode = &point.mode;
                let colour = if mode.is_converged { colour } else { GREY };
                draw_dot(area, (x - left, y - top), DOT, colour, !mode.is_converged)?;
                let note = if mode.is_converged { "" } else { "\nnot converged" };
                targets.push(TooltipTarget {
                    shape: Shape::Around { at: (x, y), radius: TOOLTIP_RADIUS },
                    title: format!(
                        "{}\n{}, growth rate {} 1/s{note}",
                        self.layout.dimension(self.layout.by).near(point.mu),
                        value::quantity(mode.frequency_hz, "Hz"),
                        value::significant(mode.growth_rate_per_s, 3).replace('-', "−")
                    ),
                    data: vec![
                        ("branch", number.to_string()),
                        ("omega", value::text(&speed.omega)),
                        ("x", value::number(point.mu)),
                        ("frequency", value::number(mode.frequency_hz)),
                        ("growth", value::number(mode.growth_rate_per_s)),
                    ],
                });
            }
        }
        Ok(targets)
    }

    /// The legend: what occurs at these speeds.
    fn signs(&self, speeds: &[&Speed]) -> Vec<Sign> {
        let mut signs = Vec::new();
        let onsets = || speeds.iter().flat_map(|speed| &speed.onsets);
        let families = self.modes.families.iter().enumerate();
        let shown: Vec<_> = families.filter(|(n, _)| onsets().any(|onset| onset.family == *n)).collect();
        if !shown.is_empty() {
            signs.push(Sign::Heading("modes that grow,\nby frequency there"));
        }
        signs.extend(shown.into_iter().map(|(number, frequency_hz)| {
            let colour = palette::colour(number, self.modes.families.len());
            Sign::Line(colour, CURVE_WIDTH, value::quantity(*frequency_hz, "Hz"))
        }));
        if onsets().any(|onset| onset.below.is_some()) {
            signs.push(Sign::Heading("vertical: it begins or\nceases to grow"));
        }
        let decays = |speed: &&Speed| (0..speed.branches.len()).any(|n| speed.onset_of(n).is_none());
        if speeds.iter().any(decays) {
            signs.push(Sign::Line(GREY, FINE, "decays at every point".to_owned()));
        }
        let mut points = speeds.iter().flat_map(|speed| &speed.branches).flat_map(|branch| &branch.points);
        if points.any(|point| !point.mode.is_converged) {
            signs.push(Sign::Dot { is_hollow: true, label: "not converged" });
        }
        signs.push(Sign::Dashes("zero growth rate"));
        signs
    }
}
