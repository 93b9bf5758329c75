//! From linear light to a display: exposure, tone curve, sRGB or gamma, integers. Apart from the film: a film can be shown in
//! many ways. Only the `libm` crate's transcendental functions, so that the file is the same bytes on every machine.

use super::Image;
use super::tone::tone_curve;
use crate::scene::ToneMap;
use rayon::prelude::*;

/// How to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    pub tonemap: ToneMap,
    /// In stops: light is multiplied by 2^exposure.
    pub exposure: f32,
    /// Integers hold light to the power 1/gamma; none: sRGB.
    pub gamma: Option<f32>,
    /// Keep alpha (unpremultiplied); otherwise the picture is opaque and alpha is dropped.
    pub transparent: bool,
}

/// Linear light, 0 to 1, as sRGB, 0 to 1.
/// Source: IEC 61966-2-1:1999, 5.2.
pub fn srgb_encode(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

/// sRGB, 0 to 1, as linear light, 0 to 1; inverse of `srgb_encode`.
/// Source: IEC 61966-2-1:1999, 5.3.
pub fn srgb_decode(encoded: f64) -> f64 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// Linear light, 0 to 1, as integers store it, 0 to 1: to the power 1/gamma, sRGB without.
pub fn display_encode(linear: f64, gamma: Option<f32>) -> f64 {
    gamma.map_or_else(|| srgb_encode(linear), |gamma| libm::pow(linear, 1.0 / f64::from(gamma)))
}

/// Nearest integer of 0..=`max` to a value of 0 to 1 times `max`, halves up. Below 0 and NaN give 0, above 1 `max`.
pub fn quantise(value: f64, max: u16) -> u16 {
    // `as` turns NaN into 0.
    (value * f64::from(max) + 0.5).clamp(0.0, f64::from(max)) as u16
}

/// Colour and alpha as they are shown, before the curve: divided by alpha where the picture is transparent; not a
/// number and negative values (a filter's negative lobes) become 0, infinite ones finite.
fn visible(pixel: [f32; 4], transparent: bool) -> ([f64; 3], f64) {
    let finite = |v: f64| v.max(0.0).min(f64::from(f32::MAX));
    let alpha = if transparent { finite(f64::from(pixel[3])).min(1.0) } else { 1.0 };
    let unpremultiply = |v: f32| {
        if alpha > 0.0 { finite(f64::from(v) / alpha) } else { 0.0 }
    };
    ([unpremultiply(pixel[0]), unpremultiply(pixel[1]), unpremultiply(pixel[2])], alpha)
}

/// The factor on all light before the curve: exposure, and for `Normalise` the image's maximum, which then becomes
/// 2^exposure. An image without light stays black.
fn gain(image: &Image, display: &Display) -> f64 {
    let exposure = libm::exp2(f64::from(display.exposure));
    if display.tonemap != ToneMap::Normalise {
        return exposure;
    }
    let largest = |p: &[f32; 4]| visible(*p, display.transparent).0.into_iter().fold(0.0, f64::max);
    let maximum = image.pixels.iter().map(largest).fold(0.0, f64::max);
    if maximum > 0.0 { exposure / maximum } else { exposure }
}

/// One pixel after exposure and curve: linear light of the display and alpha, each 0 to 1.
fn tone_map_pixel(pixel: [f32; 4], gain: f64, display: &Display) -> [f64; 4] {
    let (rgb, alpha) = visible(pixel, display.transparent);
    // Only a finite light has a place on a curve.
    let [r, g, b] = tone_curve(display.tonemap, rgb.map(|v| (v * gain).min(f64::from(f32::MAX))));
    [r, g, b, alpha]
}

/// A pixel of the display (not premultiplied) before a backdrop.
fn over([r, g, b, alpha]: [f64; 4], backdrop: Option<[f32; 3]>) -> [f64; 4] {
    let Some(behind) = backdrop else { return [r, g, b, alpha] };
    let [r, g, b] = [0, 1, 2].map(|i| [r, g, b][i] * alpha + f64::from(behind[i]) * (1.0 - alpha));
    [r, g, b, 1.0]
}

/// Exposure and tone curve: linear light of the display and alpha, each 0 to 1. Colour is not premultiplied in the
/// result. `Normalise` divides by the largest of r, g, b in the whole image.
pub fn tone_map(image: &Image, display: &Display) -> Vec<[f64; 4]> {
    let gain = gain(image, display);
    image.pixels.par_iter().map(|&pixel| tone_map_pixel(pixel, gain, display)).collect()
}

/// The displayed picture in integers of 0..=`max` (255 or 65,535): encoded light, and linear alpha where transparent, else
/// `max`.
pub fn encode(image: &Image, display: &Display, max: u16) -> Vec<[u16; 4]> {
    encode_over(image, display, None, max)
}

/// The same, opaque before `backdrop` where there is one: linear light of the display, 0 to 1.
pub fn encode_over(image: &Image, display: &Display, backdrop: Option<[f32; 3]>, max: u16) -> Vec<[u16; 4]> {
    let gain = gain(image, display);
    let integers = |&pixel: &[f32; 4]| {
        let [r, g, b, alpha] = over(tone_map_pixel(pixel, gain, display), backdrop);
        let [r, g, b] = [r, g, b].map(|v| quantise(display_encode(v, display.gamma), max));
        [r, g, b, quantise(alpha, max)]
    };
    image.pixels.par_iter().map(integers).collect()
}
