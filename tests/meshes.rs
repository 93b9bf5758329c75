//! Models from files: PLY, glTF, pictures, and the stage they are shown on.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use glam::{DVec3, Vec2, Vec3};
use gonio::scene::load::image::{ColorSpace, load_texture, texture_from_bytes};
use gonio::scene::load::{Controls, ply, staging};
use gonio::scene::{
    Background, Camera, Geometry, Integrator, Light, LightKind, Material, Mesh, MeshId, Object, Projection, Rgb, Scene,
    TextureData, Transform, shape,
};
use std::path::Path;

fn read_ply(bytes: &[u8]) -> Mesh {
    ply::mesh_from_bytes(bytes, Path::new("test.ply")).expect("a valid file")
}

/// Vertex type, face list types; then numbers written by `write`.
fn binary_ply(format: &str, write: impl Fn(&mut Vec<u8>, &[u8])) -> Vec<u8> {
    let mut bytes = format!(
        "ply\r\nformat {format} 1.0\r\ncomment made by hand\r\nelement vertex 4\r\nproperty float x\r\nproperty double y\r\n\
         property float z\r\nproperty short weight\r\nproperty uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\n\
         element extra 1\r\nproperty list ushort int things\r\nelement face 1\r\nproperty uchar flags\r\n\
         property list int ushort vertex_indices\r\nend_header\r\n"
    )
    .into_bytes();
    for [x, y] in [[0.0f32, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
        write(&mut bytes, &x.to_le_bytes());
        write(&mut bytes, &f64::from(y).to_le_bytes());
        write(&mut bytes, &(-2.5f32).to_le_bytes());
        write(&mut bytes, &(-7i16).to_le_bytes());
        bytes.extend([255, 0, 188]);
    }
    write(&mut bytes, &2u16.to_le_bytes());
    write(&mut bytes, &1i32.to_le_bytes());
    write(&mut bytes, &(-1i32).to_le_bytes());
    bytes.push(9);
    write(&mut bytes, &4i32.to_le_bytes());
    (0..4u16).for_each(|i| write(&mut bytes, &i.to_le_bytes()));
    bytes
}

#[test]
fn ply_in_both_byte_orders_gives_the_same_mesh() {
    let little = read_ply(&binary_ply("binary_little_endian", |out, bytes| out.extend(bytes)));
    let big = read_ply(&binary_ply("binary_big_endian", |out, bytes| out.extend(bytes.iter().rev())));
    assert_eq!(little, big);
    assert_eq!(little.positions[2], Vec3::new(1.0, 1.0, -2.5));
    assert_eq!(little.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(little.normals.is_empty() && little.uvs.is_empty());
    let color = little.colors[0];
    assert!((color - Vec3::new(1.0, 0.0, 0.5029)).abs().max_element() < 1e-4, "{color}");
    assert_eq!(little.name, "test");
}

#[test]
fn ascii_ply_reads_normals_uvs_float_colors_and_skips_the_rest() {
    let text = "ply\nformat ascii 1.0\nobj_info x\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nproperty float red\n\
        property float green\nproperty float blue\nproperty list uchar float other\nelement face 1\n\
        property list uchar int vertex_index\nend_header\n\
        0 0 0 0 0 2 0 0.25 0.5 0.5 0.5 0\n\n1 0 0 0 0 1 1 0 1 1 1 2 5 6\n0 1e0 0 0 0 0 0 1 0 0 0 1 7\n  3 0 1 2";
    let mesh = read_ply(text.as_bytes());
    assert_eq!(mesh.normals, [Vec3::Z; 3], "scaled to length 1; the zero normal becomes the face's");
    assert_eq!(mesh.uvs[0], Vec2::new(0.0, 0.25));
    assert_eq!(mesh.colors[0], Vec3::splat(0.5));
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
}

#[test]
fn concave_polygon_is_cut_into_triangles_that_cover_it() {
    // An arrow head whose fan from the first corner would cover the notch.
    let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float y\nproperty float z\nproperty float x\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n4 1 0\n0 2 0\n1 1 0\n0 0 0\n2 0.9 0\n5 0 1 2 3 4\n";
    let mesh = read_ply(text.as_bytes());
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).x * 0.5
    };
    let areas: Vec<f32> = mesh.triangles.iter().map(area).collect();
    let shoelace = [[4.0, 1.0], [0.0, 2.0], [1.0, 1.0], [0.0, 0.0], [2.0, 0.9]];
    let expected: f32 =
        (0..5).map(|i| (shoelace[i], shoelace[(i + 1) % 5])).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]) * 0.5).sum();
    assert_eq!(areas.len(), 3);
    assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
    assert!((areas.iter().sum::<f32>() - expected).abs() < 1e-6);
}

