//! One material as bake prepares it.

#[path = "mod.rs"]
mod common;

use gonio::bake::{SceneData, bake};
use gonio::layout::{self, SceneView};
use gonio::scene::{Geometry, Material, Transform};

/// A scene of one sphere of the material.
pub struct Baked(SceneData);

impl Baked {
    pub fn new(material: Material) -> Self {
        let mut scene = common::empty_scene();
        scene.materials = vec![material];
        scene.objects = vec![common::object(Geometry::Sphere, Transform::default())];
        Self(bake(&scene).expect("a material that can be baked"))
    }

    pub fn material(&self) -> layout::Material {
        self.0.materials[0]
    }

    pub fn view(&self) -> SceneView<'_> {
        self.0.view()
    }
}
