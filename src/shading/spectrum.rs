//! Light as four lanes. In RGB mode lanes 0-2 are linear Rec. 709 and lane 3 is 0.

use glam::{Vec3, Vec4};

use super::math::*;

pub type Spectrum = Vec4;

#[inline(always)]
pub fn spectrum_zero() -> Spectrum {
    Vec4::new(0.0, 0.0, 0.0, 0.0)
}

/// Linear Rec. 709 in lanes 0-2; lane 3 is 0.
#[inline(always)]
pub fn spectrum_from_rgb(rgb: Vec3) -> Spectrum {
    Vec4::new(rgb.x, rgb.y, rgb.z, 0.0)
}

/// Lanes 0-2.
#[inline(always)]
pub fn spectrum_to_rgb(s: Spectrum) -> Vec3 {
    Vec3::new(s.x, s.y, s.z)
}

/// The largest |lane|.
#[inline(always)]
pub fn spectrum_max(s: Spectrum) -> f32 {
    max_(max_(s.x.abs(), s.y.abs()), max_(s.z.abs(), s.w.abs()))
}

/// Relative luminance Y of lanes 0-2 (ITU-R BT.709-6, item 3.2).
#[inline(always)]
pub fn spectrum_luminance(s: Spectrum) -> f32 {
    (s.x * 0.2126 + s.y * 0.7152) + s.z * 0.0722
}

/// x, or 0 where |x| < `TINY` and for NaN.
#[inline(always)]
fn flush_lane(x: f32) -> f32 {
    if x.abs() >= TINY { x } else { 0.0 }
}

/// The spectrum with lanes below `TINY` (and NaN) set to zero, so that products of throughputs end at zero and never
/// among the subnormal numbers, which some devices keep and others do not.
#[inline(always)]
pub fn spectrum_flush(s: Spectrum) -> Spectrum {
    Vec4::new(flush_lane(s.x), flush_lane(s.y), flush_lane(s.z), flush_lane(s.w))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_fill_the_first_three_lanes() {
        let s = spectrum_from_rgb(Vec3::new(0.25, 0.5, 2.0));
        assert_eq!(s, Vec4::new(0.25, 0.5, 2.0, 0.0));
        assert_eq!(spectrum_to_rgb(s), Vec3::new(0.25, 0.5, 2.0));
        assert_eq!(spectrum_max(spectrum_zero()), 0.0);
    }

    #[test]
    fn the_largest_lane_is_found_wherever_it_is_and_whatever_its_sign() {
        for lane in 0..4 {
            for value in [3.0, -3.0] {
                let mut s = Vec4::splat(1.0);
                s[lane] = value;
                assert_eq!(spectrum_max(s), 3.0);
            }
        }
    }

    #[test]
    fn white_has_luminance_one_and_green_most_of_it() {
        let y = |r, g, b| spectrum_luminance(Vec4::new(r, g, b, 9.0));
        assert!((y(1.0, 1.0, 1.0) - 1.0).abs() < 1e-7);
        assert_eq!((y(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), y(0.0, 0.0, 1.0)), (0.2126, 0.7152, 0.0722));
    }

    #[test]
    fn tiny_lanes_are_flushed_and_no_others() {
        let s = Vec4::new(7.8e-31, -7.9e-31, f32::NAN, 1.0);
        assert_eq!(spectrum_flush(s), Vec4::new(0.0, -7.9e-31, 0.0, 1.0));
    }
}
