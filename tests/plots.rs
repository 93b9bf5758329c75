//! gonio plot and the gallery: curves are the functions that render, files are the same bytes each time, errors say
//! what is meant.

use glam::Vec3;
use gonio::film::tone::tone_curve;
use gonio::layout::{DISTRIBUTION_BECKMANN, DISTRIBUTION_TROWBRIDGE_REITZ};
use gonio::plot::curves::{self, FACETS, Interface, InterfaceKind, direction};
use gonio::plot::figure::{Axis, Curve, Frame, nice_step, number};
use gonio::plot::lecture::{ROWS, caption, numbered, plots};
use gonio::plot::page::{Content, Entry, Part, body, kept, mathml, page};
use gonio::plot::panels::{Picture, sheet};
use gonio::plot::shelf::{Shelf, shelf_of};
use gonio::plot::{Figure, Format, lobes, render};
use gonio::scene::{Material, Model, Rgb, ToneMap};
use std::path::Path;
use std::process::{Command, Output};

fn value_at(curve: &Curve, x: f64) -> f64 {
    curve.points.iter().find(|p| (p[0] - x).abs() < 1e-9).unwrap_or_else(|| panic!("no point at {x}"))[1]
}

#[test]
fn the_highlight_curves_are_powers_of_the_cosine() {
    let figure = curves::cos_power_figure(&[1.0, 8.0, 64.0]);
    assert_eq!(figure.curves.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["n = 1", "n = 8", "n = 64"]);
    for (curve, n) in figure.curves.iter().zip([1, 8, 64]) {
        for [phi, value] in &curve.points {
            assert!((value - phi.to_radians().cos().powi(n)).abs() < 1e-5, "n = {n}, {phi}: {value}");
        }
    }
}

#[test]
fn the_distributions_are_normalised_as_their_note_says() {
    let figure = curves::distribution_figure(&FACETS, &[0.1, 0.4]);
    assert_eq!(figure.curves.len(), 2 * FACETS.len());
    // Beckmann, alpha .1: D(0) = 1 / (pi alpha^2) = 31.8309879.
    assert!((value_at(&figure.curves[0], 0.0) - 31.8309879).abs() < 1e-3);
    for curve in &figure.curves {
        let fine = |a: f64| {
            let place = a / 0.25;
            let (low, part) = (place.floor() as usize, place.fract());
            curve.points[low][1] * (1.0 - part) + curve.points[(low + 1).min(360)][1] * part
        };
        let integral: f64 = (0..90_000)
            .map(|i| (f64::from(i) + 0.5) / 1000.0)
            .map(|a| fine(a) * a.to_radians().cos() * a.to_radians().sin())
            .sum::<f64>()
            * (0.001f64.to_radians() * std::f64::consts::TAU);
        assert!((integral - 1.0).abs() < 3e-3, "{}: {integral}", curve.name);
    }
    let kinds = FACETS.map(|facets| facets.kind);
    assert!(kinds.contains(&DISTRIBUTION_BECKMANN) && kinds.contains(&DISTRIBUTION_TROWBRIDGE_REITZ));
}

#[test]
fn the_v_cavity_has_its_kink_where_it_is_printed() {
    let figure = curves::masking_figure(&[0.0, 60.0], 0.4);
    let [grooves, slanted] = [&figure.curves[0], &figure.curves[1]];
    // Light along the normal: 2 cos(a/2) cos(a) / cos(a/2) = 2 cos a, below 1 from 60 degrees on.
    for [a, g] in &grooves.points {
        let expected = (2.0 * a.to_radians().cos()).min(1.0);
        assert!((g - expected).abs() < 1e-4, "{a}: {g} for {expected}");
    }
    assert!(slanted.points.iter().all(|p| (0.0..=1.0).contains(&p[1])));
    assert!(figure.curves[2..].iter().all(|curve| curve.dashed));
}

