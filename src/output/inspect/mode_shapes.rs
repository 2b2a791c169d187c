//! The motion of a complex mode as VTK files, which ParaView plays.

use super::fields::grid;
use super::vtu::{self, GridInfo, PointData, Values};
use crate::publish::{Folder, PublishError};
use crate::solver::body::pin::PinMesh;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Number of phases of a period.
const PHASES: usize = 24;

/// Writes `NAME.pvd` and a folder NAME with a file for each of 24 phases of one period of a mode.
///
/// The files have the motion Re(q exp(iφ)) of the pin as `displacement_m`, times `scale_m`, without growth or decay, and the
/// size and the phase of each component of q as `amplitude` and `phase_rad`. Components are x, y and z. The time of a file is
/// that in a period of `frequency_hz`; of a mode without vibration, a period takes one second.
///
/// `shape` has q with three numbers per node, whose largest one is 1.
///
/// # Errors
/// The first file that could not be written.
pub fn write_mode(
    folder: &mut Folder,
    mesh: &PinMesh,
    name: &str,
    frequency_hz: f64,
    shape: &[Complex<f64>],
    scale_m: f64,
) -> Result<(), PublishError> {
    let (points_m, cells) = grid(mesh);
    let period_s = if frequency_hz > 0.0 { 1.0 / frequency_hz } else { 1.0 };
    folder.create_inside(name)?;
    let mut files = Vec::new();
    for number in 0..PHASES {
        let share = number as f64 / PHASES as f64;
        let turn = Complex::from_polar(scale_m, TAU * share);
        let data = [
            vector("displacement_m", shape, |q| (q * turn).re),
            vector("amplitude", shape, Complex::norm),
            vector("phase_rad", shape, Complex::arg),
        ];
        let file = format!("{name}/phase_{number:02}.vtu");
        let time_s = share * period_s;
        let info = GridInfo { time_s, codes: None };
        folder.write_with(&file, |out| vtu::write_grid(&points_m, &cells, &data, &info, out))?;
        files.push((time_s, file));
    }
    let series = files.iter().map(|(time_s, file)| (*time_s, file.as_str()));
    folder.write_with(&format!("{name}.pvd"), |out| vtu::write_series(series, out))
}

/// Three numbers per node.
fn vector(name: &'static str, shape: &[Complex<f64>], of: impl Fn(Complex<f64>) -> f64) -> PointData {
    let numbers = shape.iter().map(|q| of(*q) as f32).collect();
    PointData { name, components: &["x", "y", "z"], values: Values::Numbers(3, numbers) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::body::pin::BlockMesh;
    use std::fs;

    /// The numbers of an array of single precision in a file.
    fn numbers(file: &[u8], name: &str) -> Vec<f32> {
        let text = String::from_utf8_lossy(file);
        let header = format!("{}</VTKFile>", text.split_once("<AppendedData").unwrap().0);
        let document = roxmltree::Document::parse(&header).unwrap();
        let array = document.descendants().find(|node| node.attribute("Name") == Some(name)).unwrap();
        assert_eq!(
            (array.attribute("type"), array.attribute("NumberOfComponents")),
            (Some("Float32"), Some("3"))
        );
        let marker = b"<AppendedData encoding=\"raw\">\n_";
        let start = file.windows(marker.len()).position(|part| part == marker).unwrap() + marker.len();
        let at = start + array.attribute("offset").unwrap().parse::<usize>().unwrap();
        let bytes = u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        let values = file[at + 8..at + 8 + bytes].chunks_exact(4);
        values.map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
    }

    /// Protects: the series lists one period in equal steps, and each file has the mode's motion at its phase, with the
    /// amplitude and the phase of every component.
    #[test]
    fn a_period_of_the_motion_is_written() {
        let mesh: PinMesh = BlockMesh::new([1e-3, 2e-3, 3e-3], [1, 2, 1]).into();
        let q = |index: usize| Complex::from_polar(1.0 / (1.0 + index as f64), 0.3 * index as f64 - 3.0);
        let shape: Vec<Complex<f64>> = (0..3 * mesh.node_count()).map(q).collect();
        let path = tempfile::tempdir().unwrap();
        let mut folder = Folder::create(path.path(), "modes").unwrap();
        write_mode(&mut folder, &mesh, "mode_01", 12_500.0, &shape, 1e-4).unwrap();
        assert_eq!(folder.finish().unwrap().len(), PHASES + 1);

        let series = fs::read_to_string(path.path().join("mode_01.pvd")).unwrap();
        let document = roxmltree::Document::parse(&series).unwrap();
        let sets: Vec<_> = document.descendants().filter(|node| node.has_tag_name("DataSet")).collect();
        assert_eq!(sets.len(), PHASES);
        for (number, set) in sets.iter().enumerate() {
            let phase = TAU * number as f64 / PHASES as f64;
            let time_s: f64 = set.attribute("timestep").unwrap().parse().unwrap();
            assert!((TAU * 12_500.0 * time_s - phase).abs() < 1e-9, "{time_s}");
            let file = fs::read(path.path().join(set.attribute("file").unwrap())).unwrap();
            let [motion, amplitudes, phases] =
                ["displacement_m", "amplitude", "phase_rad"].map(|name| numbers(&file, name));
            assert_eq!([motion.len(), amplitudes.len(), phases.len()], [shape.len(); 3]);
            for (index, q) in shape.iter().enumerate() {
                let expected_m = 1e-4 * q.norm() * (q.arg() + phase).cos();
                assert!((f64::from(motion[index]) - expected_m).abs() < 1e-11, "{number} {index}");
                assert!((f64::from(amplitudes[index]) - q.norm()).abs() < 1e-6);
                assert!((f64::from(phases[index]) - q.arg()).abs() < 1e-6);
            }
        }
    }

    /// Protects: a mode that does not vibrate has finite times.
    #[test]
    fn a_mode_without_vibration_has_a_period_too() {
        let mesh: PinMesh = BlockMesh::new([1e-3; 3], [1; 3]).into();
        let path = tempfile::tempdir().unwrap();
        let mut folder = Folder::create(path.path(), "modes").unwrap();
        write_mode(&mut folder, &mesh, "still", 0.0, &[Complex::new(1.0, 0.0); 24], 1.0).unwrap();
        let series = fs::read_to_string(path.path().join("still.pvd")).unwrap();
        assert!(series.contains("timestep=\"5e-1\" part=\"0\" file=\"still/phase_12.vtu\""), "{series}");
    }
}
