//! The pin.

use super::base::Base;
use super::check::Violations;
use super::elasticity;
use super::mesh::MeshFile;
use super::plasticity::Plasticity;
use super::strains::{MaterialLaw, Strains};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strum::IntoStaticStr;

/// Largest number of elements in all: about a gigabyte of fields, and days of run time.
const MAX_TOTAL_ELEMENTS: f64 = 2.0e6;

/// Fewest elements over the diameter of a cylinder: a core and a ring around it.
pub const FEWEST_ACROSS: usize = 3;

/// The shape of a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Shape {
    /// A block of nx × ny × nz equal hexahedra.
    #[default]
    Block,
    /// A cylinder of the diameter `diameter_m` whose axis is z. Elements in x and y are the same number, that over the diameter.
    Cylinder,
    /// The hexahedra of a file.
    Mesh,
}

impl Shape {
    /// The name used in study files.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether it is a block.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde calls")]
    fn is_block(&self) -> bool {
        *self == Self::Block
    }
}

/// The element of a pin or of an elastic disk. An upright block of one material with another one than `full` is computed as a general mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, IntoStaticStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum Element {
    /// Trilinear, with full integration. It bends too stiffly where few elements lie across.
    #[default]
    Full,
    /// The same with three modes of its own for each component of the displacements, which let it bend (Taylor, Beresford and Wilson
    /// 1976). A time step costs the same.
    Incompatible,
    /// The same with the mean of the change of volume over the element, which does not lock where ν is near ½ (Nagtegaal, Parks and Rice
    /// 1974).
    Selective,
}

impl Element {
    /// Whether it is the one that a study has if it gives none.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde calls")]
    pub(super) fn is_full(&self) -> bool {
        *self == Self::Full
    }
}

/// A region of the pin with another material, for example the backing plate of a pad.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Height (m) above the base from which the region of a block or a cylinder reaches to the top, or to the next region. It must be a
    /// plane of nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub above_m: Option<f64>,
    /// Group of elements of a mesh from a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// Young's modulus (Pa).
    pub young_modulus_pa: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poisson_ratio: f64,
    /// Density [kg/m³].
    pub density_kg_m3: f64,
    /// When it yields, in a pin of the material `j2`. Absent: it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<Plasticity>,
}

/// Elements of the core of a cylinder in x and in y, for this number of elements over the diameter. About a quarter of them, and at
/// least one, are rings on each side.
pub fn core_elements(across: usize) -> usize {
    let rings = ((across + 2) / 4).clamp(1, (across.max(3) - 1) / 2);
    across.saturating_sub(2 * rings)
}

/// The pin: an elastic body meshed with trilinear hexahedra.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Pin {
    /// Its shape.
    #[serde(skip_serializing_if = "Shape::is_block")]
    pub shape: Shape,
    /// Diameter (m) of a cylinder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diameter_m: Option<f64>,
    /// The mesh of a pin of the shape `mesh`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<Box<MeshFile>>,
    /// Edge lengths (m) in x (radial), y (sliding direction) and z. A cylinder uses z only. A mesh from a file must have this extent.
    pub size_m: [f64; 3],
    /// Number of elements in x, y and z.
    pub elements: [usize; 3],
    /// The element.
    #[serde(skip_serializing_if = "Element::is_full")]
    pub element: Element,
    /// The strains.
    #[serde(skip_serializing_if = "Strains::is_small")]
    pub strains: Strains,
    /// The law of the material with finite strains.
    #[serde(skip_serializing_if = "MaterialLaw::is_neo_hookean")]
    pub material: MaterialLaw,
    /// When a material of the law `j2` yields.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<Plasticity>,
    /// Young's modulus (Pa).
    pub young_modulus_pa: f64,
    /// Poisson's ratio, −1 < ν < 0.5.
    pub poisson_ratio: f64,
    /// Density [kg/m³].
    pub density_kg_m3: f64,
    /// How its base differs from a plane.
    pub base: Base,
    /// Angle (°) by which the pin is turned about x. A positive angle lifts its trailing end. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_x_deg: Option<f64>,
    /// Angle (°) by which the pin is turned about y, before that about x. A positive angle lifts its inner side. Absent: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt_y_deg: Option<f64>,
    /// Regions of other materials, from the base upwards.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<Region>,
}

