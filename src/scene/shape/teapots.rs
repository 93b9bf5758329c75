//! A field of teapots.

use super::noise::hash3;
use crate::scene::Transform;
use glam::{DAffine3, DVec3, Vec3};

/// Teapots of a field at most.
pub const TEAPOTS_MAX: u64 = 1 << 20;
/// Between rows and columns; a teapot is 6.434 long.
const SPACING: f64 = 7.5;

/// Where `count` teapots (1 to `TEAPOTS_MAX`) stand: in a square around the origin on y = 0, every second row shifted, each
/// turned and up to an eighth smaller or larger by a hash of its number.
pub fn teapot_field(count: u64) -> Vec<Transform> {
    debug_assert!((1..=TEAPOTS_MAX).contains(&count), "{count} teapots");
    let side = field_side(count);
    let middle = (f64::from(side) - 1.0) / 2.0;
    let place = |number: u32| {
        let (column, row) = (number % side, number / side);
        let random = |k: u32| f64::from(hash3(number, k, 0x7ea9)) / 4_294_967_296.0;
        let shift = if row % 2 == 0 { -0.25 } else { 0.25 };
        let at = DVec3::new(f64::from(column) - middle + shift, 0.0, f64::from(row) - middle) * SPACING;
        let size = Transform(DAffine3::from_scale(DVec3::splat(0.875 + 0.25 * random(0))));
        let turned = size.then(Transform::rotate(Vec3::Y, random(1) * std::f64::consts::TAU));
        turned.then(Transform(DAffine3::from_translation(at)))
    };
    (0..count as u32).map(place).collect()
}

/// Length of a side of the field.
pub fn field_size(count: u64) -> f64 {
    f64::from(field_side(count)) * SPACING
}

/// Teapots along a side.
fn field_side(count: u64) -> u32 {
    libm::ceil(libm::sqrt(count as f64)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_teapot_stands_in_another_one() {
        let field = teapot_field(50);
        assert_eq!(field.len(), 50);
        for (at, a) in field.iter().enumerate() {
            assert_eq!(a.0.translation.y, 0.0);
            let nearest =
                field[..at].iter().map(|b| (a.0.translation - b.0.translation).length()).fold(f64::MAX, f64::min);
            // Half a teapot each way, and the largest is an eighth larger.
            assert!(nearest >= 6.434 * 1.125, "teapot {at} is {nearest} from another");
        }
    }
}
