//! The Vulkan drivers of this machine, asked in a process of their own first: one that crashes or hangs there is passed over,
//! and no command goes down with it.

use super::{EXIT_DEVICE, ExitCode};
use crate::render::vulkan::choose_drivers;
use anyhow::Context;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::{Once, OnceLock, mpsc};
use std::thread;
use std::time::Duration;

/// Seconds in which the drivers have to list their devices: they take a tenth of one, but machines of many cards that sleep
/// take several. `GONIO_DRIVER_SECONDS` gives another number.
const LIST_SECONDS: u64 = 30;
/// Seconds in which a device has to prove itself exact: a slow software device compiles for many minutes.
const PROOF_SECONDS: u64 = 3600;
/// A child ends itself at its limit; whoever waits for it waits so much longer.
const GRACE: Duration = Duration::from_secs(2);
/// What the Vulkan loader says of each driver that it finds, before and behind the name of its manifest.
const FOUND: (&str, &str) = ("Found ICD manifest file ", ", version");

/// What is asked of the drivers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Question {
    /// Whether this device is exact; else what devices there are.
    pub device: Option<usize>,
    /// Of the drivers of these manifests alone; of all that the loader finds if there are none.
    pub manifests: Vec<PathBuf>,
}

/// What a child answered, or that it gave no answer.
#[derive(Clone, Debug)]
pub struct Reply {
    pub answer: Result<Value, String>,
    /// The manifests that the loader found.
    pub manifests: Vec<PathBuf>,
}

/// What there is.
#[derive(Clone, Debug)]
pub struct Drivers {
    /// Devices, and why there is none: `gonio devices --json` shows it.
    pub answer: Value,
    /// Drivers that are passed over, and why.
    pub broken: Vec<String>,
    /// The manifests of the others, where some are passed over.
    well: Vec<PathBuf>,
}

/// Starts asking, so that the answer is there when it is needed.
pub fn begin() {
    thread::spawn(found);
}

/// The drivers' answer. From here on this process uses those only that gave one.
pub fn ready() -> &'static Drivers {
    static READY: Once = Once::new();
    let drivers = found();
    READY.call_once(|| {
        drivers.broken.iter().for_each(|broken| log::warn!("{broken}"));
        if !drivers.broken.is_empty() {
            choose_drivers(&drivers.well);
        }
    });
    drivers
}

fn found() -> &'static Drivers {
    static FOUND: OnceLock<Drivers> = OnceLock::new();
    FOUND.get_or_init(|| find(ask))
}

/// Asks all drivers, and where they give no answer each alone.
fn find(ask: impl Fn(&Question) -> Reply) -> Drivers {
    let Reply { answer, manifests } = ask(&Question::default());
    if let Ok(answer) = &answer
        && (answer["problem"].is_null() || manifests.len() < 2)
    {
        return Drivers { answer: answer.clone(), broken: Vec::new(), well: Vec::new() };
    }
    let (mut well, mut broken) = (Vec::new(), Vec::new());
    for manifest in manifests {
        let alone = Question { manifests: vec![manifest.clone()], ..Question::default() };
        let problem = match ask(&alone).answer {
            Ok(answer) => answer["problem"].as_str().map(str::to_owned),
            Err(crash) => Some(crash),
        };
        match problem {
            Some(problem) => broken.push(format!("the Vulkan driver {} is passed over: {problem}", manifest.display())),
            None => well.push(manifest),
        }
    }
    let last =
        if well.is_empty() { answer } else { ask(&Question { manifests: well.clone(), ..Question::default() }).answer };
    match last {
        // None has anything to drive, which is no fault.
        Ok(answer) if well.is_empty() => Drivers { answer, broken: Vec::new(), well },
        Ok(answer) => Drivers { answer, broken, well },
        Err(crash) => {
            let answer = json!({ "devices": [], "problem": crash });
            let broken = if broken.is_empty() { vec![crash] } else { broken };
            Drivers { answer, broken, well: Vec::new() }
        }
    }
}

/// Asks in a child process.
pub fn ask(question: &Question) -> Reply {
    let seconds = limit(question);
    let (send, receive) = mpsc::channel();
    let asked = question.clone();
    // A thread waits for the child: what hangs in the kernel cannot even be killed.
    thread::spawn(move || send.send(output_of(&asked)));
    let hung = || format!("a Vulkan driver did not answer within {seconds} s");
    let output = match receive.recv_timeout(Duration::from_secs(seconds) + GRACE) {
        Ok(Ok(output)) => output,
        Ok(Err(error)) => return Reply { answer: Err(format!("{error:#}")), manifests: Vec::new() },
        Err(_) => return Reply { answer: Err(hung()), manifests: Vec::new() },
    };
    let noise = String::from_utf8_lossy(&output.stderr);
    let answer = match output.status.code() {
        Some(code) if code == i32::from(EXIT_DEVICE) => Err(hung()),
        _ => understand(&output),
    };
    if answer.is_err() {
        noise.lines().for_each(|line| log::info!("while asking the drivers: {line}"));
    }
    let manifest = |line: &str| Some(PathBuf::from(line.split_once(FOUND.0)?.1.split_once(FOUND.1)?.0));
    Reply { answer, manifests: noise.lines().filter_map(manifest).collect() }
}

