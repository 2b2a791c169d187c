//! VTK's XML files of unstructured grids (`.vtu`) and of series of them (`.pvd`), as ParaView reads them.
//!
//! Format: VTK File Formats, "XML File Formats". The data are appended in raw form, little-endian, and each array follows
//! its number of bytes.

use std::fmt::Write as _;
use std::io::{self, Write};

/// VTK's number for a hexahedron of eight nodes.
const HEXAHEDRON: u8 = 12;

/// Values at the points.
pub enum Values {
    /// Numbers, with the number of components of a point.
    Numbers(usize, Vec<f32>),
    /// Small integers, one for each point.
    Codes(Vec<i8>),
}

/// A named array of values at the points.
pub struct PointData {
    /// Its name.
    pub name: &'static str,
    /// Names of its components; may be empty.
    pub components: &'static [&'static str],
    /// The values.
    pub values: Values,
}

/// What a file says about all of its grid.
pub struct GridInfo<'a> {
    /// The time [s], which ParaView shows.
    pub time_s: f64,
    /// Name of the array with the codes of a field, and each code with its meaning; none without such a field.
    pub codes: Option<(&'a str, &'a [(i8, &'a str)])>,
}

/// Writes a grid of hexahedra: points [m], cells of eight points in the order of VTK, and values at the points.
///
/// # Errors
/// Those of the writer.
pub fn write_grid(
    points_m: &[[f64; 3]],
    cells: &[[usize; 8]],
    data: &[PointData],
    info: &GridInfo,
    out: &mut impl Write,
) -> io::Result<()> {
    let mut arrays = Arrays::default();
    let mut header = format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n",
        field_data(info),
        points_m.len(),
        cells.len()
    );
    for array in data {
        header += &match &array.values {
            Values::Numbers(count, numbers) => {
                let bytes = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
                arrays.add("Float32", array.name, *count, array.components, bytes)
            }
            Values::Codes(codes) => {
                let bytes = codes.iter().flat_map(|x| x.to_le_bytes()).collect();
                arrays.add("Int8", array.name, 1, array.components, bytes)
            }
        };
    }
    let coordinates = points_m.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let connectivity = cells.iter().flatten().flat_map(|&point| (point as i64).to_le_bytes()).collect();
    let offsets = (1..=cells.len()).flat_map(|cell| (8 * cell as i64).to_le_bytes()).collect();
    header += "</PointData>\n<Points>\n";
    header += &arrays.add("Float64", "points", 3, &[], coordinates);
    header += "</Points>\n<Cells>\n";
    header += &arrays.add("Int64", "connectivity", 1, &[], connectivity);
    header += &arrays.add("Int64", "offsets", 1, &[], offsets);
    header += &arrays.add("UInt8", "types", 1, &[], vec![HEXAHEDRON; cells.len()]);
    header += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    out.write_all(header.as_bytes())?;
    out.write_all(&arrays.bytes)?;
    out.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// The element with the time and the codes. VTK takes an array called `TimeValue` for the time of a file. The codes are the
/// components of one array, because programs show the names of components, and because meshio reads no texts.
fn field_data(info: &GridInfo) -> String {
    let mut element = format!(
        "<FieldData>\n\
         <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{:e}</DataArray>\n",
        info.time_s
    );
    let Some((name, codes)) = info.codes else { return element + "</FieldData>\n" };
    let _ = write!(
        element,
        "<DataArray type=\"Int8\" Name=\"{name}\" NumberOfTuples=\"1\" NumberOfComponents=\"{}\"",
        codes.len()
    );
    for (number, (_, meaning)) in codes.iter().enumerate() {
        let _ = write!(element, " ComponentName{number}=\"{meaning}\"");
    }
    let numbers: Vec<String> = codes.iter().map(|(code, _)| code.to_string()).collect();
    let _ = write!(element, " format=\"ascii\">{}</DataArray>\n</FieldData>\n", numbers.join(" "));
    element
}

/// Writes the list of the files of a series, each with its time [s].
///
/// # Errors
/// Those of the writer.
pub fn write_series<'a>(files: impl Iterator<Item = (f64, &'a str)>, out: &mut impl Write) -> io::Result<()> {
    out.write_all(
        b"<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n",
    )?;
    for (time, file) in files {
        writeln!(out, "<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>")?;
    }
    out.write_all(b"</Collection>\n</VTKFile>\n")
}

/// The appended data.
#[derive(Default)]
struct Arrays {
    bytes: Vec<u8>,
}

impl Arrays {
    /// Appends an array and returns the XML element that refers to it.
    fn add(&mut self, kind: &str, name: &str, count: usize, components: &[&str], bytes: Vec<u8>) -> String {
        let mut element =
            format!("<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{count}\"");
        for (number, component) in components.iter().enumerate() {
            let _ = write!(element, " ComponentName{number}=\"{component}\"");
        }
        let _ = writeln!(element, " format=\"appended\" offset=\"{}\"/>", self.bytes.len());
        self.bytes.extend((bytes.len() as u64).to_le_bytes());
        self.bytes.extend(bytes);
        element
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: the elements have the names and the nesting of VTK's format, also where neither VTK nor meshio is
    /// installed to read a file.
    #[test]
    fn elements_are_those_of_the_format() {
        let values = Values::Codes(vec![0; 8]);
        let data = [PointData { name: "state", components: &[], values }];
        let info = GridInfo { time_s: 1.25e-3, codes: Some(("codes", &[(-1, "none"), (2, "slip")])) };
        let mut file = Vec::new();
        write_grid(&[[0.0; 3]; 8], &[[0, 1, 2, 3, 4, 5, 6, 7]], &data, &info, &mut file).unwrap();
        // The appended data are no text.
        let text = String::from_utf8_lossy(&file);
        let header = format!("{}</VTKFile>", text.split_once("<AppendedData").unwrap().0);
        let document = roxmltree::Document::parse(&header).unwrap();
        let path = |element: roxmltree::Node| {
            let mut names: Vec<&str> = element.ancestors().map(|node| node.tag_name().name()).collect();
            names.reverse();
            names.join("/")
        };
        let arrays = document.descendants().filter(|node| node.has_tag_name("DataArray"));
        let found: Vec<_> =
            arrays.map(|array| (path(array.parent().unwrap()), array.attribute("Name").unwrap())).collect();
        let inline = document.descendants().filter(|node| node.attribute("format") == Some("ascii"));
        let inline: Vec<_> =
            inline.map(|array| (array.text().unwrap(), array.attribute("ComponentName1"))).collect();
        assert_eq!(inline, [("1.25e-3", None), ("-1 2", Some("slip"))]);
        let field_data = "/VTKFile/UnstructuredGrid/FieldData".to_owned();
        let piece = "/VTKFile/UnstructuredGrid/Piece";
        let [point_data, points, cells] =
            ["PointData", "Points", "Cells"].map(|name| format!("{piece}/{name}"));
        assert_eq!(
            found,
            [
                (field_data.clone(), "TimeValue"),
                (field_data, "codes"),
                (point_data, "state"),
                (points, "points"),
                (cells.clone(), "connectivity"),
                (cells.clone(), "offsets"),
                (cells, "types"),
            ]
        );
    }
}
