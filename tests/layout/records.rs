//! Every record and every constant of `src/layout`, as Rust sees them. New ones are added here.

use std::collections::BTreeMap;
use std::mem::{offset_of, size_of};

use glam::{Vec3, Vec4};
use gonio::layout::*;

use super::reflect::Member;

/// How GLSL writes a Rust type that may cross the bus.
trait Glsl {
    const NAME: &'static str;
}

macro_rules! glsl {
    ($($rust:ty => $name:literal),* $(,)?) => {$(
        impl Glsl for $rust {
            const NAME: &'static str = $name;
        }
    )*};
}

glsl! {
    u32 => "uint",
    f32 => "float",
    Vec3 => "vec3",
    Vec4 => "vec4",
    [u32; 2] => "uvec2",
    [u32; 4] => "uvec4",
    [Vec4; 3] => "vec4[3]",
    [u32; MAX_LEVELS as usize] => "uint[66]",
    [u32; MAX_SHADE_GROUPS as usize] => "uint[24]",
    [DispatchArguments; MAX_SHADE_GROUPS as usize] => "DispatchArguments[24]",
    Camera => "Camera",
    DispatchArguments => "DispatchArguments",
    FilmSum => "FilmSum",
    Ray => "Ray",
}

/// The GLSL name of the type a member has.
fn glsl_type<S, T: Glsl>(_: fn(&S) -> &T) -> &'static str {
    T::NAME
}

/// A record as Rust lays it out.
pub struct Record {
    pub name: &'static str,
    pub size: usize,
    pub members: Vec<Member>,
}

impl Record {
    /// `PathState` is `path_state` where functions are named after it.
    pub fn snake_name(&self) -> String {
        let mut result = String::new();
        for (at, letter) in self.name.char_indices() {
            if letter.is_uppercase() && at > 0 {
                result.push('_');
            }
            result.extend(letter.to_lowercase());
        }
        result
    }
}

macro_rules! records {
    ($($record:ident { $($member:ident),* $(,)? })*) => {
        /// Every record, in the order of `main` in the layout kernel.
        pub fn records() -> Vec<Record> {
            $(
                // A member missing from the list does not compile.
                let _ = |$record { $($member: _),* }: $record| ();
            )*
            vec![$(Record {
                name: stringify!($record),
                size: size_of::<$record>(),
                members: vec![$(Member {
                    // `_pad0` is `pad0` in GLSL.
                    name: stringify!($member).trim_start_matches('_').to_owned(),
                    glsl: glsl_type(|record: &$record| &record.$member).to_owned(),
                    offset: offset_of!($record, $member),
                }),*],
            }),*]
        }
    };
}

records! {
    Node {
        origin, exponents_imask, children, primitive_base, child_meta, min_x, max_x, min_y, max_y, min_z, max_z,
    }
    Triangle { v0, primitive, v1, _pad0, v2, _pad1 }
    Instance { to_world, to_object, kind, root, first_face, material, flags, object, light_density, _pad0 }
    Face { i0, i1, i2, material }
    Vertex { position, u, normal, v, color, _pad0 }
    Material {
        color, model, specular_color, exponent, k_a, k_d, k_s, k_r, eta, m0, k, m1, w0, w1, k_t, flags,
        transmit_color, first_texture, absorption, table, emission, texture_count, m0_v, m1_v, exponent_v, extra,
    }
    Light {
        position, kind, direction, attenuation, intensity, cos_outer, c, cos_inner, flaps_min, exponent,
        flaps_max, casts_shadow, slide, table, _pad0, _pad1,
    }
    Texture {
        width, height, first_word, format, wrap_u, wrap_v, magnify, level_count, scale_u, scale_v, offset_u, offset_v,
        shear_u, shear_v, first_level, parameter, channel, scale, _pad0, _pad1,
    }
    Hit { t, b1, b2, instance, primitive, _pad0, _pad1, _pad2 }
    PathState {
        ray, throughput, slot, pixel, sample_index, path_id, depth, coverage, eta, pdf, absorption, interior,
        passed, flags, _pad0, _pad1,
    }
    ShadowRay { ray, contribution, slot, dither, layer, weight }
    Camera {
        eye, kind, right, scale_x, up, scale_y, forward, pixel_size, lens_radius, focus_distance, shift_x, shift_y,
    }
    SceneHeader {
        camera, ambient, integrator, background_bottom, max_depth, background_top, min_weight, seed, sampling,
        strata, shadows, filter_kind, filter_radius, filter_norm, filter_table, top_root, instance_count,
        light_count, material_count, first_instance, first_top_instance, first_face, first_vertex, first_material,
        first_light, first_texture, first_texel, first_table, film_scale, hide_background, aovs, top_margin,
        emitter_count, first_emitter, environment_maps, first_environment_map, emitter_table, environment_density,
        rr_depth, clamp, level_count, glows, shadow_rays, media_table, nested, shadowless,
        hide_emitters,
    }
    Batch {
        crop_x, crop_y, crop_width, crop_height, first_pixel, pixel_count, first_sample, sample_count, slot_count,
        is_first, _pad0, _pad1,
    }
    FilmSum { low, high }
    AovPixel { normal, albedo, depth, object, material, _pad0 }
    Ray { origin, t_max, direction, skip_instance, skip_primitive, skip_inward, cone_width, cone_spread }
    DispatchArguments { x, y, z }
    Control {
        extend, camera, shadow, shade, shade_count, done, chunk_level, chunk_first, chunk_stored, chunk_count, shadow_pending, shadow_count, shadow_first,
        chunk_limit, level0_capacity, level_capacity, shadow_capacity, overflows, nan_count, clamped_count,
        limited_count, closest_rays, shadow_rays, rounds, camera_count, level_count,
    }
    Emitter { corner, kind, edge1, instance, edge2, primitive, normal, density, radiance, flags }
    EnvironmentMap { to_local, scale, texture, width, height, first_table, _pad0 }
}

