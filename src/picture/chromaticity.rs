//! From one set of primaries to another.

use glam::{DMat3, DVec3};

/// The x and y of CIE 1931 that red, green, blue and white have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticities {
    pub red: [f64; 2],
    pub green: [f64; 2],
    pub blue: [f64; 2],
    pub white: [f64; 2],
}

/// ITU-R BT.709-6, 1.3 and 1.4; its white is D65. OpenEXR takes these where a file says nothing.
pub const REC709: Chromaticities =
    Chromaticities { red: [0.64, 0.33], green: [0.3, 0.6], blue: [0.15, 0.06], white: [0.3127, 0.329] };

/// Files round differently; half a thousandth of x or y is a colour that nobody tells apart.
const SAME: f64 = 5.0e-4;

/// Responses of the eye's cones, sharpened, to X, Y, Z.
/// Source: Lam 1985, "Metamerism and colour constancy", as in ICC.1:2022, annex E ("linearized Bradford").
const BRADFORD: DMat3 = DMat3::from_cols(
    DVec3::new(0.8951, -0.7502, 0.0389),
    DVec3::new(0.2664, 1.7135, -0.0685),
    DVec3::new(-0.1614, 0.0367, 1.0296),
);

impl Chromaticities {
    /// Red, green, blue, white, x before y.
    pub fn from_numbers(n: [f64; 8]) -> Self {
        Self { red: [n[0], n[1]], green: [n[2], n[3]], blue: [n[4], n[5]], white: [n[6], n[7]] }
    }

    pub fn is_nearly(&self, other: &Self) -> bool {
        let pairs =
            [(self.red, other.red), (self.green, other.green), (self.blue, other.blue), (self.white, other.white)];
        pairs.iter().all(|(a, b)| (a[0] - b[0]).abs() < SAME && (a[1] - b[1]).abs() < SAME)
    }

    /// From linear r, g, b to X, Y, Z, where white has Y = 1; none if these are no primaries (three on a line, a white that is
    /// black).
    pub fn to_xyz(&self) -> Option<DMat3> {
        let place = |[x, y]: [f64; 2]| DVec3::new(x, y, 1.0 - x - y);
        let primaries = DMat3::from_cols(place(self.red), place(self.green), place(self.blue));
        let white = place(self.white) / self.white[1];
        let matrix = primaries * DMat3::from_diagonal(primaries.inverse() * white);
        (matrix.is_finite() && matrix.inverse().is_finite()).then_some(matrix)
    }
}

/// From linear r, g, b of these chromaticities to those of Rec. 709, with white staying white (`adapt`) or X, Y, Z staying what
/// they are; none if they are no primaries.
pub fn to_rec709(from: &Chromaticities, adapt: bool) -> Option<DMat3> {
    let to_xyz = from.to_xyz()?;
    let from_xyz = REC709.to_xyz()?.inverse();
    if !adapt {
        return Some(from_xyz * to_xyz);
    }
    let cones = |xyz: DMat3| BRADFORD * xyz * DVec3::ONE;
    let adaptation = cones(REC709.to_xyz()?) / cones(to_xyz);
    let matrix = from_xyz * BRADFORD.inverse() * DMat3::from_diagonal(adaptation) * BRADFORD * to_xyz;
    matrix.is_finite().then_some(matrix)
}

/// From X, Y, Z to linear Rec. 709.
pub fn xyz_to_rec709() -> DMat3 {
    REC709.to_xyz().unwrap_or(DMat3::IDENTITY).inverse()
}

/// Turns the colours of pixels that are finite.
pub fn convert(pixels: &mut [[f32; 4]], matrix: DMat3) {
    for pixel in pixels {
        let color = DVec3::new(f64::from(pixel[0]), f64::from(pixel[1]), f64::from(pixel[2]));
        // Of an infinite channel others would be made that are no number.
        if color.is_finite() {
            let [r, g, b] = (matrix * color).as_vec3().to_array();
            *pixel = [r, g, b, pixel[3]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_matrix_of_rec_709_is_the_published_one() {
        // IEC 61966-2-1:1999, 5.2, in four decimals.
        let expected = DMat3::from_cols(
            DVec3::new(0.4124, 0.2126, 0.0193),
            DVec3::new(0.3576, 0.7152, 0.1192),
            DVec3::new(0.1805, 0.0722, 0.9505),
        );
        let error = REC709.to_xyz().unwrap() - expected;
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-4), "{error}");
    }

    #[test]
    fn white_stays_white_and_acescg_becomes_what_others_publish() {
        let aces = Chromaticities::from_numbers([0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767]);
        let matrix = to_rec709(&aces, true).unwrap();
        assert!((matrix * DVec3::ONE - DVec3::ONE).abs().max_element() < 1e-12);
        // AP1_2_XYZ, D60_2_D65 (CAT02 there, Bradford here) and XYZ_2_REC709 of the ACES transforms, to three decimals.
        let expected = DMat3::from_cols(
            DVec3::new(1.705, -0.130, -0.024),
            DVec3::new(-0.622, 1.141, -0.129),
            DVec3::new(-0.083, -0.011, 1.153),
        );
        let error = matrix - expected;
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 2e-3), "{matrix}");
    }

    #[test]
    fn what_is_no_set_of_primaries_has_no_matrix() {
        let line = Chromaticities { blue: [0.47, 0.465], ..REC709 };
        let none = Chromaticities::from_numbers([0.0; 8]);
        let nan = Chromaticities { white: [f64::NAN; 2], ..REC709 };
        for bad in [Chromaticities { green: REC709.red, ..REC709 }, none, nan] {
            assert_eq!(to_rec709(&bad, true), None, "{bad:?}");
        }
        assert!(to_rec709(&line, true).is_none_or(|m| m.is_finite()));
        // XYZ itself: its third primary has no y.
        let xyz = Chromaticities::from_numbers([1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0 / 3.0, 1.0 / 3.0]);
        assert!(xyz.to_xyz().unwrap().abs_diff_eq(DMat3::IDENTITY, 1e-12));
    }
}
