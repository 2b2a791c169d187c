//! Protects: a mesh from a file is the mesh that the file describes, and what is wrong with a file is said with its line.

use super::assert_contains;
use std::fmt::Write;
use tribosweep::solver::Model;
use tribosweep::spec::JobSpec;
use tribosweep::study::{Study, job_key};

const ELEMENTS: [usize; 3] = [3, 4, 2];
const SIZE_MM: [f64; 3] = [12.0, 15.0, 10.0];

/// The number of a node, from 1.
fn node(i: usize, j: usize, k: usize) -> usize {
    let [nx, ny, _] = ELEMENTS;
    1 + i + (nx + 1) * (j + (ny + 1) * k)
}

/// The nodes of the reference pin with their coordinates in millimetres.
fn nodes() -> Vec<(usize, [f64; 3])> {
    let [nx, ny, nz] = ELEMENTS;
    let mut found = Vec::new();
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let share = [i as f64 / nx as f64 - 0.5, j as f64 / ny as f64 - 0.5, k as f64 / nz as f64];
                found.push((node(i, j, k), std::array::from_fn(|axis| share[axis] * SIZE_MM[axis])));
            }
        }
    }
    found
}

/// Its elements, with nodes around the lower face, then around the upper face.
fn hexahedra() -> Vec<[usize; 8]> {
    let [nx, ny, nz] = ELEMENTS;
    let mut found = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let around = |k| [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)];
                found.push([around(k), around(k + 1)].concat().try_into().unwrap());
            }
        }
    }
    found
}

fn words(numbers: impl IntoIterator<Item = usize>, between: &str) -> String {
    numbers.into_iter().map(|n| n.to_string()).collect::<Vec<_>>().join(between)
}

/// The pin as Gmsh writes it. Its upper layer of elements is a plate.
fn gmsh() -> String {
    let [nx, ny, nz] = ELEMENTS;
    let mut text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n1 4 \"clamp\"\n2 1 \"contact\"\n2 2 \"load\"\n\
                    3 3 \"pin body\"\n3 5 \"plate\"\n$EndPhysicalNames\n$Entities\n0 1 2 2\n7 -6 -7.5 10 -6 7.5 10 1 4 0\n\
                    1 -6 -7.5 0 6 7.5 0 1 1 0\n2 -6 -7.5 10 6 7.5 10 1 2 0\n1 -6 -7.5 0 6 7.5 5 1 3 0\n\
                    2 -6 -7.5 5 6 7.5 10 1 5 0\n$EndEntities\n"
        .to_owned();
    let nodes = nodes();
    let count = nodes.len();
    let _ = write!(text, "$Nodes\n1 {count} 1 {count}\n3 1 0 {count}\n");
    for (number, _) in &nodes {
        let _ = writeln!(text, "{number}");
    }
    for (_, [x, y, z]) in &nodes {
        let _ = writeln!(text, "{x} {y} {z}");
    }
    let face = |k: usize| {
        let around = move |i: usize, j: usize| {
            [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
        };
        (0..ny).flat_map(move |j| (0..nx).map(move |i| around(i, j)))
    };
    let mut tag = 0;
    let mut block = |text: &mut String, head: &str, elements: Vec<Vec<usize>>| {
        let _ = writeln!(text, "{head} {}", elements.len());
        for element in elements {
            tag += 1;
            let _ = writeln!(text, "{tag} {}", words(element, " "));
        }
    };
    let total = ny + 2 * nx * ny + nx * ny * nz;
    let _ = write!(text, "$EndNodes\n$Elements\n5 {total} 1 {total}\n");
    block(&mut text, "1 7 1", (0..ny).map(|j| vec![node(0, j, nz), node(0, j + 1, nz)]).collect());
    block(&mut text, "2 1 3", face(0).map(Vec::from).collect());
    block(&mut text, "2 2 3", face(nz).map(Vec::from).collect());
    for (head, elements) in ["3 1 5", "3 2 5"].into_iter().zip(hexahedra().chunks(nx * ny)) {
        block(&mut text, head, elements.iter().copied().map(Vec::from).collect());
    }
    text + "$EndElements\n"
}

/// The pin as Abaqus input, with its clamp as a range.
fn abaqus() -> String {
    let [nx, ny, nz] = ELEMENTS;
    let mut text = "*Heading\nthe pin\n*NODE\n".to_owned();
    for (number, [x, y, z]) in nodes() {
        let _ = writeln!(text, "{number}, {x}, {y}, {z}");
    }
    text += "*ELEMENT, type=CPS4, ELSET=skin\n1, 1, 2, 6, 5\n*Element, Type=C3D8R, Elset=pin body\n";
    for (number, nodes) in hexahedra().into_iter().enumerate() {
        // An element may take two lines.
        let _ = writeln!(
            text,
            "{}, {},\n{}",
            100 + number,
            words(nodes[..4].to_vec(), ", "),
            words(nodes[4..].to_vec(), ",")
        );
    }
    let plane = |k: usize| (0..=ny).flat_map(move |j| (0..=nx).map(move |i| node(i, j, k)));
    let _ = writeln!(text, "*NSET, NSET=contact\n{}", words(plane(0), ",\n"));
    let _ = writeln!(text, "*NSET, NSET=load\n{}", words(plane(nz), ",\n"));
    let _ =
        writeln!(text, "*NSET, NSET=clamp, GENERATE\n{}, {}, {}", node(0, 0, nz), node(0, ny, nz), nx + 1);
    let _ = writeln!(text, "*ELSET, ELSET=plate, GENERATE\n{}, {}", 100 + nx * ny, 99 + nx * ny * nz);
    text
}

/// The job of a study beside the file of a mesh.
fn job(text: &str, name: &str, pin: &str) -> Result<JobSpec, String> {
    job_in_unit(text, name, pin, "0.001")
}

/// As [`job`], with the length of a unit of the file.
fn job_in_unit(text: &str, name: &str, pin: &str, length_unit_m: &str) -> Result<JobSpec, String> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), text).unwrap();
    let study = format!(
        r#"{{ "scene": {{ "pin": {{ "shape": "mesh", "mesh": {{ "file": "{name}", "length_unit_m": {length_unit_m} }}{pin} }} }},
            "grid": {{ "mu": [0.3] }} }}"#
    );
    let place = folder.path().join("study.json");
    let in_folder = |error: String| error.replace(&folder.path().display().to_string(), "FOLDER");
    let study =
        Study::parse(&study, &place.display().to_string()).map_err(|error| in_folder(error.to_string()))?;
    // The stored document needs no file.
    drop(folder);
    let stored = Study::parse_stored(&study.document(), "study", None).map_err(|error| error.to_string())?;
    let job = stored.expand("1").map_err(|error| error.to_string())?.swap_remove(0).spec;
    Ok(job)
}

