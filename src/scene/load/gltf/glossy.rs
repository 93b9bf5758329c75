//! KHR_materials_pbrSpecularGlossiness as metallic-roughness, texel by texel.
//!
//! Source: Khronos Group 2017, "Converting between workflows" (examples/convert-between-workflows of the extension):
//! the metal share is the one whose base colour explains both diffuse and specular reflectance, with 4 % from what is no metal.

use super::material::{Surface, clamp_color, clamp01};
use crate::scene::load::image::srgb_to_linear;
use crate::scene::{Rgb, Texture, TextureData};
use gltf::json::extensions::material::PbrSpecularGlossiness;
use std::sync::Arc;

/// Reflectance at normal incidence of what is no metal.
const DIELECTRIC: f64 = 0.04;
/// Below this a share divides nothing.
const LEAST: f64 = 1.0e-6;

/// What metallic-roughness calls the same.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Metallic {
    base: [f64; 3],
    metallic: f64,
}

/// The surface of a material; a texture's texels times its factors.
pub(super) fn surface(
    source: &PbrSpecularGlossiness,
    diffuse: Option<Texture>,
    specular: Option<Texture>,
    opaque: bool,
) -> Surface {
    let [r, g, b, alpha] = source.diffuse_factor.0;
    let factors = [clamp_color([r, g, b]), clamp_color(source.specular_factor.0)].map(|c| c.to_array().map(f64::from));
    let gloss = f64::from(clamp01(source.glossiness_factor.0));
    let plain = Surface {
        base: Rgb::ONE,
        alpha: clamp01(alpha),
        base_texture: None,
        opaque,
        metallic: 1.0,
        roughness: 1.0,
        texture: None,
        eta: 1.5,
    };
    let Some(laid) = diffuse.as_ref().or(specular.as_ref()).cloned() else {
        let found = metallic(factors[0], factors[1]);
        return Surface {
            base: Rgb::from_array(found.base.map(|c| c as f32)),
            metallic: found.metallic as f32,
            roughness: (1.0 - gloss) as f32,
            ..plain
        };
    };
    let side = |pick: fn(&Texture) -> u32| [&diffuse, &specular].into_iter().flatten().map(pick).max().unwrap_or(1);
    let (width, height) = (side(|t| t.width), side(|t| t.height));
    let (diffuse, specular) = (Picture::new(diffuse), Picture::new(specular));
    let encode = SrgbEncoder::new();
    let byte = |v: f64| (v * 255.0 + 0.5).clamp(0.0, 255.0) as u8;
    let texel = |at: u64| {
        let place = [(at % u64::from(width)) as u32, (at / u64::from(width)) as u32];
        let ([dr, dg, db, a], [sr, sg, sb, shine]) =
            (diffuse.at(place, width, height), specular.at(place, width, height));
        let times = |color: [f64; 3], factor: [f64; 3]| std::array::from_fn(|i| color[i] * factor[i]);
        let found = metallic(times([dr, dg, db], factors[0]), times([sr, sg, sb], factors[1]));
        let [r, g, b] = found.base.map(|c| encode.byte(c));
        ([r, g, b, byte(a)], [0, byte(1.0 - shine * gloss), byte(found.metallic), 255])
    };
    let (bases, rest): (Vec<[u8; 4]>, Vec<[u8; 4]>) = (0..u64::from(width) * u64::from(height)).map(texel).unzip();
    let made = |data: TextureData| Texture { width, height, data, ..laid.clone() };
    Surface {
        base_texture: Some(made(TextureData::Srgb8(Arc::new(bases)))),
        texture: Some(made(TextureData::Linear8(Arc::new(rest)))),
        ..plain
    }
}

fn brightness([r, g, b]: [f64; 3]) -> f64 {
    libm::sqrt(0.299 * r * r + 0.587 * g * g + 0.114 * b * b)
}

