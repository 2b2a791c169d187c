//! Runs whose speed or load changes in time: figures, a table of their hysteresis, and their windows as data.

use super::layout::parameters_in_words;
use super::row::JobRow;
use super::windows;
use crate::analysis::program::{Direction, Hysteresis, Leading, ProgramWindow};
use crate::publish::plot::RGBColor;
use crate::publish::plot::palette;
use crate::publish::plot::panel::{self, Band, Panel, Scale, Series, Stroke};
use crate::publish::{FigureError, value};

/// Largest number of jobs that have a figure.
const MAX_FIGURES: usize = 12;
/// The name of the file with all windows.
pub(super) const WINDOWS: &str = "windows.csv";
const GREY: RGBColor = RGBColor(0x60, 0x60, 0x60);
/// Hertz per kilohertz.
const KILO: f64 = 1.0e3;

/// What the figures and the table mean.
pub(super) const MEANING: &str = "The speed or the load of these jobs changes in time. Their runs are cut into windows, and every figure is a \
                       mean over a window. The hysteresis is the largest difference of μ* between the way up and the way down \
                       at the same speed (or load), up minus down, interpolated between windows.";

/// The jobs of a report whose speed or load changes in time, with their figures.
pub(super) struct Programs<'a> {
    jobs: Vec<Job<'a>>,
    figures: Vec<ProgramFigure>,
    csv: String,
}

struct Job<'a> {
    row: &'a JobRow,
    windows: &'a [ProgramWindow],
    leading: Leading,
    hysteresis: Option<Hysteresis>,
}

/// A figure of a job.
pub(super) struct ProgramFigure {
    /// Its file.
    pub file: String,
    /// The job, in words.
    pub caption: String,
    /// The drawing as SVG.
    pub svg: String,
}

impl<'a> Programs<'a> {
    /// Those of the rows; none if there are no such jobs.
    ///
    /// # Errors
    /// Those of the drawing library.
    pub fn of(rows: &'a [JobRow]) -> Result<Option<Self>, FigureError> {
        let job = |row: &'a JobRow| {
            let windows = row.record()?.windows.as_slice();
            let (leading, hysteresis) = (Leading::of(windows), Hysteresis::of(windows));
            (!windows.is_empty()).then_some(Job { row, windows, leading, hysteresis })
        };
        let jobs: Vec<Job> = rows.iter().filter_map(job).collect();
        if jobs.is_empty() {
            return Ok(None);
        }
        let figure = |(number, job): (usize, &Job)| {
            let file =
                if number == 0 { "program.svg".to_owned() } else { format!("program-{}.svg", number + 1) };
            Ok(ProgramFigure { file, caption: parameters_in_words(job.row), svg: draw(job)? })
        };
        let figures: Result<_, FigureError> = jobs.iter().take(MAX_FIGURES).enumerate().map(figure).collect();
        Ok(Some(Self { figures: figures?, csv: windows::table(rows).csv(), jobs }))
    }

    /// The figures of the first jobs.
    pub fn figures(&self) -> &[ProgramFigure] {
        &self.figures
    }

    /// The contents of [`WINDOWS`].
    pub fn csv(&self) -> &str {
        &self.csv
    }

    /// Number of jobs whose speed or load changes in time.
    pub fn jobs(&self) -> usize {
        self.jobs.len()
    }

    /// The lines of the table.
    pub fn lines(&self) -> impl Iterator<Item = Vec<String>> {
        let line = |job: &Job| {
            let [difference, at] = match job.hysteresis {
                Some(Hysteresis { difference, at }) => {
                    [value::fixed(difference, 4), format!("{} {}", value::short(at), unit(job.leading))]
                }
                None => [value::MISSING.to_owned(), String::new()],
            };
            vec![parameters_in_words(job.row), job.windows.len().to_string(), difference, at]
        };
        self.jobs.iter().map(line)
    }
}

/// The heads of [`Programs::lines`].
pub(super) const HEADS: [&str; 4] = ["parameters", "windows", "hysteresis of μ*", "at"];

fn unit(leading: Leading) -> &'static str {
    match leading {
        Leading::Omega => "rpm",
        Leading::Load => "N",
    }
}

/// The colour of a direction and its name; none for windows that are on no way.
fn look(direction: Direction) -> Option<(RGBColor, &'static str)> {
    match direction {
        Direction::Up => Some((palette::VERMILLION, "up")),
        Direction::Down => Some((palette::BLUE, "down")),
        Direction::Start | Direction::Hold | Direction::Turn => None,
    }
}