/// K of a model as forces on displacements that depend on the place only, node by node in the order of places.
fn forces(model: &Model) -> Vec<([i64; 3], [f64; 3])> {
    let mesh = model.mesh();
    let u: Vec<f64> = (0..mesh.node_count())
        .flat_map(|node| {
            let [x, y, z] = mesh.coordinates_m(node).map(|x| x * 1.0e3);
            [(x + 0.3 * y * z).sin(), (x * y - z).cos(), 0.1 * x * z + y]
        })
        .collect();
    let force = model.pin().stiffness_times(&u);
    let place = |node: usize| mesh.coordinates_m(node).map(|x| (x * 1.0e9).round() as i64);
    let mut found: Vec<_> = (0..mesh.node_count())
        .map(|node| (place(node), [force[3 * node], force[3 * node + 1], force[3 * node + 2]]))
        .collect();
    found.sort_by_key(|(place, _)| *place);
    found
}

fn places(model: &Model, nodes: impl IntoIterator<Item = usize>) -> Vec<[i64; 3]> {
    let mesh = model.mesh();
    let mut found: Vec<[i64; 3]> =
        nodes.into_iter().map(|node| mesh.coordinates_m(node).map(|x| (x * 1.0e9).round() as i64)).collect();
    found.sort_unstable();
    found
}

