//! B34 The rig of Allgaier, Gaul, Keiper and Willner (1999): a beam on an elastic disk.

use std::f64::consts::TAU;
use tribosweep::solver::body::pin::{BlockMesh, GeneralMesh, MeshParts, Stiffness, Tilt};
use tribosweep::solver::body::ring::{RingDefinition, RingMesh};
use tribosweep::solver::interface::law::Law;
use tribosweep::solver::interface::target::TargetDefinition;
use tribosweep::solver::material::Material;
use tribosweep::solver::support::Support;
use tribosweep::solver::{Drive, Model, ModelDefinition, TimeStep};
use tribosweep::spec::{DiskTimeStep, TargetSurface};
use tribosweep::stability::SparseStructure;

const ALUMINIUM: Material = Material { young_modulus_pa: 7.0e10, poisson_ratio: 0.33, density_kg_m3: 2700.0 };

fn rig(pin: [usize; 3], disk: [usize; 3], tilt_deg: f64) -> Model {
    let ring = RingMesh::uniform(TAU, [0.008, 0.179], 0.025, disk);
    let held = (0..ring.node_count()).filter(|node| ring.grid_position(*node)[1] == 0).collect();
    let tilt = Tilt { x_rad: tilt_deg.to_radians(), y_rad: 0.0 };
    let parts = MeshParts::of_block(&BlockMesh::new([0.010, 0.010, 0.149], pin));
    let mesh = GeneralMesh::new(&parts, tilt).unwrap();
    let heights: Vec<f64> =
        mesh.contact_areas_m2().iter().enumerate().map(|(node, _)| mesh.coordinates_m(node)[2]).collect();
    let top: Vec<usize> = mesh.top_nodes().to_vec();
    let definition = ModelDefinition {
        mesh: mesh.into(),
        materials: vec![ALUMINIUM],
        stiffness: Stiffness::Elastic,
        supports: vec![Support::fixed(top.into_iter().flat_map(|node| 3 * node..3 * node + 3))],
        load: Vec::new(),
        target: TargetDefinition::Ring(RingDefinition {
            mesh: ring,
            material: ALUMINIUM,
            held,
            target: TargetSurface::Bilinear,
            clock: DiskTimeStep::Own,
            track_radius_m: 0.162,
        }),
        beta2: 0.5,
        beta_r_s: 0.0,
        time_step: TimeStep::FractionOfLimit(0.5),
    };
    // The far end is pushed 0.1 mm towards the disk.
    Model::new(definition).unwrap().with_initial_gaps(|slave| heights[slave.node] - 1.0e-4)
}

#[test]
#[ignore = "sparse factors of pin and disk"]
fn probe() {
    for (pin, disk) in [([2, 3, 24], [48, 12, 3]), ([2, 4, 30], [60, 14, 3])] {
        for tilt_deg in [4.0, -4.0] {
            let model = rig(pin, disk, tilt_deg);
            let structure = SparseStructure::new(&model).unwrap();
            for mu in [0.0, 0.152, 0.4] {
                let drive = Drive { law: Law::Coulomb { mu }, rate: 2.0, force_n: 1.0, ramp_s: 0.0 };
                let started = std::time::Instant::now();
                let near = match structure.near(&model, &drive, 2250.0) {
                    Ok(near) => near,
                    Err(error) => {
                        println!("{error}");
                        continue;
                    }
                };
                println!("{pin:?} {disk:?} tilt {tilt_deg} mu {mu}: {:.1?}", started.elapsed());
                let mut modes = near.modes;
                modes.retain(|mode| (mode.eigenvalue_per_s.im / TAU - 2250.0).abs() < 500.0);
                modes.sort_by(|a, b| a.eigenvalue_per_s.im.total_cmp(&b.eigenvalue_per_s.im));
                for mode in &modes {
                    println!(
                        "   {:.1} Hz {:+.2} 1/s",
                        mode.eigenvalue_per_s.im / TAU,
                        mode.eigenvalue_per_s.re
                    );
                }
            }
        }
    }
}
