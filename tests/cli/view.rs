//! What every viewer lets one turn, and the pictures for the web.

use super::support::{Folder, asset, line};

/// A slab, 4 wide, 2 high and 1 deep, front +z: red in front, green on the right, blue on top, grey elsewhere; y is up.
const SLAB: &str = "mtllib slab.mtl\nv -2 0 .5\nv 2 0 .5\nv 2 2 .5\nv -2 2 .5\nv -2 0 -.5\nv 2 0 -.5\nv 2 2 -.5\nv -2 2 -.5\n\
usemtl front\nf 1 2 3 4\nusemtl right\nf 2 6 7 3\nusemtl top\nf 4 3 7 8\nusemtl rest\nf 6 5 8 7\nf 5 1 4 8\nf 5 6 2 1\n";
const SLAB_MTL: &str =
    "newmtl front\nKd .8 0 0\nnewmtl right\nKd 0 .8 0\nnewmtl top\nKd 0 0 .8\nnewmtl rest\nKd .5 .5 .5\n";

fn slab() -> Folder {
    let folder = Folder::new();
    folder.file("slab.obj", SLAB);
    folder.file("slab.mtl", SLAB_MTL);
    folder
}

impl Folder {
    /// The picture that these flags make of the slab, 32x32.
    #[track_caller]
    fn look(&self, flags: &[&str]) -> Vec<[f32; 4]> {
        let mut args = vec!["render", "slab.obj", "-o", "look.exr", "--size", "32x32", "--spp", "4"];
        args.extend(flags);
        self.cpu(&args);
        self.picture("look.exr").image.pixels
    }
}

fn middle(pixels: &[[f32; 4]]) -> [f32; 4] {
    pixels[16 * 32 + 16]
}

/// The channel that is far above the others.
fn hue(pixel: [f32; 4]) -> Option<usize> {
    let [r, g, b, _] = pixel;
    (0..3).find(|i| [r, g, b][*i] > 2.0 * (r + g + b - [r, g, b][*i]))
}

#[test]
fn azimuth_and_elevation_show_the_side_that_is_meant() {
    let folder = slab();
    let seen =
        |azimuth: &str, elevation: &str| hue(middle(&folder.look(&["--azimuth", azimuth, "--elevation", elevation])));
    assert_eq!((seen("0", "0"), seen("90", "0"), seen("0", "90")), (Some(0), Some(1), Some(2)));
    assert_eq!(hue(middle(&folder.look(&["--look-from", "9,1,0"]))), Some(1), "towards the middle");
    assert_eq!(hue(middle(&folder.look(&["--look-from=-1.9,9,0", "--look-at=-1.9,0,0", "--fov", "5"]))), Some(2));
}

#[test]
fn the_model_nears_by_zoom_and_the_last_of_a_repeated_flag_wins() {
    let folder = slab();
    let front = ["--azimuth", "0", "--elevation", "0", "--ground", "off"];
    let reds = |more: &[&str]| {
        let flags = [&front[..], more].concat();
        folder.look(&flags).into_iter().filter(|pixel| hue(*pixel) == Some(0)).count()
    };
    let (near, far, plain) = (reds(&["--zoom", "1.5"]), reds(&["--zoom", "0.5"]), reds(&[]));
    assert!(near > plain && plain > 3 * far && far > 0, "{near} {plain} {far}");
    assert_eq!(reds(&["--zoom", "0.5", "--zoom", "1.5"]), near);
}

#[test]
fn a_file_whose_z_is_up_stands_on_the_same_side_once_it_is_told() {
    let folder = slab();
    let upright = folder.look(&["--azimuth", "0", "--elevation", "90"]);
    // The same slab as a CAD program writes it: (x, y, z) is (x, -z, y).
    let turned: String = SLAB
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            ["v", x, y, z] => format!("v {x} {} {y}\n", -z.parse::<f32>().expect("a number")),
            _ => format!("{line}\n"),
        })
        .collect();
    folder.file("slab.obj", turned);
    assert_eq!(folder.look(&["--azimuth", "0", "--elevation", "90", "--up", "z"]), upright);
    assert_ne!(folder.look(&["--azimuth", "0", "--elevation", "90"]), upright);
}

