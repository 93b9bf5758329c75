//! Forms of OBJ and MTL that programs write: each means what the plain form means.

use super::support::{Folder, SIDE, load_one, look, mean, near};
use glam::Vec3;
use gonio::scene::{Integrator, Parameter, Rgb, Scene};

const VERTICES: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
const UVS: &str = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const FACE: &str = "f 1/1 2/2 3/3 4/4\n";
const HEAD: &str = "mtllib m.mtl\nusemtl m\n";
const MTL: &str = "newmtl m\nillum 0\nKd 1 1 1\nmap_Kd t.png\n";

/// sRGB codes of the linear values 0, .25, .5 and 1.
const TEXELS: [[u8; 4]; 4] = [[0, 0, 0, 255], [137, 137, 137, 255], [188, 188, 188, 255], [255; 4]];

/// The picture of a unit square with a 2 x 2 texture, at the middles of its texels from the upper left.
#[track_caller]
fn shown(obj: impl AsRef<[u8]>, mtl: &[u8], mtl_name: &str) -> [f32; 4] {
    let folder = Folder::new(&[("o.obj", obj.as_ref()), (mtl_name, mtl)]);
    folder.picture("t.png", 2, &TEXELS);
    folder.picture("sub dir/my tex.png", 2, &TEXELS);
    let picture = look(folder.load("o.obj"), Integrator::Local, 0.0, 1);
    let (low, high) = (SIDE / 4 - 1..SIDE / 4 + 1, 3 * SIDE / 4 - 1..3 * SIDE / 4 + 1);
    let at = |x: &std::ops::Range<usize>, y: &std::ops::Range<usize>| mean(&picture, x.clone(), y.clone()).x;
    [at(&low, &low), at(&high, &low), at(&low, &high), at(&high, &high)]
}

#[track_caller]
fn shows(expected: [f32; 4], obj: impl AsRef<[u8]>, mtl: impl AsRef<[u8]>, mtl_name: &str) {
    let found = shown(obj, mtl.as_ref(), mtl_name);
    let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    // Between the middles of texels, half a pixel away, their values mix.
    assert!(error < 0.05, "{found:?}, expected {expected:?}");
}

const PLAIN: [f32; 4] = [0.0, 0.25, 0.5, 1.0];

#[test]
fn every_form_of_an_obj_gives_the_same_picture() {
    let whole = format!("{HEAD}{VERTICES}{UVS}{FACE}");
    let cases = [
        whole.clone(),
        format!("{HEAD}{VERTICES}{UVS}f -4/-4 -3/-3 -2/-2 -1/-1\nv 9 9 9\nvt .3 .3\n"),
        format!("{HEAD}{VERTICES}{UVS}f +1/-4 -3/2 3/3 -1/+4\n"),
        format!("{HEAD}{VERTICES}{UVS}f 1/1 2/2 \\\n3/3 \\\n  4/4\n"),
        whole.replace("v -1 -1 0", "v -1 \\\n-1 0"),
        whole.replace('\n', "  \r\n").replace(' ', "\t"),
        whole.replace('\n', "\r"),
        format!("\u{feff}{whole}"),
        format!(
            "{HEAD}v -1.0e+00 -1E0 0\nv +1 -1. 0 1.0\nv 1 1 -0\nv -1 .1e1 0\n{}{FACE}",
            UVS.replace('\n', " 0.0\n")
        ),
        format!("{HEAD}{VERTICES}{UVS}f 1/1/ 2/2/ 3/3/ 4/4/\n"),
        format!("{HEAD}{VERTICES}{UVS}v 5 5 5\nv 6 5 5\nv 6 6 5\nvn 0 0 1\nf 5 6 7\nf 5//1 6//1 7//1\n{FACE}"),
        format!("# head\no a b c\ng x y\ns 1\n{HEAD}{VERTICES}{UVS}# f 1 2 3\nfo 1/1 2/2 3/3 4/4 # tail\n"),
        whole.to_uppercase().replace("M.MTL", "m.mtl").replace("USEMTL M", "USEMTL m"),
        whole.replace("m.mtl", "\"m.mtl\"").replace("usemtl m", "usemtl \"m\""),
        whole.replace("m.mtl", ".\\m.mtl"),
        whole.replace("m.mtl", "C:\\models of mine\\m.mtl"),
        whole.replace("m.mtl", "absent.mtl m.mtl"),
        whole.replace("m.mtl", "\"absent one.mtl\" \"m.mtl\""),
        format!("{VERTICES}{UVS}usemtl m\n{FACE}mtllib m.mtl\n"),
        format!("{HEAD}usemtl \n{HEAD}{VERTICES}{UVS}{FACE}"),
        format!("{HEAD}xyzzy 1 2 3\n{VERTICES}{UVS}{FACE}"),
        format!("{HEAD}{VERTICES}{UVS}l 1 2\np 1\n{FACE}"),
    ];
    for obj in cases {
        println!("{}", obj.escape_debug());
        shows(PLAIN, &obj, MTL, "m.mtl");
    }
}

