//! Further properties of vertices and faces under names, as Mitsuba 3 has them.
//!
//! Neighbouring properties `weight_0`, or `flow_x`, `flow_y` and `flow_z`, are one attribute `vertex_weight`, `face_flow`; the
//! endings are x y z, 0 1 2, 1 2 3 or r g b, which make `vertex_paint_color` of `paint_r`... Colours without a name, `r` or `red`
//! and so on, are `vertex_color` and `face_color`. Attributes have one or three numbers.
//! Source: Mitsuba 3 documentation, plugin `ply`.

use super::header::Element;
use super::numbers::Values;
use crate::scene::load::image::srgb_to_linear;
use glam::Vec3;

/// One value for each vertex, or for each triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribute {
    pub name: String,
    pub on_faces: bool,
    /// A single number stands in all three places.
    pub values: Vec<Vec3>,
}

/// How the members of an attribute end, and what its name then ends with.
const ENDINGS: [([&str; 3], &str); 4] =
    [(["x", "y", "z"], ""), (["r", "g", "b"], "_color"), (["0", "1", "2"], ""), (["1", "2", "3"], "")];
/// Colours without a name.
const COLORS: [[&str; 3]; 2] = [["r", "g", "b"], ["red", "green", "blue"]];

/// The properties of an element that are one attribute.
pub(super) struct Columns {
    pub attribute: Attribute,
    /// One or three.
    columns: Vec<usize>,
    /// Codes to be decoded have this full scale.
    full_scale: Option<f64>,
}

impl Columns {
    /// All attributes of `vertex` or `face`.
    pub fn find(element: &Element) -> Vec<Self> {
        let mut found = Vec::new();
        let mut add = |name: String, columns: Vec<usize>, is_color: bool| {
            let on_faces = element.name == "face";
            let attribute = Attribute { name: format!("{}_{name}", element.name), on_faces, values: Vec::new() };
            let item = element.properties[columns[0]].item;
            let full_scale = (is_color && !item.is_float()).then(|| item.full_scale());
            found.push(Self { attribute, columns, full_scale });
        };
        let plain = COLORS.iter().find_map(|names| {
            let places: Option<Vec<usize>> = names.iter().map(|name| element.find(&[name])).collect();
            places
        });
        if let Some(columns) = plain {
            add("color".to_owned(), columns, true);
        }
        let ending = |at: usize| {
            let property = element.properties.get(at).filter(|property| property.length.is_none())?;
            property.name.rsplit_once('_').filter(|(prefix, _)| !prefix.is_empty())
        };
        let mut at = 0;
        while at < element.properties.len() {
            let start = at;
            at += 1;
            let Some((prefix, first)) = ending(start) else { continue };
            let Some((endings, suffix)) = ENDINGS.iter().find(|(endings, _)| endings[0] == first) else { continue };
            while at - start < 3 && ending(at) == Some((prefix, endings[at - start])) {
                at += 1;
            }
            if at - start != 2 {
                add(format!("{prefix}{suffix}"), (start..at).collect(), *suffix == "_color");
            }
        }
        found
    }

    /// Appends the value of one element `times` times: as often as it makes triangles.
    pub fn push(&mut self, values: &Values, times: usize) {
        let number = |column: &usize| {
            let value = values.scalars[*column];
            let value = self.full_scale.map_or(value, |full| srgb_to_linear(value / full));
            if value.is_finite() { value as f32 } else { 0.0 }
        };
        let value = match self.columns.as_slice() {
            [r, g, b] => Vec3::new(number(r), number(g), number(b)),
            columns => Vec3::splat(columns.first().map_or(0.0, number)),
        };
        self.attribute.values.extend(std::iter::repeat_n(value, times));
    }
}
