//! `gonio render`: the files it writes.

use super::support::{Ended, Folder, TRIANGLE_OBJ, TRIANGLE_PLY, ended, line, region};
use gonio::film::Rect;

const ALL_AOVS: &str = "depth,normal,albedo,object,material,samples";

#[test]
fn every_format_holds_the_same_film() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.png"]);
    assert_eq!(line(&report, "samples"), "0..2");
    for args in [vec!["a16.png", "--bits", "16"], vec!["a.exr", "--aov", ALL_AOVS], vec!["a.hdr"], vec!["a.gfilm"]] {
        let same = folder.cpu(&[&["render", "scene.toml", "-o"], args.as_slice()].concat());
        assert_eq!(same, report, "{args:?}");
    }
    assert_eq!(folder.picture("a.png").codes.expect("integers").bits, 8);
    assert_eq!(folder.picture("a16.png").codes.expect("integers").bits, 16);
    let film = folder.film("a.gfilm");
    assert_eq!(film.hash().to_string(), line(&report, "film"));
    let resolved = film.resolve().pixels;
    // Colour only: files of an opaque picture say nothing of coverage.
    let colours = |pixels: &[[f32; 4]]| pixels.iter().map(|p| [p[0], p[1], p[2]]).collect::<Vec<_>>();
    assert_eq!(colours(&folder.picture("a.exr").image.pixels), colours(&resolved));
    for (shared, exact) in folder.picture("a.hdr").image.pixels.iter().zip(&resolved) {
        let largest = exact[0].max(exact[1]).max(exact[2]);
        for lane in 0..3 {
            assert!((shared[lane] - exact[lane]).abs() <= largest / 128.0, "{shared:?} {exact:?}");
        }
    }
}

#[test]
fn exr_has_a_channel_for_every_aov_and_says_what_it_is() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.exr", "--aov", ALL_AOVS]);
    let bytes = folder.bytes("a.exr");
    let meta = exr::meta::MetaData::read_from_buffered(bytes.as_slice(), false).expect("an EXR");
    let channels: Vec<String> = meta
        .headers
        .iter()
        .flat_map(|header| &header.channels.list)
        .map(|channel| channel.name.to_string().to_lowercase())
        .collect();
    for name in ALL_AOVS.split(',') {
        let initial = &name[..1];
        let found = channels.iter().any(|channel| {
            channel.starts_with(name) || (name == "depth" && channel == "z") || channel == initial && name != "albedo"
        });
        assert!(found, "{name} is not among {channels:?}");
    }
    let hash = line(&report, "film").as_bytes();
    assert!(bytes.windows(hash.len()).any(|window| window == hash), "the film hash is an attribute");
}

#[test]
fn png_says_its_film_hash() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.png"]);
    let hash = line(&report, "film").as_bytes();
    assert!(folder.bytes("a.png").windows(hash.len()).any(|window| window == hash));
}

#[test]
fn standard_output_carries_the_picture_and_standard_error_the_hash() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.png"]);
    let Ended { code, out, stderr } = folder.run(&["render", "scene.toml", "-o", "-", "--backend", "cpu"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(out, folder.bytes("a.png"), "nothing but the file's bytes");
    assert_eq!(stderr, report);
    let film = folder.run(&["render", "scene.toml", "-o", "-", "--format", "gfilm", "--backend", "cpu"]);
    assert!(film.out.starts_with(b"GFILM"));
}

#[test]
fn scene_can_come_from_standard_input() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml", "-o", "a.gfilm"]);
    let mut command = folder.command(&["render", "-", "-o", "b.gfilm", "--backend", "cpu"]);
    let piped = ended(command.write_stdin(super::support::SCENE));
    assert_eq!((piped.code, piped.text()), (Some(0), report), "{}", piped.stderr);
}

#[test]
fn halves_of_the_samples_merge_to_the_whole_byte_for_byte() {
    let folder = Folder::new();
    let whole = folder.cpu(&["render", "scene.toml", "-o", "whole.png", "--samples", "0..4"]);
    folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--samples", "0..1"]);
    folder.cpu(&["render", "scene.toml", "-o", "b.gfilm", "--samples", "1..4"]);
    let merged = folder.done(&["merge", "b.gfilm", "a.gfilm", "-o", "merged.png"]);
    assert_eq!(merged, whole);
    assert_eq!(line(&merged, "samples"), "0..4");
    assert_eq!(folder.bytes("merged.png"), folder.bytes("whole.png"));
    let spp = folder.cpu(&["render", "scene.toml", "-o", "spp.png", "--spp", "4"]);
    assert_eq!(spp, whole, "--spp counts from 0");
}

#[test]
fn crop_is_that_region_of_the_whole_picture() {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "whole.exr"]);
    folder.cpu(&["render", "scene.toml", "-o", "crop.exr", "--crop", "9,5,23,17"]);
    let (whole, crop) = (folder.picture("whole.exr"), folder.picture("crop.exr"));
    assert_eq!((crop.image.width, crop.image.height), (14, 12));
    let expected = region(&whole, Rect { x: 9, y: 5, width: 14, height: 12 });
    assert_eq!(crop.image.pixels, expected);
    let first = expected[0];
    assert!(expected.iter().any(|pixel| *pixel != first), "a region of one colour would prove nothing");
}