#[test]
fn surroundings_light_a_model_and_turn_and_scale() {
    let folder = slab();
    let view = ["--azimuth", "0", "--elevation", "0", "--ground", "off"];
    let with = |flags: &[&str]| folder.look(&[&view[..], flags].concat());
    let white = with(&["--environment", "white"]);
    let is = |pixel: [f32; 4], light: f32| pixel[..3].iter().all(|v| (v / light - 1.0).abs() < 1e-5);
    assert!(is(white[0], 1.0), "seen in the corner: {:?}", white[0]);
    let double = with(&["--environment", "white", "--environment-scale", "2"]);
    assert!(is(double[0], 2.0), "{:?}", double[0]);
    assert!((middle(&double)[0] / middle(&white)[0] - 2.0).abs() < 0.01);
    // The sun stands at the left; half a turn brings it behind the model.
    let lit = |turn: &str| middle(&with(&["--environment", "sky", "--environment-rotate", turn]))[0];
    assert!(lit("0") > 1.5 * lit("180"), "{} {}", lit("0"), lit("180"));
    // A picture of a file: one texel of light.
    folder.cpu(&["render", "scene.toml", "-o", "around.hdr"]);
    assert!(middle(&with(&["--environment", "around.hdr"]))[0] > 0.0);
    let message = folder.fails(74, &["render", "slab.obj", "--environment", "nowhere.hdr"]);
    assert!(message.contains("nowhere.hdr"), "{message}");
    // Scenes of our own can be put elsewhere, too.
    folder.cpu(&["render", "scene.toml", "-o", "own.exr", "--environment", "white"]);
    assert!(is(folder.picture("own.exr").image.pixels[0], 1.0));
}

#[test]
fn a_model_on_a_plain_background_is_lit_as_before_and_stands_on_no_ground() {
    let folder = slab();
    let args = ["render", "slab.obj", "--size", "32x32", "--spp", "4", "--background", "#ff8000", "-o"];
    folder.cpu(&[&args[..], &["a.png"]].concat());
    let codes = folder.picture("a.png").codes.expect("eight bits").pixels;
    assert_eq!(codes[0][..3], [255, 128, 0]);
    assert!(codes[16 * 32 + 16][0] != 255, "the model is there");
    let pixels = folder.picture("a.png").image.pixels;
    assert!(pixels.iter().all(|pixel| pixel[3] == 1.0), "nothing is left to see through");
}

#[test]
fn pictures_for_the_web_are_those_of_the_png() {
    let folder = Folder::new();
    for name in ["a.png", "a.webp", "a.jpg", "b.JPEG"] {
        folder.cpu(&["render", "scene.toml", "-o", name]);
    }
    let codes = |name: &str| folder.picture(name).codes.expect("eight bits").pixels;
    assert_eq!(codes("a.webp"), codes("a.png"), "WebP is lossless");
    let differences = codes("a.jpg")
        .iter()
        .zip(codes("a.png"))
        .map(|(a, b)| (0..3).map(|i| (i32::from(a[i]) - i32::from(b[i])).abs()).max().unwrap_or(0))
        .collect::<Vec<_>>();
    let mean = differences.iter().sum::<i32>() as f64 / differences.len() as f64;
    assert!(mean < 4.0 && codes("a.jpg") == codes("b.JPEG"), "{mean}");
    for name in ["a.webp", "a.jpg"] {
        let bytes = folder.bytes(name);
        let told = bytes.windows(10).any(|window| window == b"Film-Hash:");
        assert!(told, "{name} does not say where it is from");
    }
    folder.cpu(&["render", "scene.toml", "-o", "clear.webp", "--transparent"]);
    assert_eq!(folder.picture("clear.webp").image.pixels[0][3], 0.0);
    // Panels, too.
    folder
        .file("panels.toml", format!("{}[[panel]]\nlabel = \"a\"\n[[panel]]\nlabel = \"b\"\n", super::support::SCENE));
    folder.cpu(&["render", "panels.toml", "-o", "panels.png"]);
    folder.cpu(&["render", "panels.toml", "-o", "panels.webp"]);
    assert_eq!(codes("panels.webp"), codes("panels.png"));
}

