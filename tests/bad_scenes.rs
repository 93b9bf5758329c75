//! Malformed scenes: each ends with an error that says where and what, none with a panic.

#[path = "common/assets.rs"]
mod assets;

use assets::asset;
use gonio::scene::load::load;
use gonio::scene::{Scene, SceneError};
use std::fs;
use std::path::Path;

/// Writes `text` as `name` and loads it. The temporary folder is cut from the message.
fn attempt(name: &str, text: &[u8]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join(name);
    fs::write(&file, text).expect("writable");
    let prefix = format!("{}{}", folder.path().display(), std::path::MAIN_SEPARATOR);
    load(&file, &[]).map_err(|error| error.to_string().replace(&prefix, ""))
}

#[track_caller]
fn refuses(name: &str, text: &str, expected: &str) {
    match attempt(name, text.as_bytes()) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(message) => assert_eq!(message, expected, "for:\n{text}"),
    }
}

/// Line 1 to 4 of every scene below; what is appended begins in line 5, in the object.
const HEAD: &str = "[camera]\neye = [0, 0, 5]\n[[object]]\nshape = \"sphere\"\n";

#[test]
fn toml_that_is_no_toml_is_refused_at_its_place() {
    refuses("a.toml", "[camera\n", "a.toml:1:8: unclosed table, expected `]`");
    refuses("a.toml", "a = 1\na = 2\n", "a.toml:2:1: duplicate key");
    refuses("a.toml", "é = [1,\n", "a.toml:1:8: unclosed array, expected `]`");
    assert!(attempt("a.toml", b"x = \"\xff\"").unwrap_err().starts_with("a.toml:1:6: the text is not UTF-8"));
    assert!(attempt("a.toml", &b"a=[".repeat(100_000)).unwrap_err().starts_with("a.toml:1:"));
    assert!(attempt("a.toml", b"a = 99999999999999999999").unwrap_err().contains("a.toml:1:5: the integer"));
}