/// Public structs of `src/layout` that stay on the host.
pub const HOST_ONLY: [&str; 1] = ["SceneView"];

trait Bits {
    fn bits(self) -> u32;
}

impl Bits for u32 {
    fn bits(self) -> u32 {
        self
    }
}

impl Bits for f32 {
    fn bits(self) -> u32 {
        self.to_bits()
    }
}

macro_rules! constants {
    ($($name:ident)*) => {
        /// Every constant of `src/layout`: name and bits.
        pub fn constants() -> BTreeMap<String, u32> {
            BTreeMap::from([$((stringify!($name).to_owned(), $name.bits())),*])
        }
    };
}

constants! {
    INVALID
    CAMERA_PERSPECTIVE CAMERA_ORTHOGRAPHIC
    MAX_LEVELS MAX_SHADE_GROUPS SHADE_GROUP_MISSED STACK_SIZE
    KIND_MESH KIND_SPHERE INSTANCE_NO_SHADOW INSTANCE_MIRRORED INSTANCE_FLAT INSTANCE_GOURAUD
    INTEGRATOR_LOCAL INTEGRATOR_WHITTED INTEGRATOR_PATH
    SAMPLER_SOBOL SAMPLER_STRATIFIED SAMPLER_INDEPENDENT
    SHADOWS_OFF SHADOWS_OPAQUE SHADOWS_FILTERED FILTER_BOX FILTER_TENT FILTER_TABLE FILTER_KNOTS
    LIGHT_POINT LIGHT_DIRECTIONAL LIGHT_SPOT SLIDE_ENTRIES
    ATTENUATION_INVERSE_SQUARE ATTENUATION_POLYNOMIAL ATTENUATION_NONE
    MODEL_LAMBERT MODEL_PHONG MODEL_BLINN_PHONG MODEL_COOK_TORRANCE MODEL_MIRROR MODEL_DIELECTRIC MODEL_EMISSIVE
    MODEL_OREN_NAYAR MODEL_WARD MODEL_ASHIKHMIN_SHIRLEY MODEL_KELEMEN MODEL_CONDUCTOR MODEL_ROUGH_CONDUCTOR MODEL_ROUGH_DIELECTRIC MODEL_THIN_DIELECTRIC MODEL_PLASTIC MODEL_ROUGH_PLASTIC MODEL_PRINCIPLED MODEL_MEASURED MODEL_NULL MODEL_BLEND MODEL_TABULATED
    MATERIAL_FILTERED MATERIAL_CONDUCTOR MATERIAL_LAFORTUNE MATERIAL_D_1982
    MATERIAL_SCHLICK MATERIAL_SMITH MATERIAL_ANISOTROPIC MATERIAL_NONLINEAR MATERIAL_COMPENSATE MATERIAL_ONE_SIDED MATERIAL_EMIT_ONE_SIDED MATERIAL_WARD_1992 MATERIAL_WARD_DUER MATERIAL_TRANSMISSIVE MATERIAL_BY_SIDE DISTRIBUTION_SHIFT ALBEDO_HEADER ALBEDO_KNOTS MAX_LEAVES
    DISTRIBUTION_BECKMANN DISTRIBUTION_GAUSSIAN DISTRIBUTION_TROWBRIDGE_REITZ DISTRIBUTION_PHONG
    EMITTER_TRIANGLE EMITTER_SPHERE EMITTER_LIGHT EMITTER_ENVIRONMENT EMITTER_ONE_SIDED EMITTER_TEXTURED
    T_INFINITE PATH_BEHIND_SHADOWLESS FRACTION_BITS
    TEXEL_SRGB8 TEXEL_LINEAR8 TEXEL_FLOAT
    WRAP_REPEAT WRAP_CLAMP WRAP_MIRROR
    MAGNIFY_NEAREST MAGNIFY_BILINEAR
    PATTERN_CHECKER PATTERN_NOISE PATTERN_GRADIENT PATTERN_ZONE_PLATE
    PARAMETER_COLOR PARAMETER_SPECULAR_COLOR PARAMETER_EMISSION PARAMETER_ROUGHNESS PARAMETER_ROUGHNESS_U
    PARAMETER_ROUGHNESS_V PARAMETER_METALLIC PARAMETER_OPACITY PARAMETER_MASK PARAMETER_WEIGHT PARAMETER_NORMAL
    PARAMETER_BUMP PARAMETER_ANISOTROPIC PARAMETER_SPEC_TRANS PARAMETER_SPEC_TINT PARAMETER_SHEEN
    PARAMETER_SHEEN_TINT PARAMETER_FLATNESS PARAMETER_CLEARCOAT PARAMETER_CLEARCOAT_GLOSS CHANNEL_R CHANNEL_G CHANNEL_B CHANNEL_A CHANNEL_RGB TEXTURES_MOST
}