/// Protects: both formats give the block, with its stiffness, mass, contact, load and clamp.
#[test]
fn a_block_from_a_file_is_the_block() {
    let mut spec = JobSpec::default();
    spec.scene.pin.elements = ELEMENTS;
    spec.scene.clamp.width_m = 0.0;
    let block = Model::from_scene(&spec.scene, &spec.numerics).unwrap();
    for (text, name) in [(gmsh(), "pin.msh"), (abaqus(), "pin.inp")] {
        let job = job(&text, name, "").unwrap();
        let model = Model::from_scene(&job.scene, &job.numerics).unwrap();
        let (expected, found) = (forces(&block), forces(&model));
        let scale = expected.iter().flat_map(|(_, force)| *force).fold(0.0, |a: f64, b| a.max(b.abs()));
        assert_eq!(expected.len(), found.len(), "{name}");
        for ((place, expected), (other, found)) in expected.iter().zip(&found) {
            assert_eq!(place, other, "{name}");
            for c in 0..3 {
                // A row has 81 products of stiffnesses that are sums of some 64 terms.
                assert!(
                    (expected[c] - found[c]).abs() < 200.0 * f64::EPSILON * 24.0 * scale,
                    "{name} at {place:?}"
                );
            }
        }
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1.0e-12, "{name}: {a} instead of {b}");
        near(model.pin().masses_kg().iter().sum(), block.pin().masses_kg().iter().sum());
        near(model.slaves().iter().map(|s| s.area_m2).sum(), block.slaves().iter().map(|s| s.area_m2).sum());
        near(model.load().iter().map(|load| load.share).sum(), -1.0);
        for support in [0, 1] {
            let nodes =
                |model: &Model| places(model, model.supports()[support].dofs().iter().map(|dof| dof / 3));
            assert_eq!(nodes(&model), nodes(&block), "{name}");
        }
        assert_eq!(places(&model, model.mesh().bottom_nodes()), places(&block, block.mesh().bottom_nodes()));
    }
}

/// Protects: elements of a group have the material of its region.
#[test]
fn a_group_of_elements_is_a_region() {
    let region = r#", "regions": [{ "group": "plate", "young_modulus_pa": 2e9, "poisson_ratio": 0.1, "density_kg_m3": 5000 }]"#;
    for (text, name) in [(gmsh(), "pin.msh"), (abaqus(), "pin.inp")] {
        let job = job(&text, name, region).unwrap();
        let model = Model::from_scene(&job.scene, &job.numerics).unwrap();
        let mass: f64 = model.pin().masses_kg().iter().sum();
        assert!((mass / (0.5 * (2500.0 + 5000.0) * 1.8e-6) - 1.0).abs() < 1.0e-12, "{name}: {mass} kg");
    }
}

/// Protects: the reason why a file cannot be used, with its line.
#[test]
fn unusable_files_are_refused_with_their_line() {
    let gmsh_cases: [(&str, &str, &[&str]); 18] = [
        ("4.1 0 8", "2.2 0 8", &["FOLDER/pin.msh:2: version", "expected 4.1"]),
        ("4.1 0 8", "4.1 1 8", &["pin.msh:2: a binary file", "Mesh.Binary = 0"]),
        ("$MeshFormat", "solid pin", &["pin.msh:1:", "expected a section"]),
        ("\"contact\"", "\"base\"", &["no group \"contact\"", "base, clamp, load"]),
        ("2 1 \"contact\"", "2 1 contact", &["pin.msh:7:", "quotation marks"]),
        ("3 1 5 12", "3 1 4 12", &["is a tetrahedron", "pin body", "expected hexahedra with 8 nodes"]),
        ("3 1 5 12", "3 1 17 12", &["elements of kind 17"]),
        ("2 1 3 12", "2 1 2 12", &["group \"contact\"", "a triangle", "expected quadrilaterals"]),
        ("$Nodes\n1 60", "$Nodes\n1 x", &["`1 x 1 60`: expected blocks"]),
        ("$EndElements", "", &["the file ends here"]),
        ("29 1 2 6 5 21 22 26 25", "29 2 1 5 6 22 21 25 26", &["element 29", "Jacobian"]),
        ("\n30 2 3 7 6", "\n29 2 3 7 6", &["element 29 is repeated"]),
        ("\n30 2 3 7 6 22 23 27 26", "\n30 1 2 6 5 21 22 26 25", &["elements 29 and 30 have the same nodes"]),
        ("\n30 2 3 7 6", "\n5000000000 2 3 7 6", &["element 5000000000", "4294967295"]),
        ("\n6 2 3 7 6", "\n6 1 2 6 5", &["near x = -6", "of the contact face is repeated"]),
        ("\n6 2 3 7 6", "\n6 22 23 27 26", &["of the contact face is between two elements"]),
        ("\n6 2 3 7 6", "\n6 2 3 8 6", &["of the contact face is no face of an element"]),
        ("2 1 \"contact\"\n2 2 \"load\"", "2 2 \"contact\"\n2 1 \"load\"", &["does not look down"]),
    ];
    for (from, to, expected) in gmsh_cases {
        let text = gmsh();
        assert!(text.contains(from), "{from} in\n{text}");
        let changed = text.replacen(from, to, 1);
        let refused = job(&changed, "pin.msh", "").and_then(|job| {
            Model::from_scene(&job.scene, &job.numerics).map(drop).map_err(|error| error.to_string())
        });
        assert_contains(&refused.unwrap_err(), expected);
    }
    let abaqus_cases: [(&str, &str, &[&str]); 12] = [
        ("Type=C3D8R", "Type=C3D4", &["pin.inp:66:", "\"C3D4\"", "C3D8"]),
        ("Type=C3D8R", "Type=C3D20R", &["\"C3D20R\""]),
        ("*Heading", "*INCLUDE, INPUT=other.inp", &["pin.inp:1: *INCLUDE is not read"]),
        ("NSET=load", "NSET=top", &["no group \"load\"", "clamp, contact, top"]),
        ("1, -6, -7.5, 0", "1, -6, -7.5, nan", &["pin.inp:4:", "coordinate 3 of node 1"]),
        ("100, 1, 2, 6, 5,", "100, 1, 2, 6, 555,", &["node 555, which does not exist"]),
        ("*NODE", "*NODE, SYSTEM=C", &["pin.inp:3:", "SYSTEM=C", "expected Cartesian"]),
        ("*NODE", "*NODE, INPUT=nodes.txt", &["pin.inp:3:", "INPUT=nodes.txt"]),
        (
            "*NODE\n",
            "*NODE\n99, 1, 1, 1\n*NSET, NSET=load\n99\n*NODE\n",
            &["node 99 of group \"load\" is in no element"],
        ),
        ("41, 57, 4", "57, 41, 4", &["a range from 57 to 41"]),
        ("41, 57, 4", "41, 18446744073709551615, 4", &["a range of 4611686018427387894 numbers"]),
        ("41, 57, 4", "41, 4000000, 4", &["a range of 999990 numbers, but there are"]),
    ];
    for (from, to, expected) in abaqus_cases {
        let text = abaqus();
        assert!(text.contains(from), "{from} in\n{text}");
        assert_contains(&job(&text.replacen(from, to, 1), "pin.inp", "").unwrap_err(), expected);
    }
}

