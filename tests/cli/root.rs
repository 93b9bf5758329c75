//! Scenes of strangers: `--root` confines what they read, and without it what lies far from a scene is told.
#![cfg(target_os = "linux")]

use super::support::{Folder, SCENE, TRIANGLE_OBJ};
use std::os::unix::fs::symlink;

/// `inside/` with scenes that want the files of `outside/`, and of their own folder.
fn folder() -> Folder {
    let folder = Folder::new();
    for name in ["inside", "inside/scenes", "inside/shared", "outside"] {
        std::fs::create_dir(folder.path(name)).expect("a new folder");
    }
    for name in ["inside/scenes/own.obj", "inside/shared/shared.obj", "outside/secret.obj"] {
        folder.file(name, TRIANGLE_OBJ);
    }
    symlink("../../outside/secret.obj", folder.path("inside/scenes/link.obj")).expect("a link");
    symlink("../shared", folder.path("inside/scenes/library")).expect("a link");
    folder
}

/// The scene with a mesh of this name.
fn scene_of(mesh: &str) -> String {
    format!("{SCENE}[[object]]\nname = \"mesh\"\nmaterial = \"red\"\nshape = \"mesh\"\nfile = \"{mesh}\"\n")
}

const RENDER: [&str; 6] = ["render", "inside/scenes/a.toml", "--backend", "cpu", "-o", "a.png"];

#[test]
fn with_a_root_no_name_leads_out_of_it() {
    let folder = folder();
    let rooted = [&RENDER[..], &["--root", "inside"]].concat();
    for mesh in ["own.obj", "../shared/shared.obj", "library/shared.obj", "./../scenes/own.obj"] {
        folder.file("inside/scenes/a.toml", scene_of(mesh));
        folder.done(&rooted);
    }
    let absolute = folder.path("outside/secret.obj").display().to_string();
    for mesh in ["../../outside/secret.obj", "link.obj", &absolute, "/absent/mesh.obj", "../../outside/absent.obj"] {
        folder.file("inside/scenes/a.toml", scene_of(mesh));
        let told = folder.fails(74, &rooted);
        assert!(told.contains("it leads out of ") && told.contains("(--root)"), "{mesh}: {told}");
    }
    // The scene itself, and other formats.
    folder.file("outside/a.toml", SCENE);
    folder.fails(74, &["render", "outside/a.toml", "--root", "inside", "-o", "a.png"]);
    folder.file(
        "inside/a.gltf",
        r#"{"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"..%2Foutside%2Fsecret.obj"}]}"#,
    );
    let told = folder.fails(74, &["render", "inside/a.gltf", "--root", "inside", "-o", "a.png"]);
    assert!(told.contains("it leads out of "), "{told}");
    folder.file("inside/a.xml", r#"<scene version="3.0.0"><include filename="../outside/b.xml"/></scene>"#);
    folder.file("outside/b.xml", r#"<scene version="3.0.0"></scene>"#);
    let told = folder.fails(74, &["render", "inside/a.xml", "--root", "inside", "-o", "a.png"]);
    assert!(told.contains("no file \"../outside/b.xml\""), "{told}");
    assert!(folder.fails(74, &["render", "scene.toml", "--root", "absent"]).contains("--root absent"));
}

#[test]
fn without_a_root_a_file_far_from_the_scene_is_a_warning() {
    let folder = folder();
    for (mesh, is_far) in
        [("own.obj", false), ("../shared/shared.obj", false), ("../../outside/secret.obj", true), ("link.obj", true)]
    {
        folder.file("inside/scenes/a.toml", scene_of(mesh));
        let ended = folder.run(&RENDER);
        assert_eq!(ended.code, Some(0), "{}", ended.stderr);
        assert_eq!(ended.stderr.contains("outside/secret.obj: read from outside"), is_far, "{mesh}: {}", ended.stderr);
        let strict = folder.run(&[&RENDER[..], &["--strict"]].concat());
        assert_eq!(strict.code, Some(if is_far { 65 } else { 0 }), "{mesh}: {}", strict.stderr);
    }
}
