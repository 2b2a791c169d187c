//! The legend of figures of the stability: one or two lines of text beside each sign.

use super::GREY;
use super::boundary;
use crate::publish::plot::canvas::{self, Area};
use crate::publish::plot::{DASH, DrawError, GUIDE_WIDTH, MARGIN, TEXT};
use crate::report::figure::marker;
use crate::report::stability::Verdict;
use plotters::prelude::{BLACK, Circle, PathElement, RGBColor, WHITE};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

/// Length of the line in an entry [px].
const SAMPLE: i32 = 56;
/// Largest distance of the lines of text [px].
const PITCH: i32 = 44;

/// An entry of a legend.
pub(in crate::report::figure) enum Sign {
    /// Words without a sign.
    Heading(&'static str),
    /// The line on which the leading growth rate is zero.
    ZeroLine,
    /// The mark of a job.
    Verdict(Verdict),
    /// A line of this colour and width.
    Line(RGBColor, u32, String),
    /// A dashed line.
    Dashes(&'static str),
    /// A filled square.
    Swatch(RGBColor, &'static str),
    /// A black dot, or a hollow grey one.
    Dot { is_hollow: bool, label: &'static str },
    /// An arrow away from the level of a value.
    Arrow { is_up: bool, label: &'static str },
}

impl Sign {
    /// The text in lines.
    fn lines(&self) -> Vec<&str> {
        match self {
            Self::ZeroLine => vec!["threshold: the leading", "growth rate is zero"],
            Self::Verdict(verdict) => verdict.lines().into(),
            Self::Line(_, _, label) => label.split('\n').collect(),
            Self::Heading(label)
            | Self::Dashes(label)
            | Self::Swatch(_, label)
            | Self::Dot { label, .. }
            | Self::Arrow { label, .. } => label.split('\n').collect(),
        }
    }
}

/// Draws entries below one another, starting at height `top` [px].
pub(in crate::report::figure) fn draw(area: &Area, top: i32, signs: &[Sign]) -> Result<(), DrawError> {
    let (width, height) = area.dim_in_pixel();
    let lines: i32 = signs.iter().map(|sign| sign.lines().len() as i32).sum();
    // Half a line between the entries.
    let halves = 2 * lines + signs.len() as i32;
    let pitch = (2 * (height as i32 - top - MARGIN / 2) / halves.max(1)).clamp(12, PITCH);
    let mut y = top + pitch / 2;
    for sign in signs {
        let text = sign.lines();
        let beside = if matches!(sign, Sign::Heading(_)) { 0 } else { SAMPLE + 16 };
        draw_sign(area, sign, y + (text.len() as i32 - 1) * pitch / 2)?;
        for line in text {
            let size = canvas::fitting_size(line.chars().count(), width as i32 - beside - 8);
            canvas::write(area, line, (beside, y), size.min(pitch * 4 / 5).min(TEXT - 2), HPos::Left)?;
            y += pitch;
        }
        y += pitch / 2;
    }
    Ok(())
}

fn draw_sign(area: &Area, sign: &Sign, y: i32) -> Result<(), DrawError> {
    let middle = (SAMPLE / 2, y);
    let line = |colour: RGBColor, width: u32| {
        area.draw(&PathElement::new([(0, y), (SAMPLE, y)], colour.stroke_width(width)))
    };
    match sign {
        Sign::Heading(_) => Ok(()),
        Sign::ZeroLine => line(BLACK, boundary::WIDTH),
        Sign::Verdict(verdict) => boundary::draw_mark(area, *verdict, middle, boundary::MARK),
        Sign::Line(colour, width, _) => line(*colour, *width),
        Sign::Dashes(_) => {
            for x in [0, SAMPLE - DASH] {
                area.draw(&PathElement::new([(x, y), (x + DASH, y)], BLACK.stroke_width(GUIDE_WIDTH)))?;
            }
            Ok(())
        }
        Sign::Swatch(colour, _) => canvas::fill_rectangle(area, (0, y - 16), (SAMPLE, y + 16), *colour),
        Sign::Dot { is_hollow, .. } => {
            draw_dot(area, middle, 8, if *is_hollow { GREY } else { BLACK }, *is_hollow)
        }
        Sign::Arrow { is_up, .. } => {
            let shift = if *is_up { 12 } else { -12 };
            marker::draw_outside(area, (middle.0, y + shift), *is_up, BLACK)
        }
    }
}

/// Draws a dot of a mode.
pub(super) fn draw_dot(
    area: &Area,
    at: (i32, i32),
    radius: i32,
    colour: RGBColor,
    is_hollow: bool,
) -> Result<(), DrawError> {
    area.draw(&Circle::new(at, radius, colour.filled()))?;
    if is_hollow { area.draw(&Circle::new(at, radius - 3, WHITE.filled())) } else { Ok(()) }
}