#[test]
fn unknown_keys_are_refused_with_the_nearest_one() {
    let cases: &[(&str, &str)] = &[
        ("colour = \"red\"\n", "a.toml:5:1: unknown key \"colour\"; [[object]] has"),
        ("materal = \"red\"\n", "a.toml:5:1: unknown key \"materal\"; did you mean \"material\"?"),
        ("[rander]\nsamples = 1\n", "a.toml:5:2: unknown key \"rander\"; did you mean \"render\"?"),
        ("[render]\n  smaples = 3\n", "a.toml:6:3: unknown key \"smaples\"; did you mean \"samples\"?"),
        ("[render]\nspp = 3\n", "a.toml:6:1: unknown key \"spp\"; did you mean \"samples\"?"),
        (
            "[[material]]\nname = \"a\"\nroughnes = 1\n",
            "a.toml:7:1: unknown key \"roughnes\"; did you mean \"roughness\"?",
        ),
        ("[[material]]\nname = \"a\"\nkd = 1\n", "a.toml:7:1: unknown key \"kd\"; did you mean \"k_d\"?"),
        (
            "grid = { count = [1, 1, 1], spacin = [1, 1, 1] }\n",
            "a.toml:5:29: unknown key \"spacin\"; did you mean \"spacing\"?",
        ),
        (
            "[[light]]\ntype = \"point\"\npostion = [1, 2, 3]\n",
            "a.toml:7:1: unknown key \"postion\"; did you mean \"position\"?",
        ),
    ];
    for (text, expected) in cases {
        let message = attempt("a.toml", format!("{HEAD}{text}").as_bytes()).expect_err(text);
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn wrong_types_and_ranges_say_what_was_found_and_what_is_allowed() {
    let cases: &[(&str, &str)] = &[
        ("radius = \"big\"", "a.toml:5:10: \"radius\" must be a number > 0, found the string \"big\""),
        ("radius = 0", "a.toml:5:10: \"radius\" must be a number > 0, found 0"),
        ("radius = nan", "a.toml:5:10: \"radius\" must be a number > 0, found NaN, which is no number"),
        ("radius = inf", "a.toml:5:10: \"radius\" must be a number > 0, found inf; numbers are at most 1e12"),
        (
            "radius = 1e13",
            "a.toml:5:10: \"radius\" must be a number > 0, found 10000000000000.0; numbers are at most 1e12",
        ),
        (
            "translate = [1, -1e13, 0]",
            "a.toml:5:13: \"translate\" must be three numbers [x, y, z], found -10000000000000.0; numbers are at least -1e12",
        ),
        ("segments = 2", "a.toml:5:12: \"segments\" of this shape must be an integer from 3 to 4096, found 2"),
        ("segments = 99999999", "a.toml:5:12: \"segments\" must be an integer from 1 to 4096, found 99999999"),
        ("segments = 8.0", "a.toml:5:12: \"segments\" must be an integer from 1 to 4096, found 8.0"),
        ("casts_shadow = 1", "a.toml:5:16: \"casts_shadow\" must be true or false, found 1"),
        ("material = 3", "a.toml:5:12: \"material\" must be a non-empty string, found 3"),
        ("translate = [1, 2]", "a.toml:5:13: \"translate\" must be three numbers [x, y, z], found an array of 2"),
        (
            "translate = [1, 2, nan]",
            "a.toml:5:13: \"translate\" must be three numbers [x, y, z], found NaN, which is no number",
        ),
        ("scale = 0", "a.toml:5:9: \"scale\" must not be 0: nothing would be left to see"),
        ("rotate = [0, 0, 0, 30]", "a.toml:5:10: the axis of \"rotate\" must not have length 0"),
        ("translate = 1979-05-27", "a.toml:5:13: \"translate\" must be three numbers [x, y, z], found a date"),
        (
            "matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 2]]",
            "a.toml:5:10: the last row of \"matrix\" must be [0, 0, 0, 1]",
        ),
        (
            "matrix = [[1, 0, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]",
            "a.toml:3:1: the transform flattens the object: its axes are not independent",
        ),
        ("matrix = 3", "a.toml:5:10: \"matrix\" must be four rows of four numbers, found 3"),
        ("scale = 2\nmatrix = 3", "a.toml:6:10: \"scale\" and \"matrix\" exclude each other"),
        (
            "transform = [{ scale = 1e9 }, { scale = 1e9 }]",
            "a.toml:3:1: the transform moves the object out of the range of single precision",
        ),
        ("transform = [3]", "a.toml:5:14: a transform step must be a table, found 3"),
        ("instances = []", "a.toml:5:13: \"instances\" is empty: the object would be nowhere"),
        (
            "grid = { count = [2, 2, 0], spacing = [1, 1, 1] }",
            "a.toml:5:18: \"count\" must be three integers [x, y, z] from 1, at most 1048576 copies in all, found an array of 3",
        ),
        (
            "grid = { count = [1024, 1024, 2], spacing = [1, 1, 1] }",
            "a.toml:5:18: 2097152 copies of an object; at most 1048576 are allowed",
        ),
        ("grid = { count = [2, 2, 2] }", "a.toml:5:8: a grid needs the key \"spacing\""),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("{HEAD}{text}\n"), expected);
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let cases: &[(&str, &str)] = &[
        ("[render]\nsamples = 0", "a.toml:6:11: \"samples\" must be an integer from 1 to 16777216, found 0"),
        (
            "[render]\nintegrator = \"bdpt\"",
            "a.toml:6:14: \"integrator\" must be \"local\", \"whitted\", \"direct\" or \"path\", found \"bdpt\"",
        ),
        (
            "[render]\nsampler = \"sobel\"",
            "a.toml:6:11: \"sampler\" must be \"sobol\", \"stratified\" or \"independent\", found \"sobel\"; did you mean \"sobol\"?",
        ),
        ("[render]\nambient = -1", "a.toml:6:11: \"ambient\" must be a colour >= 0, found -1"),
        (
            "[render]\nambient = \"#12345\"",
            "a.toml:6:11: \"ambient\" must be a colour >= 0, found the string \"#12345\"",
        ),
        (
            "[film]\nsize = [0, 10]",
            "a.toml:6:8: \"size\" must be two integers [width, height] from 1 to 65535, found an array of 2",
        ),
        ("[film]\nsize = [10.5, 10]", "a.toml:6:8: \"size\" must be two integers [width, height]"),
        (
            "[film]\nsize = [70000, 1]",
            "a.toml:6:8: \"size\" must be two integers [width, height] from 1 to 65535, found an array of 2",
        ),
        ("[film]\nunit = 3", "a.toml:6:8: \"unit\" must be a power of two from 2^-40 to 2^40, found 3"),
        ("[film]\nfilter = { radius = 1 }", "a.toml:6:10: a filter needs the key \"type\""),
        (
            "[film]\nfilter = \"sinc\"",
            "a.toml:6:10: \"filter\" must be \"box\", \"tent\", \"gaussian\", \"mitchell\", \"catmull-rom\", \"blackman-harris\", \"lanczos\" or a table, found the string \"sinc\"",
        ),
        (
            "[film]\nfilter = { type = \"tent\", radius = 0 }",
            "a.toml:6:36: \"radius\" must be a number above 0 and up to 16, found 0",
        ),
        ("[background]\ncolor = 1\ntop = 2", "a.toml:7:7: \"color\" and \"top\" exclude each other"),
        ("[[render]]\nsamples = 1", "a.toml:5:1: [render] must be a table, found an array of 1"),
        (
            "[material]\nname = \"a\"",
            "a.toml:5:1: \"material\" is a list of tables, found a table: write [[material]] or material = [{ … }]",
        ),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("{HEAD}{text}\n"), expected);
    }
}

#[test]
fn cameras_that_see_nothing_are_refused() {
    let cases: &[(&str, &str)] = &[
        ("target = [0, 0, 0]", "a.toml:1:1: [camera] needs the key \"eye\""),
        ("eye = [1, 2, 3]\ntarget = [1, 2, 3]", "a.toml:3:10: \"target\" and \"eye\" are the same point"),
        ("eye = [0, 5, 0]", "a.toml:1:1: \"up\" = [0, 1, 0] is parallel to the view; choose another direction"),
        ("eye = [0, 0, 5]\nup = [0, 0, 0]", "a.toml:3:6: \"up\" is a direction and must not have length 0"),
        ("eye = [0, 0, 5]\nfov = 180", "a.toml:3:7: \"fov\" must be a number from 0.01 to 179, found 180"),
        ("eye = [0, 0, 5]\nfov = 30\nfov_x = 40", "a.toml:4:9: \"fov\" and \"fov_x\" exclude each other"),
        ("eye = [0, 0, 5]\nprojection = \"orthographic\"", "a.toml:1:1: [camera] needs the key \"height\""),
        (
            "eye = [0, 0, 5]\nprojection = \"orthographic\"\nheight = 0",
            "a.toml:4:10: \"height\" must be a number > 0, found 0",
        ),
        (
            "eye = [0, 0, 5]\nheight = 2",
            "a.toml:3:10: \"height\" has no meaning for a perspective camera; it has \"fov\"",
        ),
        ("eye = [0, 0, 5]\nfov_y = 2", "a.toml:3:1: unknown key \"fov_y\"; did you mean \"fov\"?"),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("[camera]\n{text}\n[[object]]\nshape = \"sphere\"\n"), expected);
    }
    refuses("a.toml", "[[object]]\nshape = \"sphere\"\n", "a.toml:1:1: the scene needs the key \"camera\"");
    refuses(
        "a.toml",
        "[camera]\neye = [0, 0, 5]\n",
        "a.toml:1:1: the scene has no [[object]]: there is nothing to draw",
    );
}

