//! Total forces and their spectrum.

use super::style::{MICRO, MILLI};
use crate::inspect::envelope::Bin;
use crate::inspect::inspection::Inspection;
use crate::publish::plot::palette;
use crate::publish::plot::panel::{Level, Mark, Panel, Scale, Series, Stroke};

/// The spectrum is shown up to this multiple of the fundamental frequency.
const HARMONICS: f64 = 8.0;

/// N and T of the whole run, and of the last cycles.
pub fn forces(inspection: &Inspection) -> Vec<Panel> {
    vec![whole_run(inspection), last_cycles(inspection)]
}

fn whole_run(inspection: &Inspection) -> Panel {
    let bins = inspection.survey.envelope.bins();
    // A line between the extremes of every bin looks like a drawing of all steps.
    let band = |range: fn(&Bin) -> [f64; 2]| -> Vec<(f64, f64)> {
        let ends = |bin| range(bin).map(|force| (bin.start_s * MILLI, force));
        bins.iter().flat_map(ends).collect()
    };
    let (normal, tangential) = (band(|bin| bin.normal_n), band(|bin| bin.tangential_n));
    let all = normal.iter().chain(&tangential).map(|point| point.1);
    let y = Scale::spanning("force [N]", all, 0.01);
    let x = Scale::from_to("time [ms]", 0.0, inspection.survey.record.simulated_s * MILLI);
    let mut panel = Panel::new("Whole run", x, y);
    panel.series = vec![
        Series { stroke: Stroke::Fine, ..Series::line("N", palette::colour(0, 8), normal) },
        Series { stroke: Stroke::Fine, ..Series::line("T at the clamp", palette::colour(1, 8), tangential) },
    ];
    panel.marks = vec![Mark { label: String::new(), at: inspection.survey.windows.totals_from_s * MILLI }];
    panel
}

fn last_cycles(inspection: &Inspection) -> Panel {
    let [start_s, end_s] = inspection.survey.windows.shown_s;
    let since = |time_s: f64| (time_s - start_s) * MICRO;
    let shown = || {
        inspection.capture.totals.iter().filter(|sample| sample.time_s >= start_s && sample.time_s < end_s)
    };
    let normal: Vec<_> = shown().map(|sample| (since(sample.time_s), sample.smooth_normal_n)).collect();
    let tangential: Vec<_> =
        shown().map(|sample| (since(sample.time_s), sample.clamp_tangential_n)).collect();
    let all = normal.iter().chain(&tangential).map(|point| point.1);
    let y = Scale::spanning("force [N]", all, 0.01);
    let mut panel = Panel::new("Last cycles", Scale::from_to("time [µs]", 0.0, since(end_s)), y);
    panel.series = vec![
        Series::line("N", palette::colour(0, 8), normal),
        Series::line("T at the clamp", palette::colour(1, 8), tangential),
    ];
    panel.levels =
        vec![Level { label: "load F".to_owned(), at: inspection.spec.scene.load.force_n, right: false }];
    let starts = inspection.survey.passages_s.iter().map(|passage| passage[0]);
    // A mark at the edge would be drawn on the axis.
    let starts = starts.filter(|&at_s| at_s > start_s && at_s < end_s);
    panel.marks = starts.map(|at_s| Mark { label: String::new(), at: since(at_s) }).collect();
    panel
}

/// The spectrum of N.
pub fn spectrum(inspection: &Inspection) -> Panel {
    let fundamental_hz =
        inspection.survey.record.frequency_hz.unwrap_or(1.0 / inspection.survey.windows.period_s);
    let points: Vec<(f64, f64)> = inspection
        .spectrum
        .lines()
        .take_while(|(frequency, _)| *frequency <= HARMONICS * fundamental_hz)
        .map(|(frequency, amplitude)| (frequency / MILLI, amplitude))
        .collect();
    let x = Scale::from_to("frequency [kHz]", 0.0, HARMONICS * fundamental_hz / MILLI);
    let y = Scale::spanning("amplitude of N [N]", points.iter().map(|point| point.1).chain([0.0]), 1e-6);
    let mut panel = Panel::new("Spectrum of the total normal contact force", x, y);
    panel.series = vec![Series::line("N", palette::colour(0, 8), points)];
    if let Some(frequency_hz) = inspection.survey.record.frequency_hz {
        panel.marks = vec![Mark { label: format!("{frequency_hz:.0} Hz"), at: frequency_hz / MILLI }];
    }
    panel
}
