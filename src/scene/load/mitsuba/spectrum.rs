//! Tabulated spectra as linear Rec. 709, as Mitsuba's RGB variants have them.

use crate::scene::Rgb;
use glam::DVec3;

/// Nanometres of the first and last row of the table, and between rows.
const FIRST: f64 = 360.0;
const LAST: f64 = 830.0;
const STEP: f64 = 5.0;
/// Points of the integration: as many as Mitsuba takes, so that edges of a spectrum count the same.
const POINTS: u32 = 1000;
/// Integral of y-bar in the table: a flat spectrum of 1 has luminance 1.
const Y_INTEGRAL: f64 = 106.750_259_399_414_06;
/// Luminance of D65 in the table's units over that of a flat spectrum of 1.
const D65_LUMINANCE: f64 = 98.997_417_518_762_55;

/// What kind of thing has a spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Seen under D65, 0 to 1.
    Reflectance,
    /// Light itself.
    Emission,
    /// An index of refraction or its imaginary part: a plain mean, not bounded.
    Index,
}

/// A piecewise linear spectrum, 0 outside its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// (nanometres, value), ascending, 2 or more.
    pub points: Vec<(f64, f64)>,
}

impl Spectrum {
    fn at(&self, wavelength: f64) -> f64 {
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        if wavelength < first.0 || wavelength > last.0 {
            return 0.0;
        }
        let after = self.points.partition_point(|(w, _)| *w <= wavelength).clamp(1, self.points.len() - 1);
        let ((w0, v0), (w1, v1)) = (self.points[after - 1], self.points[after]);
        if w1 > w0 { v0 + (v1 - v0) * ((wavelength - w0) / (w1 - w0)) } else { v1 }
    }

    /// The colour: integrals against the CIE 1931 observer (for reflectances: and D65), channels below 0 cut, those of
    /// reflectances above 1 too. A flat emission of 1 is the equal-energy white, not (1, 1, 1).
    /// Source: Mitsuba 3, `spectrum_list_to_srgb`.
    pub fn rgb(&self, role: Role) -> Rgb {
        let mut xyz = DVec3::ZERO;
        for i in 0..POINTS {
            let wavelength = FIRST + f64::from(i) / f64::from(POINTS - 1) * (LAST - FIRST);
            let (observer, d65) = observer(wavelength);
            let light = if role == Role::Reflectance { d65 / D65_LUMINANCE } else { 1.0 };
            xyz += observer * (light * self.at(wavelength));
        }
        xyz *= (LAST - FIRST) / f64::from(POINTS) / Y_INTEGRAL;
        let rgb = rgb_from_xyz(xyz).as_vec3();
        let high = if role == Role::Reflectance { 1.0 } else { f32::MAX };
        rgb.clamp(Rgb::ZERO, Rgb::splat(high))
    }
}

/// x-bar, y-bar, z-bar and the power of D65 at a wavelength within the table.
fn observer(wavelength: f64) -> (DVec3, f64) {
    let place = (wavelength - FIRST) / STEP;
    let row = (place as usize).min(TABLE.len() - 2);
    let t = place - row as f64;
    let mix = |k: usize| TABLE[row][k] + (TABLE[row + 1][k] - TABLE[row][k]) * t;
    (DVec3::new(mix(0), mix(1), mix(2)), mix(3))
}

/// ITU-R BT.709 primaries and D65.
fn rgb_from_xyz(v: DVec3) -> DVec3 {
    DVec3::new(
        3.240479 * v.x - 1.537150 * v.y - 0.498535 * v.z,
        -0.969256 * v.x + 1.875991 * v.y + 0.041556 * v.z,
        0.055648 * v.x - 0.204043 * v.y + 1.057311 * v.z,
    )
}

/// A metal under the name Mitsuba gives it: (name, eta, k), the means of its tables under the observer (`Role::Index`).
/// Source: Palik 1985 and SOPRA through luxpop.com, as in Mitsuba's `data/ior`.
pub const METALS: &[(&str, [f32; 3], [f32; 3])] = &[
    ("Ag", [0.155276, 0.116728, 0.138388], [4.828355, 3.122222, 2.146901]),
    ("Al", [1.657501, 0.880405, 0.521244], [9.223811, 6.269502, 4.837004]),
    ("Au", [0.143036, 0.375307, 1.442045], [3.982997, 2.385556, 1.603359]),
    ("Cr", [4.369668, 2.916505, 1.654905], [5.206547, 4.231306, 3.754699]),
    ("Cu", [0.201006, 0.923749, 1.102215], [3.913262, 2.453045, 2.142090]),
    // Reflects everything.
    ("none", [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]),
];

