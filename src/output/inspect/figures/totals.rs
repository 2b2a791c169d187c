//! Total forces and their spectrum.

use super::style::{MICRO, MILLI, add_level, add_marks, fine, thick};
use crate::analysis::sample::Sample;
use crate::inspect::envelope::Bin;
use crate::inspect::inspection::Inspection;
use crate::publish::chart::palette::{BLUE, VERMILLION};
use crate::publish::chart::{At, Chart, Panel, Pen, Rgb, Scale};

/// The spectrum is shown up to this multiple of the fundamental frequency.
const HARMONICS: f64 = 8.0;

/// N and T of the whole run, and of the last cycles.
pub fn forces(inspection: &Inspection) -> Chart {
    Chart::stack(vec![whole_run(inspection), last_cycles(inspection)])
}

fn of_forces(title: &str, x: Scale, pen: fn(Rgb) -> Pen, normal: Vec<At>, tangential: Vec<At>) -> Panel {
    let values = normal.iter().chain(&tangential).map(|point| point.1);
    let y = Scale::spanning("force [N]", values, 0.01);
    let mut panel = Panel::new(title, x, y);
    panel.line("N", pen(BLUE), normal);
    panel.line("T at the clamp", pen(VERMILLION), tangential);
    panel
}

fn whole_run(inspection: &Inspection) -> Panel {
    // A line between the extremes of every bin looks like a drawing of all steps.
    let band = |range: fn(&Bin) -> [f64; 2]| -> Vec<At> {
        let ends = |bin| range(bin).map(|force| (bin.start_s * MILLI, force));
        inspection.survey.envelope.bins().iter().flat_map(ends).collect()
    };
    let x = Scale::from_to("time [ms]", 0.0, inspection.survey.record.simulated_s * MILLI);
    let mut panel = of_forces("Whole run", x, fine, band(|bin| bin.normal_n), band(|bin| bin.tangential_n));
    add_marks(&mut panel, [(String::new(), inspection.survey.windows.totals_from_s * MILLI)]);
    panel
}

fn last_cycles(inspection: &Inspection) -> Panel {
    let [start_s, end_s] = inspection.survey.windows.shown_s;
    let since = |time_s: f64| (time_s - start_s) * MICRO;
    let path = |force: fn(&Sample) -> f64| -> Vec<At> {
        let totals = inspection.capture.totals.iter();
        let shown = totals.filter(|sample| sample.time_s >= start_s && sample.time_s < end_s);
        shown.map(|sample| (since(sample.time_s), force(sample))).collect()
    };
    let (normal, tangential) =
        (path(|sample| sample.smooth_normal_n), path(|sample| sample.clamp_tangential_n));
    let x = Scale::from_to("time [µs]", 0.0, since(end_s));
    let mut panel = of_forces("Last cycles", x, thick, normal, tangential);
    add_level(&mut panel, "load F", inspection.spec.scene.load.force_n, false);
    let starts = inspection.survey.passages_s.iter().map(|passage| passage[0]);
    // A mark at the edge would be drawn on the axis.
    let starts = starts.filter(|&at_s| at_s > start_s && at_s < end_s);
    add_marks(&mut panel, starts.map(|at_s| (String::new(), since(at_s))));
    panel
}

/// The spectrum of N.
pub fn spectrum(inspection: &Inspection) -> Chart {
    let frequency_hz = inspection.survey.record.frequency_hz;
    let highest_hz = HARMONICS * frequency_hz.unwrap_or(1.0 / inspection.survey.windows.period_s);
    let lines = inspection.spectrum.lines().take_while(|(frequency_hz, _)| *frequency_hz <= highest_hz);
    let points: Vec<At> = lines.map(|(frequency_hz, amplitude)| (frequency_hz / MILLI, amplitude)).collect();
    let x = Scale::from_to("frequency [kHz]", 0.0, highest_hz / MILLI);
    let y = Scale::spanning("amplitude of N [N]", points.iter().map(|point| point.1).chain([0.0]), 1e-6);
    let mut panel = Panel::new("Spectrum of the total normal contact force", x, y);
    panel.line("N", thick(BLUE), points);
    add_marks(&mut panel, frequency_hz.map(|at_hz| (format!("{at_hz:.0} Hz"), at_hz / MILLI)));
    Chart::of(panel)
}
