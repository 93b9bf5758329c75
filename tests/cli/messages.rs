//! Exit codes, help, completions, devices: what a user sees before the first picture and when something is wrong.

use super::support::{Ended, Folder, ended, program};
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

#[test]
fn wrong_usage_exits_with_2() {
    let folder = Folder::new();
    let cases: &[(&[&str], &str)] = &[
        (&[], "Usage: gonio"),
        (&["rendre"], "render"),
        (&["render"], "<SCENE>"),
        (&["render", "scene.toml", "--bogus"], "--bogus"),
        (&["render", "scene.toml", "--size", "32"], "WIDTHxHEIGHT"),
        (&["render", "scene.toml", "--size", "0x5"], "WIDTHxHEIGHT"),
        (&["render", "scene.toml", "--size", "70000x5"], "1 to 65535"),
        (&["render", "scene.toml", "--spp", "0"], "--spp"),
        (&["render", "scene.toml", "--spp", "2", "--samples", "0..2"], "--samples"),
        (&["render", "scene.toml", "--samples", "2..2"], "A < B"),
        (&["render", "scene.toml", "--samples", "0..99999999"], "16777216"),
        (&["render", "scene.toml", "--crop", "5,5,5,9"], "X0 < X1"),
        (&["render", "scene.toml", "--crop", "0,0,33,24"], "--crop 33x24+0+0 is not inside the frame 32x24+0+0"),
        (&["render", "scene.toml", "--crop", "1,0,4294967295,24"], "is not inside the frame"),
        (&["render", "scene.toml", "--pixel", "5"], "X,Y"),
        (&["render", "scene.toml", "--time", "-1"], "--time"),
        (&["render", "scene.toml", "--time", "nan"], "seconds"),
        (&["render", "scene.toml", "--set", "film.unit"], "has no \"=\""),
        (&["render", "scene.toml", "--set", ".=1"], "empty key"),
        (&["render", "scene.toml", "--threads", "0"], "1 to 1024"),
        (&["render", "scene.toml", "--threads", "1000000"], "1 to 1024"),
        (&["parity", "scene.toml", "--threads", "0"], "1 to 1024"),
        (&["render", "scene.toml", "--bits", "12"], "8, 16"),
        (&["render", "scene.toml", "--exposure", "nan"], "-100 to 100"),
        (&["render", "scene.toml", "-o", "a.gif"], ".gif"),
        (&["render", "scene.toml", "-o", "noextension"], "no extension"),
        (&["render", "scene.toml", "-o", "a.png", "--aov", "depth"], "--aov needs an .exr"),
        (&["render", "scene.toml", "-o", "a.exr", "--aov", "depht"], "allowed: depth"),
        (&["render", "scene.toml", "-o", "-", "--stats", "-"], "standard output"),
        (&["render", "scene.toml", "--elevation", "91"], "-90 to 90"),
        (&["render", "scene.toml", "--look-from", "1,2"], "X,Y,Z"),
        (&["render", "scene.toml", "--look-from", "1,2,3", "--look-at", "1,2,3"], "the same point"),
        (&["render", "scene.toml", "--zoom", "0"], "1e-6"),
        (&["render", "scene.toml", "--fov", "180"], "179"),
        (&["render", "scene.toml", "--environment-rotate", "90"], "--environment"),
        (&["render", "scene.toml", "--background", "mauvish"], "a colour"),
        (&["render", "scene.toml", "--scale", "0"], "0.001 to 64"),
        (&["render", "scene.toml", "--scale", "64", "--size", "3x3"], "--size"),
        (&["render", "scene.toml", "-o", "a.jpg", "--transparent"], "no alpha"),
        (&["merge", "-o", "a.png"], "FILM"),
        (&["compare", "a.png"], "<TEST>"),
        (&["completions", "basic"], "bash"),
    ];
    for (args, expected) in cases {
        let message = folder.fails(2, args);
        assert!(message.contains(expected), "{args:?}: {message}");
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn bad_scene_exits_with_65_and_says_where_and_what_was_meant() {
    let folder = Folder::new();
    folder.file("bad.toml", super::support::SCENE.replace("samples = 2", "smaples = 2"));
    let message = folder.fails(65, &["render", "bad.toml"]);
    assert_eq!(message, "error: bad.toml:3:1: unknown key \"smaples\"; did you mean \"samples\"?\n");
    let mut piped = folder.command(&["render", "-"]);
    let Ended { code, stderr, .. } = ended(piped.write_stdin(folder.bytes("bad.toml")));
    assert_eq!(code, Some(65));
    assert!(stderr.starts_with("error: <stdin>:3:1: unknown key \"smaples\""), "{stderr}");
}

#[test]
fn device_that_is_not_there_exits_with_69() {
    let folder = Folder::new();
    let message = folder.fails(69, &["render", "scene.toml", "-o", "a.png", "--device", "nonsense"]);
    assert_eq!(message.lines().count(), 1, "{message}");
    folder.fails(69, &["render", "scene.toml", "-o", "a.png", "--device", "999"]);
}

#[test]
fn what_cannot_be_read_or_written_exits_with_74() {
    let folder = Folder::new();
    folder.file("file", "");
    std::fs::create_dir(folder.path("folder.png")).expect("a new folder");
    let cases: &[(&[&str], &str)] = &[
        (&["render", "absent.toml"], "absent.toml"),
        (&["render", "scene.toml", "-o", "no/such/folder/a.png"], "no/such/folder"),
        (&["render", "scene.toml", "-o", "file/a.png"], "file/a.png"),
        (&["render", "scene.toml", "-o", "folder.png"], "folder.png"),
        (&["render", "scene.toml", "-o", "a.png", "--stats", "no/s.json"], "no/s.json"),
        (&["merge", "absent.gfilm", "-o", "a.png"], "absent.gfilm"),
        (&["compare", "absent.png", "absent.png"], "absent.png"),
    ];
    for (args, expected) in cases {
        let message = folder.fails(74, args);
        assert!(message.contains(expected) && message.lines().count() == 1, "{args:?}: {message}");
    }
    assert_eq!(folder.names(), ["file", "folder.png", "scene.toml"], "nothing unfinished is left");
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_is_reported() {
    let folder = Folder::new();
    let full = ["render", "scene.toml", "--backend", "cpu", "--format", "png", "-o", "/dev/full"];
    let message = folder.fails(74, &full);
    assert!(message.starts_with("error: cannot write /dev/full: No space left"), "{message}");
    let stats = folder.fails(74, &["render", "scene.toml", "--backend", "cpu", "--stats", "/dev/full"]);
    assert!(stats.starts_with("error: cannot write /dev/full: No space left"), "{stats}");
    for args in [
        &["render", "scene.toml", "--backend", "cpu", "-o", "-"][..],
        &["render", "scene.toml", "--backend", "cpu", "-o", "a.png"],
        &["render", "scene.toml", "--backend", "cpu", "--pixel", "1,1"],
        &["parity", "scene.toml", "--between", "cpu,cpu"],
        &["parity", "scene.toml", "--between", "cpu,cpu", "--json"],
        &["compare", "a.png", "a.png"],
        &["devices"],
        &["completions", "bash"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
        let child =
            Command::new(program()).args(args).current_dir(folder.path("")).stdout(full).output().expect("started");
        let stderr = String::from_utf8_lossy(&child.stderr);
        assert_eq!(child.status.code(), Some(74), "{args:?}: {stderr}");
        assert!(
            stderr.starts_with("error: ") && stderr.lines().count() <= 3 && stderr.contains("No space left"),
            "{args:?}: {stderr}"
        );
    }
}

#[test]
fn without_a_vulkan_driver_auto_uses_the_cpu_and_says_why_when_asked() {
    let folder = Folder::new();
    for (variable, value) in [("VK_DRIVER_FILES", "/nonexistent"), ("GONIO_VULKAN_LOADER", "/nonexistent/libvulkan.so")]
    {
        let without = |args: &[&str]| ended(folder.command(args).env(variable, value));
        let auto = without(&["render", "scene.toml", "-o", "auto.png"]);
        assert_eq!((auto.code, auto.stderr.as_str()), (Some(0), ""));
        let told = without(&["render", "scene.toml", "-o", "auto.png", "-v"]).stderr;
        assert!(told.contains("Vulkan") && told.contains("rendering on cpu ("), "{told}");
        assert_eq!(auto.text(), folder.cpu(&["render", "scene.toml", "-o", "cpu.png"]));
        assert_eq!(folder.bytes("auto.png"), folder.bytes("cpu.png"));
        let vulkan = without(&["render", "scene.toml", "-o", "vulkan.png", "--backend", "vulkan"]);
        assert_eq!(vulkan.code, Some(69), "{}", vulkan.stderr);
        assert_eq!(vulkan.stderr.lines().count(), 1, "{}", vulkan.stderr);
    }
}

#[test]
fn devices_lists_the_cpu_whatever_the_drivers_are() {
    let folder = Folder::new();
    folder.file("broken.json", "{ \"ICD\": ");
    folder.file("absent.json", "{\"file_format_version\": \"1.0.0\", \"ICD\": {\"library_path\": \"/nonexistent.so\", \"api_version\": \"1.2.0\"}}");
    let manifest = |name: &str| folder.path(name).display().to_string();
    for drivers in [None, Some("/nonexistent".to_owned()), Some(manifest("broken.json")), Some(manifest("absent.json"))]
    {
        let mut command = folder.command(&["devices"]);
        if let Some(drivers) = &drivers {
            command.env("VK_DRIVER_FILES", drivers);
        }
        let listed = ended(&mut command);
        assert_eq!(listed.code, Some(0), "{drivers:?}: {}", listed.stderr);
        let text = listed.text();
        assert!(text.starts_with("DEVICE "), "{text}");
        assert!(text.contains("the CPU backend ("), "{drivers:?}: {text}");
        if drivers.is_some() {
            assert!(text.lines().count() > 2, "it says why there is no device: {text}");
        }
    }
    let json: serde_json::Value = serde_json::from_str(&folder.done(&["devices", "--json"])).expect("JSON");
    assert_eq!(json["cpu"]["usable"], true);
}

#[test]
fn reader_that_goes_away_is_no_error() {
    let folder = Folder::new();
    for args in [
        &["devices"][..],
        &["completions", "zsh"],
        &["--version"],
        &["render", "--help"],
        &["parity", "scene.toml", "--between", "cpu,cpu"],
    ] {
        assert_eq!(without_a_reader(&folder, args), (Some(0), String::new()), "{args:?}");
    }
    // As `head -1`: the first line is read, then the pipe is closed.
    let mut child = Command::new(program()).arg("devices").stdout(Stdio::piped()).spawn().expect("started");
    let mut first = String::new();
    BufReader::new(child.stdout.take().expect("piped")).read_line(&mut first).expect("a line");
    assert!(first.starts_with("DEVICE "), "{first}");
    assert_eq!(child.wait().expect("ended").code(), Some(0));
}

/// Runs the program with standard output closed at the other end; its exit code and what it says.
fn without_a_reader(folder: &Folder, args: &[&str]) -> (Option<i32>, String) {
    // The reader is gone before the program begins: a small picture fits into a pipe that somebody still holds.
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let mut child = Command::new(program());
    child.args(args).current_dir(folder.path("")).stdout(writer).stderr(Stdio::piped());
    let mut child = child.spawn().expect("started");
    let mut stderr = String::new();
    child.stderr.take().expect("piped").read_to_string(&mut stderr).expect("text");
    (child.wait().expect("ended").code(), stderr)
}

#[test]
fn picture_that_nobody_reads_to_its_end_is_an_error() {
    let folder = Folder::new();
    for args in [
        &["render", "scene.toml", "--backend", "cpu", "-o", "-"][..],
        &["render", "scene.toml", "--backend", "cpu", "-o", "-", "--format", "gfilm"],
        &["plot", "fresnel", "-o", "-"],
    ] {
        let (code, stderr) = without_a_reader(&folder, args);
        assert_eq!(code, Some(74), "{args:?}: {stderr}");
        assert!(stderr.starts_with("error: cannot write standard output: Broken pipe"), "{args:?}: {stderr}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn full_standard_error_changes_no_exit_code_but_that_of_a_report_on_it() {
    let folder = Folder::new();
    folder.cpu(&["render", "scene.toml", "-o", "a.png"]);
    let cases: &[(i32, &[&str])] = &[
        (2, &["render", "scene.toml", "--bogus"]),
        (65, &["render", "a.png"]),
        (74, &["render", "absent.toml"]),
        (69, &["render", "scene.toml", "--device", "nonsense", "-o", "b.png"]),
        (0, &["render", "scene.toml", "-vv", "--backend", "cpu", "-o", "b.png"]),
        (74, &["render", "scene.toml", "--backend", "cpu", "-o", "-"]),
    ];
    let closed = || {
        let mut reader = Command::new("true").stdin(Stdio::piped()).spawn().expect("started");
        let pipe = reader.stdin.take().expect("piped");
        reader.wait().expect("ended");
        Stdio::from(pipe)
    };
    let full = || Stdio::from(std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full"));
    for &(code, args) in cases {
        let ended = |stderr: Stdio| {
            let mut command = Command::new(program());
            command.args(args).current_dir(folder.path("")).stdout(Stdio::piped()).stderr(stderr);
            command.output().expect("started").status.code()
        };
        assert_eq!(ended(full()), Some(code), "{args:?}, full");
        // A report that nobody reads is text like any other.
        let code = if args.contains(&"-") { 0 } else { code };
        assert_eq!(ended(closed()), Some(code), "{args:?}, closed");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn help_that_cannot_be_written_is_an_error() {
    for args in [&["--help"][..], &["render", "--help"], &["--version"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("/dev/full");
        let child = Command::new(program()).args(args).stdout(full).output().expect("started");
        let stderr = String::from_utf8_lossy(&child.stderr);
        assert_eq!(child.status.code(), Some(74), "{args:?}: {stderr}");
        assert!(stderr.starts_with("error: cannot write standard output: No space left"), "{args:?}: {stderr}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_was_closed_is_an_error_and_costs_no_file() {
    let folder = Folder::new();
    let run = |args: &str, redirection: &str| {
        let line = format!("exec '{}' {args} {redirection}", program().display());
        let mut shell = Command::new("sh");
        let output = shell.args(["-c", &line]).current_dir(folder.path("")).output().expect("sh starts");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    for args in ["render scene.toml --backend cpu -o a.png", "devices", "--help", "completions bash"] {
        let (code, stderr) = run(args, ">&-");
        assert_eq!(code, Some(74), "{args}: {stderr}");
        assert_eq!(stderr, "error: cannot write standard output: it is closed\n", "{args}");
        // Whoever wants none of it opens `/dev/null`, for reading too if he likes.
        for redirection in [">/dev/null", "1<>/dev/null"] {
            assert_eq!(run(args, redirection), (Some(0), String::new()), "{args} {redirection}");
        }
    }
    assert_eq!(folder.names(), ["a.png", "scene.toml"]);
}

#[test]
fn completions_of_every_shell_know_the_subcommands() {
    let folder = Folder::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = folder.done(&["completions", shell]);
        for word in ["render", "parity", "merge", "compare", "devices", "spp"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
}

#[test]
fn help_of_every_subcommand_has_examples_that_begin_with_the_programs_name() {
    let folder = Folder::new();
    for name in ["render", "merge", "parity", "compare", "devices", "completions"] {
        let help = folder.done(&[name, "--help"]);
        let (_, examples) =
            help.split_once("Examples:\n").unwrap_or_else(|| panic!("no examples in the help of {name}"));
        assert!(examples.contains(&format!("  gonio {name} ")), "{name}: {examples}");
        assert!(help.contains(&format!("Usage: gonio {name}")));
    }
}
