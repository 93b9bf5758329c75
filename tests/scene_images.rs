//! What becomes of the images that scenes name: files that are not there, values that are out of range, Mitsuba's own reading.

use gonio::film::Image;
use gonio::film::write::write_linear;
use gonio::scene::load::load;
use gonio::scene::*;
use std::path::PathBuf;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn file(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("writable");
    }

    /// An EXR of one row of greys.
    fn exr(&self, name: &str, values: &[f32]) {
        let pixels = values.iter().map(|v| [*v, *v, *v, 1.0]).collect();
        let mut bytes = Vec::new();
        write_linear(&Image { width: values.len() as u32, height: 1, pixels }, &mut bytes).expect("written");
        self.file(name, bytes);
    }

    /// The folder cut from a message.
    fn bare(&self, text: &str) -> String {
        text.replace(&format!("{}/", self.0.path().display()), "")
    }

    fn try_load(&self, name: &str, text: &str) -> Result<Scene, String> {
        self.file(name, text);
        load(&self.path(name), &[]).map_err(|error| self.bare(&error.to_string()))
    }

    #[track_caller]
    fn load(&self, name: &str, text: &str) -> Scene {
        self.try_load(name, text).unwrap_or_else(|error| panic!("{error}"))
    }

    fn warnings(&self, scene: &Scene) -> Vec<String> {
        scene.warnings.iter().map(|warning| self.bare(warning)).collect()
    }
}

const TOML: &str = "[camera]\neye = [0, 0, 5]\n[[light]]\ntype = \"directional\"\ndirection = [0, 0, -1]\n[[object]]\n\
                    shape = \"sphere\"\nmaterial = \"m\"\n[[material]]\nname = \"m\"\n";
const GONE: &str = "No such file or directory (os error 2)";

/// A triangle with one material, whose textures are those of `images`.
fn gltf(material: &str, images: &str, buffers: &str) -> String {
    let triangle = "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA";
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0, 1]}}], "nodes": [{{"mesh": 0}}, {{"mesh": 1}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1, "material": 0}}]}},
        {{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "materials": [{material}], "textures": [{{"source": 0}}], "images": [{images}],
        "buffers": [{{"byteLength": 42, "uri": "{triangle}"}}{buffers}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 6}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}},
        {{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}}]}}"#
    )
}

fn mitsuba(elements: &str) -> String {
    format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/><emitter type=\"point\"/>\n{elements}</scene>\n")
}

fn bitmap(property: &str, file: &str) -> String {
    format!("<texture name=\"{property}\" type=\"bitmap\"><string name=\"filename\" value=\"{file}\"/></texture>")
}

#[test]
fn a_toml_scene_goes_on_without_textures_that_are_not_there() {
    let folder = Folder::new();
    let scene = folder.load(
        "a.toml",
        &format!(
            "{TOML}color = [0.5, 0.25, 0.125]\ntexture = \"no.png\"\nnormal_map = {{ file = \"no.exr\", strength = 2 }}\n\
             emission_texture = \"no.png\"\nopacity_texture = \"deep/no.png\"\n"
        ),
    );
    let material = &scene.materials[0];
    assert_eq!((material.color, material.emission), (Rgb::new(0.5, 0.25, 0.125), Rgb::ZERO));
    assert!(material.textures.is_empty() && scene.textures.is_empty());
    let expected = [
        format!("a.toml:12:11: no texture: no.png: {GONE}"),
        format!("a.toml:14:20: no texture: no.png: {GONE}"),
        format!("a.toml:15:19: no texture: deep/no.png: {GONE}"),
        format!("a.toml:13:23: no texture: no.exr: {GONE}"),
    ];
    assert_eq!(folder.warnings(&scene), expected);
}