/// Base colour and metal share of a diffuse and a specular reflectance.
fn metallic(diffuse: [f64; 3], specular: [f64; 3]) -> Metallic {
    let kept = 1.0 - specular.iter().fold(0.0f64, |most, c| most.max(*c));
    let share = metal_share(brightness(diffuse), brightness(specular), kept);
    let base = std::array::from_fn(|i| {
        let from_diffuse = diffuse[i] * kept / (1.0 - DIELECTRIC) / (1.0 - share).max(LEAST);
        let from_specular = (specular[i] - DIELECTRIC * (1.0 - share)) / share.max(LEAST);
        (from_diffuse + (from_specular - from_diffuse) * share * share).clamp(0.0, 1.0)
    });
    Metallic { base, metallic: share }
}

/// The root of the quadratic that equates both base colours.
fn metal_share(diffuse: f64, specular: f64, kept: f64) -> f64 {
    if specular < DIELECTRIC {
        return 0.0;
    }
    let b = diffuse * kept / (1.0 - DIELECTRIC) + specular - 2.0 * DIELECTRIC;
    let c = DIELECTRIC - specular;
    let root = libm::sqrt((b * b - 4.0 * DIELECTRIC * c).max(0.0));
    ((root - b) / (2.0 * DIELECTRIC)).clamp(0.0, 1.0)
}

/// The texels of a texture as reflectances; white without one.
struct Picture {
    texture: Option<Texture>,
    table: Vec<f64>,
}

impl Picture {
    fn new(texture: Option<Texture>) -> Self {
        Self { texture, table: (0..256).map(|code| srgb_to_linear(f64::from(code) / 255.0)).collect() }
    }

    /// The texel under `place` of a picture of `width` x `height`.
    fn at(&self, [x, y]: [u32; 2], width: u32, height: u32) -> [f64; 4] {
        let Some(texture) = &self.texture else { return [1.0; 4] };
        let scaled = |at: u32, size: u32, of: u32| (u64::from(at) * u64::from(of) / u64::from(size)) as usize;
        let index = scaled(y, height, texture.height) * texture.width as usize + scaled(x, width, texture.width);
        match &texture.data {
            TextureData::Srgb8(texels) => {
                let [r, g, b, a] = texels[index];
                let decode = |code: u8| self.table[usize::from(code)];
                [decode(r), decode(g), decode(b), f64::from(a) / 255.0]
            }
            TextureData::Linear8(texels) => texels[index].map(|code| f64::from(code) / 255.0),
            TextureData::Float(texels) => texels[index].map(f64::from),
            TextureData::Pattern(_) => [1.0; 4],
        }
    }
}

/// Nearest sRGB codes of linear values.
struct SrgbEncoder {
    /// Where one code gives way to the next.
    thresholds: Vec<f64>,
}

impl SrgbEncoder {
    fn new() -> Self {
        let middle = |code: u32| srgb_to_linear((f64::from(code) + 0.5) / 255.0);
        Self { thresholds: (0..255).map(middle).collect() }
    }

    fn byte(&self, v: f64) -> u8 {
        self.thresholds.partition_point(|t| *t <= v) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metals_and_what_is_none_are_told_apart() {
        let plastic = metallic([0.5, 0.2, 0.1], [0.04; 3]);
        assert!(plastic.metallic < 1e-9, "{plastic:?}");
        assert!((plastic.base[0] - 0.5).abs() < 1e-9 && (plastic.base[2] - 0.1).abs() < 1e-9, "{plastic:?}");
        let gold = metallic([0.0; 3], [1.0, 0.77, 0.34]);
        assert!((gold.metallic - 1.0).abs() < 1e-9, "{gold:?}");
        assert!((gold.base[1] - 0.77).abs() < 1e-9, "{gold:?}");
        let dark = metallic([0.3; 3], [0.0; 3]);
        assert!(dark.metallic == 0.0 && dark.base[0] > 0.3);
    }

    #[test]
    fn every_code_is_its_own_nearest() {
        let encoder = SrgbEncoder::new();
        for code in 0..=255u8 {
            assert_eq!(encoder.byte(srgb_to_linear(f64::from(code) / 255.0)), code);
        }
    }
}