#[test]
fn materials_that_mean_nothing_are_refused() {
    let ct = "model = \"cook-torrance\"\n";
    let cases: &[(String, &str)] = &[
        (
            "model = \"cook-torrence\"".into(),
            "a.toml:7:9: \"model\" must be \"lambert\", \"phong\", \"blinn-phong\", \"cook-torrance\", \"mirror\", \"dielectric\", \"emissive\", \"oren-nayar\", \"eon\", \"ward\", \"ashikhmin-shirley\", \"kelemen\", \"conductor\", \"rough-conductor\", \"rough-dielectric\", \"thin-dielectric\", \"plastic\", \"rough-plastic\", \"principled\", \"measured\", \"null\" or \"blend\", found \"cook-torrence\"; did you mean \"cook-torrance\"?",
        ),
        ("color = [1, 2, 3]".into(), "a.toml:7:9: \"color\" is a reflectance, at most 1, found 3"),
        ("color = \"octarine\"".into(), "a.toml:7:9: \"color\" must be a colour >= 0, found the string \"octarine\""),
        ("k_r = 2".into(), "a.toml:7:7: \"k_r\" must be a number from 0 to 1, found 2"),
        (
            format!("{ct}k_d = 0.5\nk_s = 0.6"),
            "a.toml:9:7: k_d + k_s = 1.1; cook-torrance shares its light: k_d + k_s must be 1",
        ),
        (format!("{ct}k_s = 1.5"), "a.toml:8:7: k_s = 1.5; cook-torrance shares its light: k_d + k_s must be 1"),
        (format!("{ct}m = 0"), "a.toml:8:5: \"m\" must be a number or two numbers [u, v], from 0.001 to 2, found 0"),
        (format!("{ct}lobes = []"), "a.toml:8:9: \"lobes\" must be one or two tables, found 0"),
        (
            format!("{ct}lobes = [{{ m = 0.1, weight = 0.5 }}]"),
            "a.toml:8:9: the weights of \"lobes\" must add up to 1, not to 0.5",
        ),
        (
            format!("{ct}m = 0.1\nlobes = [{{ m = 0.1, weight = 1 }}]"),
            "a.toml:9:9: \"m\" and \"lobes\" exclude each other",
        ),
        (
            format!("{ct}metal = \"Fe\""),
            "a.toml:8:9: \"metal\" must be \"Cu\", \"Au\", \"Ag\", \"Al\" or \"Cr\", found \"Fe\"",
        ),
        (format!("{ct}metal = \"Cu\"\neta = 2"), "a.toml:9:7: \"metal\" and \"eta\" exclude each other"),
        (format!("{ct}k = 3"), "a.toml:8:5: \"k\" needs \"eta\" beside it"),
        (
            format!("{ct}eta = 0"),
            "a.toml:8:7: \"eta\" must be a number from 0.01 to 20, \"glass\", \"water\" or \"diamond\"; with `k` a colour from 0.01 to 20, found 0",
        ),
        (
            format!("{ct}normalisation = \"lafortune\""),
            "a.toml:8:17: \"normalisation\" of \"cook-torrance\" must be \"unit\" or \"1982\", found \"lafortune\"",
        ),
        ("transparency_color = 1".into(), "a.toml:7:22: \"transparency_color\" needs transparency_mode = \"filtered\""),
        ("texture = { wrap = \"clamp\" }".into(), "a.toml:7:11: a texture needs the key \"file\""),
        ("texture = 3".into(), "a.toml:7:11: \"texture\" must be a file name or a table, found 3"),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("{HEAD}[[material]]\nname = \"a\"\n{text}\n"), expected);
    }
}

