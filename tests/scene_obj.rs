//! OBJ and MTL: geometry, attributes and materials.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use glam::{Vec2, Vec3};
use gonio::scene::load::obj;
use gonio::scene::*;
use std::fs;
use std::path::PathBuf;

/// Writes the files, the first of which is the OBJ, and loads that one.
#[track_caller]
fn read_files(files: &[(&str, &str)]) -> Scene {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("writable");
    }
    obj::load(&folder.path().join(files[0].0)).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn read(text: &str) -> Scene {
    read_files(&[("a.obj", text)])
}

/// The material that the MTL lines `keys` make.
#[track_caller]
fn material(keys: &str) -> Material {
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    let scene = read_files(&[("a.obj", obj), ("a.mtl", &format!("newmtl m\n{keys}\n"))]);
    scene.materials[scene.meshes[0].face_materials[0].0 as usize].clone()
}

/// Corners of all triangles, in order.
fn corners(mesh: &Mesh) -> Vec<Vec3> {
    mesh.triangles.iter().flatten().map(|corner| mesh.positions[*corner as usize]).collect()
}

fn area(mesh: &Mesh) -> f32 {
    corners(mesh).chunks(3).map(|c| (c[1] - c[0]).cross(c[2] - c[0]).z * 0.5).sum()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn polygons_become_triangles_that_cover_them() {
    let square = read(&format!("{SQUARE}f 1 2 3 4\n"));
    assert_eq!((square.meshes[0].triangles.len(), area(&square.meshes[0])), (2, 1.0));
    // An L of area 3: a fan from its first corner would leave it.
    let l = read("v 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nf 1 2 3 4 5 6\n");
    let mesh = &l.meshes[0];
    assert_eq!((mesh.triangles.len(), area(mesh)), (4, 3.0));
    assert!(corners(mesh).chunks(3).all(|c| (c[1] - c[0]).cross(c[2] - c[0]).z >= 0.0), "none is turned over");
}

#[test]
fn indices_count_from_one_or_back_from_the_latest() {
    let forward = read(&format!("{SQUARE}f 1 2 3\n"));
    let backward = read(&format!("{SQUARE}f -4 -3 -2\nv 9 9 9\n"));
    assert_eq!(corners(&forward.meshes[0]), corners(&backward.meshes[0]));
    assert_eq!(forward.meshes[0].positions.len(), 3, "vertices that no face uses are left out");
}

#[test]
fn corners_share_vertices_only_if_all_their_indices_agree() {
    let text =
        format!("{SQUARE}vt 0 0\nvt 1 0.5\nvn 0 0 2\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/2/1\nf 1/2/1 3/1/1 4/2/1\n");
    let mesh = &read(&text).meshes[0];
    assert_eq!(mesh.positions.len(), 5);
    assert_eq!(mesh.uvs[mesh.triangles[1][2] as usize], Vec2::new(1.0, 0.5));
    assert!(mesh.normals.iter().all(|normal| *normal == Vec3::Z), "normals are made unit");
}

#[test]
fn attributes_that_some_corners_lack_are_filled_in() {
    let text = format!("{SQUARE}v 2 0 0 1 0.5 0\nvt 0.5 0.5\nvn 0 1 0\nf 1 2 3\nf 1/1/1 3/1/1 4/1/1\nf 2 5 3\n");
    let mesh = &read(&text).meshes[0];
    let n = mesh.positions.len();
    assert_eq!((mesh.uvs.len(), mesh.normals.len(), mesh.colors.len()), (n, n, n));
    let [a, ..] = mesh.triangles[0];
    assert_eq!((mesh.uvs[a as usize], mesh.normals[a as usize]), (Vec2::ZERO, Vec3::Z), "the face's own normal");
    let [b, ..] = mesh.triangles[1];
    assert_eq!((mesh.uvs[b as usize], mesh.normals[b as usize]), (Vec2::splat(0.5), Vec3::Y));
    let [_, c, _] = mesh.triangles[2];
    // IEC 61966-2-1 of .5.
    assert_eq!((mesh.colors[a as usize], mesh.colors[c as usize]), (Vec3::ONE, Vec3::new(1.0, 0.214_041_14, 0.0)));
}

#[test]
fn a_file_without_normals_is_smooth_unless_it_says_s_off() {
    assert!(!read(&format!("{SQUARE}f 1 2 3\n")).meshes[0].normals.is_empty());
    assert!(read(&format!("s off\n{SQUARE}f 1 2 3\n")).meshes[0].normals.is_empty());
    assert!(!read(&format!("s off\n{SQUARE}s 1\nf 1 2 3\n")).meshes[0].normals.is_empty());
}

#[test]
fn windows_line_ends_continuations_and_odd_statements_are_read() {
    let text =
        "\u{feff}# c\r\no a\r\ng b c\r\nv 0 0 0 1.0\r\nv 1 0 0\r\nv 0 \\\r\n1 0\r\nl 1 2\r\nvp 0.5\r\nf 1// 2 3\r\n";
    let scene = read(text.trim_start_matches('\u{feff}'));
    assert_eq!(corners(&scene.meshes[0])[2], Vec3::Y);
    assert!(scene.warnings[0].ends_with("ignored: l, vp"), "{:?}", scene.warnings);
    assert_eq!(read(text).meshes, scene.meshes, "a byte order mark changes nothing");
}

#[test]
fn faces_keep_the_materials_they_were_given() {
    let obj = format!("{SQUARE}f 1 2 3\nmtllib a.mtl\nusemtl red paint\nf 1 3 4\nf 1 2 4\nusemtl none\nf 2 3 4\n");
    let scene = read_files(&[("a.obj", &obj), ("a.mtl", "newmtl unused\nnewmtl red paint\nKd 1 0 0\n")]);
    let mesh = &scene.meshes[0];
    let names: Vec<&str> = mesh.face_materials.iter().map(|id| scene.materials[id.0 as usize].name.as_str()).collect();
    assert_eq!(names, ["grey", "red paint", "red paint", "none"]);
    assert_eq!(scene.objects[0].material, None);
    assert!(scene.warnings[0].contains("a.obj:10: there is no material \"none\""), "{:?}", scene.warnings);
    let bare = read(&format!("{SQUARE}f 1 2 3\nusemtl late\n"));
    let id = bare.objects[0].material.expect("a material");
    assert_eq!((bare.materials[id.0 as usize].name.as_str(), bare.meshes[0].face_materials.len()), ("grey", 0));
}

#[test]
fn triangles_with_a_repeated_corner_are_left_out_with_a_word() {
    let scene = read(&format!("{SQUARE}f 1 2 2 3\n"));
    assert_eq!(scene.meshes[0].triangles.len(), 1);
    assert!(scene.warnings[0].ends_with("triangles with a repeated corner left out: 1"), "{:?}", scene.warnings);
}

#[test]
fn mtl_becomes_the_nearest_model() {
    let lambert = material("Kd 0.1 0.2 0.3\nKs 1 1 1\nillum 1");
    assert_eq!((lambert.model, lambert.color, lambert.k_s), (Model::Lambert, Rgb::new(0.1, 0.2, 0.3), 0.0));
    let blinn = material("Kd 0.5 0.5 0.5\nKs 0.4 0.2 0\nNs 77\nKa 0 0 0\nillum 2");
    assert_eq!(blinn.model, Model::BlinnPhong { exponent: 77.0 });
    assert_eq!((blinn.k_a, blinn.k_s, blinn.k_r), (0.0, 0.4, 0.0));
    assert_eq!(blinn.specular_color, Rgb::new(1.0, 0.5, 0.0));
    assert_eq!(material("Ks 0.5 0.5 0.5\nillum 3").k_r, 0.5);
    let glass = material("Ni 1.5\nTf 1 0.5 1\nillum 6");
    assert_eq!(glass.model, Model::Dielectric { eta: 1.5, absorption: Rgb::ZERO });
    assert_eq!((glass.specular_color, glass.transparency), (Rgb::new(1.0, 0.5, 1.0), None));
    assert_eq!(material("d 0.25").transparency, Some(Transparency::Interpolated { k_t: 0.75 }));
    assert_eq!(material("Tr 0.25").transparency, Some(Transparency::Interpolated { k_t: 0.25 }));
    assert_eq!(material("d -halo 0.5").transparency, Some(Transparency::Interpolated { k_t: 0.5 }));
    assert_eq!(material("Ke 3 2 1").emission, Rgb::new(3.0, 2.0, 1.0));
    assert_eq!(material("Kd 1 1 1\nillum 0").model, Model::Emissive);
    assert_eq!(material("Kd 7 -1 0.5").color, Rgb::new(1.0, 0.0, 0.5), "a reflectance is 0 to 1");
}

#[test]
fn map_kd_reads_its_options_and_a_missing_image_is_a_warning() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let image = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/textures/checker.png");
    fs::copy(image, folder.path().join("my map.png")).expect("copied");
    let file = folder.path().join("a.obj");
    fs::write(&file, "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n")
        .expect("writable");
    let mtl = "newmtl m\nKd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 -bm 1 -clamp on my map.png\nnewmtl n\nKd 0.5 0.5 0.5\nmap_Kd no.png\nmap_Ka x.png\n";
    fs::write(folder.path().join("a.mtl"), mtl).expect("writable");
    let scene = obj::load(&file).unwrap_or_else(|error| panic!("{error}"));
    let texture = &scene.textures[0];
    assert_eq!((texture.scale, texture.offset), ([2.0, 3.0], [0.5, 0.0]));
    assert_eq!((texture.wrap_u, texture.wrap_v), (Wrap::Clamp, Wrap::Clamp));
    assert_eq!(
        (scene.materials[0].color, scene.materials[0].texture(Parameter::Color)),
        (Rgb::ONE, Some(TextureId(0)))
    );
    assert_eq!((scene.materials[1].color, scene.materials[1].texture(Parameter::Color)), (Rgb::splat(0.5), None));
    let warnings = scene.warnings.join("\n");
    assert!(warnings.contains("ignored: map_Ka") && warnings.contains("a.mtl:6: no texture: "), "{warnings}");
}

