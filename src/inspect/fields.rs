//! The fields of the pin over a cycle as VTK files, which ParaView reads.

use super::capture::{Capture, Frame};
use super::vtu::{self, PointData, Values};
use crate::analysis::sample::NodeSample;
use crate::publish::{Folder, PublishError};
use crate::solver::body::block::BlockMesh;
use crate::solver::body::block::stress;
use crate::solver::interface::ContactState;

/// The corners of an element in the order of VTK, which goes around each face.
const VTK_CORNERS: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// The folder of the files that `fields.pvd` lists.
pub(super) const FRAMES_FOLDER: &str = "fields";

/// Writes `fields.pvd` and a folder with a file for each frame.
///
/// # Errors
/// The first file that could not be written.
pub fn write(capture: &Capture, folder: &mut Folder) -> Result<(), PublishError> {
    let mesh = capture.model.mesh();
    let points_m: Vec<[f64; 3]> = (0..mesh.node_count()).map(|node| mesh.coordinates_m(node)).collect();
    let cells: Vec<[usize; 8]> = mesh
        .element_positions()
        .map(|[i, j, k]| {
            let corners = mesh.element_nodes(i, j, k);
            VTK_CORNERS.map(|corner| corners[corner])
        })
        .collect();
    let path = folder.path_of(FRAMES_FOLDER);
    let mut parts = Folder::create(&path)?;
    let mut names = Vec::new();
    for (number, frame) in capture.frames.iter().enumerate() {
        let name = format!("pin_{number:04}.vtu");
        let data = point_data(capture, mesh, frame);
        parts.write_with(&name, |out| vtu::write_grid(&points_m, &cells, &data, out))?;
        names.push(format!("{FRAMES_FOLDER}/{name}"));
    }
    folder.written.append(&mut parts.written);
    let times_s = capture.frames.iter().map(|frame| frame.time_s);
    folder
        .write_with("fields.pvd", |out| vtu::write_series(times_s.zip(names.iter().map(String::as_str)), out))
}

fn point_data(capture: &Capture, mesh: &BlockMesh, frame: &Frame) -> Vec<PointData> {
    let numbers = |name, count, components, values: Vec<f64>| PointData {
        name,
        components,
        values: Values::Numbers(count, values.into_iter().map(|x| x as f32).collect()),
    };
    // Slave nodes are numbered first.
    let of_face = |count: usize, value: &dyn Fn(&NodeSample, f64) -> Vec<f64>| {
        let areas = capture.model.slaves().iter().map(|slave| slave.area_m2);
        let mut all: Vec<f64> =
            frame.face.iter().zip(areas).flat_map(|(node, area_m2)| value(node, area_m2)).collect();
        all.resize(count * mesh.node_count(), 0.0);
        all
    };
    let mut codes: Vec<i8> = frame.face.iter().map(|node| code(node.state)).collect();
    codes.resize(mesh.node_count(), -1);
    let stress = stress::nodal_pa(mesh, capture.model.pin().material(), &frame.u_m);
    vec![
        numbers("displacement_m", 3, &[], frame.u_m.clone()),
        numbers("velocity_m_s", 3, &[], frame.velocity_m_s.clone()),
        numbers("contact_force_n", 3, &[], of_face(3, &|node, _| node.force_n.to_vec())),
        numbers(
            "normal_contact_stress_pa",
            1,
            &[],
            of_face(1, &|node, area_m2| vec![node.force_n[2] / area_m2]),
        ),
        numbers("gap_m", 1, &[], of_face(1, &|node, _| vec![node.gap_m])),
        PointData { name: "contact_state", components: &[], values: Values::Codes(codes) },
        numbers("stress_pa", 6, &stress::COMPONENTS, stress.into_iter().flatten().collect()),
    ]
}

/// The number of a contact state in the files: 0 separated, 1 stick, 2 slip. Other nodes have −1.
fn code(state: ContactState) -> i8 {
    match state {
        ContactState::Separated => 0,
        ContactState::Stick => 1,
        ContactState::Slip => 2,
    }
}