#[test]
fn fresnel_curves_have_the_lectures_values() {
    let glass = Interface::dielectric(1.5);
    let figure = curves::fresnel_figure(&[glass.clone(), Interface::dielectric(2.417)]);
    assert!((value_at(&figure.curves[0], 45.0) - 0.0502399).abs() < 1e-5);
    assert!((value_at(&figure.curves[0], 0.0) - 0.04).abs() < 1e-5);
    let copper =
        InterfaceKind::Conductor { eta: Vec3::new(0.3669, 1.0162, 1.2464), k: Vec3::new(5.5448, 2.6765, 2.3920) };
    let copper = Interface { name: "Cu".into(), kind: copper };
    let figure = curves::fresnel_figure(std::slice::from_ref(&copper));
    assert_eq!(figure.curves.len(), 6, "three channels and Schlick's three");
    for (channel, want) in [0.955, 0.638, 0.537].into_iter().enumerate() {
        assert!((value_at(&figure.curves[channel], 0.0) - want).abs() < 1e-3);
        assert!((value_at(&figure.curves[channel + 3], 0.0) - want).abs() < 1e-3);
        assert!(value_at(&figure.curves[channel], 90.0) > 0.999);
    }
    let Frame::Ramp { strips, .. } = curves::ramp_figure(&[copper]).frame else { panic!("a ramp") };
    let [first, last] = [strips[0].colors[0], strips[0].colors[179]];
    assert!(first[0] > first[1] && first[1] > first[2] && last.iter().all(|c| *c > 245), "{first:?} {last:?}");
    // The 1982 paper's colours: the same at both ends, between them on the way to white by a common share.
    let early = &strips[1].colors;
    assert!(first.iter().zip(early[0]).all(|(a, b)| a.abs_diff(b) <= 1), "{first:?} {:?}", early[0]);
    // A quarter of a degree before the end it is not all the way yet.
    assert!(early[179].iter().all(|c| *c > 230), "{:?}", early[179]);
    assert!(early.windows(2).all(|pair| (0..3).all(|c| pair[1][c] >= pair[0][c])), "never darker");
}

#[test]
fn directed_light_is_cut_at_its_cone() {
    let figure = curves::spot_figure(&[8.0], 40.0);
    assert!((value_at(&figure.curves[0], 30.0) - 30f64.to_radians().cos().powi(8)).abs() < 1e-5);
    assert_eq!((value_at(&figure.curves[0], 41.0), value_at(&figure.curves[0], -41.0)), (0.0, 0.0));
}

#[test]
fn tone_curves_are_the_films() {
    let figure = curves::tone_figure(1.0);
    let clamp = &figure.curves[0];
    // One stop of exposure: 1/16 is shown as 1/8.
    assert!((value_at(clamp, -4.0) - gonio::film::display::srgb_encode(0.125)).abs() < 1e-12);
    let agx = gonio::film::display::srgb_encode(tone_curve(ToneMap::Agx, [0.5; 3])[1]);
    assert!((value_at(&figure.curves[3], -2.0) - agx).abs() < 1e-12);
}

fn shelf() -> Shelf {
    let matt = Material { name: "matt".into(), color: Rgb::splat(0.5), ..Material::grey("") };
    let glossy = Material {
        name: "glossy".into(),
        model: Model::Phong { exponent: 20.0, lafortune: Some(true) },
        k_d: 0.0,
        k_s: 1.0,
        ..Material::grey("")
    };
    shelf_of(vec![matt, glossy, Material { name: "mirror".into(), model: Model::Mirror, ..Material::grey("") }])
        .unwrap()
}

