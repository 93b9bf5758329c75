//! `--strict`: whatever a scene is warned of is an error.

use super::support::{Folder, SCENE};

#[test]
fn warnings_of_loading_are_errors_under_strict_for_every_command() {
    let folder = Folder::new();
    folder.file("warned.toml", SCENE.replace("color = [0.8, 0.1, 0.1]", "texture = \"no.png\""));
    let commands: [&[&str]; 4] = [
        &["render", "warned.toml", "-o", "a.png", "--backend", "cpu"],
        &["parity", "warned.toml", "--between", "cpu,cpu"],
        &["bench", "warned.toml", "--on", "cpu", "--rays", "16", "--runs", "1"],
        &["plot", "lobe", "warned.toml", "-o", "b.svg"],
    ];
    for command in commands {
        folder.done(command);
        let strict = [command, &["--strict"]].concat();
        let message = folder.fails(65, &strict);
        assert!(message.starts_with("error: warned.toml:14:11: no texture: no.png: "), "{command:?}: {message}");
        assert!(message.ends_with("error: --strict: a scene that is warned of is refused\n"), "{message}");
        // A scene without a warning is as good as ever.
        let good: Vec<&str> = strict.iter().map(|w| if *w == "warned.toml" { "scene.toml" } else { w }).collect();
        folder.done(&good);
    }
}

#[test]
fn warnings_of_baking_are_errors_under_strict() {
    let folder = Folder::new();
    // Ambient light has no effect there.
    folder.file("warned.toml", SCENE.replace("samples = 2", "samples = 2\nambient = 0.5\nintegrator = \"path\""));
    let args = ["render", "warned.toml", "-o", "a.png", "--backend", "cpu"];
    folder.done(&args);
    std::fs::remove_file(folder.path("a.png")).expect("it was written");
    let message = folder.fails(65, &[&args[..], &["--strict"]].concat());
    assert!(message.contains("ambient light has no effect"), "{message}");
    assert_eq!(folder.names(), ["scene.toml", "warned.toml"], "nothing was written");
}
