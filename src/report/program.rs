//! Runs whose speed or load changes in time: figures, a table of their hysteresis, and their windows as data.

use super::export::io_error;
use super::layout::parameters_in_words;
use super::markdown;
use super::row::JobRow;
use crate::analysis::program::{Direction, Hysteresis, Leading, ProgramWindow};
use crate::publish::chart::palette::{self, GREY, Rgb};
use crate::publish::chart::{At, Cell, Chart, Entry, Layer, Marker, Panel, Pen, Point, Scale, Shape};
use crate::publish::{html, value};
use maud::{Markup, html};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Largest number of jobs that have a figure.
const MAX_FIGURES: usize = 12;
/// Largest number of jobs in the table of a page.
const MAX_LISTED: usize = 100;
/// Longer data is not in the page \[byte\].
const MAX_DATA: usize = 1_000_000;
/// The name of the file with all windows.
pub(super) const WINDOWS: &str = "windows.csv";
/// Hertz per kilohertz.
const KILO: f64 = 1.0e3;

const MEANING: &str = "The speed or the load of these jobs changes in time. Their runs are cut into windows, and every figure is a \
                       mean over a window. The hysteresis is the largest difference of μ* between the way up and the way down \
                       at the same speed (or load), up minus down, interpolated between windows.";

/// The columns of [`WindowsCsv`].
const COLUMNS: [&str; 16] = [
    "study",
    "job",
    "parameters",
    "start_s",
    "end_s",
    "direction",
    "omega_rpm",
    "load_n",
    "mu_star",
    "mu_star_contact",
    "frequency_hz",
    "n_amplitude",
    "y_peak_to_peak_m",
    "stick_share",
    "slip_share",
    "separated_share",
];

/// All windows as CSV: a row for each window of each job whose speed or load changes in time.
pub struct WindowsCsv<W: Write>(csv::Writer<W>);

impl<W: Write> WindowsCsv<W> {
    /// Writes the header.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn new(out: W) -> io::Result<Self> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(COLUMNS).map_err(io_error)?;
        Ok(Self(writer))
    }

    /// Writes the windows of a job.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&mut self, row: &JobRow) -> io::Result<()> {
        for window in row.record().iter().flat_map(|record| &record.windows) {
            let own = [row.study.clone(), row.job.clone(), parameters_in_words(row)];
            let [start_s, end_s] = window.time_s.map(value::number);
            let direction = window.direction.name().to_owned();
            let frequency = window.frequency_hz.map_or_else(String::new, value::number);
            let before = [window.omega_rpm, window.load_n, window.mu_star, window.mu_star_contact];
            let after = [
                window.n_amplitude,
                window.y_peak_to_peak_m,
                window.stick_share,
                window.slip_share,
                window.separated_share,
            ];
            let cells = own
                .into_iter()
                .chain([start_s, end_s, direction])
                .chain(before.map(value::number))
                .chain([frequency])
                .chain(after.map(value::number));
            self.0.write_record(cells).map_err(io_error)?;
        }
        Ok(())
    }

    /// Writes what is still buffered.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn finish(mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The jobs of a report whose speed or load changes in time, with their figures.
pub(super) struct Programs<'a> {
    jobs: Vec<Job<'a>>,
    figures: Vec<ProgramFigure>,
    csv: Vec<u8>,
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
        Some(Self { figures, csv: windows_of(rows), jobs })
    }

    /// The figures of the first jobs.
    pub fn figures(&self) -> &[ProgramFigure] {
        &self.figures
    }

    /// The contents of [`WINDOWS`].
    pub fn csv(&self) -> &[u8] {
        &self.csv
    }

    /// The section of a page.
    pub fn markup(&self) -> Markup {
        let data = std::str::from_utf8(&self.csv).ok().filter(|text| text.len() <= MAX_DATA);
        let lines = self.lines(MAX_LISTED).into_iter();
        let lines: Vec<Vec<Markup>> =
            lines.map(|line| line.into_iter().map(|text| html! { (text) }).collect()).collect();
        let drawn = self.figures.len();
        html! {
            p { (MEANING) }
            (html::table(&HEADER.map(str::to_owned), &lines))
            @if self.jobs.len() > lines.len() { p.note { "… and more jobs: see " code { (WINDOWS) } "." } }
            @for (number, figure) in self.figures.iter().enumerate() {
                h3 { (figure.caption) }
                (html::figure(&figure.svg(), CAPTION, data.filter(|_| number == 0).map(|csv| (WINDOWS, csv))))
            }
            @if self.jobs.len() > drawn {
                p.note { "The first " (drawn) " of " (value::count(self.jobs.len(), "job")) " have a figure; " code { (WINDOWS) } " has all of them." }
            }
        }
    }

    /// The section of a Markdown page.
    pub fn markdown(&self) -> String {
        let mut text = format!("\n## Speed and load in time\n\n{}\n\n", markdown::escape(MEANING));
        let _ =
            writeln!(text, "{}", markdown::table(&HEADER.map(str::to_owned), &self.lines(usize::MAX), false));
        for figure in &self.figures {
            let _ = write!(
                text,
                "{}:\n\n![μ* over speed or load, and over time]({})\n\n",
                markdown::escape(&figure.caption),
                figure.file
            );
        }
        text + &format!("All windows: [{WINDOWS}]({WINDOWS})\n")
    }

    fn lines(&self, most: usize) -> Vec<Vec<String>> {
        let line = |job: &Job| {
            let [difference, at] = match job.hysteresis {
                Some(Hysteresis { difference, at }) => {
                    [value::fixed(difference, 4), format!("{} {}", value::short(at), unit(job.leading))]
                }
                None => [value::MISSING.to_owned(), String::new()],
            };
            vec![parameters_in_words(job.row), job.windows.len().to_string(), difference, at]
        };
        self.jobs.iter().take(most).map(line).collect()
    }
}

const HEADER: [&str; 4] = ["parameters", "windows", "hysteresis of μ*", "at"];

const CAPTION: &str = "Above: μ* of the windows against the speed (or the load), on the way up and on the way down. Below: μ* and \
                       the rate of the cycles of N against time. A window whose N hardly varies has no frequency.";

fn unit(leading: Leading) -> &'static str {
    match leading {
        Leading::Omega => "rpm",
        Leading::Load => "N",
    }
}

fn windows_of(rows: &[JobRow]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut write = || {
        let mut csv = WindowsCsv::new(&mut out)?;
        rows.iter().try_for_each(|row| csv.write(row))?;
        csv.finish()
    };
    write().expect("memory can be written");
    out
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
