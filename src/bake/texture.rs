//! Textures as the device reads them: one record for each texture of the scene, then the levels of their mip chains, then
//! one for each use by a material.

use super::mip::mip_levels;
use super::model::Baked;
use super::srgb::srgb_table;
use super::{BakeError, SceneArrays};
use crate::layout::{
    CHANNEL_A, CHANNEL_B, CHANNEL_G, CHANNEL_R, CHANNEL_RGB, MAGNIFY_BILINEAR, MAGNIFY_NEAREST, MATERIAL_ANISOTROPIC,
    MATERIAL_GENERAL_LOBES, MODEL_COOK_TORRANCE, MODEL_EMISSIVE, PARAMETER_ANISOTROPIC, PARAMETER_BUMP,
    PARAMETER_CLEARCOAT, PARAMETER_CLEARCOAT_GLOSS, PARAMETER_COLOR, PARAMETER_EMISSION, PARAMETER_FLATNESS,
    PARAMETER_MASK, PARAMETER_METALLIC, PARAMETER_NORMAL, PARAMETER_OPACITY, PARAMETER_ROUGHNESS,
    PARAMETER_ROUGHNESS_U, PARAMETER_ROUGHNESS_V, PARAMETER_SHEEN, PARAMETER_SHEEN_TINT, PARAMETER_SPEC_TINT,
    PARAMETER_SPEC_TRANS, PARAMETER_SPECULAR_COLOR, PARAMETER_WEIGHT, PATTERN_CHECKER, PATTERN_GRADIENT, PATTERN_NOISE,
    PATTERN_ZONE_PLATE, TEXEL_FLOAT, TEXEL_LINEAR8, TEXEL_SRGB8, TEXTURES_MOST, Texture, WRAP_CLAMP, WRAP_MIRROR,
    WRAP_REPEAT,
};
use crate::scene::{self, Channel, Parameter, Pattern, PatternKind, TextureBinding, TextureData, Wrap};

/// Bakes all textures; record i is texture i of the scene.
pub fn bake_textures(textures: &[scene::Texture], data: &mut SceneArrays) {
    for texture in textures {
        let record = bake_texture(texture, &mut data.texels);
        data.textures.push(record);
    }
    let table = srgb_table();
    for (index, texture) in textures.iter().enumerate().filter(|(_, texture)| texture.mipmap) {
        let levels = mip_levels(texture.width, texture.height, &texture.data, &table);
        data.textures[index].level_count = levels.len() as u32 + 1;
        data.textures[index].first_level = data.textures.len() as u32;
        for level in levels {
            let first_word = data.texels.len() as u32;
            append_texels(&level.data, &mut data.texels);
            let record = Texture { width: level.width, height: level.height, first_word, ..data.textures[index] };
            data.textures.push(record);
        }
    }
}

/// Appends a record for each texture that `material` binds, and writes their place into `baked`.
pub fn bind_textures(material: &scene::Material, baked: &mut Baked, data: &mut SceneArrays) -> Result<(), BakeError> {
    let count = material.textures.len();
    if count > TEXTURES_MOST as usize {
        return Err(BakeError::Textures { name: material.name.clone(), count });
    }
    (baked.first_texture, baked.texture_count) = (data.textures.len() as u32, count as u32);
    for binding in &material.textures {
        if matches!(binding.parameter, Parameter::RoughnessU | Parameter::RoughnessV) {
            baked.closure.flags |= MATERIAL_ANISOTROPIC;
            baked.closure.flags |= if baked.closure.model == MODEL_COOK_TORRANCE { MATERIAL_GENERAL_LOBES } else { 0 };
        }
        let mut record = bound(binding, data.textures[binding.texture.0 as usize]);
        // The colour of what shines by itself is its emission.
        if baked.closure.model == MODEL_EMISSIVE && record.parameter == PARAMETER_COLOR {
            record.parameter = PARAMETER_EMISSION;
        }
        data.textures.push(record);
    }
    Ok(())
}

