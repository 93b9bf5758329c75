//! Affine transforms, kept in double precision until bake rounds them once.

use glam::{DAffine3, DMat3, DVec3, Vec3};

/// Object to world. The linear part is invertible (the loader refuses others).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform(pub DAffine3);

impl Default for Transform {
    fn default() -> Self {
        Self(DAffine3::IDENTITY)
    }
}

/// Sizes of objects and their coordinates in the world must stay within this and one part of it: beyond, single precision
/// does not tell their points apart.
pub const WORLD_LIMIT: f64 = 1e10;
/// What is wrong with an object beyond it.
pub const OUT_OF_LIMITS: &str =
    "is too large, too small or too far away: sizes from 1e-10 to 1e10 and coordinates up to 1e10 are possible";

impl Transform {
    /// Whether an object stays within `WORLD_LIMIT` whose own coordinates are up to twice `unit`.
    pub fn is_within_limits(&self, unit: f64) -> bool {
        let row_sums = |m: &DMat3| [0, 1, 2].map(|i| m.row(i).abs().element_sum()).into_iter().fold(0.0, f64::max);
        let scaled = self.0.matrix3 * unit;
        let reach = row_sums(&scaled) * 2.0 + self.0.translation.abs().max_element();
        let shrink = row_sums(&scaled.inverse());
        self.0.is_finite() && reach < WORLD_LIMIT && shrink < WORLD_LIMIT
    }

    pub fn translate(v: Vec3) -> Self {
        Self(DAffine3::from_translation(v.as_dvec3()))
    }

    pub fn scale(v: Vec3) -> Self {
        Self(DAffine3::from_scale(v.as_dvec3()))
    }

    /// Right-handed rotation by `angle` radians about `axis` (any non-zero length).
    pub fn rotate(axis: Vec3, angle: f64) -> Self {
        // Rodrigues' formula with libm's sine and cosine: the platform's would not be the same bits everywhere.
        let a = axis.as_dvec3();
        let a = a / libm::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let k = 1.0 - c;
        let column = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        Self(DAffine3::from_mat3(DMat3::from_cols(
            column(c + a.x * a.x * k, a.y * a.x * k + a.z * s, a.z * a.x * k - a.y * s),
            column(a.x * a.y * k - a.z * s, c + a.y * a.y * k, a.z * a.y * k + a.x * s),
            column(a.x * a.z * k + a.y * s, a.y * a.z * k - a.x * s, c + a.z * a.z * k),
        )))
    }

    /// First `self`, then `next`.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self(next.0 * self.0)
    }

    pub fn determinant(&self) -> f64 {
        self.0.matrix3.determinant()
    }
}
