//! One material as bake prepares it.

#[path = "mod.rs"]
mod common;

use gonio::bake::{SceneData, bake};
use gonio::layout::SceneView;
use gonio::scene::{Geometry, Material, Table, Transform};
use gonio::shading::closure::{Closure, closure_of};

/// A scene of one sphere of the material.
pub struct Baked(SceneData);

impl Baked {
    pub fn new(material: Material) -> Self {
        Self::with(material, Vec::new())
    }

    /// The same of a material that may name tables.
    pub fn with(material: Material, tables: Vec<Table>) -> Self {
        let mut scene = common::empty_scene();
        (scene.materials, scene.tables) = (vec![material], tables);
        scene.objects = vec![common::object(Geometry::Sphere, Transform::default())];
        Self(bake(&scene).expect("a material that can be baked"))
    }

    pub fn closure(&self) -> Closure {
        closure_of(&self.view(), &self.0.materials[0])
    }

    pub fn view(&self) -> SceneView<'_> {
        self.0.view()
    }
}
