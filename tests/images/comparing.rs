//! How far two pictures are apart; a comparison that cannot fail would prove nothing.

use crate::{encode, film_of, ramp};
use clap::{Args, FromArgMatches};
use gonio::cli::ExitCode;
use gonio::cli::compare::{CompareArgs, excesses, run};
use gonio::cli::merge;
use gonio::film::Image;
use gonio::film::metrics::{FlipMap, Metrics, Step, compare, ulp_distance};
use gonio::film::read::{Picture, read_film, read_picture};
use gonio::film::write::Format;
use std::fs;
use std::path::Path;

fn picture(width: u32, pixels: Vec<[f32; 4]>) -> Picture {
    let height = pixels.len() as u32 / width;
    Picture { image: Image { width, height, pixels }, codes: None, film_hash: None }
}

fn measure(a: &Picture, b: &Picture) -> Metrics {
    compare((Path::new("a"), a), (Path::new("b"), b)).unwrap().0
}

fn parse<T: Args + FromArgMatches>(args: &[&str]) -> T {
    let command = T::augment_args(clap::Command::new("test").no_binary_name(true));
    T::from_arg_matches(&command.try_get_matches_from(args).unwrap()).unwrap()
}

fn grey(values: &[f32]) -> Picture {
    picture(values.len() as u32, values.iter().map(|v| [*v, *v, *v, 1.0]).collect())
}

#[test]
fn adjacent_floats_are_one_ulp_apart() {
    let next = |v: f32| f32::from_bits(v.to_bits() + 1);
    for v in [1.0f32, 0.1, 1e-40, 3e38, next(1.0)] {
        assert_eq!(ulp_distance(v, next(v)), Some(1));
        assert_eq!(ulp_distance(-next(v), -v), Some(1));
    }
    assert_eq!(ulp_distance(0.0, -0.0), Some(0));
    assert_eq!(ulp_distance(f32::from_bits(1), -f32::from_bits(1)), Some(2));
    assert_eq!(ulp_distance(f32::MAX, f32::INFINITY), Some(1));
    assert_eq!(ulp_distance(f32::NAN, f32::from_bits(0x7fc0_1234)), Some(0));
    assert_eq!(ulp_distance(f32::NAN, 1.0), None);
    let metrics = measure(&grey(&[1.0, 0.5]), &grey(&[1.0, next(0.5)]));
    assert_eq!((metrics.max_ulp, metrics.differing_pixels, metrics.step), (1, 1, Step::Float));
    assert!(!metrics.equal());
}

#[test]
fn measures_have_their_definitions_values() {
    let metrics = measure(&grey(&[0.5, 1.0, 0.0, 0.25]), &grey(&[0.5, 0.5, 0.1, 0.25]));
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-7, "{a} {b}");
    close(metrics.mse, (0.25 + 0.01) / 4.0);
    close(metrics.rmse, metrics.mse.sqrt());
    close(metrics.rel_mse, (0.25 / 1.01 + 0.01 / 0.01) / 4.0);
    assert_eq!((metrics.max_abs, metrics.max_abs_at, metrics.differing_pixels), (0.5, Some([1, 0]), 2));
    // sRGB of 0.5 is 0.735357, of 0.1 it is 0.349190.
    let mse = ((1.0f64 - 0.735_357).powi(2) + 0.349_190f64.powi(2)) / 4.0;
    assert!((metrics.psnr_db.unwrap() + 10.0 * mse.log10()).abs() < 1e-4);
    let (_, map) = compare((Path::new("a"), &grey(&[0.0])), (Path::new("b"), &grey(&[1.0]))).unwrap();
    assert!(map.mean() > 0.5, "{}", map.mean());
}

#[test]
fn a_picture_equals_itself_in_every_measure() {
    let a = picture(40, ramp(40, 30));
    let metrics = measure(&a, &a.clone());
    assert!(metrics.equal());
    assert_eq!((metrics.differing_pixels, metrics.max_ulp, metrics.mse, metrics.rel_mse), (0, 0, 0.0, 0.0));
    assert_eq!((metrics.flip, metrics.psnr_db, metrics.max_abs_at), (0.0, None, None));
    assert_eq!(FlipMap::new(&a.image, &a.image).mean(), 0.0);
    assert_eq!(FlipMap::new(&a.image, &a.image).colours().len(), 40 * 30 * 3);
}

