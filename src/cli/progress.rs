//! The progress bar: samples done, rate and remaining time, on stderr when it is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;

/// A bar over `total` samples (pixels times samples a pixel); hidden unless `show` and stderr is a terminal.
pub fn bar(total: u64, show: bool) -> ProgressBar {
    let bar = ProgressBar::new(total);
    if !show || !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    // The template is a constant that indicatif accepts.
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} %  {per_sec} samples  {eta} left") {
        bar.set_style(style);
    }
    bar
}
