//! How far two pictures are apart.

use super::display::{Display, encode, srgb_encode, tone_map};
use super::read::Picture;
use super::{FilmError, Image};
use crate::scene::ToneMap;
use serde::Serialize;

/// Keeps the relative error finite where the reference is black.
/// Source: Rousselle, Knaus, Zwicker 2011, Adaptive Sampling and Reconstruction using Greedy Error Minimization, section 5.
const RELATIVE_EPSILON: f64 = 0.01;

/// What the steps of `max_ulp` are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Step {
    /// Neighbouring f32 numbers of linear light.
    #[serde(rename = "f32")]
    Float,
    /// Stored codes, if both pictures have them in 8 bits.
    #[serde(rename = "8 bit")]
    Eight,
    /// Stored codes, if both pictures have them in 16 bits.
    #[serde(rename = "16 bit")]
    Sixteen,
}

/// The distance of a picture from a reference. Errors are of linear r, g, b (premultiplied); not a number on both sides
/// is no error, on one side it is counted in `nan_mismatches` and left out of the means.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Metrics {
    pub width: u32,
    pub height: u32,
    /// Pixels in which any channel, alpha included, differs (+0 and -0 do not).
    pub differing_pixels: u64,
    /// Channels that are not a number in one picture only.
    pub nan_mismatches: u64,
    /// Largest distance in `step`s of any channel, alpha included.
    pub max_ulp: u64,
    pub step: Step,
    /// Mean over pixels and r, g, b of the squared error.
    pub mse: f64,
    /// Its square root.
    pub rmse: f64,
    /// Mean of squared error / (reference^2 + 0.01).
    pub rel_mse: f64,
    /// Peak signal-to-noise ratio in dB of the displayed pictures (clamped, sRGB, peak 1); none if they are equal.
    pub psnr_db: Option<f64>,
    /// Largest absolute error, and the first pixel (x, y) that has it.
    pub max_abs: f64,
    pub max_abs_at: Option<[u32; 2]>,
    /// Mean of the FLIP map.
    pub flip: f64,
    /// Whether both are films, and the same: then hashes agree, and not only what can be seen.
    pub same_film: Option<bool>,
}

/// The visible difference of each pixel, 0 to 1.
pub struct FlipMap {
    map: nv_flip::FlipImageFloat,
}

impl FlipMap {
    /// Of two displayed pictures of one size at 67 pixels a degree (0.7 m from a 4K screen 0.7 m wide).
    /// Source: Andersson et al. 2020, FLIP: A Difference Evaluator for Alternating Images.
    pub fn new(reference: &Image, test: &Image) -> Self {
        let rgb8 = |image: &Image| {
            let codes = encode(image, &PLAIN, 255);
            let bytes: Vec<u8> = codes.iter().flat_map(|[r, g, b, _]| [*r as u8, *g as u8, *b as u8]).collect();
            nv_flip::FlipImageRgb8::with_data(image.width, image.height, &bytes)
        };
        Self { map: nv_flip::flip(rgb8(reference), rgb8(test), nv_flip::DEFAULT_PIXELS_PER_DEGREE) }
    }

    pub fn mean(&self) -> f64 {
        let values = self.map.to_vec();
        values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len() as f64
    }

    /// r, g, b bytes of the map in the magma colours: black is equal, white is as different as can be.
    pub fn colours(&self) -> Vec<u8> {
        self.map.apply_color_lut(&nv_flip::magma_lut()).to_vec()
    }
}

/// Linear light as it is, clamped.
const PLAIN: Display = Display { tonemap: ToneMap::Clamp, exposure: 0.0, gamma: None, transparent: false };

/// Number of f32 numbers from `a` to `b`; 0 for equal ones, for +0 and -0, and for two NaNs; none if one is a NaN.
pub fn ulp_distance(a: f32, b: f32) -> Option<u64> {
    // Bits in the order of the numbers, both zeros at 0.
    let ordered = |v: f32| {
        let magnitude = i64::from(v.to_bits() & 0x7fff_ffff);
        if v.is_sign_negative() { -magnitude } else { magnitude }
    };
    match (a.is_nan(), b.is_nan()) {
        (true, true) => Some(0),
        (false, false) => Some(ordered(a).abs_diff(ordered(b))),
        _ => None,
    }
}