fn draw(job: &Job) -> Result<String, FigureError> {
    let windows = job.windows;
    let (name, least) = match job.leading {
        Leading::Omega => ("ω [rpm]", 1.0e-3),
        Leading::Load => ("F [N]", 1.0e-3),
    };
    let leading = |window: &ProgramWindow| job.leading.value(window);
    let mu_scale = || Scale::spanning("μ*", windows.iter().map(|window| window.mu_star), 0.01);
    let lead_scale = || Scale::spanning(name, windows.iter().map(leading), least);
    let time_scale = || {
        let [from_s, to_s] = [windows[0].time_s[0], windows[windows.len() - 1].time_s[1]];
        Scale::from_to("t [s]", from_s, to_s)
    };

    let mut over_lead = Panel::new(&title(job), lead_scale(), mu_scale());
    over_lead.height = 720;
    let mut named: Vec<&str> = Vec::new();
    for way in windows.chunk_by(|a, b| a.direction == b.direction) {
        let points: Vec<(f64, f64)> = way.iter().map(|window| (leading(window), window.mu_star)).collect();
        let (colour, label) = look(way[0].direction).unwrap_or((GREY, "start, hold, turn"));
        let is_new = !named.contains(&label);
        named.push(label);
        let label = is_new.then(|| label.to_owned());
        if look(way[0].direction).is_some() {
            let line =
                Series { label: None, colour, stroke: Stroke::Fine, right: false, points: points.clone() };
            over_lead.series.push(line);
        }
        over_lead.series.push(Series { label, colour, stroke: Stroke::Dots, right: false, points });
    }

    let over_time = |read: fn(&ProgramWindow) -> f64| -> Vec<(f64, f64)> {
        windows.iter().map(|window| (window.middle_s(), read(window))).collect()
    };
    let mut in_time = Panel::new("", time_scale(), mu_scale());
    in_time.right = Some(lead_scale());
    in_time.bands = bands(windows);
    let lead_points = windows.iter().map(|window| (window.middle_s(), leading(window))).collect();
    let lead = Series {
        label: Some(name.to_owned()),
        colour: GREY,
        stroke: Stroke::Fine,
        right: true,
        points: lead_points,
    };
    in_time.series = vec![Series::line("μ*", palette::GREEN, over_time(|window| window.mu_star)), lead];

    let khz = |window: &ProgramWindow| window.frequency_hz.unwrap_or(f64::NAN) / KILO;
    let mut frequency =
        Panel::new("", time_scale(), Scale::spanning("f [kHz]", windows.iter().map(khz), 0.01));
    let amplitude = |window: &ProgramWindow| window.n_amplitude;
    frequency.right = Some(Scale::spanning("amplitude of N/F", windows.iter().map(amplitude), 0.01));
    frequency.bands = bands(windows);
    let rates = over_time(|window| window.frequency_hz.unwrap_or(f64::NAN) / KILO);
    let rates: Vec<(f64, f64)> = rates.into_iter().filter(|(_, rate)| rate.is_finite()).collect();
    let dots = Series {
        label: Some("frequency".to_owned()),
        colour: palette::PURPLE,
        stroke: Stroke::Dots,
        right: false,
        points: rates,
    };
    let amplitudes = Series {
        label: Some("amplitude of N/F".to_owned()),
        colour: GREY,
        stroke: Stroke::Fine,
        right: true,
        points: over_time(|window| window.n_amplitude),
    };
    frequency.series = vec![dots, amplitudes];
    panel::stack(&[over_lead, in_time, frequency])
}

fn title(job: &Job) -> String {
    let words = parameters_in_words(job.row);
    match job.hysteresis {
        Some(Hysteresis { difference, at }) => format!(
            "{words}: hysteresis {} at {} {}",
            value::fixed(difference, 4),
            value::short(at),
            unit(job.leading)
        ),
        None => words,
    }
}

/// Backgrounds of the ways up and down.
fn bands(windows: &[ProgramWindow]) -> Vec<Band> {
    let ways = windows.chunk_by(|a, b| a.direction == b.direction);
    let band = |way: &[ProgramWindow]| {
        let (colour, label) = look(way[0].direction)?;
        Some(Band { label, colour, span: (way[0].time_s[0], way[way.len() - 1].time_s[1]) })
    };
    ways.filter_map(band).collect()
}
