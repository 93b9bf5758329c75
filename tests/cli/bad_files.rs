//! Malformed files that are not text, and those that scenes refer to: as in `bad_text`.

use super::bad_text::{judge, refused, scene_refused};
use super::support::{Folder, SCENE};

const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"buffers": [{"byteLength": 42, "uri": "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
{"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]}"#;

#[test]
fn broken_gltf_is_refused_with_the_place_in_the_document() {
    let folder = Folder::new();
    folder.file("good.gltf", GLTF);
    folder.cpu(&["render", "good.gltf", "-o", "good.png", "--size", "8x6", "--spp", "1"]);
    let cases = [
        (GLTF, "", "bad.gltf:1:", ""),
        (r#""version": "2.0""#, r#""version": "3.0""#, "bad.gltf: asset: ", "version 3.0"),
        (r#"{"mesh": 0}"#, r#"{"mesh": 1}"#, "bad.gltf: nodes[0]: ", "mesh 1"),
        (r#"{"mesh": 0}"#, r#"{"children": [0]}"#, "bad.gltf: nodes[0]: ", "cycle"),
        (
            r#""count": 3, "type": "VEC3""#,
            r#""count": 4000000000, "type": "VEC3""#,
            "bad.gltf: accessors[0]: ",
            "4000000000",
        ),
        (
            r#""bufferView": 0, "componentType": 5126, "count": 3"#,
            r#""componentType": 5126, "count": 4000000000"#,
            "bad.gltf: accessors[0]: ",
            "",
        ),
        (r#""byteLength": 42"#, r#""byteLength": 99999999999"#, "bad.gltf: buffers[0]: ", "99999999999"),
        ("\"meshes\"", "\"meshes\" oops", "bad.gltf:2:", ""),
        (
            r#""scene": 0,"#,
            r#""scene": 0, "extensionsRequired": ["XYZ_magic"],"#,
            "bad.gltf: extensionsRequired: ",
            "XYZ_magic",
        ),
    ];
    for (from, to, place, what) in cases {
        let text = GLTF.replacen(from, to, 1);
        assert_ne!(text, GLTF, "{from}");
        folder.file("bad.gltf", text);
        scene_refused(&folder, "bad.gltf", place, what);
    }
    folder.file("bad.gltf", GLTF.replace("data:;base64,AAAA", "gone.bin?"));
    let args = ["render", "bad.gltf", "-o", "a.png", "--backend", "cpu", "--size", "8x6", "--spp", "1"];
    refused(&folder, &args, 74, "bad.gltf: buffers[0]: gone.bin?", "");
    let picture = r#""images": [{"uri": "gone.png"}], "textures": [{"source": 0}], "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], "scene""#;
    let text = GLTF.replacen("\"scene\"", picture, 1).replace("\"indices\"", "\"material\": 0, \"indices\"");
    folder.file("bad.gltf", text);
    // A texture that is not there is a warning, which names as much.
    let (code, stderr) = judge(&folder, &args);
    assert!(code == 0 && stderr.contains("warn: bad.gltf: images[0]: no texture: gone.png: No such file"), "{stderr}");
    // Version 1 has objects where version 2 has lists.
    folder.file("bad.gltf", r#"{"asset": {"version": "1.0"}, "meshes": {"a": {}}, "scenes": {"b": {}}}"#);
    scene_refused(&folder, "bad.gltf", "bad.gltf: asset: ", "version 1.0; only 2.0 is known");
    folder.file("bad.gltf", GLTF.replace(r#"{"mesh": 0}"#, r#"{"mesh": 0, "scale": [1e-20, 1e-20, 1e-20]}"#));
    scene_refused(&folder, "bad.gltf", "bad.gltf: nodes[0]: object \"nodes[0]\" is too large, too small", "1e10");
}

#[test]
fn broken_glb_is_refused() {
    let folder = Folder::new();
    let header = |length: u32| [&b"glTF"[..], &2u32.to_le_bytes(), &length.to_le_bytes()].concat();
    let cases: [(Vec<u8>, &str); 5] = [
        (Vec::new(), ""),
        (b"glTF".to_vec(), "header"),
        (header(12), "no JSON chunk"),
        (header(u32::MAX), "claims"),
        ([header(20), vec![255; 8]].concat(), "4294967295"),
    ];
    for (bytes, what) in cases {
        folder.file("bad.glb", bytes);
        scene_refused(&folder, "bad.glb", "bad.glb", what);
    }
}

#[test]
fn broken_texture_is_refused_by_name() {
    let folder = Folder::new();
    folder.file("textured.toml", SCENE.replace("color = [0.8, 0.1, 0.1]", "texture = \"t.png\""));
    folder.cpu(&["render", "scene.toml", "-o", "good.png"]);
    let good = folder.bytes("good.png");
    folder.file("t.png", &good);
    folder.cpu(&["render", "textured.toml", "-o", "a.png", "--spp", "1"]);
    // A header that claims 60,000 x 60,000 texels.
    let huge = [&good[..16], &60_000u32.to_be_bytes(), &60_000u32.to_be_bytes(), &good[24..]].concat();
    for bytes in
        [Vec::new(), b"hello".to_vec(), good[..8].to_vec(), good[..40].to_vec(), good[..good.len() / 2].to_vec(), huge]
    {
        folder.file("t.png", bytes);
        let args = ["render", "textured.toml", "-o", "b.png", "--backend", "cpu"];
        refused(&folder, &args, 65, "", "t.png");
    }
    // One that is not there is missed, but not refused.
    std::fs::remove_file(folder.path("t.png")).expect("there");
    let ended = folder.run(&["render", "textured.toml", "-o", "b.png", "--backend", "cpu"]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stderr.starts_with("warn: textured.toml:14:11: no texture: t.png: "), "{}", ended.stderr);
}

#[test]
fn broken_film_is_refused_by_name() {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "good.gfilm"]);
    let good = folder.bytes("good.gfilm");
    let with = |at: usize, byte: u8| {
        let mut bytes = good.clone();
        bytes[at] ^= byte;
        bytes
    };
    let cases: [Vec<u8>; 9] = [
        Vec::new(),
        b"GFILM".to_vec(),
        good[..12].to_vec(),
        good[..good.len() - 1].to_vec(),
        [&good[..], b"x"].concat(),
        with(8, 2),
        with(15, 0xff),
        with(20, 1),
        with(good.len() / 2, 1),
    ];
    for bytes in cases {
        folder.file("bad.gfilm", bytes);
        refused(&folder, &["merge", "bad.gfilm", "-o", "a.png"], 65, "bad.gfilm", "");
        refused(&folder, &["compare", "good.gfilm", "bad.gfilm"], 65, "bad.gfilm", "");
    }
    refused(&folder, &["merge", "absent.gfilm", "-o", "a.png"], 74, "cannot read absent.gfilm", "");
}

#[test]
fn names_that_are_no_scene_are_refused() {
    let folder = Folder::new();
    folder.file("scene.xyz", SCENE);
    folder.file("scene", SCENE);
    std::fs::create_dir(folder.path("folder.obj")).expect("a new folder");
    scene_refused(&folder, "scene.xyz", "scene.xyz: ", "found .xyz");
    scene_refused(&folder, "scene", "scene: ", "no extension");
    std::fs::create_dir(folder.path("folder")).expect("a new folder");
    let render = |name: &'static str| ["render", name, "-o", "a.png", "--backend", "cpu"];
    refused(&folder, &render("folder"), 74, "folder: it is a folder; a scene is a file: .toml", "");
    refused(&folder, &render("folder.obj"), 74, "folder.obj: it is a folder", "");
    for absent in ["absent.toml", "absent.obj", "absent.ply", "absent.gltf", "absent.glb", "folder.obj"] {
        refused(&folder, &["render", absent, "-o", "a.png", "--backend", "cpu"], 74, absent, "");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn endless_film_is_refused_without_being_read_to_its_end() {
    let folder = Folder::new();
    refused(&folder, &["merge", "/dev/zero", "-o", "a.png"], 65, "/dev/zero", "");
    refused(&folder, &["compare", "/dev/zero", "/dev/zero"], 65, "/dev/zero", "");
}

#[cfg(unix)]
#[test]
fn what_a_scene_names_and_is_no_regular_file_is_refused_unread() {
    let folder = Folder::new();
    // Nobody writes to it: who opens it waits for ever.
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe")).status().expect("mkfifo");
    assert!(made.success());
    for alias in ["pipe.toml", "pipe.obj", "pipe.ply", "pipe.gltf", "pipe.xml", "pipe.png"] {
        std::os::unix::fs::symlink("pipe", folder.path(alias)).expect("a link");
    }
    let render = |scene: &'static str| ["render", scene, "-o", "a.png", "--backend", "cpu"];
    for scene in ["pipe.toml", "pipe.obj", "pipe.ply", "pipe.gltf", "pipe.xml"] {
        refused(&folder, &render(scene), 74, scene, "no regular file");
    }
    let color = "color = [0.8, 0.1, 0.1]";
    for (from, to) in [
        (color, "texture = \"pipe.png\""),
        (color, "texture = \"/dev/zero\""),
        ("shape = \"sphere\"", "shape = \"mesh\"\nfile = \"pipe.obj\""),
        ("shape = \"sphere\"", "shape = \"mesh\"\nfile = \"pipe.ply\""),
    ] {
        let text = SCENE.replacen(from, to, 1);
        assert_ne!(text, SCENE, "{from}");
        folder.file("a.toml", text);
        refused(&folder, &render("a.toml"), 74, "a.toml:", "no regular file");
    }
    folder.file(
        "b.gltf",
        GLTF.replacen("data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA", "pipe", 1),
    );
    refused(&folder, &render("b.gltf"), 74, "b.gltf: buffers[0]: pipe: ", "no regular file");
    // Standard input is meant to be a pipe.
    let mut piped = folder.command(&["render", "-", "-o", "a.png", "--backend", "cpu"]);
    assert_eq!(super::support::ended(piped.write_stdin(SCENE)).code, Some(0));
}

#[test]
fn what_takes_more_memory_than_there_is_exits_with_75() {
    let folder = Folder::new();
    let film = ["render", "scene.toml", "-o", "a.png", "--backend", "cpu", "--size", "65535x65535"];
    refused(&folder, &film, 75, "a film of 65535 x 65535 pixels takes 384.0 GiB; ", "--max-memory");
    // A part of the same frame is small.
    folder.done(&[&film[..], &["--crop", "0,0,8,8", "--spp", "1"]].concat());
    let parity = ["parity", "scene.toml", "--between", "cpu,cpu", "--size", "65535x65535"];
    refused(&folder, &parity, 75, "a film of 65535 x 65535 pixels", "");
    std::fs::create_dir(folder.path("scenes")).expect("a new folder");
    folder.file("scenes/a.toml", SCENE);
    let gallery = ["render", "--gallery", "scenes", "-o", "page", "--backend", "cpu", "--size", "65535x65535"];
    refused(&folder, &gallery, 75, "a film of 65535 x 65535 pixels", "");
    // 96 bytes a pixel alone, 360 with auxiliary values, and the program's own few tens of MiB.
    let layered =
        ["render", "scene.toml", "--backend", "cpu", "--size", "2048x1024", "--spp", "1", "--max-memory", "500M"];
    folder.done(&[&layered[..], &["-o", "a.exr"]].concat());
    let aovs = [&layered[..], &["-o", "a.exr", "--aov", "normal"]].concat();
    refused(&folder, &aovs, 75, "a film of 2048 x 1024 pixels with auxiliary values takes 7", "--max-memory");
    let little = ["render", "scene.toml", "-o", "a.png", "--backend", "cpu", "--max-memory", "1K"];
    refused(&folder, &little, 75, "scene.toml: the file takes ", "1.0 KiB are left");
    folder.done(&["render", "scene.toml", "-o", "a.png", "--backend", "cpu", "--max-memory", "1G"]);
    let message = folder.fails(2, &["render", "scene.toml", "--max-memory", "much"]);
    assert!(message.contains("as in 900M"), "{message}");
    assert!(!folder.names().iter().any(|name| name.ends_with(".part")), "{:?}", folder.names());
}