#[test]
fn lobes_are_the_materials_own() {
    let shelf = shelf();
    assert_eq!(shelf.find("glossy"), Some(1));
    assert_eq!([0, 1, 2].map(|i| shelf.reflects(i)), [true, true, false]);
    let figure = lobes::cartesian_figure(&shelf, &[0, 1], 45.0);
    for [angle, value] in &figure.curves[0].points {
        assert!((value - 0.5 / std::f64::consts::PI).abs() < 1e-5, "{angle}: {value}");
    }
    let lobe = &figure.curves[1];
    let brightest = lobe.points.iter().fold([0.0, 0.0], |a, b| if b[1] > a[1] { *b } else { a });
    assert!((brightest[0] - 45.0).abs() < 1.0, "{brightest:?}");
    let expected = shelf.eval(1, direction(lobe.points[200][0]), direction(-45.0)) / 45f64.to_radians().cos();
    assert!((lobe.points[200][1] - expected).abs() < 1e-6 * expected.max(1.0));
    let Frame::Bodies(bodies) = lobes::bodies_figure(&shelf, &[1], 45.0).frame else { panic!("bodies") };
    assert!(
        bodies[0]
            .facets
            .iter()
            .flat_map(|f| &f.corners)
            .all(|[x, y]| (0.0..=1.0).contains(x) && (0.0..=1.2).contains(y))
    );
}

#[test]
fn what_a_body_transmits_hangs_below_its_surface() {
    let clear = |name: &str, model| Material { name: name.into(), model, color: Rgb::ONE, ..Material::grey("") };
    let frosted = Model::RoughDielectric {
        distribution: gonio::scene::Distribution::TrowbridgeReitz,
        alpha_u: 0.3,
        alpha_v: 0.3,
        eta: 1.5,
        absorption: Rgb::ZERO,
    };
    let shelf = shelf_of(vec![clear("frosted", frosted), clear("matt", Model::Lambert)]).unwrap();
    let Frame::Bodies(bodies) = lobes::bodies_figure(&shelf, &[0, 1], 45.0).frame else { panic!("bodies") };
    // The surface's own edge nearest to the viewer is at .4 - .46 sin 25 degrees = .206.
    let lowest = |i: usize| bodies[i].facets.iter().flat_map(|f| &f.corners).map(|[_, y]| *y).fold(1.0, f64::min);
    assert!(lowest(0) < 0.17 && lowest(0) >= 0.0 && (lowest(1) - 0.206).abs() < 1e-3, "{} {}", lowest(0), lowest(1));
    assert!(bodies[0].facets.len() > 3 * bodies[1].facets.len() / 2, "two shells and one");
}

#[test]
fn lamps_fall_off_as_the_renderer_s_do() {
    let figure = curves::attenuation_figure([0.6, 0.35, 0.05]);
    for (curve, expected) in figure.curves.iter().zip([1.0 / 16.0, 1.0 / (0.6 + 1.4 + 0.8), 1.0]) {
        assert!((value_at(curve, 4.0) - expected).abs() < 1e-6, "{}", curve.name);
    }
    assert_eq!(value_at(&figure.curves[1], 0.0), 1.0, "capped");
}

#[test]
fn filters_are_normalised_and_mitchell_s_has_negative_lobes() {
    let figure = curves::filter_figure();
    for curve in &figure.curves {
        let step = curve.points[1][0] - curve.points[0][0];
        let area = curve.points.iter().map(|point| point[1]).sum::<f64>() * step;
        assert!((area - 1.0).abs() < 1e-9, "{}: {area}", curve.name);
        assert_eq!(curve.points.iter().any(|point| point[1] < -0.01), curve.name == "mitchell", "{}", curve.name);
    }
    // Tent: 1 at the pixel's centre, one half half a pixel beside it.
    assert!((value_at(&figure.curves[1], 0.0) - 1.0).abs() < 1e-3);
    let file =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture/05-attenuation.toml"));
    assert!(file.unwrap().contains("attenuation=[0.6,0.35,0.05]"), "curves::CAPPED are the scene's");
    assert_eq!(curves::CAPPED, [0.6, 0.35, 0.05]);
}

