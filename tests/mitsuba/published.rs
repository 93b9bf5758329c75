//! Scenes as people publish them: every plug-in with every documented parameter, in the ways in which exporters write them.

use super::{LEAST, material, read, try_files, try_read};
use glam::{DVec3, Vec3};
use gonio::bake::bake;
use gonio::scene::load::load;
use gonio::scene::load::mitsuba::plugin_tables;
use gonio::scene::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

const SCENES: [(&str, &str); 4] = [
    ("interior.xml", include_str!("published/interior.xml")),
    ("studio.xml", include_str!("published/studio.xml")),
    ("plain.xml", include_str!("published/plain.xml")),
    (
        "direct.xml",
        "<scene version=\"3.0.0\"><integrator type=\"direct\"><integer name=\"emitter_samples\" value=\"2\"/>\
         <integer name=\"bsdf_samples\" value=\"1\"/><integer name=\"samples_per_pass\" value=\"4\"/>\
         <integer name=\"block_size\" value=\"32\"/><float name=\"timeout\" value=\"-1\"/></integrator>\
         <sensor type=\"perspective\"><string name=\"focal_length\" value=\"50mm\"/></sensor>\
         <sensor type=\"thinlens\"><float name=\"fov\" value=\"40\"/></sensor>\
         <shape type=\"merge\"><shape type=\"sphere\"/></shape><emitter type=\"constant\"/></scene>",
    ),
];

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                   property float r\nproperty float g\nproperty float b\nelement face 1\n\
                   property list uchar int vertex_indices\nend_header\n\
                   0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n";

/// One triangle in version 4 of the format.
fn serialized() -> Vec<u8> {
    let mut content = 0x1000u32.to_le_bytes().to_vec();
    content.extend(b"part\0");
    content.extend([3u64.to_le_bytes(), 1u64.to_le_bytes()].concat());
    content.extend([0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|v| v.to_le_bytes()));
    content.extend([0u32, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
    let mut file = [0x1c, 0x04, 0x04, 0x00].to_vec();
    file.extend(miniz_oxide::deflate::compress_to_vec_zlib(&content, 6));
    file.extend([0; 8]);
    file.extend(1u32.to_le_bytes());
    file
}

/// A folder with the scenes and all that they name.
fn published() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["models", "textures"] {
        std::fs::create_dir(at(name)).expect("a folder");
    }
    let write = |name: &str, bytes: &[u8]| std::fs::write(at(name), bytes).expect("writable");
    for (name, text) in SCENES {
        write(name, text.as_bytes());
    }
    write("models/Mesh001.obj", OBJ.as_bytes());
    write("models/part.ply", PLY.as_bytes());
    write("models/part.serialized", &serialized());
    write("metal.eta.spd", b"# nm eta\n400 1.5\n550 1.0\n700 0.5\n");
    let picture = image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([40 + 50 * x as u8, 60 * y as u8, 128]));
    picture.save(at("textures/wood.png")).expect("writable");
    picture.save(at("textures/leaf.png")).expect("writable");
    let sky = image::Rgb32FImage::from_fn(8, 4, |x, y| image::Rgb([x as f32, y as f32, 1.0]));
    sky.save(at("textures/sky.hdr")).expect("writable");
    folder
}

