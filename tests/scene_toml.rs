//! TOML scenes: what each key does to the scene, overrides, and the key reference in scenes/README.md.

use glam::{DVec3, Vec3};
use gonio::scene::load::toml::key_tables;
use gonio::scene::load::{Override, load};
use gonio::scene::*;
use std::fs;
use std::path::{Path, PathBuf};

/// The least that a scene needs, to be added to.
const LEAST: &str = "[camera]\neye = [0, 0, 5]\n[[object]]\nname = \"ball\"\nshape = \"sphere\"\n";

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

fn try_read(text: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("a.toml");
    fs::write(&file, text).expect("writable");
    let overrides: Vec<Override> = overrides.iter().map(|text| text.parse().expect("an override")).collect();
    load(&file, &overrides)
}

#[track_caller]
fn read(text: &str, overrides: &[&str]) -> Scene {
    try_read(text, overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// The only material of a scene.
#[track_caller]
fn material(keys: &str) -> Material {
    let text = format!("[[material]]\nname = \"m\"\n{keys}\n{LEAST}material = \"m\"\n");
    read(&text, &[]).materials.swap_remove(0)
}

#[track_caller]
fn light(keys: &str) -> Light {
    read(&format!("{LEAST}[[light]]\n{keys}\n"), &[]).lights.swap_remove(0)
}

/// Where `object` puts a point of its own space.
fn placed(object: &Object, point: [f64; 3]) -> DVec3 {
    object.transform.0.transform_point3(DVec3::from_array(point))
}

fn close(a: DVec3, b: [f64; 3]) -> bool {
    (a - DVec3::from_array(b)).abs().max_element() < 1e-12
}

#[test]
fn every_shipped_scene_loads_without_a_warning() {
    let mut count = 0;
    for folder in [scenes(), scenes().join("lecture")] {
        for entry in fs::read_dir(&folder).expect("the folder of scenes") {
            let path = entry.expect("readable").path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let scene = load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
            let traced = matches!(scene.settings.integrator, Integrator::Direct | Integrator::Path);
            assert!(!scene.objects.is_empty() && (traced || !scene.lights.is_empty()), "{}", path.display());
            count += 1;
        }
    }
    assert!(count >= 14, "{count} scenes");
}

#[test]
fn the_readme_lists_exactly_the_keys_that_the_reader_knows() {
    const HEAD: &str = "\n# Keys\n";
    let path = scenes().join("README.md");
    let written = fs::read_to_string(&path).expect("scenes/README.md");
    let (before, after) = written.split_once(HEAD).expect("a chapter \"Keys\"");
    let introduction = after.split("\n## ").next().unwrap_or("");
    let tables: Vec<String> = key_tables().iter().map(|(name, rows)| format!("\n## `{name}`\n\n{rows}")).collect();
    let expected = format!("{before}{HEAD}{}\n{}", introduction.trim_end_matches('\n'), tables.concat());
    if std::env::var_os("GONIO_UPDATE").is_some() {
        fs::write(&path, &expected).expect("writable");
        return;
    }
    for (written, expected) in written.lines().zip(expected.lines()) {
        assert_eq!(written, expected, "GONIO_UPDATE=1 cargo test --test scene_toml rewrites the tables");
    }
    assert_eq!(written.lines().count(), expected.lines().count(), "GONIO_UPDATE=1 rewrites the tables");
}

#[test]
fn a_scene_without_settings_has_the_documented_defaults() {
    let scene = read(LEAST, &[]);
    assert_eq!((scene.film.width, scene.film.height), (1280, 720));
    assert_eq!(scene.film.filter, Filter::Gaussian { radius: 1.5, sigma: 0.5 });
    assert_eq!((scene.film.unit_exponent, scene.film.tonemap, scene.film.exposure), (0, ToneMap::Clamp, 0.0));
    let settings = RenderSettings {
        integrator: Integrator::Whitted,
        samples: 16,
        seed: 0,
        sampler: Sampler::Sobol,
        max_depth: 8,
        min_weight: 0.003,
        rr_depth: 5,
        clamp: None,
        hide_emitters: false,
        transparent: false,
        aovs: false,
        shadows: Shadows::Opaque,
        shading: Shading::Phong,
    };
    assert_eq!(scene.settings, settings);
    assert_eq!((scene.ambient, scene.background), (Rgb::ZERO, Background::BLACK));
    let camera = scene.camera;
    assert_eq!((camera.target, camera.up), (Vec3::ZERO, Vec3::Y));
    assert_eq!(camera.projection, Projection::Perspective { fov_y: 45.0_f32.to_radians() });
    assert_eq!(scene.materials, [Material::grey("grey")]);
    assert_eq!(scene.objects[0].material, Some(MaterialId(0)));
}

#[test]
fn render_film_and_background_keys_arrive() {
    let text = format!(
        "[render]\nintegrator = \"local\"\nsamples = 9\nseed = 4294967295\nsampler = \"stratified\"\nmax_depth = 3\n\
         min_weight = 0.5\nrr_depth = 2\nclamp = 10\nshadows = false\nshading = \"gouraud\"\nambient = [0.1, 0.2, 0.3]\n\
         [film]\nsize = [3, 2]\nfilter = {{ type = \"gaussian\", radius = 2.5 }}\nunit = 0.25\ntonemap = \"reinhard\"\nexposure = -1\ngamma = 2.2\n\
         [background]\nbottom = 0.5\ntop = \"white\"\n{LEAST}segments = 8\nshading = \"flat\"\n"
    );
    let scene = read(&text, &[]);
    let settings = RenderSettings {
        integrator: Integrator::Local,
        samples: 9,
        seed: u32::MAX,
        sampler: Sampler::Stratified,
        max_depth: 3,
        min_weight: 0.5,
        rr_depth: 2,
        clamp: Some(10.0),
        hide_emitters: false,
        transparent: false,
        aovs: false,
        shadows: Shadows::Off,
        shading: Shading::Gouraud,
    };
    assert_eq!(scene.settings, settings);
    assert_eq!(scene.objects[0].shading, Some(Shading::Flat));
    let film = Film {
        width: 3,
        height: 2,
        crop: None,
        filter: Filter::Gaussian { radius: 2.5, sigma: 0.5 },
        unit_exponent: -2,
        tonemap: ToneMap::Reinhard,
        exposure: -1.0,
        gamma: Some(2.2),
    };
    assert_eq!(scene.film, film);
    assert_eq!(scene.ambient, Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(scene.background, Background::Gradient { bottom: Rgb::splat(0.5), top: Rgb::ONE });
}

#[test]
fn a_horizontal_field_of_view_becomes_a_vertical_one_by_the_frame() {
    let text = "[film]\nsize = [200, 100]\n[camera]\neye = [0, 0, 1]\nfov_x = 90\n[[object]]\nshape = \"sphere\"\n";
    let Projection::Perspective { fov_y } = read(text, &[]).camera.projection else { panic!("perspective") };
    assert!((fov_y - 2.0 * 0.5_f32.atan()).abs() < 1e-6, "{fov_y}");
    let text = "[camera]\neye = [0, 0, 1]\nprojection = \"orthographic\"\nheight = 3\n[[object]]\nshape = \"sphere\"\n";
    assert_eq!(read(text, &[]).camera.projection, Projection::Orthographic { height: 3.0 });
}

#[test]
fn each_model_reads_its_own_keys() {
    assert_eq!(material("color = \"red\"\nk_d = 0.5"), Material { color: Rgb::X, k_d: 0.5, ..Material::grey("m") });
    let phong = material("model = \"phong\"\nexponent = 8\nnormalisation = \"lafortune\"");
    assert_eq!(phong.model, Model::Phong { exponent: 8.0, lafortune: Some(true) });
    assert_eq!((phong.k_d, phong.k_s), (0.7, 0.3));
    assert_eq!(material("model = \"phong\"").model, Model::Phong { exponent: 32.0, lafortune: None });
    assert_eq!(material("model = \"blinn-phong\"\nexponent = 0").model, Model::BlinnPhong { exponent: 0.0 });
    assert_eq!(material("model = \"mirror\"").color, Rgb::splat(0.9));
    let water = material("model = \"dielectric\"\neta = \"water\"\nabsorption = [1, 2, 3]");
    assert_eq!(water.model, Model::Dielectric { eta: 1.333, absorption: Rgb::new(1.0, 2.0, 3.0) });
    let lamp = material("model = \"emissive\"\ncolor = [4, 5, 6]");
    assert_eq!((lamp.model, lamp.color), (Model::Emissive, Rgb::new(4.0, 5.0, 6.0)));
}

#[test]
fn cook_torrance_takes_metals_indices_and_lobes() {
    let plastic = material("model = \"cook-torrance\"\nk_s = 0.1\nm = 0.15\neta = 1.46\nnormalisation = \"1982\"");
    assert_eq!(
        plastic.model,
        Model::CookTorrance {
            lobes: vec![Lobe::beckmann(0.15, 1.0)],
            fresnel: Fresnel::Dielectric { eta: 1.46 },
            masking: Masking::VCavity,
            normalisation_1982: true
        }
    );
    assert_eq!((plastic.k_d, plastic.k_s), (0.9, 0.1), "k_d + k_s = 1");
    let copper = material(
        "model = \"cook-torrance\"\nmetal = \"Cu\"\nlobes = [{ m = 0.4, weight = 0.4 }, { m = 0.2, weight = 0.6 }]",
    );
    let Model::CookTorrance { lobes, fresnel: Fresnel::Conductor { .. }, .. } = &copper.model else {
        panic!("{:?}", copper.model)
    };
    assert_eq!(lobes, &[Lobe::beckmann(0.4, 0.4), Lobe::beckmann(0.2, 0.6)]);
    assert_eq!((copper.k_d, copper.k_s), (0.0, 1.0));
    assert!((copper.color - Rgb::new(0.955, 0.638, 0.537)).abs().max_element() < 1e-4, "ambient light shows copper");
    let own = material("model = \"cook-torrance\"\neta = [0.2, 1, 1.2]\nk = [4, 2.5, 2.4]");
    let Model::CookTorrance { fresnel, .. } = own.model else { panic!("{:?}", own.model) };
    assert_eq!(fresnel, Fresnel::Conductor { eta: Rgb::new(0.2, 1.0, 1.2), k: Rgb::new(4.0, 2.5, 2.4) });
}

#[test]
fn transparency_is_interpolated_unless_it_is_filtered() {
    assert_eq!(material("k_t = 0.25").transparency, Some(Transparency::Interpolated { k_t: 0.25 }));
    let filtered = material("k_t = 0.25\ntransparency_mode = \"filtered\"\ntransparency_color = [1, 0.5, 0]");
    assert_eq!(filtered.transparency, Some(Transparency::Filtered { k_t: 0.25, color: Rgb::new(1.0, 0.5, 0.0) }));
    assert_eq!(material("k_t = 0").transparency, None);
}

#[test]
fn a_texture_is_read_once_and_laid_on_as_written() {
    let file = scenes().join("textures/checker.png");
    let file = file.display();
    let text = format!(
        "[[material]]\nname = \"a\"\ntexture = '{file}'\n[[material]]\nname = \"b\"\ntexture = '{file}'\n[[material]]\nname = \"c\"\n\
         texture = {{ file = '{file}', wrap = [\"clamp\", \"mirror\"], filter = \"nearest\", scale = 4, offset = [0.5, 0.25], colorspace = \"linear\" }}\n{LEAST}"
    );
    let scene = read(&text, &[]);
    let ids: Vec<_> = scene.materials.iter().take(3).map(|material| material.texture(Parameter::Color)).collect();
    assert_eq!(ids, [Some(TextureId(0)), Some(TextureId(0)), Some(TextureId(1))]);
    assert_eq!(scene.materials[0].color, Rgb::ONE, "a texture shows its own colours unless a factor is given");
    let texture = &scene.textures[1];
    assert_eq!((texture.wrap_u, texture.wrap_v, texture.bilinear), (Wrap::Clamp, Wrap::Mirror, false));
    assert_eq!((texture.scale, texture.offset), ([4.0, 4.0], [0.5, 0.25]));
    assert!(matches!(texture.data, TextureData::Linear8(_)) && matches!(scene.textures[0].data, TextureData::Srgb8(_)));
}

#[test]
fn lights_have_unit_directions_and_the_unit_of_the_scene() {
    let sun = light(
        "type = \"directional\"\ndirection = [0, -3, -4]\nintensity = [1, 2, 3]\ncolor = 0.5\ncasts_shadow = false",
    );
    assert_eq!(sun.kind, LightKind::Directional { direction: Vec3::new(0.0, -0.6, -0.8) });
    assert_eq!((sun.intensity, sun.casts_shadow), (Rgb::new(0.5, 1.0, 1.5), false));
    let lamp = light("type = \"point\"\nposition = [1, 2, 3]\nattenuation = [1, 0, 2]");
    assert_eq!(lamp.kind, LightKind::Point { position: Vec3::new(1.0, 2.0, 3.0) });
    assert_eq!(lamp.attenuation, Attenuation::Polynomial { c1: 1.0, c2: 0.0, c3: 2.0 });
    let keys =
        "type = \"spot\"\nposition = [0, 5, 0]\ntarget = [0, 5, -2]\nouter_angle = 60\ninner_angle = 45\nexponent = 8";
    let (inner, outer) = (45.0_f64.to_radians() as f32, 60.0_f64.to_radians() as f32);
    let (position, direction) = (Vec3::new(0.0, 5.0, 0.0), Vec3::NEG_Z);
    assert_eq!(light(keys).kind, LightKind::Spot { position, direction, inner, outer, exponent: 8.0 });

    let lecture =
        format!("[render]\nintensity = \"lecture\"\n{LEAST}[[light]]\ntype = \"point\"\nposition = [1, 2, 3]\n");
    let lecture = &read(&lecture, &[]).lights[0];
    assert_eq!((lecture.unit, lecture.attenuation), (IntensityUnit::Lecture, Attenuation::None));
    assert_eq!(
        (lamp.unit, light("type = \"point\"\nposition = [1, 2, 3]").attenuation),
        (IntensityUnit::Radiometric, Attenuation::InverseSquare)
    );
}

#[test]
fn flaps_lens_filtered_shadows_and_priorities_arrive() {
    assert_eq!(light("type = \"point\"\nposition = [1, 2, 3]").flaps, Flaps::NONE);
    let flaps = light("type = \"point\"\nposition = [1, 2, 3]\nflaps_x = [-1, 2]\nflaps_z = [0.5, 0.5]").flaps;
    assert_eq!(flaps.min, Vec3::new(-1.0, f32::NEG_INFINITY, 0.5));
    assert_eq!(flaps.max, Vec3::new(2.0, f32::INFINITY, 0.5));

    assert_eq!(read(LEAST, &[]).camera.lens, None);
    let lens = |keys: &[&str]| read(LEAST, keys).camera.lens.expect("a lens");
    let at_target = lens(&["camera.lens_radius=0.25", "camera.target=[0, 3, 1]"]);
    assert_eq!(at_target, Lens { radius: 0.25, focus_distance: 5.0 });
    let nearer = lens(&["camera.lens_radius=0.25", "camera.focus_distance=2"]);
    assert_eq!(nearer, Lens { radius: 0.25, focus_distance: 2.0 });

    let shadows = |word: &str| read(LEAST, &[&format!("render.shadows={word}")]).settings.shadows;
    assert_eq!(
        [shadows("true"), shadows("false"), shadows("\"filtered\"")],
        [Shadows::Opaque, Shadows::Off, Shadows::Filtered]
    );
    assert_eq!(material("model = \"dielectric\"\npriority = 3").priority, Some(3));
    assert_eq!(material("model = \"dielectric\"").priority, None);
}

#[test]
fn an_object_is_scaled_then_turned_then_moved() {
    let keys = "scale = [2, 1, 1]\nrotate = [0, 0, 1, 90]\ntranslate = [10, 0, 0]\n";
    let steps = "transform = [{ scale = [2, 1, 1] }, { rotate = [0, 0, 5, 90] }, { translate = [10, 0, 0] }]\n";
    let matrix = "matrix = [[0, -1, 0, 10], [2, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n";
    for place in [keys, steps, matrix] {
        let scene = read(&format!("{LEAST}{place}"), &[]);
        assert!(close(placed(&scene.objects[0], [1.0, 0.0, 0.0]), [10.0, 2.0, 0.0]), "{place}");
    }
    let reversed = "transform = [{ translate = [10, 0, 0] }, { scale = 2 }]\n";
    assert!(close(placed(&read(&format!("{LEAST}{reversed}"), &[]).objects[0], [0.0; 3]), [20.0, 0.0, 0.0]));
}

#[test]
fn copies_share_their_mesh_and_are_placed_after_the_object() {
    let text = "[camera]\neye = [0, 0, 5]\n[[material]]\nname = \"red\"\ncolor = \"red\"\n[[object]]\nname = \"b\"\nshape = \"box\"\nscale = 2\n\
                instances = [{ translate = [1, 0, 0] }, { translate = [0, 1, 0], material = \"red\" }]\n\
                grid = { count = [1, 1, 2], spacing = [0, 0, 4] }\n";
    let scene = read(text, &[]);
    assert_eq!((scene.meshes.len(), scene.objects.len()), (1, 4));
    assert!(scene.objects.iter().all(|object| object.geometry == Geometry::Mesh(MeshId(0))));
    assert!(close(placed(&scene.objects[0], [0.5, 0.0, 0.0]), [2.0, 0.0, -2.0]), "scaled before, moved after");
    assert!(close(placed(&scene.objects[3], [0.0; 3]), [0.0, 1.0, 2.0]));
    assert_eq!(scene.objects[1].material, Some(MaterialId(0)));
    assert_ne!(scene.objects[0].material, Some(MaterialId(0)));
    assert_eq!(scene.objects[1].name, "b[1]");
}

#[test]
fn every_shape_has_the_size_that_its_keys_say() {
    let cases: &[(&str, [f32; 3])] = &[
        ("shape = \"quad\"\nsize = [2, 4]", [2.0, 0.0, 4.0]),
        ("shape = \"box\"\nsize = [1, 2, 3]\nsegments = 2", [1.0, 2.0, 3.0]),
        ("shape = \"disk\"\nradius = 2\nsegments = 8", [4.0, 0.0, 4.0]),
        ("shape = \"cylinder\"\nradius = 1\nheight = 3\nsegments = 8\ncapped = false", [2.0, 3.0, 2.0]),
        ("shape = \"cone\"\nradius = 1\nheight = 3\nsegments = 8", [2.0, 3.0, 2.0]),
        ("shape = \"torus\"\nmajor_radius = 2\nminor_radius = 0.5\nsegments = 8\nrings = 8", [5.0, 1.0, 5.0]),
        ("shape = \"lathe\"\nprofile = [[1, 0], [1, 2]]\ncurve = \"polyline\"\nsegments = 8", [2.0, 2.0, 2.0]),
        ("shape = \"sphere\"\nradius = 3\nsegments = 8", [6.0, 6.0, 6.0]),
    ];
    for (keys, size) in cases {
        let scene = read(&format!("[camera]\neye = [0, 0, 5]\n[[object]]\n{keys}\n"), &[]);
        assert!(scene.warnings.iter().all(|warning| !warning.contains("no effect")), "{:?}", scene.warnings);
        let positions = &scene.meshes[0].positions;
        let low = positions.iter().fold(Vec3::INFINITY, |low, p| low.min(*p));
        let high = positions.iter().fold(Vec3::NEG_INFINITY, |high, p| high.max(*p));
        let error = (high - low - Vec3::from_array(*size)).abs().max_element();
        assert!(error < 1e-5, "{keys}: {:?}", high - low);
    }
    let teapot = read("[camera]\neye = [0, 0, 9]\n[[object]]\nshape = \"teapot\"\nsegments = 2\n", &[]);
    assert!(teapot.meshes[0].triangles.len() > 200);
    let noise =
        "shape = \"heightfield\"\nsegments = 16\nsize = [4, 2]\nheight = 0.5\nnoise = { features = 2, seed = 7 }";
    let land = read(&format!("[camera]\neye = [0, 0, 9]\n[[object]]\n{noise}\n"), &[]);
    assert_eq!(land.meshes[0].triangles.len(), 2 * 16 * 16);
    let ball = read("[camera]\neye = [0, 0, 9]\n[[object]]\nshape = \"sphere\"\nradius = 3\n", &[]);
    assert_eq!(ball.objects[0].geometry, Geometry::Sphere, "without segments a sphere is exact");
    assert!(close(placed(&ball.objects[0], [1.0, 0.0, 0.0]), [3.0, 0.0, 0.0]));
}

#[test]
fn shapes_of_any_size_have_about_as_many_triangles_as_they_say() {
    let shape = |keys: &str| read(&format!("[camera]\neye = [0, 0, 9]\n[[object]]\n{keys}\n"), &[]);
    assert_eq!(shape("shape = \"terrain\"\ntriangles = 800").meshes[0].triangles.len(), 800);
    assert_eq!(shape("shape = \"hairball\"\ntriangles = 960").meshes[0].triangles.len(), 960);
    let flake = shape("shape = \"sphereflake\"\nlevel = 1\nscale = 3\ntranslate = [1, 0, 0]");
    assert_eq!((flake.objects.len(), flake.meshes.len()), (10, 0), "spheres are exact");
    assert!(flake.objects.iter().all(|object| object.geometry == Geometry::Sphere));
    assert!(close(placed(&flake.objects[0], [1.0, 0.0, 0.0]), [4.0, 0.0, 0.0]));
    assert!(close(placed(&flake.objects[1], [0.0, 0.0, 0.0]), [5.0, 0.0, 0.0]), "it touches the first along x");
    let field = shape("shape = \"teapots\"\ntriangles = 20000");
    assert_eq!((field.objects.len(), field.meshes.len()), (5, 1), "one teapot, placed five times");
}

#[test]
fn a_mesh_file_brings_its_materials_and_is_read_once() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("writable");
    write("m.mtl", "newmtl green\nKd 0 1 0\n");
    write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl green\nf 1 2 3\n");
    write(
        "a.toml",
        "[camera]\neye = [0, 0, 5]\n[[material]]\nname = \"own\"\n[[object]]\nshape = \"mesh\"\nfile = \"m.obj\"\n\
         [[object]]\nshape = \"mesh\"\nfile = \"m.obj\"\ntranslate = [2, 0, 0]\nmaterial = \"own\"\n",
    );
    let scene = load(&folder.path().join("a.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scene.meshes.len(), scene.objects.len()), (1, 2));
    let first = scene.meshes[0].face_materials[0];
    assert_eq!(scene.materials[first.0 as usize].color, Rgb::Y);
    assert_eq!((scene.objects[0].material, scene.objects[1].material), (None, Some(MaterialId(0))));
    assert!(scene.lights.is_empty(), "a mesh in a scene is not staged");
}

#[test]
fn a_key_that_means_nothing_here_is_a_warning_with_its_place() {
    let scene = read(&format!("[[material]]\nname = \"m\"\nexponent = 3\n{LEAST}"), &[]);
    let warning = &scene.warnings[0];
    assert!(warning.contains("a.toml:3:1: \"exponent\" has no effect with model = \"lambert\""), "{warning}");
    assert!(scene.warnings[1].contains("no light"), "{:?}", scene.warnings);
}

#[test]
fn overrides_change_values_by_name_and_by_number() {
    let text = format!(
        "[[material]]\nname = \"copper\"\nmodel = \"phong\"\nexponent = 3\n{LEAST}material = \"copper\"\n\
         [[light]]\ntype = \"point\"\nposition = [1, 1, 1]\n"
    );
    let overrides = [
        "render.samples=64",
        "material.copper.exponent=20",
        "material.copper.color=#ffffff",
        "object.ball.translate=[1, 2, 3]",
        "light.0.intensity=3",
        "light.0.position.1=7",
        "camera.projection=orthographic",
        "camera.height = 2",
    ];
    let scene = read(&text, &overrides);
    assert_eq!(scene.settings.samples, 64);
    assert_eq!(scene.materials[0].model, Model::Phong { exponent: 20.0, lafortune: None });
    assert_eq!(scene.materials[0].color, Rgb::ONE);
    assert!(close(placed(&scene.objects[0], [0.0; 3]), [1.0, 2.0, 3.0]));
    assert_eq!(scene.lights[0].intensity, Rgb::splat(3.0));
    assert_eq!(scene.lights[0].kind, LightKind::Point { position: Vec3::new(1.0, 7.0, 1.0) });
    assert_eq!(scene.camera.projection, Projection::Orthographic { height: 2.0 });
}

#[test]
fn a_wrong_override_is_named_in_the_error() {
    let cases: &[(&str, &str)] = &[
        ("render.smaples=3", "--set render.smaples=3: unknown key \"smaples\"; did you mean \"samples\"?"),
        (
            "render.samples=many",
            "--set render.samples=many: \"samples\" must be an integer from 1 to 16777216, found the string \"many\"",
        ),
        ("render.samples=[1", "--set render.samples=[1: "),
        ("material.x.exponent=3", "--set material.x.exponent=3: the scene has no [[material]]"),
        (
            "object.bal.scale=3",
            "--set object.bal.scale=3: there is no item named \"bal\" in a list of 1; did you mean \"ball\"?",
        ),
        ("object.7.scale=3", "--set object.7.scale=3: there is no item 7: the list has 1, counted from 0"),
        ("object.ball.shape.x=3", "--set object.ball.shape.x=3: \"x\" is no part of the string \"sphere\""),
    ];
    for (text, expected) in cases {
        let message = try_read(LEAST, &[text]).expect_err(text).to_string();
        assert!(message.starts_with(expected), "{message}");
    }
    for text in ["render.samples", "=3", "a..b=3", "a.=3"] {
        assert!(text.parse::<Override>().is_err(), "{text}");
    }
    let quoted: Override = "material.\"a.b\".color=red".parse().expect("a quoted name");
    assert_eq!(quoted.path, ["material", "a.b", "color"]);
}

#[test]
fn a_bare_mesh_takes_overrides_of_what_the_stage_makes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("m.obj");
    fs::write(&file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("writable");
    let set =
        |texts: &[&str]| -> Vec<Override> { texts.iter().map(|text| text.parse().expect("an override")).collect() };
    let scene =
        load(&file, &set(&["film.size=[64, 64]", "camera.eye=[0, 0, 9]", "render.samples=3"])).expect("a scene");
    assert_eq!((scene.film.width, scene.film.height, scene.settings.samples), (64, 64, 3));
    assert_eq!(scene.camera.eye, Vec3::new(0.0, 0.0, 9.0));
    assert!(scene.background.shines() && scene.metered, "a bare mesh is staged");
    let error = load(&file, &set(&["material.grey.color=red"])).expect_err("no materials to set").to_string();
    assert!(error.contains("the scene has no [[material]]"), "{error}");
    let red = load(&file, &set(&["background.color=red"])).expect("a scene");
    assert_eq!(red.background, Background::flat(Rgb::X));
    let dim = load(&file, &set(&["background.scale=0.5", "render.samples=3"])).expect("a scene");
    let Background::Image(studio) = dim.background else { panic!("a studio") };
    assert_eq!((studio.scale, dim.settings.samples, dim.metered), (Rgb::splat(0.5), 3, true));
    let error = load(&file, &set(&["panel=[]"])).expect_err("not for meshes").to_string();
    assert!(error.contains("can only be set in a TOML scene"), "{error}");
}

#[test]
fn flaps_lenses_shadows_and_priorities_out_of_range_are_refused() {
    let refuses = |text: String, expected: &str| {
        let message = try_read(&text, &[]).expect_err(&text).to_string();
        assert!(message.ends_with(expected), "{message}\nfor:\n{text}");
    };
    let light = |keys: &str| format!("{LEAST}[[light]]\ntype = \"point\"\nposition = [0, 0, 0]\n{keys}\n");
    refuses(light("flaps_y = [1, 0]"), "a.toml:9:11: \"flaps_y\" = [1, 0] has its smaller number last");
    refuses(light("flaps_y = [1, 2, 3]"), "9:11: \"flaps_y\" must be two numbers [min, max], found an array of 3");
    let expected = "a.toml:2:18: \"focus_distance\" has no meaning without a \"lens_radius\" above 0";
    refuses(LEAST.replace("[camera]\n", "[camera]\nfocus_distance = 2\n"), expected);
    let expected = "a.toml:7:11: \"shadows\" must be true, false or \"filtered\", found the string \"soft\"";
    refuses(format!("{LEAST}[render]\nshadows = \"soft\"\n"), expected);
    let glass = format!("{LEAST}[[material]]\nname = \"a\"\nmodel = \"dielectric\"\npriority = 256\n");
    refuses(glass, "a.toml:9:12: \"priority\" must be an integer from 0 to 255, found 256");
}

#[test]
fn what_single_precision_cannot_carry_is_refused_where_it_is_written() {
    for (keys, place, name) in [
        ("translate = [0, 1e11, 0]", "7:13", "sphere.0"),
        ("scale = 1e-11", "7:9", "sphere.0"),
        ("radius = 1e11", "5:1", "sphere.0"),
        ("instances = [{ translate = [0, 0, 1] }, { translate = [1e11, 0, 0] }]", "7:55", "sphere.0[1]"),
    ] {
        let text =
            format!("[camera]\neye = [0, 0, 5]\n[film]\nsize = [4, 4]\n[[object]]\nshape = \"sphere\"\n{keys}\n");
        let message = try_read(&text, &[]).expect_err(keys).to_string();
        let expected =
            format!("a.toml:{place}: object \"{name}\" is too large, too small or too far away: sizes from ");
        assert!(message.contains(&expected), "{message}\nfor:\n{text}");
    }
}
