//! Fifty malformed inputs in text: one line that names the file and the place, exit code 65 or 74, soon, in little memory.

use super::support::{Folder, SCENE, TRIANGLE_OBJ, TRIANGLE_PLY, asset, program};
use std::path::Path;
use std::time::{Duration, Instant};

/// Bytes of address space that a small scene may take; a claim in a header must not be believed.
const MEMORY_KIB: u32 = 3 << 20;

/// Runs the program with little memory and gives its exit code and messages; a panic, a crash or a long run fails.
#[track_caller]
pub fn judge(folder: &Folder, args: &[&str]) -> (i32, String) {
    let start = Instant::now();
    let mut command = assert_cmd::Command::new(if cfg!(unix) { Path::new("sh") } else { program() });
    if cfg!(unix) {
        command.args(["-c", &format!("ulimit -v {MEMORY_KIB}; exec \"$0\" \"$@\"")]).arg(program());
    }
    command.args(args).current_dir(folder.path("")).timeout(Duration::from_secs(60));
    let ended = super::support::ended(&mut command);
    assert!(!ended.stderr.contains("panicked"), "{args:?}: {}", ended.stderr);
    let code = ended.code.unwrap_or_else(|| panic!("{args:?} was killed: {}", ended.stderr));
    assert!(start.elapsed() < Duration::from_secs(20), "{args:?} took {:?}", start.elapsed());
    (code, ended.stderr)
}

/// `judge` for a file that must be refused with one line that begins with `place` and contains `what`.
#[track_caller]
pub fn refused(folder: &Folder, args: &[&str], code: i32, place: &str, what: &str) {
    let (found, stderr) = judge(folder, args);
    assert_eq!(found, code, "{args:?}: {stderr}");
    let errors: Vec<&str> = stderr.lines().filter(|line| line.starts_with("error: ")).collect();
    let others = stderr.lines().filter(|line| !line.starts_with("error: ") && !line.starts_with("warn: ")).count();
    assert_eq!((errors.len(), others), (1, 0), "one line: {stderr}");
    assert!(errors[0].starts_with(&format!("error: {place}")), "{stderr}, expected {place}");
    assert!(errors[0].contains(what), "{stderr}, expected {what}");
}

#[track_caller]
pub fn scene_refused(folder: &Folder, file: &str, place: &str, what: &str) {
    refused(
        folder,
        &["render", file, "-o", "a.png", "--backend", "cpu", "--size", "8x6", "--spp", "1"],
        65,
        place,
        what,
    );
}