#[test]
fn published_scenes_load_bake_and_warn_of_nothing_but_what_is_left_out() {
    let folder = published();
    for (name, expected) in
        [("interior.xml", vec![]), ("studio.xml", vec!["\"aov\" is left out"]), ("plain.xml", vec![])]
    {
        let scene = load(&folder.path().join(name), &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.warnings.len(), expected.len(), "{:?}", scene.warnings);
        for (warning, part) in scene.warnings.iter().zip(expected) {
            assert!(warning.contains(part), "{warning}");
        }
        bake(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// Plug-ins of the tables that scenes/README.md prints: (element, type) and the names of their properties.
fn documented() -> BTreeMap<(String, String), BTreeSet<String>> {
    let mut plugins = BTreeMap::new();
    for (class, rows) in plugin_tables() {
        for row in rows.lines().skip(2) {
            let cells: Vec<&str> = row.split(" | ").collect();
            let words = |cell: &str| -> Vec<String> { cell.split('`').skip(1).step_by(2).map(str::to_owned).collect() };
            plugins.insert((class.to_owned(), words(cells[0]).remove(0)), words(cells[1]).into_iter().collect());
        }
    }
    plugins
}

#[test]
fn the_published_scenes_write_every_property_of_every_plugin() {
    let mut missing = documented();
    assert!(missing.len() > 50, "{}", missing.len());
    for (name, text) in SCENES {
        let xml = roxmltree::Document::parse(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        for node in xml.descendants().filter(|node| node.is_element()) {
            let kind = node.attribute("type").unwrap_or_default().replace("$integrator", "path");
            let Some(left) = missing.get_mut(&(node.tag_name().name().to_owned(), kind)) else { continue };
            left.insert(String::new());
            for child in node.children().filter_map(|child| child.attribute("name")) {
                left.remove(child);
            }
        }
    }
    // An empty name says that the plug-in was there.
    let samplers_of_the_same_kind = ["multijitter", "ldsampler"];
    let same = ["volpath", "ptracer", "catmullrom", "box", "gaussian", "srgb"];
    for ((class, kind), left) in missing {
        let known = samplers_of_the_same_kind.contains(&kind.as_str()) || same.contains(&kind.as_str());
        let names: Vec<&String> = left.iter().filter(|name| !name.is_empty()).collect();
        assert!(known || (names.is_empty() && left.contains("")), "{class} {kind}: {names:?} are in no scene");
    }
}

#[test]
fn a_crop_is_what_is_rendered_of_the_film() {
    let film = |inner: &str| {
        try_read(&format!(
            "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"60\"/>\
             <integer name=\"height\" value=\"40\"/>{inner}</film></sensor><shape type=\"sphere\"/>"
        ))
    };
    assert_eq!(film("").expect("a scene").film.crop, None);
    let crop = film("<integer name=\"crop_offset_x\" value=\"10\"/><integer name=\"crop_width\" value=\"50\"/>");
    let scene = crop.expect("a scene");
    assert_eq!(scene.film.crop, Some(Window { x: 10, y: 0, width: 50, height: 40 }));
    assert_eq!((scene.film.width, scene.film.height), (60, 40), "the field of view is the whole film's");
    let outside = film("<integer name=\"crop_offset_y\" value=\"1\"/>").unwrap_err().to_string();
    assert!(outside.contains("is not inside the film of 60 x 40"), "{outside}");
}

#[test]
fn a_thin_lens_is_focused_where_it_says_or_on_the_far_plane() {
    let lens = |inner: &str| {
        let radius = "<float name=\"aperture_radius\" value=\"0.25\"/>";
        read(&format!("<sensor type=\"thinlens\">{radius}{inner}</sensor><shape type=\"sphere\"/>")).camera.lens
    };
    assert_eq!(lens(""), Some(Lens { radius: 0.25, focus_distance: 10_000.0 }));
    assert_eq!(lens("<float name=\"far_clip\" value=\"50\"/>"), Some(Lens { radius: 0.25, focus_distance: 50.0 }));
    let written = "<float name=\"far_clip\" value=\"50\"/><float name=\"focus_distance\" value=\"3\"/>";
    assert_eq!(lens(written), Some(Lens { radius: 0.25, focus_distance: 3.0 }));
    assert_eq!(read("<sensor type=\"perspective\"/><shape type=\"sphere\"/>").camera.lens, None);
}

/// Where the ray through a film point of a 40 x 20 pixel camera goes at distance 1: to the right, and up.
fn seen(sensor: &str, x: f32, y: f32) -> [f32; 2] {
    let scene = read(&format!(
        "<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/><film type=\"hdrfilm\">\
         <integer name=\"width\" value=\"40\"/><integer name=\"height\" value=\"20\"/></film>{sensor}</sensor><shape type=\"sphere\"/>"
    ));
    let data = bake(&scene).expect("bakes");
    let direction = gonio::shading::camera::camera_ray(&data.header.camera, x, y).direction;
    // The camera looks along +z with y up: -x is to its right.
    [-direction.x / direction.z, direction.y / direction.z]
}

#[track_caller]
fn assert_seen(found: [f32; 2], wanted: [f32; 2]) {
    assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-6), "{found:?} instead of {wanted:?}");
}

#[test]
fn a_mirrored_camera_swaps_left_and_right() {
    assert_seen(seen("", 40.0, 0.0), [1.0, 0.5]);
    let mirrored = "<transform name=\"to_world\"><scale x=\"-1\"/></transform>";
    assert_seen(seen(mirrored, 40.0, 0.0), [-1.0, 0.5]);
}

#[test]
fn the_principal_point_moves_the_film_by_parts_of_its_size() {
    // A quarter of the film to the right, half of it down.
    let offset = "<float name=\"principal_point_offset_x\" value=\"0.25\"/><float name=\"principal_point_offset_y\" value=\"0.5\"/>";
    assert_seen(seen(offset, 20.0, 10.0), seen("", 30.0, 20.0));
}

#[test]
fn faces_without_normals_turn_with_a_mirroring_transform_and_normals_do_not() {
    let bare = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let with = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
    // The outside of a placed face, which a mirroring transform of ours leaves outside.
    let outside = |obj: &str, flat: bool, x: f64| {
        let text = format!(
            "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"obj\"><string name=\"filename\" value=\"m.obj\"/>\
             <boolean name=\"face_normals\" value=\"{flat}\"/>\
             <transform name=\"to_world\"><scale x=\"{x}\"/></transform></shape></scene>"
        );
        let scene = try_files(&[("a.xml", &text), ("m.obj", obj)], &[]).expect("readable");
        let mesh = &scene.meshes[0];
        let [a, b, c] = mesh.triangles[0].map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).z.signum()
    };
    for (obj, flat, x, expected) in [
        (bare, false, 1.0, 1.0),
        (bare, false, -1.0, -1.0),
        (bare, true, -1.0, -1.0),
        (with, false, -1.0, 1.0),
        (with, true, -1.0, -1.0),
    ] {
        assert_eq!(outside(obj, flat, x), expected, "{obj:?} flat {flat} scaled by {x}");
    }
}

#[test]
fn factors_of_glass_may_be_colours_and_textures() {
    let tinted = material(
        "<bsdf type=\"dielectric\"><rgb name=\"specular_reflectance\" value=\"0.5\"/>\
         <rgb name=\"specular_transmittance\" value=\"0.2 0.4 0.6\"/></bsdf>",
    );
    assert_eq!((tinted.color, tinted.specular_color), (Rgb::splat(0.5), Rgb::new(0.2, 0.4, 0.6)));
    let board = "<texture type=\"checkerboard\" name=\"specular_transmittance\"/>";
    let varied = material(&format!("<bsdf type=\"thindielectric\">{board}</bsdf>"));
    assert_eq!(varied.textures[0].parameter, Parameter::SpecularColor);
    let metal = material(&format!("<bsdf type=\"conductor\">{}</bsdf>", board.replace("transmittance", "reflectance")));
    assert_eq!((metal.textures[0].parameter, metal.specular_color), (Parameter::SpecularColor, Rgb::ONE));
}

#[test]
fn two_bsdfs_of_a_twosided_are_its_front_and_its_back() {
    let scene = read(
        "<sensor type=\"perspective\"/><shape type=\"rectangle\"><bsdf type=\"twosided\">\
         <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.25\"/></bsdf><bsdf type=\"conductor\"/></bsdf></shape>",
    );
    let of = |id: MaterialId| &scene.materials[id.0 as usize];
    let Model::Sides { front, back } = of(scene.objects[0].material.expect("a material")).model else {
        panic!("{scene:?}")
    };
    assert_eq!((of(front).color, of(front).two_sided), (Rgb::splat(0.25), true));
    assert!(matches!(of(back).model, Model::Conductor { .. }));
}

#[test]
fn every_number_of_a_principled_surface_may_be_a_texture() {
    let names = [
        ("roughness", Parameter::Roughness),
        ("anisotropic", Parameter::Anisotropic),
        ("metallic", Parameter::Metallic),
        ("spec_trans", Parameter::SpecTrans),
        ("spec_tint", Parameter::SpecTint),
        ("sheen", Parameter::Sheen),
        ("sheen_tint", Parameter::SheenTint),
        ("flatness", Parameter::Flatness),
        ("clearcoat", Parameter::Clearcoat),
        ("clearcoat_gloss", Parameter::ClearcoatGloss),
    ];
    let boards = names.map(|(name, _)| format!("<texture type=\"checkerboard\" name=\"{name}\"/>"));
    let paint = material(&format!("<bsdf type=\"principled\">{}</bsdf>", boards.concat()));
    let bound: Vec<_> = paint.textures.iter().map(|binding| (binding.parameter, binding.channel)).collect();
    assert_eq!(bound.len(), names.len());
    for (name, parameter) in names {
        assert!(bound.contains(&(parameter, Channel::R)), "{name}");
    }
    let Model::Principled(Principled { eta, .. }) = paint.model else { panic!("{paint:?}") };
    let one = Principled {
        roughness: 1.0,
        anisotropic: 1.0,
        metallic: 1.0,
        spec_trans: 1.0,
        eta,
        spec_tint: 1.0,
        sheen: 1.0,
        sheen_tint: 1.0,
        flatness: 1.0,
        clearcoat: 1.0,
        clearcoat_gloss: 1.0,
    };
    assert_eq!(paint.model, Model::Principled(one), "what the texels are times");
}

#[test]
fn a_textured_lamp_shines_as_its_texture() {
    let lamp = material("<emitter type=\"area\"><texture type=\"checkerboard\" name=\"radiance\"/></emitter>");
    assert_eq!((lamp.emission, lamp.textures[0].parameter), (Rgb::ONE, Parameter::Emission));
}

#[test]
fn tabulated_and_black_body_spectra_are_those_of_the_plain_ones() {
    let color = |spectrum: &str| {
        let light = format!("<emitter type=\"point\">{spectrum}</emitter>");
        read(&format!("{LEAST}{light}")).lights.swap_remove(0).intensity
    };
    let plain = color("<spectrum name=\"intensity\" value=\"400:1, 500:3, 600:2\"/>");
    let regular = color(
        "<spectrum name=\"intensity\" type=\"regular\"><float name=\"wavelength_min\" value=\"400\"/>\
         <float name=\"wavelength_max\" value=\"600\"/><string name=\"values\" value=\"1, 3, 2\"/></spectrum>",
    );
    let irregular = color(
        "<spectrum name=\"intensity\" type=\"irregular\"><string name=\"wavelengths\" value=\"400, 500, 600\"/>\
         <string name=\"values\" value=\"1, 3, 2\"/></spectrum>",
    );
    assert_eq!((regular, irregular), (plain, plain));
    let glow = |kelvin: f64| {
        color(&format!(
            "<spectrum name=\"intensity\" type=\"blackbody\"><float name=\"temperature\" value=\"{kelvin}\"/></spectrum>"
        ))
    };
    // A candle is red, the sky is blue, and 6500 K is nearly white.
    let (candle, white, sky) = (glow(1900.0), glow(6504.0), glow(15_000.0));
    assert!(candle.x > 4.0 * candle.z && sky.z > 1.4 * sky.x, "{candle} {sky}");
    assert!((white.x / white.z - 1.0).abs() < 0.1 && (white.y / white.z - 1.0).abs() < 0.1, "{white}");
    for (spectrum, expected) in [
        (
            "<spectrum name=\"intensity\" type=\"irregular\"><string name=\"wavelengths\" value=\"400, 500\"/><string name=\"values\" value=\"1\"/></spectrum>",
            "2 wavelengths have 1 values",
        ),
        (
            "<spectrum name=\"intensity\" type=\"regular\"><string name=\"values\" value=\"1, x\"/></spectrum>",
            "found \"x\"",
        ),
        (
            "<spectrum name=\"intensity\" type=\"regular\"><string name=\"values\" value=\"1, 2\"/></spectrum>",
            "needs \"wavelength_min\"",
        ),
        ("<spectrum name=\"intensity\" type=\"blackbody\"/>", "needs \"temperature\""),
    ] {
        let error = try_read(&format!("{LEAST}<emitter type=\"point\">{spectrum}</emitter>")).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

/// Light of a scene's only lamp at a point: what `eval` is multiplied by.
fn radiance(scene: &Scene, position: Vec3) -> Vec3 {
    let data = bake(scene).expect("bakes");
    let lit = gonio::shading::light::sample_light(&data.lights[0], position);
    let through = gonio::shading::slide::slide_factor(&data.view(), &data.lights[0], lit.wi);
    (lit.radiance * through).truncate()
}

#[test]
fn a_spot_falls_off_linearly_in_its_angle() {
    let scene = read(&format!(
        "{LEAST}<emitter type=\"spot\"><float name=\"cutoff_angle\" value=\"40\"/><float name=\"beam_width\" value=\"20\"/></emitter>"
    ));
    // It shines along +z; at distance 2, a quarter of its intensity.
    for (degrees, expected) in
        [(0.0f64, 0.25), (19.9, 0.25), (25.0, 0.1875), (30.0, 0.125), (39.0, 0.0125), (40.1, 0.0)]
    {
        let angle = degrees.to_radians();
        let found = radiance(&scene, DVec3::new(2.0 * angle.sin(), 0.0, 2.0 * angle.cos()).as_vec3());
        assert!((f64::from(found.x) - expected).abs() < 1e-5, "{degrees}: {found}");
    }
}

/// The quadrants of a picture of two by two texels with red its upper left, green upper right, blue lower left.
fn quadrants(folder: &Path) {
    let mut picture = image::RgbImage::new(2, 2);
    picture.put_pixel(0, 0, image::Rgb([255, 0, 0]));
    picture.put_pixel(1, 0, image::Rgb([0, 255, 0]));
    picture.put_pixel(0, 1, image::Rgb([0, 0, 255]));
    picture.save(folder.join("q.png")).expect("writable");
}

fn lamp_with_quadrants(kind: &str, texture: &str, inner: &str) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    quadrants(folder.path());
    let text = format!(
        "<scene version=\"3.0.0\">{LEAST}<emitter type=\"{kind}\"><texture type=\"bitmap\" name=\"{texture}\">\
         <string name=\"filename\" value=\"q.png\"/><string name=\"filter_type\" value=\"nearest\"/></texture>{inner}</emitter></scene>"
    );
    std::fs::write(folder.path().join("a.xml"), text).expect("writable");
    load(&folder.path().join("a.xml"), &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_projector_lights_a_plane_across_evenly_and_throws_its_picture_upright() {
    let scene = lamp_with_quadrants(
        "projector",
        "irradiance",
        "<float name=\"fov\" value=\"90\"/><float name=\"scale\" value=\"2\"/>",
    );
    // It looks along +z with y up, so +x is to its left: where a camera there would see the picture's left half.
    for (x, y, color) in [(0.5, 0.5, Vec3::X), (-0.5, 0.5, Vec3::Y), (0.9, -0.9, Vec3::Z), (0.1, 0.1, Vec3::X)] {
        let position = Vec3::new(x, y, 1.0);
        // Irradiance of a plane at z = 1: radiance times the cosine there.
        let irradiance = radiance(&scene, position) / position.length();
        let expected = color * (2.0 * std::f32::consts::PI);
        assert!((irradiance - expected).length() < 1e-5, "{x} {y}: {irradiance}");
    }
    for beyond in [Vec3::new(1.01, 0.0, 1.0), Vec3::new(0.0, -1.01, 1.0), Vec3::new(0.0, 0.0, -1.0)] {
        assert_eq!(radiance(&scene, beyond), Vec3::ZERO, "{beyond}");
    }
    // Farther away as the square of the distance.
    let far = radiance(&scene, Vec3::new(1.0, 1.0, 2.0)) / 1.5f32.sqrt();
    assert!((far.x - 0.5 * std::f32::consts::PI).abs() < 1e-5, "{far}");
}

#[test]
fn the_picture_of_a_spot_fills_its_cone() {
    let scene = lamp_with_quadrants(
        "spot",
        "texture",
        "<float name=\"cutoff_angle\" value=\"45\"/><float name=\"beam_width\" value=\"45\"/>",
    );
    // u grows along +x and v, from the picture's top, along +y.
    for (x, y, color) in [(-0.4, -0.4, Vec3::X), (0.4, -0.4, Vec3::Y), (-0.4, 0.4, Vec3::Z), (0.4, 0.4, Vec3::ZERO)] {
        let found = radiance(&scene, Vec3::new(x, y, 1.0)) * (1.0 + x * x + y * y);
        assert!((found - color).length() < 1e-5, "{x} {y}: {found}");
    }
}

#[test]
fn filters_with_parameters_take_them() {
    let filter = |inner: &str| {
        read(&format!(
            "<sensor type=\"perspective\"><film type=\"hdrfilm\">{inner}</film></sensor><shape type=\"sphere\"/>"
        ))
        .film
        .filter
    };
    assert_eq!(filter("<rfilter type=\"lanczos\"/>"), Filter::Lanczos { radius: 3.0 });
    assert_eq!(
        filter("<rfilter type=\"lanczos\"><integer name=\"lobes\" value=\"2\"/></rfilter>"),
        Filter::Lanczos { radius: 2.0 }
    );
    assert_eq!(
        filter("<rfilter type=\"box\"><float name=\"radius\" value=\"1\"/></rfilter>"),
        Filter::Box { radius: 1.0 }
    );
    assert_eq!(filter("<rfilter type=\"catmullrom\"/>"), Filter::Mitchell { radius: 2.0, b: 0.0, c: 0.5 });
}

/// As exporters wrote them for Mitsuba 0.6.
const OLD: &str = r#"<scene version="0.6.0">
    <default name="maxDepth" value="5"/>
    <integrator type="path"><integer name="maxDepth" value="$maxDepth"/><boolean name="strictNormals" value="true"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="35"/>
        <string name="fovAxis" value="y"/>
        <transform name="toWorld"><lookAt origin="0, 1, 5" target="0, 1, 0" up="0, 1, 0"/></transform>
        <sampler type="ldsampler"><integer name="sampleCount" value="32"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="20"/><integer name="height" value="10"/>
            <boolean name="banner" value="false"/>
            <rfilter type="gaussian"/>
        </film>
    </sensor>
    <shape type="sphere">
        <transform name="toWorld"><translate y="1"/></transform>
        <boolean name="flipNormals" value="false"/>
        <bsdf type="roughplastic">
            <texture type="bitmap" name="diffuseReflectance">
                <string name="filename" value="textures/wood.png"/>
                <float name="uscale" value="4"/><float name="voffset" value="0.25"/>
            </texture>
            <float name="intIOR" value="1.9"/><float name="extIOR" value="1"/>
        </bsdf>
    </shape>
    <shape type="cube"><bsdf type="diffuse"><rgb name="diffuseReflectance" value="0.3"/></bsdf></shape>
</scene>"#;

#[test]
fn scenes_of_old_versions_are_read_as_mitsuba_3_upgrades_them() {
    let folder = published();
    std::fs::write(folder.path().join("old.xml"), OLD).expect("writable");
    let scene = load(&folder.path().join("old.xml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scene.settings.max_depth, scene.settings.samples), (4, 32));
    assert!(
        matches!(scene.camera.projection, Projection::Perspective { fov_y } if (fov_y - 35f32.to_radians()).abs() < 1e-6)
    );
    assert_eq!(scene.camera.eye, Vec3::new(0.0, 1.0, 5.0));
    let of = |index: usize| &scene.materials[scene.objects[index].material.expect("a material").0 as usize];
    assert!(matches!(of(0).model, Model::RoughPlastic { eta: 1.9, .. }), "{:?}", of(0));
    assert_eq!(of(1).color, Rgb::splat(0.3));
    // u' = 4 u and v' = v + .25 from the top; v = 1 - v here.
    let texture = &scene.textures[of(0).textures[0].texture.0 as usize];
    assert_eq!((texture.scale, texture.offset), ([4.0, 1.0], [0.0, -0.25]));
    // The same names in a scene of today are errors.
    let error = try_files(&[("a.xml", &OLD.replace("0.6.0", "3.0.0"))], &[]).unwrap_err().to_string();
    assert!(error.contains("has no property \"maxDepth\"") && error.contains("did you mean \"max_depth\"?"), "{error}");
}
