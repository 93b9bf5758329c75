//! Broken models: each is an error that names its file and the place within it, or is accepted for a stated reason.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use gonio::scene::load::image::{ColorSpace, texture_from_bytes};
use gonio::scene::load::{gltf, ply};
use std::path::{Path, PathBuf};

fn files_with(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files_with(&path, extensions));
        } else if path.extension().is_some_and(|e| extensions.iter().any(|x| e == *x)) {
            found.push(path);
        }
    }
    found
}

#[test]
fn every_broken_ply_of_the_assets_is_refused_with_its_name() {
    let Some(folder) = asset("negative/obj-ply") else {
        return;
    };
    let files = files_with(&folder, &["ply"]);
    assert!(files.len() >= 6);
    for file in files {
        let message = ply::load(&file).expect_err("a broken file").to_string();
        assert!(message.starts_with(&file.display().to_string()), "{message}");
        println!("{message}");
    }
}

#[test]
fn every_broken_gltf_of_the_assets_is_refused_with_its_name() {
    let Some(folder) = asset("negative/gltf") else {
        return;
    };
    let files = files_with(&folder, &["gltf", "glb"]);
    assert!(files.len() >= 12);
    for file in files {
        let message = gltf::load(&file).expect_err(&file.display().to_string()).to_string();
        assert!(message.starts_with(&folder.display().to_string()), "{message}");
        println!("{message}");
    }
}

const VERTEX: &str = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const FACE: &str = "element face 1\nproperty list uchar int vertex_indices\n";
const POINTS: &str = "0 0 0\n1 0 0\n0 1 0\n";

#[test]
fn broken_text_ply_is_refused_with_its_line() {
    let ascii = |rest: &str| format!("ply\nformat ascii 1.0\n{rest}");
    let body = |face: &str| ascii(&format!("{VERTEX}{FACE}end_header\n{POINTS}{face}"));
    let cases: Vec<(String, u32, &str)> = vec![
        (String::new(), 1, "no end_header"),
        ("plx\n".into(), 1, "first line is not `ply`"),
        ("ply\nformat ascii 1.0\n".into(), 3, "no end_header"),
        ("ply\nelement vertex 3\nend_header\n".into(), 3, "no format line"),
        ("ply\nformat text 1.0\nend_header\n".into(), 2, "unknown format `text`"),
        ("ply\nformat ascii 2.0\nend_header\n".into(), 2, "version 2.0"),
        (ascii("element vertex -3\nend_header\n"), 3, "`-3` is not a count"),
        (ascii("element vertex 99999999999999999999\nend_header\n"), 3, "is not a count"),
        (ascii("property float x\nend_header\n"), 3, "before the first element"),
        (ascii("element vertex 3\nproperty real x\nend_header\n"), 4, "unknown type `real`"),
        (ascii("element face 1\nproperty list float int vertex_indices\nend_header\n"), 4, "integer type"),
        (ascii("element face 1\nproperty list uchar int\nend_header\n"), 4, "a property is"),
        (ascii("elephant vertex 3\nend_header\n"), 3, "unknown header line"),
        (ascii("element vertex 3\nproperty float x\nproperty float y\nend_header\n1 2\n1 2\n1 2\n"), 6, "x, y, z"),
        (
            ascii(&format!("{VERTEX}element face 1\nproperty int a\nend_header\n{POINTS}3\n")),
            9,
            "no list vertex_indices",
        ),
        (ascii(&format!("{VERTEX}end_header\n{POINTS}")), 7, "no faces"),
        (body(""), 12, "1 items of at least 2 bytes, but only 0 bytes follow"),
        (body("3 0 1\n"), 13, "the line ends before property `vertex_indices`"),
        (body("3 0 1 2 4\n"), 13, "`4` follows the last property"),
        (body("3 0 1 3\n"), 13, "vertex 3 of 3"),
        (body("3 0 1 -1\n"), 13, "-1 is not the index"),
        (body("3 0 1 x\n"), 13, "`x` is not a number"),
        (body("3 0 1 1.5\n"), 13, "`1.5` is not an integer"),
        (body("2 0 1\n"), 9, "no faces to draw, only 1 without three different corners"),
        (body("3 0 1 1\n"), 9, "no faces to draw, only 1 without three different corners"),
        (body("-1 0 1\n"), 13, "has -1 items"),
        (body("4000000000 0 1\n"), 13, "the line ends"),
        (body("3 0 1 2\n").replace("1 0 0\n", "1 nan 0\n"), 11, "not finite"),
        (body("3 0 1 2\n").replace("vertex 3", "vertex 4000000000"), 9, "element vertex claims 4000000000 items"),
        (
            ascii(&format!(
                "element face 1\nproperty list uchar int vertex_indices\n{VERTEX}end_header\n3 0 1 9\n{POINTS}"
            )),
            10,
            "vertex 9 of 3",
        ),
    ];
    for (text, line, expected) in cases {
        let message = ply::mesh_from_bytes(text.as_bytes(), Path::new("bad.ply")).expect_err(&text).to_string();
        // The line within the body counts the header; see each case.
        assert!(message.contains(expected), "{message}\n{text}");
        assert!(message.starts_with(&format!("bad.ply:{line}: ")), "{message}, expected line {line}\n{text}");
    }
}

