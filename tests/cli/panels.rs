//! Scenes with panels: one picture of several films.

use super::support::{Folder, SCENE, line};

/// `panels.toml`: three panels in two columns.
fn folder() -> Folder {
    let folder = Folder::new();
    let panels = r#"
[[panel]]
label = "red"
[[panel]]
label = "green, wide"
set = ["material.red.color=[0.1,0.8,0.1]", "film.size=[40,24]"]
[[panel]]
label = "1/d²"
set = ["light.0.intensity=90"]
"#;
    folder.file("panels.toml", SCENE.replace("size = [32, 24]", "size = [32, 24]\ncolumns = 2") + panels);
    folder
}

/// The film hashes of a report, by panel.
fn hashes(report: &str) -> Vec<(String, String)> {
    let parts = report.split("panel ").skip(1);
    parts.map(|part| (part.lines().next().unwrap().to_owned(), line(part, "film").to_owned())).collect()
}

#[test]
fn panels_are_one_picture_of_films_that_labels_do_not_change() {
    let folder = folder();
    let report = folder.cpu(&["render", "panels.toml", "-o", "all.png"]);
    let found = hashes(&report);
    assert_eq!(found.iter().map(|(label, _)| label.as_str()).collect::<Vec<_>>(), ["red", "green, wide", "1/d²"]);
    // Columns of 32 and 40 with a gap of 6; two rows with a line of 24 under each.
    let whole = image::open(folder.path("all.png")).unwrap().to_rgb8();
    assert_eq!(whole.dimensions(), (78, 102));
    for (label, hash) in &found {
        let alone = folder.cpu(&["render", "panels.toml", "--panel", label, "-o", "one.gfilm"]);
        assert_eq!((line(&alone, "film"), alone.contains("panel")), (hash.as_str(), false), "{label}");
    }
    // The first panel is the scene as it is, and its pixels are those of its picture.
    let plain = folder.cpu(&["render", "scene.toml", "-o", "plain.png"]);
    assert_eq!(line(&plain, "film"), found[0].1);
    let plain = image::open(folder.path("plain.png")).unwrap().to_rgb8();
    assert!(plain.enumerate_pixels().all(|(x, y, pixel)| whole.get_pixel(x, y) == pixel));
    let numbered = folder.cpu(&["render", "panels.toml", "--panel", "2", "-o", "one.gfilm"]);
    assert_eq!(line(&numbered, "film"), found[2].1);
}

#[test]
fn the_command_line_has_the_last_word_over_panels() {
    let folder = folder();
    let report = folder.cpu(&["render", "panels.toml", "-o", "a.png", "--set", "light.0.intensity=50", "--bits", "16"]);
    let found = hashes(&report);
    let plain = folder.cpu(&["render", "scene.toml", "-o", "b.png", "--set", "light.0.intensity=50"]);
    assert_eq!((&found[0].1, &found[2].1), (&found[2].1, &found[0].1));
    assert_eq!(line(&plain, "film"), found[0].1);
    assert_eq!(image::open(folder.path("a.png")).unwrap().color(), image::ColorType::Rgb16);
    folder.cpu(&["render", "panels.toml", "-o", "a.png", "--stats", "s.json", "--set", "panel.0.label=first"]);
    let stats: serde_json::Value = serde_json::from_slice(&folder.bytes("s.json")).unwrap();
    assert_eq!((&stats["panels"][0]["panel"], &stats["panels"][2]["width"]), (&"first".into(), &32.into()));
}

#[test]
fn films_of_one_panel_merge_and_those_of_two_do_not() {
    let folder = folder();
    folder.cpu(&["render", "panels.toml", "--panel", "red", "--samples", "0..1", "-o", "a.gfilm"]);
    folder.cpu(&["render", "panels.toml", "--panel", "red", "--samples", "1..2", "-o", "b.gfilm"]);
    folder.cpu(&["render", "panels.toml", "--panel", "1/d²", "--samples", "1..2", "-o", "c.gfilm"]);
    let whole = folder.cpu(&["render", "panels.toml", "--panel", "red", "-o", "whole.png"]);
    assert_eq!(folder.done(&["merge", "a.gfilm", "b.gfilm", "-o", "m.png"]), whole);
    let message = folder.fails(65, &["merge", "a.gfilm", "c.gfilm", "-o", "m.gfilm"]);
    assert!(message.contains("the films differ in scene"), "{message}");
}

#[test]
fn parity_compares_every_panel() {
    let folder = folder();
    let json = folder.done(&["parity", "panels.toml", "--between", "cpu,cpu", "--json"]);
    folder.file("expect.json", &json);
    let text = folder.done(&["parity", "panels.toml", "--between", "cpu,cpu", "--expect", "expect.json"]);
    assert_eq!(text.matches(": 0 of ").count(), 3, "{text}");
    assert_eq!(text.matches("the recorded hash").count(), 3, "{text}");
    assert!(text.contains("panels.toml, panel \"1/d²\": 0 of 768 pixels differ"), "{text}");
}

#[test]
fn what_one_film_alone_can_do_asks_for_a_panel() {
    let folder = folder();
    let cases: [&[&str]; 5] = [
        &["-o", "a.exr"],
        &["-o", "a.gfilm"],
        &["-o", "a.exr", "--aov", "depth"],
        &["--pixel", "1,1"],
        &["-o", "a.png", "--time", "1"],
    ];
    for args in cases {
        let message = folder.fails(2, &[&["render", "panels.toml"], args].concat());
        assert!(message.contains("choose one by --panel: \"red\", \"green, wide\", \"1/d²\""), "{message}");
    }
    folder.cpu(&["render", "panels.toml", "--panel", "red", "--pixel", "1,1"]);
    let message = folder.fails(2, &["render", "panels.toml", "--panel", "rde", "-o", "a.png"]);
    assert!(message.contains("--panel rde: there are \"red\", \"green, wide\", \"1/d²\""), "{message}");
    let message = folder.fails(2, &["render", "scene.toml", "--panel", "red", "-o", "a.png"]);
    assert!(message.contains("the scene has no panels"), "{message}");
    assert_eq!(folder.names(), ["panels.toml", "scene.toml"]);
}

#[test]
fn wrong_panels_are_refused_with_their_place() {
    let cases = [
        ("label = \"a\"\n[[panel]]\nlabel = \"a\"", "bad.toml:25:9: there are two panels \"a\""),
        ("set = []", "[[panel]] needs the key \"label\""),
        ("label = \"a\"\nset = [\"render.samples\"]", "bad.toml:24:8: \"render.samples\" has no \"=\""),
        ("label = \"a\"\nset = \"render.samples=2\"", "\"set\" must be an array of changes"),
        ("label = \"a\"\nset = [\"render.sample=2\"]", "bad.toml:24:8: unknown key \"sample\""),
        ("label = \"a\"\nset = [\"material.blue.color=1\"]", "bad.toml:24:8: there is no item named \"blue\""),
        ("label = \"a\"\nset = [\"render.samples=0\"]", "bad.toml:24:8: \"samples\" must be an integer"),
    ];
    for (panel, expected) in cases {
        let folder = Folder::new();
        folder.file("bad.toml", format!("{}[[panel]]\n{panel}\n", SCENE.trim_start()));
        let message = folder.fails(65, &["render", "bad.toml", "-o", "a.png", "--backend", "cpu"]);
        assert!(message.contains(expected), "{panel}: {message}");
    }
}