#[test]
fn what_no_factor_was_given_for_is_as_if_the_key_had_not_been_written() {
    let folder = Folder::new();
    let of = |keys: &str| folder.load("a.toml", &format!("{TOML}{keys}")).materials[0].clone();
    assert_eq!(of("texture = \"no.png\"\n"), of(""));
    let principled = "model = \"principled\"\n";
    assert_eq!(of(&format!("{principled}metallic_texture = \"no.png\"\nsheen_texture = \"no.png\"\n")), of(principled));
    let blend = "materials = [\"m\", \"m\"]\nmodel = \"blend\"\n";
    assert_eq!(of(&format!("{blend}weight_texture = \"no.png\"\n")), of(blend));
}

#[test]
fn a_sky_that_is_not_there_is_as_bright_as_its_scale() {
    let folder = Folder::new();
    let scene = folder.load("a.toml", &format!("{TOML}[background]\nimage = \"no.hdr\"\nscale = [1, 2, 3]\n"));
    let Background::Image(environment) = scene.background else { panic!("{:?}", scene.background) };
    assert_eq!(environment.scale, Rgb::new(1.0, 2.0, 3.0));
    let texture = &scene.textures[environment.texture.0 as usize];
    assert!(matches!(&texture.data, TextureData::Float(texels) if texels[..] == [[1.0; 4]]));
    assert_eq!(folder.warnings(&scene), [format!("a.toml:12:9: no texture: no.hdr: {GONE}")]);
    let sky = "<emitter type=\"envmap\"><string name=\"filename\" value=\"no.exr\"/><float name=\"scale\" value=\"2\"/></emitter>";
    let scene = folder.load("a.xml", &mitsuba(&format!("<shape type=\"sphere\"/>{sky}")));
    assert_eq!(scene.background, Background::flat(Rgb::splat(2.0)));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
}

#[test]
fn all_faults_of_a_toml_scene_are_told_at_once_files_included() {
    let folder = Folder::new();
    folder.file("broken.png", "no picture");
    let text = format!(
        "{TOML}texture = \"broken.png\"\nnormal_map = \"broken.png\"\nspecular_color = 7\n[[object]]\nshape = \"mesh\"\n\
         file = \"no.obj\"\n[[object]]\nshape = \"mesh\"\nfile = \"no.ply\"\n[background]\nimage = \"broken.png\"\n"
    );
    let error = folder.try_load("a.toml", &text).unwrap_err();
    for expected in [
        "broken.png: not a picture",
        "a.toml:13:18: \"specular_color\" must be",
        "a.toml:16:8: no.obj: ",
        "a.toml:19:8: no.ply: ",
    ] {
        assert!(error.contains(expected), "{expected} is not in\n{error}");
    }
}