#[test]
fn names_are_unique_and_known() {
    let cases: &[(&str, &str)] = &[
        ("[[material]]\ncolor = 1", "a.toml:5:1: [[material]] needs the key \"name\""),
        ("[[material]]\nname = \"\"", "a.toml:6:8: \"name\" must be a non-empty string, found the string \"\""),
        (
            "[[material]]\nname = \"a\"\n[[material]]\nname = \"a\"",
            "a.toml:8:8: the material name \"a\" is already given in line 6",
        ),
        (
            "material = \"coper\"\n[[material]]\nname = \"copper\"",
            "a.toml:5:12: there is no material named \"coper\"; did you mean \"copper\"?",
        ),
        (
            "name = \"x\"\n[[object]]\nshape = \"box\"\nname = \"x\"",
            "a.toml:8:8: the object name \"x\" is already given in line 5",
        ),
        ("[[object]]\nname = \"x\"", "a.toml:5:1: [[object]] needs the key \"shape\""),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("{HEAD}{text}\n"), expected);
    }
}

#[test]
fn lights_that_shine_nowhere_are_refused() {
    let cases: &[(&str, &str)] = &[
        ("", "a.toml:5:1: [[light]] needs the key \"type\""),
        ("type = \"point\"", "a.toml:5:1: [[light]] needs the key \"position\""),
        ("type = \"directional\"", "a.toml:5:1: [[light]] needs the key \"direction\""),
        (
            "type = \"directional\"\ndirection = [0, 0, 0]",
            "a.toml:7:13: \"direction\" is a direction and must not have length 0",
        ),
        (
            "type = \"spot\"\nposition = [1, 1, 1]\ntarget = [1, 1, 1]",
            "a.toml:8:10: \"target\" and \"position\" are the same point",
        ),
        (
            "type = \"spot\"\nposition = [1, 1, 1]\ninner_angle = 40",
            "a.toml:8:15: \"inner_angle\" = 40 is larger than \"outer_angle\" = 30",
        ),
        (
            "type = \"spot\"\nposition = [1, 1, 1]\nouter_angle = 0",
            "a.toml:8:15: \"outer_angle\" must be a number above 0 and up to 90, found 0",
        ),
        (
            "type = \"point\"\nposition = [1, 1, 1]\nintensity = -1",
            "a.toml:8:13: \"intensity\" must be a colour >= 0, found -1",
        ),
        (
            "type = \"point\"\nposition = [1, 1, 1]\nattenuation = [0, 0, 0]",
            "a.toml:8:15: \"attenuation\" has three zeros: it divides by nothing",
        ),
        (
            "type = \"point\"\nposition = [1, 1, 1]\nattenuation = [1, -1, 0]",
            "a.toml:8:15: \"attenuation\" must be \"inverse-square\", \"none\" or three numbers [c1, c2, c3] >= 0, found an array of 3",
        ),
        ("type = \"area\"", "a.toml:6:8: \"type\" must be \"point\", \"directional\" or \"spot\", found \"area\""),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("{HEAD}[[light]]\n{text}\n"), expected);
    }
}

