//! Gmsh MSH 4.1 as text (Gmsh reference manual, section "MSH file format").

use super::{FileMesh, Group};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::str::FromStr;

/// A message and its line.
type Failed = (usize, String);

/// A kind of element of the format: its number, its number of nodes, and its name.
const KINDS: [(u32, usize, &str); 13] = [
    (1, 2, "line"),
    (2, 3, "triangle"),
    (3, 4, "quadrilateral"),
    (4, 4, "tetrahedron"),
    (5, 8, "hexahedron"),
    (6, 6, "wedge"),
    (7, 5, "pyramid"),
    (8, 3, "line of second order"),
    (9, 6, "triangle of second order"),
    (10, 9, "quadrilateral of second order"),
    (11, 10, "tetrahedron of second order"),
    (12, 27, "hexahedron of second order"),
    (15, 1, "point"),
];
const QUADRILATERAL: u32 = 3;
const HEXAHEDRON: u32 = 5;

/// The lines of a text with their numbers.
struct Lines<'a> {
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
    number: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Result<&'a str, Failed> {
        let found = self.lines.find(|(_, line)| !line.trim().is_empty());
        let (index, line) = found.ok_or((self.number, "the file ends here".to_owned()))?;
        self.number = index + 1;
        Ok(line.trim())
    }

    /// The numbers of the next line, at least `least` of them.
    fn numbers<T: FromStr>(&mut self, least: usize, what: &str) -> Result<Vec<T>, Failed> {
        let line = self.next()?;
        let numbers: Result<Vec<T>, _> = line.split_whitespace().map(str::parse).collect();
        match numbers {
            Ok(numbers) if numbers.len() >= least => Ok(numbers),
            _ => {
                Err(self.failed(format!("`{}`: expected {what}", line.chars().take(40).collect::<String>())))
            }
        }
    }

    fn failed(&self, message: impl Into<String>) -> Failed {
        (self.number, message.into())
    }

    fn expect_end(&mut self, section: &str) -> Result<(), Failed> {
        let line = self.next()?;
        if line == format!("$End{section}") {
            Ok(())
        } else {
            Err(self.failed(format!("`{line}`: expected $End{section}")))
        }
    }
}

/// Groups of the entities of the geometry: dimension and tag → names.
type Named = HashMap<(u32, i64), Vec<String>>;

pub(super) fn read(text: &str) -> Result<FileMesh, Failed> {
    let mut lines = Lines { lines: text.lines().enumerate(), number: 1 };
    let mut mesh = FileMesh::default();
    let mut names: HashMap<(u32, i64), String> = HashMap::new();
    let mut entities: Named = HashMap::new();
    let mut index_of: HashMap<u64, usize> = HashMap::new();
    let mut has_format = false;
    while let Ok(header) = lines.next() {
        let Some(section) = header.strip_prefix('$') else {
            return Err(lines.failed(format!("`{header}`: expected a section such as $MeshFormat")));
        };
        if !has_format && section != "MeshFormat" && section != "Comments" {
            return Err(lines.failed(format!("`{header}`: expected $MeshFormat of a Gmsh file")));
        }
        match section {
            "MeshFormat" => {
                let line = lines.next()?;
                let words: Vec<&str> = line.split_whitespace().collect();
                if words.first() != Some(&"4.1") {
                    return Err(lines.failed(format!(
                        "version {line:?}: expected 4.1; save it with Mesh.MshFileVersion = 4.1"
                    )));
                }
                if words.get(1) != Some(&"0") {
                    return Err(lines.failed("a binary file: expected text; save it with Mesh.Binary = 0"));
                }
                has_format = true;
                lines.expect_end(section)?;
            }
            "PhysicalNames" => {
                physical_names(&mut lines, &mut names)?;
                lines.expect_end(section)?;
            }
            "Entities" => {
                read_entities(&mut lines, &names, &mut entities)?;
                lines.expect_end(section)?;
            }
            "Nodes" => {
                nodes(&mut lines, &mut mesh, &mut index_of)?;
                lines.expect_end(section)?;
            }
            "Elements" => {
                elements(&mut lines, &mut mesh, &index_of, &entities)?;
                lines.expect_end(section)?;
            }
            // Other sections do not describe the mesh.
            other => {
                let end = format!("$End{other}");
                while lines.next()? != end {}
            }
        }
    }
    if !has_format {
        return Err((1, "not a Gmsh file: expected $MeshFormat".to_owned()));
    }
    Ok(mesh)
}

fn physical_names(lines: &mut Lines<'_>, names: &mut HashMap<(u32, i64), String>) -> Result<(), Failed> {
    let [count] = lines.numbers::<usize>(1, "a number of names")?[..] else {
        return Err(lines.failed("expected one number of names"));
    };
    for _ in 0..count {
        let line = lines.next()?;
        let (numbers, name) =
            line.split_once('"').ok_or_else(|| lines.failed("expected a name in quotation marks"))?;
        let mut numbers = numbers.split_whitespace();
        let (dimension, tag) =
            (numbers.next().and_then(|n| n.parse().ok()), numbers.next().and_then(|n| n.parse().ok()));
        let (Some(dimension), Some(tag)) = (dimension, tag) else {
            return Err(lines.failed("expected a dimension and a tag before the name"));
        };
        names.insert((dimension, tag), name.trim_end().trim_end_matches('"').to_owned());
    }
    Ok(())
}

