//! `gonio verify`: proofs, as one table.

use super::setup::{BackendFlags, bake_scene, crop_of, film_of};
use super::{EXIT_DIFFERS, ExitCode, Usage, functions, strict, team};
use crate::film::read::read_picture;
use crate::film::{Film, FilmError, Image, OutputFile, write};
use crate::scene::{Scene, load};
use crate::verify::mitsuba::{
    ACCEPTED_MIN, Case, DisplayTest, Reference, display_test, find_cases, reduce, samples_for, show_z, z_test,
};
use crate::verify::report::{Outcome, Row, all_proved, table};
use crate::watch::Watch;
use anyhow::Context;
use clap::Args;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Side of a block of the documentation's pictures that is compared as one pixel: below it, filters and JPEG differ.
const BLOCK: u32 = 4;
/// Samples of each pixel of a documentation picture: 256 of each block. With 64 of each, metal's noise alone reaches the limit.
const DISPLAY_SAMPLES: u32 = 16;

#[derive(Args)]
#[command(after_help = "\
Examples:
  gonio verify --functions                                every function on 2^22 sets of arguments, CPU against device
  gonio verify --functions 100000 --only fresnel          some of them on fewer
  gonio verify --mitsuba ../mitsuba-data                  every scene that has a reference
  gonio verify --mitsuba ../mitsuba-data --only envmap    those whose names say envmap
  gonio verify --mitsuba ../mitsuba-data --keep out       with pictures of what failed

Exit code 0 if everything that could be tried is proved, 1 if not.")]
pub struct VerifyArgs {
    /// Compare with the references of Mitsuba 3 below this folder: its z-test where a variance is known, displayed
    /// pictures where there is a JPEG.
    #[arg(long, value_name = "DIR")]
    mitsuba: Option<PathBuf>,
    /// Compare every function that the CPU and the device share on N sets of arguments, bit for bit; 4194304 if N is not
    /// given.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "4194304", value_parser = clap::value_parser!(u32).range(1..))]
    functions: Option<u32>,
    /// Only what has one of these words in its name; may be repeated.
    #[arg(long, value_name = "WORD")]
    only: Vec<String>,
    /// Samples a pixel, instead of what each test asks for.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_777_216))]
    spp: Option<u32>,
    /// Keep image, reference and z map of what failed in this folder.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
    /// Print the rows as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    backend: BackendFlags,
}

pub fn run(args: &VerifyArgs) -> anyhow::Result<ExitCode> {
    let mut rows = Vec::new();
    if let Some(count) = args.functions {
        rows.extend(functions::run(count, &args.backend, |name| args.wants(name))?);
    }
    if let Some(folder) = &args.mitsuba {
        rows.extend(compare_with_mitsuba(args, folder)?);
    }
    if args.functions.is_none() && args.mitsuba.is_none() {
        return Err(Usage("nothing to verify: give --functions or --mitsuba DIR".to_owned()).into());
    }
    if rows.is_empty() {
        return Err(Usage(format!("nothing here is named {}", args.only.join(" or "))).into());
    }
    let text = if args.json { serde_json::to_string_pretty(&rows)? + "\n" } else { table(&rows) };
    std::io::stdout().write_all(text.as_bytes()).context("cannot write standard output")?;
    Ok(if all_proved(&rows) { ExitCode::SUCCESS } else { ExitCode::from(EXIT_DIFFERS) })
}

impl VerifyArgs {
    /// Whether `--only` asks for what has this name.
    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|word| name.contains(word))
    }
}

fn compare_with_mitsuba(args: &VerifyArgs, folder: &Path) -> anyhow::Result<Vec<Row>> {
    let cases = find_cases(folder).with_context(|| folder.display().to_string())?;
    if cases.is_empty() {
        let expected = "NAME_INTEGRATOR.xml with refs/NAME_ref_rgb.exr and refs/NAME_ref_rgb_var.exr, or \
                        scenes/NAME.xml with images/render/NAME.jpg";
        return Err(Usage(format!("{}: no scene with a reference; expected {expected}", folder.display())).into());
    }
    let cases: Vec<&Case> = cases.iter().filter(|case| args.wants(&case.scene.display().to_string())).collect();
    if let Some(keep) = &args.keep {
        std::fs::create_dir_all(keep).with_context(|| keep.display().to_string())?;
    }
    let mut rows = Vec::new();
    for case in cases {
        let row = run_case(args, folder, case)?;
        log::info!("{}: {}", row.subject, row.finding);
        rows.push(row);
    }
    Ok(rows)
}

