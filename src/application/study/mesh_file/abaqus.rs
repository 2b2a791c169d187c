//! Abaqus input: `*NODE`, `*ELEMENT` of the types C3D8, `*NSET` and `*ELSET`, without parts and instances.
//!
//! A set of nodes is a group. Its faces are those on the surface whose nodes are all in the set. A set of elements is a body.

use super::{FileMesh, Group};
use std::collections::{BTreeMap, HashMap};

/// A message and its line.
type Failed = (usize, String);

/// What the data lines of a keyword are.
enum Section {
    /// Their numbers are not needed.
    Other,
    Nodes {
        set: Option<String>,
    },
    Elements {
        set: Option<String>,
        pending: Vec<u64>,
    },
    NodeSet {
        name: String,
        generates: bool,
    },
    ElementSet {
        name: String,
        generates: bool,
    },
}

/// Beginnings of the types of solid elements.
const SOLIDS: [&str; 3] = ["C3D", "CSS", "SC"];

/// A range of a set may be so many times as long as there are numbers: they need not be consecutive.
const MOST_SPARSE: usize = 1000;

/// Keywords that describe a mesh in a way that is not read.
const REFUSED: [&str; 9] =
    ["INCLUDE", "INSTANCE", "NGEN", "NFILL", "NCOPY", "ELGEN", "NMAP", "SYSTEM", "TRANSFORM"];

/// What has been read.
#[derive(Default)]
struct Reader {
    nodes: Vec<[f64; 3]>,
    numbers: Vec<u64>,
    index_of: HashMap<u64, usize>,
    elements: BTreeMap<u64, [usize; 8]>,
    node_sets: BTreeMap<String, Vec<u64>>,
    element_sets: BTreeMap<String, Vec<u64>>,
}

pub(super) fn read(text: &str) -> Result<FileMesh, Failed> {
    let mut reader = Reader::default();
    let mut section = Section::Other;
    let mut last = 1;
    for (index, line) in text.lines().enumerate() {
        let (number, line) = (index + 1, line.trim());
        last = number;
        if line.is_empty() || line.starts_with("**") {
            continue;
        }
        let done = match line.strip_prefix('*') {
            Some(_) if section.is_incomplete() => {
                Err("the element before this line is not complete".to_owned())
            }
            Some(keyword) => keyword_section(keyword).map(|next| section = next),
            None => reader.data(line, &mut section),
        };
        done.map_err(|message| (number, message))?;
    }
    reader.mesh().map_err(|message| (last, message))
}

impl Section {
    fn is_incomplete(&self) -> bool {
        matches!(self, Self::Elements { pending, .. } if !pending.is_empty())
    }
}

impl Reader {
    /// Takes a data line.
    fn data(&mut self, line: &str, section: &mut Section) -> Result<(), String> {
        let entries: Vec<&str> = line.trim_end_matches(',').split(',').map(str::trim).collect();
        match section {
            Section::Other => {}
            Section::Nodes { set } => {
                let id = whole(entries[0])?;
                self.node(id, &entries[1..])?;
                if let Some(set) = set {
                    self.node_sets.entry(set.clone()).or_default().push(id);
                }
            }
            Section::Elements { set, pending } => {
                for entry in entries {
                    pending.push(whole(entry)?);
                }
                // The nodes of an element may go on in the next line.
                if pending.len() < 9 {
                    return Ok(());
                }
                let numbers = std::mem::take(pending);
                self.element(&numbers)?;
                if let Some(set) = set {
                    self.element_sets.entry(set.clone()).or_default().push(numbers[0]);
                }
            }
            Section::NodeSet { name, generates } => {
                let is_known = |id: &u64| self.index_of.contains_key(id);
                let known = self.nodes.len();
                let members = members(&entries, *generates, &self.node_sets, known, is_known)?;
                self.node_sets.entry(name.clone()).or_default().extend(members);
            }
            Section::ElementSet { name, generates } => {
                let is_known = |id: &u64| self.elements.contains_key(id);
                let known = self.elements.len();
                let members = members(&entries, *generates, &self.element_sets, known, is_known)?;
                self.element_sets.entry(name.clone()).or_default().extend(members);
            }
        }
        Ok(())
    }

    fn node(&mut self, id: u64, coordinates: &[&str]) -> Result<(), String> {
        let mut x = [0.0; 3];
        for (axis, x) in x.iter_mut().enumerate() {
            let entry = coordinates.get(axis).copied().unwrap_or("");
            let value = entry.parse::<f64>().ok().filter(|x| x.is_finite());
            *x = value.ok_or_else(|| format!("`{entry}`: expected coordinate {} of node {id}", axis + 1))?;
        }
        if self.index_of.insert(id, self.nodes.len()).is_some() {
            return Err(format!("node {id} is repeated"));
        }
        self.nodes.push(x);
        self.numbers.push(id);
        Ok(())
    }

    fn element(&mut self, numbers: &[u64]) -> Result<(), String> {
        let &[id, ref corners @ ..] = numbers else { return Ok(()) };
        if u32::try_from(id).is_err() {
            return Err(format!("element {id}: expected a number up to {}", u32::MAX));
        }
        if corners.len() != 8 {
            return Err(format!("element {id} has {} nodes: expected 8 of a C3D8", corners.len()));
        }
        let mut nodes = [0; 8];
        for (node, number) in nodes.iter_mut().zip(corners) {
            let index = self.index_of.get(number).copied();
            *node = index
                .ok_or_else(|| format!("element {id} has node {number}, which does not exist before it"))?;
        }
        match self.elements.insert(id, nodes) {
            None => Ok(()),
            Some(_) => Err(format!("element {id} is repeated")),
        }
    }

