//! glTF: what of it becomes what of ours.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use glam::{DVec3, Vec2, Vec3};
use gonio::scene::load::{Controls, gltf, load, staging};
use gonio::scene::{
    Channel, Geometry, Material, Model, Parameter, Scene, SceneError, TextureBinding, TextureData, Transparency, Wrap,
};
use std::path::{Path, PathBuf};

/// Positions finite, indices valid, arrays of equal length, normals unit.
fn check_scene(scene: &Scene) {
    for mesh in &scene.meshes {
        let n = mesh.positions.len();
        assert!(mesh.positions.iter().all(|p| p.is_finite()));
        assert!(mesh.triangles.iter().flatten().all(|i| (*i as usize) < n) && !mesh.triangles.is_empty());
        assert!([0, n].contains(&mesh.normals.len()) && [0, n].contains(&mesh.uvs.len()));
        assert!([0, n].contains(&mesh.colors.len()));
        assert!(mesh.normals.iter().all(|v| (v.length() - 1.0).abs() < 1e-5));
    }
    for object in &scene.objects {
        let Geometry::Mesh(id) = object.geometry else { panic!("no spheres in files") };
        assert!((id.0 as usize) < scene.meshes.len() && object.transform.determinant() != 0.0);
        assert!((object.material.expect("a material").0 as usize) < scene.materials.len());
    }
    for material in &scene.materials {
        assert!(material.textures.iter().all(|t| (t.texture.0 as usize) < scene.textures.len()));
        assert!(material.color.is_finite() && material.emission.is_finite() && material.k_r >= 0.0);
        if let Model::CookTorrance { .. } = material.model {
            assert_eq!(material.k_d + material.k_s, 1.0);
        }
    }
    for texture in &scene.textures {
        let texels = match &texture.data {
            TextureData::Srgb8(t) | TextureData::Linear8(t) => t.len(),
            TextureData::Float(t) => t.len(),
            TextureData::Pattern(_) => panic!("a file holds no pattern"),
        };
        assert_eq!(texels as u64, u64::from(texture.width) * u64::from(texture.height));
    }
}

fn gltf_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            gltf_files(&path, found);
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            found.push(path);
        }
    }
}

#[test]
fn every_gltf_of_the_assets_loads() {
    for name in ["gltf", "gltf-scenes", "cornell/gltf-referencePT"] {
        let Some(folder) = asset(name) else { return };
        let mut files = Vec::new();
        gltf_files(&folder, &mut files);
        files.sort();
        assert!(!files.is_empty());
        for file in files {
            let scene = load(&file, &[]).unwrap_or_else(|e| panic!("{e}"));
            check_scene(&scene);
            let is_lit = !scene.lights.is_empty()
                || scene.background.shines()
                || scene.notes.iter().any(|n| n.contains("glows"));
            assert!(scene.camera.eye != scene.camera.target && is_lit, "staged: {}", scene.name);
            println!("{}: {} objects, {:?}", scene.name, scene.objects.len(), scene.warnings);
        }
    }
}