#[test]
fn shapes_that_have_no_surface_are_refused() {
    let cases: &[(&str, &str)] = &[
        (
            "shape = \"cube\"",
            "a.toml:4:9: \"shape\" must be \"sphere\", \"quad\", \"box\", \"disk\", \"cylinder\", \"cone\", \"torus\", \"lathe\", \"teapot\", \"heightfield\", \"terrain\", \"hairball\", \"sphereflake\", \"teapots\" or \"mesh\", found \"cube\"",
        ),
        (
            "shape = \"quad\"\nsize = [1, 2, 3]",
            "a.toml:5:8: \"size\" of this shape must be a number > 0 or 2 of them, found an array of 3",
        ),
        (
            "shape = \"sphere\"\nshading = \"gouraud\"",
            "a.toml:5:11: a sphere without \"segments\" has no triangles to shade flat or by Gouraud's method",
        ),
        (
            "shape = \"torus\"\nminor_radius = 2",
            "a.toml:5:16: \"minor_radius\" = 2 must be less than \"major_radius\" = 1",
        ),
        ("shape = \"lathe\"", "a.toml:3:1: [[object]] needs the key \"profile\""),
        (
            "shape = \"lathe\"\nprofile = [[1, 0], [-1, 2]]",
            "a.toml:5:20: a profile point is [radius >= 0, height], found -1, 2",
        ),
        ("shape = \"lathe\"\nprofile = [[1, 0], [1, 0]]", "a.toml:5:11: profile points 0 and 1 are the same"),
        (
            "shape = \"teapot\"\nsegments = 500",
            "a.toml:5:12: \"segments\" of this shape must be an integer from 1 to 128, found 500",
        ),
        (
            "shape = \"terrain\"\ntriangles = 1",
            "a.toml:5:13: \"triangles\" of this shape must be an integer from 2 to 33554432, found 1",
        ),
        ("shape = \"sphereflake\"\nlevel = 8", "a.toml:5:9: \"level\" must be an integer from 0 to 7, found 8"),
        ("shape = \"mesh\"", "a.toml:3:1: [[object]] needs the key \"file\""),
        (
            "shape = \"mesh\"\nfile = \"a.toml\"",
            "a.toml:5:8: \"file\" of a mesh must be OBJ, PLY, STL, glTF or GLB, found a TOML scene",
        ),
        (
            "shape = \"mesh\"\nfile = \"a.off\"",
            "a.off: scene files are .toml, .obj, .gltf, .glb, .ply, .stl or .xml, found .off",
        ),
    ];
    for (text, expected) in cases {
        refuses("a.toml", &format!("[camera]\neye = [0, 0, 5]\n[[object]]\n{text}\n"), expected);
    }
}