#[test]
fn ply_triangle_strips_alternate_and_restart() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n9 0 1 2 3 -1 2 3 4 5\n";
    assert_eq!(read_ply(text.as_bytes()).triangles, [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]);
}

#[test]
fn every_ply_of_the_assets_loads() {
    let Some(folder) = asset("meshes") else {
        return;
    };
    let sizes = [("mitsuba_bunny.ply", 69_451), ("mitsuba_teapot.ply", 2_256), ("matpreview/02_shell.ply", 0)];
    for (name, triangles) in sizes {
        let scene = ply::load(&folder.join(name)).expect(name);
        let mesh = &scene.meshes[0];
        assert!(triangles == 0 || mesh.triangles.len() == triangles, "{name}: {}", mesh.triangles.len());
        assert_eq!(mesh.normals.len(), mesh.positions.len(), "{name} is shaded smoothly");
    }
}

#[test]
fn pictures_of_every_depth_and_format_become_textures() {
    let Some(folder) = asset("images/pngsuite") else {
        return;
    };
    for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
        let path = entry.path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if path.extension().is_none_or(|e| e != "png") {
            continue;
        }
        let result = load_texture(&path, ColorSpace::Srgb);
        if name.starts_with('x') {
            let message = result.expect_err(&name).to_string();
            assert!(message.contains(&name), "{message}");
        } else {
            let texture = result.unwrap_or_else(|e| panic!("{e}"));
            let sixteen = name.ends_with("16.png") && !name.starts_with("tbg") && !name.starts_with("tbb");
            assert!(!sixteen || matches!(texture.data, TextureData::Float(_)), "{name}");
        }
    }
    let Some(hdr) = asset("hdr/chinese_garden_1k.hdr") else {
        return;
    };
    let texture = load_texture(&hdr, ColorSpace::Srgb).expect("a valid picture");
    assert_eq!((texture.width, texture.height), (1024, 512));
    let Some(exr) = asset("images/exr-testimages") else {
        return;
    };
    for name in ["BrightRingsNanInf.exr", "AllHalfValues.exr", "SquaresSwirls.exr"] {
        let texture = load_texture(&exr.join(name), ColorSpace::Srgb).unwrap_or_else(|e| panic!("{e}"));
        let TextureData::Float(stored) = &texture.data else { panic!("{name}") };
        // What is no number comes as far as here, and no further: the scene that shows it holds none.
        let file = exr.join(name).canonicalize().expect("it is there");
        let text = format!(
            "[camera]\neye = [0, 0, 5]\n[[object]]\nshape = \"sphere\"\nmaterial = \"m\"\n[[material]]\nname = \"m\"\n\
             bump_map = '{}'\n",
            file.display()
        );
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.toml");
        std::fs::write(&path, text).expect("writable");
        let scene = gonio::scene::load::load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
        let TextureData::Float(shown) = &scene.textures[0].data else { panic!("{name}") };
        assert!(shown.as_flattened().iter().all(|v| v.is_finite()), "{name}");
        let broken = stored.as_flattened().iter().filter(|v| !v.is_finite()).count();
        assert_eq!(scene.warnings.iter().any(|warning| warning.contains("numbers are finite")), broken > 0, "{name}");
    }
}

#[test]
fn sixteen_bit_srgb_is_decoded_and_linear_data_is_not() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::ImageBuffer::from_pixel(2, 1, image::Rgba([32_768u16, 65_535, 0, 32_768]));
    image::DynamicImage::ImageRgba16(picture).write_to(&mut bytes, image::ImageFormat::Png).expect("a picture");
    let texel = |space| {
        let texture = texture_from_bytes(bytes.get_ref(), Path::new("a.png"), space).expect("a picture");
        let TextureData::Float(texels) = texture.data else { panic!("16 bits are floats") };
        texels[0]
    };
    let srgb = texel(ColorSpace::Srgb);
    assert!((srgb[0] - 0.214_05).abs() < 1e-4 && srgb[1] == 1.0 && srgb[2] == 0.0, "{srgb:?}");
    assert!((srgb[3] - 0.5).abs() < 1e-4, "alpha is linear");
    assert!((texel(ColorSpace::Linear)[0] - 0.5).abs() < 1e-4);
}

/// `mesh`, staged.
fn staged(mesh: Mesh, transform: Transform) -> Scene {
    staged_as(mesh, transform, &Controls::default())
}

