//! The fields of the pin over a cycle as VTK files, which ParaView reads.

use super::capture::{Capture, Frame};
use super::vtu::{self, GridInfo, PointData, Values};
use crate::analysis::sample::NodeSample;
use crate::publish::{Folder, PublishError};
use crate::solver::body::pin::PinMesh;
use crate::solver::body::pin::stress;
use crate::solver::interface::ContactState;

/// The corners of an element in the order of VTK, which goes around each face.
const VTK_CORNERS: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// The folder of the files that `fields.pvd` lists.
const FRAMES_FOLDER: &str = "fields";

/// The names of the principal stresses, largest first.
const PRINCIPAL: [&str; 3] = ["I", "II", "III"];

/// The meaning of the numbers of `contact_state`. Every file has it as field data.
const CODES: [(i8, &str); 4] =
    [(NO_CONTACT_NODE, "no contact node"), (0, "separated"), (1, "stick"), (2, "slip")];
const NO_CONTACT_NODE: i8 = -1;

/// The fields of the files, each with its meaning and unit.
pub(super) const FIELDS: [(&str, &str); 10] = [
    ("displacement_m", "displacement [m]"),
    ("velocity_m_s", "velocity over the step that led to the displacement [m/s]"),
    ("contact_force_n", "contact force on the pin: friction in x and y, normal force in z [N]"),
    ("normal_contact_stress_pa", "normal contact force over the area of the node [Pa]"),
    ("gap_m", "gap between the node and the disk [m]"),
    (
        "contact_state",
        "−1 no contact node, 0 separated, 1 stick, 2 slip; the files repeat this as field data",
    ),
    ("von_mises_pa", "von Mises stress [Pa]"),
    ("principal_stress_pa", "principal stresses I ≥ II ≥ III [Pa]; the largest shear stress is (I − III)/2"),
    ("stress_pa", "stress in the order xx, yy, zz, xy, yz, xz [Pa]"),
    ("plastic_strain", "plastic strain, of a pin that may yield"),
];

/// Writes `fields.pvd` and a folder with a file for each frame.
///
/// # Errors
/// The first file that could not be written.
pub fn write(capture: &Capture, folder: &mut Folder) -> Result<(), PublishError> {
    let mesh = capture.model.mesh();
    let (points_m, cells) = grid(mesh);
    folder.create_inside(FRAMES_FOLDER)?;
    let mut names = Vec::new();
    for (number, frame) in capture.frames.iter().enumerate() {
        let name = format!("{FRAMES_FOLDER}/pin_{number:04}.vtu");
        let data = point_data(capture, mesh, frame);
        let info = GridInfo { time_s: frame.time_s, codes: Some(("contact_state_codes", &CODES)) };
        folder.write_with(&name, |out| vtu::write_grid(&points_m, &cells, &data, &info, out))?;
        names.push(name);
    }
    let times_s = capture.frames.iter().map(|frame| frame.time_s);
    folder
        .write_with("fields.pvd", |out| vtu::write_series(times_s.zip(names.iter().map(String::as_str)), out))
}

/// The nodes [m] of the pin, and its elements with their corners in the order of VTK.
pub(super) fn grid(mesh: &PinMesh) -> (Vec<[f64; 3]>, Vec<[usize; 8]>) {
    let points_m = (0..mesh.node_count()).map(|node| mesh.coordinates_m(node)).collect();
    let corners = |corners: [usize; 8]| VTK_CORNERS.map(|corner| corners[corner]);
    (points_m, mesh.element_nodes().into_iter().map(corners).collect())
}

fn point_data(capture: &Capture, mesh: &PinMesh, frame: &Frame) -> Vec<PointData> {
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
    codes.resize(mesh.node_count(), NO_CONTACT_NODE);
    let stress = &frame.stress_pa;
    let principal: Vec<f64> = stress.iter().flat_map(|at| stress::principal_pa(*at)).collect();
    let plastic = frame.plastic_strain.clone().map(|strain| numbers("plastic_strain", 1, &[], strain));
    let mut all = vec![
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
        numbers("von_mises_pa", 1, &[], stress.iter().map(|at| stress::von_mises_pa(*at)).collect()),
        numbers("principal_stress_pa", 3, &PRINCIPAL, principal),
        numbers("stress_pa", 6, &stress::COMPONENTS, stress.concat()),
    ];
    all.extend(plastic);
    all
}

/// The number of a contact state in the files: 0 separated, 1 stick, 2 slip. Other nodes have −1.
fn code(state: ContactState) -> i8 {
    match state {
        ContactState::Separated => 0,
        ContactState::Stick => 1,
        ContactState::Slip => 2,
    }
}
