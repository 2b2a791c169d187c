//! The figures show what the inspection found, compared as data.

use crate::{coarse, inspect};
use std::collections::BTreeMap;
use tribosweep_output::inspect::{InspectionFigure, Options, PageHeader, Picture, Summary, figures, page};
use tribosweep_output::publish::chart::{Cell, Chart, Guide, Layer, Panel};
use tribosweep_output::publish::page::{Block, Tile};

fn chart<'a>(figures: &'a [InspectionFigure], stem: &str) -> &'a Chart {
    match &figures.iter().find(|figure| figure.stem == stem).unwrap().picture {
        Picture::Chart(chart) => chart,
        Picture::Sketch(_) => panic!("{stem} is a sketch"),
    }
}

fn lines(panel: &Panel) -> impl Iterator<Item = &Vec<(f64, f64)>> {
    panel.layers.iter().filter_map(|layer| match layer {
        Layer::Line { points, .. } => Some(points),
        _ => None,
    })
}

fn cells(panel: &Panel) -> &[Cell] {
    panel
        .layers
        .iter()
        .find_map(|layer| if let Layer::Cells(cells) = layer { Some(cells) } else { None })
        .unwrap()
}

fn guides(panel: &Panel) -> Vec<&Guide> {
    panel
        .layers
        .iter()
        .filter_map(|layer| if let Layer::Guide(guide) = layer { Some(guide) } else { None })
        .collect()
}

fn words(panel: &Panel) -> Vec<&str> {
    panel.legend.iter().map(|entry| entry.text.as_str()).collect()
}

/// Protects: histories have a panel for each observed node, with every step of it; the states behind a line follow each other
/// without a gap, in the colours that the legend explains; the level of the disk and the instants of a cycle are at their
/// values.
#[test]
fn histories_are_those_of_the_nodes() {
    let inspection = inspect(&coarse(), &Options::default());
    let figures = figures(&inspection);
    let [start_s, end_s] = inspection.survey.windows.shown_s;
    for (number, steps) in inspection.capture.nodes.iter().enumerate() {
        let observed = &inspection.observed[number];
        let panel = &chart(&figures, "figure2a").panels[number];
        assert_eq!(panel.title, observed.node.title);
        let labels = words(panel);
        assert_eq!(labels[..3], ["displacement in x", "displacement in y", "displacement in z"]);
        assert_eq!(labels[3..], ["velocity in y (right)"]);
        let drawn: Vec<_> = lines(panel).collect();
        for (c, line) in drawn[..3].iter().enumerate() {
            let expected: Vec<_> =
                steps.iter().map(|step| ((step.time_s - start_s) * 1e6, step.node.u_m[c] * 1e6)).collect();
            assert_eq!(**line, expected);
        }
        assert!(
            drawn[3].iter().map(|point| point.1).eq(steps.iter().map(|step| step.node.y_velocity_m_s * 1e3))
        );
        let [disk] = guides(panel)[..] else { panic!("{:?}", guides(panel)) };
        assert!(disk.right && disk.label == "disk" && disk.at == observed.target_velocity_m_s * 1e3);

        let panel = &chart(&figures, "figure2b").panels[number];
        let bands = cells(panel);
        assert_eq!(bands.len(), observed.phases.len());
        assert!(bands.windows(2).all(|pair| pair[0].x[1] == pair[1].x[0] && pair[0].fill != pair[1].fill));
        assert_eq!(bands[bands.len() - 1].x[1], (end_s - start_s) * 1e6);
        assert_eq!(words(panel)[..3], ["stick", "slip", "separated"]);

        let panel = &chart(&figures, "figure4").panels[number];
        let marks: Vec<_> = guides(panel).into_iter().filter(|guide| guide.is_vertical).collect();
        let named = observed.instants.unwrap().named();
        assert!(
            marks
                .iter()
                .map(|mark| mark.label.clone())
                .eq(named.iter().map(|(letter, _)| format!("t_{letter}")))
        );
        for pair in marks.windows(2).zip(named.windows(2)) {
            let ([a, b], [(_, from_s), (_, to_s)]) = (pair.0, pair.1) else { unreachable!() };
            assert!((b.at - a.at - (to_s - from_s) * 1e6).abs() < 1e-9 * b.at.abs());
        }
    }
}