#[test]
fn known_gltf_files_have_what_their_names_say() {
    let Some(folder) = asset("gltf") else { return };
    let load = |name: &str| load(&folder.join(name), &[]).unwrap_or_else(|e| panic!("{e}"));
    let triangles = |scene: &Scene| -> usize {
        let of = |g: Geometry| {
            if let Geometry::Mesh(id) = g { scene.meshes[id.0 as usize].triangles.len() } else { 0 }
        };
        scene.objects.iter().filter(|o| o.name != "ground").map(|o| of(o.geometry)).sum()
    };
    assert_eq!(triangles(&load("Duck.glb")), 4_212);
    assert_eq!(triangles(&load("Box.glb")), 12);
    assert_eq!(triangles(&load("24_gpu_instancing/24_gpu_instancing.gltf")), 7_656_770, "1,899 teapots and a plane");
    let shared = load("02_shared_mesh/02_shared_mesh.gltf");
    assert!(shared.objects.len() > shared.meshes.len(), "nodes that share a mesh are instances");
    let unlit = load("01_unlit/01_unlit.gltf");
    assert!(unlit.materials.iter().any(|m| m.model == Model::Emissive));
    let blend = load("01_alpha_blend/01_alpha_blend.gltf");
    let fades = |m: &Material| m.textures.iter().any(|binding| binding.parameter == Parameter::Opacity);
    assert!(blend.materials.iter().any(fades), "its texture's alpha is kept");
    let transmission = load("17_ior/17_ior.gltf");
    assert!(transmission.materials.iter().any(|m| m.transparency.is_some()));
    let wrapping = load("13_texture_wrapping/13_texture_wrapping.gltf");
    let wraps: Vec<Wrap> = wrapping.textures.iter().flat_map(|t| [t.wrap_u, t.wrap_v]).collect();
    assert!(wraps.contains(&Wrap::Clamp) || wraps.contains(&Wrap::Mirror), "{wraps:?}");
    let colored = load("22_vertex_color/22_vertex_color.gltf");
    assert!(colored.meshes.iter().any(|m| !m.colors.is_empty()));
    let pointer = load("24_animation_pointer/24_animation_pointer.gltf");
    assert!(pointer.lights.iter().all(|l| l.name != "key"), "its own lights are kept");
}

#[test]
fn default_morph_weights_move_vertices() {
    let Some(file) = asset("gltf/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf") else {
        return;
    };
    let scene = gltf::load(&file).expect("a valid file");
    let text = std::fs::read_to_string(&file).expect("text");
    let still = gltf::scene_from_bytes(text.replace("0.5", "0.0").as_bytes(), &file).expect("a valid file");
    assert_ne!(scene.meshes[0].positions, still.meshes[0].positions);
}

/// A triangle in z = 0 as a glTF with its data inline; `change` edits the JSON text.
fn triangle_gltf(change: impl Fn(String) -> String) -> Result<Scene, SceneError> {
    use base64::Engine;
    let positions: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut data: Vec<u8> = positions.iter().flat_map(|v| v.to_le_bytes()).collect();
    data.extend([0u8, 1, 2, 0]);
    data.extend([0i8, 127, -128, -127, 64, 0].map(|v| v as u8));
    data.extend([0u8; 2]);
    let uri = base64::engine::general_purpose::STANDARD.encode(&data);
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "indices": 1}}]}}],
        "buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{uri}"}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 4}},
            {{"buffer": 0, "byteOffset": 40, "byteLength": 8}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}},
            {{"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}},
            {{"bufferView": 2, "componentType": 5120, "count": 3, "type": "VEC2", "normalized": true}},
            {{"componentType": 5126, "count": 3, "type": "VEC3", "sparse": {{"count": 1,
              "indices": {{"bufferView": 1, "byteOffset": 2, "componentType": 5121}}, "values": {{"bufferView": 0, "byteOffset": 12}}}}}}]}}"#,
        data.len()
    );
    gltf::scene_from_bytes(change(text).as_bytes(), Path::new("test.gltf"))
}