/// Compares `test` with `reference`; an error (of `test_name`) if their sizes differ.
pub fn compare(
    (reference_name, reference): (&std::path::Path, &Picture),
    (test_name, test): (&std::path::Path, &Picture),
) -> Result<(Metrics, FlipMap), FilmError> {
    let (a, b) = (&reference.image, &test.image);
    if (a.width, a.height) != (b.width, b.height) {
        let sizes = format!("{}x{}, but {} is {}x{}", b.width, b.height, reference_name.display(), a.width, a.height);
        return Err(FilmError::bad(test_name, format!("the picture is {sizes}")));
    }
    let flip_map = FlipMap::new(a, b);
    let mut metrics = Metrics {
        width: a.width,
        height: a.height,
        differing_pixels: 0,
        nan_mismatches: 0,
        max_ulp: 0,
        step: Step::Float,
        mse: 0.0,
        rmse: 0.0,
        rel_mse: 0.0,
        psnr_db: psnr(a, b),
        max_abs: 0.0,
        max_abs_at: None,
        flip: flip_map.mean(),
        same_film: reference.film_hash.zip(test.film_hash).map(|(a, b)| a == b),
    };
    metrics.count_steps(reference, test);
    metrics.add_errors(a, b);
    Ok((metrics, flip_map))
}

impl Metrics {
    /// Whether nothing at all differs.
    pub fn equal(&self) -> bool {
        self.differing_pixels == 0 && self.same_film != Some(false)
    }

    fn count_steps(&mut self, a: &Picture, b: &Picture) {
        if let (Some(a), Some(b)) = (&a.codes, &b.codes)
            && a.bits == b.bits
        {
            self.step = if a.bits == 8 { Step::Eight } else { Step::Sixteen };
            for (a, b) in a.pixels.iter().zip(&b.pixels) {
                let steps = (0..4).map(|i| u64::from(a[i].abs_diff(b[i]))).max().unwrap_or(0);
                self.max_ulp = self.max_ulp.max(steps);
                self.differing_pixels += u64::from(steps > 0);
            }
            return;
        }
        for (a, b) in a.image.pixels.iter().zip(&b.image.pixels) {
            let mut differs = false;
            for i in 0..4 {
                match ulp_distance(a[i], b[i]) {
                    Some(ulp) => {
                        self.max_ulp = self.max_ulp.max(ulp);
                        differs |= ulp > 0;
                    }
                    None => {
                        self.nan_mismatches += 1;
                        differs = true;
                    }
                }
            }
            self.differing_pixels += u64::from(differs);
        }
    }

    fn add_errors(&mut self, a: &Image, b: &Image) {
        let (mut squares, mut relative, mut count) = (0.0, 0.0, 0u64);
        for (pixel, (a, b)) in a.pixels.iter().zip(&b.pixels).enumerate() {
            for (&a, &b) in a[..3].iter().zip(&b[..3]) {
                if a.is_nan() != b.is_nan() {
                    continue;
                }
                count += 1;
                // Equal infinities and two NaNs are no error, though their difference is no number.
                if a == b || a.is_nan() {
                    continue;
                }
                let (a, b) = (f64::from(a), f64::from(b));
                let error = (a - b).abs();
                squares += error * error;
                relative += if a.is_finite() { error * error / (a * a + RELATIVE_EPSILON) } else { f64::INFINITY };
                if error > self.max_abs {
                    self.max_abs = error;
                    self.max_abs_at = Some([pixel as u32 % self.width, pixel as u32 / self.width]);
                }
            }
        }
        if count > 0 {
            self.mse = squares / count as f64;
            self.rel_mse = relative / count as f64;
            self.rmse = self.mse.sqrt();
        }
    }
}

fn psnr(a: &Image, b: &Image) -> Option<f64> {
    let shown = |image: &Image| tone_map(image, &PLAIN).into_iter().flat_map(|[r, g, b, _]| [r, g, b].map(srgb_encode));
    let squares: f64 = shown(a).zip(shown(b)).map(|(a, b)| (a - b) * (a - b)).sum();
    let mse = squares / (a.pixels.len() * 3) as f64;
    (mse > 0.0).then(|| -10.0 * libm::log10(mse))
}
