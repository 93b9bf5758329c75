//! What stands in a spot's beam: a picture that the light throws, and a linear edge.
//!
//! Table: `right`, `up` (3 entries each), the texture or -1, the angle at which a ramp ends, its slope per radian or 0, and
//! 1 for a projector.
//! Source: Jakob et al. 2022, "Mitsuba 3", plugins `spot` and `projector`, whose light this is.

use crate::layout::{Light, SceneView, load_table, load_texture};
use crate::shading::lobe::COS_MIN;
use crate::shading::math::{acos_, clamp_, dot3, rcp};
use crate::shading::spectrum::{Spectrum, spectrum_from_rgb, spectrum_zero};
use crate::shading::texture::sample_texture;
use glam::{Vec2, Vec3};

/// Factor on the light that comes along `wi` (unit, to the light). The light has a slide.
pub fn slide_factor(scene: &SceneView, light: &Light, wi: Vec3) -> Spectrum {
    let direction = -wi;
    let cos_axis = dot3(direction, light.direction);
    if cos_axis <= COS_MIN {
        return spectrum_zero();
    }
    let at = light.table;
    let slope = load_table(scene, at + 8);
    let mut factor = 1.0;
    if slope > 0.0 {
        factor = clamp_((load_table(scene, at + 7) - acos_(cos_axis)) * slope, 0.0, 1.0);
    }
    let picture = load_table(scene, at + 6);
    if picture < 0.0 {
        return spectrum_from_rgb(Vec3::splat(factor));
    }
    let right = Vec3::new(load_table(scene, at), load_table(scene, at + 1), load_table(scene, at + 2));
    let up = Vec3::new(load_table(scene, at + 3), load_table(scene, at + 4), load_table(scene, at + 5));
    let inverse = rcp(cos_axis);
    let u = 0.5 + dot3(direction, right) * inverse;
    let v = 0.5 + dot3(direction, up) * inverse;
    if load_table(scene, at + 9) > 0.0 {
        if u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0 {
            return spectrum_zero();
        }
        factor *= (inverse * inverse) * inverse;
    }
    let texel = sample_texture(scene, &load_texture(scene, picture as u32), Vec2::new(u, v));
    spectrum_from_rgb(Vec3::new(texel.x, texel.y, texel.z) * factor)
}