#[test]
fn inline_gltf_triangle_is_placed_by_its_node() {
    let scene = triangle_gltf(|t| {
        t.replace(
            r#"{"mesh": 0}"#,
            r#"{"mesh": 0, "translation": [1, 2, 3], "scale": [2, 2, 2], "rotation": [0, 0, 0.70710678, 0.70710678]}"#,
        )
    })
    .expect("valid");
    check_scene(&scene);
    assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]]);
    let moved = scene.objects[0].transform.0.transform_point3(DVec3::X);
    assert!((moved - DVec3::new(1.0, 4.0, 3.0)).length() < 1e-6, "{moved}");
    // The same as a matrix, columns first.
    let matrix = scene.objects[0].transform.0.matrix3.to_cols_array();
    let [a, b, c] = [0, 3, 6].map(|i| format!("{}, {}, {}, 0", matrix[i], matrix[i + 1], matrix[i + 2]));
    let node = format!(r#"{{"mesh": 0, "matrix": [{a}, {b}, {c}, 1, 2, 3, 1]}}"#);
    let same = triangle_gltf(|t| t.replace(r#"{"mesh": 0}"#, &node)).expect("valid");
    assert!((same.objects[0].transform.0.transform_point3(DVec3::X) - moved).length() < 1e-6);
}

#[test]
fn gltf_strips_fans_and_missing_indices_make_triangles() {
    let mode = |mode: u32| move |t: String| t.replace(r#""indices": 1"#, &format!(r#""mode": {mode}"#));
    assert_eq!(triangle_gltf(mode(5)).expect("valid").meshes[0].triangles, [[0, 1, 2]]);
    assert_eq!(triangle_gltf(mode(6)).expect("valid").meshes[0].triangles, [[1, 2, 0]]);
    assert_eq!(triangle_gltf(mode(4)).expect("valid").meshes[0].triangles, [[0, 1, 2]]);
    let points = triangle_gltf(mode(0)).expect("valid");
    assert!(points.warnings.iter().any(|w| w.contains("points and lines")), "{:?}", points.warnings);
}

#[test]
fn gltf_sparse_accessor_replaces_zeros() {
    let scene = triangle_gltf(|t| t.replace(r#""POSITION": 0}, "indices": 1"#, r#""POSITION": 3}"#)).expect("valid");
    // Index 2 of view 1 is vertex 2; its value is the second position.
    assert_eq!(scene.meshes[0].positions, [Vec3::ZERO, Vec3::ZERO, Vec3::X]);
}

#[test]
fn gltf_normalized_integers_are_scaled_and_v_points_up() {
    let scene = triangle_gltf(|t| t.replace(r#""POSITION": 0"#, r#""POSITION": 0, "TEXCOORD_0": 2"#)).expect("valid");
    let uvs = &scene.meshes[0].uvs;
    assert_eq!(uvs[0], Vec2::new(0.0, 0.0));
    assert_eq!(uvs[1], Vec2::new(-1.0, 2.0), "-128 is -1 too");
    assert!((uvs[2] - Vec2::new(64.0 / 127.0, 1.0)).length() < 1e-6, "{}", uvs[2]);
    let plain = triangle_gltf(|t| {
        t.replace(r#""POSITION": 0"#, r#""POSITION": 0, "TEXCOORD_0": 2"#).replace(r#", "normalized": true"#, "")
    });
    assert_eq!(plain.expect("valid").meshes[0].uvs[1], Vec2::new(-128.0, 128.0));
}

#[test]
fn gltf_material_becomes_our_nearest_model() {
    let with = |material: &str| {
        let scene = triangle_gltf(|t| {
            let t = t.replace(r#""indices": 1"#, r#""indices": 1, "material": 0"#);
            t.replace(r#""scene": 0,"#, &format!(r#""scene": 0, "materials": [{material}],"#))
        });
        scene.expect("valid").materials[0].clone()
    };
    let metal = with(r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0.5}}"#);
    let Model::Principled(principled) = &metal.model else { panic!("{metal:?}") };
    assert_eq!((principled.roughness, principled.metallic), (0.5, 1.0));
    assert_eq!((metal.color, metal.specular_color), (Vec3::new(1.0, 0.5, 0.25), Vec3::new(1.0, 0.5, 0.25)));
    assert_eq!(metal.k_r, 0.25);
    let mirror = with(r#"{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "roughnessFactor": 0}}"#);
    assert_eq!((&mirror.model, mirror.color), (&Model::Mirror, Vec3::new(1.0, 0.5, 0.25)));
    let plastic = with(r#"{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.3, 0.4, 1], "metallicFactor": 0}}"#);
    let Model::Principled(principled) = &plastic.model else { panic!("{plastic:?}") };
    assert_eq!((principled.metallic, principled.eta, plastic.color), (0.0, 1.5, Vec3::new(0.2, 0.3, 0.4)));
    let glass = with(
        r#"{"pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.33}, "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, 0.5, 0.25]}}}"#,
    );
    let Model::Dielectric { eta, absorption } = glass.model else { panic!("{glass:?}") };
    assert_eq!(eta, 1.33);
    assert!((absorption - Vec3::new(0.0, 0.5, 1.0) * std::f32::consts::LN_2).length() < 1e-5, "{absorption}");
    let blend = with(
        r#"{"alphaMode": "BLEND", "pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [1, 1, 1, 0.25]}}"#,
    );
    assert_eq!(blend.transparency, Some(Transparency::Interpolated { k_t: 0.75 }));
    let glow = with(
        r#"{"emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}}"#,
    );
    assert_eq!(glow.emission, Vec3::new(4.0, 2.0, 0.0));
}

#[test]
fn gltf_lights_keep_their_units_and_cameras_are_kept() {
    let scene = triangle_gltf(|t| {
        t.replace(r#"{"mesh": 0}"#, r#"{"mesh": 0, "children": [1, 2]}, {"camera": 0, "translation": [0, 0, 5]},
            {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 9]}"#)
            .replace(r#""scene": 0,"#, r#""scene": 0, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 2, "znear": 0.1}}],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 54351}]}},"#)
    })
    .expect("valid");
    assert_eq!(scene.camera.eye, Vec3::new(0.0, 0.0, 5.0));
    assert!(scene.camera.target.z < 5.0 && scene.camera.target.x == 0.0);
    assert_eq!(scene.film.width, 2 * scene.film.height);
    assert_eq!(scene.objects.len(), 1, "no ground where there is a camera");
    // 54,351 cd / 683 over 9^2 m^2 is 0.98 W/m^2, a well lit scene.
    assert_eq!(scene.lights.len(), 1);
    assert!((scene.lights[0].intensity.x - 79.577).abs() < 0.01, "{}", scene.lights[0].intensity);
    let mut dark = triangle_gltf(|t| {
        t.replace(r#"{"mesh": 0}"#, r#"{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}"#)
            .replace(r#""scene": 0,"#, r#""scene": 0, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},"#)
    })
    .expect("valid");
    staging::prepare(&mut dark);
    staging::stage(&mut dark, &Controls::default()).expect("nothing is read");
    // 3 lux are 0.0044 W/m^2: the film is exposed for them, and they stay what they are.
    assert!((dark.lights[0].intensity.x - 3.0 / 683.0).abs() < 1e-6, "{}", dark.lights[0].intensity);
    assert!(dark.metered && dark.film.unit_exponent < -6, "{}", dark.film.unit_exponent);
    assert!(dark.warnings.is_empty() && dark.notes.iter().any(|n| n.contains("own light alone")), "{:?}", dark.notes);
}

#[test]
fn glb_chunks_are_read_and_unknown_ones_skipped() {
    let json = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}  "#;
    let positions: Vec<u8> =
        [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut chunks = Vec::new();
    for (kind, data) in [(b"JSON", &json[..]), (b"ODD!", &[1, 2, 3, 4][..]), (b"BIN\0", &positions[..])] {
        chunks.extend((data.len() as u32).to_le_bytes());
        chunks.extend(kind);
        chunks.extend(data);
    }
    let mut glb = b"glTF".to_vec();
    glb.extend(2u32.to_le_bytes());
    glb.extend((chunks.len() as u32 + 12).to_le_bytes());
    glb.extend(chunks);
    let scene = gltf::scene_from_bytes(&glb, Path::new("test.glb")).expect("valid");
    assert_eq!(scene.meshes[0].positions[1], Vec3::X);
}

/// A picture of 2 x 3 texels of one colour.
fn png_base64(color: [u8; 4]) -> String {
    use base64::Engine;
    let mut png = std::io::Cursor::new(Vec::new());
    let picture = image::ImageBuffer::from_pixel(2, 3, image::Rgba(color));
    image::DynamicImage::ImageRgba8(picture).write_to(&mut png, image::ImageFormat::Png).expect("a picture");
    base64::engine::general_purpose::STANDARD.encode(png.get_ref())
}

/// The triangle with one material, and pictures of one colour each.
fn textured_gltf(material: &str, pictures: &[[u8; 4]]) -> Scene {
    let images: Vec<String> =
        pictures.iter().map(|c| format!(r#"{{"uri": "data:image/png;base64,{}"}}"#, png_base64(*c))).collect();
    let textures: Vec<String> = (0..pictures.len()).map(|i| format!(r#"{{"source": {i}}}"#)).collect();
    let head = format!(
        r#""scene": 0, "images": [{}], "textures": [{}], "materials": [{material}],"#,
        images.join(","),
        textures.join(",")
    );
    let scene = triangle_gltf(|t| {
        t.replace(r#""POSITION": 0"#, r#""POSITION": 0, "TEXCOORD_0": 2"#)
            .replace(r#""indices": 1"#, r#""indices": 1, "material": 0"#)
            .replace(r#""scene": 0,"#, &head)
    });
    scene.unwrap_or_else(|error| panic!("{error}"))
}

/// What a material's textures vary, with channel, scale and first texel.
fn bindings(scene: &Scene) -> Vec<(Parameter, Channel, f32, [u8; 4], bool)> {
    let of = |binding: &TextureBinding| {
        let (texel, encoded) = match &scene.textures[binding.texture.0 as usize].data {
            TextureData::Srgb8(texels) => (texels[0], true),
            TextureData::Linear8(texels) => (texels[0], false),
            _ => panic!("eight bits"),
        };
        (binding.parameter, binding.channel, binding.scale, texel, encoded)
    };
    scene.materials[0].textures.iter().map(of).collect()
}

#[test]
fn gltf_textures_vary_every_parameter_texel_by_texel() {
    let scene = textured_gltf(
        r#"{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}, "metallicFactor": 0.75},
        "normalTexture": {"index": 2, "scale": 0.5}, "emissiveTexture": {"index": 3}, "emissiveFactor": [1, 1, 1],
        "occlusionTexture": {"index": 1}, "alphaMode": "MASK", "alphaCutoff": 0.25}"#,
        &[[9, 8, 7, 128], [0, 100, 200, 255], [128, 128, 255, 255], [1, 2, 3, 255]],
    );
    assert_eq!(
        bindings(&scene),
        [
            (Parameter::Color, Channel::Rgb, 1.0, [9, 8, 7, 128], true),
            (Parameter::Roughness, Channel::G, 1.0, [0, 100, 200, 255], false),
            (Parameter::Metallic, Channel::B, 1.0, [0, 100, 200, 255], false),
            (Parameter::Mask, Channel::A, 0.25, [9, 8, 7, 128], true),
            (Parameter::Emission, Channel::Rgb, 1.0, [1, 2, 3, 255], true),
            (Parameter::Normal, Channel::Rgb, 0.5, [128, 128, 255, 255], false),
        ]
    );
    let Model::Principled(principled) = &scene.materials[0].model else { panic!("{:?}", scene.materials[0]) };
    assert_eq!((principled.roughness, principled.metallic), (1.0, 0.75), "what the texels are times");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn gltf_alpha_of_a_texture_blends_only_where_there_is_some() {
    let material = r#"{"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]}}"#;
    let scene = textured_gltf(material, &[[9, 8, 7, 128]]);
    assert_eq!(bindings(&scene)[1], (Parameter::Opacity, Channel::A, 1.0, [9, 8, 7, 128], true));
    assert_eq!(scene.materials[0].opacity, 0.5);
    let scene = textured_gltf(material, &[[9, 8, 7, 255]]);
    assert_eq!(bindings(&scene).len(), 1);
    assert_eq!(scene.materials[0].transparency, Some(Transparency::Interpolated { k_t: 0.5 }));
    let masked = r#"{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.4]}}"#;
    assert_eq!(textured_gltf(masked, &[]).materials[0].opacity, 0.0);
}

#[test]
fn gltf_transmission_of_a_texture_counts_by_its_mean() {
    let thin = |factor: f32| {
        let material = format!(
            r#"{{"pbrMetallicRoughness": {{"metallicFactor": 0}}, "extensions": {{"KHR_materials_transmission":
            {{"transmissionFactor": {factor}, "transmissionTexture": {{"index": 0}}}}}}}}"#
        );
        textured_gltf(&material, &[[51, 255, 255, 255]])
    };
    let scene = thin(0.5);
    let Some(Transparency::Filtered { k_t, .. }) = scene.materials[0].transparency else { panic!("{scene:?}") };
    assert!((k_t - 0.1).abs() < 1e-6, "a fifth of a half: {k_t}");
    assert_eq!(scene.warnings, ["transmission textures count by their mean"]);
    assert_eq!(thin(0.0).materials[0].transparency, None);
}

#[test]
fn gltf_specular_glossiness_is_converted_texel_by_texel() {
    let with = |diffuse: [u8; 4], specular: [u8; 4]| {
        let material = r#"{"extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": {"index": 0},
            "specularGlossinessTexture": {"index": 1}, "glossinessFactor": 0.5}}}"#;
        bindings(&textured_gltf(material, &[diffuse, specular]))
    };
    // A gold of sRGB 255, 226, 155 and full glossiness: the specular colour is the base colour, all metal.
    let gold = with([0, 0, 0, 255], [255, 226, 155, 255]);
    assert_eq!(gold[0], (Parameter::Color, Channel::Rgb, 1.0, [255, 226, 155, 255], true));
    assert_eq!(gold[1].3, [0, 128, 255, 255], "roughness 1 - 0.5");
    assert_eq!((gold[1].0, gold[2].0), (Parameter::Roughness, Parameter::Metallic));
    // 4 % reflectance is sRGB 56: what is no metal keeps its diffuse colour.
    let chalk = with([200, 100, 50, 255], [56, 56, 56, 0]);
    let near = |a: [u8; 4], b: [u8; 4]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 2);
    assert!(near(chalk[0].3, [200, 100, 50, 255]) && near(chalk[1].3, [0, 255, 0, 255]), "{chalk:?}");
}

#[test]
fn gltf_texture_transform_and_sampler_become_the_textures() {
    let uri = png_base64([255, 0, 0, 255]);
    let head = format!(
        r#""scene": 0, "images": [{{"uri": "data:image/png;base64,{uri}"}}],
        "samplers": [{{"magFilter": 9728, "wrapS": 33071, "wrapT": 33648}}], "textures": [{{"source": 0, "sampler": 0}}],
        "materials": [{{"pbrMetallicRoughness": {{"metallicFactor": 0, "baseColorTexture": {{"index": 0, "texCoord": 5,
        "extensions": {{"KHR_texture_transform": {{"offset": [0.25, 0], "rotation": 1.57079632679, "scale": [2, 1], "texCoord": 1}}}}}}}}}}],"#
    );
    let scene = triangle_gltf(|t| {
        t.replace(r#""POSITION": 0"#, r#""POSITION": 0, "TEXCOORD_1": 2"#)
            .replace(r#""indices": 1"#, r#""indices": 1, "material": 0"#)
            .replace(r#""scene": 0,"#, &head)
    })
    .expect("valid");
    let texture = &scene.textures[0];
    assert_eq!((texture.width, texture.height, texture.bilinear), (2, 3, false));
    assert_eq!((texture.wrap_u, texture.wrap_v), (Wrap::Clamp, Wrap::Mirror));
    // A quarter turn takes (2 u, v) to (v, -2 u); then the offset, then v up.
    let expected = [Vec2::new(1.25, 1.0), Vec2::new(-0.75, -1.0), Vec2::new(0.25, 1.0 + 128.0 / 127.0)];
    let ([su, sv], [hu, hv], [ou, ov]) = (texture.scale, texture.shear, texture.offset);
    for (uv, expected) in scene.meshes[0].uvs.iter().zip(expected) {
        let laid = Vec2::new(uv.x * su + uv.y * hu + ou, uv.y * sv + uv.x * hv + ov);
        assert!((laid - expected).length() < 1e-5, "{laid} {expected}");
    }
    assert_eq!(scene.meshes[0].uvs[0].y, 0.0, "the set that the texture asks for, as it is but for v");
}