/// Protects: a mesh in other units than the study says is refused, and a region of a group that does not exist.
#[test]
fn other_units_and_unknown_groups_are_refused() {
    let checked =
        |pin: &str| job(&gmsh(), "pin.msh", pin).and_then(|job| job.check().map_err(|e| e.to_string()));
    checked("").unwrap();
    let other = checked(r#", "size_m": [0.12, 0.15, 0.10]"#).unwrap_err();
    assert_contains(&other, &["scene.pin.size_m[0]", "0.12", "0.012", "length_unit_m"]);
    let region = r#", "regions": [{ "group": "steel", "young_modulus_pa": 2e9, "poisson_ratio": 0.1, "density_kg_m3": 5000 }]"#;
    assert_contains(&checked(region).unwrap_err(), &["scene.pin.regions[0].group", "steel", "pin body"]);
    let region = |group| {
        format!(
            r#"{{ "group": "{group}", "young_modulus_pa": 2e9, "poisson_ratio": 0.1, "density_kg_m3": 5000 }}"#
        )
    };
    let both = format!(r#", "regions": [{}, {}]"#, region("plate"), region("pin body"));
    assert_contains(
        &checked(&both).unwrap_err(),
        &["every element is in a region (plate, pin body)", "scene.pin"],
    );
    let missing = Study::parse(
        r#"{ "scene": { "pin": { "shape": "mesh", "mesh": { "file": "none.msh", "length_unit_m": 1 } } } }"#,
        "studies/x.json",
    );
    assert_contains(
        &missing.unwrap_err().to_string(),
        &["scene.pin.mesh.file", "none.msh", "cannot be read"],
    );
}

/// The text of the Gmsh file with every node moved by `by_mm` along x.
fn moved(by_mm: f64) -> String {
    let change = |line: &str| {
        let numbers: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
        match numbers[..] {
            [x, y, z] => format!("{} {y} {z}", x + by_mm),
            _ => line.to_owned(),
        }
    };
    let text = gmsh();
    let (before, nodes) = text.split_once("$Nodes").unwrap();
    let (nodes, after) = nodes.split_once("$EndNodes").unwrap();
    let nodes: Vec<String> = nodes.lines().map(change).collect();
    format!("{before}$Nodes{}\n$EndNodes{after}", nodes.join("\n"))
}

/// Protects: x = y = 0 of the file is the pin's axis. A mesh in the coordinates of the disk or of an assembly is refused.
#[test]
fn a_mesh_beside_its_axis_is_refused() {
    job(&moved(5.0), "pin.msh", "").unwrap();
    assert_contains(
        &job(&moved(91.4), "pin.msh", "").unwrap_err(),
        &["x goes from 85.4 to 97.4", "x = 0", "track_radius_m"],
    );
}

/// Protects: the same mesh has the same key, whatever its file calls its groups and elements, in whatever unit it is, and however
/// exactly the study says its size.
#[test]
fn equal_meshes_have_equal_keys() {
    let key = |text: &str, pin: &str| job_key(&job(text, "pin.msh", pin).unwrap(), "1");
    let expected = key(&gmsh(), "");
    assert_eq!(key(&gmsh(), r#", "size_m": [0.012001, 0.015, 0.01]"#), expected);
    let sized = r#", "size_m": ["12 mm", "15 mm", "1 cm"]"#;
    let in_texts = job_in_unit(&gmsh(), "pin.msh", sized, "\"1 mm\"").unwrap();
    assert_eq!(job_key(&in_texts, "1"), expected);
    assert_eq!(key(&gmsh(), r#", "elements": [3, 3, 3]"#), expected);
    assert_eq!(key(&gmsh().replace("pin body", "block"), ""), expected);
    assert_eq!(key(&gmsh().replace("\n52 ", "\n1052 "), ""), expected);
    assert_ne!(key(&gmsh().replace("\n-6 -7.5 0\n", "\n-6.001 -7.5 0\n"), ""), expected);
    let region = r#", "regions": [{ "group": "plate", "young_modulus_pa": 2e9, "poisson_ratio": 0.1, "density_kg_m3": 5000 }]"#;
    assert_ne!(key(&gmsh(), region), expected);
    let renamed = (gmsh().replace("plate", "back"), region.replace("plate", "back"));
    assert_eq!(key(&renamed.0, &renamed.1), key(&gmsh(), region));
    let other = region.replace("plate", "pin body");
    assert_ne!(key(&gmsh(), &other), key(&gmsh(), region));
}

/// Protects: a message about what follows a mesh on its line has the place in the user's file, not in the text with the mesh.
#[test]
fn places_are_those_of_the_users_text() {
    let pin = r#", "regions": [{ "group": "steel", "young_modulus_pa": 2e9, "poisson_ratio": 0.1, "density_kg_m3": 5000 }]"#;
    let error = job(&gmsh(), "pin.msh", pin)
        .and_then(|job| job.check().map_err(|error| error.to_string()))
        .unwrap_err();
    assert_contains(&error, &["study.json:1:118"]);
}

/// Numbers that are the same on every machine (a linear congruential generator, Knuth).
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count.max(1)
    }
}

/// The text with a few random changes of its lines and words.
fn damaged(text: &str, random: &mut Random) -> String {
    const WORDS: [&str; 14] = [
        "",
        "-1",
        "0",
        "1",
        "4294967296",
        "18446744073709551615",
        "9e999",
        "nan",
        "-inf",
        "1e300",
        "x",
        "$Nodes",
        "*NODE",
        "\u{fffd}",
    ];
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=random.below(3) {
        let (at, other) = (random.below(lines.len()), random.below(lines.len()));
        match random.below(6) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[other].clone()),
            2 => lines.swap(at, other),
            3 => lines.truncate(at.max(1)),
            _ => {
                let mut words: Vec<&str> = lines[at].split(' ').collect();
                let word = random.below(words.len());
                words[word] = WORDS[random.below(WORDS.len())];
                lines[at] = words.join(" ");
            }
        }
    }
    lines.join("\n")
}

/// Protects: whatever a file contains, it is a mesh that a model can be made of, or it is refused. Nothing panics, and nothing asks for
/// memory without limit.
#[test]
fn damaged_files_are_refused_or_read() {
    let mut random = Random(1);
    let [mut read, mut refused] = [0, 0];
    for round in 0..600 {
        for (text, name) in [(gmsh(), "pin.msh"), (abaqus(), "pin.inp")] {
            let text = damaged(&text, &mut random);
            let found = job(&text, name, "").and_then(|job| {
                Model::from_scene(&job.scene, &job.numerics).map(drop).map_err(|error| error.to_string())
            });
            match found {
                Ok(()) => read += 1,
                Err(message) => {
                    assert!(message.len() > 20, "round {round}, {name}: {message}");
                    refused += 1;
                }
            }
        }
    }
    assert!(read > 10 && refused > 600, "{read} read, {refused} refused");
}
