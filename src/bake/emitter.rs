//! What `path` samples: every triangle that glows, spheres, lights of no size and the environment, with the probability
//! of each.

use super::alias::alias_table;
use super::environment::{bake_environment, luminance};
use super::shapes::Shapes;
use super::{BakeError, SceneArrays};
use crate::layout::{
    EMITTER_ENVIRONMENT, EMITTER_LIGHT, EMITTER_ONE_SIDED, EMITTER_SPHERE, EMITTER_TEXTURED, EMITTER_TRIANGLE, Emitter,
    INVALID, Instance, KIND_SPHERE, LIGHT_DIRECTIONAL, LIGHT_SPOT, Light, MATERIAL_EMIT_ONE_SIDED, MODEL_BLEND,
    MODEL_EMISSIVE, Material, PARAMETER_EMISSION, PARAMETER_MASK, PARAMETER_OPACITY,
};
use crate::scene::{Background, Scene};
use crate::shading::material::own_weight;
use glam::{DMat3, DVec3, Vec3, Vec4};
use std::f64::consts::PI;
use std::ops::Range;

/// Part of the choice that goes by power; the rest gives every object and light the same, so that neither a faint lamp
/// close by nor a bright one far away is found too seldom.
const BY_POWER: f64 = 0.5;
/// Emitters that 24 random bits can tell apart.
const EMITTERS_MOST: usize = 1 << 24;

/// What shares one probability: the glowing faces of an instance, a light, the environment.
struct Group {
    members: Range<usize>,
    power: f64,
    instance: Option<usize>,
}

/// Emitters with what they weigh within their group.
#[derive(Default)]
struct Collection {
    emitters: Vec<Emitter>,
    shares: Vec<f64>,
    groups: Vec<Group>,
}

impl Collection {
    fn group(&mut self, first: usize, power: f64, instance: Option<usize>) {
        if self.emitters.len() > first && power > 0.0 {
            self.groups.push(Group { members: first..self.emitters.len(), power, instance });
        } else {
            self.emitters.truncate(first);
            self.shares.truncate(first);
        }
    }

    fn push(&mut self, emitter: Emitter, share: f64) {
        self.emitters.push(emitter);
        self.shares.push(share);
    }
}

/// Fills in emitters, their table and what the header and the instances say of them. `environment`: its luminance, from
/// `bake_surroundings`.
pub fn bake_emitters(environment: f64, data: &mut SceneArrays) -> Result<(), BakeError> {
    let world = data.shapes.bounds;
    let half = (world.max.as_dvec3() - world.min.as_dvec3()) * 0.5;
    let radius2 = half.length_squared().max(0.0);
    let mut all = Collection::default();
    for index in 0..data.instances.len() {
        collect_instance(data, index, &mut all);
    }
    for (index, light) in data.lights.iter().enumerate() {
        let first = all.emitters.len();
        all.push(Emitter { kind: EMITTER_LIGHT, instance: index as u32, ..Emitter::default() }, 1.0);
        all.group(first, light_power(light, radius2), None);
    }
    if environment > 0.0 {
        let first = all.emitters.len();
        let nowhere = Emitter { kind: EMITTER_ENVIRONMENT, instance: INVALID, ..Emitter::default() };
        all.push(nowhere, 1.0);
        // What falls onto the disk of the scene's size from every direction; at least something for a single point.
        all.group(first, (PI * radius2 * environment).max(environment), None);
    }
    if all.emitters.len() > EMITTERS_MOST {
        return Err(BakeError::Emitters { count: all.emitters.len(), most: EMITTERS_MOST });
    }
    distribute(all, data);
    Ok(())
}

/// Gives every emitter its probability and writes the alias table.
fn distribute(mut all: Collection, data: &mut SceneArrays) {
    let power: f64 = all.groups.iter().map(|group| group.power).sum();
    let even = 1.0 / all.groups.len().max(1) as f64;
    let mut probabilities = vec![0.0; all.emitters.len()];
    for group in &all.groups {
        let chosen = BY_POWER * group.power / power + (1.0 - BY_POWER) * even;
        let sum: f64 = all.shares[group.members.clone()].iter().sum();
        for member in group.members.clone() {
            let emitter = &mut all.emitters[member];
            probabilities[member] = chosen * all.shares[member] / sum;
            // The share of a triangle is its area times its luminance; of a sphere its luminance.
            let glow = luminance(emitter.radiance.as_dvec3());
            emitter.density = match emitter.kind {
                EMITTER_TRIANGLE => (chosen * glow / sum) as f32,
                _ => probabilities[member] as f32,
            };
            if emitter.kind == EMITTER_ENVIRONMENT {
                data.header.environment_density = emitter.density;
            }
        }
        if let Some(instance) = group.instance {
            data.instances[instance].light_density = (chosen / sum) as f32;
        }
    }
    data.header.emitter_count = all.emitters.len() as u32;
    data.header.emitter_table = data.tables.len() as u32;
    let table = alias_table(&probabilities);
    // Indices below 2^24 are exact floats.
    data.tables.extend(table.thresholds.iter().zip(&table.aliases).flat_map(|(&t, &a)| [t, a as f32]));
    data.emitters = all.emitters;
}

/// What a material sends out, without its textures, as far as it covers; a blend on average.
fn emission(material: &Material) -> Vec3 {
    material.emission * own_weight(material.flags, material.k_t)
}