/// Indices of refraction by name, near 589 nm and 0 to 20 degrees Celsius. Source: Hecht, Optics, 4th edition, as in
/// Mitsuba's documentation.
pub const INDICES: &[(&str, f64)] = &[
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.3330),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.470),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.5750),
    ("diamond", 2.419),
];

/// x-bar, y-bar, z-bar of the CIE 1931 2-degree observer and the relative power of D65, 360 to 830 nm by 5.
/// Source: CIE 018:2019 and ISO/CIE 11664-2:2022.
#[rustfmt::skip]
const TABLE: [[f64; 4]; 95] = [
    [0.0001299, 0.000003917, 0.0006061, 46.638302],
    [0.0002321, 0.000006965, 0.001086, 49.363701],
    [0.0004149, 0.00001239, 0.001946, 52.0891],
    [0.0007416, 0.00002202, 0.003486, 51.032299],
    [0.001368, 0.000039, 0.006450001, 49.975498],
    [0.002236, 0.000064, 0.01054999, 52.311798],
    [0.004243, 0.00012, 0.02005001, 54.648201],
    [0.00765, 0.000217, 0.03621, 68.7015],
    [0.01431, 0.000396, 0.06785001, 82.754898],
    [0.02319, 0.00064, 0.1102, 87.120399],
    [0.04351, 0.00121, 0.2074, 91.486],
    [0.07763, 0.00218, 0.3713, 92.4589],
    [0.13438, 0.004, 0.6456, 93.431801],
    [0.21477, 0.0073, 1.0390501, 90.056999],
    [0.2839, 0.0116, 1.3856, 86.682297],
    [0.3285, 0.01684, 1.62296, 95.773598],
    [0.34828, 0.023, 1.74706, 104.865],
    [0.34806, 0.0298, 1.7826, 110.936],
    [0.3362, 0.038, 1.77211, 117.008],
    [0.3187, 0.048, 1.7441, 117.41],
    [0.2908, 0.06, 1.6692, 117.812],
    [0.2511, 0.0739, 1.5281, 116.336],
    [0.19536, 0.09098, 1.28764, 114.861],
    [0.1421, 0.1126, 1.0419, 115.392],
    [0.09564, 0.13902, 0.8129501, 115.923],
    [0.05795001, 0.1693, 0.6162, 112.367],
    [0.03201, 0.20802, 0.46518, 108.811],
    [0.0147, 0.2586, 0.3533, 109.082],
    [0.0049, 0.323, 0.272, 109.354],
    [0.0024, 0.4073, 0.2123, 108.578],
    [0.0093, 0.503, 0.1582, 107.802],
    [0.0291, 0.6082, 0.1117, 106.296],
    [0.06327, 0.71, 0.07824999, 104.79],
    [0.1096, 0.7932, 0.05725001, 106.239],
    [0.1655, 0.862, 0.04216, 107.689],
    [0.2257499, 0.9148501, 0.02984, 106.047],
    [0.2904, 0.954, 0.0203, 104.405],
    [0.3597, 0.9803, 0.0134, 104.225],
    [0.4334499, 0.9949501, 0.008749999, 104.046],
    [0.5120501, 1.0, 0.005749999, 102.023],
    [0.5945, 0.995, 0.0039, 100.0],
    [0.6784, 0.9786, 0.002749999, 98.167099],
    [0.7621, 0.952, 0.0021, 96.334198],
    [0.8425, 0.9154, 0.0018, 96.061096],
    [0.9163, 0.87, 0.001650001, 95.788002],
    [0.9786, 0.8163, 0.0014, 92.236801],
    [1.0263, 0.757, 0.0011, 88.6856],
    [1.0567, 0.6949, 0.001, 89.345901],
    [1.0622, 0.631, 0.0008, 90.006203],
    [1.0456, 0.5668, 0.0006, 89.802597],
    [1.0026, 0.503, 0.00034, 89.599098],
    [0.9384, 0.4412, 0.00024, 88.648903],
    [0.8544499, 0.381, 0.00019, 87.6987],
    [0.7514, 0.321, 0.0001, 85.493599],
    [0.6424, 0.265, 0.00004999999, 83.288597],
    [0.5419, 0.217, 0.00003, 83.493896],
    [0.4479, 0.175, 0.00002, 83.699203],
    [0.3608, 0.1382, 0.00001, 81.862999],
    [0.2835, 0.107, 0.0, 80.026802],
    [0.2187, 0.0816, 0.0, 80.120697],
    [0.1649, 0.061, 0.0, 80.2146],
    [0.1212, 0.04458, 0.0, 81.246201],
    [0.0874, 0.032, 0.0, 82.277802],
    [0.0636, 0.0232, 0.0, 80.280998],
    [0.04677, 0.017, 0.0, 78.284203],
    [0.0329, 0.01192, 0.0, 74.002701],
    [0.0227, 0.00821, 0.0, 69.721298],
    [0.01584, 0.005723, 0.0, 70.665199],
    [0.01135916, 0.004102, 0.0, 71.6091],
    [0.008110916, 0.002929, 0.0, 72.978996],
    [0.005790346, 0.002091, 0.0, 74.348999],
    [0.004109457, 0.001484, 0.0, 67.976501],
    [0.002899327, 0.001047, 0.0, 61.604],
    [0.00204919, 0.00074, 0.0, 65.744797],
    [0.001439971, 0.00052, 0.0, 69.885597],
    [0.0009999493, 0.0003611, 0.0, 72.486298],
    [0.0006900786, 0.0002492, 0.0, 75.086998],
    [0.0004760213, 0.0001719, 0.0, 69.339798],
    [0.0003323011, 0.00012, 0.0, 63.592701],
    [0.0002348261, 0.0000848, 0.0, 55.005402],
    [0.0001661505, 0.00006, 0.0, 46.418201],
    [0.000117413, 0.0000424, 0.0, 56.611801],
    [0.00008307527, 0.00003, 0.0, 66.805397],
    [0.00005870652, 0.0000212, 0.0, 65.094101],
    [0.00004150994, 0.00001499, 0.0, 63.382801],
    [0.00002935326, 0.0000106, 0.0, 63.843399],
    [0.00002067383, 0.0000074657, 0.0, 64.304001],
    [0.00001455977, 0.0000052578, 0.0, 61.877899],
    [0.00001025398, 0.0000037029, 0.0, 59.4519],
    [0.000007221456, 0.0000026078, 0.0, 55.705399],
    [0.000005085868, 0.0000018366, 0.0, 51.959],
    [0.000003581652, 0.0000012934, 0.0, 54.699799],
    [0.000002522525, 0.00000091093, 0.0, 57.440601],
    [0.000001776509, 0.00000064153, 0.0, 58.876499],
    [0.000001251141, 0.00000045181, 0.0, 60.3125],
];