#[test]
fn every_row_has_a_scene_and_a_formula_and_the_plots_that_say_more() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/lecture");
    let mut plotted = Vec::new();
    let mut found = Vec::new();
    for file in std::fs::read_dir(&folder).unwrap().map(|file| file.unwrap().path()) {
        let stem = file.file_stem().unwrap().to_string_lossy().into_owned();
        let (Some(row), title) = numbered(&stem) else { panic!("{stem} has no row") };
        found.push(row);
        assert!(ROWS.iter().any(|known| known.number == row && !known.formulae.is_empty()), "{stem}");
        let scene = gonio::scene::load::load(&file, &[]).unwrap();
        let figures = plots(row, title, &scene).unwrap_or_else(|error| panic!("{stem}: {error}"));
        plotted.extend(figures.iter().map(|_| row));
    }
    // 4, 11, 22, 24 and 25 are seen, not plotted.
    for row in ROWS.iter().map(|row| row.number) {
        assert!(found.contains(&row), "row {row} has no scene");
        assert_eq!(plotted.contains(&row), ![4, 11, 22, 24, 25, 27].contains(&row), "row {row}");
    }
    for row in (1..=11).chain(14..=19).chain(21..=24).chain([26, 27]) {
        assert!(found.contains(&row), "row {row} has no scene");
    }
}

#[test]
fn albedo_of_lambert_is_its_colour_and_of_a_mirror_its_reflectance() {
    let figure = lobes::albedo_figure(&shelf(), &[0, 2]);
    assert!(figure.curves[0].points.iter().all(|p| (p[1] - 0.5).abs() < 1e-4), "{:?}", figure.curves[0].points);
    assert!(figure.curves[1].points.iter().all(|p| (p[1] - 0.7).abs() < 1e-4), "{:?}", figure.curves[1].points);
}

#[test]
fn across_an_edge_gouraud_misses_the_highlight() {
    let figure = gonio::plot::edge::edge_figure().unwrap();
    let [flat, gouraud, phong] = [0, 1, 2].map(|i| figure.curves[i].highest());
    assert!(gouraud < 0.3 && phong > 0.5 && flat < phong, "{flat} {gouraud} {phong}");
    // Flat: a step at each edge, level between.
    let steps = figure.curves[0].points.windows(2).filter(|p| (p[0][1] - p[1][1]).abs() > 1e-3).count();
    assert!((4..=40).contains(&steps), "{steps}");
}

#[test]
fn axes_end_on_round_numbers_and_ticks_are_short() {
    assert_eq!([0.07, 0.2, 0.21, 3.0, 99.0].map(nice_step), [0.1, 0.2, 0.5, 5.0, 100.0]);
    let axis = Axis::up_to("", 7.96);
    assert_eq!((axis.high, axis.ticks()), (8.0, vec![0.0, 2.0, 4.0, 6.0, 8.0]));
    assert_eq!([0.0, 0.30000000000000004, -15.0, 1234.6, 0.00012].map(number), ["0", "0.3", "–15", "1235", "0.00012"]);
}

fn figures() -> Vec<Figure> {
    let shelf = shelf();
    vec![
        curves::cos_power_figure(&[1.0, 8.0]),
        curves::spot_figure(&[8.0], 40.0),
        curves::ramp_figure(&[Interface::dielectric(1.5)]),
        lobes::polar_figure(&shelf, &[0, 1], 30.0),
        lobes::bodies_figure(&shelf, &[1], 30.0),
    ]
}

#[test]
fn files_are_the_same_bytes_each_time_and_have_the_size_asked_for() {
    for figure in figures() {
        for format in [Format::Svg, Format::Png, Format::Csv] {
            let file = render(&figure, format, [480, 300]).unwrap();
            assert_eq!(file, render(&figure, format, [480, 300]).unwrap(), "{} {format:?}", figure.title);
        }
        let svg = String::from_utf8(render(&figure, Format::Svg, [480, 300]).unwrap()).unwrap();
        assert!(svg.starts_with("<svg width=\"480\" height=\"300\" viewBox=\"0 0 1920 1200\""), "{}", &svg[..80]);
        assert!(figure.curves.iter().all(|curve| svg.contains(&curve.name)), "the legend names each curve");
        let png = image::load_from_memory(&render(&figure, Format::Png, [480, 300]).unwrap()).unwrap();
        assert_eq!((png.width(), png.height()), (480, 300));
        let dark = png.to_rgb8().pixels().filter(|p| p.0[0] < 100).count();
        assert!(dark > 100, "{}: letters and lines", figure.title);
    }
}

