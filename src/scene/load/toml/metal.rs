//! Complex indices of the metals the lecture draws, one number per channel of linear Rec. 709.

use crate::scene::{Fresnel, Rgb};

/// A metal by its chemical symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metal {
    Copper,
    Gold,
    Silver,
    Aluminium,
    Chromium,
}

pub const METALS: &[(&str, Metal)] = &[
    ("Cu", Metal::Copper),
    ("Au", Metal::Gold),
    ("Ag", Metal::Silver),
    ("Al", Metal::Aluminium),
    ("Cr", Metal::Chromium),
];

impl Metal {
    /// eta is the tabulated n at 611, 549 and 464 nm: Johnson and Christy 1972 (Cu, Au, Ag), Johnson and Christy 1974 (Cr),
    /// Rakic 1995 (Al). Three wavelengths are not the colour of a spectrum, so k is solved for the normal-incidence
    /// reflectance R that the whole spectrum has under D65 (the table of the test below; chromium: integrated from its own data),
    /// k^2 = (R (n + 1)^2 - (n - 1)^2) / (1 - R). Gold's red is 1.022, outside the gamut; no reflectance is, so 0.99.
    pub fn fresnel(self) -> Fresnel {
        let (eta, k) = match self {
            Self::Copper => ([0.3669, 1.0162, 1.2464], [5.5448, 2.6765, 2.3920]),
            Self::Gold => ([0.2234, 0.4283, 1.3353], [9.3735, 2.4197, 1.6321]),
            Self::Silver => ([0.0583, 0.0599, 0.0464], [2.6309, 2.2060, 1.0190]),
            Self::Aluminium => ([1.3195, 1.0109, 0.6825], [7.4355, 6.9136, 5.6718]),
            Self::Chromium => ([3.1786, 3.1800, 2.4470], [3.2815, 3.3431, 3.1740]),
        };
        Fresnel::Conductor { eta: Rgb::from_array(eta), k: Rgb::from_array(k) }
    }
}

/// The reflectance of an interface at normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
pub fn normal_reflectance(fresnel: Fresnel) -> Rgb {
    let (eta, k) = match fresnel {
        Fresnel::Dielectric { eta } => (Rgb::splat(eta), Rgb::ZERO),
        Fresnel::Conductor { eta, k } => (eta, k),
        Fresnel::Schlick { f0 } => return f0,
    };
    let square = |v: Rgb| v * v;
    (square(eta - Rgb::ONE) + square(k)) / (square(eta + Rgb::ONE) + square(k))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_have_the_normal_incidence_colours_of_the_lecture() {
        // Reflectance at normal incidence, linear sRGB under D65; gold's red is clipped.
        let table = [
            (Metal::Copper, [0.955, 0.638, 0.537]),
            (Metal::Gold, [0.99, 0.783, 0.342]),
            (Metal::Silver, [0.971, 0.960, 0.913]),
            (Metal::Aluminium, [0.913, 0.922, 0.922]),
        ];
        for (metal, color) in table {
            let error = (normal_reflectance(metal.fresnel()) - Rgb::from_array(color)).abs().max_element();
            assert!(error < 1e-4, "{metal:?} is off by {error}");
        }
    }

    #[test]
    fn glass_reflects_four_percent() {
        assert!((normal_reflectance(Fresnel::Dielectric { eta: 1.5 }).x - 0.04).abs() < 1e-7);
    }
}
