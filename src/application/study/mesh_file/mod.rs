//! The file of a mesh: it is read with the study, whose text and jobs then contain the mesh.
//!
//! A reader of a format gives a [`FileMesh`]: nodes, hexahedra, and groups. From it follows the content of a job.

mod abaqus;
mod gmsh;

use super::error::StudyError;
use super::source::SourceText;
use super::text_file::read_text;
use crate::spec::{MeshContent, MeshFile};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::io::ErrorKind;
use std::path::Path;

/// The field of the mesh.
const MESH: &str = "scene.pin.mesh";

/// Largest file [byte].
const MOST_BYTES: u64 = 1 << 30;

/// A mesh as its file describes it. Nodes are numbered from 0.
#[derive(Debug, Default)]
struct FileMesh {
    nodes: Vec<[f64; 3]>,
    /// Their numbers in the file.
    numbers: Vec<u64>,
    /// The hexahedra with their numbers in the file, their nodes (around the lower face, then around the upper face), and the names of their
    /// groups.
    hexahedra: Vec<(u64, [usize; 8], Vec<String>)>,
    /// The groups of faces and nodes.
    groups: BTreeMap<String, Group>,
}

/// A group of faces or nodes.
#[derive(Debug, Default)]
struct Group {
    /// Quadrilaterals, around their edges. None: the faces of hexahedra on the surface whose nodes are all in the group.
    faces: Option<Vec<[usize; 4]>>,
    nodes: BTreeSet<usize>,
    /// What in it is no quadrilateral, with its number in the file.
    other: Option<String>,
}

/// From the nodes around the two faces of a hexahedron to those with x fastest, then y, then z.
const FROM_AROUND: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// The faces of a hexahedron by its nodes around its two faces.
const FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// The text of the study with a mesh in place of its file's name; `None` if it names none. The file's path is relative to the folder of
/// the study, or to the working directory for standard input.
///
/// # Errors
/// If the file cannot be read, or does not have what the study needs.
pub(super) fn with_mesh(value: &Value, source: &SourceText) -> Result<Option<String>, StudyError> {
    let Some(mesh) = value.pointer("/scene/pin/mesh") else { return Ok(None) };
    // Fields of wrong types are found with the other fields of the study.
    let Ok(mesh) = serde_json::from_value::<MeshFile>(mesh.clone()) else { return Ok(None) };
    let Some(name) = &mesh.file else { return Ok(None) };
    let refuse = |message: String| Err(source.problem(&format!("{MESH}.file"), message).into());
    if mesh.content.is_some() {
        return refuse("expected either a file or its content".to_owned());
    }
    if mesh.length_unit_m <= 0.0 {
        let right = "expected a length > 0 m of a unit of the file: 0.001 for millimetres";
        return Err(source.problem(&format!("{MESH}.length_unit_m"), right).into());
    }
    let folder = Path::new(&source.file).parent().unwrap_or(Path::new(""));
    let regions = value.pointer("/scene/pin/regions").and_then(Value::as_array);
    let regions: Vec<&str> =
        regions.into_iter().flatten().filter_map(|region| region.get("group")?.as_str()).collect();
    match read(&mesh, &folder.join(name), &regions) {
        Ok(mesh) => Ok(source.with_value(MESH, &json!(mesh))),
        Err(message) => refuse(message),
    }
}

/// Reads the file of a mesh, and puts its content in its place.
///
/// # Errors
/// A message with the file, the line where there is one, and what would be right.
fn read(mesh: &MeshFile, path: &Path, regions: &[&str]) -> Result<MeshFile, String> {
    let named = |message: String| format!("{}: {message}", path.display());
    let is_abaqus = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("inp"));
    let text = read_text(path, MOST_BYTES).map_err(|error| {
        named(match error.kind() {
            ErrorKind::InvalidData if is_abaqus => "not a text file".to_owned(),
            ErrorKind::InvalidData => "not a text file; save it with Mesh.Binary = 0".to_owned(),
            _ => format!("cannot be read: {error}"),
        })
    })?;
    let read = if is_abaqus { abaqus::read(&text) } else { gmsh::read(&text) };
    let file_mesh = read.map_err(|(line, message)| format!("{}:{line}: {message}", path.display()))?;
    resolved(mesh, &file_mesh, regions).map_err(named)
}

