//! What a viewer lets one turn: surroundings, camera, ground, which way is up. For scenes of every format.

use super::bounds::Bounds;
use super::image::{ColorSpace, load_texture};
use super::staging::{add_ground, azimuth_of, camera_from};
use super::surroundings::{Surroundings, turn};
use super::texture_files::intern;
use super::toml::{Override, quoted};
use crate::scene::{
    Background, Environment, Integrator, LightKind, Location, Projection, Rgb, Scene, SceneError, Texture, Transform,
    Wrap,
};
use glam::{DVec3, Vec3};
use std::path::{Path, PathBuf};

/// What stands around a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Around {
    Ours(Surroundings),
    /// An equirectangular picture.
    Image(PathBuf),
}

impl Around {
    /// `studio`, `sky`, `white`, or a file.
    pub fn from_text(text: &str) -> Self {
        Surroundings::from_name(text).map_or_else(|| Self::Image(PathBuf::from(text)), Self::Ours)
    }
}

/// What the user wants otherwise than the file and the stage have it; nothing by default.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Controls {
    /// The integrator that is asked for, so that the stage gives it light that it sees.
    pub integrator: Option<Integrator>,
    pub surroundings: Option<Around>,
    /// Turns the surroundings about +y, degrees, counter-clockwise seen from above.
    pub turn: f64,
    /// Factor on the radiance of the surroundings; 1 if none.
    pub strength: Option<f32>,
    /// Name or number of one of the file's cameras.
    pub camera: Option<String>,
    /// Degrees from +z to +x from which the scene is seen.
    pub azimuth: Option<f64>,
    /// Degrees above the horizon from which the scene is seen, -90 to 90.
    pub elevation: Option<f64>,
    /// How much larger the middle is shown, > 0.
    pub zoom: Option<f64>,
    pub look_from: Option<Vec3>,
    pub look_at: Option<Vec3>,
    /// Full vertical field of view, radians.
    pub fov: Option<f32>,
    /// The file's z points up, not its y.
    pub z_up: bool,
    pub ground: Option<bool>,
    /// What surrounds the scene is not seen: it needs no ground.
    pub cut_out: bool,
    /// Further lights, each the keys of a `[[light]]`, a line each.
    pub lights: Vec<String>,
    /// Materials by name (`*`: all of the file's), each the keys of a `[[material]]`, a line each.
    pub materials: Vec<(String, String)>,
}

impl Controls {
    /// The view of a scene whose middle is `centre`.
    pub(super) fn aim(&self, scene: &mut Scene, centre: DVec3) {
        if self.azimuth.is_some() || self.elevation.is_some() {
            let bounds = Bounds::of(scene);
            let back = (scene.camera.eye.as_dvec3() - scene.camera.target.as_dvec3()).normalize_or(DVec3::Z);
            let azimuth = self.azimuth.unwrap_or_else(|| azimuth_of(&scene.camera));
            let elevation = self.elevation.unwrap_or_else(|| libm::asin(back.y.clamp(-1.0, 1.0)).to_degrees());
            scene.camera = camera_from(&scene.film, &bounds, azimuth, elevation);
        }
        let camera = &mut scene.camera;
        if let Some(eye) = self.look_from {
            (camera.eye, camera.target) = (eye, centre.as_vec3());
        }
        camera.target = self.look_at.unwrap_or(camera.target);
        if self.look_from.is_some() || self.look_at.is_some() {
            camera.up = Vec3::Y;
        }
        // Straight down or up: the far side of the scene is up in the picture.
        let view = (camera.target.as_dvec3() - camera.eye.as_dvec3()).normalize_or(DVec3::NEG_Z);
        if camera.up.as_dvec3().normalize_or(DVec3::Y).cross(view).length() < 1e-4 {
            camera.up = if view.y < 0.0 { Vec3::NEG_Z } else { Vec3::Z };
        }
        let zoom = self.zoom.unwrap_or(1.0);
        camera.projection = match (camera.projection, self.fov) {
            (Projection::Perspective { .. }, Some(fov_y)) => Projection::Perspective { fov_y },
            (projection, _) => projection,
        };
        camera.projection = match camera.projection {
            _ if zoom == 1.0 => camera.projection,
            Projection::Perspective { fov_y } => {
                let half = libm::tan(f64::from(fov_y) * 0.5) / zoom;
                Projection::Perspective { fov_y: (2.0 * libm::atan(half)) as f32 }
            }
            Projection::Orthographic { height } => {
                Projection::Orthographic { height: (f64::from(height) / zoom) as f32 }
            }
        };
    }