#[test]
fn every_form_of_an_mtl_gives_the_same_picture() {
    let obj = format!("{HEAD}{VERTICES}{UVS}{FACE}");
    let map = |text: &str| MTL.replace("map_Kd t.png", text);
    let cases = [
        map("map_Kd sub dir/my tex.png"),
        map("map_Kd sub dir\\my tex.png"),
        map("map_Kd ./t.png"),
        map("map_Kd \"t.png\""),
        map("map_Kd \"sub dir/my tex.png\" -s 1 1"),
        map("map_Kd D:\\textures\\of mine\\t.png"),
        map("map_Kd -s 1 1 1 -o 0 0 0 -clamp on -texres 256 t.png"),
        map("map_Kd t.png -s 1 1 1"),
        map("\tmap_kd t.png").replace("illum", "\tillum"),
        MTL.replace('\n', "\r"),
        MTL.replace('\n', "\r\n"),
        format!("\u{feff}# head\n\n{MTL}"),
        MTL.replace("newmtl m", "NEWMTL \"m\"").replace("Kd 1", "KD 1").replace("illum", "ILLUM"),
    ];
    for mtl in cases {
        println!("{}", mtl.escape_debug());
        shows(PLAIN, &obj, &mtl, "m.mtl");
    }
    shows([0.25, 0.0, 1.0, 0.5], &obj, map("map_Kd -o 0.5 t.png"), "m.mtl");
    shows([0.0, 0.125, 0.25, 0.5], &obj, map("map_Kd -mm 0 0.5 t.png"), "m.mtl");
    shows([0.5, 0.5625, 0.625, 0.75], &obj, map("map_Kd t.png -mm 0.5 0.25"), "m.mtl");
    let spaced = obj.replace("m.mtl", "my lib.mtl").replace("usemtl m", "usemtl my mat");
    shows(PLAIN, spaced, MTL.replace("newmtl m", "newmtl my mat"), "my lib.mtl");
}

#[test]
fn names_in_latin_1_are_names() {
    let latin = |text: &str| text.chars().map(|c| c as u8).collect::<Vec<u8>>();
    let obj = latin(&format!("mtllib m.mtl\nusemtl mü\n{VERTICES}{UVS}{FACE}"));
    // Both would be the same unknown character if they were read as UTF-8.
    let mtl = latin(&format!("newmtl mö\nKd 0 0 0\n{}", MTL.replace("newmtl m", "newmtl mü")));
    shows(PLAIN, obj, mtl, "m.mtl");
}

