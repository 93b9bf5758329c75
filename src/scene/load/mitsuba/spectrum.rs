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
/// D65 in its table has this luminance: a surface that reflects all of it has luminance 1.
const D65_LUMINANCE: f64 = 98.997_417_518_762_55;

/// What kind of thing has a spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// 0 to 1.
    Reflectance,
    /// Light itself.
    Emission,
    /// An index of refraction or its imaginary part.
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

    /// The colour: integrals against the CIE 1931 observer, channels below 0 cut, those of reflectances above 1 too.
    /// Reflectances are seen under D65, so that what reflects all light is (1, 1, 1); light and indices of refraction are under
    /// no illuminant, so that a flat spectrum of 1 is the equal-energy white.
    /// Source: Mitsuba 3.9.1, `spectrum_list_to_srgb`. It takes indices in lists as if they were reflectances, but those of named
    /// metals under no illuminant; here both are the latter.
    pub fn rgb(&self, role: Role) -> Rgb {
        let mut xyz = DVec3::ZERO;
        for i in 0..POINTS {
            let wavelength = FIRST + f64::from(i) / f64::from(POINTS - 1) * (LAST - FIRST);
            let light = match role {
                Role::Reflectance => between(wavelength, |row| D65[row]) / D65_LUMINANCE,
                Role::Emission | Role::Index => 1.0,
            };
            xyz += observer(wavelength) * (self.at(wavelength) * light);
        }
        xyz *= (LAST - FIRST) / f64::from(POINTS) / Y_INTEGRAL;
        let rgb = rgb_from_xyz(xyz).as_vec3();
        let high = if role == Role::Reflectance { 1.0 } else { f32::MAX };
        rgb.clamp(Rgb::ZERO, Rgb::splat(high))
    }
}

/// A table's value at a wavelength within it, linear between its rows.
fn between(wavelength: f64, row: impl Fn(usize) -> f64) -> f64 {
    let place = (wavelength - FIRST) / STEP;
    let first = (place as usize).min(TABLE.len() - 2);
    row(first) + (row(first + 1) - row(first)) * (place - first as f64)
}

/// x-bar, y-bar and z-bar at a wavelength within the table.
fn observer(wavelength: f64) -> DVec3 {
    let lane = |k: usize| between(wavelength, |row| TABLE[row][k]);
    DVec3::new(lane(0), lane(1), lane(2))
}

/// Light that is 1 at every wavelength, a little purple next to D65.
pub fn equal_energy_white() -> Rgb {
    rgb_from_xyz(DVec3::ONE).as_vec3()
}

/// ITU-R BT.709 primaries and D65.
fn rgb_from_xyz(v: DVec3) -> DVec3 {
    DVec3::new(
        3.240479 * v.x - 1.537150 * v.y - 0.498535 * v.z,
        -0.969256 * v.x + 1.875991 * v.y + 0.041556 * v.z,
        0.055648 * v.x - 0.204043 * v.y + 1.057311 * v.z,
    )
}