    /// `around` as the background of `scene`; the studio and the sky turn with the camera.
    pub(super) fn background(&self, around: &Around, scene: &mut Scene) -> Result<Background, SceneError> {
        let scale = Rgb::splat(self.strength.unwrap_or(1.0));
        match around {
            Around::Ours(ours) => {
                let to_world = turn(azimuth_of(&scene.camera) + self.turn);
                Ok(ours.background(&mut scene.textures, scale, to_world))
            }
            Around::Image(path) => {
                let texture = Texture { wrap_v: Wrap::Clamp, ..load_texture(path, ColorSpace::Srgb)? };
                let texture = intern(&mut scene.textures, texture);
                let to_world = turn(self.turn);
                Ok(Background::Image(Environment { texture, scale, to_world }))
            }
        }
    }

    /// Refuses materials for names that the file does not have, and what only text can take.
    pub(super) fn check_materials(&self, scene: &Scene) -> Result<(), SceneError> {
        let known = |name: &str| name == "*" || scene.materials.iter().any(|material| material.name == name);
        let Some((name, _)) = self.materials.iter().find(|(name, _)| !known(name)) else { return Ok(()) };
        let names: Vec<String> = scene.materials.iter().map(|material| format!("{:?}", material.name)).collect();
        let there =
            if names.is_empty() { "it has none of its own; * stands for all".to_owned() } else { names.join(", ") };
        let message = format!("--material {name}: the file has no such material: {there}");
        Err(SceneError::bad(Location::file(Path::new(&scene.name)), message))
    }

    /// The text of a scene file and the changes to it, with the further lights and materials.
    pub(super) fn written_into(&self, text: String, overrides: &[Override]) -> (String, Vec<Override>) {
        let lights = self.lights.iter().map(|table| format!("\n[[light]]\n{table}\n"));
        let material = |(name, table): &(String, String)| {
            let keys = table.replace('\n', ", ");
            let value = format!("{{ name = {}, {keys} }}", quoted(name));
            Override { path: vec!["material".to_owned(), name.clone()], value }
        };
        let changes = self.materials.iter().map(material).chain(overrides.iter().cloned());
        (lights.fold(text, |text, light| text + &light), changes.collect())
    }

    /// Refuses further lights and materials for a scene that has no place for them.
    pub(super) fn refuse_tables(&self, path: &Path) -> Result<(), SceneError> {
        if self.lights.is_empty() && self.materials.is_empty() {
            return Ok(());
        }
        let message = "--light and --material are for TOML, OBJ, PLY, STL, glTF and GLB";
        Err(SceneError::bad(Location::file(path), message))
    }

    /// Changes a scene that is complete.
    pub(super) fn adjust(&self, scene: &mut Scene) -> Result<(), SceneError> {
        self.raise(scene);
        self.choose_camera(scene)?;
        self.aim(scene, scene.camera.target.as_dvec3());
        if let Some(around) = &self.surroundings {
            scene.background = self.background(around, scene)?;
        }
        match self.ground {
            Some(true) => add_ground(scene, &Bounds::of(scene), Rgb::splat(0.4)),
            Some(false) => scene.objects.retain(|object| object.name != "ground"),
            None => {}
        }
        Ok(())
    }