/// The primitives of an instance's mesh that can be hit, in ascending order.
fn primitives(shapes: &Shapes, instance: usize) -> Vec<u32> {
    let mesh = shapes.placed[instance].mesh.clone().unwrap_or_default();
    let mut primitives: Vec<u32> = shapes.triangles[mesh.triangles].iter().map(|t| t.primitive).collect();
    primitives.sort_unstable();
    primitives
}

fn collect_instance(data: &SceneArrays, index: usize, all: &mut Collection) {
    let instance = &data.instances[index];
    let first = all.emitters.len();
    let glows = |id: u32| luminance(emission(&data.materials[id as usize]).as_dvec3()) > 0.0;
    let flags = |material: &Material, textured: bool| {
        let sided = if (material.flags & MATERIAL_EMIT_ONE_SIDED) != 0 { EMITTER_ONE_SIDED } else { 0 };
        sided | if textured { EMITTER_TEXTURED } else { 0 }
    };
    let textured = |material: &Material| {
        let (first, count) = (material.first_texture as usize, material.texture_count as usize);
        // What a blend shows is found where it is met.
        material.model == MODEL_BLEND
            || data.textures[first..first + count].iter().any(|texture| match texture.parameter {
                // Holes emit nothing.
                PARAMETER_EMISSION | PARAMETER_OPACITY | PARAMETER_MASK => true,
                _ => false,
            })
    };
    let mut power = 0.0;
    let sides = |material: &Material| if (material.flags & MATERIAL_EMIT_ONE_SIDED) != 0 { 1.0 } else { 2.0 };
    if instance.kind == KIND_SPHERE {
        if !glows(instance.material) {
            return;
        }
        let material = &data.materials[instance.material as usize];
        let radiance = emission(material);
        let glow = luminance(radiance.as_dvec3());
        // Of the sphere with the ellipsoid's volume: a choice needs no more.
        let area = 4.0 * PI * libm::pow(linear(instance).determinant().abs(), 2.0 / 3.0);
        power += area * glow * PI;
        let flags = flags(material, textured(material));
        let sphere = Emitter { kind: EMITTER_SPHERE, instance: index as u32, radiance, flags, ..Emitter::default() };
        all.push(sphere, glow);
    } else if instance.material == INVALID || glows(instance.material) {
        let (matrix, offset) = (linear(instance), instance.to_world.map(|row| f64::from(row.w)));
        let place = |p: Vec3| matrix * p.as_dvec3() + DVec3::from_array(offset);
        for primitive in primitives(&data.shapes, index) {
            let face = data.shapes.faces[(instance.first_face + primitive) as usize];
            let id = if instance.material == INVALID { face.material } else { instance.material };
            if !glows(id) {
                continue;
            }
            let material = &data.materials[id as usize];
            let vertices = [face.i0, face.i1, face.i2].map(|i| &data.shapes.vertices[i as usize]);
            let [a, b, c] = vertices.map(|vertex| place(vertex.position));
            let (edge1, edge2) = (b - a, c - a);
            let across = edge1.cross(edge2);
            let area = 0.5 * libm::sqrt(across.length_squared());
            // As `trace::surface`: a mirroring transform keeps the outside outside.
            let outside = if matrix.determinant() < 0.0 { -across } else { across };
            let radiance = emission(material);
            let share = area * luminance(radiance.as_dvec3());
            if !(share > 0.0) {
                continue;
            }
            let tinted = material.model == MODEL_EMISSIVE && vertices.iter().any(|vertex| vertex.color != Vec3::ONE);
            power += share * PI * sides(material);
            let triangle = Emitter {
                corner: a.as_vec3(),
                kind: EMITTER_TRIANGLE,
                edge1: edge1.as_vec3(),
                instance: index as u32,
                edge2: edge2.as_vec3(),
                primitive,
                normal: super::light::unit(outside),
                density: 0.0,
                radiance,
                flags: flags(material, textured(material) || tinted),
            };
            all.push(triangle, share);
        }
    }
    all.group(first, power, Some(index));
}

fn linear(instance: &Instance) -> DMat3 {
    let row = |v: Vec4| v.truncate().as_dvec3();
    let [x, y, z] = instance.to_world.map(row);
    DMat3::from_cols(x, y, z).transpose()
}

/// Power of a light of no size; for one without fall-off what it would have with.
fn light_power(light: &Light, radius2: f64) -> f64 {
    let intensity = luminance(light.intensity.as_dvec3());
    let spread = match light.kind {
        LIGHT_DIRECTIONAL => PI * radius2,
        LIGHT_SPOT => 2.0 * PI * (1.0 - f64::from(light.cos_outer)),
        _ => 4.0 * PI,
    };
    intensity * spread
}

/// Fills in what rays see that leave the scene. Returns the integral of its luminance over all directions.
pub fn bake_surroundings(scene: &Scene, data: &mut SceneArrays) -> f64 {
    match &scene.background {
        Background::Gradient { bottom, top } => {
            (data.header.background_bottom, data.header.background_top) = (*bottom, *top);
            2.0 * PI * (luminance(bottom.as_dvec3()) + luminance(top.as_dvec3()))
        }
        Background::Image(environment) => {
            let texture = &scene.textures[environment.texture.0 as usize];
            let Some(mut baked) = bake_environment(environment, texture) else { return 0.0 };
            baked.map.first_table = data.tables.len() as u32;
            data.tables.extend(baked.table);
            data.environments.push(baked.map);
            baked.luminance
        }
    }
}
