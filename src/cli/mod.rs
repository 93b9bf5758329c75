//! The command line: one file per subcommand. The only folder that prints.

pub mod bench;
mod closed;
pub mod compare;
pub mod convert;
pub mod devices;
mod drivers;
mod exact;
mod exposure;
mod fit;
mod functions;
mod gallery;
mod growth;
mod interrupt;
pub mod merge;
mod output;
pub mod parity;
pub mod plot;
mod progress;
pub mod render;
mod setup;
mod sheet;
mod strict;
mod tables;
mod team;
pub mod verify;
mod view;

use anyhow::Context;
use clap::{Parser, Subcommand};
use std::io::{self, Write};

/// Exit codes (README, "Exit codes").
pub const EXIT_DIFFERS: u8 = 1;
pub const EXIT_USAGE: u8 = 2;
pub const EXIT_BAD_INPUT: u8 = 65;
pub const EXIT_NO_DEVICE: u8 = 69;
pub const EXIT_IO: u8 = 74;
pub const EXIT_DEVICE: u8 = 75;
pub const EXIT_INTERRUPTED: u8 = 130;

/// How the program ends. `std::process::ExitCode` does not tell its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExitCode(u8);

impl ExitCode {
    pub const SUCCESS: Self = Self(0);
}

impl From<u8> for ExitCode {
    fn from(code: u8) -> Self {
        Self(code)
    }
}

/// A ray tracer in Rust and Vulkan compute. The same scene, seed and sample count give the same bits on every device.
#[derive(Parser)]
#[command(name = "gonio", version, max_term_width = 100, args_override_self = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Say more on stderr (twice: everything).
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
    /// Say nothing on stderr but errors.
    #[arg(short, long, global = true)]
    quiet: bool,
    /// Refuse a scene that loading or baking warns of (exit code 65).
    #[arg(long, global = true)]
    strict: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Make a picture of a scene.
    Render(render::RenderArgs),
    /// Write the scene file that shows the picture of a model, to go on from.
    Convert(convert::ConvertArgs),
    /// Add films of the same scene with different samples.
    Merge(merge::MergeArgs),
    /// Render the same samples on two backends and compare every bit.
    Parity(parity::ParityArgs),
    /// Measure rays a second on the CPU and on Vulkan devices, with every hit verified.
    Bench(bench::BenchArgs),
    /// Compare two pictures: ULP, MSE, FLIP.
    Compare(compare::CompareArgs),
    /// Draw a model: lobes, distributions, Fresnel, albedo and others.
    Plot(plot::PlotArgs),
    /// Prove that a device computes what it must, and that pictures are those of Mitsuba 3.
    Verify(verify::VerifyArgs),
    /// List what can be used, and why the rest cannot.
    Devices(devices::DevicesArgs),
    /// Print a completion script for a shell.
    #[command(after_help = "\
Examples:
  gonio completions bash > ~/.local/share/bash-completion/completions/gonio
  gonio completions zsh > ~/.zfunc/_gonio
  gonio completions fish > ~/.config/fish/completions/gonio.fish")]
    Completions {
        /// bash, zsh, fish, elvish or powershell.
        shell: clap_complete::Shell,
    },
}

/// Runs the program.
pub fn main() -> std::process::ExitCode {
    let ExitCode(code) = run();
    // A device that was given up may still be at work in threads of its driver: nothing that they use is taken from them.
    if crate::render::vulkan::is_any_stuck() {
        signal_hook::low_level::exit(code.into());
    }
    code.into()
}

