//! Every call of one render that may fail does so once.

use super::{Folder, done, has_device, library, stderr};
use std::path::Path;
use std::process::Command;

/// Out of host memory, out of device memory, device lost, initialisation failed.
const CODES: [i32; 4] = [-1, -2, -4, -3];

/// The command with a loader that fails call `call` with `code`.
fn failing<'a>(command: &'a mut Command, loader: &Path, call: usize, code: i32) -> &'a mut Command {
    command.env("GONIO_VULKAN_LOADER", loader);
    command.env("GONIO_FAULT_CALL", call.to_string()).env("GONIO_FAULT_CODE", code.to_string())
}

/// Fails the calls of a render with `args` one by one, each with one of the codes, on all cores; `judge` sees the exit code,
/// the picture if there is one, and what the program said.
fn each_call(args: &[&str], gpu: bool, judge: impl Fn(i32, Option<&[u8]>, &str) -> Result<(), String> + Sync) {
    let shared = Folder::new();
    let loader = library(&shared, "loader.cpp", &[]);
    let log = shared.path("calls");
    let prepared = |folder: &Folder| {
        let mut command = folder.render(args);
        command.envs(gpu.then_some(("GONIO_FAULT_GPU", "1")));
        command
    };
    // The first run keeps what the device is asked once.
    done(failing(&mut prepared(&shared), &loader, 0, 0));
    done(failing(&mut prepared(&shared), &loader, 0, 0).env("GONIO_FAULT_LOG", &log));
    let told = std::fs::read_to_string(log).expect("a log");
    let numbers = told.lines().filter_map(|line| line.split(' ').next()?.parse::<usize>().ok());
    let count = numbers.max().unwrap_or(0);
    assert!(count > 100, "{count} calls");

    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let found: Vec<String> = std::thread::scope(|scope| {
        let one = |first: usize| {
            let folder = Folder::new();
            let mut found = Vec::new();
            for call in (1 + first..=count).step_by(threads) {
                // Neighbours differ, and in every run of four each code comes once.
                let code = CODES[(call + call / 4) % 4];
                let output = failing(&mut prepared(&folder), &loader, call, code).output().expect("the program starts");
                let (picture, said) = (folder.take_picture(), stderr(&output));
                let verdict = match output.status.code() {
                    None => Err(format!("{}", output.status)),
                    Some(_) if !folder.names().is_empty() => Err(format!("it left {:?}", folder.names())),
                    Some(code) => judge(code, picture.as_deref(), &said),
                };
                if let Err(why) = verdict {
                    found.push(format!("call {call}, code {code}: {why}: {said}"));
                }
            }
            found
        };
        let threads: Vec<_> = (0..threads).map(|first| scope.spawn(move || one(first))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no panic")).collect()
    });
    assert!(found.is_empty(), "{} of {count}: {found:#?}", found.len());
}

#[test]
fn a_call_that_fails_on_a_named_device_ends_the_program_as_documented() {
    if !has_device() {
        return;
    }
    let expected = Folder::new().expected();
    each_call(&["--backend", "vulkan"], false, |code, picture, said| match (code, picture) {
        (0, Some(bytes)) if bytes == expected => Ok(()),
        (69 | 75, None) if said.contains("error: ") => Ok(()),
        (code, picture) => Err(format!("exit code {code}, a picture: {}", picture.is_some())),
    });
}

#[test]
fn a_call_that_fails_on_a_gpu_that_nobody_named_leaves_the_picture_to_the_cpu() {
    if !has_device() {
        return;
    }
    let expected = Folder::new().expected();
    each_call(&[], true, |code, picture, _| match (code, picture) {
        (0, Some(bytes)) if bytes == expected => Ok(()),
        (code, picture) => Err(format!("exit code {code}, a picture: {}", picture.is_some())),
    });
}

#[test]
fn a_device_that_is_given_up_at_work_does_not_take_the_program_down() {
    if !has_device() {
        return;
    }
    let folder = Folder::new();
    let loader = library(&folder, "loader.cpp", &[]);
    let log = folder.path("calls");
    let args = ["--backend", "vulkan"];
    done(failing(&mut folder.render(&args), &loader, 0, 0).env("GONIO_FAULT_LOG", &log));
    let told = std::fs::read_to_string(log).expect("a log");
    let behind = told.rsplit_once("vkCreateComputePipelines").expect("it compiles").1;
    let wait = behind.lines().find(|line| line.ends_with("vkWaitForFences")).expect("it waits for kernels");
    let wait = wait.split(' ').next().and_then(|number| number.parse().ok()).expect("a number");
    // The kernels' first run, in threads of the driver. A program that ends in the usual way crashes in one of ten such runs.
    for _ in 0..24 {
        let output = failing(&mut folder.render(&args), &loader, wait, -4).output().expect("the program starts");
        assert_eq!(output.status.code(), Some(75), "{} {}", output.status, stderr(&output));
    }
}