#[cfg(test)]
mod tests {
    use super::*;

    fn spectrum(points: &[(f64, f64)]) -> Spectrum {
        Spectrum { points: points.to_vec() }
    }

    #[track_caller]
    fn close(found: Rgb, expected: [f32; 3], tolerance: f32) {
        let error = (found - Rgb::from_array(expected)).abs().max_element();
        assert!(error < tolerance, "{found} is not {expected:?}");
    }

    #[test]
    fn a_flat_reflectance_is_grey_and_a_flat_emission_is_not() {
        // 0.1 % is what 5 nm rows and 1000 points lose of D65's peaks.
        close(spectrum(&[(360.0, 1.0), (830.0, 1.0)]).rgb(Role::Reflectance), [1.0, 1.0, 1.0], 1.2e-3);
        // Mitsuba's own conversion of 0.78, in its Cornell box for RGB variants.
        let flat = spectrum(&[(400.0, 0.78), (700.0, 0.78)]);
        close(flat.rgb(Role::Emission), [0.936461, 0.740433, 0.705267], 8e-4);
    }

    #[test]
    fn what_lies_outside_the_gamut_is_cut() {
        let laser = spectrum(&[(519.0, 0.0), (520.0, 60.0), (521.0, 0.0)]);
        let (light, surface) = (laser.rgb(Role::Emission), laser.rgb(Role::Reflectance));
        assert!(light.x == 0.0 && light.y > 0.5, "{light}");
        assert!(surface.x == 0.0 && surface.max_element() <= 1.0, "{surface}");
    }

    #[test]
    fn two_values_at_one_wavelength_are_a_step() {
        let step = spectrum(&[(360.0, 0.0), (600.0, 0.0), (600.0, 1.0), (830.0, 1.0)]);
        assert_eq!((step.at(599.9), step.at(600.1), step.at(900.0)), (0.0, 1.0, 0.0));
    }
}