#[test]
fn missing_files_that_are_no_textures_are_io_errors_that_say_who_asked() {
    let io = |name: &str, text: &str| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join(name);
        fs::write(&file, text).expect("writable");
        let error = load(&file, &[]).expect_err("a file is missing");
        assert!(matches!(error, SceneError::Io { .. }), "{error}");
        error.to_string()
    };
    let mesh = io("a.toml", "[camera]\neye = [0, 0, 5]\n[[object]]\nshape = \"mesh\"\nfile = \"no.obj\"\n");
    assert!(mesh.contains("a.toml:5:8: ") && mesh.contains("no.obj: "), "{mesh}");
    for name in ["no.toml", "no.obj", "no.ply"] {
        let error = load(Path::new(name), &[]).expect_err("no such file");
        assert!(matches!(error, SceneError::Io { .. }) && error.to_string().starts_with(name), "{error}");
    }
    refuses("a.txt", "", "a.txt: scene files are .toml, .obj, .gltf, .glb, .ply, .stl or .xml, found .txt");
    refuses("a", "", "a: scene files are .toml, .obj, .gltf, .glb, .ply, .stl or .xml, found no extension");
}

#[test]
fn malformed_obj_files_are_refused_at_their_place() {
    let cases: &[(&str, &str)] = &[
        ("", "a.obj: the file has no triangles"),
        ("v 0 0 0\nl 1 1\n", "a.obj: the file has no triangles"),
        ("v 0 0\n", "a.obj:1:1: \"v\" needs 3 numbers, found 2"),
        ("v 0 zero 0\n", "a.obj:1:5: expected a number, found \"zero\""),
        ("v 0 nan 0\n", "a.obj:1:5: \"nan\" is NaN, which is no number"),
        ("v 0 1e40 0\n", "a.obj:1:5: \"1e40\" is too large; numbers are at most 1e12"),
        ("vt\n", "a.obj:1:1: \"vt\" needs 1 number, found 0"),
        ("vn 0 1\n", "a.obj:1:1: \"vn\" needs 3 numbers, found 2"),
        ("f\n", "a.obj:1:1: a face needs 3 corners, found 0"),
        ("v 0 0 0\nv 1 0 0\nf 1 2\n", "a.obj:3:1: a face needs 3 corners, found 2"),
        ("v 0 0 0\nf 1 1 0\n", "a.obj:2:7: indices count from 1, found vertex 0"),
        ("v 0 0 0\nf 1 1 2\n", "a.obj:2:7: there is no vertex 2: the file has 1 so far"),
        ("v 0 0 0\nf 1 1 -2\n", "a.obj:2:7: there is no vertex -2: the file has 1 so far"),
        ("v 0 0 0\nf 1/1 1 1\n", "a.obj:2:3: there is no texture coordinate 1: the file has 0 so far"),
        ("v 0 0 0\nf 1 1//9 1\n", "a.obj:2:5: there is no normal 9: the file has 0 so far"),
        ("v 0 0 0\nf 1/ /1 1\n", "a.obj:2:6: expected the index of a vertex, found \"\""),
        ("v 0 0 0\nf 1/1/1/1 1 1\n", "a.obj:2:3: there is no texture coordinate 1: the file has 0 so far"),
        (
            "v 0 0 0\nf 1 1 99999999999999999999\n",
            "a.obj:2:7: expected the index of a vertex, found \"99999999999999999999\"",
        ),
        ("v 0 0 0\nf 1 1 1.5\n", "a.obj:2:7: expected the index of a vertex, found \"1.5\""),
        ("v 0 0 0\nf 1 1 1\n", "a.obj: the file has no triangles"),
        ("solid cube\n", "a.obj:1:1: unknown statement \"solid\""),
        ("usemtl\n", "a.obj: the file has no triangles"),
        ("v 0 0 0\n\nf 1 \\\n1 7\n", "a.obj:3: there is no vertex 7: the file has 1 so far"),
    ];
    for (text, expected) in cases {
        refuses("a.obj", text, expected);
    }
    assert!(attempt("a.obj", &[0x89, b'P', b'N', b'G', 0, 255, 10, 0]).unwrap_err().starts_with("a.obj:1"));
}