#[test]
fn scale_makes_the_frame_larger_or_smaller() {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "half.png", "--scale", "0.5"]);
    let half = folder.picture("half.png").image;
    assert_eq!((half.width, half.height), (16, 12));
    folder.cpu(&["render", "scene.toml", "-o", "double.png", "--scale", "2"]);
    assert_eq!(folder.picture("double.png").image.width, 64);
    let message = folder.fails(2, &["render", "scene.toml", "--size", "4000x40", "--scale", "2"]);
    assert!(message.contains("--scale"), "{message}");
}

#[test]
fn one_of_the_files_cameras_is_chosen_by_name_or_number() {
    let folder = Folder::new();
    let camera = |name: &str| {
        format!(r#"{{"name": "{name}", "type": "perspective", "perspective": {{"yfov": 0.5, "znear": 0.1}}}}"#)
    };
    folder.file(
        "cameras.gltf",
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0, 1]}}], "scene": 0, "cameras": [{}, {}],
        "nodes": [{{"camera": 0, "translation": [0, 0, 5]}}, {{"camera": 1, "translation": [0, 0, 50]}}]}}"#,
            camera("near"),
            camera("far")
        ),
    );
    let args = ["render", "cameras.gltf", "-o", "a.png", "--size", "4x4", "--spp", "1", "--backend", "cpu"];
    let plain = folder.run(&args);
    assert!(plain.stderr.contains("the first of 2 cameras (\"near\")"), "{}", plain.stderr);
    for wanted in ["far", "1"] {
        let chosen = folder.run(&[&args[..], &["--camera", wanted]].concat());
        assert_eq!(chosen.code, Some(0), "{}", chosen.stderr);
        assert!(!chosen.stderr.contains("the first of"), "{}", chosen.stderr);
    }
    let message = folder.fails(65, &["render", "cameras.gltf", "--camera", "middle"]);
    assert!(message.contains("0 \"near\", 1 \"far\""), "{message}");
    assert!(folder.fails(65, &["render", "scene.toml", "--camera", "0"]).contains("none of its own"));
}

#[test]
fn a_part_of_the_samples_or_the_frame_is_exposed_like_the_whole() {
    let folder = slab();
    let whole = ["render", "slab.obj", "--size", "32x32", "--spp", "4", "-o", "whole.png"];
    folder.cpu(&whole);
    for (range, name) in [("0..1", "a.gfilm"), ("1..4", "b.gfilm")] {
        folder.cpu(&["render", "slab.obj", "--size", "32x32", "--samples", range, "-o", name]);
    }
    folder.done(&["merge", "a.gfilm", "b.gfilm", "-o", "merged.png"]);
    assert_eq!(folder.bytes("merged.png"), folder.bytes("whole.png"));
    assert_ne!(folder.film("a.gfilm").spec().exposure, 0.0, "metered");
}

#[test]
fn models_that_come_alone_are_neither_dark_nor_clipped() {
    let folder = Folder::new();
    for name in ["meshes/spot.obj", "gltf/Duck.glb", "meshes/teapot.obj"] {
        let Some(path) = asset(name) else { return };
        let path = path.display().to_string();
        let report = folder.cpu(&["render", &path, "-o", "a.png", "--size", "64x36", "--spp", "8"]);
        assert_eq!(line(&report, "samples"), "0..8");
        let codes = folder.picture("a.png").codes.expect("eight bits").pixels;
        let mean = codes.iter().map(|c| f64::from(c[1])).sum::<f64>() / codes.len() as f64;
        let clipped = codes.iter().filter(|c| c[0] == 255 && c[1] == 255 && c[2] == 255).count();
        assert!((60.0..200.0).contains(&mean) && clipped * 100 < codes.len(), "{name}: {mean}, {clipped} clipped");
    }
}