fn read_entities(
    lines: &mut Lines<'_>,
    names: &HashMap<(u32, i64), String>,
    entities: &mut Named,
) -> Result<(), Failed> {
    let counts = lines.numbers::<usize>(4, "the numbers of points, curves, surfaces and volumes")?;
    for (dimension, &count) in counts.iter().take(4).enumerate() {
        // A point has a position, all others have two corners of a box.
        let before = if dimension == 0 { 4 } else { 7 };
        for _ in 0..count {
            let numbers = lines.numbers::<f64>(before + 1, "an entity")?;
            let groups = numbers[before] as usize;
            let Some(tags) = numbers.get(before + 1..before + 1 + groups) else {
                return Err(lines.failed(format!("expected {groups} physical tags")));
            };
            // Tags of elements' orientation are negative.
            let named = |tag: &f64| {
                let tag = tag.abs() as i64;
                names.get(&(dimension as u32, tag)).cloned().unwrap_or_else(|| tag.to_string())
            };
            entities.insert((dimension as u32, numbers[0] as i64), tags.iter().map(named).collect());
        }
    }
    Ok(())
}

fn nodes(
    lines: &mut Lines<'_>,
    mesh: &mut FileMesh,
    index_of: &mut HashMap<u64, usize>,
) -> Result<(), Failed> {
    let header = lines.numbers::<u64>(4, "blocks, nodes, and the smallest and largest tag")?;
    for _ in 0..header[0] {
        let block = lines.numbers::<u64>(4, "dimension, tag, parametric and number of nodes")?;
        let first = mesh.nodes.len();
        for offset in 0..block[3] as usize {
            let tag = lines.numbers::<u64>(1, "the tag of a node")?[0];
            if index_of.insert(tag, first + offset).is_some() {
                return Err(lines.failed(format!("node {tag} is repeated")));
            }
            mesh.numbers.push(tag);
        }
        for _ in 0..block[3] {
            let x = lines.numbers::<f64>(3, "three coordinates")?;
            if x.iter().any(|x| !x.is_finite()) {
                return Err(lines.failed("a coordinate is not finite"));
            }
            mesh.nodes.push([x[0], x[1], x[2]]);
        }
    }
    Ok(())
}

fn elements(
    lines: &mut Lines<'_>,
    mesh: &mut FileMesh,
    index_of: &HashMap<u64, usize>,
    entities: &Named,
) -> Result<(), Failed> {
    let header = lines.numbers::<u64>(4, "blocks, elements, and the smallest and largest tag")?;
    let mut groups: BTreeMap<String, Group> = BTreeMap::new();
    let mut tags = HashSet::new();
    for _ in 0..header[0] {
        let block = lines.numbers::<i64>(4, "dimension, tag, kind and number of elements")?;
        let (dimension, kind) = (block[0] as u32, block[2] as u32);
        let none = Vec::new();
        let names = entities.get(&(dimension, block[1])).unwrap_or(&none);
        let (size, word) = KINDS
            .iter()
            .find(|(number, ..)| *number == kind)
            .map(|(_, size, word)| (*size, *word))
            .ok_or_else(|| {
                lines.failed(format!("elements of kind {kind}: expected hexahedra with 8 nodes (kind 5)"))
            })?;
        for _ in 0..block[3] {
            let numbers = lines.numbers::<u64>(size + 1, "an element's tag and nodes")?;
            let tag = numbers[0];
            if !tags.insert(tag) {
                return Err(lines.failed(format!("element {tag} is repeated")));
            }
            if u32::try_from(tag).is_err() {
                return Err(lines.failed(format!("element {tag}: expected a number up to {}", u32::MAX)));
            }
            if dimension == 3 && kind != HEXAHEDRON {
                let of = names.first().map_or(String::new(), |name| format!(" of group {name:?}"));
                return Err(
                    lines.failed(format!("element {tag}{of} is a {word}: expected hexahedra with 8 nodes"))
                );
            }
            let corners: Result<Vec<usize>, Failed> = numbers[1..=size]
                .iter()
                .map(|node| {
                    let index = index_of.get(node).copied();
                    index.ok_or_else(|| {
                        lines.failed(format!("element {tag} has node {node}, which does not exist"))
                    })
                })
                .collect();
            let corners = corners?;
            if let Ok(nodes) = <[usize; 8]>::try_from(corners.as_slice())
                && kind == HEXAHEDRON
            {
                mesh.hexahedra.push((tag, nodes, names.clone()));
                continue;
            }
            for name in names {
                let group = groups.entry(name.clone()).or_default();
                group.nodes.extend(&corners);
                let faces = group.faces.get_or_insert_default();
                match <[usize; 4]>::try_from(corners.as_slice()) {
                    Ok(face) if kind == QUADRILATERAL => faces.push(face),
                    _ => group.other = Some(format!("element {tag}, a {word}")),
                }
            }
        }
    }
    mesh.groups = groups;
    Ok(())
}