#[test]
fn every_broken_model_of_the_assets_is_refused_by_name() {
    let Some(root) = asset("negative") else { return };
    let folder = Folder::new();
    let mut folders = vec![root.clone()];
    let mut count = 0;
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("readable").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if !path.extension().is_some_and(|e| ["obj", "ply", "gltf", "glb"].iter().any(|known| e == *known)) {
                continue;
            }
            // Its buffer is a file that is not there: the one that cannot be read is named.
            let missing = path.ends_with("not_found.gltf");
            let name = path.display().to_string();
            let place = if missing { path.parent().expect("a folder").display().to_string() } else { name.clone() };
            let args = ["render", &name, "-o", "a.png", "--backend", "cpu", "--size", "8x6", "--spp", "1"];
            refused(&folder, &args, if missing { 74 } else { 65 }, &place, "");
            count += 1;
        }
    }
    assert!(count >= 20, "{count} files");
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn broken_toml_is_refused_at_its_line_and_column() {
    let folder = Folder::new();
    let change = |from: &str, to: &str| {
        let text = SCENE.replacen(from, to, 1);
        assert_ne!(text, SCENE, "{from}");
        text
    };
    let cases: Vec<(String, &str, &str)> = vec![
        ("[[object]]\nshape = \"sphere\"\n".into(), "bad.toml:1:1: ", "camera"),
        ("\0\0\0\0".into(), "bad.toml:1:5: ", ""),
        ("[camera".into(), "bad.toml:1:8: ", "]"),
        ("x = \"\"\"\nnever closed".into(), "bad.toml:", ""),
        (format!("x = {}{}", "[".repeat(50_000), "]".repeat(50_000)), "bad.toml:1:", ""),
        (format!("{SCENE}{SCENE}"), "bad.toml:", ""),
        (change("samples = 2", "samples = -2"), "bad.toml:3:11: ", "found -2"),
        (change("samples = 2", "samples = 2e9"), "bad.toml:3:11: ", "from 1 to 16777216"),
        (change("filter = \"box\"", "filter = 3"), "bad.toml:6:10: ", "must be"),
        (change("[film]", "[flim]"), "bad.toml:4:2: ", "did you mean \"film\"?"),
        (change("material = \"red\"", "material = \"rde\""), "bad.toml:18:12: ", "no material named \"rde\""),
        (change("shape = \"sphere\"", "shape = \"spehre\""), "bad.toml:", "did you mean \"sphere\"?"),
        (change("shape = \"sphere\"", "mesh = \"absent.obj\""), "bad.toml:", ""),
        (change("color = [0.8, 0.1, 0.1]", "color = [nan, 0, 0]"), "bad.toml:14:9: ", ""),
        (change("position = [3, 5, 4]", "position = [3, 5]"), "bad.toml:21:12: ", "found an array of 2"),
        (change("target = [0, 0.5, 0]", "target = [0, 1, 5]"), "bad.toml:9:10: ", "same point"),
    ];
    for (text, place, what) in cases {
        folder.file("bad.toml", &text);
        scene_refused(&folder, "bad.toml", place, what);
    }
    folder.file("bad.toml", b"x = \"\xff\"\n");
    scene_refused(&folder, "bad.toml", "bad.toml:1:6: ", "UTF-8");
}

#[test]
fn all_faults_of_a_toml_file_are_told_at_once_in_the_order_of_their_lines() {
    let folder = Folder::new();
    let faults = |text: &str, flags: &[&str]| -> Vec<String> {
        folder.file("bad.toml", text);
        let args = [&["render", "bad.toml", "-o", "a.png", "--backend", "cpu"], flags].concat();
        let (code, stderr) = judge(&folder, &args);
        assert_eq!(code, 65, "{stderr}");
        let told = |line: &str| line.strip_prefix("error: ").unwrap_or_else(|| panic!("{stderr}")).to_owned();
        stderr.lines().map(told).collect()
    };
    let text = SCENE
        .replace("samples = 2", "smaples = 2")
        .replace("filter = \"box\"", "filter = 3")
        .replace("eye = [0, 1, 5]", "eye = [0, 1]")
        .replace("color = [0.8, 0.1, 0.1]", "k_d = \"much\"\nk_s = -1\nmodle = \"phong\"")
        .replace("shape = \"sphere\"", "shape = \"spehre\"")
        .replace("intensity = 200", "intensity = -3");
    let expected = [
        "bad.toml:3:1: unknown key \"smaples\"; did you mean \"samples\"?",
        "bad.toml:6:10: \"filter\" must be",
        "bad.toml:8:7: \"eye\" must be three numbers",
        "bad.toml:14:7: \"k_d\" must be a number",
        "bad.toml:15:7: \"k_s\" must be a number",
        "bad.toml:16:1: unknown key \"modle\"; did you mean \"model\"?",
        "bad.toml:19:9: \"shape\" must be",
        "bad.toml:24:13: \"intensity\" must be",
    ];
    let found = faults(&text, &[]);
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.starts_with(expected), "{found}, expected {expected}");
    }
    // What a misspelt key leaves missing is not told beside it, but in another light it is.
    let lights = "[[light]]\ntype = \"point\"\npostion = [1, 2, 3]\n[[light]]\ntype = \"point\"\n";
    let found = faults(&format!("{SCENE}{lights}"), &[]);
    assert!(
        matches!(&found[..], [a, b] if a.contains("\"postion\"") && b.contains("needs the key \"position\"")),
        "{found:#?}"
    );
    // Panels are read before the rest; changes of the command line have no line.
    let panels = "[[panel]]\nlabel = 3\n[[panel]]\nlable = \"b\"\n";
    let found = faults(&format!("{}{panels}", SCENE.replace("samples = 2", "smaples = 2")), &["--set", "film.sise=3"]);
    let [set, render, label, lable] = &found[..] else { panic!("{found:#?}") };
    assert!(set.starts_with("--set film.sise=3: unknown key") && render.starts_with("bad.toml:3:1:"), "{found:#?}");
    assert!(label.contains("\"label\" must be") && lable.contains("unknown key \"lable\""), "{found:#?}");
    // More than anyone reads are counted.
    let many: String = (0..30).map(|i| format!("[[object]]\nshape = \"sphere\"\nradius = -{i}.5\n")).collect();
    let found = faults(&format!("{SCENE}{many}"), &[]);
    assert_eq!(found.len(), 21, "{found:#?}");
    assert!(
        found[20].starts_with("bad.toml:") && found[20].ends_with(": here and below are 10 more faults"),
        "{found:#?}"
    );
}