#[test]
fn broken_binary_ply_is_refused_with_its_byte() {
    let header = format!("ply\nformat binary_little_endian 1.0\n{VERTEX}{FACE}end_header\n");
    let file = |bytes: &[u8]| [header.as_bytes(), &[0u8; 36], bytes].concat();
    let start = header.len() + 36;
    let cases: Vec<(Vec<u8>, usize, &str)> = vec![
        (header.clone().into_bytes(), header.len(), "3 items of at least 12 bytes, but only 0 bytes follow"),
        (file(&[]), start, "element face claims"),
        (file(&[3, 0, 0]), start, "runs over the end"),
        (file(&[255; 13]), start, "255 items runs over the end"),
        (file(&[3, 0, 0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0]), start, "vertex 3 of 3"),
        (file(&[3, 0, 0, 0, 0, 1, 0, 0, 0, 255, 255, 255, 255]), start, "-1 is not the index"),
    ];
    for (bytes, at, expected) in cases {
        let message = ply::mesh_from_bytes(&bytes, Path::new("bad.ply")).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}");
        assert!(message.starts_with(&format!("bad.ply: byte {at}: ")), "{message}, expected byte {at}");
    }
    let message = ply::mesh_from_bytes(&file(&[0]), Path::new("bad.ply")).expect_err("no face").to_string();
    assert_eq!(message, "bad.ply:9: the file has no faces to draw, only 1 without three different corners");
}

#[test]
fn ply_element_without_properties_takes_no_time_however_many_there_are() {
    let text = format!(
        "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\n{VERTEX}{FACE}end_header\n{POINTS}3 0 1 2\n"
    );
    assert!(ply::mesh_from_bytes(text.as_bytes(), Path::new("odd.ply")).is_ok());
}

#[test]
fn ply_cut_off_or_changed_anywhere_never_panics() {
    let text = format!("ply\nformat ascii 1.0\n{VERTEX}{FACE}end_header\n{POINTS}3 0 1 2\n");
    let binary = [
        format!("ply\nformat binary_big_endian 1.0\n{VERTEX}{FACE}end_header\n").as_bytes(),
        &[0u8; 36],
        &[3, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2],
    ]
    .concat();
    for good in [text.as_bytes(), &binary] {
        assert!(ply::mesh_from_bytes(good, Path::new("good.ply")).is_ok());
        for at in 0..good.len() {
            let _ = ply::mesh_from_bytes(&good[..at], Path::new("cut.ply"));
            for value in [0, b' ', b'9', b'-', 0x7f, 0xff] {
                let mut changed = good.to_vec();
                changed[at] = value;
                let _ = ply::mesh_from_bytes(&changed, Path::new("changed.ply"));
            }
        }
    }
}

/// A valid glTF triangle; each case replaces a part of it.
const TRIANGLE: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"buffers": [{"byteLength": 42, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]}"#;