#[test]
fn image_compare_rejects_a_one_percent_brighter_image() {
    let pixels: Vec<[f32; 4]> = ramp(40, 30).iter().map(|[r, g, b, _]| [r / 4.0, g / 4.0, b / 4.0, 1.0]).collect();
    let brighter: Vec<[f32; 4]> = pixels.iter().map(|[r, g, b, a]| [r * 1.01, g * 1.01, b * 1.01, *a]).collect();
    let metrics = measure(&picture(40, pixels.clone()), &picture(40, brighter));
    let same = measure(&picture(40, pixels.clone()), &picture(40, pixels));
    for limits in [
        &["a", "b"][..],
        &["a", "b", "--max-ulp", "4"],
        &["a", "b", "--max-mse", "1e-6"],
        &["a", "b", "--max-flip", "1e-4"],
    ] {
        let args: CompareArgs = parse(limits);
        assert_eq!(excesses(&args, &metrics).len(), 1, "{limits:?} {metrics:?}");
        assert!(excesses(&args, &same).is_empty(), "{limits:?}");
    }
    let generous: CompareArgs = parse(&["a", "b", "--max-mse", "0.01", "--max-flip", "0.1"]);
    assert!(excesses(&generous, &metrics).is_empty(), "{metrics:?}");
}

#[test]
fn not_a_number_equals_itself_and_no_number() {
    let (nan, number) = (grey(&[f32::NAN, 0.5]), grey(&[0.25, 0.5]));
    assert!(measure(&nan, &nan.clone()).equal());
    let metrics = measure(&nan, &number);
    assert_eq!((metrics.nan_mismatches, metrics.differing_pixels, metrics.mse), (3, 1, 0.0));
    // No limit, however generous, accepts it.
    let args: CompareArgs = parse(&["a", "b", "--max-ulp", "4294967295", "--max-mse", "inf"]);
    assert_eq!(excesses(&args, &metrics), ["3 values are not a number in one picture only"]);
    let infinite = grey(&[f32::INFINITY, 0.5]);
    assert_eq!(measure(&infinite, &infinite.clone()).mse, 0.0);
    assert_eq!(measure(&infinite, &number).mse, f64::INFINITY);
}

#[test]
fn alpha_differs_but_is_no_light() {
    let metrics = measure(&picture(1, vec![[0.5, 0.5, 0.5, 1.0]]), &picture(1, vec![[0.5, 0.5, 0.5, 0.5]]));
    assert_eq!((metrics.differing_pixels, metrics.mse, metrics.equal()), (1, 0.0, false));
}

#[test]
fn pictures_of_different_sizes_are_refused() {
    let error = compare((Path::new("a"), &grey(&[1.0; 6])), (Path::new("b"), &picture(3, vec![[1.0; 4]; 6])));
    let error = error.err().unwrap();
    assert_eq!((error.exit_code(), error.to_string()), (65, "b: the picture is 3x2, but a is 6x1".into()));
}

#[test]
fn integers_are_compared_as_integers_and_films_as_films() {
    let folder = tempfile::tempdir().unwrap();
    let film = film_of(8, &ramp(8, 4), |_| {});
    let mut brighter = ramp(8, 4);
    brighter[9][1] += 1.0 / 4_194_304.0;
    let other = film_of(8, &brighter, |_| {});
    let file = |name: &str, bytes: Vec<u8>| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        read_picture(&path).unwrap()
    };
    let png = file("a.png", encode(&film, Format::Png, false));
    assert_eq!(measure(&png, &png).step, Step::Eight);
    let deep = file("b.png", encode(&film, Format::Png, true));
    assert_eq!(measure(&deep, &deep).step, Step::Sixteen);
    assert_eq!(measure(&png, &deep).step, Step::Float);
    let mut code = png.clone();
    code.codes.as_mut().unwrap().pixels[5][2] ^= 4;
    assert_eq!((measure(&png, &code).max_ulp, measure(&png, &code).differing_pixels), (4, 1));

    let (a, b) =
        (file("a.gfilm", encode(&film, Format::Gfilm, false)), file("b.gfilm", encode(&other, Format::Gfilm, false)));
    assert_eq!((measure(&a, &a).same_film, measure(&a, &b).same_film), (Some(true), Some(false)));
    assert_eq!(measure(&a, &b).differing_pixels, 1);
    // Equal pictures of unequal films: the same light from other samples.
    let mut more = a.clone();
    more.film_hash = Some(blake3::hash(b"more samples"));
    let args: CompareArgs = parse(&["a", "b"]);
    assert_eq!(excesses(&args, &measure(&a, &more)).len(), 1);
}

/// Exit code of `gonio compare`.
fn compare_files(args: &[&str]) -> u8 {
    match run(&parse::<CompareArgs>(args)) {
        Ok(code) if code == ExitCode::SUCCESS => 0,
        Ok(code) if code == ExitCode::from(1) => 1,
        Ok(code) => panic!("{code:?}"),
        Err(error) => error.downcast_ref::<gonio::film::FilmError>().unwrap().exit_code(),
    }
}