    /// Turns a scene whose z is up so that its y is.
    pub(super) fn raise(&self, scene: &mut Scene) {
        if !self.z_up {
            return;
        }
        let tip = |v: &mut Vec3| *v = Vec3::new(v.x, v.z, -v.y);
        let rotation = Transform(glam::DAffine3::from_mat3(glam::DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y)));
        for object in &mut scene.objects {
            object.transform = object.transform.then(rotation);
        }
        for light in &mut scene.lights {
            match &mut light.kind {
                LightKind::Point { position } => tip(position),
                LightKind::Directional { direction } => tip(direction),
                LightKind::Spot { position, direction, .. } => [position, direction].into_iter().for_each(tip),
            }
        }
        let cameras = scene.cameras.iter_mut().map(|named| &mut named.camera);
        for camera in cameras.chain([&mut scene.camera]) {
            [&mut camera.eye, &mut camera.target, &mut camera.up].into_iter().for_each(tip);
        }
    }

    /// Takes the camera that is asked for by its name, or by its number from 0.
    pub(super) fn choose_camera(&self, scene: &mut Scene) -> Result<(), SceneError> {
        let Some(wanted) = &self.camera else { return Ok(()) };
        let named = scene.cameras.iter().position(|named| named.name == *wanted);
        let index = named.or_else(|| wanted.parse().ok().filter(|index| *index < scene.cameras.len()));
        let Some(index) = index else {
            let names: Vec<String> =
                scene.cameras.iter().enumerate().map(|(i, named)| format!("{i} {:?}", named.name)).collect();
            let there = if names.is_empty() { "the file has none of its own".to_owned() } else { names.join(", ") };
            let message = format!("--camera {wanted}: {there}");
            return Err(SceneError::bad(Location::file(Path::new(&scene.name)), message));
        };
        let chosen = scene.cameras[index].clone();
        (scene.camera, scene.has_camera) = (chosen.camera, true);
        scene.film.width = chosen.width_of(&scene.film);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::staging::bare_scene;
    use super::*;

    #[test]
    fn what_points_along_z_points_up_once_it_is_raised() {
        let mut scene = bare_scene(Path::new("a.obj"));
        (scene.camera.up, scene.camera.eye) = (Vec3::Z, Vec3::new(1.0, 2.0, 3.0));
        Controls::default().raise(&mut scene);
        assert_eq!(scene.camera.up, Vec3::Z);
        let controls = Controls { z_up: true, ..Controls::default() };
        controls.raise(&mut scene);
        assert_eq!((scene.camera.up, scene.camera.eye), (Vec3::Y, Vec3::new(1.0, 3.0, -2.0)));
    }

    #[test]
    fn the_view_turns_rises_and_nears() {
        let mut scene = bare_scene(Path::new("a.obj"));
        let aim = |scene: &mut Scene, controls: Controls| {
            controls.aim(scene, DVec3::ZERO);
            scene.camera.eye.as_dvec3().normalize()
        };
        let right = aim(&mut scene, Controls { azimuth: Some(90.0), elevation: Some(0.0), ..Controls::default() });
        assert!((right - DVec3::X).length() < 1e-6, "{right}");
        let above = aim(&mut scene, Controls { elevation: Some(90.0), ..Controls::default() });
        assert!((above - DVec3::Y).length() < 1e-6 && scene.camera.up == Vec3::NEG_Z, "{above}");
        let Projection::Perspective { fov_y: before } = scene.camera.projection else { panic!("perspective") };
        aim(&mut scene, Controls { zoom: Some(2.0), ..Controls::default() });
        let Projection::Perspective { fov_y: after } = scene.camera.projection else { panic!("perspective") };
        assert!(((before * 0.5).tan() / (after * 0.5).tan() - 2.0).abs() < 1e-5);
        let from = Vec3::new(0.0, 3.0, 4.0);
        let seen = Controls { look_from: Some(from), look_at: Some(Vec3::Y), fov: Some(1.0), ..Controls::default() };
        aim(&mut scene, seen);
        assert_eq!((scene.camera.eye, scene.camera.target, scene.camera.up), (from, Vec3::Y, Vec3::Y));
        assert_eq!(scene.camera.projection, Projection::Perspective { fov_y: 1.0 });
    }
}