#[test]
fn transparent_pictures_have_coverage_as_alpha_and_no_background() {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "opaque.png"]);
    folder.cpu(&["render", "scene.toml", "-o", "clear.png", "--transparent"]);
    let alphas = |name: &str| folder.picture(name).image.pixels.iter().map(|pixel| pixel[3]).collect::<Vec<_>>();
    assert!(alphas("opaque.png").iter().all(|&alpha| alpha == 1.0));
    let clear = folder.picture("clear.png").image;
    assert_eq!(clear.pixels[0], [0.0; 4], "the corner is background");
    assert_eq!(clear.pixels[12 * 32 + 16][3], 1.0, "the middle is the ball");
}

#[test]
fn meshes_alone_get_the_size_seed_and_samples_that_were_asked_for() {
    let folder = Folder::new();
    folder.file("mesh.obj", TRIANGLE_OBJ);
    folder.file("mesh.ply", TRIANGLE_PLY);
    for mesh in ["mesh.obj", "mesh.ply"] {
        folder.cpu(&["render", mesh, "-o", "a.gfilm", "--size", "20x30", "--spp", "1", "--seed", "7"]);
        let film = folder.film("a.gfilm");
        assert_eq!((film.spec().width, film.spec().height, film.spec().seed), (20, 30, 7), "{mesh}");
        assert_eq!(film.samples().to_string(), "0..1");
        // Staged for the wide frame, the same mesh is not cut off in a tall one.
        folder.cpu(&["render", mesh, "-o", "tall.exr", "--size", "12x48", "--spp", "4", "--aov", "object"]);
        folder.cpu(&["render", mesh, "-o", "later.exr", "--set", "film.size=[12,48]", "--spp", "4", "--aov", "object"]);
        assert_eq!(folder.bytes("tall.exr"), folder.bytes("later.exr"), "--size is film.size");
    }
}

#[test]
fn the_camera_of_a_staged_mesh_knows_the_frame_it_is_framed_for() {
    let folder = Folder::new();
    folder.file("mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let reaches_edge = |size: &str| {
        folder.cpu(&[
            "render",
            "mesh.obj",
            "-o",
            "a.gfilm",
            "--size",
            size,
            "--spp",
            "4",
            "--aov",
            "object",
            "--set",
            "film.filter=\"box\"",
        ]);
        let film = folder.film("a.gfilm");
        let objects = film.resolve_aovs().expect("kept").object;
        let (width, mesh) = (film.spec().width as usize, objects[objects.len() / 2 + film.spec().width as usize / 2]);
        objects.iter().enumerate().any(|(i, &object)| object == mesh && (i % width == 0 || i % width == width - 1))
    };
    assert!(!reaches_edge("96x24"));
    assert!(!reaches_edge("24x96"), "a tall frame needs a camera further away");
}

#[test]
fn output_takes_the_scenes_name_if_none_is_given() {
    let folder = Folder::new();
    let report = folder.cpu(&["render", "scene.toml"]);
    assert_eq!(line(&report, "picture"), "scene.png", "{report}");
    assert_eq!(folder.names(), ["scene.png", "scene.toml"]);
    let mut piped = folder.command(&["render", "-", "--backend", "cpu"]);
    assert_eq!(ended(piped.write_stdin(super::support::SCENE)).code, Some(0));
    assert_eq!(folder.names(), ["out.png", "scene.png", "scene.toml"]);
}

#[test]
fn file_that_was_there_is_untouched_when_the_render_fails() {
    let folder = Folder::new();
    folder.file("old.png", "precious");
    folder.fails(69, &["render", "scene.toml", "-o", "old.png", "--device", "nonsense"]);
    folder.file("bad.toml", "nonsense = 1\n");
    folder.fails(65, &["render", "bad.toml", "-o", "old.png"]);
    folder.fails(2, &["render", "scene.toml", "-o", "old.png", "--crop", "0,0,99,99"]);
    assert_eq!(folder.bytes("old.png"), b"precious");
    assert_eq!(folder.names(), ["bad.toml", "old.png", "scene.toml"], "no unfinished file is left");
}

#[test]
fn compare_reads_a_crop_in_every_format_that_render_writes() {
    let folder = Folder::new();
    for name in ["a.exr", "a.gfilm", "a.hdr"] {
        folder.cpu(&["render", "scene.toml", "-o", name, "--crop", "5,4,21,20"]);
    }
    // The data window of the EXR lies inside its display window; what is there is the picture.
    assert_eq!((folder.picture("a.exr").image.width, folder.picture("a.exr").image.height), (16, 16));
    folder.done(&["compare", "a.exr", "a.gfilm"]);
    folder.done(&["compare", "a.gfilm", "a.exr"]);
    folder.done(&["compare", "a.exr", "a.hdr", "--max-mse", "1e-4"]);
}