#[test]
fn a_converted_model_shows_the_same_picture_and_can_be_gone_on_from() {
    let folder = slab();
    std::fs::create_dir(folder.path("scenes")).expect("a folder");
    for flags in [&[][..], &["--environment", "sky", "--azimuth", "200"], &["--integrator", "whitted"], &["--up", "z"]]
    {
        let size = ["--size", "24x16", "--spp", "2"];
        folder.done(&[&["convert", "slab.obj", "-o", "scenes/slab.toml"], &size[..], flags].concat());
        folder.cpu(&[&["render", "slab.obj", "-o", "model.png"], &size[..], flags].concat());
        folder.cpu(&["render", "scenes/slab.toml", "-o", "scene.png"]);
        let [model, scene] = ["model.png", "scene.png"].map(|name| folder.picture(name).codes.expect("8 bits").pixels);
        assert_eq!(model, scene, "{flags:?}");
    }
    // A material of the scene file stands for the file's of the same name.
    let text = String::from_utf8(folder.bytes("scenes/slab.toml")).expect("text");
    assert!(text.contains("file = \"../slab.obj\""), "{text}");
    folder.file("scenes/slab.toml", format!("{text}\n[[material]]\nname = \"front\"\ncolor = [0, 0.8, 0]\n"));
    folder.cpu(&["render", "scenes/slab.toml", "-o", "green.exr", "--azimuth", "0", "--elevation", "0", "--up", "y"]);
    let green = folder.picture("green.exr").image.pixels;
    assert!(green.iter().all(|pixel| hue(*pixel) != Some(0)), "no red is left");
    assert!(folder.fails(65, &["convert", "scene.toml", "-o", "a.toml"]).contains("only OBJ"));
}

#[test]
fn lights_and_materials_are_added_from_the_command_line() {
    let folder = slab();
    let view = ["--azimuth", "0", "--elevation", "0", "--ground", "off"];
    let seen = |flags: &[&str]| middle(&folder.look(&[&view[..], flags].concat()));
    assert_eq!(hue(seen(&["--material", "front=[0,0,0.8]"])), Some(2));
    assert_eq!(hue(seen(&["--material", "*=lime"])), Some(1));
    assert_eq!(hue(seen(&["--material", "front=model=oren-nayar, color=lime"])), Some(1));
    let lamp = "type=directional, direction=[0,0,-1], intensity=[0,0,90]";
    assert!(seen(&["--light", lamp, "--material", "*=0.5"])[2] > 5.0 * seen(&["--material", "*=0.5"])[2]);
    let message = folder.fails(65, &["render", "slab.obj", "--material", "frond=red"]);
    assert!(message.contains("\"front\", \"right\""), "{message}");
    // Scenes of our own take both.
    folder.cpu(&["render", "scene.toml", "-o", "blue.exr", "--material", "red=blue", "--light", lamp]);
    assert_eq!(hue(folder.picture("blue.exr").image.pixels[12 * 32 + 16]), Some(2));
    assert!(folder.fails(65, &["render", "teapots:100", "--light", lamp]).contains("--light"));
    assert!(folder.fails(2, &["render", "slab.obj", "--light", "bright"]).contains("keys and values"));
}

#[test]
fn what_the_stage_made_is_changed_like_what_a_file_says() {
    let folder = slab();
    let corner = |flags: &[&str]| folder.look(flags)[0];
    assert_eq!(hue(corner(&["--set", "material.ground.color=[0,0.8,0]"])), Some(1));
    assert_eq!(corner(&["--ground", "off", "--set", "background.color=[0,0,3]"])[..3], [0.0, 0.0, 3.0]);
    let keyless = corner(&["--integrator", "whitted", "--set", "light.0.intensity=0"]);
    assert!(keyless[1] < 0.7 * corner(&["--integrator", "whitted"])[1], "{keyless:?}");
}