/// Parses the command line and runs the subcommand; nothing is left in a buffer.
fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(told) => return said(&told),
    };
    let level = match (cli.quiet, cli.verbose) {
        (true, _) => log::LevelFilter::Error,
        (_, 0) => log::LevelFilter::Warn,
        (_, 1) => log::LevelFilter::Info,
        _ => log::LevelFilter::Trace,
    };
    env_logger::Builder::new()
        .filter_level(log::LevelFilter::Warn)
        .filter_module("gonio", level)
        .parse_default_env()
        .format(|out, record| match record.level() {
            log::Level::Info => writeln!(out, "{}", record.args()),
            _ if record.target() == strict::NOTE => writeln!(out, "note: {}", record.args()),
            level => writeln!(out, "{}: {}", level.as_str().to_lowercase(), record.args()),
        })
        .init();
    strict::demand(cli.strict);
    let result = match &cli.command {
        Command::Render(args) => render::run(args, cli.quiet),
        Command::Convert(args) => convert::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Parity(args) => parity::run(args, cli.quiet),
        Command::Bench(args) => bench::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Plot(args) => plot::run(args),
        Command::Verify(args) => verify::run(args),
        Command::Devices(args) => devices::run(args),
        Command::Completions { shell } => {
            // Into memory first: the generator panics where it cannot write.
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut <Cli as clap::CommandFactory>::command(), "gonio", &mut script);
            let written = io::stdout().write_all(&script);
            written.context("cannot write standard output").map(|()| ExitCode::SUCCESS)
        }
    };
    // What is still in standard output's buffer, or went where nothing arrives, would be lost without a word.
    let flushed = |code| arrived().context("cannot write standard output").map(|()| code);
    result.and_then(flushed).unwrap_or_else(|error| failed(&error))
}

/// Whether what was printed is out.
fn arrived() -> io::Result<()> {
    io::stdout().flush().and_then(|()| closed::check())
}

/// Prints what clap has to say: help, or what is wrong with the command line.
fn said(told: &clap::Error) -> ExitCode {
    match told.print().and_then(|()| arrived()) {
        _ if told.use_stderr() => ExitCode::from(EXIT_USAGE),
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&anyhow::Error::from(error).context("cannot write standard output")),
    }
}

/// Prints an error; its exit code, also where nobody can be told.
fn failed(error: &anyhow::Error) -> ExitCode {
    // A reader that has gone away (`gonio devices | head -1`) is no error worth a word.
    if is_broken_pipe(error) {
        return ExitCode::SUCCESS;
    }
    // Of a scene file all that is wrong is told, each on its line. `eprintln!` would panic where standard error is full.
    let told = message(error).lines().map(|line| format!("error: {line}\n")).collect::<String>();
    let _ = io::stderr().write_all(told.as_bytes());
    ExitCode::from(exit_code(error))
}

/// The error and its causes on one line, but for causes that it already tells.
fn message(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |text, cause| match text.as_str() {
        "" => cause,
        told if told.contains(&cause) => text,
        _ => format!("{text}: {cause}"),
    })
}

/// Whether text was printed for somebody who reads no more. Pictures and films are not text: half of one is none.
fn is_broken_pipe(error: &anyhow::Error) -> bool {
    !error.chain().any(|cause| cause.is::<crate::film::FilmError>())
        && error
            .chain()
            .any(|cause| cause.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe))
}

/// A command line that parses but asks for what does not exist: exit code 2.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct Usage(pub String);

/// The documented exit code of an error.
fn exit_code(error: &anyhow::Error) -> u8 {
    use crate::{bake::BakeError, film::FilmError, film::MergeError, render::RenderError, scene::SceneError};
    for cause in error.chain() {
        if cause.is::<Usage>() {
            return EXIT_USAGE;
        }
        if let Some(error) = cause.downcast_ref::<SceneError>() {
            return match () {
                _ if error.is_io() => EXIT_IO,
                _ if error.is_memory() => EXIT_DEVICE,
                _ => EXIT_BAD_INPUT,
            };
        }
        if let Some(error) = cause.downcast_ref::<RenderError>() {
            return match error {
                RenderError::NoDevice(_) => EXIT_NO_DEVICE,
                RenderError::Aborted => EXIT_INTERRUPTED,
                RenderError::OutOfMemory(_)
                | RenderError::Lost(_)
                | RenderError::TooLarge(_)
                | RenderError::Failed(_) => EXIT_DEVICE,
            };
        }
        if let Some(error) = cause.downcast_ref::<FilmError>() {
            return error.exit_code();
        }
        if let Some(error) = cause.downcast_ref::<BakeError>() {
            return if matches!(error, BakeError::Aborted) { EXIT_INTERRUPTED } else { EXIT_BAD_INPUT };
        }
        if cause.is::<crate::memory::Shortage>() {
            return EXIT_DEVICE;
        }
        if cause.is::<MergeError>() || cause.is::<strict::Strict>() {
            return EXIT_BAD_INPUT;
        }
        if cause.is::<io::Error>() {
            return EXIT_IO;
        }
    }
    EXIT_DEVICE
}
