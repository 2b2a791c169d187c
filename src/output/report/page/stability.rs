//! The section on linear stability.

use crate::publish::page::{Block, Figure, Grid, MOST_DATA, Section, limited};
use crate::publish::value;
use crate::report::figure::stability::StabilityPlot;
use crate::report::layout::{Group, MAX_GROUPS, MAX_SHEETS};
use crate::report::stability::{
    Analysis, Files, GroupModes, ShownModes, Speed, above_band, small_contact, unknown_errors,
};

/// What the section is about.
const MEANING: [&str; 3] = [
    "The figures show the linear stability of steady sliding. Small vibrations about steady sliding are complex modes. Each mode \
     has a frequency and a growth rate: the imaginary part of its eigenvalue over 2π, and the real part.",
    "If a growth rate is positive, the vibration grows, and steady sliding is unstable. A threshold is a value of the parameter \
     that is varied, usually μ, at which this begins or ends. With friction that falls with the speed, sliding can be unstable \
     below a threshold and stable above it.",
    "The eigenvalues say nothing about the size that the vibration reaches. A limit cycle can also exist below the threshold, \
     because stable sliding and a stick–slip cycle exist side by side; the start of a run decides which of them it reaches.",
];

fn caption(plot: StabilityPlot) -> &'static str {
    match plot {
        StabilityPlot::Map => {
            "Growth rate of the leading mode, which grows fastest or decays slowest. Blue: it decays. Orange: it grows. A \
             line is a threshold, interpolated between the points."
        }
        StabilityPlot::LockIn => {
            "Frequencies of the modes over the parameter that is varied and, below them, their growth rates. Where two \
             frequencies meet and the growth rates part, two modes lock in. At most six speeds are shown."
        }
        StabilityPlot::Thresholds => {
            "Thresholds: where the growth rate of a mode becomes positive (filled) or negative again (hollow). Steady sliding is \
             unstable where at least one mode grows; the table has these ranges."
        }
    }
}

/// The lowest threshold in a sentence, or at how many points of no series a mode grows; none if no mode grows in a series, or if there
/// are no points.
pub(super) fn found(analysis: &Analysis) -> Option<String> {
    if !analysis.has_series() && !analysis.points().is_empty() {
        let [unstable, points] = [analysis.unstable_points(), analysis.points().len()];
        return Some(format!(
            "Steady sliding is unstable at {unstable} of {}.",
            value::count(points, "point")
        ));
    }
    let speeds = analysis.groups.iter().flat_map(|modes| &modes.speeds);
    let onsets = speeds.filter_map(|speed| Some((speed.lowest()?, speed)));
    let (onset, speed) = onsets.min_by(|a, b| a.0.mu.total_cmp(&b.0.mu))?;
    let [along, across] =
        [analysis.layout.by, analysis.layout.axis].map(|name| analysis.layout.dimension(name));
    let place = across.assignment(&speed.omega);
    let frequency = value::quantity(onset.frequency_hz, "Hz");
    Some(match onset.below {
        Some(_) => format!(
            "Steady sliding is unstable from {} (lowest threshold, at {place}); the mode has {frequency}.",
            along.near(onset.mu)
        ),
        None => format!(
            "Steady sliding is unstable at {} already, below which nothing is known (at {place}); the mode has {frequency}.",
            along.near(onset.mu)
        ),
    })
}

/// The section of a page.
pub(super) fn section(analysis: &Analysis, files: &Files) -> Section {
    let mut blocks: Vec<Block> = Vec::new();
    let further = [
        analysis.along_in_words(),
        above_band(analysis.points()),
        small_contact(analysis.points()),
        not_converged(analysis),
        unknown_errors(analysis.points(), ShownModes::ALL),
    ];
    for (plot, figures) in &files.figures {
        for (number, figure) in figures.iter().take(MAX_SHEETS).enumerate() {
            if !figure.caption.is_empty() {
                blocks.push(Block::Heading(figure.caption.clone()));
            }
            blocks.push(Block::figure(Figure {
                file: format!("{}{}.svg", plot.stem(), figure.suffix),
                svg: figure.svg.clone(),
                caption: caption(*plot).to_owned(),
                data: data_of(*plot, files).filter(|_| number == 0),
            }));
        }
    }
    if files.figures.iter().any(|(_, figures)| figures.len() > MAX_SHEETS) {
        blocks.push(Block::note(
            "… more combinations of parameters: see the figures in the folder of this page.",
        ));
    }
    blocks.extend(further.into_iter().flatten().map(|sentence| Block::Text(sentence.into())));
    if analysis.points().is_empty() {
        blocks.push(Block::text("There are no points."));
    } else if !analysis.has_series() {
        blocks.push(Block::text(
            "There are no thresholds, because several parameters differ from point to point. `modes.csv` has the modes of all points.",
        ));
    } else {
        blocks.push(Block::Heading("Thresholds".to_owned()));
        blocks.push(Block::Table(table(analysis)));
    }
    blocks.push(Block::Fold(
        "What the figures mean".to_owned(),
        MEANING.iter().map(|paragraph| Block::text(paragraph)).collect(),
    ));
    Section::new("stability", "Linear stability", blocks)
}

/// The data below a figure.
fn data_of(plot: StabilityPlot, files: &Files) -> Option<(String, Option<String>)> {
    let name = match plot {
        StabilityPlot::Map => return None,
        StabilityPlot::LockIn => "modes.csv",
        StabilityPlot::Thresholds => "thresholds.csv",
    };
    let (_, text) = files.data.iter().find(|(file, _)| *file == name)?;
    Some((name.to_owned(), (text.len() <= MOST_DATA).then(|| text.clone())))
}

/// How many modes are not converged, in a sentence; none if all are.
fn not_converged(analysis: &Analysis) -> Option<String> {
    let modes = || analysis.points().iter().flat_map(|point| &point.stability.modes);
    let count = modes().filter(|mode| !mode.is_converged).count();
    let all = value::count(modes().count(), "mode");
    let verb = if count == 1 { "is" } else { "are" };
    let drawn = if analysis.has_series() { " They are drawn grey or hollow." } else { "" };
    (count > 0).then(|| format!("Of {all}, {count} {verb} not converged.{drawn}"))
}

/// ω, the first threshold, where sliding is unstable, the frequency, and what else there is to say, for each group.
fn table(analysis: &Analysis) -> Grid {
    let across = analysis.layout.dimension(analysis.along.across());
    let threshold = if analysis.along.is_mu() { "μ_c".to_owned() } else { analysis.along.threshold() };
    let own = ["unstable", "frequency", "note"].map(str::to_owned);
    let heads = [across.label.clone(), threshold].into_iter().chain(own).collect();
    let mut left_out = String::new();
    let group = |(group, modes): (&Group, &GroupModes)| {
        let line = |speed: &Speed| {
            let place = analysis.across_in_words(speed);
            [place].into_iter().chain(analysis.words(speed)).map(Into::into).collect()
        };
        let (lines, rest) = limited(modes.speeds.iter().map(line), "thresholds.csv");
        if !rest.is_empty() {
            left_out = rest;
        }
        (group.caption(), lines)
    };
    let all = analysis.layout.groups.iter().zip(&analysis.groups);
    let groups: Vec<_> = all.take(MAX_GROUPS).map(group).collect();
    let more = analysis.groups.len() - groups.len();
    if more > 0 {
        left_out =
            format!("… left out: {} of parameters; see `thresholds.csv`.", value::count(more, "combination"));
    }
    Grid { heads, groups, has_words: true, rest: left_out }
}
