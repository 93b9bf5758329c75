//! Pictures against those of Mitsuba 3: its own z-test where a reference and its variance are known, and the pictures of
//! its documentation.

use crate::film::Image;
use crate::film::display::srgb_encode;
use std::path::{Path, PathBuf};

/// Share of channel values that must be accepted.
pub const ACCEPTED_MIN: f64 = 0.9975;
/// Significance of the test as a whole; Šidák's correction gives each pixel's share.
const SIGNIFICANCE: f64 = 0.01;
/// Variances below this are taken as this: a pixel whose samples all agree is not exact either.
const VARIANCE_MIN: f64 = 1e-4;
/// Samples of a whole picture from which the samples a pixel follow.
const SAMPLES: f64 = 2e6;

/// Folders within the folder that is searched.
const DEPTH_MAX: u32 = 8;

/// What a scene is compared with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reference {
    /// Mean and variance of one sample, linear EXR.
    Statistics { mean: PathBuf, variance: PathBuf },
    /// A displayed picture.
    Displayed(PathBuf),
}

/// A scene and its reference.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    pub scene: PathBuf,
    pub reference: Reference,
}

/// The scenes below `folder` that have a reference, in order: `X_INTEGRATOR.xml` with `refs/X_ref_rgb.exr` and
/// `refs/X_ref_rgb_var.exr`, and `scenes/X.xml` with `images/render/X.jpg`.
pub fn find_cases(folder: &Path) -> std::io::Result<Vec<Case>> {
    let mut scenes = Vec::new();
    collect(folder, 0, &mut scenes)?;
    scenes.sort();
    Ok(scenes.into_iter().filter_map(|scene| reference_of(&scene).map(|reference| Case { scene, reference })).collect())
}

fn collect(folder: &Path, depth: u32, scenes: &mut Vec<PathBuf>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() && depth < DEPTH_MAX {
            collect(&path, depth + 1, scenes)?;
        } else if path.extension().is_some_and(|extension| extension == "xml") {
            scenes.push(path);
        }
    }
    Ok(())
}

fn reference_of(scene: &Path) -> Option<Reference> {
    let folder = scene.parent()?;
    let name = scene.file_stem()?.to_str()?;
    if let Some((stem, _)) = name.rsplit_once('_') {
        let [mean, variance] =
            ["", "_var"].map(|suffix| folder.join("refs").join(format!("{stem}_ref_rgb{suffix}.exr")));
        if mean.is_file() && variance.is_file() {
            return Some(Reference::Statistics { mean, variance });
        }
    }
    let displayed = folder.parent()?.join("images/render").join(format!("{name}.jpg"));
    displayed.is_file().then_some(Reference::Displayed(displayed))
}

/// Samples a pixel that Mitsuba's test takes of a picture of this size.
pub fn samples_for(width: u32, height: u32) -> u32 {
    (SAMPLES / (f64::from(width) * f64::from(height))).ceil().max(1.0) as u32
}

/// How a picture lies around its reference.
#[derive(Clone, Debug, PartialEq)]
pub struct ZTest {
    /// Share of the X, Y and Z values that are accepted, 0 to 1.
    pub accepted: f64,
    /// Mean of all values over that of the reference.
    pub brightness: f64,
    /// Largest |z|, and its pixel (x, y).
    pub worst: f64,
    pub worst_at: [u32; 2],
    /// Signed z of each pixel's X, Y and Z: too bright is positive.
    pub z: Image,
}

impl ZTest {
    pub fn passes(&self) -> bool {
        self.accepted >= ACCEPTED_MIN
    }
}