#[test]
fn broken_obj_is_refused_at_its_line() {
    let folder = Folder::new();
    let cases = [
        ("", "bad.obj", "no triangles"),
        ("# nothing\n", "bad.obj", "no triangles"),
        ("v 0 0 0\nf 1 1 4\n", "bad.obj:2:", "vertex 4"),
        ("v 0 0\n", "bad.obj:1:", ""),
        ("v 0 0 zero\n", "bad.obj:1:", "zero"),
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "bad.obj:1:", ""),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "bad.obj:4:", "3 corners"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "bad.obj:4:", "0"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 1 2\n", "bad.obj:4:", "-9"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/7 2/7 3/7\n", "bad.obj:4:", "7"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 99999999999999999999 1 2\n", "bad.obj:4:", "99999999999999999999"),
    ];
    for (text, place, what) in cases {
        folder.file("bad.obj", text);
        scene_refused(&folder, "bad.obj", place, what);
    }
}

/// Accepted on purpose, each with a warning that says what is missing.
#[test]
fn harmless_lacks_of_an_obj_are_a_warning_and_a_picture() {
    let folder = Folder::new();
    let cases = [
        // A mesh is as often handed on without its materials as with them, and is worth seeing.
        (format!("mtllib absent.mtl\n{TRIANGLE_OBJ}"), "absent.mtl"),
        (format!("usemtl nowhere\n{TRIANGLE_OBJ}"), "nowhere"),
    ];
    for (text, what) in cases {
        folder.file("odd.obj", text);
        let (code, stderr) =
            judge(&folder, &["render", "odd.obj", "-o", "a.png", "--backend", "cpu", "--size", "8x6", "--spp", "1"]);
        assert_eq!(code, 0, "{stderr}");
        assert!(stderr.lines().any(|line| line.starts_with("warn: ") && line.contains(what)), "{stderr}");
    }
}

#[test]
fn broken_ply_is_refused_at_its_line() {
    let folder = Folder::new();
    let change = |from: &str, to: &str| {
        let text = TRIANGLE_PLY.replacen(from, to, 1);
        assert_ne!(text, TRIANGLE_PLY, "{from}");
        text
    };
    let cases: Vec<(String, &str, &str)> = vec![
        ("plx\n".into(), "bad.ply:1: ", ""),
        (change("ascii 1.0", "ascii 2.0"), "bad.ply:2: ", ""),
        (change("element vertex 3", "element vertex 18446744073709551615"), "bad.ply", ""),
        (change("element vertex 3", "element vertex -3"), "bad.ply:3: ", "-3"),
        (change("format ascii", "format binary_little_endian"), "bad.ply", ""),
        (change("element face 1", "element face 4000000000"), "bad.ply", ""),
        (change("property float z\n", ""), "bad.ply", "z"),
        (change("3 0 1 2", "3 0 1 3"), "bad.ply:", "vertex 3 of 3"),
        (change("3 0 1 2", "2 0 1"), "bad.ply:", ""),
        (change("1 0 0\n", "1 0 inf\n"), "bad.ply:", ""),
    ];
    for (text, place, what) in cases {
        folder.file("bad.ply", &text);
        scene_refused(&folder, "bad.ply", place, what);
    }
}