fn run_case(args: &VerifyArgs, folder: &Path, case: &Case) -> anyhow::Result<Row> {
    let start = Instant::now();
    let subject = case.scene.strip_prefix(folder).unwrap_or(&case.scene).display().to_string();
    let proof = match case.reference {
        Reference::Statistics { .. } => "mitsuba z-test",
        Reference::Displayed(_) => "mitsuba picture",
    };
    let mut row = Row {
        proof,
        subject,
        backend: String::new(),
        outcome: Outcome::Skipped,
        finding: String::new(),
        measures: serde_json::Value::Null,
        seconds: 0.0,
    };
    let scene = match load::load(&case.scene, &[]) {
        Ok(scene) => scene,
        Err(error) if error.to_string().contains(load::mitsuba::NO_MEDIA) => {
            row.finding = "participating media".to_owned();
            return Ok(row);
        }
        Err(error) => return Err(error.into()),
    };
    match &case.reference {
        Reference::Statistics { mean, variance } => {
            let (mean, variance) = (read_picture(mean)?.image, read_picture(variance)?.image);
            check_size(&case.scene, &scene, &mean)?;
            check_size(&case.scene, &scene, &variance)?;
            let samples = args.spp.unwrap_or_else(|| samples_for(mean.width, mean.height));
            let film = render(args, &scene, samples, &mut row)?;
            let image = film.resolve();
            let test = z_test(&image, &mean, &variance, samples);
            row.outcome = if test.passes() { Outcome::Proved } else { Outcome::Unproved };
            let [x, y] = test.worst_at;
            row.finding = format!(
                "{:.3} % of values accepted, {:.2} wanted; brightness {:.4}; worst z {:.1} at {x},{y}",
                100.0 * test.accepted,
                100.0 * ACCEPTED_MIN,
                test.brightness,
                test.worst
            );
            row.measures = serde_json::json!({
                "accepted": test.accepted, "accepted_min": ACCEPTED_MIN, "brightness": test.brightness,
                "worst_z": test.worst, "worst_at": test.worst_at, "samples": samples, "film_hash": film.hash().to_string(),
            });
            if !test.passes()
                && let Some(keep) = &args.keep
            {
                let name = case.scene.file_stem().unwrap_or_default().to_string_lossy();
                keep_exr(&keep.join(format!("{name}.exr")), &image)?;
                keep_exr(&keep.join(format!("{name}-reference.exr")), &mean)?;
                keep_exr(&keep.join(format!("{name}-z.exr")), &test.z)?;
                let mut file = OutputFile::open(&keep.join(format!("{name}-z.png")))?;
                let written = write::write_rgb8(image.width, image.height, &show_z(&test), &mut file);
                written.map_err(|e| FilmError::write(file.path(), e))?;
                file.commit()?;
            }
        }
        Reference::Displayed(path) => {
            let reference = read_picture(path)?.image;
            check_size(&case.scene, &scene, &reference)?;
            let samples = args.spp.unwrap_or(DISPLAY_SAMPLES);
            let film = render(args, &scene, samples, &mut row)?;
            // In the reference's own size: a smaller picture's filter would reach over as many times larger pixels.
            let (image, reference) = (reduce(&film.resolve(), BLOCK), reduce(&reference, BLOCK));
            let test = display_test(&image, &reference);
            row.outcome = if test.passes() { Outcome::Proved } else { Outcome::Unproved };
            let limits = DisplayTest::LIMITS;
            row.finding = format!(
                "means within {:.2} codes, {} wanted; mean difference {:.2}, {} wanted",
                test.mean, limits.mean, test.absolute, limits.absolute
            );
            row.measures = serde_json::json!({
                "mean_codes": test.mean, "absolute_codes": test.absolute, "samples": samples, "film_hash": film.hash().to_string(),
            });
            if !test.passes()
                && let Some(keep) = &args.keep
            {
                let name = case.scene.file_stem().unwrap_or_default().to_string_lossy();
                keep_exr(&keep.join(format!("{name}.exr")), &image)?;
                keep_exr(&keep.join(format!("{name}-reference.exr")), &reference)?;
            }
        }
    }
    row.seconds = start.elapsed().as_secs_f64();
    Ok(row)
}

fn check_size(path: &Path, scene: &Scene, reference: &Image) -> Result<(), FilmError> {
    let film = scene.film.crop.map_or((scene.film.width, scene.film.height), |crop| (crop.width, crop.height));
    if film == (reference.width, reference.height) {
        return Ok(());
    }
    let message =
        format!("the film is {}x{}, but its reference {}x{}", film.0, film.1, reference.width, reference.height);
    Err(FilmError::bad(path, message))
}

/// Renders the scene; says on what in `row`.
fn render(args: &VerifyArgs, scene: &Scene, samples: u32, row: &mut Row) -> anyhow::Result<Film> {
    for warning in &scene.warnings {
        log::info!("{warning}");
    }
    strict::check(&scene.warnings)?;
    let data = bake_scene(scene)?;
    let session = team::session(&args.backend, &data, film_of(scene, &data, crop_of(scene, None)?))?;
    session.render(0..samples, &Watch::default())?;
    row.backend = session.names().join(" + ");
    Ok(session.into_film())
}

fn keep_exr(path: &Path, image: &Image) -> anyhow::Result<()> {
    let mut file = OutputFile::open(path)?;
    write::write_linear(image, &mut file).map_err(|e| FilmError::write(file.path(), e))?;
    file.commit()?;
    Ok(())
}