#[test]
fn compare_exits_as_documented() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let film = film_of(8, &ramp(8, 4), |_| {});
    let brighter: Vec<[f32; 4]> = ramp(8, 4).iter().map(|p| p.map(|v| v * 1.0078125)).collect();
    fs::write(path("a.exr"), encode(&film, Format::Exr, false)).unwrap();
    fs::write(path("b.exr"), encode(&film_of(8, &brighter, |_| {}), Format::Exr, false)).unwrap();
    fs::write(path("a.gfilm"), encode(&film, Format::Gfilm, false)).unwrap();
    fs::write(path("bad.png"), b"\x89PNG, or so it claims to be").unwrap();
    let (a, b, heat) = (path("a.exr"), path("b.exr"), path("heat.png"));
    assert_eq!(compare_files(&[&a, &a, "--json"]), 0);
    assert_eq!(compare_files(&[&a, &path("a.gfilm")]), 0);
    assert_eq!(compare_files(&[&a, &b, "--heatmap", &heat]), 1);
    let map = read_picture(Path::new(&heat)).unwrap();
    assert_eq!((map.image.width, map.image.height), (8, 4));
    assert_eq!(compare_files(&[&a, &b, "--max-mse", "0.1"]), 0);
    assert_eq!(compare_files(&[&a, &b, "--max-mse", "0.1", "--max-ulp", "1"]), 1);
    assert_eq!(compare_files(&[&a, &path("missing.png")]), 74);
    assert_eq!(compare_files(&[&a, &path("bad.png")]), 65);
    assert_eq!(compare_files(&[&a, &b, "--heatmap", &path("no/heat.png")]), 74);
    assert_eq!(compare_files(&[&a, &b, "--heatmap", &path("heat.exr")]), 2);
    assert_eq!(compare_files(&["-", "-"]), 2);
    let parsed = |args: &[&str]| {
        CompareArgs::augment_args(clap::Command::new("test").no_binary_name(true)).try_get_matches_from(args).is_ok()
    };
    assert!(parsed(&["a", "b", "--max-flip", "0.5"]));
    assert!(!parsed(&["a", "b", "--max-flip", "nan"]) && !parsed(&["a", "b", "--max-mse=-1"]) && !parsed(&["a"]));
}

#[test]
fn merge_adds_films_converts_them_and_names_what_does_not_fit() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let film = film_of(8, &ramp(8, 4), |_| {});
    let mut other = film_of(8, &[[0.0; 4]; 32], |_| {});
    let mut second = gonio::film::Film::new(other.spec().clone());
    second.record(1..2, 0, 0);
    other.set_display(gonio::scene::ToneMap::Clamp, 0.0, None);
    fs::write(path("a.gfilm"), encode(&film, Format::Gfilm, false)).unwrap();
    fs::write(path("b.gfilm"), encode(&second, Format::Gfilm, false)).unwrap();
    fs::write(path("same.gfilm"), encode(&other, Format::Gfilm, false)).unwrap();
    let run = |args: &[&str]| merge::run(&parse(args));
    run(&[&path("b.gfilm"), &path("a.gfilm"), "-o", &path("ab.gfilm")]).unwrap();
    let mut expected = film.clone();
    expected.merge(&second).unwrap();
    assert_eq!(read_film(Path::new(&path("ab.gfilm"))).unwrap().hash(), expected.hash());
    run(&[
        &path("ab.gfilm"),
        "-o",
        &path("ab.png"),
        "--bits",
        "16",
        "--exposure",
        "-1.5",
        "--tonemap",
        "reinhard",
        "--gamma",
        "2.2",
    ])
    .unwrap();
    expected.set_display(gonio::scene::ToneMap::Reinhard, -1.5, Some(2.2));
    assert_eq!(fs::read(path("ab.png")).unwrap(), encode(&expected, Format::Png, true));

    let failure = |args: &[&str]| {
        let error = run(args).unwrap_err();
        let error = error.downcast_ref::<gonio::film::FilmError>().unwrap();
        (error.exit_code(), error.to_string())
    };
    let (code, message) = failure(&[&path("a.gfilm"), &path("same.gfilm"), "-o", &path("bad.gfilm")]);
    assert_eq!(code, 65);
    assert!(
        message.starts_with(&path("same.gfilm")) && message.contains("both films hold the samples 0..1"),
        "{message}"
    );
    assert_eq!(failure(&[&path("a.gfilm"), &path("none.gfilm"), "-o", &path("bad.gfilm")]).0, 74);
    assert_eq!(failure(&[&path("ab.png"), "-o", &path("bad.gfilm")]).0, 65);
    assert_eq!(failure(&["-", "-", "-o", &path("bad.gfilm")]).0, 2);
    assert!(!Path::new(&path("bad.gfilm")).exists());
}
