//! `gonio compare`: how far two pictures are apart.

use super::{EXIT_DIFFERS, ExitCode};
use crate::film::metrics::{Metrics, Step, compare};
use crate::film::read::read_picture;
use crate::film::{FilmError, OutputFile, write};
use anyhow::{Context, Result};
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Measures how far a picture is from a reference: PNG, JPEG, WebP, HDR, EXR and gfilm in any pair.
///
/// Exit code 0 if they are equal or, where limits are given, within all of them; 1 if not.
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  gonio compare golden.png new.png                        equal or not, and how far apart
  gonio compare golden.exr new.exr --max-flip 0.05        close enough to the eye
  gonio compare a.gfilm b.png --json                      any pair of formats; the measures as JSON
  gonio compare golden.png new.png --heatmap where.png    a picture of the difference")]
pub struct CompareArgs {
    /// The reference; `-` is standard input
    pub reference: PathBuf,
    /// The picture to be judged; `-` is standard input
    pub test: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Write the FLIP map in colours (black: equal)
    #[arg(long, value_name = "FILE.png")]
    pub heatmap: Option<PathBuf>,
    /// Accept a distance of N steps: of f32, or of codes where both files have the same integers
    #[arg(long, value_name = "N")]
    pub max_ulp: Option<u64>,
    /// Accept a mean squared error (linear light) of X
    #[arg(long, value_name = "X", value_parser = limit)]
    pub max_mse: Option<f64>,
    /// Accept a mean FLIP of X, 0 to 1
    #[arg(long, value_name = "X", value_parser = limit)]
    pub max_flip: Option<f64>,
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 => Ok(value),
        _ => Err("expected a number, 0 or more".into()),
    }
}

/// Runs the subcommand.
pub fn run(args: &CompareArgs) -> Result<ExitCode> {
    let stdin = Path::new("-");
    if args.reference == stdin && args.test == stdin {
        return Err(FilmError::Usage("only one of the two pictures can be standard input".into()).into());
    }
    let heatmap = args.heatmap.as_deref().map(open_heatmap).transpose()?;
    if !args.json && heatmap.as_ref().is_some_and(OutputFile::is_stdout) {
        return Err(FilmError::Usage("--heatmap - and the measures cannot both go to standard output".into()).into());
    }
    let reference = read_picture(&args.reference)?;
    let test = read_picture(&args.test)?;
    let (metrics, map) = compare((&args.reference, &reference), (&args.test, &test))?;
    if let Some(mut file) = heatmap {
        let written = write::write_rgb8(metrics.width, metrics.height, &map.colours(), &mut file);
        written.map_err(|e| FilmError::write(file.path(), e))?;
        file.commit()?;
    }
    let excesses = excesses(args, &metrics);
    let text = if args.json { json(&metrics, &excesses)? } else { table(&metrics, &excesses) };
    std::io::stdout().write_all(text.as_bytes()).context("cannot write standard output")?;
    Ok(if excesses.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(EXIT_DIFFERS) })
}

fn open_heatmap(path: &Path) -> Result<OutputFile, FilmError> {
    match write::Format::of(path)? {
        write::Format::Png => OutputFile::open(path),
        _ => Err(FilmError::Usage(format!("{}: a heat map is a .png file", path.display()))),
    }
}

/// Why the picture is not accepted; empty if it is.
pub fn excesses(args: &CompareArgs, metrics: &Metrics) -> Vec<String> {
    let mut found = Vec::new();
    if args.max_ulp.is_none() && args.max_mse.is_none() && args.max_flip.is_none() {
        if metrics.differing_pixels > 0 {
            found.push(format!("{} pixels differ", metrics.differing_pixels));
        } else if metrics.same_film == Some(false) {
            found.push("the pictures are equal, but the films' hashes are not".into());
        }
        return found;
    }
    if metrics.nan_mismatches > 0 {
        found.push(format!("{} values are not a number in one picture only", metrics.nan_mismatches));
    }
    if let Some(max) = args.max_ulp.filter(|max| metrics.max_ulp > *max) {
        found.push(format!("max ULP {} is above {max}", metrics.max_ulp));
    }
    if let Some(max) = args.max_mse.filter(|max| metrics.mse > *max) {
        found.push(format!("MSE {} is above {max}", metrics.mse));
    }
    if let Some(max) = args.max_flip.filter(|max| metrics.flip > *max) {
        found.push(format!("FLIP {} is above {max}", metrics.flip));
    }
    found
}

fn json(metrics: &Metrics, excesses: &[String]) -> Result<String> {
    #[derive(serde::Serialize)]
    struct Report<'a> {
        #[serde(flatten)]
        metrics: &'a Metrics,
        accepted: bool,
        excesses: &'a [String],
    }
    let report = Report { metrics, accepted: excesses.is_empty(), excesses };
    Ok(serde_json::to_string_pretty(&report)? + "\n")
}

fn table(metrics: &Metrics, excesses: &[String]) -> String {
    let step = match metrics.step {
        Step::Float => "f32 steps",
        Step::Eight => "8-bit codes",
        Step::Sixteen => "16-bit codes",
    };
    let pixels = u64::from(metrics.width) * u64::from(metrics.height);
    let at = metrics.max_abs_at.map(|[x, y]| format!(" at pixel {x},{y}")).unwrap_or_default();
    let psnr = metrics.psnr_db.map_or("equal".into(), |psnr| format!("{psnr:.2} dB"));
    let mut lines = vec![
        format!("pixels     {} of {pixels} differ ({}x{})", metrics.differing_pixels, metrics.width, metrics.height),
        format!("max ULP    {} {step}", metrics.max_ulp),
        format!("max error  {:.6e}{at}", metrics.max_abs),
        format!("MSE        {:.6e}", metrics.mse),
        format!("RMSE       {:.6e}", metrics.rmse),
        format!("relMSE     {:.6e}", metrics.rel_mse),
        format!("PSNR       {psnr}"),
        format!("FLIP       {:.6}", metrics.flip),
    ];
    if metrics.nan_mismatches > 0 {
        lines.push(format!("NaN        {} values in one picture only", metrics.nan_mismatches));
    }
    if let Some(same) = metrics.same_film {
        lines.push(format!("film hash  {}", if same { "equal" } else { "different" }));
    }
    lines.push(match excesses {
        [] => "accepted".into(),
        _ => format!("rejected: {}", excesses.join("; ")),
    });
    lines.join("\n") + "\n"
}
