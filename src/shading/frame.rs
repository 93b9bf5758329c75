//! Orthonormal frames, right-handed, z = normal.

use glam::Vec3;

use super::math::*;

/// tangent x bitangent = normal, all unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame {
    pub tangent: Vec3,
    pub bitangent: Vec3,
    pub normal: Vec3,
}

/// A frame around a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3); orthonormal
/// within 5e-7. The tangent jumps where normal.z changes its sign.
#[inline]
pub fn frame_from_normal(normal: Vec3) -> Frame {
    // Not `>= 0`: whether a subnormal z survives may not decide.
    let sign_ = if normal.z > -TINY { 1.0 } else { -1.0 };
    let a = -rcp(sign_ + normal.z);
    let b = (normal.x * normal.y) * a;
    Frame {
        tangent: Vec3::new(1.0 + (sign_ * normal.x) * (normal.x * a), sign_ * b, -sign_ * normal.x),
        bitangent: Vec3::new(b, sign_ + (normal.y * normal.y) * a, -normal.y),
        normal,
    }
}

/// The frame around a unit normal whose tangent is nearest to `tangent` (any length), orthonormal within 1e-6; that of
/// `frame_from_normal` if `tangent` is zero or within about 0.1 degrees of the normal's line.
#[inline]
pub fn frame_from_tangent(normal: Vec3, tangent: Vec3) -> Frame {
    let along = normalize3(tangent);
    let across = along - normal * dot3(normal, along);
    if dot3(across, across) >= 4e-6 {
        // A second step removes what cancellation in the first one left along the normal.
        let unit = normalize3(across);
        let nearest = normalize3(unit - normal * dot3(normal, unit));
        return Frame { tangent: nearest, bitangent: cross3(normal, nearest), normal };
    }
    frame_from_normal(normal)
}

/// The components of `w` along the frame's axes.
#[inline(always)]
pub fn to_local(frame: Frame, w: Vec3) -> Vec3 {
    Vec3::new(dot3(frame.tangent, w), dot3(frame.bitangent, w), dot3(frame.normal, w))
}

/// The vector with components `w` along the frame's axes.
#[inline(always)]
pub fn to_world(frame: Frame, w: Vec3) -> Vec3 {
    (frame.tangent * w.x + frame.bitangent * w.y) + frame.normal * w.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_orthonormal(frame: Frame, bound: f64) {
        let (t, b, n) = (frame.tangent.as_dvec3(), frame.bitangent.as_dvec3(), frame.normal.as_dvec3());
        for (value, want) in [(t.dot(t), 1.0), (b.dot(b), 1.0), (t.dot(b), 0.0), (t.dot(n), 0.0), (b.dot(n), 0.0)] {
            assert!((value - want).abs() < bound, "{value} instead of {want} in {frame:?}");
        }
        assert!((t.cross(b) - n).length() < bound, "left-handed: {frame:?}");
    }

    #[test]
    fn frames_around_the_axes_are_exact() {
        for normal in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z] {
            assert_orthonormal(frame_from_normal(normal), 1e-12);
        }
        assert_eq!(frame_from_normal(Vec3::Z), Frame { tangent: Vec3::X, bitangent: Vec3::Y, normal: Vec3::Z });
    }

    #[test]
    fn neither_signed_zero_nor_a_subnormal_turns_the_frame() {
        let plain = frame_from_normal(Vec3::X);
        for z in [-0.0, 1e-45, -1e-45, -1e-38] {
            let frame = frame_from_normal(Vec3::new(1.0, 0.0, z));
            assert_eq!((frame.tangent, frame.bitangent), (plain.tangent, plain.bitangent), "{z}");
        }
    }

    #[test]
    fn tangents_along_the_normal_fall_back() {
        let normal = normalize3(Vec3::new(1.0, -2.0, 3.0));
        for tangent in [Vec3::ZERO, normal, normal * -5.0, normal + Vec3::new(1e-3, 0.0, 0.0)] {
            assert_eq!(frame_from_tangent(normal, tangent), frame_from_normal(normal));
        }
    }

    fn vector() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn frames_are_orthonormal_and_right_handed(v in vector(), tangent in vector(), flat in -40i32..1) {
            let normal = normalize3(Vec3::new(v.x, v.y, ldexp_(v.z, flat)));
            prop_assume!(normal != Vec3::ZERO);
            assert_orthonormal(frame_from_normal(normal), 5e-7);
            let frame = frame_from_tangent(normal, tangent);
            assert_orthonormal(frame, 1e-6);
            prop_assert!(dot3(frame.tangent, tangent) > 0.0 || frame == frame_from_normal(normal));
        }

        #[test]
        fn to_world_undoes_to_local(v in vector(), w in vector()) {
            prop_assume!(normalize3(v) != Vec3::ZERO);
            let frame = frame_from_normal(normalize3(v));
            prop_assert!((to_world(frame, to_local(frame, w)) - w).length() < 1e-6);
            prop_assert!((to_local(frame, frame.normal) - Vec3::Z).length() < 1e-6);
        }
    }
}
