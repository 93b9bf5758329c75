//! Which properties of a vertex, and which of a face, mean what.

use super::header::{Element, Header, Property};
use super::numbers::Values;
use crate::scene::Mesh;
use crate::scene::load::image::srgb_to_linear;
use glam::{Vec2, Vec3};

/// Names of the parts of a colour. Mitsuba writes the last ones.
const COLORS: [[&str; 3]; 4] = [
    ["red", "green", "blue"],
    ["r", "g", "b"],
    ["diffuse_red", "diffuse_green", "diffuse_blue"],
    ["color_0", "color_1", "color_2"],
];

/// Names of texture coordinates.
const UVS: [[&str; 2]; 5] =
    [["s", "t"], ["u", "v"], ["texture_u", "texture_v"], ["texture_s", "texture_t"], ["uv_0", "uv_1"]];

/// The properties that together are something.
fn find<const N: usize>(element: &Element, names: [&str; N]) -> Option<[usize; N]> {
    let mut places = [0; N];
    for (place, name) in places.iter_mut().zip(names) {
        *place = element.find(&[name])?;
    }
    Some(places)
}

/// Properties of `element` that are a colour: codes of sRGB if they are integers, linear if not.
pub(super) struct Color {
    columns: [usize; 3],
    full_scale: f64,
    /// What the codes of a byte stand for.
    table: Option<Vec<f32>>,
    is_encoded: bool,
}

impl Color {
    pub fn find(element: &Element) -> Option<Self> {
        let columns = COLORS.into_iter().find_map(|names| find(element, names))?;
        let item = element.properties[columns[0]].item;
        let codes = 0..=255u8;
        let decode = |code| srgb_to_linear(f64::from(code) / 255.0) as f32;
        Some(Self {
            columns,
            full_scale: item.full_scale(),
            table: (item.full_scale() == 255.0).then(|| codes.map(decode).collect()),
            is_encoded: !item.is_float(),
        })
    }

    /// Linear; NaN becomes 0.
    pub fn value(&self, values: &Values) -> Vec3 {
        Vec3::from_array(self.columns.map(|column| {
            let code = values.scalars[column];
            if let Some(linear) = self.table.as_ref().and_then(|table| table.get(code as usize)) {
                return *linear;
            }
            let value = code / self.full_scale;
            let value = if self.is_encoded { srgb_to_linear(value) } else { value };
            if value > 0.0 { value.min(1e6) as f32 } else { 0.0 }
        }))
    }
}

/// The properties of the element `vertex` that are used.
pub(super) struct Columns {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    color: Option<Color>,
}

impl Columns {
    pub fn find(element: &Element) -> Result<Self, String> {
        let Some(position) = find(element, ["x", "y", "z"]) else {
            return Err("element vertex has no properties x, y, z".to_owned());
        };
        Ok(Self {
            position,
            normal: find(element, ["nx", "ny", "nz"]),
            uv: UVS.into_iter().find_map(|names| find(element, names)),
            color: Color::find(element),
        })
    }

    /// Appends the vertex.
    pub fn push(&self, values: &Values, mesh: &mut Mesh) -> Result<(), String> {
        let vector = |columns: [usize; 3]| Vec3::from_array(columns.map(|c| values.scalars[c] as f32));
        let position = vector(self.position);
        if !position.is_finite() {
            return Err(format!("the position {position} is not finite"));
        }
        mesh.positions.push(position);
        if let Some(columns) = self.normal {
            mesh.normals.push(vector(columns));
        }
        if let Some(columns) = self.uv {
            let uv = Vec2::from_array(columns.map(|c| values.scalars[c] as f32));
            mesh.uvs.push(if uv.is_finite() { uv } else { Vec2::ZERO });
        }
        if let Some(color) = &self.color {
            mesh.colors.push(color.value(values));
        }
        Ok(())
    }

    fn uses(&self, column: usize) -> bool {
        self.position.contains(&column)
            || self.normal.is_some_and(|columns| columns.contains(&column))
            || self.uv.is_some_and(|columns| columns.contains(&column))
            || self.color.as_ref().is_some_and(|color| color.columns.contains(&column))
    }
}

/// Whether vertices have colours, so that faces need none.
pub(super) fn has_colors(header: &Header) -> bool {
    let vertex = header.elements.iter().find(|element| element.name == "vertex");
    vertex.and_then(Color::find).is_some()
}

/// What of the file a picture does not show, in the order of the header: `vertex quality`, `element edge`.
pub(super) fn unused(header: &Header) -> Vec<String> {
    let mut found = Vec::new();
    let mut has_vertices = false;
    for element in &header.elements {
        let name = element.name.as_str();
        let vertex = if name == "vertex" && !has_vertices { Columns::find(element).ok() } else { None };
        has_vertices |= vertex.is_some();
        let is_face = name == "face";
        if vertex.is_none() && !is_face && name != "tristrips" {
            found.push(format!("element {name}"));
            continue;
        }
        let color = if is_face && !has_colors(header) { Color::find(element) } else { None };
        let is_used = |(column, property): &(usize, &Property)| match (&vertex, property.name.as_str()) {
            (Some(vertex), _) => vertex.uses(*column),
            (None, "vertex_indices" | "vertex_index") => property.length.is_some(),
            (None, "texcoord") if is_face => property.length.is_some(),
            (None, "texnumber") if is_face => header.textures.len() > 1,
            _ => color.as_ref().is_some_and(|color| color.columns.contains(column)),
        };
        let rest = element.properties.iter().enumerate().filter(|property| !is_used(property));
        found.extend(rest.map(|(_, property)| format!("{name} {}", property.name)));
    }
    found
}
