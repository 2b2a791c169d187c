//! What tests read from charts.

use tribosweep_output::publish::chart::{At, Chart, Entry, Layer, Panel, Pen, Point, Rgb, Tip};
use tribosweep_output::report::figure::{Figure, Plot, figures};
use tribosweep_output::report::{JobRow, View};

/// All figures of a kind.
pub fn all(rows: &[JobRow], plot: Plot) -> Vec<Figure> {
    figures(rows, &View::default(), plot)
}

/// The only figure of a kind.
pub fn only(rows: &[JobRow], plot: Plot) -> Chart {
    let mut all = all(rows, plot);
    assert_eq!(all.len(), 1);
    all.remove(0).chart
}

/// The points of a panel.
pub fn points(panel: &Panel) -> Vec<&Point> {
    let points = panel.layers.iter().filter_map(|layer| match layer {
        Layer::Points(points) => Some(points),
        _ => None,
    });
    points.flatten().collect()
}

/// The points of a panel in a colour.
pub fn coloured(panel: &Panel, colour: Rgb) -> Vec<&Point> {
    points(panel).into_iter().filter(|point| point.marker.colour == colour).collect()
}

/// The lines of a panel.
pub fn lines(panel: &Panel) -> Vec<(&[At], Pen)> {
    let line = |layer| match layer {
        &Layer::Line { ref points, pen, .. } => Some((points.as_slice(), pen)),
        _ => None,
    };
    panel.layers.iter().filter_map(line).collect()
}

/// The meanings in a legend.
pub fn texts(legend: &[Entry]) -> Vec<&str> {
    legend.iter().map(|entry| entry.text.as_str()).collect()
}

/// An attribute of a tooltip.
pub fn data<'a>(tip: &'a Tip, name: &str) -> &'a str {
    tip.data.iter().find(|(own, _)| *own == name).map_or("", |(_, value)| value)
}

/// The point of a job in a panel, of a kind if there are several.
pub fn point<'a>(panel: &'a Panel, job: &str, kind: &str) -> Option<&'a Point> {
    points(panel).into_iter().find(|point| {
        point.tip.as_ref().is_some_and(|tip| data(tip, "job") == job && data(tip, "kind") == kind)
    })
}

/// Number of drawings in a page. A drawing has inner ones, which end at the edges of plots.
pub fn drawings(page: &str) -> usize {
    page.matches("<svg ").count() - page.matches("<svg x=").count()
}