#[test]
fn a_missing_library_is_a_warning() {
    let scene = read(&format!("mtllib no.mtl\n{SQUARE}f 1 2 3\n"));
    assert!(scene.warnings[0].contains("a.obj:1: no materials from "), "{:?}", scene.warnings);
}

#[test]
fn the_collected_obj_files_load_with_the_triangles_they_are_known_for() {
    let Some(assets) = asset("") else { return };
    // Counts from the assets' README; with Kd maps: textures.
    for (name, triangles, textures) in [
        ("kitchen/kitchen.obj", 56_939, 0),
        ("sponza-dabrovic/obj/sponza.obj", 66_445, 10),
        ("cornell/obj-mtl/cornell_box.obj", 3_968, 0),
        ("meshes/spot.obj", 5_856, 0),
        ("meshes/stanford-bunny.obj", 69_451, 0),
        ("meshes/suzanne.obj", 968, 0),
        ("meshes/teapot.obj", 6_320, 0),
    ] {
        let start = std::time::Instant::now();
        let scene = obj::load(&assets.join(name)).unwrap_or_else(|error| panic!("{error}"));
        println!("{name}: {:.0} ms, {:?}", start.elapsed().as_secs_f64() * 1e3, scene.warnings);
        let mesh = &scene.meshes[0];
        assert_eq!((mesh.triangles.len(), scene.textures.len()), (triangles, textures), "{name}");
        assert!(mesh.normals.len() == mesh.positions.len(), "{name} is shaded smoothly");
        assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{name}: unit normals");
        assert!(mesh.triangles.iter().flatten().all(|corner| (*corner as usize) < mesh.positions.len()));
    }
}