impl Default for Pin {
    fn default() -> Self {
        Self {
            size_m: [0.012, 0.015, 0.010],
            elements: [12, 15, 10],
            element: Element::Full,
            strains: Strains::Small,
            material: MaterialLaw::NeoHookean,
            plasticity: None,
            young_modulus_pa: 1.0e9,
            poisson_ratio: 0.3,
            density_kg_m3: 2500.0,
            base: Base::default(),
            shape: Shape::Block,
            diameter_m: None,
            mesh: None,
            tilt_x_deg: None,
            tilt_y_deg: None,
            regions: Vec::new(),
        }
    }
}

impl Pin {
    /// Time \[s\] in which a shear wave crosses the pin's height; NaN for an unphysical material.
    pub fn shear_transit_s(&self) -> f64 {
        self.extent_m()[2]
            / elasticity::shear_wave_speed_m_s(self.young_modulus_pa, self.poisson_ratio, self.density_kg_m3)
    }

    /// When each material yields: that of the pin, and those of its regions.
    pub fn plasticity_of_materials(&self) -> Vec<Option<Plasticity>> {
        let regions = self.regions.iter().map(|region| region.plasticity.clone());
        std::iter::once(self.plasticity.clone()).chain(regions).collect()
    }

    /// Whether the pin is an upright block of one material, for which there is a faster form of the stiffness.
    pub fn is_plain_block(&self) -> bool {
        self.shape == Shape::Block
            && self.element == Element::Full
            && self.strains == Strains::Small
            && self.regions.is_empty()
            && !self.is_tilted()
    }

    /// Whether the base is a plane that is parallel to the disk. A mesh from a file may have any base.
    pub fn has_plane_base(&self) -> bool {
        self.base.is_flat() && !self.is_tilted() && self.shape != Shape::Mesh
    }

    fn is_tilted(&self) -> bool {
        [self.tilt_x_deg, self.tilt_y_deg].into_iter().flatten().any(|angle| angle != 0.0)
    }

    /// Elements in x, y and z; returns `None` if the mesh is from a file.
    pub fn own_elements(&self) -> Option<[usize; 3]> {
        (self.shape != Shape::Mesh).then_some(self.elements)
    }

    /// Extent \[m\] in x, y and z, without tilt.
    pub fn extent_m(&self) -> [f64; 3] {
        let of_mesh = self.mesh.as_ref().and_then(|mesh| mesh.extent_m);
        match (self.shape, self.diameter_m, of_mesh) {
            (Shape::Cylinder, Some(diameter), _) => [diameter, diameter, self.size_m[2]],
            (Shape::Mesh, _, Some(extent_m)) => extent_m,
            _ => self.size_m,
        }
    }

    /// Edges \[m\] of the elements in x, y and z. Those of a mesh from a file are the largest ones in x and y of its contact face, and the
    /// mean one in z.
    pub fn element_edges_m(&self) -> [f64; 3] {
        let extent_m = self.extent_m();
        match self.mesh.as_ref().and_then(|mesh| mesh.contact_edges_m) {
            Some([x, y]) if self.shape == Shape::Mesh => [x, y, extent_m[2] / self.layers()],
            _ => std::array::from_fn(|axis| extent_m[axis] / self.elements[axis] as f64),
        }
    }

    /// Mean number of elements over the height.
    fn layers(&self) -> f64 {
        let faces = self.mesh.as_ref().and_then(|mesh| mesh.contact_faces).unwrap_or(1);
        (self.element_count() / faces as f64).max(1.0)
    }

