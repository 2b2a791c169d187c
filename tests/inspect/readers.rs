//! The fields as other programs read them: VTK, on which ParaView is based, and meshio.

use crate::{coarse, inspect, tools};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;
use tribosweep_mechanics::analysis::sample::NodeSample;
use tribosweep_mechanics::solver::body::pin::stress;
use tribosweep_mechanics::solver::interface::ContactState;
use tribosweep_output::inspect::{Frame, Inspection, Options, PageHeader, write};

/// The start of both scripts.
const HEAD: &str = r"
import json, os, sys
import xml.etree.ElementTree as tree
";

/// The end of both scripts: reads a series, and prints all times and the contents of its files as JSON.
const TAIL: &str = r#"
series = sys.argv[1]
parts = list(tree.parse(series).getroot().iter("DataSet"))
files = [os.path.join(os.path.dirname(series), part.get("file")) for part in parts]
json.dump({"times": [float(part.get("timestep")) for part in parts], "files": [read(file) for file in files]},
          sys.stdout)
"#;

/// Reads a file with VTK.
const WITH_VTK: &str = r#"
import vtk
from vtk.util.numpy_support import vtk_to_numpy

def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)).tolist() for i in range(data.GetNumberOfArrays())}
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume")).tolist()
    points = vtk_to_numpy(grid.GetPoints().GetData()).tolist()
    fields = grid.GetFieldData()
    time = fields.GetArray("TimeValue").GetValue(0)
    codes = fields.GetArray("contact_state_codes")
    codes = [[codes.GetComponentName(i), codes.GetComponent(0, i)] for i in range(codes.GetNumberOfComponents())]
    return {"points": points, "volumes": volumes, "arrays": arrays, "time": time, "codes": codes}
"#;

/// Reads a file with meshio.
const WITH_MESHIO: &str = r#"
import numpy
import meshio

def read(path):
    mesh = meshio.read(path)
    cells = mesh.cells_dict["hexahedron"]
    a = mesh.points[cells]
    edges = [a[:, i] - a[:, 0] for i in (1, 3, 4)]
    volumes = numpy.einsum("ij,ij->i", numpy.cross(edges[0], edges[1]), edges[2])
    arrays = {name: values.tolist() for name, values in mesh.point_data.items()}
    time = float(mesh.field_data["TimeValue"][0])
    codes = mesh.field_data["contact_state_codes"].flatten().tolist()
    return {"points": mesh.points.tolist(), "volumes": volumes.tolist(), "arrays": arrays, "time": time, "codes": codes}
"#;

