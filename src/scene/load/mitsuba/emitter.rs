//! `<emitter>`: lights of a shape, of a place, and around everything.

use super::Loader;
use super::document::{Node, Result};
use super::object::{Child, Object};
use super::spectrum::Role;
use crate::scene::load::image::ColorSpace;
use crate::scene::load::texture_files::intern;
use crate::scene::{
    Attenuation, Background, Channel, Environment, Flaps, IntensityUnit, Light, LightKind, Material, Model, Parameter,
    Rgb, Slide, Texture, TextureBinding, Transparency, Wrap,
};
use glam::{DAffine3, DVec3, Vec3};
use std::f64::consts::PI;

/// A slide in the beam along the z axis of `place`, without a picture: its axes are x and y, times these.
fn slide(place: &DAffine3, right: f64, up: f64) -> Slide {
    // Directions come in unit length, whatever the transform scales by.
    let axis = |v: DVec3, factor: f64| {
        let length = libm::sqrt(v.dot(v));
        if length > 0.0 { (v * (factor / length)).as_vec3() } else { Vec3::ZERO }
    };
    let (right, up) = (axis(place.matrix3.x_axis, right), axis(place.matrix3.y_axis, up));
    Slide { texture: None, right, up, ramp: None, projector: false }
}

impl Loader<'_> {
    /// Lets `material` glow as a shape's emitter says.
    pub fn glow(&mut self, emitter: Child, material: &mut Material) -> Result<()> {
        let object = Object::open(self.document, emitter.node)?;
        if object.plugin.name != "area" {
            let message = format!("a shape has an emitter of type \"area\", found {:?}", object.plugin.name);
            return Err(self.document.bad(emitter.written, message));
        }
        material.emission_two_sided = false;
        material.emission = Rgb::ONE;
        match object.property("radiance") {
            Some(node) if self.document.tag(node) == "texture" => {
                let parameter = Parameter::Emission;
                let bind = |texture| TextureBinding { parameter, texture, channel: Channel::Rgb, scale: 1.0 };
                material.textures.extend(self.texture(node)?.map(bind));
            }
            Some(node) => material.emission = super::color::color(self.document, node, Role::Emission)?,
            None => {}
        }
        Ok(())
    }

    /// Lets a lamp glow as if it covered everything: in Mitsuba neither a mask nor `null` takes of what a shape emits.
    pub fn uncover(&mut self, emitter: Node, material: &mut Material) {
        if material.model == Model::Null || material.opacity == 0.0 {
            let transparency = Some(Transparency::Filtered { k_t: 1.0, color: Rgb::ONE });
            let nothing =
                Material { model: Model::Lambert, color: Rgb::ZERO, transparency, opacity: 1.0, ..material.clone() };
            *material = nothing;
        }
        material.emission *= 1.0 / material.opacity;
        if material.textures.iter().any(|texture| texture.parameter == Parameter::Opacity) {
            let location = self.document.location_of(emitter);
            self.scene.warnings.push(format!("{location}: the holes of a textured mask emit nothing here"));
        }
    }

    /// Adds an emitter that stands in the scene itself.
    pub fn add_emitter(&mut self, node: Node) -> Result<()> {
        let object = Object::open(self.document, node)?;
        match object.plugin.name {
            // Shapes refer to it.
            "area" => Ok(()),
            "constant" => {
                let radiance = object.color("radiance", Role::Emission)?.unwrap_or(Rgb::ONE);
                self.scene.background = Background::flat(radiance);
                self.claim_surroundings(&object)
            }
            "envmap" => {
                self.claim_surroundings(&object)?;
                let scale = Rgb::splat(object.float_in("scale", 0.0, 1e12)?.unwrap_or(1.0) as f32);
                let read = self.textures.picture(&object, ColorSpace::Srgb, &mut self.scene.warnings)?;
                let Some(mut texture) = read else {
                    self.scene.background = Background::flat(scale);
                    return Ok(());
                };
                // The rows of Mitsuba's pictures lie from pole to pole, ours have their middles half a row inside.
                let rows = texture.height as f32;
                (texture.scale[1], texture.offset[1]) = ((rows - 1.0) / rows, 0.5 / rows);
                texture.wrap_v = Wrap::Clamp;
                self.scene.background = Background::Image(Environment {
                    texture: intern(&mut self.scene.textures, texture),
                    scale,
                    to_world: object.transform("to_world")?,
                });
                Ok(())
            }
            "point" => {
                let position = match object.vector("position")? {
                    Some(_) if object.has("to_world") => {
                        return Err(object.bad("to_world", "\"position\" and \"to_world\" exclude each other"));
                    }
                    Some(position) => position,
                    None => object.transform("to_world")?.0.translation,
                };
                let kind = LightKind::Point { position: position.as_vec3() };
                self.add_light(&object, kind, "intensity", Attenuation::InverseSquare)
            }
            "spot" => {
                let place = object.transform("to_world")?.0;
                let outer = object.float_in("cutoff_angle", 1e-3, 89.999)?.unwrap_or(20.0);
                let inner = object.float_in("beam_width", 0.0, 89.999)?.unwrap_or(outer * 0.75);
                if inner > outer {
                    return Err(object.bad("beam_width", "\"beam_width\" is at most \"cutoff_angle\""));
                }
                let texture = match object.property("texture") {
                    Some(node) if self.document.tag(node) == "texture" => self.texture(node)?,
                    Some(_) => return Err(object.bad("texture", "the \"texture\" of a spot is a <texture>")),
                    None => None,
                };
                let ramp = Some([inner, outer].map(|angle| angle.to_radians() as f32));
                // Seen along the light's way, the picture of a spot is the right way round with x to the right.
                let half = 0.5 / libm::tan(outer.to_radians());
                let slide = Slide { texture, ramp, ..slide(&place, half, -half) };
                let intensity = object.color("intensity", Role::Emission)?.unwrap_or(Rgb::ONE);
                self.add_spot(&object, place, outer.to_radians(), intensity, slide)
            }
            "projector" => {
                let place = object.transform("to_world")?.0;
                let Some(picture) = object.property("irradiance") else { return object.required("irradiance", None) };
                let (texture, color) = match self.document.tag(picture) {
                    "texture" => (self.texture(picture)?, Rgb::ONE),
                    _ => (None, super::color::color(self.document, picture, Role::Emission)?),
                };
                let texture = texture.unwrap_or_else(|| intern(&mut self.scene.textures, Texture::uniform(color)));
                let Texture { width, height, .. } = self.scene.textures[texture.0 as usize];
                let aspect = f64::from(width) / f64::from(height);
                let tangent_y = libm::tan(super::sensor::read_fov(&object, aspect)? / 2.0);
                let tangent_x = tangent_y * aspect;
                let intensity = Rgb::splat((PI * object.float_in("scale", 0.0, 1e12)?.unwrap_or(1.0)) as f32);
                // The camera's own axes: x to the left, y up.
                let around = slide(&place, -0.5 / tangent_x, 0.5 / tangent_y);
                let slide = Slide { texture: Some(texture), projector: true, ..around };
                self.add_spot(&object, place, libm::atan(libm::hypot(tangent_x, tangent_y)), intensity, slide)
            }
            // directional
            _ => {
                let direction = match object.vector("direction")? {
                    Some(_) if object.has("to_world") => {
                        return Err(object.bad("to_world", "\"direction\" and \"to_world\" exclude each other"));
                    }
                    Some(direction) => direction,
                    None => object.transform("to_world")?.0.matrix3.z_axis,
                };
                let kind = LightKind::Directional { direction: self.unit(&object, "direction", direction)? };
                self.add_light(&object, kind, "irradiance", Attenuation::None)
            }
        }
    }

    fn unit(&self, object: &Object, name: &str, v: DVec3) -> Result<Vec3> {
        let length = libm::sqrt(v.dot(v));
        match length > 1e-12 {
            true => Ok((v / length).as_vec3()),
            false => Err(object.bad(name, format!("{name:?} has no direction"))),
        }
    }

    /// A light at the origin of `place` that shines along its z axis into a cone of half angle `outer`.
    fn add_spot(&mut self, object: &Object, place: DAffine3, outer: f64, intensity: Rgb, slide: Slide) -> Result<()> {
        let kind = LightKind::Spot {
            position: place.translation.as_vec3(),
            direction: self.unit(object, "to_world", place.matrix3.z_axis)?,
            inner: outer as f32,
            outer: outer as f32,
            exponent: 0.0,
        };
        self.push_light(object, kind, intensity, Attenuation::InverseSquare, Some(slide));
        Ok(())
    }

    fn add_light(&mut self, object: &Object, kind: LightKind, strength: &str, attenuation: Attenuation) -> Result<()> {
        let intensity = object.color(strength, Role::Emission)?.unwrap_or(Rgb::ONE);
        self.push_light(object, kind, intensity, attenuation, None);
        Ok(())
    }

    fn push_light(
        &mut self,
        object: &Object,
        kind: LightKind,
        intensity: Rgb,
        attenuation: Attenuation,
        slide: Option<Slide>,
    ) {
        let name = self.document.attribute(object.node, "id").unwrap_or(object.plugin.name).to_owned();
        let unit = IntensityUnit::Radiometric;
        let flaps = Flaps::NONE;
        self.scene.lights.push(Light { name, kind, intensity, unit, attenuation, flaps, casts_shadow: true, slide });
    }

    /// There is one environment.
    fn claim_surroundings(&mut self, object: &Object) -> Result<()> {
        match self.environment.replace(object.node) {
            None => Ok(()),
            Some(first) => {
                let message =
                    format!("a second emitter around the scene; the first is at {}", self.document.location_of(first));
                Err(self.document.bad(object.node, message))
            }
        }
    }
}