#[test]
fn broken_gltf_is_refused_with_the_place_in_the_document() {
    let good = gltf::scene_from_bytes(TRIANGLE.as_bytes(), Path::new("good.gltf")).expect("valid");
    assert_eq!(good.meshes[0].triangles, [[0, 1, 2]]);
    let material = |text: &str| {
        format!(
            r#""scene": 0, "materials": [{text}], "images": [{{"uri": "data:,x"}}], "textures": [{{"source": 0}}, {{"source": 7}}],"#
        )
    };
    let texture = |text: &str| material(&format!(r#"{{"pbrMetallicRoughness": {{"baseColorTexture": {text}}}}}"#));
    let indexed = r#""indices": 1"#;
    let cases: Vec<(&str, String, &str)> = vec![
        (r#""version": "2.0""#, r#""version": "1.0""#.into(), "bad.gltf: asset: version 1.0"),
        (r#""version": "2.0""#, r#""version": "2.1", "minVersion": "2.1""#.into(), "bad.gltf: asset: version 2.1"),
        (r#""asset": {"version": "2.0"},"#, String::new(), "missing field `asset`"),
        (r#""scene": 0,"#, r#""scene": 3,"#.into(), "scene: is 3; there are 1"),
        (r#"{"nodes": [0]}"#, r#"{"nodes": [5]}"#.into(), "scenes: refers to node 5"),
        (r#"{"nodes": [0]}"#, r#"{"nodes": [0, 0]}"#.into(), "nodes[0]: is in the scene twice"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 4}"#.into(), "nodes[0]: refers to mesh 4; there are 1"),
        (r#"{"mesh": 0}"#, r#"{"camera": 4}"#.into(), "nodes[0]: refers to camera 4"),
        (r#"{"mesh": 0}"#, r#"{"children": [9]}"#.into(), "nodes[0].children: refers to node 9"),
        (r#"{"mesh": 0}"#, r#"{"children": [0]}"#.into(), "nodes[0]: is in a cycle"),
        (r#"{"mesh": 0}"#, r#"{"children": [1]}, {"children": [1]}"#.into(), "nodes[1].children: node 1 is also"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 0, "translation": [1e999, 0, 0]}"#.into(), "number out of range"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 0, "scale": [1e39, 1, 1]}"#.into(), "nodes[0]: its transform is not finite"),
        (r#"{"mesh": 0}"#, r#"{"extensions": {"KHR_lights_punctual": {"light": 0}}}"#.into(), "nodes[0]: refers to light 0"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": "x"}}}}"#.into(), "SCALE is not the index"),
        (r#""POSITION": 0"#, r#""POSITION": 8"#.into(), "meshes[0].primitives[0].attributes.POSITION: refers to accessor 8"),
        (r#""POSITION": 0"#, r#""POSITION": 1"#.into(), "accessors[1]: meshes[0].primitives[0].attributes.POSITION needs 3 numbers"),
        (r#""POSITION": 0"#, r#""POSITION": 0, "NORMAL": 8"#.into(), "attributes.NORMAL: refers to accessor 8"),
        (indexed, r#""indices": 0"#.into(), "accessors[0]: meshes[0].primitives[0].indices needs single unsigned integers"),
        (indexed, r#""indices": 1, "mode": 9"#.into(), "meshes[0].primitives[0]: unknown mode"),
        (indexed, r#""indices": 1, "material": 2"#.into(), "meshes[0].primitives[0]: refers to material 2"),
        (indexed, r#""indices": 1, "extensions": {"KHR_draco_mesh_compression": {}}"#.into(), "compressed by KHR_draco"),
        (r#""byteLength": 42"#, r#""byteLength": 43"#.into(), "buffers[0]: claims 43 bytes; there are 42"),
        (r#""byteLength": 42"#, r#""byteLength": 40"#.into(), "bufferViews[1]: 6 bytes from 36 run over the end of buffer 0, which has 40"),
        ("data:;base64,AAAA", "data:;base64,?AAA".into(), "buffers[0]: the data URI is not base64"),
        ("data:;base64,AAAA", "data:;base64;AAAA".into(), "buffers[0]: the data URI has no comma"),
        ("data:;base64,AAAA", "ftp://there/AAAA".into(), "buffers[0]: cannot read URIs of scheme `ftp`"),
        (r#""byteLength": 36}"#, r#""byteLength": 18446744073709551615}"#.into(), "bufferViews[0]: 18446744073709551615 bytes"),
        (r#""buffer": 0, "byteLength": 36"#, r#""buffer": 3, "byteLength": 36"#.into(), "bufferViews[0]: refers to buffer 3"),
        (r#""byteLength": 36}"#, r#""byteLength": 36, "byteStride": 4}"#.into(), "accessors[0]: elements of 12 bytes, but a stride of 4"),
        (r#"5126, "count": 3"#, r#"5126, "count": 4"#.into(), "accessors[0]: 4 elements from byte 0 run over the end"),
        (r#"5126, "count": 3"#, r#"5126, "count": 18446744073709551615"#.into(), "accessors[0]: 18446744073709551615 elements"),
        (r#"5126, "count": 3"#, r#"5126, "count": 2"#.into(), "meshes[0].primitives[0].indices: index 2 at 2; there are 2"),
        (r#""bufferView": 0, "componentType": 5126, "count": 3"#, r#""componentType": 5126, "count": 4000000000"#.into(), "accessors[0]: 4000000000 elements without a bufferView"),
        (r#""bufferView": 0, "componentType": 5126"#, r#""bufferView": 0, "componentType": 5127"#.into(), "accessors[0]: unknown type"),
        (r#""bufferView": 0, "componentType": 5126"#, r#""bufferView": 6, "componentType": 5126"#.into(), "accessors[0]: refers to bufferView 6"),
        (r#""count": 3, "type": "VEC3""#, r#""count": 3, "type": "VEC3", "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 1}}"#.into(), "accessors[0]: 2 sparse elements run over the end"),
        (r#""count": 3, "type": "VEC3""#, r#""count": 3, "type": "VEC3", "sparse": {"count": 1, "indices": {"bufferView": 0, "byteOffset": 15, "componentType": 5121}, "values": {"bufferView": 0}}"#.into(), "accessors[0]: sparse element 63 of 3"),
        (r#""scene": 0,"#, r#""scene": 0, "extensionsRequired": ["KHR_lights_punctual", "XYZ_magic"],"#.into(), "extensionsRequired: not supported: XYZ_magic"),
        (indexed, r#""indices": 1, "material": 0"#.into(), "refers to material 0"),
        (r#""scene": 0,"#, texture(r#"{"index": 9}"#), "materials[0]: refers to texture 9"),
        (r#""scene": 0,"#, texture(r#"{"index": 1}"#), "textures[1]: has no image, or one of 1 that is not there"),
        (r#""scene": 0,"#, texture(r#"{"index": 0}"#), "images[0]: not a picture"),
        (r#""scene": 0,"#, material(r#"{"alphaMode": "SOLID"}"#), "materials[0]: unknown alphaMode"),
        (r#""meshes""#, "\"meshes\"\n]".into(), "bad.gltf:3:"),
    ];
    for (from, to, expected) in cases {
        let mut text = TRIANGLE.replacen(from, &to, 1);
        assert_ne!(text, TRIANGLE, "{from} is not in the document");
        if to.contains("\"materials\"") {
            text = text.replacen(indexed, r#""indices": 1, "material": 0"#, 1);
        }
        let message = match gltf::scene_from_bytes(text.as_bytes(), Path::new("bad.gltf")) {
            Ok(_) => panic!("accepted: {to}"),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(expected) && message.starts_with("bad.gltf"), "{message}, expected {expected}");
    }
}

#[test]
fn gltf_that_names_a_missing_file_names_it_and_itself_in_the_error() {
    let text = TRIANGLE.replace("data:;base64,AAAA", "not%20there.bin?");
    let message =
        gltf::scene_from_bytes(text.as_bytes(), Path::new("folder/bad.gltf")).expect_err("missing").to_string();
    assert!(message.starts_with("folder/bad.gltf: buffers[0]: folder/not there.bin?"), "{message}");
}

#[test]
fn broken_glb_is_refused() {
    let chunk = |kind: &[u8; 4], data: &[u8]| [&(data.len() as u32).to_le_bytes()[..], kind, data].concat();
    let glb = |version: u32, length: u32, rest: &[u8]| {
        [&b"glTF"[..], &version.to_le_bytes(), &length.to_le_bytes(), rest].concat()
    };
    let json = chunk(b"JSON", br#"{"asset":{"version":"2.0"}}"#);
    let whole = 12 + json.len() as u32;
    let cases = [
        (b"glTF".to_vec(), "GLB header: the file ends"),
        (glb(1, whole, &json), "GLB header: version 1"),
        (glb(2, whole + 1, &json), "GLB header: claims"),
        (glb(2, 0, &[]), "there is no JSON chunk"),
        (glb(2, 12, &[]), "there is no JSON chunk"),
        (glb(2, 16, &[0; 4]), "GLB chunk at byte 12: the file ends"),
        (glb(2, 20, &[255; 8]), "GLB chunk at byte 12: claims 4294967295 bytes; 0 follow"),
        (glb(2, 12 + 9, &chunk(b"BIN\0", &[0])), "there is no JSON chunk"),
        (glb(2, 12 + 9, &chunk(b"JSON", b"{")), "bad.glb:1:1"),
    ];
    for (bytes, expected) in cases {
        let message = gltf::scene_from_bytes(&bytes, Path::new("bad.glb")).expect_err(expected).to_string();
        assert!(message.contains(expected), "{message}, expected {expected}");
    }
    // Nothing to draw is no error: the file may be a library of materials. It is said.
    let scene = gltf::scene_from_bytes(&glb(2, whole, &json), Path::new("empty.glb")).expect("valid");
    assert!(scene.warnings.iter().any(|w| w == "there is nothing to draw"));
}

#[test]
fn gltf_cut_off_or_changed_anywhere_never_panics() {
    let good = TRIANGLE.as_bytes();
    for at in 0..good.len() {
        let _ = gltf::scene_from_bytes(&good[..at], Path::new("cut.gltf"));
        for value in [b'0', b'9', b'-', b'"', b'A', 0xff] {
            let mut changed = good.to_vec();
            changed[at] = value;
            let _ = gltf::scene_from_bytes(&changed, Path::new("changed.gltf"));
        }
    }
}

#[test]
fn deeply_nested_gltf_is_refused_and_a_long_chain_of_nodes_is_not() {
    let nested =
        format!(r#"{{"asset": {{"version": "2.0", "extras": {}1{}}}}}"#, "[".repeat(100_000), "]".repeat(100_000));
    assert!(gltf::scene_from_bytes(nested.as_bytes(), Path::new("deep.gltf")).is_err());
    let chain: Vec<String> = (1..20_000).map(|i| format!(r#"{{"children": [{i}]}}"#)).collect();
    let text = TRIANGLE.replace(r#"{"mesh": 0}"#, &format!(r#"{}, {{"mesh": 0}}"#, chain.join(", ")));
    let scene = gltf::scene_from_bytes(text.as_bytes(), Path::new("long.gltf")).expect("valid");
    assert_eq!(scene.objects[0].name, "nodes[19999]");
}

#[test]
fn broken_pictures_are_refused_with_their_name() {
    let huge = |kind: &[u8]| {
        // A PNG header that claims 60,000 x 60,000 texels and ends.
        let mut bytes = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x06\0\0\0".to_vec();
        bytes.extend(kind);
        bytes
    };
    let cases: [(Vec<u8>, &str); 5] = [
        (Vec::new(), "not a picture"),
        (b"hello".to_vec(), "not a picture"),
        (b"\x89PNG\r\n\x1a\n".to_vec(), "cannot decode"),
        (huge(&[0x38, 0x4f, 0x5b, 0x5a]), "bad.png"),
        (b"\x76\x2f\x31\x01\x02\0\0\0".to_vec(), "cannot decode"),
    ];
    for (bytes, expected) in cases {
        let message =
            texture_from_bytes(&bytes, Path::new("bad.png"), ColorSpace::Srgb).expect_err(expected).to_string();
        assert!(message.starts_with("bad.png: ") && message.contains(expected), "{message}");
    }
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n";
    let message = texture_from_bytes(hdr, Path::new("bad.hdr"), ColorSpace::Srgb).expect_err("too large").to_string();
    assert!(message.contains("a picture of 60000 x 60000; allowed are"), "{message}");
}