fn staged_as(mesh: Mesh, transform: Transform, controls: &Controls) -> Scene {
    let mut scene = staging::bare_scene(Path::new("bare.obj"));
    scene.materials.push(gonio::scene::Material::grey("grey"));
    scene.objects.push(Object {
        name: mesh.name.clone(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform,
        material: Some(gonio::scene::MaterialId(0)),
        casts_shadow: None,
        shading: None,
    });
    scene.meshes.push(mesh);
    staging::stage(&mut scene, controls).expect("nothing is read");
    scene
}

/// Where `p` is seen: right and up, -1 to 1 within the frame.
fn on_film(scene: &Scene, p: DVec3) -> [f64; 2] {
    let Camera { eye, target, up, projection, .. } = scene.camera;
    let Projection::Perspective { fov_y } = projection else { panic!("perspective") };
    let forward = (target.as_dvec3() - eye.as_dvec3()).normalize();
    let right = forward.cross(up.as_dvec3()).normalize();
    let up = right.cross(forward);
    let v = p - eye.as_dvec3();
    let depth = v.dot(forward);
    assert!(depth > 0.0, "{p} is behind the camera at {eye}");
    let tan = (f64::from(fov_y) * 0.5).tan() * depth;
    let aspect = f64::from(scene.film.width) / f64::from(scene.film.height);
    [v.dot(right) / (tan * aspect), v.dot(up) / tan]
}

fn largest_on_film(scene: &Scene) -> f64 {
    let Geometry::Mesh(id) = scene.objects[0].geometry else { panic!("a mesh") };
    let points = scene.meshes[id.0 as usize].positions.iter();
    points
        .flat_map(|p| on_film(scene, scene.objects[0].transform.0.transform_point3(p.as_dvec3())))
        .fold(0.0, |m, v| m.max(v.abs()))
}

#[test]
fn any_model_fills_the_frame_whatever_its_size_place_and_shape() {
    for size in [1e-4, 1.0, 1e6] {
        for offset in [0.0, 30.0] {
            let meshes = [
                shape::teapot(3),
                shape::torus(1.0, 0.2, 12, 8),
                shape::cuboid([0.1, 9.0, 0.1], 1),
                shape::quad([3.0, 1.0], 1),
            ];
            for mesh in meshes {
                let name = mesh.name.clone();
                let scale = Transform::scale(Vec3::splat(size));
                let scene = staged(mesh, scale.then(Transform::translate(Vec3::new(offset, -offset, offset) * size)));
                let reach = largest_on_film(&scene);
                assert!((0.5..0.95).contains(&reach), "{name} of size {size} at {offset}: {reach}");
                assert!(scene.lights.is_empty() && matches!(scene.background, Background::Image(_)), "in a studio");
            }
        }
    }
}

/// What `whitted` and `local` light with lamps.
fn with_lamps() -> Controls {
    Controls { integrator: Some(Integrator::Whitted), ..Controls::default() }
}

#[test]
fn key_light_comes_from_above_behind_the_camera() {
    let scene = staged_as(shape::teapot(3), Transform::default(), &with_lamps());
    assert!(scene.lights.len() == 2 && scene.ambient != Rgb::ZERO);
    assert!(scene.lights.iter().all(|l| matches!(l.kind, LightKind::Directional { .. })));
    let Light { kind: LightKind::Directional { direction }, .. } = scene.lights[0] else { panic!("directional") };
    let view = (scene.camera.target - scene.camera.eye).normalize();
    assert!(direction.y < -0.5 && direction.dot(view) > 0.3 && (direction.length() - 1.0).abs() < 1e-6, "{direction}");
    assert!(scene.camera.eye.y > scene.camera.target.y, "slightly from above");
}

#[test]
fn objects_get_a_ground_and_flat_things_and_rooms_do_not() {
    let has_ground = |mesh: Mesh| staged(mesh, Transform::default()).objects.len() == 2;
    assert!(has_ground(shape::teapot(3)) && has_ground(shape::sphere_mesh(1.0, 12)));
    assert!(!has_ground(shape::quad([1.0, 1.0], 1)));
    let mut room = shape::cuboid([4.0, 3.0, 6.0], 1);
    room.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert!(!has_ground(room));
    let scene = staged(shape::teapot(3), Transform::translate(Vec3::new(0.0, 5.0, 0.0)));
    let ground = scene.objects[1].transform.0.translation.y;
    assert!(ground < 5.0 && ground > 4.99, "{ground}");
}

#[test]
fn room_is_seen_and_lit_from_inside() {
    let mut room = shape::cuboid([4.0, 3.0, 6.0], 1);
    room.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let scene = staged(room, Transform::translate(Vec3::new(10.0, 0.0, 0.0)));
    let inside = |p: Vec3| (p.x - 10.0).abs() < 2.0 && p.y.abs() < 1.5 && p.z.abs() < 3.0;
    assert!(inside(scene.camera.eye) && scene.camera.eye.z > 2.0, "{}", scene.camera.eye);
    for light in &scene.lights {
        let LightKind::Point { position } = light.kind else { panic!("{light:?}") };
        assert!(inside(position), "{position}");
    }
}

/// A box within a box that faces inwards: walls 0.2 thick, the lid of both left away where `open`.
fn thick_walls(open: bool) -> Mesh {
    let mut walls = shape::cuboid([4.4, 3.4, 6.4], 1);
    let inner = shape::cuboid([4.0, 3.0, 6.0], 1);
    let first = walls.positions.len() as u32;
    walls.positions.extend(&inner.positions);
    walls.normals.extend(inner.normals.iter().map(|n| -n));
    walls.uvs.extend(&inner.uvs);
    walls.triangles.extend(inner.triangles.iter().map(|&[a, b, c]| [b + first, a + first, c + first]));
    let top = |t: &[u32; 3]| t.iter().all(|&i| walls.positions[i as usize].y > 1.4);
    let kept = walls.triangles.iter().copied().filter(|t| !(open && top(t))).collect();
    Mesh { triangles: kept, ..walls }
}

#[test]
fn room_whose_walls_have_an_outside_is_seen_from_inside_and_a_trough_from_outside() {
    let room = staged(thick_walls(false), Transform::default());
    let eye = room.camera.eye;
    assert!(eye.x.abs() < 2.0 && eye.y.abs() < 1.5 && eye.z.abs() < 3.0, "{eye}");
    let trough = staged(thick_walls(true), Transform::default());
    assert!(trough.camera.eye.length() > 5.0 && trough.objects.len() == 2, "{}", trough.camera.eye);
}

#[test]
fn own_camera_and_lights_are_kept() {
    let mut scene = staging::bare_scene(Path::new("own.gltf"));
    let camera = Camera {
        eye: Vec3::X,
        target: Vec3::Y,
        up: Vec3::Z,
        projection: Projection::Orthographic { height: 2.0 },
        lens: None,
        shift: Vec2::ZERO,
        mirrored: false,
    };
    (scene.camera, scene.has_camera) = (camera, true);
    staging::stage(&mut scene, &Controls::default()).expect("nothing is read");
    assert_eq!(scene.camera, camera);
    assert!(matches!(scene.background, Background::Image(_)), "a camera alone gives no light");
    let lights = staged_as(shape::teapot(3), Transform::default(), &with_lamps()).lights;
    let mut scene = staging::bare_scene(Path::new("own.gltf"));
    scene.lights = lights.clone();
    staging::stage(&mut scene, &Controls::default()).expect("nothing is read");
    assert_eq!((scene.lights, scene.background), (lights, Background::BLACK), "no light is added or changed");
    assert!(scene.notes.iter().any(|note| note.contains("--environment sky")), "{:?}", scene.notes);
    assert!(scene.camera.eye != scene.camera.target);
}

/// A box of `color` that glows with `emission` on all sides.
fn glowing(emission: f32) -> Scene {
    let mut scene = staging::bare_scene(Path::new("glow.obj"));
    scene.materials.push(Material { emission: Rgb::splat(emission), ..Material::grey("glow") });
    scene.meshes.push(shape::cuboid([1.0; 3], 1));
    scene.objects.push(Object {
        name: "box".to_owned(),
        geometry: Geometry::Mesh(MeshId(0)),
        transform: Transform::default(),
        material: Some(gonio::scene::MaterialId(0)),
        casts_shadow: None,
        shading: None,
    });
    staging::stage(&mut scene, &Controls::default()).expect("nothing is read");
    scene
}

#[test]
fn what_glows_like_a_lamp_lights_its_scene_and_what_glows_like_a_display_does_not() {
    let lamp = glowing(15.0);
    assert!(lamp.lights.is_empty() && !lamp.background.shines() && lamp.objects.len() == 1, "no lamp is invented");
    assert_eq!(lamp.settings.integrator, Integrator::Path, "whitted sees no light from faces");
    assert!(lamp.notes.iter().any(|note| note.contains("--environment sky")), "{:?}", lamp.notes);
    assert!(glowing(0.8).background.shines(), "a studio");
}

#[test]
fn the_ground_is_darker_than_the_model_and_never_black() {
    let ground = |grey: f32| {
        let mut scene = staging::bare_scene(Path::new("a.obj"));
        scene.materials.push(Material { color: Rgb::splat(grey), ..Material::grey("m") });
        scene.meshes.push(shape::teapot(3));
        scene.objects.push(Object {
            name: "pot".to_owned(),
            geometry: Geometry::Mesh(MeshId(0)),
            transform: Transform::default(),
            material: Some(gonio::scene::MaterialId(0)),
            casts_shadow: None,
            shading: None,
        });
        staging::stage(&mut scene, &Controls::default()).expect("nothing is read");
        scene.materials.last().expect("the ground's").color.x
    };
    for grey in [0.25, 0.5, 0.9] {
        assert!(ground(grey) < 0.7 * grey && ground(grey) > 0.3 * grey, "{grey}: {}", ground(grey));
    }
    assert!(ground(0.0) > 0.05);
}