fn python() -> String {
    std::env::var("TRIBOSWEEP_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// The contents as a program reads them; none if it is not installed.
fn read_with(module: &str, script: &str, series: &Path) -> Option<Value> {
    let has = Command::new(python()).args(["-c", &format!("import {module}")]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        tools::missing(
            &format!("{} has no module {module}", python()),
            &format!("pip install {module}, or set TRIBOSWEEP_PYTHON to a Python that has it"),
        );
        return None;
    }
    let output =
        Command::new(python()).args(["-c", &[HEAD, script, TAIL].concat()]).arg(series).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

/// Checks one array in all frames.
fn assert_read_back(name: &str, frames: &[(&Value, Vec<f64>)]) {
    for (read, written) in frames {
        let read = numbers(read);
        assert_eq!(read.len(), written.len(), "{name}");
        for (r, w) in read.iter().zip(written) {
            // The files have single precision.
            assert!((r - w).abs() <= w.abs() * f64::from(f32::EPSILON), "{name}: {r} instead of {w}");
        }
    }
    let varies = frames.windows(2).any(|pair| pair[0].1 != pair[1].1);
    assert!(varies, "{name} is the same in all frames: it could be anything");
}

/// Values of the contact nodes, which are numbered first, and `elsewhere` at all other nodes.
fn on_face(nodes: usize, elsewhere: f64, value: fn(&NodeSample) -> Vec<f64>) -> impl Fn(&Frame) -> Vec<f64> {
    move |frame| {
        let mut all: Vec<f64> = frame.face.iter().flat_map(value).collect();
        all.resize(all.len() / frame.face.len() * nodes, elsewhere);
        all
    }
}

fn code(state: ContactState) -> f64 {
    match state {
        ContactState::Separated => 0.0,
        ContactState::Stick => 1.0,
        ContactState::Slip => 2.0,
    }
}

fn assert_is_the_inspection(read: &Value, inspection: &Inspection) {
    let mesh = inspection.mesh();
    let frames = &inspection.capture.frames;
    assert_eq!(numbers(&read["times"]), frames.iter().map(|frame| frame.time_s).collect::<Vec<_>>());
    let files = read["files"].as_array().unwrap();
    assert_eq!(files.len(), frames.len());
    let [hx, hy, hz] = mesh.block().unwrap().element_size_m();
    let points: Vec<f64> = (0..mesh.node_count()).flat_map(|node| mesh.coordinates_m(node)).collect();
    for (file, frame) in files.iter().zip(frames) {
        assert_eq!(file["time"].as_f64(), Some(frame.time_s));
        // meshio does not read the names of components.
        if file["codes"][0].is_array() {
            let expected =
                json!([["no contact node", -1.0], ["separated", 0.0], ["stick", 1.0], ["slip", 2.0]]);
            assert_eq!(file["codes"], expected);
        }
        assert_eq!(numbers(&file["points"]), points);
        // With the corners in another order, the cells would be twisted and have other volumes.
        let volumes = numbers(&file["volumes"]);
        assert_eq!(volumes.len(), mesh.block().unwrap().element_positions().count());
        assert!(volumes.iter().all(|volume| (volume / (hx * hy * hz) - 1.0).abs() < 1e-9), "{volumes:?}");
    }
    let nodes = mesh.node_count();
    let compare = |name: &str, written: &dyn Fn(&Frame) -> Vec<f64>| {
        let both: Vec<_> =
            files.iter().zip(frames).map(|(file, frame)| (&file["arrays"][name], written(frame))).collect();
        assert_read_back(name, &both);
    };
    compare("displacement_m", &|frame| frame.u_m.clone());
    compare("velocity_m_s", &|frame| frame.velocity_m_s.clone());
    compare("stress_pa", &|frame| frame.stress_pa.concat());
    let stress = |frame: &Frame| frame.stress_pa.clone();
    compare("von_mises_pa", &|frame| stress(frame).into_iter().map(stress::von_mises_pa).collect());
    compare("principal_stress_pa", &|frame| {
        stress(frame).into_iter().flat_map(stress::principal_pa).collect()
    });
    compare("contact_force_n", &on_face(nodes, 0.0, |node| node.force_n.to_vec()));
    compare("normal_contact_stress_pa", &|frame| {
        let slaves = inspection.capture.model.slaves();
        let mut all: Vec<f64> =
            frame.face.iter().zip(slaves).map(|(node, slave)| node.force_n[2] / slave.area_m2).collect();
        all.resize(nodes, 0.0);
        all
    });
    compare("gap_m", &on_face(nodes, 0.0, |node| vec![node.gap_m]));
    compare("contact_state", &on_face(nodes, -1.0, |node| vec![code(node.state)]));
}

/// Protects: VTK and meshio read every number at its point and its time.
#[test]
fn readers_find_what_was_written() {
    let inspection = inspect(&coarse(), &Options { frames: 16, ..Options::default() });
    let folder = tempfile::tempdir().unwrap();
    write(&inspection, folder.path(), &PageHeader::default()).unwrap();
    let series = folder.path().join("fields.pvd");
    for (module, script) in [("vtk", WITH_VTK), ("meshio", WITH_MESHIO)] {
        if let Some(read) = read_with(module, script, &series) {
            assert_is_the_inspection(&read, &inspection);
        }
    }
}
