//! Runs whose speed or load changes in time: figures, a table of their hysteresis, and their windows as data.

use super::layout::parameters_in_words;
use super::row::JobRow;
use super::windows;
use crate::analysis::program::{Direction, Hysteresis, Leading, ProgramWindow};
use crate::publish::chart::palette::{self, GREY, Rgb};
use crate::publish::chart::{At, Cell, Chart, Entry, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use crate::publish::value;

/// Largest number of jobs that have a figure.
const MAX_FIGURES: usize = 12;
/// The name of the file with all windows.
pub(super) const WINDOWS: &str = "windows.csv";
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
    /// The drawing.
    pub chart: Chart,
}

/// The figure of a job whose speed or load changes in time; none for other jobs.
pub fn chart(row: &JobRow) -> Option<Chart> {
    Job::of(row).as_ref().map(draw)
}

impl<'a> Job<'a> {
    fn of(row: &'a JobRow) -> Option<Self> {
        let windows = row.record()?.windows.as_slice();
        let (leading, hysteresis) = (Leading::of(windows), Hysteresis::of(windows));
        (!windows.is_empty()).then_some(Self { row, windows, leading, hysteresis })
    }
}

impl ProgramFigure {
    /// The drawing as SVG.
    pub fn svg(&self) -> String {
        self.chart.svg(&format!("μ* over speed or load, and over time: {}", self.caption))
    }
}

impl<'a> Programs<'a> {
    /// Those of the rows; none if there are no such jobs.
    pub fn of(rows: &'a [JobRow]) -> Option<Self> {
        let jobs: Vec<Job> = rows.iter().filter_map(Job::of).collect();
        if jobs.is_empty() {
            return None;
        }
        let figure = |(number, job): (usize, &Job)| {
            let file =
                if number == 0 { "program.svg".to_owned() } else { format!("program-{}.svg", number + 1) };
            ProgramFigure { file, caption: parameters_in_words(job.row), chart: draw(job) }
        };
        let figures = jobs.iter().take(MAX_FIGURES).enumerate().map(figure).collect();
        Some(Self { figures, csv: windows::table(rows).csv(), jobs })
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
fn look(direction: Direction) -> Option<(Rgb, &'static str)> {
    match direction {
        Direction::Up => Some((palette::VERMILLION, "up")),
        Direction::Down => Some((palette::BLUE, "down")),
        Direction::Start | Direction::Hold | Direction::Turn => None,
    }
}

fn draw(job: &Job) -> Chart {
    let windows = job.windows;
    let name = match job.leading {
        Leading::Omega => "ω [rpm]",
        Leading::Load => "F [N]",
    };
    let mu = || Scale::spanning("μ*", windows.iter().map(|window| window.mu_star), 0.01);
    let lead = || Scale::spanning(name, windows.iter().map(|window| job.leading.value(window)), 1.0e-3);
    let time = || Scale::from_to("t [s]", windows[0].time_s[0], windows[windows.len() - 1].time_s[1]);
    let over_time = |read: &dyn Fn(&ProgramWindow) -> f64| -> Vec<At> {
        windows.iter().map(|window| (window.middle_s(), read(window))).collect()
    };
    let over_lead = over_lead(job, Panel::new("", lead(), mu()));

    let mut in_time =
        Panel { right: Some(lead()), layers: vec![ways(windows)], ..Panel::new("", time(), mu()) };
    in_time.line("μ*", Pen::solid(palette::GREEN, 2.0), over_time(&|window| window.mu_star));
    on_the_right(&mut in_time, name, over_time(&|window| job.leading.value(window)));

    let khz = |window: &ProgramWindow| window.frequency_hz.unwrap_or(f64::NAN) / KILO;
    let amplitudes = over_time(&|window| window.n_amplitude);
    let of_n = "amplitude of N/F";
    let mut frequency = Panel {
        right: Some(Scale::spanning(of_n, amplitudes.iter().map(|at| at.1), 0.01)),
        layers: vec![ways(windows)],
        ..Panel::new("", time(), Scale::spanning("f [kHz]", windows.iter().map(khz), 0.01))
    };
    let mut rates = over_time(&khz);
    rates.retain(|(_, rate)| rate.is_finite());
    frequency.legend.push(Entry::marker(dot(palette::PURPLE), "frequency"));
    on_the_right(&mut frequency, of_n, amplitudes);
    frequency.layers.push(dots(palette::PURPLE, &rates));

    for panel in [&mut in_time, &mut frequency] {
        for (colour, label) in windows.iter().filter_map(|window| look(window.direction)) {
            panel.explain(Entry::cell(palette::lightened(colour), "", label));
        }
    }
    Chart { title: title(job), ..Chart::stack(vec![over_lead, in_time, frequency]) }
}

/// μ\* over the speed or the load, in the colours of the ways.
fn over_lead(job: &Job, mut panel: Panel) -> Panel {
    panel.height = 300.0;
    for way in job.windows.chunk_by(|a, b| a.direction == b.direction) {
        let points: Vec<At> = way.iter().map(|window| (job.leading.value(window), window.mu_star)).collect();
        let (colour, label) = look(way[0].direction).unwrap_or((GREY, "start, hold, turn"));
        panel.explain(Entry::marker(dot(colour), label));
        let dots = dots(colour, &points);
        if look(way[0].direction).is_some() {
            panel.layers.push(Layer::Line { points, pen: Pen::solid(colour, 1.0), right: false });
        }
        panel.layers.push(dots);
    }
    panel
}

fn dot(colour: Rgb) -> Marker {
    Marker::new(Shape::Circle, colour).sized(3.0)
}

fn dots(colour: Rgb, points: &[At]) -> Layer {
    let point = |at: &At| Point { at: *at, error: 0.0, marker: dot(colour), tip: None };
    Layer::Points(points.iter().map(point).collect())
}

/// Adds a thin grey line on the scale on the right side.
fn on_the_right(panel: &mut Panel, label: &str, points: Vec<At>) {
    let pen = Pen::solid(GREY, 1.0);
    panel.layers.push(Layer::Line { points, pen, right: true });
    panel.legend.push(Entry::line(pen, &format!("{label} (right axis)")));
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
fn ways(windows: &[ProgramWindow]) -> Layer {
    let ways = windows.chunk_by(|a, b| a.direction == b.direction);
    let cell = |way: &[ProgramWindow]| {
        let (colour, _) = look(way[0].direction)?;
        let x = [way[0].time_s[0], way[way.len() - 1].time_s[1]];
        let y = [f64::NEG_INFINITY, f64::INFINITY];
        Some(Cell { x, y, fill: Some(palette::lightened(colour)), ..Cell::default() })
    };
    Layer::Cells(ways.filter_map(cell).collect())
}
