//! From linear light to a display: exposure, tone curve, sRGB, integers. Apart from the film: a film can be shown in
//! many ways. Only the `libm` crate's transcendental functions, so that the file is the same bytes on every machine.

use super::Image;
use crate::scene::ToneMap;
use rayon::prelude::*;

/// How to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    pub tonemap: ToneMap,
    /// In stops: light is multiplied by 2^exposure.
    pub exposure: f32,
    /// Keep alpha (unpremultiplied); otherwise the picture is opaque and alpha is dropped.
    pub transparent: bool,
}

/// Names of the tone curves, as scene files and flags write them.
pub const TONEMAP_NAMES: [(&str, ToneMap); 3] =
    [("clamp", ToneMap::Clamp), ("normalise", ToneMap::Normalise), ("reinhard", ToneMap::Reinhard)];

/// The curve of that name; an error names what is allowed.
pub fn tonemap_from_name(name: &str) -> Result<ToneMap, String> {
    let named = TONEMAP_NAMES.iter().find(|(n, _)| *n == name);
    named.map(|(_, curve)| *curve).ok_or_else(|| "allowed: clamp, normalise, reinhard".into())
}

/// The name of a curve.
pub fn tonemap_name(tonemap: ToneMap) -> &'static str {
    match tonemap {
        ToneMap::Clamp => "clamp",
        ToneMap::Normalise => "normalise",
        ToneMap::Reinhard => "reinhard",
    }
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

/// Nearest integer of 0..=`max` to a value of 0 to 1 times `max`, halves up. Below 0 and NaN give 0, above 1 `max`.
pub fn quantise(value: f64, max: u16) -> u16 {
    // `as` turns NaN into 0.
    (value * f64::from(max) + 0.5).clamp(0.0, f64::from(max)) as u16
}

/// Rec. 709 luminance.
fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
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
    let light = rgb.map(|v| v * gain);
    let curve = match display.tonemap {
        ToneMap::Clamp | ToneMap::Normalise => 1.0,
        // equation 3: L_d = L / (1 + L), with hue and saturation kept (Reinhard et al. 2002)
        ToneMap::Reinhard => 1.0 / (1.0 + luminance(light)),
    };
    let [r, g, b] = light.map(|v| (v * curve).min(1.0));
    [r, g, b, alpha]
}

/// Exposure and tone curve: linear light of the display and alpha, each 0 to 1. Colour is not premultiplied in the
/// result. `Normalise` divides by the largest of r, g, b in the whole image.
/// Source: Reinhard, Stark, Shirley, Ferwerda 2002, Photographic Tone Reproduction for Digital Images, equation 3.
pub fn tone_map(image: &Image, display: &Display) -> Vec<[f64; 4]> {
    let gain = gain(image, display);
    image.pixels.par_iter().map(|&pixel| tone_map_pixel(pixel, gain, display)).collect()
}

/// The displayed picture in integers of 0..=`max` (255 or 65,535): sRGB, and linear alpha where transparent, else `max`.
pub fn encode(image: &Image, display: &Display, max: u16) -> Vec<[u16; 4]> {
    let gain = gain(image, display);
    let integers = |&pixel: &[f32; 4]| {
        let [r, g, b, alpha] = tone_map_pixel(pixel, gain, display);
        let [r, g, b] = [r, g, b].map(|v| quantise(srgb_encode(v), max));
        [r, g, b, quantise(alpha, max)]
    };
    image.pixels.par_iter().map(integers).collect()
}