/// A metal, semiconductor or salt under the name Mitsuba gives it: (name, eta, k), the means of its tables under the observer
/// (`Role::Index`). `_palik` after a name that has an entry without it means the same.
/// Source: Palik 1985 and SOPRA through luxpop.com, as in Mitsuba's `data/ior`.
pub const METALS: &[(&str, [f32; 3], [f32; 3])] = &[
    ("a-C", [2.944046, 2.227136, 1.968162], [0.887465, 0.799298, 0.815290]),
    ("Ag", [0.155276, 0.116728, 0.138388], [4.828355, 3.122222, 2.146901]),
    ("Al", [1.657501, 0.880405, 0.521244], [9.223811, 6.269502, 4.837004]),
    ("AlAs", [3.605296, 3.232938, 2.216318], [0.000679, 0.000000, 0.007513]),
    ("AlSb", [0.000000, 4.139375, 4.669254], [0.000000, 0.094009, 1.300570]),
    ("Au", [0.143036, 0.375307, 1.442045], [3.982997, 2.385556, 1.603359]),
    ("Be", [4.185013, 3.185029, 2.784061], [3.835466, 3.010122, 2.868994]),
    ("Cr", [4.369668, 2.916505, 1.654905], [5.206547, 4.231306, 3.754699]),
    ("CsI", [2.144900, 1.702319, 1.662427], [0.000000, 0.000000, 0.000000]),
    ("Cu", [0.201006, 0.923749, 1.102215], [3.913262, 2.453045, 2.142090]),
    ("Cu2O", [3.551773, 2.949869, 2.751875], [0.114207, 0.193897, 0.606134]),
    ("CuO", [3.247541, 2.447805, 2.210220], [0.521090, 0.570031, 0.722179]),
    ("Cu_palik", [0.213229, 0.919715, 1.102411], [3.921873, 2.457332, 2.136584]),
    ("d-C", [2.708720, 2.318826, 2.228897], [0.000000, 0.000000, 0.000000]),
    ("Hg", [2.398939, 1.440028, 0.909570], [6.327587, 4.371925, 3.421763]),
    ("HgTe", [4.779040, 3.231196, 2.659901], [1.631613, 1.580810, 1.729287]),
    ("Ir", [3.086300, 2.082190, 1.617914], [5.592153, 4.067088, 3.267312]),
    ("K", [0.064043, 0.046410, 0.038185], [2.104200, 1.348940, 0.913126]),
    ("Li", [0.265791, 0.195618, 0.220949], [3.540155, 2.311123, 1.668607]),
    ("MgO", [2.089584, 1.650723, 1.594879], [0.000000, 0.000000, 0.000000]),
    ("Mo", [4.483974, 3.525131, 2.776310], [4.111438, 3.420827, 3.150607]),
    ("Na_palik", [0.060269, 0.056141, 0.061988], [3.179274, 2.112490, 1.579041]),
    ("Nb", [3.420074, 2.790093, 2.395629], [3.441395, 2.737666, 2.579746]),
    ("Ni_palik", [2.367305, 1.663373, 1.467078], [4.498812, 3.050153, 2.345439]),
    ("Rh", [2.585794, 1.860216, 1.554263], [6.782261, 4.702987, 3.976073]),
    ("Se", [4.058312, 2.842935, 2.820853], [0.754050, 0.638444, 0.521807]),
    ("Se-e", [5.722849, 4.165736, 4.081338], [0.871136, 1.105157, 1.565320]),
    ("SiC", [3.172342, 2.525972, 2.479370], [0.000001, 0.000000, 0.000010]),
    ("SnTe", [4.524250, 1.981645, 1.281591], [0.000000, 0.000000, 0.000000]),
    ("Ta", [2.062721, 2.392939, 2.627929], [2.408360, 1.741486, 1.947028]),
    ("Te", [7.390234, 4.482105, 2.637106], [3.256022, 3.527059, 3.292054]),
    ("Te-e", [7.508907, 4.296429, 2.369988], [5.583929, 4.947205, 3.997592]),
    ("ThF4", [1.830714, 1.442228, 1.387648], [0.000000, 0.000000, 0.000000]),
    ("TiC", [3.700529, 2.837422, 2.582287], [3.265635, 2.351589, 2.172790]),
    ("TiN", [1.648450, 1.150516, 1.379823], [3.368328, 1.943498, 1.102068]),
    ("TiO2", [3.456610, 2.801736, 2.905175], [0.000105, 0.000000, 0.000653]),
    ("TiO2-e", [3.106565, 2.513168, 2.582444], [0.000030, 0.000000, 0.000183]),
    ("VC", [3.657566, 2.752736, 2.532672], [3.068301, 2.198687, 1.963193]),
    ("VN", [2.865602, 2.119189, 1.940091], [3.032243, 2.056116, 1.616306]),
    ("V_palik", [4.277582, 3.512949, 2.761071], [3.491301, 2.889455, 3.111522]),
    ("W", [4.370817, 3.300246, 2.998407], [3.500641, 2.604874, 2.273233]),
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

/// x-bar, y-bar, z-bar of the CIE 1931 2-degree observer, 360 to 830 nm by 5. Source: CIE 018:2019.
#[rustfmt::skip]
const TABLE: [[f64; 3]; 95] = [
    [0.0001299, 0.000003917, 0.0006061],
    [0.0002321, 0.000006965, 0.001086],
    [0.0004149, 0.00001239, 0.001946],
    [0.0007416, 0.00002202, 0.003486],
    [0.001368, 0.000039, 0.006450001],
    [0.002236, 0.000064, 0.01054999],
    [0.004243, 0.00012, 0.02005001],
    [0.00765, 0.000217, 0.03621],
    [0.01431, 0.000396, 0.06785001],
    [0.02319, 0.00064, 0.1102],
    [0.04351, 0.00121, 0.2074],
    [0.07763, 0.00218, 0.3713],
    [0.13438, 0.004, 0.6456],
    [0.21477, 0.0073, 1.0390501],
    [0.2839, 0.0116, 1.3856],
    [0.3285, 0.01684, 1.62296],
    [0.34828, 0.023, 1.74706],
    [0.34806, 0.0298, 1.7826],
    [0.3362, 0.038, 1.77211],
    [0.3187, 0.048, 1.7441],
    [0.2908, 0.06, 1.6692],
    [0.2511, 0.0739, 1.5281],
    [0.19536, 0.09098, 1.28764],
    [0.1421, 0.1126, 1.0419],
    [0.09564, 0.13902, 0.8129501],
    [0.05795001, 0.1693, 0.6162],
    [0.03201, 0.20802, 0.46518],
    [0.0147, 0.2586, 0.3533],
    [0.0049, 0.323, 0.272],
    [0.0024, 0.4073, 0.2123],
    [0.0093, 0.503, 0.1582],
    [0.0291, 0.6082, 0.1117],
    [0.06327, 0.71, 0.07824999],
    [0.1096, 0.7932, 0.05725001],
    [0.1655, 0.862, 0.04216],
    [0.2257499, 0.9148501, 0.02984],
    [0.2904, 0.954, 0.0203],
    [0.3597, 0.9803, 0.0134],
    [0.4334499, 0.9949501, 0.008749999],
    [0.5120501, 1.0, 0.005749999],
    [0.5945, 0.995, 0.0039],
    [0.6784, 0.9786, 0.002749999],
    [0.7621, 0.952, 0.0021],
    [0.8425, 0.9154, 0.0018],
    [0.9163, 0.87, 0.001650001],
    [0.9786, 0.8163, 0.0014],
    [1.0263, 0.757, 0.0011],
    [1.0567, 0.6949, 0.001],
    [1.0622, 0.631, 0.0008],
    [1.0456, 0.5668, 0.0006],
    [1.0026, 0.503, 0.00034],
    [0.9384, 0.4412, 0.00024],
    [0.8544499, 0.381, 0.00019],
    [0.7514, 0.321, 0.0001],
    [0.6424, 0.265, 0.00004999999],
    [0.5419, 0.217, 0.00003],
    [0.4479, 0.175, 0.00002],
    [0.3608, 0.1382, 0.00001],
    [0.2835, 0.107, 0.0],
    [0.2187, 0.0816, 0.0],
    [0.1649, 0.061, 0.0],
    [0.1212, 0.04458, 0.0],
    [0.0874, 0.032, 0.0],
    [0.0636, 0.0232, 0.0],
    [0.04677, 0.017, 0.0],
    [0.0329, 0.01192, 0.0],
    [0.0227, 0.00821, 0.0],
    [0.01584, 0.005723, 0.0],
    [0.01135916, 0.004102, 0.0],
    [0.008110916, 0.002929, 0.0],
    [0.005790346, 0.002091, 0.0],
    [0.004109457, 0.001484, 0.0],
    [0.002899327, 0.001047, 0.0],
    [0.00204919, 0.00074, 0.0],
    [0.001439971, 0.00052, 0.0],
    [0.0009999493, 0.0003611, 0.0],
    [0.0006900786, 0.0002492, 0.0],
    [0.0004760213, 0.0001719, 0.0],
    [0.0003323011, 0.00012, 0.0],
    [0.0002348261, 0.0000848, 0.0],
    [0.0001661505, 0.00006, 0.0],
    [0.000117413, 0.0000424, 0.0],
    [0.00008307527, 0.00003, 0.0],
    [0.00005870652, 0.0000212, 0.0],
    [0.00004150994, 0.00001499, 0.0],
    [0.00002935326, 0.0000106, 0.0],
    [0.00002067383, 0.0000074657, 0.0],
    [0.00001455977, 0.0000052578, 0.0],
    [0.00001025398, 0.0000037029, 0.0],
    [0.000007221456, 0.0000026078, 0.0],
    [0.000005085868, 0.0000018366, 0.0],
    [0.000003581652, 0.0000012934, 0.0],
    [0.000002522525, 0.00000091093, 0.0],
    [0.000001776509, 0.00000064153, 0.0],
    [0.000001251141, 0.00000045181, 0.0],
];

/// CIE standard illuminant D65, 360 to 830 nm by 5, 100 at 560. Source: ISO/CIE 11664-2:2022.
#[rustfmt::skip]
const D65: [f64; 95] = [
    46.6383, 49.3637, 52.0891, 51.0323, 49.9755, 52.3118, 54.6482, 68.7015, 82.7549, 87.1204,
    91.486, 92.4589, 93.4318, 90.057, 86.6823, 95.7736, 104.865, 110.936, 117.008, 117.41,
    117.812, 116.336, 114.861, 115.392, 115.923, 112.367, 108.811, 109.082, 109.354, 108.578,
    107.802, 106.296, 104.79, 106.239, 107.689, 106.047, 104.405, 104.225, 104.046, 102.023,
    100.0, 98.1671, 96.3342, 96.0611, 95.788, 92.2368, 88.6856, 89.3459, 90.0062, 89.8026,
    89.5991, 88.6489, 87.6987, 85.4936, 83.2886, 83.4939, 83.6992, 81.863, 80.0268, 80.1207,
    80.2146, 81.2462, 82.2778, 80.281, 78.2842, 74.0027, 69.7213, 70.6652, 71.6091, 72.979,
    74.349, 67.9765, 61.604, 65.7448, 69.8856, 72.4863, 75.087, 69.3398, 63.5927, 55.0054,
    46.4182, 56.6118, 66.8054, 65.0941, 63.3828, 63.8434, 64.304, 61.8779, 59.4519, 55.7054,
    51.959, 54.6998, 57.4406, 58.8765, 60.3125,
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
    fn a_flat_spectrum_is_the_equal_energy_white() {
        // Mitsuba's own conversion of 0.78, in its Cornell box for RGB variants.
        let flat = spectrum(&[(400.0, 0.78), (700.0, 0.78)]);
        for role in [Role::Emission, Role::Index] {
            close(flat.rgb(role), [0.936461, 0.740433, 0.705267], 8e-4);
        }
    }

    #[test]
    fn reflectances_are_seen_under_d65_as_in_mitsuba() {
        // Mitsuba 3.9.1, scalar_rgb, `traverse` of a diffuse BSDF. The first is short of 1 by the sum's 1000 points in 999 steps.
        for (points, expected) in [
            (&[(360.0, 1.0), (830.0, 1.0)][..], [0.998985, 0.998874, 0.998802]),
            (&[(400.0, 0.78), (700.0, 0.78)], [0.776367, 0.77981, 0.776029]),
            (&[(400.0, 0.1), (500.0, 0.6), (600.0, 0.9), (700.0, 0.2)], [0.806934, 0.752263, 0.32012]),
            (&[(300.0, 0.2), (550.0, 0.9), (900.0, 0.1)], [0.737546, 0.861101, 0.604327]),
            (&[(400.0, 1.0), (500.0, 1.0), (500.001, 0.0), (700.0, 0.0)], [0.0, 0.0135933, 1.0]),
        ] {
            close(spectrum(points).rgb(Role::Reflectance), expected, 2e-5);
        }
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