#[test]
fn panels_stand_in_rows_over_their_names() {
    let picture = |value: u16| Picture { width: 40, height: 20, max: 65_535, pixels: vec![[value * 257; 4]; 40 * 20] };
    let whole = sheet(&[("one", picture(10)), ("two", picture(200)), ("three", picture(90))], 2).unwrap();
    // Two rows of a picture and a line of 24 pixels, gaps of 6.
    assert_eq!((whole.width, whole.height, whole.max), (86, 94, 65_535));
    let at = |x: u32, y: u32| whole.pixels[(y * whole.width + x) as usize][0];
    let seen = [at(0, 0), at(39, 19), at(42, 5), at(46, 0), at(85, 19), at(3, 50), at(39, 69), at(60, 60)];
    assert_eq!(seen.map(|v| v / 257), [10, 10, 255, 200, 200, 90, 90, 255]);
    let inked =
        |x: std::ops::Range<u32>, y: std::ops::Range<u32>| x.clone().any(|x| y.clone().any(|y| at(x, y) < 32_768));
    assert!(inked(5..35, 20..44) && inked(50..80, 20..44) && !inked(41..45, 20..44) && inked(0..40, 70..94));
    assert!(!inked(46..86, 50..94), "the last row has one picture");
}

#[test]
fn a_scenes_comment_is_its_caption_and_its_name_has_its_row() {
    assert_eq!(caption("# Row 8. Shading: a\n# b.\n\n[x]"), "Shading: a b.");
    assert_eq!(caption("# Rows 14 to 18. Copper.\n"), "Copper.");
    assert_eq!(caption("# Many copies. Of one.\n"), "Many copies. Of one.");
    assert_eq!(caption("[render]\n"), "");
    assert_eq!(numbered("02-phong"), (Some(2), "phong"));
    assert_eq!(numbered("2nd-scene"), (None, "2nd-scene"));
    assert_eq!(numbered("ball"), (None, "ball"));
}

/// The first element with another number of parts than browsers take.
fn misplaced(math: &str) -> Option<String> {
    let text = math.replace("&nbsp;", "\u{a0}");
    let document = roxmltree::Document::parse(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let wrong = |node: &roxmltree::Node| {
        let parts = match node.tag_name().name() {
            "msup" | "msub" | "mfrac" | "munder" | "mover" => 2,
            "msubsup" | "munderover" => 3,
            _ => return false,
        };
        node.children().filter(roxmltree::Node::is_element).count() != parts
    };
    document.descendants().find(wrong).map(|node| node.tag_name().name().to_owned())
}

#[test]
fn every_formula_is_mathml() {
    for row in ROWS {
        for latex in row.formulae {
            let math = mathml(latex);
            assert!(math.starts_with("<math") && math.trim_end().ends_with("</math>"), "{latex}: {math}");
            assert!(!math.contains("merror") && !math.contains("\\"), "{latex}: {math}");
            assert_eq!(misplaced(&math), None, "{latex}");
        }
    }
    // What the converter makes of a power of a function after a sign.
    assert_eq!(misplaced(&mathml(r"-\tan^2 x")).as_deref(), Some("msup"));
    assert!(mathml(r"I = k_d").contains("<msub><mi>k</mi><mi>d</mi></msub>"), "{}", mathml(r"I = k_d"));
}

#[test]
fn the_page_needs_nothing_else_and_escapes_what_it_shows() {
    let content = Content {
        name: "02-phong".into(),
        caption: "x < y & z".into(),
        settings: "path, 4 samples".into(),
        pictures: vec![(Some("n < 2".into()), vec![1, 2, 3]), (Some("n > 2".into()), vec![4, 5, 6])],
        columns: 2,
        plots: vec!["<svg></svg>".into()],
        text: "# <b>\n".into(),
    };
    let (name, body) = ("02-phong".to_owned(), body(&content));
    let entry = Entry { name, row: Some(2), title: "phong".into(), key: "k1".into(), body: body.clone() };
    let page = page("T", "gonio 1 < 2", &[Part { entries: vec![entry] }], &["3 Blinn & co".into()]);
    assert!(
        page.contains("gonio 1 &lt; 2")
            && page.contains("path, 4 samples")
            && page.contains("To come: 3 Blinn &amp; co.")
    );
    assert_eq!(kept(&page, "02-phong", "k1"), Some(body));
    assert!(kept(&page, "02-phong", "k2").is_none() && kept(&page, "03-blinn", "k1").is_none());
    assert!(page.contains("x &lt; y &amp; z") && page.contains("# &lt;b&gt;") && page.contains("base64,AQID"));
    assert!(page.contains("<h2>2 · Phong's highlight</h2>") && page.contains("<a href=\"#row-2\">"), "{page}");
    assert!(page.contains("<figcaption>n &lt; 2</figcaption>") && page.contains("<math"), "{page}");
    let outside = ["http:", "https:", "src=\"/", "<link", "<script src", "@import", "url("];
    assert!(outside.iter().all(|word| !page.contains(word)), "{page}");
}

fn gonio(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gonio")).current_dir(folder).args(args).output().unwrap()
}

fn fails(folder: &Path, args: &[&str], code: i32) -> String {
    let ended = gonio(folder, args);
    let message = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(code), "{args:?}: {message}");
    message
}