/// Seconds that a question may take.
fn limit(question: &Question) -> u64 {
    let given = || std::env::var("GONIO_DRIVER_SECONDS").ok()?.parse().ok();
    if question.device.is_some() { PROOF_SECONDS } else { given().unwrap_or(LIST_SECONDS) }
}

fn output_of(question: &Question) -> anyhow::Result<Output> {
    let program = std::env::current_exe().context("cannot find this program's own file")?;
    let mut command = Command::new(program);
    command.args(["devices", "--probe"]).args(question.device.map(|index| index.to_string()));
    if question.device.is_none() {
        command.env("VK_LOADER_DEBUG", "all");
    }
    if !question.manifests.is_empty() {
        let files =
            std::env::join_paths(&question.manifests).context("a Vulkan manifest's name cannot be passed on")?;
        command.env_remove("VK_ADD_DRIVER_FILES").env("VK_DRIVER_FILES", &files).env("VK_ICD_FILENAMES", &files);
    }
    command.stdin(Stdio::null()).output().context("cannot start the process that asks the Vulkan drivers")
}

/// In the child: prints what `answer` finds out. Ends the process at the limit, also where nobody waits for it any more.
pub fn answer(device: Option<usize>, answer: impl FnOnce() -> Value) -> io::Result<ExitCode> {
    let seconds = limit(&Question { device, ..Question::default() });
    thread::spawn(move || {
        thread::sleep(Duration::from_secs(seconds));
        signal_hook::low_level::exit(EXIT_DEVICE.into());
    });
    writeln!(io::stdout(), "{}", answer())?;
    Ok(ExitCode::SUCCESS)
}

/// A child's answer, or that it died before it could give one.
fn understand(output: &Output) -> Result<Value, String> {
    let answer = serde_json::from_slice(&output.stdout).ok().filter(|_| output.status.success());
    answer.ok_or_else(|| {
        format!(
            "a Vulkan driver crashed the process that asked it ({}); -v shows what it said, and VK_DRIVER_FILES chooses \
             drivers",
            output.status
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What drivers of these names say: "good" and "idle" ones answer, "wild" ones crash, "sick" ones have a problem.
    fn machine(names: &'static [&'static str]) -> Drivers {
        find(|question| {
            let manifests: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
            let asked = if question.manifests.is_empty() { &manifests } else { &question.manifests };
            let has = |name: &str| asked.iter().any(|manifest| manifest.ends_with(name));
            let good = asked.iter().filter(|manifest| manifest.ends_with("good"));
            let devices: Vec<Value> = good.map(|_| json!({ "name": "card" })).collect();
            let problem = if has("sick") { json!("no luck") } else { Value::Null };
            let answer = if has("wild") {
                Err("it crashed".to_owned())
            } else {
                Ok(json!({ "devices": devices, "problem": problem }))
            };
            Reply { answer, manifests }
        })
    }

    #[test]
    fn a_driver_that_crashes_or_fails_costs_only_itself() {
        for names in [&["good", "wild"][..], &["sick", "good"], &["idle", "sick", "good", "wild"]] {
            let drivers = machine(names);
            assert_eq!(drivers.answer["devices"].as_array().map(Vec::len), Some(1), "{names:?}");
            assert!(drivers.well.contains(&PathBuf::from("good")), "{names:?}");
            let broken = names.iter().filter(|name| ["wild", "sick"].contains(name)).count();
            assert_eq!(drivers.broken.len(), broken, "{:?}", drivers.broken);
        }
        assert_eq!(machine(&["wild", "good"]).broken, ["the Vulkan driver wild is passed over: it crashed"]);
    }

    #[test]
    fn a_machine_of_well_drivers_is_asked_once_and_keeps_them_all() {
        for names in [&["good"][..], &["good", "idle"], &["idle"], &[]] {
            let drivers = machine(names);
            assert!(drivers.broken.is_empty() && drivers.well.is_empty(), "{names:?}");
        }
    }

    #[test]
    fn where_no_driver_answers_there_is_no_device_and_one_that_has_none_is_not_blamed() {
        let drivers = machine(&["wild"]);
        assert_eq!((drivers.answer["problem"].as_str(), drivers.broken.len()), (Some("it crashed"), 1));
        let drivers = machine(&["sick", "sick"]);
        assert_eq!((drivers.answer["problem"].as_str(), drivers.broken.len()), (Some("no luck"), 0));
    }

    #[cfg(unix)]
    #[test]
    fn a_child_that_aborts_has_given_no_answer() {
        use std::os::unix::process::ExitStatusExt;
        let status = std::process::ExitStatus::from_raw(6);
        let aborted = Output { status, stdout: b"{\"devices\":[".to_vec(), stderr: Vec::new() };
        let told = understand(&aborted).unwrap_err();
        assert!(told.contains("a Vulkan driver crashed the process that asked it (signal: 6"), "{told}");
    }
}