/// Protects: in phase planes and loops the lines of the three states have every step of a node once, and none of two states.
#[test]
fn states_share_out_a_path() {
    let inspection = inspect(&coarse(), &Options::default());
    let figures = figures(&inspection);
    for (number, steps) in inspection.capture.nodes.iter().enumerate() {
        // Each pair of neighbours is drawn in the colour of its first step; of a loop over slip, those where a cycle begins are not.
        let finite = |panel: &Panel| lines(panel).flatten().filter(|point| point.0.is_finite()).count();
        let pairs = steps.len() - 1;
        assert_eq!(finite(&chart(&figures, "figure3b").panels[number]), 2 * pairs);
        let loops = &chart(&figures, "loops").panels[2 * number..2 * number + 2];
        let drawn = finite(&loops[0]) / 2;
        let cycles = inspection.survey.windows.cycle_count;
        assert!(drawn < pairs && drawn + cycles >= pairs, "{drawn} of {pairs}");
        // The displacement of the first step is not known.
        assert_eq!(finite(&loops[1]) / 2, pairs - 1);
        assert!(loops.iter().all(|panel| words(panel) == ["stick", "slip", "separated"]));
    }
}

/// Protects: the rows of the figure of waves are the nodes along the middle of the face, each with the whole cycle, and every
/// row has the time of its largest stress.
#[test]
fn waves_have_a_row_for_each_node() {
    let inspection = inspect(&coarse(), &Options::default());
    let figures = figures(&inspection);
    let [panel] = chart(&figures, "wave").panels.as_slice() else { panic!("one panel") };
    let [_, end_s] = inspection.survey.windows.cycle_s;
    let mut rows: BTreeMap<u64, f64> = BTreeMap::new();
    for cell in cells(panel) {
        *rows.entry((cell.y[0] + 100.0).to_bits()).or_default() += cell.x[1] - cell.x[0];
    }
    let [_, ny, _] = coarse().scene.pin.elements;
    assert_eq!(rows.len(), ny + 1);
    // From the first step of the cycle on.
    let cycle_us = (end_s - inspection.capture.face[0].time_s) * 1e6;
    // Sums of as many differences as a row has phases round.
    assert!(rows.values().all(|shown_us| (shown_us / cycle_us - 1.0).abs() < 1e-12), "{rows:?}");
    let peaks = panel
        .layers
        .iter()
        .find_map(|layer| if let Layer::Points(points) = layer { Some(points) } else { None });
    assert_eq!(peaks.unwrap().len(), ny + 1);
    assert!(words(panel).contains(&"largest stress"));
}

/// Protects: the page has a section for each figure with its tables, and says if the job has no cycle.
#[test]
fn the_page_has_all_figures() {
    let page_of = |mu: f64| {
        let mut spec = coarse();
        spec.scene.contact.mu = mu;
        let inspection = inspect(&spec, &Options::default());
        let figures = figures(&inspection);
        let tables = BTreeMap::from([("phases.csv".to_owned(), "node\n".to_owned())]);
        (page(&inspection, &Summary::of(&inspection), &figures, &tables, &PageHeader::default()), figures)
    };
    let (page, figures) = page_of(0.4);
    let ids: Vec<_> = page.sections.iter().map(|section| section.id.as_ref()).collect();
    let stems: Vec<_> = figures.iter().map(|figure| figure.stem).collect();
    assert_eq!(stems.len(), 10);
    assert_eq!(ids, [&["scene"], &stems[..], &["nodes", "files"]].concat());
    let files = page.sections[2]
        .blocks
        .iter()
        .find_map(|block| if let Block::Data(files) = block { Some(files) } else { None });
    let files: Vec<_> = files.unwrap().iter().map(|(name, text)| (name.as_str(), text.is_some())).collect();
    assert_eq!(
        files,
        [("node_front_centre.csv", false), ("node_rear_centre.csv", false), ("phases.csv", true)]
    );
    let warns = |lead: &[Block]| {
        lead.iter()
            .any(|block| matches!(block, Block::Warning(text, _) if text.words().contains("no limit cycle")))
    };
    assert!(!warns(&page.lead));
    // This job starts from rest.
    let says_unknown = |tile: &Tile| tile.note.contains("mesh unknown (no run on a coarser mesh)");
    assert!(
        page.lead.iter().any(|block| matches!(block, Block::Tiles(tiles) if tiles.iter().any(says_unknown)))
    );
    let (page, _) = page_of(0.1);
    assert!(warns(&page.lead));
}