const SCENE: &str = "# Row 1. A ball.\n[film]\nsize = [24, 16]\n[render]\nsamples = 1\n[camera]\neye = [0, 0, 5]\n\
[[material]]\nname = \"brass\"\n[[object]]\nshape = \"sphere\"\nmaterial = \"brass\"\n\
[[light]]\ntype = \"directional\"\ndirection = [0, 0, -1]\n";

#[test]
fn wrong_plots_are_refused_with_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    std::fs::write(folder.path().join("bad.toml"), "[camra]\n").unwrap();
    std::fs::write(folder.path().join("bad.brdf"), "gonio-brdf 1\nlight 3\ndata text\n").unwrap();
    let cases: &[(&[&str], i32, &str)] = &[
        (&["plot", "lobs"], 2, "'lobe'"),
        (&["plot"], 2, "Usage"),
        (&["plot", "lobe", "scene.toml", "--material", "bras"], 2, "did you mean \"brass\"?"),
        (&["plot", "lobe", "scene.toml", "--material", "q"], 2, "there are brass"),
        (&["plot", "lobe", "--theta", "90"], 2, "degrees from 0 to 89"),
        (&["plot", "lobe", "bad.toml"], 65, "did you mean \"camera\"?"),
        (&["plot", "lobe", "none.toml"], 74, "none.toml"),
        (&["plot", "edge", "-o", "a.gif"], 2, "allowed: .svg, .png, .csv"),
        (&["plot", "ramp", "-o", "a.csv"], 2, "no curves"),
        (&["plot", "edge", "-o", "none/a.svg"], 74, "none/a.svg"),
        (&["plot", "fresnel", "--metal", "Fe"], 2, "allowed: Cu, Au, Ag, Al, Cr"),
        (&["plot", "d", "--distribution", "ggx"], 2, "allowed: beckmann"),
        (&["plot", "albedo", "--against", "colour"], 2, "angle, roughness"),
        (&["plot", "albedo", "scene.toml", "--against", "roughness"], 2, "none of the materials has a roughness"),
        (&["plot", "fit"], 2, "Usage"),
        (&["plot", "fit", "none.binary"], 74, "none.binary"),
        (&["plot", "fit", "bad.toml"], 65, "did you mean \"camera\"?"),
        (&["plot", "fit", "scene.toml"], 2, "no measured material"),
        (&["plot", "fit", "scene.toml", "--material", "bras"], 2, "did you mean \"brass\"?"),
        (&["plot", "fit", "bad.brdf"], 65, "bad.brdf:2:1: unknown key \"light\""),
        (&["plot", "fit", "bad.brdf", "--material", "brass"], 2, "this is a table"),
        (&["plot", "fit", "scene.toml", "--model", "blinn"], 2, "allowed: ward, phong, cook-torrance"),
        (&["plot", "tone", "--size", "100x100"], 2, "240x180"),
        (&["render", "--gallery", "."], 2, "--output"),
        (&["render", "--gallery", "none", "-o", "out"], 74, "none"),
        (&["render", "scene.toml", "--gamma", "0"], 2, "0.1 to 10"),
    ];
    for (args, code, expected) in cases {
        let message = fails(folder.path(), args, *code);
        assert!(message.contains(expected), "{args:?}: {message}");
    }
    let mut left: Vec<String> =
        std::fs::read_dir(folder.path()).unwrap().map(|f| f.unwrap().file_name().into_string().unwrap()).collect();
    left.sort();
    assert_eq!(left, ["bad.brdf", "bad.toml", "scene.toml"]);
}

