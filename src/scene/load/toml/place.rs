//! Where a thing stands: `scale`, `rotate`, `translate`, or `matrix`, or `transform`, a list of such steps.

use super::document::{Node, Value};
use super::format::{GRID, INSTANCE, STEP};
use super::keys::Range;
use super::reader::{Reader, Result, in_range, numbers};
use crate::scene::Transform;
use glam::{DAffine3, DVec3, Vec3};

/// Copies one object may have.
pub const MAX_COPIES: u64 = 1 << 20;

/// The transform that `table` (an object, an instance) writes.
pub fn read_place(table: &Reader) -> Result<Transform> {
    for key in ["scale", "rotate", "translate", "matrix"] {
        table.exclusive(key, "transform")?;
    }
    let transform = match table.array("transform")? {
        None => read_step(table)?,
        Some(steps) => {
            let mut transform = Transform::default();
            for node in steps {
                let step = Reader::open(table.document, node, &STEP)?;
                transform = transform.then(read_step(&step)?);
            }
            transform
        }
    };
    check(table, transform)
}

/// The keys of one step: scale, then rotate, then translate; or a matrix.
fn read_step(table: &Reader) -> Result<Transform> {
    for key in ["scale", "rotate", "translate"] {
        table.exclusive(key, "matrix")?;
    }
    if let Some(node) = table.node("matrix") {
        return read_matrix(table, node);
    }
    let mut transform = Transform::default();
    if let Some(scale) = table.number_or_numbers::<3>("scale", Range::ANY)? {
        if scale.contains(&0.0) {
            return Err(table.bad("scale", "\"scale\" must not be 0: nothing would be left to see"));
        }
        transform = Transform(DAffine3::from_scale(DVec3::from_array(scale)));
    }
    if let Some(rotation) = read_rotation(table)? {
        transform = transform.then(rotation);
    }
    if let Some(offset) = table.vector("translate")? {
        transform = transform.then(Transform::translate(offset));
    }
    Ok(transform)
}

/// The key `rotate`.
pub fn read_rotation(table: &Reader) -> Result<Option<Transform>> {
    let Some([x, y, z, degrees]) = table.numbers::<4>("rotate", Range::ANY)? else { return Ok(None) };
    let axis = Vec3::new(x as f32, y as f32, z as f32);
    if axis.as_dvec3().length() < 1.0e-9 {
        return Err(table.bad("rotate", "the axis of \"rotate\" must not have length 0"));
    }
    Ok(Some(Transform::rotate(axis, degrees.to_radians())))
}

fn read_matrix(table: &Reader, node: &Node) -> Result<Transform> {
    let Value::Array(rows) = &node.value else { return Err(table.mismatch("matrix", node)) };
    let rows: Option<Vec<[f64; 4]>> = rows.iter().map(|row| numbers::<4>(row, Range::ANY)).collect();
    let Some([x, y, z, w]) = rows.as_deref() else { return Err(table.mismatch("matrix", node)) };
    if *w != [0.0, 0.0, 0.0, 1.0] {
        return Err(table.bad("matrix", "the last row of \"matrix\" must be [0, 0, 0, 1]"));
    }
    let column = |i: usize| DVec3::new(x[i], y[i], z[i]);
    Ok(Transform(DAffine3::from_cols(column(0), column(1), column(2), column(3))))
}

/// Refuses what cannot be inverted or leaves the range of single precision.
pub fn check(table: &Reader, transform: Transform) -> Result<Transform> {
    let columns = [transform.0.x_axis, transform.0.y_axis, transform.0.z_axis];
    let size: f64 = columns.iter().map(|column| column.length()).product();
    let largest = columns.iter().map(|column| column.abs().max_element()).fold(0.0, f64::max);
    let moved = transform.0.translation.abs().max_element();
    let message = if transform.determinant().abs() <= 1.0e-9 * size {
        "the transform flattens the object: its axes are not independent"
    } else if largest > super::keys::LARGEST || moved > super::keys::LARGEST {
        "the transform moves the object out of the range of single precision"
    } else {
        return Ok(transform);
    };
    Err(table.document.bad(table.place, message))
}

/// One copy of an object: its transform after the object's own, and the table that may name another material.
#[derive(Clone, Copy, Debug)]
pub struct Copy<'a> {
    pub transform: Transform,
    pub table: Option<Reader<'a>>,
}

/// The copies that `instances` and `grid` ask for, a grid of each instance; one where there is neither.
pub fn read_copies<'a>(object: &Reader<'a>) -> Result<Vec<Copy<'a>>> {
    let mut copies = Vec::new();
    for table in object.tables("instances", &INSTANCE)? {
        copies.push(Copy { transform: read_place(&table)?, table: Some(table) });
    }
    if object.has("instances") && copies.is_empty() {
        return Err(object.bad("instances", "\"instances\" is empty: the object would be nowhere"));
    }
    if copies.is_empty() {
        copies.push(Copy { transform: Transform::default(), table: None });
    }
    let Some(grid) = object.table("grid", &GRID)? else { return Ok(copies) };
    let (count, spacing) = (read_count(&grid)?, grid.required("spacing", grid.vector("spacing")?)?);
    let total = count.iter().map(|n| u64::from(*n)).product::<u64>().saturating_mul(copies.len() as u64);
    if total > MAX_COPIES {
        return Err(grid.bad("count", format!("{total} copies of an object; at most {MAX_COPIES} are allowed")));
    }
    let cells = (0..count[2]).flat_map(|k| (0..count[1]).flat_map(move |j| (0..count[0]).map(move |i| [i, j, k])));
    let offset = |cell: [u32; 3]| {
        let axis = |a: usize| (f64::from(cell[a]) - f64::from(count[a] - 1) / 2.0) * f64::from(spacing[a]);
        Transform(DAffine3::from_translation(DVec3::new(axis(0), axis(1), axis(2))))
    };
    Ok(cells
        .flat_map(|cell| copies.iter().map(move |copy| (cell, *copy)))
        .map(|(cell, copy)| Copy { transform: copy.transform.then(offset(cell)), ..copy })
        .collect())
}

fn read_count(grid: &Reader) -> Result<[u32; 3]> {
    let Some(node) = grid.node("count") else { return grid.required("count", None) };
    let range = Range::new(1.0, MAX_COPIES as f64);
    let count = numbers::<3>(node, range).filter(|count| count.iter().all(|n| n.fract() == 0.0));
    debug_assert!(in_range(node, range).is_none() || count.is_none(), "a number is no array");
    count.map(|count| count.map(|n| n as u32)).ok_or_else(|| grid.mismatch("count", node))
}