#[test]
fn malformed_mtl_files_are_refused_at_their_place() {
    let cases: &[(&str, &str)] = &[
        ("Kd 1 1 1\n", "a.mtl:1:1: \"Kd\" comes before any \"newmtl\""),
        ("newmtl a\nKd 1 red 1\n", "a.mtl:2:6: expected a number, found \"red\""),
        ("newmtl a\nKd\n", "a.mtl:2:1: \"Kd\" needs 3 numbers, found 0"),
        ("newmtl a\nNs inf\n", "a.mtl:2:4: \"inf\" is too large; numbers are at most 1e12"),
        ("newmtl a\nd\n", "a.mtl:2:1: \"d\" needs a number"),
        ("newmtl a\nillum -1\n", "a.mtl:2:7: \"illum\" must be 0 to 10, found \"-1\""),
        ("newmtl a\nmap_Kd\n", "a.mtl:2:1: \"map_Kd\" needs a file name"),
    ];
    for (text, expected) in cases {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("a.mtl"), text).expect("writable");
        let file = folder.path().join("a.obj");
        fs::write(&file, "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("writable");
        let message = load(&file, &[]).expect_err(text).to_string();
        assert!(message.ends_with(expected), "{message}");
    }
}

#[test]
fn the_collected_malformed_obj_files_are_refused() {
    let Some(folder) = asset("negative/obj-ply") else { return };
    for (name, expected) in [
        ("empty.obj", "empty.obj: the file has no triangles"),
        ("malformed.obj", "malformed.obj:23:5: there is no vertex 12: the file has 8 so far"),
        ("malformed2.obj", "malformed2.obj:23:1: a face needs 3 corners, found 0"),
    ] {
        let message = load(&folder.join(name), &[]).expect_err(name).to_string();
        assert!(message.ends_with(expected), "{message}");
    }
}

/// Cuts and bends valid files in thousands of ways; whatever comes out, it is a scene or an error.
#[test]
fn no_damage_to_a_scene_makes_the_reader_panic() {
    let toml = include_str!("../scenes/lecture/14-cook-torrance.toml").as_bytes();
    let obj = b"mtllib x.mtl\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nusemtl a\ns 1\nf 1/1/1 2/1/1 3//1 4\nf -1 -2 -3\n";
    let mut state = 1_u32;
    let mut random = move |below: usize| {
        // Numerical Recipes' linear congruential generator: any will do.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for round in 0..1500 {
        let (name, source) = if round % 3 == 0 { ("a.toml", toml) } else { ("a.obj", &obj[..]) };
        let mut bytes = source.to_vec();
        for _ in 0..=random(3) {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes.truncate(at.max(1)),
                1 => bytes[at] = b"0-.#\"[]{}=\n\\/e\xff"[random(15)],
                2 => drop(bytes.remove(at)),
                _ => {
                    let copy = bytes[at..(at + random(40)).min(bytes.len())].to_vec();
                    let to = random(bytes.len());
                    bytes.splice(to..to, copy);
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        if let Err(message) = attempt(name, &bytes) {
            assert!(message.starts_with(name), "{message}");
        }
    }
}
