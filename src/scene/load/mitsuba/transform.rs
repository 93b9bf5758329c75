//! `<transform>`: steps in the order they are applied; and points.

use super::document::{Document, Node, Result};
use super::object::{no_number, parse, words};
use crate::scene::Transform;
use glam::{DAffine3, DMat3, DVec3};

/// Elements that may stand in a transform.
const STEPS: &[&str] = &["translate", "rotate", "scale", "lookat", "matrix"];
/// A determinant below this, relative to the size of the rows, is a flattened space.
const FLAT: f64 = 1e-12;

/// The affine map of a `<transform>`; invertible.
pub fn transform(document: &Document, node: Node) -> Result<Transform> {
    document.check_attributes(node, &["name", "id"])?;
    let mut result = DAffine3::IDENTITY;
    for child in document.children(node) {
        result = step(document, *child)? * result;
    }
    let m = result.matrix3;
    let size = m.x_axis.length() * m.y_axis.length() * m.z_axis.length();
    if !result.is_finite() || !(m.determinant().abs() > FLAT * size) {
        return Err(document.bad(node, "the transform flattens space: it has no inverse"));
    }
    Ok(Transform(result))
}

fn step(document: &Document, node: Node) -> Result<DAffine3> {
    match document.tag(node) {
        "translate" => Ok(DAffine3::from_translation(vector(document, node, 0.0, &[])?)),
        "scale" => Ok(DAffine3::from_scale(vector(document, node, 1.0, &[])?)),
        "rotate" => {
            let axis = vector(document, node, 0.0, &["angle"])?;
            let text = document.required(node, "angle")?;
            let Some(angle) = parse(text) else {
                return Err(document.bad_value(node, "angle", format!("expected an angle in degrees, found {text:?}")));
            };
            if !(axis.length() > 0.0) {
                return Err(document.bad(node, "<rotate> needs an axis, such as y=\"1\""));
            }
            Ok(Transform::rotate(axis.as_vec3(), angle.to_radians()).0)
        }
        "lookat" | "look_at" => look_at(document, node),
        "matrix" => matrix(document, node),
        tag => Err(document.bad(node, format!("<{tag}> is no step of a transform; steps are {}", STEPS.join(", ")))),
    }
}

/// x, y, z of an element with these attributes or all three in `value`; what is left out is `default`.
/// `others`: attributes the element may have beside them.
pub fn vector(document: &Document, node: Node, default: f64, others: &[&str]) -> Result<DVec3> {
    let mut allowed = vec!["value", "x", "y", "z"];
    allowed.extend(others);
    document.check_attributes(node, &allowed)?;
    let number = |attribute: &str| match document.attribute(node, attribute) {
        None => Ok(default),
        Some(text) => parse(text).ok_or_else(|| document.bad_value(node, attribute, no_number(text))),
    };
    if document.attribute(node, "value").is_none() {
        return Ok(DVec3::new(number("x")?, number("y")?, number("z")?));
    }
    if let Some(other) = ["x", "y", "z"].into_iter().find(|name| document.attribute(node, name).is_some()) {
        return Err(document.bad_value(node, other, "\"value\" and \"x\", \"y\", \"z\" exclude each other"));
    }
    match numbers(document, node, "value")?.as_slice() {
        [x] => Ok(DVec3::splat(*x)),
        [x, y, z] => Ok(DVec3::new(*x, *y, *z)),
        list => Err(document.bad_value(node, "value", format!("expected 1 or 3 numbers, found {}", list.len()))),
    }
}

/// The numbers of an attribute.
pub fn numbers(document: &Document, node: Node, attribute: &str) -> Result<Vec<f64>> {
    let text = document.required(node, attribute)?;
    let number = |word: &str| {
        parse(word).ok_or_else(|| document.bad_value(node, attribute, format!("expected numbers, found {word:?}")))
    };
    words(text).map(number).collect()
}

/// Camera space (x left, y up, z forward) to the world.
fn look_at(document: &Document, node: Node) -> Result<DAffine3> {
    document.check_attributes(node, &["origin", "target", "up"])?;
    let point = |name: &str| match numbers(document, node, name)?.as_slice() {
        [x, y, z] => Ok(DVec3::new(*x, *y, *z)),
        list => Err(document.bad_value(node, name, format!("expected 3 numbers, found {}", list.len()))),
    };
    let (origin, target) = (point("origin")?, point("target")?);
    let unit = |v: DVec3| {
        let length = libm::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        (length > 1e-12).then(|| v / length)
    };
    let Some(forward) = unit(target - origin) else {
        return Err(document.bad_value(node, "target", "\"origin\" and \"target\" are the same point"));
    };
    let up = if document.attribute(node, "up").is_some() { point("up")? } else { perpendicular(forward) };
    let Some(left) = unit(up.cross(forward)) else {
        return Err(document.bad_value(node, "up", "\"up\" is parallel to the view or has length 0"));
    };
    let matrix3 = DMat3::from_cols(left, forward.cross(left), forward);
    Ok(DAffine3 { matrix3, translation: origin })
}

/// Some direction across `v`: Mitsuba leaves the choice to its frames.
fn perpendicular(v: DVec3) -> DVec3 {
    if v.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y }
}

/// 16 or 9 numbers, row by row.
fn matrix(document: &Document, node: Node) -> Result<DAffine3> {
    document.check_attributes(node, &["value"])?;
    let m = numbers(document, node, "value")?;
    let row = |at: usize| DVec3::new(m[at], m[at + 1], m[at + 2]);
    match m.len() {
        9 => Ok(DAffine3::from_mat3(DMat3::from_cols(row(0), row(3), row(6)).transpose())),
        16 if m[12..15].iter().all(|v| *v == 0.0) && m[15] != 0.0 => {
            let matrix3 = DMat3::from_cols(row(0), row(4), row(8)).transpose();
            let translation = DVec3::new(m[3], m[7], m[11]);
            Ok(DAffine3 { matrix3: matrix3 * (1.0 / m[15]), translation: translation / m[15] })
        }
        16 => Err(document.bad_value(node, "value", "the last row of an affine matrix is 0 0 0 1")),
        count => Err(document.bad_value(node, "value", format!("expected 16 or 9 numbers, found {count}"))),
    }
}