    fn mesh(self) -> Result<FileMesh, String> {
        let mut groups = BTreeMap::new();
        for (name, ids) in self.node_sets {
            let index = |id: &u64| {
                let index = self.index_of.get(id).copied();
                index.ok_or_else(|| format!("set {name:?} has node {id}, which does not exist"))
            };
            let nodes = ids.iter().map(index).collect::<Result<_, _>>()?;
            groups.insert(name, Group { nodes, ..Group::default() });
        }
        let mut bodies: HashMap<u64, Vec<String>> = HashMap::new();
        for (name, ids) in self.element_sets {
            for id in ids {
                let names = bodies.entry(id).or_default();
                if !names.contains(&name) {
                    names.push(name.clone());
                }
            }
        }
        let hexahedra = self.elements.into_iter();
        let hexahedra =
            hexahedra.map(|(id, nodes)| (id, nodes, bodies.remove(&id).unwrap_or_default())).collect();
        Ok(FileMesh { nodes: self.nodes, numbers: self.numbers, hexahedra, groups })
    }
}

fn whole(entry: &str) -> Result<u64, String> {
    entry.parse::<u64>().map_err(|_| format!("`{entry}`: expected a whole number"))
}

fn keyword_section(keyword: &str) -> Result<Section, String> {
    let mut words = keyword.split(',').map(str::trim);
    let name = words.next().unwrap_or_default().to_uppercase();
    let options: Vec<(String, String)> = words
        .map(|word| {
            let (key, value) = word.split_once('=').unwrap_or((word, ""));
            (key.trim().to_uppercase(), value.trim().trim_matches('"').to_owned())
        })
        .collect();
    let option = |key: &str| options.iter().find(|(found, _)| found == key).map(|(_, value)| value.clone());
    let set = |key: &str| option(key).ok_or_else(|| format!("*{name} without {key}"));
    let generates = option("GENERATE").is_some();
    if let Some(file) = option("INPUT").filter(|_| !REFUSED.contains(&name.as_str())) {
        return Err(format!("*{name} with INPUT={file}: expected the data in this file"));
    }
    let system = option("SYSTEM").filter(|system| name == "NODE" && !system.eq_ignore_ascii_case("R"));
    if let Some(system) = system {
        return Err(format!("*NODE with SYSTEM={system}: expected Cartesian coordinates, SYSTEM=R"));
    }
    match name.as_str() {
        "NODE" => Ok(Section::Nodes { set: option("NSET") }),
        "ELEMENT" => {
            let kind = option("TYPE").unwrap_or_default().to_uppercase();
            // Faces and lines are not needed: groups are sets of nodes.
            if !SOLIDS.iter().any(|solid| kind.starts_with(solid)) {
                return Ok(Section::Other);
            }
            if kind.trim_start_matches("C3D8").starts_with(|next: char| next.is_ascii_digit())
                || !kind.starts_with("C3D8")
            {
                return Err(format!("*ELEMENT of the type {kind:?}: expected hexahedra with 8 nodes, C3D8"));
            }
            Ok(Section::Elements { set: option("ELSET"), pending: Vec::new() })
        }
        "NSET" => Ok(Section::NodeSet { name: set("NSET")?, generates }),
        "ELSET" => Ok(Section::ElementSet { name: set("ELSET")?, generates }),
        other if REFUSED.contains(&other) => {
            Err(format!("*{other} is not read: expected one mesh with *NODE and *ELEMENT in this file"))
        }
        _ => Ok(Section::Other),
    }
}

/// The members of a set that a data line names: numbers, other sets, or a range with its step.
///
/// Numbers in a range that nothing has are passed over, as by Abaqus. `known` nodes or elements exist before this line.
fn members(
    entries: &[&str],
    generates: bool,
    sets: &BTreeMap<String, Vec<u64>>,
    known: usize,
    is_known: impl Fn(&u64) -> bool,
) -> Result<Vec<u64>, String> {
    let number =
        |entry: &str| entry.parse::<u64>().map_err(|_| format!("`{entry}`: expected a whole number"));
    if generates {
        let numbers = entries.iter().map(|entry| number(entry)).collect::<Result<Vec<_>, _>>()?;
        let (first, last, step) = match numbers[..] {
            [first, last] => (first, last, 1),
            [first, last, step] if step > 0 => (first, last, step),
            _ => return Err("expected the first number, the last one and the step".to_owned()),
        };
        if last < first {
            return Err(format!("a range from {first} to {last}: expected the smaller number first"));
        }
        let count = (last - first) / step + 1;
        if count > (MOST_SPARSE * known.max(1)) as u64 {
            return Err(format!("a range of {count} numbers, but there are {known} before this line"));
        }
        let numbers = (0..count).map(|number| first + number * step);
        return Ok(numbers.filter(is_known).collect());
    }
    let mut found = Vec::new();
    for entry in entries {
        match sets.get(*entry) {
            Some(set) => found.extend(set),
            None => found.push(whole(entry)?),
        }
    }
    Ok(found)
}