/// Tests each value against the reference: z = |mean - reference| sqrt(samples / variance) is accepted where its p-value
/// under a normal distribution is above the corrected significance. The images have the same size.
/// Source: Mitsuba 3, `src/render/tests/test_renders.py`.
pub fn z_test(image: &Image, reference: &Image, variance: &Image, samples: u32) -> ZTest {
    debug_assert!(image.pixels.len() == reference.pixels.len() && image.pixels.len() == variance.pixels.len());
    let pixels = image.pixels.len();
    let significance = 1.0 - libm::pow(1.0 - SIGNIFICANCE, 1.0 / pixels as f64);
    let mut test = ZTest {
        accepted: 0.0,
        brightness: 0.0,
        worst: 0.0,
        worst_at: [0; 2],
        z: Image { width: image.width, height: image.height, pixels: Vec::with_capacity(pixels) },
    };
    let (mut accepted, mut sums) = (0u64, [0.0, 0.0]);
    for (index, (pixel, (mean, variance))) in
        image.pixels.iter().zip(reference.pixels.iter().zip(&variance.pixels)).enumerate()
    {
        let (found, wanted, variance) = (xyz(pixel), xyz(mean), xyz(variance));
        let mut z = [0.0f32; 4];
        for lane in 0..3 {
            let deviation = libm::sqrt(variance[lane].max(VARIANCE_MIN) / f64::from(samples));
            let value = (found[lane] - wanted[lane]) / deviation;
            // Two-sided: 2 (1 - Phi(|z|)). NaN is not accepted.
            accepted += u64::from(libm::erfc(value.abs() * std::f64::consts::FRAC_1_SQRT_2) > significance);
            sums[0] += found[lane];
            sums[1] += wanted[lane];
            // The first value that is no number stays the worst.
            if value.abs() > test.worst || (value.is_nan() && !test.worst.is_nan()) {
                test.worst = value.abs();
                test.worst_at = [index as u32 % image.width, index as u32 / image.width];
            }
            z[lane] = value as f32;
        }
        test.z.pixels.push(z);
    }
    test.accepted = accepted as f64 / (3 * pixels) as f64;
    test.brightness = sums[0] / sums[1];
    test
}

/// CIE XYZ of linear Rec. 709; linear, so variances go the same way in Mitsuba's test.
fn xyz(pixel: &[f32; 4]) -> [f64; 3] {
    let [r, g, b, _] = pixel.map(f64::from);
    [
        0.412453 * r + 0.357580 * g + 0.180423 * b,
        0.212671 * r + 0.715160 * g + 0.072169 * b,
        0.019334 * r + 0.119193 * g + 0.950227 * b,
    ]
}

/// How far a picture is from a displayed one, in 8-bit code values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayTest {
    /// Largest difference between the means of a channel.
    pub mean: f64,
    /// Mean absolute difference of all values.
    pub absolute: f64,
}

impl DisplayTest {
    /// What noise and JPEG leave of agreement: Mitsuba's own pictures at 64 samples stay below 2 and 6.
    pub const LIMITS: Self = Self { mean: 3.0, absolute: 8.0 };

    pub fn passes(&self) -> bool {
        self.mean <= Self::LIMITS.mean && self.absolute <= Self::LIMITS.absolute
    }
}

/// Compares displayed values of two linear images of the same size, clamped to 0 and 1.
pub fn display_test(image: &Image, reference: &Image) -> DisplayTest {
    debug_assert_eq!(image.pixels.len(), reference.pixels.len());
    let code = |v: f32| 255.0 * srgb_encode(f64::from(v).clamp(0.0, 1.0));
    let (mut signed, mut absolute) = ([0.0f64; 3], 0.0);
    for (a, b) in image.pixels.iter().zip(&reference.pixels) {
        for lane in 0..3 {
            let difference = code(a[lane]) - code(b[lane]);
            signed[lane] += difference;
            absolute += difference.abs();
        }
    }
    let pixels = image.pixels.len() as f64;
    let mean = signed.iter().map(|sum| (sum / pixels).abs()).fold(0.0, f64::max);
    DisplayTest { mean, absolute: absolute / (3.0 * pixels) }
}

/// The image with each `factor` by `factor` block as the mean of its values, what is left over at the right and bottom goes.
/// Noise goes beyond white and comes back in a mean: it is not cut off first, which would darken all that is noisy.
pub fn reduce(image: &Image, factor: u32) -> Image {
    let (width, height) = (image.width / factor, image.height / factor);
    let mut pixels = Vec::with_capacity((width * height) as usize);
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0.0f64; 4];
            for (dy, dx) in (0..factor).flat_map(|dy| (0..factor).map(move |dx| (dy, dx))) {
                let pixel = image.pixels[((y * factor + dy) * image.width + x * factor + dx) as usize];
                (0..4).for_each(|lane| sum[lane] += f64::from(pixel[lane]));
            }
            pixels.push(sum.map(|v| (v / f64::from(factor * factor)) as f32));
        }
    }
    Image { width, height, pixels }
}

