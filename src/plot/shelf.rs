//! Materials as the renderer evaluates them: baked, and asked by name.

use crate::bake::{BakeError, SceneData, bake};
use crate::layout::{MATERIAL_ANISOTROPIC, MODEL_BLEND, SAMPLER_SOBOL};
use crate::scene::{Camera, Material, Projection, Scene};
use crate::shading::closure::{Closure, closure_of};
use crate::shading::material::{eval_closure, sample_closure};
use crate::shading::sampling::{SampleKey, sample_1d, sample_2d};
use crate::shading::spectrum::{Spectrum, spectrum_luminance};
use glam::{Vec2, Vec3};
use std::path::Path;

/// The materials of a scene.
pub struct Shelf {
    data: SceneData,
    names: Vec<String>,
}

impl Shelf {
    /// All materials of `scene`; nothing else of it.
    pub fn of(scene: &Scene) -> Result<Self, BakeError> {
        let mut bare = crate::scene::load::staging::bare_scene(Path::new(&scene.name));
        bare.camera = Camera {
            eye: Vec3::Z,
            target: Vec3::ZERO,
            up: Vec3::Y,
            projection: Projection::Orthographic { height: 1.0 },
            lens: None,
            shift: Vec2::ZERO,
            mirrored: false,
        };
        bare.materials = scene.materials.clone();
        bare.textures = scene.textures.clone();
        bare.tables = scene.tables.clone();
        let names = bare.materials.iter().map(|material| material.name.clone()).collect();
        Ok(Self { data: bake(&bare)?, names })
    }

    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Whether white light from 45 degrees goes anywhere that is not a lobe of zero width.
    pub fn reflects(&self, index: usize) -> bool {
        let wi = Vec3::new(-0.70710677, 0.0, 0.70710677);
        (-80..=80).any(|angle| self.eval(index, super::curves::direction(f64::from(angle)), wi) > 0.0)
    }

    pub fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// f |cos theta_i| of material number `index`, luminance per steradian. Directions leave the surface, z is its
    /// normal. Textures count as 1.
    pub fn eval(&self, index: usize, wo: Vec3, wi: Vec3) -> f64 {
        f64::from(spectrum_luminance(self.spectrum(index, wo, wi)))
    }

    /// The same, linear Rec. 709.
    pub fn eval_rgb(&self, index: usize, wo: Vec3, wi: Vec3) -> [f64; 3] {
        let value = self.spectrum(index, wo, wi);
        [value.x, value.y, value.z].map(f64::from)
    }

    fn spectrum(&self, index: usize, wo: Vec3, wi: Vec3) -> Spectrum {
        let closure = self.closure(index);
        if closure.model == MODEL_BLEND {
            let (first, weight) = (closure.first_part as usize, closure.blend);
            return self.spectrum(first, wo, wi) * (1.0 - weight) + self.spectrum(first + 1, wo, wi) * weight;
        }
        eval_closure(&self.data.view(), &closure, wo, wi)
    }

    /// Material number `index` as the renderer evaluates it.
    pub fn closure(&self, index: usize) -> Closure {
        closure_of(&self.data.view(), &self.data.materials[index])
    }

    /// `eval` of a closure, green.
    pub fn eval_closure(&self, closure: &Closure, wo: Vec3, wi: Vec3) -> f64 {
        f64::from(eval_closure(&self.data.view(), closure, wo, wi).y)
    }

    /// Whether turning the surface changes what material number `index` reflects.
    pub fn is_anisotropic(&self, index: usize) -> bool {
        let closure = self.closure(index);
        if closure.model == MODEL_BLEND {
            let first = closure.first_part as usize;
            return self.is_anisotropic(first) || self.is_anisotropic(first + 1);
        }
        closure.flags & MATERIAL_ANISOTROPIC != 0
    }

    /// The part of white light from everywhere that goes to `wo`, by sampling: the mean weight of `count` samples,
    /// lobes of zero width included.
    pub fn albedo(&self, index: usize, wo: Vec3, count: u32) -> f64 {
        let closure = self.closure(index);
        if closure.model == MODEL_BLEND {
            let (first, weight) = (closure.first_part as usize, f64::from(closure.blend));
            return (1.0 - weight) * self.albedo(first, wo, count) + weight * self.albedo(first + 1, wo, count);
        }
        let view = self.data.view();
        let weight = |sample_index: u32| {
            let key = SampleKey { sampling: SAMPLER_SOBOL, strata: 1, seed: 0, pixel: 0, sample_index, path_id: 0 };
            let (u, u_lobe): (Vec2, f32) = (sample_2d(key, 0), sample_1d(key, 1));
            let sample = sample_closure(&view, &closure, wo, u, u_lobe);
            if sample.pdf > 0.0 { f64::from(spectrum_luminance(sample.weight)) } else { 0.0 }
        };
        (0..count).map(weight).sum::<f64>() / f64::from(count)
    }
}

/// The materials that a plot shows without a scene file.
pub fn shelf_of(materials: Vec<Material>) -> Result<Shelf, BakeError> {
    let mut scene = crate::scene::load::staging::bare_scene(Path::new("gonio plot"));
    scene.materials = materials;
    Shelf::of(&scene)
}