fn resolved(mesh: &MeshFile, file: &FileMesh, regions: &[&str]) -> Result<MeshFile, String> {
    if file.hexahedra.is_empty() {
        return Err("no hexahedron with 8 nodes".to_owned());
    }
    let mut bodies: Vec<String> = file.hexahedra.iter().flat_map(|(_, _, groups)| groups.clone()).collect();
    bodies.sort_unstable();
    bodies.dedup();
    // An element may be in several groups of its file. The regions of the study decide which of them counts.
    let body_of = |(number, _, groups): &(u64, [usize; 8], Vec<String>)| -> Result<u32, String> {
        let of_regions: Vec<&String> =
            groups.iter().filter(|group| regions.contains(&group.as_str())).collect();
        match of_regions[..] {
            [] => Ok(bodies.len() as u32),
            [one] => Ok(bodies.binary_search(one).unwrap_or(bodies.len()) as u32),
            [one, other, ..] => Err(format!("element {number} is in the regions {one:?} and {other:?}")),
        }
    };
    let [contact, load, clamp] = mesh.groups();
    let faces = |name: &str| -> Result<Vec<[u32; 4]>, String> {
        let group = group_of(file, name)?;
        if let Some(other) = &group.other {
            return Err(format!("group {name:?} has {other}: expected quadrilaterals with 4 nodes"));
        }
        let faces = group.faces.clone().unwrap_or_else(|| surface_faces(file, &group.nodes));
        if faces.is_empty() {
            return Err(format!("group {name:?} has no quadrilateral on the surface of the hexahedra"));
        }
        Ok(faces.into_iter().map(|face| face.map(|node| node as u32)).collect())
    };
    let content = MeshContent {
        nodes_m: file.nodes.iter().map(|x| x.map(|x| x * mesh.length_unit_m)).collect(),
        hexahedra: file
            .hexahedra
            .iter()
            .map(|(_, nodes, _)| FROM_AROUND.map(|corner| nodes[corner] as u32))
            .collect(),
        ids: file.hexahedra.iter().map(|(number, _, _)| *number as u32).collect(),
        body_of: file.hexahedra.iter().map(body_of).collect::<Result<_, _>>()?,
        contact: faces(contact)?,
        load: faces(load)?,
        clamp: group_of(file, clamp)?.nodes.iter().map(|&node| node as u32).collect(),
    };
    check_place(file)?;
    for name in [contact, load, clamp] {
        check_group(file, name)?;
    }
    if content.body_of.iter().all(|&body| (body as usize) < bodies.len()) {
        return Err(format!(
            "every element is in a region ({}): leave out the region of the material that slides on the disk, and give that \
             material in scene.pin",
            regions.join(", ")
        ));
    }
    Ok(mesh.with_content(&content, bodies))
}

/// Every node of a group is in an element.
fn check_group(file: &FileMesh, name: &str) -> Result<(), String> {
    let mut is_used = vec![false; file.nodes.len()];
    file.hexahedra.iter().flat_map(|(_, nodes, _)| nodes).for_each(|&node| is_used[node] = true);
    match group_of(file, name)?.nodes.iter().find(|&&node| !is_used[node]) {
        None => Ok(()),
        Some(&node) => Err(format!("node {} of group {name:?} is in no element", file.numbers[node])),
    }
}

/// x = y = 0 of the file is the pin's axis. A mesh beside it is one in other coordinates, for example those of an assembly.
fn check_place(file: &FileMesh) -> Result<(), String> {
    let corners =
        || file.hexahedra.iter().flat_map(|(_, nodes, _)| nodes.iter().map(|&node| file.nodes[node]));
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let low = corners().map(|x| x[axis]).fold(f64::INFINITY, f64::min);
        let high = corners().map(|x| x[axis]).fold(f64::NEG_INFINITY, f64::max);
        if low > 0.0 || high < 0.0 {
            return Err(format!(
                "{name} goes from {low} to {high}, but {name} = 0 must be the pin's axis: move the mesh, and give the place on the \
                 disk as scene.disk.track_radius_m"
            ));
        }
    }
    Ok(())
}

fn group_of<'a>(file: &'a FileMesh, name: &str) -> Result<&'a Group, String> {
    file.groups.get(name).filter(|group| !group.nodes.is_empty()).ok_or_else(|| {
        let known: Vec<&str> = file.groups.keys().map(String::as_str).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        format!("no group {name:?} of faces or nodes; the file has {known}")
    })
}

/// The faces of one hexahedron only whose nodes are all in a set.
fn surface_faces(file: &FileMesh, nodes: &BTreeSet<usize>) -> Vec<[usize; 4]> {
    let mut faces: BTreeMap<[usize; 4], (usize, [usize; 4])> = BTreeMap::new();
    for (_, corners, _) in &file.hexahedra {
        for face in FACES.map(|face| face.map(|corner| corners[corner])) {
            if face.iter().all(|node| nodes.contains(node)) {
                let mut sorted = face;
                sorted.sort_unstable();
                faces.entry(sorted).or_insert((0, face)).0 += 1;
            }
        }
    }
    faces.into_values().filter(|(count, _)| *count == 1).map(|(_, face)| face).collect()
}