fn bound(binding: &TextureBinding, texture: Texture) -> Texture {
    let parameter = match binding.parameter {
        Parameter::Color => PARAMETER_COLOR,
        Parameter::SpecularColor => PARAMETER_SPECULAR_COLOR,
        Parameter::Emission => PARAMETER_EMISSION,
        Parameter::Roughness => PARAMETER_ROUGHNESS,
        Parameter::RoughnessU => PARAMETER_ROUGHNESS_U,
        Parameter::RoughnessV => PARAMETER_ROUGHNESS_V,
        Parameter::Metallic => PARAMETER_METALLIC,
        Parameter::Opacity => PARAMETER_OPACITY,
        Parameter::Mask => PARAMETER_MASK,
        Parameter::Weight => PARAMETER_WEIGHT,
        Parameter::Normal => PARAMETER_NORMAL,
        Parameter::Bump => PARAMETER_BUMP,
        Parameter::Anisotropic => PARAMETER_ANISOTROPIC,
        Parameter::SpecTrans => PARAMETER_SPEC_TRANS,
        Parameter::SpecTint => PARAMETER_SPEC_TINT,
        Parameter::Sheen => PARAMETER_SHEEN,
        Parameter::SheenTint => PARAMETER_SHEEN_TINT,
        Parameter::Flatness => PARAMETER_FLATNESS,
        Parameter::Clearcoat => PARAMETER_CLEARCOAT,
        Parameter::ClearcoatGloss => PARAMETER_CLEARCOAT_GLOSS,
    };
    let channel = match binding.channel {
        Channel::Rgb => CHANNEL_RGB,
        Channel::R => CHANNEL_R,
        Channel::G => CHANNEL_G,
        Channel::B => CHANNEL_B,
        Channel::A => CHANNEL_A,
    };
    Texture { parameter, channel, scale: binding.scale, ..texture }
}

/// One texture; its words are appended to `texels`.
fn bake_texture(texture: &scene::Texture, texels: &mut Vec<u32>) -> Texture {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => WRAP_REPEAT,
        Wrap::Clamp => WRAP_CLAMP,
        Wrap::Mirror => WRAP_MIRROR,
    };
    let first_word = texels.len() as u32;
    append_texels(&texture.data, texels);
    Texture {
        width: texture.width,
        height: texture.height,
        first_word,
        format: match &texture.data {
            TextureData::Srgb8(_) => TEXEL_SRGB8,
            TextureData::Linear8(_) => TEXEL_LINEAR8,
            TextureData::Float(_) => TEXEL_FLOAT,
            TextureData::Pattern(pattern) => match pattern.kind {
                PatternKind::Checker => PATTERN_CHECKER,
                PatternKind::Noise { .. } => PATTERN_NOISE,
                PatternKind::Gradient => PATTERN_GRADIENT,
                PatternKind::ZonePlate => PATTERN_ZONE_PLATE,
            },
        },
        wrap_u: wrap(texture.wrap_u),
        wrap_v: wrap(texture.wrap_v),
        magnify: if texture.bilinear { MAGNIFY_BILINEAR } else { MAGNIFY_NEAREST },
        scale_u: texture.scale[0],
        scale_v: texture.scale[1],
        offset_u: texture.offset[0],
        offset_v: texture.offset[1],
        shear_u: texture.shear[0],
        shear_v: texture.shear[1],
        channel: CHANNEL_RGB,
        scale: 1.0,
        ..Texture::default()
    }
}

/// An image's words, from the top row down, or a pattern's (`shading/pattern`).
fn append_texels(data: &TextureData, texels: &mut Vec<u32>) {
    match data {
        TextureData::Srgb8(data) | TextureData::Linear8(data) => {
            texels.extend(data.iter().map(|&rgba| u32::from_le_bytes(rgba)));
        }
        TextureData::Float(data) => texels.extend(data.iter().flatten().map(|x| x.to_bits())),
        TextureData::Pattern(pattern) => texels.extend(pattern_words(pattern)),
    }
}

/// Two colours, octaves, gain, seed.
fn pattern_words(pattern: &Pattern) -> Vec<u32> {
    let (octaves, gain, seed) = match pattern.kind {
        PatternKind::Noise { octaves, gain, seed } => (octaves, gain, seed),
        PatternKind::Checker | PatternKind::Gradient | PatternKind::ZonePlate => (0, 0.0, 0),
    };
    let colors = pattern.colors.iter().flat_map(|color| color.to_array()).map(f32::to_bits);
    colors.chain([octaves, gain.to_bits(), seed]).collect()
}
