//! Mitsuba's own scenes and pictures, where they are at hand.

use super::assets;
use gonio::bake::bake;
use gonio::film::read::read_picture;
use gonio::render::cpu::CpuRenderer;
use gonio::scene::load::load;
use gonio::scene::load::mitsuba::NO_MEDIA;
use gonio::scene::{Fresnel, Model};
use gonio::verify::mitsuba::{Case, Reference, find_cases, z_test};
use std::path::Path;

#[test]
fn every_scene_with_a_reference_loads_but_those_with_media() {
    let Some(assets) = assets() else { return };
    let mut cases = find_cases(&assets.join("mitsuba-ref")).expect("a folder");
    assert_eq!(cases.len(), 16);
    for name in ["cbox", "cbox-rgb", "cbox-spectral"] {
        let scene = assets.join(format!("cornell/mitsuba-cbox/{name}.xml"));
        cases.push(Case { reference: Reference::Displayed(scene.clone()), scene });
    }
    for Case { scene, .. } in cases {
        let media = scene.ends_with("test_homo_null_envmap_volpath.xml");
        match load(&scene, &[]) {
            Ok(loaded) => {
                assert!(!media && !loaded.objects.is_empty());
                assert_eq!(loaded.warnings, Vec::<String>::new(), "{}", scene.display());
            }
            Err(error) => assert!(media && error.to_string().contains(NO_MEDIA), "{error}"),
        }
    }
}

#[test]
fn metals_are_the_means_of_mitsubas_tables() {
    // The scene lies elsewhere, so a relative path would not lead there.
    let Some(assets) = assets().map(|folder| folder.canonicalize().expect("it is there")) else { return };
    for name in ["Ag", "Al", "Au", "Cr", "Cu"] {
        let part = |part: &str| {
            let file = assets.join(format!("spectra/mitsuba-ior/{name}.{part}.spd"));
            format!("<spectrum name=\"{part}\" filename=\"{}\"/>", file.display())
        };
        let of = |inner: &str| match super::material(&format!("<bsdf type=\"conductor\">{inner}</bsdf>")).model {
            Model::Conductor { fresnel: Fresnel::Conductor { eta, k } } => [eta, k],
            model => panic!("{model:?}"),
        };
        let table = of(&(part("eta") + &part("k")));
        let named = of(&format!("<string name=\"material\" value=\"{name}\"/>"));
        for (table, named) in table.iter().zip(named) {
            assert!((*table - named).abs().max_element() < 2e-6, "{name}: {table} is not {named}");
        }
    }
}

/// Renders the scene with `samples` a pixel and tests it against its reference.
fn accepted(scene: &Path, mean: &Path, variance: &Path, samples: u32) -> f64 {
    let scene = load(scene, &[]).unwrap_or_else(|error| panic!("{error}"));
    let data = bake(&scene).expect("a scene that bakes");
    let mut film = super::scenes::film(&scene, &data);
    super::scenes::accumulate(&mut CpuRenderer::new(&data, None).expect("a renderer"), &mut film, 0..samples);
    let read = |path: &Path| read_picture(path).expect("a reference").image;
    z_test(&film.resolve(), &read(mean), &read(variance), samples).accepted
}

#[test]
fn small_scenes_pass_mitsubas_z_test() {
    let Some(assets) = assets() else { return };
    // Few samples: only gross errors show; `gonio verify --mitsuba` takes as many as Mitsuba's own test.
    let wanted = ["directional", "textured_diffuse", "orthographic", "roughdielectric", "pointlight"];
    let mut tested = 0;
    for case in find_cases(&assets.join("mitsuba-ref/tests")).expect("a folder") {
        let name = case.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let (true, Reference::Statistics { mean, variance }) =
            (wanted.iter().any(|w| name.contains(w)), &case.reference)
        else {
            continue;
        };
        let accepted = accepted(&case.scene, mean, variance, 16);
        assert!(accepted >= 0.9975, "{name}: {accepted}");
        tested += 1;
    }
    assert_eq!(tested, wanted.len());
}
