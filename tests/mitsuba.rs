//! Mitsuba's XML scenes: what is read, what it means, and what is refused.

mod common;

use gonio::scene::load::{load, load_with};
use gonio::scene::*;
use std::path::{Path, PathBuf};

/// The folder of third-party scenes, if it is there.
fn assets() -> Option<PathBuf> {
    let folder = std::env::var_os("GONIO_ASSETS").map_or_else(|| PathBuf::from("../shared/assets"), PathBuf::from);
    let found = folder.is_dir();
    if !found {
        println!("SKIPPED: no assets in {}", folder.display());
    }
    found.then_some(folder)
}

#[test]
fn every_reference_scene_of_surfaces_loads() {
    let Some(assets) = assets() else { return };
    let tests = assets.join("mitsuba-ref/tests/scenes");
    let docs = assets.join("mitsuba-ref/docs/scenes");
    let scenes = [
        tests.join("bsdf_spheres/test_arealight_path.xml"),
        tests.join("bsdf_spheres/test_constant_path.xml"),
        tests.join("bsdf_spheres/test_envmap_path.xml"),
        tests.join("bsdf_spheres/test_pointlight_path.xml"),
        tests.join("bsdf_spheres/test_roughdielectric_path.xml"),
        tests.join("bsdf_spheres/test_textured_diffuse_path.xml"),
        tests.join("floating_sphere/test_directional_direct.xml"),
        tests.join("orthographic_sensor/test_orthographic_path.xml"),
        tests.join("participating_media/test_surf_area_light_volpath.xml"),
        docs.join("bsdf_conductor_aluminium.xml"),
        docs.join("bsdf_dielectric_glass.xml"),
        docs.join("bsdf_diffuse_plain.xml"),
        docs.join("bsdf_roughdielectric_glass.xml"),
        docs.join("bsdf_roughplastic_ggx.xml"),
        docs.join("variants_cbox_rgb.xml"),
        assets.join("cornell/mitsuba-cbox/cbox.xml"),
        assets.join("cornell/mitsuba-cbox/cbox-rgb.xml"),
        assets.join("cornell/mitsuba-cbox/cbox-spectral.xml"),
    ];
    for path in scenes {
        match load(&path, &[]) {
            Ok(scene) => println!("{}: {} objects {} materials {} meshes, warnings {:?}", path.display(), scene.objects.len(), scene.materials.len(), scene.meshes.len(), scene.warnings),
            Err(error) => println!("ERROR {error}"),
        }
    }
}