#[test]
fn a_gltf_goes_on_without_images_that_are_not_there() {
    let folder = Folder::new();
    let material = r#"{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0.25,
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}}, "normalTexture": {"index": 0},
        "emissiveTexture": {"index": 0}, "emissiveFactor": [0, 1, 0], "alphaMode": "BLEND"}"#;
    let scene = folder.load("a.gltf", &gltf(material, r#"{"uri": "no%20pic.png"}"#, ""));
    let material = &scene.materials[0];
    assert_eq!((material.color, material.emission), (Rgb::new(0.5, 0.25, 1.0), Rgb::Y));
    assert!(material.textures.is_empty(), "{:?}", material.textures);
    assert!(matches!(material.model, Model::Principled(Principled { metallic: 0.25, .. })), "{:?}", material.model);
    let told = folder.warnings(&scene);
    let expected = format!("a.gltf: images[0]: no texture: no pic.png: {GONE}");
    assert_eq!(told.iter().filter(|warning| warning.contains("no texture")).collect::<Vec<_>>(), [&expected]);
}

#[test]
fn all_faults_of_a_gltf_are_told_at_once() {
    let folder = Folder::new();
    let buffers = r#", {"byteLength": 1, "uri": "no1.bin"}, {"byteLength": 1, "uri": "no2.bin"}"#;
    let error = folder.try_load("a.gltf", &gltf("{}", "", buffers)).unwrap_err();
    assert!(error.contains("no1.bin") && error.contains("no2.bin"), "{error}");
    let text = gltf(r#"{"normalTexture": {"index": 0}}"#, r#"{"uri": "data:,x"}"#, "");
    let text = text.replace(r#""POSITION": 0}, "indices": 1}]"#, r#""POSITION": 7}, "indices": 1}]"#);
    let error = folder.try_load("a.gltf", &text).unwrap_err();
    assert!(error.contains("images[0]: not a picture") && error.contains("refers to accessor 7"), "{error}");
}

#[test]
fn a_mitsuba_scene_goes_on_without_bitmaps_that_are_not_there() {
    let folder = Folder::new();
    let of = |bsdf: &str| {
        let scene = folder.load("a.xml", &mitsuba(&format!("<shape type=\"sphere\">{bsdf}</shape>")));
        let id = scene.objects[0].material.expect("a material");
        (scene.materials[id.0 as usize].clone(), folder.warnings(&scene))
    };
    let whole = |kind: &str, inner: &str| format!("<bsdf type=\"{kind}\">{inner}</bsdf>");
    let (found, warnings) = of(&whole("diffuse", &bitmap("reflectance", "no.png")));
    assert_eq!(found, of(&whole("diffuse", "")).0);
    let missing = "no texture: no file \"no.png\" beside the scene or in a <path> of it";
    assert_eq!(warnings, [format!("a.xml:2:85: {missing}")]);
    let alpha = whole("roughconductor", &bitmap("alpha", "no.png"));
    assert_eq!(of(&alpha).0, of(&whole("roughconductor", "")).0);
    for map in [
        whole("normalmap", &(bitmap("normalmap", "no.png") + "<bsdf type=\"diffuse\"/>")),
        whole("bumpmap", &(bitmap("", "no.png") + "<bsdf type=\"diffuse\"/>")),
    ] {
        assert_eq!(of(&map).0.textures, []);
    }
    let lamp = format!("<emitter type=\"area\">{}</emitter>", bitmap("radiance", "no.exr"));
    assert_eq!(of(&lamp).0.emission, Rgb::ONE);
}

#[test]
fn all_faults_of_a_mitsuba_scene_are_told_at_once() {
    let folder = Folder::new();
    let text = mitsuba(
        "<bsdf type=\"difuse\" id=\"a\"/>\n<shape type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></shape>\n\
         <shape type=\"sphere\"><ref id=\"a\"/></shape>\n<shape type=\"sphere\"><float name=\"radius\" value=\"-1\"/></shape>\n",
    );
    let error = folder.try_load("a.xml", &text).unwrap_err();
    let lines: Vec<&str> = error.lines().collect();
    assert_eq!(lines.len(), 3, "{error}");
    assert!(lines[0].starts_with("a.xml:2:13: the bsdf \"difuse\" is not supported"), "{error}");
    assert!(lines[1].starts_with("a.xml:3:") && lines[1].contains("no file \"no.obj\""), "{error}");
    assert!(lines[2].starts_with("a.xml:5:22: \"radius\" must be"), "{error}");
}

/// The reds of the texture that a material binds to a parameter.
#[track_caller]
fn bound(scene: &Scene, material: usize, parameter: Parameter) -> Vec<f32> {
    let id = scene.materials[material].texture(parameter).expect("bound");
    match &scene.textures[id.0 as usize].data {
        TextureData::Float(texels) => texels.iter().map(|texel| texel[0]).collect(),
        data => panic!("{data:?}"),
    }
}

#[test]
fn float_images_keep_the_range_of_what_they_are_bound_to_in_every_format() {
    let folder = Folder::new();
    folder.exr("neg.exr", &[-1.0, 2.0, 0.5, f32::NAN]);
    let reflectance = "neg.exr: 3 of 4 texels clamped: a reflectance is 0 to 1 (1 below 0, 1 above 1, 1 not a number)";
    let light = "neg.exr: 2 of 4 texels clamped: light is 0 or more (1 below 0, 1 not a number)";
    let (as_reflectance, as_light) = (vec![0.0, 1.0, 0.5, 0.0], vec![0.0, 2.0, 0.5, 0.0]);

    let scene = folder.load("a.toml", &format!("{TOML}texture = \"neg.exr\"\nemission_texture = \"neg.exr\"\n"));
    assert_eq!(bound(&scene, 0, Parameter::Color), as_reflectance);
    assert_eq!(bound(&scene, 0, Parameter::Emission), as_light);
    assert_eq!(folder.warnings(&scene), [reflectance, light]);
    let scene = folder.load("a.toml", &format!("{TOML}model = \"emissive\"\ntexture = \"neg.exr\"\n"));
    assert_eq!(
        (bound(&scene, 0, Parameter::Color), folder.warnings(&scene)),
        (as_light.clone(), vec![light.to_owned()])
    );
    let scene = folder.load("a.toml", &format!("{TOML}[background]\nimage = \"neg.exr\"\n"));
    assert_eq!(folder.warnings(&scene), [light]);
    // A file with no number in it is one texture, however many ask for it.
    let two = format!("{TOML}texture = \"neg.exr\"\n[[material]]\nname = \"n\"\ntexture = \"neg.exr\"\n");
    assert_eq!(folder.load("a.toml", &two).textures.len(), 1);
    // Heights may be anything that is a number.
    let scene = folder.load("a.toml", &format!("{TOML}bump_map = \"neg.exr\"\n"));
    assert_eq!(bound(&scene, 0, Parameter::Bump), [-1.0, 2.0, 0.5, 0.0]);

    let material = r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1]}"#;
    let scene = folder.load("a.gltf", &gltf(material, r#"{"uri": "neg.exr"}"#, ""));
    assert_eq!(bound(&scene, 0, Parameter::Color), as_reflectance);
    assert_eq!(bound(&scene, 0, Parameter::Emission), as_light);

    let lamp = format!("<emitter type=\"area\">{}</emitter>", bitmap("radiance", "neg.exr"));
    let wall = format!("<bsdf type=\"diffuse\">{}</bsdf>", bitmap("reflectance", "neg.exr"));
    let scene = folder.load("a.xml", &mitsuba(&format!("<shape type=\"sphere\">{wall}{lamp}</shape>")));
    let last = scene.materials.len() - 1;
    assert_eq!(bound(&scene, last, Parameter::Color), as_reflectance);
    assert_eq!(bound(&scene, last, Parameter::Emission), as_light);
    assert_eq!(folder.warnings(&scene), [reflectance, light]);

    folder.file("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    folder.file("a.mtl", "newmtl m\nmap_Kd neg.exr\n");
    let scene = load(&folder.path("a.obj"), &[]).expect("a scene");
    assert_eq!(bound(&scene, 0, Parameter::Color), as_reflectance);
    assert!(folder.warnings(&scene).contains(&reflectance.to_owned()), "{:?}", scene.warnings);
}

#[test]
fn images_in_range_are_not_touched_and_not_mentioned() {
    let folder = Folder::new();
    folder.exr("good.exr", &[0.0, 1.0, 0.5]);
    folder.exr("bright.exr", &[0.0, 60_000.0, 0.5]);
    let scene = folder.load(
        "a.toml",
        &format!("{TOML}texture = \"good.exr\"\nemission_texture = \"bright.exr\"\nspecular_texture = \"good.exr\"\n"),
    );
    assert_eq!(bound(&scene, 0, Parameter::Color), [0.0, 1.0, 0.5]);
    assert_eq!(bound(&scene, 0, Parameter::Emission), [0.0, 60_000.0, 0.5]);
    assert_eq!((scene.warnings, scene.textures.len()), (Vec::<String>::new(), 2));
}

#[test]
fn mitsuba_scenes_read_light_as_mitsuba_does_and_others_as_the_formats_say() {
    let folder = Folder::new();
    let mut hdr = b"#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n".to_vec();
    hdr.extend(gonio::film::write::rgbe([1.0; 3]));
    folder.file("a.hdr", hdr);
    let scene = folder.load("a.toml", &format!("{TOML}texture = \"a.hdr\"\n"));
    assert_eq!(bound(&scene, 0, Parameter::Color), [0.5]);
    let wall = format!("<bsdf type=\"diffuse\">{}</bsdf>", bitmap("reflectance", "a.hdr"));
    let scene = folder.load("a.xml", &mitsuba(&format!("<shape type=\"sphere\">{wall}</shape>")));
    assert_eq!(bound(&scene, 0, Parameter::Color), [1.0]);
}

#[test]
fn a_raw_constant_is_a_number_or_three() {
    let folder = Folder::new();
    let of = |value: &str, property: &str, kind: &str| {
        let texture = format!("<texture name=\"{property}\" type=\"rawconstant\">{value}</texture>");
        let scene = folder.try_load(
            "a.xml",
            &mitsuba(&format!("<shape type=\"sphere\"><bsdf type=\"{kind}\">{texture}</bsdf></shape>")),
        )?;
        let id = scene.objects[0].material.expect("a material");
        let binding = scene.materials[id.0 as usize].textures[0];
        match &scene.textures[binding.texture.0 as usize].data {
            TextureData::Float(texels) => Ok::<_, String>((texels[0], folder.warnings(&scene))),
            data => panic!("{data:?}"),
        }
    };
    let diffuse = |value: &str| of(value, "reflectance", "diffuse");
    assert_eq!(diffuse("<float name=\"value\" value=\"0.25\"/>"), Ok(([0.25, 0.25, 0.25, 1.0], vec![])));
    let vector = "<vector name=\"value\" value=\"0.125, 0.25, 0.5\"/>";
    assert_eq!(diffuse(vector), Ok(([0.125, 0.25, 0.5, 1.0], vec![])));
    assert_eq!(of("<float name=\"value\" value=\"0.25\"/>", "alpha", "roughconductor").unwrap().0[0], 0.25);
    let told = "rawconstant: 1 of 1 texel clamped: a reflectance is 0 to 1 (1 above 1)";
    assert_eq!(diffuse("<float name=\"value\" value=\"3\"/>"), Ok(([1.0; 4], vec![told.to_owned()])));
    assert!(diffuse("").unwrap_err().contains("the texture \"rawconstant\" needs \"value\""));
    let rgb = diffuse("<rgb name=\"value\" value=\"1\"/>").unwrap_err();
    assert!(rgb.contains("\"value\" is a number or three, found <rgb>"), "{rgb}");
}

#[test]
fn plugins_that_gonio_cannot_show_say_why() {
    let folder = Folder::new();
    for (element, expected) in [
        (
            "<bsdf type=\"principledthin\"/>",
            "a.xml:2:13: the bsdf \"principledthin\" is not supported: gonio has no thin",
        ),
        ("<shape type=\"sdfgrid\"/>", "a.xml:2:14: the shape \"sdfgrid\" is not supported: gonio traces triangles"),
    ] {
        let error = folder.try_load("a.xml", &mitsuba(element)).unwrap_err();
        assert!(error.starts_with(expected), "{error}");
    }
}

#[test]
fn white_reflectances_are_white_and_greys_are_grey() {
    let folder = Folder::new();
    let of = |value: &str| {
        let wall = format!("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"{value}\"/></bsdf>");
        let scene = folder.load("a.xml", &mitsuba(&format!("<shape type=\"sphere\">{wall}</shape>")));
        scene.materials[0].color
    };
    // Mitsuba 3.9.1, scalar_rgb.
    for (value, expected) in [
        ("360:1, 830:1", [1.0, 1.0, 1.0]),
        ("360:0.5, 830:0.5", [0.5, 0.5, 0.5]),
        ("400:0.1, 500:0.6, 600:0.9, 700:0.2", [0.8069, 0.7523, 0.3201]),
    ] {
        let error = (of(value) - Rgb::from_array(expected)).abs().max_element();
        assert!(error < 2e-3, "{value}: {}", of(value));
    }
}
