//! What a scene uses, and what a kernel is compiled for.
//!
//! Each member is a specialisation constant of the kernels, in capitals there: both sides ask `has_spheres` by one name. A
//! kernel is compiled without what its scene does not use, since devices that walk lanes in lockstep run both sides of every
//! branch.

use super::control::SHADE_GROUP_MISSED;
use super::geometry::STACK_SIZE;
use bytemuck::Zeroable;

pub const INTEGRATOR_LOCAL: u32 = 0;
pub const INTEGRATOR_WHITTED: u32 = 1;
/// Path tracing; `direct` is its case of one scattering event.
pub const INTEGRATOR_PATH: u32 = 2;

pub const SAMPLER_SOBOL: u32 = 0;
pub const SAMPLER_STRATIFIED: u32 = 1;
pub const SAMPLER_INDEPENDENT: u32 = 2;

pub const SHADOWS_OFF: u32 = 0;
pub const SHADOWS_OPAQUE: u32 = 1;
pub const SHADOWS_FILTERED: u32 = 2;

pub const FILTER_BOX: u32 = 0;
pub const FILTER_TENT: u32 = 1;
/// Gaussian, Mitchell and other tabulated filters: piecewise constant, sampled through their inverse CDF.
pub const FILTER_TABLE: u32 = 2;

/// What a scene uses. By default all that there may be; `zeroed` is a scene of nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Zeroable)]
pub struct Features {
    /// `INTEGRATOR_*`.
    pub integrator: u32,
    /// `SAMPLER_*`.
    pub sampler: u32,
    /// `FILTER_*`.
    pub filter: u32,
    /// `SHADOWS_*`: what becomes of shadow rays. `SHADOWS_FILTERED` only if the scene has something to filter by.
    pub shadows: u32,
    /// Bit n: a material has `MODEL_*` n.
    pub models: u32,
    /// Bit n: there is an emitter of kind `EMITTER_*` n.
    pub emitters: u32,
    /// Bit n: a texture has the format `TEXEL_*` or `PATTERN_*` n.
    pub formats: u32,
    pub has_spheres: bool,
    /// One instance and no more: no top level to walk.
    pub is_one_instance: bool,
    /// Objects shaded flat or by Gouraud's method.
    pub has_facets: bool,
    /// Of materials.
    pub has_textures: bool,
    pub has_textured_emitters: bool,
    /// An image surrounds the scene; else the gradient does.
    pub has_environment_map: bool,
    pub has_panes: bool,
    pub has_absorption: bool,
    /// Media are nested by rank.
    pub has_ranks: bool,
    pub has_lens: bool,
    /// Lights with flaps.
    pub has_flaps: bool,
    /// Spots with a picture or a linear ramp.
    pub has_slides: bool,
    /// Objects that cast no shadow.
    pub has_shadowless: bool,
    /// Paths keep what they have passed since their direction was drawn: panes that filter, objects that cast no shadow.
    pub has_passing: bool,
    /// A ray that has left a surface can meet light: something glows or surrounds the scene (path).
    pub has_glow: bool,
    /// Contributions have a limit.
    pub has_clamp: bool,
    /// Auxiliary values are recorded.
    pub has_aovs: bool,
    /// The camera does not see the background (it still lights mirrors and glass).
    pub hides_background: bool,
    /// The camera looks through what glows (path).
    pub hides_emitters: bool,
}

impl Features {
    /// Whether a material has `MODEL_*` `model`; `HAS_MODEL` of the shaders.
    #[inline(always)]
    pub fn has_model(&self, model: u32) -> bool {
        self.models & (1 << model) != 0
    }
}

impl Default for Features {
    fn default() -> Self {
        Self {
            integrator: INTEGRATOR_LOCAL,
            sampler: SAMPLER_SOBOL,
            filter: FILTER_BOX,
            shadows: SHADOWS_OPAQUE,
            models: u32::MAX,
            emitters: u32::MAX,
            formats: u32::MAX,
            has_spheres: true,
            is_one_instance: false,
            has_facets: true,
            has_textures: true,
            has_textured_emitters: true,
            has_environment_map: true,
            has_panes: true,
            has_absorption: true,
            has_ranks: true,
            has_lens: true,
            has_flaps: true,
            has_slides: true,
            has_shadowless: true,
            has_passing: true,
            has_glow: true,
            has_clamp: true,
            has_aovs: true,
            hides_background: false,
            hides_emitters: true,
        }
    }
}

/// Pages that each set of the scene's arrays may have.
pub const MAX_PAGES: u32 = 8;
/// Invocations in a workgroup. On lavapipe 32 to 1024 take the same time.
pub const WORKGROUP: u32 = 64;

/// What a kernel is compiled for, beside the scene's features. None of it shows in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variant {
    /// Invocations in a workgroup.
    pub group_size: u32,
    /// Pages of each set of the scene's arrays: a kernel binds no more than there are.
    pub node_pages: u32,
    pub triangle_pages: u32,
    pub data_pages: u32,
    /// log2 of the 16-byte words of a page.
    pub page_shift: u32,
    /// Entries of each traversal stack that the scene's hierarchies need.
    pub stack_depth: u32,
    /// Whether extend makes the camera rays of its chunk, or reads what waited.
    pub extend_camera: bool,
    /// Whether paths are shaded in groups by the model they hit, each by a kernel that has its models for `models`.
    pub shade_grouped: bool,
    /// Which of them a kernel shades.
    pub shade_group: u32,
    /// The one model of that group, or INVALID if there are more.
    pub shade_model: u32,
}

impl Default for Variant {
    fn default() -> Self {
        Self {
            group_size: WORKGROUP,
            node_pages: MAX_PAGES,
            triangle_pages: MAX_PAGES,
            data_pages: MAX_PAGES,
            page_shift: 31,
            stack_depth: STACK_SIZE,
            extend_camera: false,
            shade_grouped: false,
            shade_group: SHADE_GROUP_MISSED,
            shade_model: u32::MAX,
        }
    }
}