    /// Mass \[kg\] of a block or a cylinder with its regions; `None` for a mesh from a file.
    pub fn mass_kg(&self) -> Option<f64> {
        if self.shape == Shape::Mesh {
            return None;
        }
        let height_m = self.extent_m()[2];
        let mut ends: Vec<f64> = self.regions.iter().filter_map(|region| region.above_m).collect();
        ends.extend([0.0, height_m]);
        ends.retain(|end_m| (0.0..=height_m).contains(end_m));
        ends.sort_by(f64::total_cmp);
        let density_kg_m3 = |middle_m: f64| {
            let is_inside = |region: &&Region| region.above_m.is_some_and(|above_m| middle_m > above_m);
            // Of several regions the last one holds.
            self.regions.iter().rfind(is_inside).map_or(self.density_kg_m3, |region| region.density_kg_m3)
        };
        let per_area =
            ends.windows(2).map(|part| density_kg_m3(0.5 * (part[0] + part[1])) * (part[1] - part[0]));
        Some(self.base_area_m2() * per_area.sum::<f64>())
    }

    /// Mean volume \[m³\] of an element; of a mesh from a file, that of the box around it over its elements.
    pub fn element_volume_m3(&self) -> f64 {
        match self.shape {
            Shape::Mesh => self.extent_m().iter().product::<f64>() / self.element_count(),
            Shape::Block | Shape::Cylinder => self.element_edges_m().iter().product(),
        }
    }

    /// The mesh in words: `12×15×10`.
    pub fn mesh_words(&self) -> String {
        let [nx, ny, nz] = self.elements;
        match self.shape {
            Shape::Mesh => format!("{} elements", self.element_count()),
            Shape::Block | Shape::Cylinder => format!("{nx}×{ny}×{nz}"),
        }
    }

    /// Area \[m²\] of the base; of a mesh from a file, that of the rectangle around it.
    pub fn base_area_m2(&self) -> f64 {
        let [x, y, _] = self.extent_m();
        match self.shape {
            Shape::Block | Shape::Mesh => x * y,
            Shape::Cylinder => std::f64::consts::FRAC_PI_4 * x * y,
        }
    }

    /// Number of elements.
    pub fn element_count(&self) -> f64 {
        let [nx, ny, nz] = self.elements.map(|n| n as f64);
        let plane = match self.shape {
            Shape::Mesh => return self.mesh.as_ref().and_then(|mesh| mesh.hexahedra).unwrap_or(0) as f64,
            Shape::Block => nx * ny,
            Shape::Cylinder => {
                let core = core_elements(self.elements[0]) as f64;
                core * core + 2.0 * core * (nx - core)
            }
        };
        plane * nz
    }

    /// Number of nodes.
    pub fn node_count(&self) -> f64 {
        let [nx, ny, nz] = self.elements.map(|n| n as f64);
        let plane = match self.shape {
            Shape::Mesh => return self.mesh.as_ref().and_then(|mesh| mesh.nodes).unwrap_or(0) as f64,
            Shape::Block => (nx + 1.0) * (ny + 1.0),
            Shape::Cylinder => {
                let core = core_elements(self.elements[0]) as f64;
                (core + 1.0).powi(2) + 2.0 * core * (nx - core)
            }
        };
        plane * (nz + 1.0)
    }

    /// Adds every violated limit to `found`.
    pub(super) fn check(&self, found: &mut Violations) {
        for (axis, size) in self.size_m.iter().enumerate() {
            found.within(&format!("scene.pin.size_m[{axis}]"), *size);
        }
        for (axis, &count) in self.elements.iter().enumerate() {
            found.within(&format!("scene.pin.elements[{axis}]"), count as f64);
        }
        let total = self.element_count();
        if total > MAX_TOTAL_ELEMENTS {
            found.add(
                "scene.pin.elements",
                format!("{:?} ({total:e} elements)", self.elements),
                format!("at most {MAX_TOTAL_ELEMENTS:e} elements in all"),
            );
        }
        self.check_shape(found);
        let [lx, ly, _] = self.extent_m();
        let [hx, hy, _] = self.element_edges_m();
        self.base.check([lx, ly], [hx, hy], found);
        found.within("scene.pin.young_modulus_pa", self.young_modulus_pa);
        found.within("scene.pin.poisson_ratio", self.poisson_ratio);
        found.within("scene.pin.density_kg_m3", self.density_kg_m3);
        self.check_regions(found);
    }

