//! `gonio merge` and `gonio compare`.

use super::support::Folder;

/// A folder with `a.gfilm` (samples 0 and 1) and `b.gfilm` (2 and 3).
fn halves() -> Folder {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "a.gfilm", "--samples", "0..2"]);
    folder.cpu(&["render", "scene.toml", "-o", "b.gfilm", "--samples", "2..4"]);
    folder
}

#[test]
fn films_with_samples_in_common_are_refused_with_both_ranges() {
    let folder = halves();
    folder.cpu(&["render", "scene.toml", "-o", "c.gfilm", "--samples", "1..3"]);
    folder.file("old.png", "precious");
    let message = folder.fails(65, &["merge", "a.gfilm", "c.gfilm", "-o", "old.png"]);
    let expected = "error: c.gfilm: cannot be merged: both films hold the samples 1..2 (they hold 0..2 and 1..3)\n";
    assert_eq!(message, expected);
    assert_eq!(folder.bytes("old.png"), b"precious");
    folder.fails(65, &["merge", "a.gfilm", "a.gfilm", "-o", "old.png"]);
}

#[test]
fn films_of_different_pictures_are_refused_with_what_differs() {
    let folder = halves();
    let cases: [(&[&str], &str); 4] = [
        (&["--set", "material.red.color=[0,0,1]"], "scene"),
        (&["--seed", "5"], "seed"),
        (&["--size", "33x24"], "frame"),
        (&["--crop", "0,0,8,8"], "crop"),
    ];
    for (change, what) in cases {
        let args = [&["render", "scene.toml", "-o", "c.gfilm", "--samples", "2..4"], change].concat();
        folder.cpu(&args);
        let message = folder.fails(65, &["merge", "a.gfilm", "c.gfilm", "-o", "m.gfilm"]);
        assert!(message.starts_with("error: c.gfilm: cannot be merged: the films differ in "), "{message}");
        assert!(message.contains(what), "{what}: {message}");
    }
}

#[test]
fn merged_film_can_be_merged_again() {
    let folder = halves();
    folder.cpu(&["render", "scene.toml", "-o", "c.gfilm", "--samples", "4..5"]);
    folder.done(&["merge", "c.gfilm", "a.gfilm", "-o", "ac.gfilm"]);
    let merged = folder.done(&["merge", "ac.gfilm", "b.gfilm", "-o", "abc.gfilm"]);
    let whole = folder.cpu(&["render", "scene.toml", "-o", "whole.gfilm", "--spp", "5"]);
    assert_eq!(merged, whole);
    assert_eq!(folder.bytes("abc.gfilm"), folder.bytes("whole.gfilm"));
}

#[test]
fn film_can_come_from_standard_input_once() {
    let folder = halves();
    let direct = folder.done(&["merge", "a.gfilm", "b.gfilm", "-o", "m.png"]);
    let mut command = folder.command(&["merge", "-", "b.gfilm", "-o", "n.png"]);
    let piped = super::support::ended(command.write_stdin(folder.bytes("a.gfilm")));
    assert_eq!((piped.code, piped.text()), (Some(0), direct));
    folder.fails(2, &["merge", "-", "-", "-o", "n.png"]);
}

#[test]
fn merge_displays_with_other_settings_and_the_film_stays_the_same() {
    let folder = halves();
    let plain = folder.done(&["merge", "a.gfilm", "-o", "plain.png"]);
    let bright = folder.done(&["merge", "a.gfilm", "-o", "bright.png", "--exposure", "-1"]);
    assert_eq!(plain, bright, "the same film hash");
    assert_ne!(folder.bytes("plain.png"), folder.bytes("bright.png"));
}

#[test]
fn equal_pictures_compare_equal() {
    let folder = halves();
    folder.cpu(&["render", "scene.toml", "-o", "a.exr", "--samples", "0..2"]);
    let out = folder.done(&["compare", "a.exr", "a.gfilm"]);
    assert!(out.starts_with("pixels     0 of 768 differ (32x24)\nmax ULP    0 "), "{out}");
    assert!(out.ends_with("accepted\n"), "{out}");
}

#[test]
fn different_pictures_exit_with_1_and_within_limits_with_0() {
    let folder = halves();
    let ended = folder.run(&["compare", "a.gfilm", "b.gfilm"]);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    let text = ended.text();
    assert!(
        text.contains("film hash  different") && text.contains("\nrejected: ") && text.contains("pixels differ"),
        "{text}"
    );
    folder.done(&["compare", "a.gfilm", "b.gfilm", "--max-mse", "100", "--max-flip", "1"]);
    let ended = folder.run(&["compare", "a.gfilm", "b.gfilm", "--max-flip", "1", "--max-ulp", "1"]);
    assert_eq!(ended.code, Some(1));
    assert!(ended.text().contains("rejected: max ULP ") && ended.text().contains(" is above 1\n"), "{}", ended.text());
    let json = folder.run(&["compare", "a.gfilm", "b.gfilm", "--max-mse", "0", "--json", "--heatmap", "where.png"]);
    assert_eq!(json.code, Some(1));
    let report: serde_json::Value = serde_json::from_slice(&json.out).expect("JSON");
    assert_eq!(report["accepted"], false);
    assert_eq!(folder.picture("where.png").image.width, 32);
}

#[test]
fn pictures_of_different_size_cannot_be_compared() {
    let folder = halves();
    folder.cpu(&["render", "scene.toml", "-o", "small.png", "--size", "16x12"]);
    let message = folder.fails(65, &["compare", "a.gfilm", "small.png"]);
    assert!(message.contains("small.png") && message.contains("16x12") && message.contains("32x24"), "{message}");
    folder.fails(74, &["compare", "a.gfilm", "absent.png"]);
    folder.fails(2, &["compare", "-", "-"]);
}
