//! `--strict`: what loading and baking a scene warn of is an error.

use std::sync::atomic::{AtomicBool, Ordering};

/// Set once, before any command runs, like the level of the log.
static STRICT: AtomicBool = AtomicBool::new(false);

/// The log's target for what is worth a word and no warning.
pub const NOTE: &str = "gonio::note";

/// Warnings that are errors; exit code 65.
#[derive(Debug, thiserror::Error)]
#[error("{}\n--strict: a scene that is warned of is refused", .0.join("\n"))]
pub struct Strict(Vec<String>);

/// Makes warnings errors from here on.
pub fn demand(strict: bool) {
    STRICT.store(strict, Ordering::Relaxed);
}

/// Refuses a scene with warnings, where that is wanted.
pub fn check(warnings: &[String]) -> Result<(), Strict> {
    match STRICT.load(Ordering::Relaxed) && !warnings.is_empty() {
        true => Err(Strict(warnings.to_vec())),
        false => Ok(()),
    }
}

/// Prints the warnings of a scene, or refuses it.
pub fn tell(warnings: &[String]) -> Result<(), Strict> {
    check(warnings)?;
    warnings.iter().for_each(|warning| log::warn!("{warning}"));
    Ok(())
}

/// Prints what loading a scene chose for the user.
pub fn note(notes: &[String]) {
    notes.iter().for_each(|note| log::warn!(target: NOTE, "{note}"));
}