    fn check_shape(&self, found: &mut Violations) {
        match (self.shape, self.diameter_m) {
            (Shape::Cylinder, None) => {
                found.add("scene.pin.diameter_m", "absent", "a diameter > 0 m of the cylinder");
            }
            (Shape::Cylinder, Some(diameter)) => _ = found.within("scene.pin.diameter_m", diameter),
            (Shape::Block | Shape::Mesh, Some(diameter)) => {
                let right = "absent, because only scene.pin.shape = cylinder has a diameter";
                found.add("scene.pin.diameter_m", diameter, right);
            }
            (Shape::Block | Shape::Mesh, None) => {}
        }
        match (self.shape, &self.mesh) {
            (Shape::Mesh, None) => found.add("scene.pin.mesh", "absent", "the file of a mesh"),
            (Shape::Mesh, Some(mesh)) => mesh.check(self.size_m, found),
            (Shape::Block | Shape::Cylinder, Some(_)) => {
                found.add("scene.pin.mesh", "a mesh", "absent, or scene.pin.shape = mesh");
            }
            (Shape::Block | Shape::Cylinder, None) => {}
        }
        let [across, also, _] = self.elements;
        if self.shape == Shape::Cylinder && (across != also || across < FEWEST_ACROSS) {
            let right = format!(
                "the same number in x and y, at least {FEWEST_ACROSS}: the elements over the diameter of a cylinder"
            );
            found.add("scene.pin.elements", format!("{:?}", self.elements), right);
        }
        found.within_if_given("scene.pin.tilt_x_deg", self.tilt_x_deg);
        found.within_if_given("scene.pin.tilt_y_deg", self.tilt_y_deg);
    }

    fn check_regions(&self, found: &mut Violations) {
        let (height, layers) = (self.size_m[2], self.elements[2] as f64);
        let mut below = 0.0;
        for (number, region) in self.regions.iter().enumerate() {
            let field = |name: &str| format!("scene.pin.regions[{number}].{name}");
            match (self.shape, region.above_m, &region.group) {
                (Shape::Mesh, None, Some(group))
                    if self.regions[..number].iter().any(|other| other.group.as_ref() == Some(group)) =>
                {
                    found.add(&field("group"), group, "another group: a region before it has this one");
                }
                (Shape::Mesh, None, Some(group)) => {
                    let bodies = self.mesh.as_ref().map_or(&[][..], |mesh| &mesh.bodies);
                    if !bodies.contains(group) {
                        let right = format!("a group of elements of the mesh: {}", bodies.join(", "));
                        found.add(&field("group"), group, right);
                    }
                }
                (Shape::Mesh, ..) => {
                    found.add(&field("group"), "absent", "a group of elements of the mesh, without above_m");
                }
                (_, Some(above), None) => {
                    let layer = above / height * layers;
                    let holds = above > below && above < height && (layer - layer.round()).abs() <= 1.0e-6;
                    let right = format!(
                        "a height between {below} m and {height} m at a multiple of {} m, the height of an element",
                        height / layers
                    );
                    found.require(&field("above_m"), above, holds, &right);
                    below = above;
                }
                _ => found.add(
                    &field("above_m"),
                    "absent",
                    "a height, without group, which is for meshes from files",
                ),
            }
            found.within(&field("young_modulus_pa"), region.young_modulus_pa);
            found.within(&field("poisson_ratio"), region.poisson_ratio);
            found.within(&field("density_kg_m3"), region.density_kg_m3);
        }
    }
}