fn two_faces(first: &str, second: &str, mtl: &str) -> Scene {
    let vertices = "v -1 -1 0\nv 1 -1 0\nv 1 0 0\nv -1 0 0\nv 1 1 0\nv -1 1 0\n";
    let obj = format!("mtllib m.mtl\n{vertices}{first}\nf 1 2 3 4\n{second}\nf 4 3 5 6\n");
    Folder::new(&[("o.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())]).load("o.obj")
}

#[test]
fn a_material_without_a_name_is_none_or_the_one_that_has_none() {
    let blue = "newmtl blue\nillum 0\nKd .25 .5 1\n";
    for none in ["usemtl", "usemtl ", "usemtl\t\r", "USEMTL # none", "usemtl \"\""] {
        let scene = two_faces(none, "usemtl blue", blue);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        let mesh = &scene.meshes[0];
        let [low, high] = [0, 2].map(|face| &scene.materials[mesh.face_materials[face].0 as usize]);
        assert_eq!((low.color, high.color), (Rgb::splat(0.7), Rgb::new(0.25, 0.5, 1.0)), "{none:?}");
    }
    let back = two_faces("usemtl blue", "usemtl", blue);
    let color = |scene: &Scene, face: usize| scene.materials[scene.meshes[0].face_materials[face].0 as usize].color;
    assert_eq!((color(&back, 0), color(&back, 2)), (Rgb::new(0.25, 0.5, 1.0), Rgb::splat(0.7)));
    let named = two_faces("usemtl", "usemtl blue", &format!("newmtl \nillum 0\nKd 1 0 0\n{blue}"));
    assert_eq!((color(&named, 0), color(&named, 2)), (Rgb::X, Rgb::new(0.25, 0.5, 1.0)));
    near(mean(&look(named, Integrator::Local, 0.0, 1), 4..28, 20..28), Vec3::X, 1e-4);
}

#[test]
fn what_is_ignored_is_said_once() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let scene = load_one("a.obj", format!("xyzzy\nl 1 2\nXYZZY 3\n{triangle}l 2 3\n"));
    assert_eq!(scene.warnings.len(), 1);
    assert!(scene.warnings[0].ends_with("a.obj: ignored: xyzzy, l"), "{:?}", scene.warnings);
    let many: String = (0..1000).map(|i| format!("key{i}\u{1b} 1\n")).collect();
    let scene = load_one("a.obj", format!("{many}{triangle}"));
    let expected = (0..8).map(|i| format!("key{i}\\u{{1b}}")).collect::<Vec<_>>().join(", ");
    assert!(scene.warnings[0].ends_with(&format!("ignored: {expected} and more")), "{:?}", scene.warnings);
    let folder = Folder::new(&[
        ("a.obj", format!("mtllib a.mtl\nusemtl m\n{triangle}usemtl m\nf 1 2 3\n").as_bytes()),
        ("a.mtl", b"newmtl m\nKd 1 0 0\nsharpness 3\nmap_Ka a.png\nSharpness 4\nmap_ka b.png\n"),
    ]);
    let scene = folder.load("a.obj");
    assert!(
        scene.warnings.len() == 1
            && scene.warnings[0].ends_with("a.mtl: ignored: sharpness, map_Ka, Sharpness, map_ka"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn bad_lines_are_refused_at_their_place() {
    let cases = [
        ("v 0 0 0\rv 1 x 0\r", "a.obj:2:5: expected a number, found \"x\""),
        ("v 0 0 0\nf 1 2/ 3\n", "a.obj:2:5: there is no vertex 2: the file has 1 so far"),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "a.obj:2:3: there is no texture coordinate 1: the file has 0 so far"),
        (
            "v 0 0 0\nvt 0\nvn 0 0 1\nf 1/1/1/1 1 1\n",
            "a.obj:4:3: a corner is v, v/vt, v//vn or v/vt/vn, found \"1/1/1/1\"",
        ),
        ("v 0 0 0\nf 1x 1 1\n", "a.obj:2:3: expected the index of a vertex, found \"1x\""),
        ("v 0 0 0\nvt 0\nf 1 1 1/1.5\n", "a.obj:3:7: expected the index of a texture coordinate, found \"1.5\""),
        ("v 0 0 0\nf /1 1 1\n", "a.obj:2:3: expected the index of a vertex, found \"\""),
        ("v 0 0 0\nf - 1 1\n", "a.obj:2:3: expected the index of a vertex, found \"-\""),
        (
            "v 0 0 0\nf 1 1 18446744073709551617\n",
            "a.obj:2:7: expected the index of a vertex, found \"18446744073709551617\"",
        ),
        ("v 0 0 0 1 2 nan\n", "a.obj:1:13: \"nan\" is NaN, which is no number"),
    ];
    for (text, expected) in cases {
        let message = Folder::new(&[("a.obj", text.as_bytes())]).refused("a.obj");
        assert!(message.starts_with(expected), "{message}, expected {expected}");
    }
    let triangle = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    for (text, expected) in [
        ("Kd 1 0 0\n", "a.mtl:1:1: \"Kd\" comes before any \"newmtl\""),
        ("newmtl m\nKd 1 0\nPr x\n", "a.mtl:3:4: expected a number, found \"x\""),
        ("newmtl m\nKd 1 0 red\n", "a.mtl:2:8: expected a number, found \"red\""),
        ("newmtl m\nmap_Kd # t.png\n", "a.mtl:2:1: \"map_Kd\" needs a file name"),
        ("newmtl m\nillum 11\n", "a.mtl:2:7: \"illum\" must be 0 to 10, found \"11\""),
        ("newmtl m\nd\n", "a.mtl:2:1: \"d\" needs a number"),
    ] {
        let folder = Folder::new(&[("a.obj", triangle.as_bytes()), ("a.mtl", text.as_bytes())]);
        let message = folder.refused("a.obj");
        assert!(message.starts_with(expected), "{message}, expected {expected}");
    }
}

#[test]
fn a_texture_that_is_not_there_is_a_warning_and_the_factor_stays() {
    let obj = format!("{HEAD}{VERTICES}{UVS}{FACE}");
    let mtl = "newmtl m\nillum 2\nKd .5 .25 1\nmap_Kd no.png\nmap_Ks no.png\nKs .5 .5 .5\nmap_d no.png\nd .5\nKe 1 0 0\nmap_Ke no.png\nmap_Bump no.png\n";
    let folder = Folder::new(&[("o.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes()), ("no.gif", b"x")]);
    let scene = folder.load("o.obj");
    let material = &scene.materials[0];
    assert_eq!(
        (material.color, material.emission, material.k_s),
        (Rgb::new(0.5, 0.25, 1.0) / (1.0 + 0.5 * 8.0 / 34.0), Rgb::X, 0.5 / (1.0 + 0.5 * 8.0 / 34.0))
    );
    assert!(material.textures.is_empty() && material.texture(Parameter::Color).is_none());
    assert_eq!(
        scene.warnings.iter().filter(|w| w.contains("no texture: ") && w.contains("no.png")).count(),
        5,
        "{:?}",
        scene.warnings
    );
    // One that is no picture likewise, and black where a picture was to give the colour becomes white.
    folder.file("no.png", b"hello");
    folder.file("m.mtl", b"newmtl m\nKd 0 0 0\nmap_Kd no.png\n");
    let scene = folder.load("o.obj");
    assert_eq!(scene.materials[0].color, Rgb::ONE);
    assert!(scene.warnings[0].contains("m.mtl:3: no texture: "), "{:?}", scene.warnings);
}

#[test]
fn files_cut_off_or_changed_anywhere_never_panic() {
    let obj = format!(
        "mtllib m.mtl\nv 0 0 0 1 .5 0\n{VERTICES}{UVS}vn 0 0 1\ns 1\nusemtl m\nf 1/1/1 2//1 3/3 \\\n-1\ns off\nusemtl\nf 1 2 3 4 5\n"
    );
    let mtl = "newmtl m\nKd 1 0 .5\nNs 3\nKs 1 1 1\nPr .5\nd .5\nTr 1\nillum 2\nmap_Kd -s 1 2 -mm 0 .5 \"t.png\" -o 1\nmap_d t.png\n";
    let folder = Folder::new(&[]);
    folder.picture("t.png", 2, &TEXELS);
    for (name, good) in [("o.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())] {
        for at in 0..good.len() {
            folder.file("o.obj", obj.as_bytes());
            folder.file("m.mtl", mtl.as_bytes());
            let mut all = vec![good[..at].to_vec()];
            for value in [0, b' ', b'9', b'-', b'\\', b'"', 0xff] {
                let mut changed = good.to_vec();
                changed[at] = value;
                all.push(changed);
            }
            for bytes in all {
                folder.file(name, &bytes);
                if let Ok(scene) = folder.try_load("o.obj") {
                    let mesh = &scene.meshes[0];
                    assert!(mesh.triangles.iter().flatten().all(|v| (*v as usize) < mesh.positions.len()));
                    assert!(mesh.face_materials.iter().all(|id| (id.0 as usize) < scene.materials.len()));
                }
            }
        }
    }
}