/// A z map to look at: red where the picture is too bright, blue where too dark, full at |z| = 6; of the luminance.
pub fn show_z(test: &ZTest) -> Vec<u8> {
    let colour = |z: &[f32; 4]| {
        let strength = (z[1] / 6.0).clamp(-1.0, 1.0);
        let faded = (255.0 * (1.0 - strength.abs())) as u8;
        if strength >= 0.0 { [255, faded, faded] } else { [faded, faded, 255] }
    };
    test.z.pixels.iter().flat_map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `count` grey pixels in a row.
    fn grey(values: impl IntoIterator<Item = f32>) -> Image {
        let pixels: Vec<[f32; 4]> = values.into_iter().map(|v| [v, v, v, 1.0]).collect();
        Image { width: pixels.len() as u32, height: 1, pixels }
    }

    fn tested(shift: f32, pixels: usize) -> ZTest {
        let reference = grey(vec![1.0; 1000]);
        let variance = grey(vec![1.0; 1000]);
        let image = grey((0..1000).map(|i| if i < pixels { 1.0 + shift } else { 1.0 }));
        z_test(&image, &reference, &variance, 100)
    }

    #[test]
    fn an_image_within_its_noise_passes_and_its_z_is_the_distance_in_deviations() {
        // One deviation of a mean of 100 samples of variance 1 (Y of white is 1 within rounding).
        let test = tested(0.1, 1000);
        assert!(test.passes() && (test.worst - 1.0).abs() < 0.07, "{} {}", test.accepted, test.worst);
        assert!((test.brightness - 1.1).abs() < 1e-6);
    }

    #[test]
    fn three_pixels_of_a_thousand_beyond_the_limit_fail_and_two_do_not() {
        // Šidák at 1000 pixels: |z| = 4.4; 6 deviations are beyond it in each of X, Y, Z.
        assert!(tested(0.6, 2).passes());
        let test = tested(0.6, 3);
        assert!(!test.passes(), "{}", test.accepted);
        assert!((test.accepted - 0.997).abs() < 1e-12);
    }

    #[test]
    fn a_four_percent_brighter_image_is_rejected_where_noise_is_small() {
        let (reference, variance) = (grey(vec![1.0; 1000]), grey(vec![0.05; 1000]));
        let test = z_test(&grey(vec![1.04; 1000]), &reference, &variance, 868);
        assert!(!test.passes(), "{}", test.accepted);
        assert_eq!(show_z(&test)[..3], [255, 31, 31]);
    }

    #[test]
    fn a_pixel_that_is_no_number_is_not_accepted() {
        let flat = grey(vec![1.0; 10]);
        let test = z_test(&grey((0..10).map(|i| if i == 3 { f32::NAN } else { 1.0 })), &flat, &flat, 10);
        assert!(!test.passes() && test.worst_at == [3, 0]);
    }

    #[test]
    fn displayed_pictures_are_measured_in_code_values() {
        let dark = display_test(&grey(vec![0.0; 4]), &grey(vec![0.0, 0.0, 0.0, 2.0]));
        // 2 is shown as 1, and a quarter of 255 is 63.75.
        assert!((dark.mean - 63.75).abs() < 1e-9 && (dark.absolute - 63.75).abs() < 1e-9, "{dark:?}");
        assert!(!dark.passes() && display_test(&grey(vec![0.5; 4]), &grey(vec![0.51; 4])).passes());
    }

    #[test]
    fn blocks_are_reduced_to_their_means() {
        let image = Image { width: 3, height: 2, pixels: [0.0, 1.5, 9.0, 0.5, 0.0, 9.0].map(|v| [v; 4]).to_vec() };
        assert_eq!(reduce(&image, 2), Image { width: 1, height: 1, pixels: vec![[0.5; 4]] });
    }
}
