//! From sums to numbers.

use super::Film;
use crate::layout::FRACTION_BITS;

/// Exponent of the smallest step of a sum without a unit.
const STEP: i32 = -(FRACTION_BITS as i32);

/// Linear Rec. 709 and alpha (coverage), rows from the top; r, g, b are premultiplied where alpha means something.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    pub pixels: Vec<[f32; 4]>,
}

/// Auxiliary planes, as `Image::pixels`.
#[derive(Clone, Debug, PartialEq)]
pub struct Aovs {
    /// Mean shading normal of the first hit, world space; not unit where samples differ or miss.
    pub normal: Vec<[f32; 3]>,
    /// Mean albedo of the first hit.
    pub albedo: Vec<[f32; 3]>,
    /// Of sample 0: distance along the camera ray (`T_INFINITE` on a miss), object, material (`INVALID` on a miss).
    pub depth: Vec<f32>,
    pub object: Vec<u32>,
    pub material: Vec<u32>,
}

/// Mean of `n` samples: sum * 2^exponent / n in f64, rounded once to f32. 0 for no samples.
fn mean(sum: i64, exponent: i32, n: u64) -> f32 {
    if n == 0 {
        return 0.0;
    }
    // Exact: a power of two, far from f64's limits (|exponent| <= 122).
    let scale = f64::from_bits(((1023 + i64::from(exponent)) as u64) << 52);
    (sum as f64 * scale / n as f64) as f32
}

impl Film {
    /// The picture: each sum times 2^-(22 - e), alpha times 2^-22, divided by the number of samples in f64, rounded to f32.
    /// Black and empty for a film without samples.
    pub fn resolve(&self) -> Image {
        let light = self.spec.unit_exponent + STEP;
        let exponents = [light, light, light, STEP];
        let n = self.samples.total();
        let resolve = |sums: &[i64; 4]| std::array::from_fn(|lane| mean(sums[lane], exponents[lane], n));
        let pixels = self.sums.iter().map(resolve).collect();
        Image { width: self.spec.crop.width, height: self.spec.crop.height, pixels }
    }

    /// The auxiliary planes, if kept; their scale is 2^22 whatever the film's unit.
    pub fn resolve_aovs(&self) -> Option<Aovs> {
        let aovs = self.aovs.as_ref()?;
        let n = self.samples.total();
        let means = |sums: [i64; 3]| sums.map(|sum| mean(sum, STEP, n));
        Some(Aovs {
            normal: aovs.iter().map(|aov| means(aov.normal)).collect(),
            albedo: aovs.iter().map(|aov| means(aov.albedo)).collect(),
            depth: aovs.iter().map(|aov| aov.depth).collect(),
            object: aovs.iter().map(|aov| aov.object).collect(),
            material: aovs.iter().map(|aov| aov.material).collect(),
        })
    }
}