#[test]
fn plots_go_where_they_are_sent() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    let piped = gonio(folder.path(), &["plot", "lobe", "scene.toml", "-o", "-"]);
    assert!(piped.status.success() && piped.stdout.starts_with(b"<svg"));
    let numbers = gonio(folder.path(), &["plot", "cos-n", "--n", "2", "-o", "-", "--format", "csv"]);
    assert!(
        String::from_utf8(numbers.stdout)
            .unwrap()
            .starts_with("curve,\"φ between R and V [°]\",\"cosⁿ φ\"\n\"n = 2\",0,1\n")
    );
    assert!(gonio(folder.path(), &["plot", "tone"]).status.success());
    assert!(std::fs::read(folder.path().join("tone.svg")).unwrap().starts_with(b"<svg"));
}

#[test]
fn a_gallery_is_a_folder_of_pictures_and_one_page() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = folder.path().join("scenes");
    std::fs::create_dir(&scenes).unwrap();
    std::fs::write(scenes.join("ball.toml"), SCENE).unwrap();
    let panels = "[[panel]]\nlabel = \"bright\"\n[[panel]]\nlabel = \"dark\"\nset = [\"light.0.intensity=0.1\"]\n";
    std::fs::write(scenes.join("02-phong.toml"), SCENE.to_owned() + panels).unwrap();
    let made = gonio(folder.path(), &["render", "--gallery", "scenes", "-o", "out", "--backend", "cpu"]);
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    let page = std::fs::read_to_string(folder.path().join("out/index.html")).unwrap();
    assert!(page.contains("A ball.") && page.contains("Phong's highlight") && page.contains("cosⁿ φ"));
    assert!(page.find("row-2") < page.find("#ball"), "rows first");
    assert_eq!(page.matches("<figure>").count(), 3);
    let size = |name: &str| image::image_dimensions(folder.path().join("out").join(name)).unwrap();
    assert_eq!((size("ball.png"), size("02-phong.png")), ((24, 16), (54, 40)));
    assert!(page.contains("gonio 0.") && page.contains("samples, seed 0, 24 x 16 pixels"), "version and settings");
    assert!(page.contains("To come: 1 Lambert's law; 3 ") && !page.contains("; 2 Phong"), "rows without a scene");
    assert!(page.contains("showModal") && page.contains("ArrowRight"));
    // What is up to date is kept; what is not is rendered again.
    let told = |flags: &[&str]| {
        let made = gonio(folder.path(), &[&["render", "--gallery", "scenes", "-o", "out"], flags].concat());
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
        String::from_utf8(made.stdout).unwrap()
    };
    assert!(told(&["--backend", "cpu"]).contains("2 as they were"));
    assert_eq!(std::fs::read_to_string(folder.path().join("out/index.html")).unwrap(), page);
    std::fs::write(scenes.join("ball.toml"), SCENE.to_owned() + "# changed\n").unwrap();
    assert!(told(&["--backend", "cpu"]).contains("1 as they were"));
    assert!(!told(&["--backend", "cpu", "--spp", "1"]).contains("as they were"), "other flags, other pictures");
}
