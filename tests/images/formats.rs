//! What is written is read back, by our reader and by others.

use crate::assets::asset;
use crate::{encode, film_of, ramp};
use gonio::film::read::{Picture, read_picture, read_picture_from};
use gonio::film::write::{Aov, Format};
use gonio::film::{FilmError, FilmSpec};
use std::io::Cursor;
use std::path::Path;

fn read(bytes: &[u8]) -> Result<Picture, FilmError> {
    read_picture_from(Path::new("a"), bytes)
}

#[test]
fn the_same_film_gives_the_same_bytes_in_every_format() {
    let film = film_of(40, &ramp(40, 70), |s| s.aovs = true);
    for format in [Format::Png, Format::Exr, Format::Hdr, Format::Gfilm] {
        let first = encode(&film, format, false);
        (0..4).for_each(|_| assert_eq!(encode(&film, format, false), first, "{format:?}"));
    }
}

#[test]
fn png_is_tagged_and_says_where_it_came_from() {
    let film = film_of(4, &ramp(4, 2), |s| s.scene_name = "Kugel \u{2603}.toml".into());
    let bytes = encode(&film, Format::Png, false);
    let reader = png::Decoder::new(Cursor::new(&bytes)).read_info().unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (4, 2));
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
    let text = |key: &str| info.uncompressed_latin1_text.iter().find(|t| t.keyword == key).map(|t| t.text.clone());
    assert_eq!(text("Film-Hash"), Some(film.hash().to_string()));
    assert_eq!(text("Samples"), Some("0..1".into()));
    assert_eq!(text("Seed"), Some("42".into()));
    assert_eq!(text("Integrator"), Some("local".into()));
    assert_eq!(text("Software"), Some("gonio 0.1.0".into()));
    assert_eq!(text("Scene-Digest"), Some("03".repeat(32)));
    let scene = &info.utf8_text[0];
    assert_eq!((scene.keyword.as_str(), scene.get_text().unwrap().as_str()), ("Scene", "Kugel \u{2603}.toml"));
}

#[test]
fn png_holds_the_displayed_codes_in_8_and_16_bits() {
    let pixels = [[0.0, 0.5, 1.0, 0.25], [0.25, 9.0, -1.0, 0.5]];
    let opaque = film_of(2, &pixels, |_| {});
    let codes = read(&encode(&opaque, Format::Png, false)).unwrap().codes.unwrap();
    assert_eq!((codes.bits, codes.pixels), (8, vec![[0, 188, 255, 255], [137, 255, 0, 255]]));
    let codes = read(&encode(&opaque, Format::Png, true)).unwrap().codes.unwrap();
    assert_eq!((codes.bits, codes.pixels), (16, vec![[0, 48_192, 65_535, 65_535], [35_199, 65_535, 0, 65_535]]));
    let transparent = film_of(2, &pixels, |s| s.transparent = true);
    let codes = read(&encode(&transparent, Format::Png, false)).unwrap().codes.unwrap();
    assert_eq!(codes.pixels, [[0, 255, 255, 64], [188, 255, 0, 128]]);
}

#[test]
fn exr_keeps_every_bit_and_its_place_in_the_frame() {
    for transparent in [false, true] {
        let mut pixels = ramp(40, 70);
        pixels[3] = [-0.25, 65_536.0, 1.0 / 4_194_304.0, 0.5];
        let film = film_of(40, &pixels, |s| (s.transparent, s.aovs) = (transparent, true));
        let bytes = encode(&film, Format::Exr, false);
        let read = read(&bytes).unwrap();
        let alpha = |pixel: &[f32; 4]| if transparent { pixel[3] } else { 1.0 };
        let expected: Vec<[f32; 4]> = pixels.iter().map(|p| [p[0], p[1], p[2], alpha(p)]).collect();
        assert_eq!(read.image.pixels, expected);
        assert_eq!((read.image.width, read.image.height), (40, 70));

        let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
        let header = &meta.headers[0];
        let window = header.shared_attributes.display_window;
        assert_eq!((window.size.0, window.size.1), (43, 75));
        assert_eq!((header.own_attributes.layer_position.0, header.own_attributes.layer_position.1), (2, 1));
        let names: Vec<String> = header.channels.list.iter().map(|c| c.name.to_string()).collect();
        let expected =
            "A B G R albedo.B albedo.G albedo.R depth.Z material.id normal.X normal.Y normal.Z object.id samples";
        assert_eq!(names.join(" "), expected);
        let hash = &header.own_attributes.other[&exr::meta::attribute::Text::from("filmHash")];
        assert_eq!(hash, &exr::prelude::AttributeValue::Text(film.hash().to_string().as_str().into()));
        let comments = header.own_attributes.comments.as_ref().unwrap().to_string();
        assert!(comments.contains("Seed: 42\n") && comments.contains("Scene: spheres.toml\n"), "{comments}");
    }
}

#[test]
fn exr_layers_hold_the_auxiliary_values() {
    use exr::prelude::{FlatSamples, ReadChannels, ReadLayers};
    let film = film_of(4, &ramp(4, 2), |s| s.aovs = true);
    let bytes = encode(&film, Format::Exr, false);
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(&bytes))
        .unwrap();
    let channel = |name: &str| {
        let list = &image.layer_data.channel_data.list;
        list.iter().find(|c| c.name.eq(name)).map(|c| c.sample_data.clone()).unwrap()
    };
    let ids: Vec<u32> = (0..8).collect();
    assert_eq!(channel("depth.Z"), FlatSamples::F32(ids.iter().map(|i| *i as f32).collect()));
    assert_eq!(channel("object.id"), FlatSamples::U32(ids));
    assert_eq!(channel("material.id"), FlatSamples::U32(vec![7; 8]));
    assert_eq!(channel("samples"), FlatSamples::U32(vec![1; 8]));
    assert_eq!(channel("normal.Z"), FlatSamples::F32(vec![1.0; 8]));
    assert_eq!(channel("normal.X"), FlatSamples::F32(vec![0.0; 8]));
    assert_eq!(channel("albedo.R"), FlatSamples::F32(vec![0.5; 8]));
    assert_eq!(channel("albedo.G"), FlatSamples::F32(vec![0.25; 8]));
}

#[test]
fn hdr_keeps_light_to_half_a_mantissa_step() {
    // Below 8 and from 8 pixels on lines are stored differently; 300 has runs and literals above 127.
    for width in [1, 7, 8, 300] {
        let mut pixels = ramp(width, 5);
        let flat = pixels.len() / 2;
        pixels[..flat].fill([0.75, 0.0, 3.0, 1.0]);
        pixels[0] = [-1.0, 0.0, -3.0, 1.0];
        let bytes = encode(&film_of(width, &pixels, |_| {}), Format::Hdr, false);
        assert!(bytes.starts_with(b"#?RADIANCE\n# Software: gonio 0.1.0\n# Film-Hash: "));
        let read = read(&bytes).unwrap().image;
        assert_eq!((read.width, read.height), (width, 5));
        for (read, wrote) in read.pixels.iter().zip(&pixels) {
            let largest = wrote[..3].iter().fold(0.0f32, |a, b| a.max(*b));
            for (read, wrote) in read[..3].iter().zip(&wrote[..3]) {
                // A mantissa of at least 128 means half a step is at most 1/256 of the largest channel.
                assert!((read - wrote.max(0.0)).abs() <= largest / 256.0, "{read} {wrote}");
            }
        }
    }
}

/// An EXR of one row of three pixels with these channels, the values of channel i being 10 i + 1, 2, 3.
fn exr_with(names: &[&str]) -> Vec<u8> {
    use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Layer, LayerAttributes, WritableImage};
    let samples = |i: usize| FlatSamples::F32((1..4).map(|k| (10 * i + k) as f32).collect());
    let channels = names.iter().enumerate().map(|(i, name)| AnyChannel::new(*name, samples(i)));
    let channels = AnyChannels::sort(channels.collect());
    let layer = Layer::new((3, 1), LayerAttributes::default(), Encoding::UNCOMPRESSED, channels);
    let mut bytes = Cursor::new(Vec::new());
    exr::prelude::Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn exr_colours_that_are_absent_are_black_and_luminance_is_grey() {
    let second = |names: &[&str]| read(&exr_with(names)).unwrap().image.pixels[1];
    assert_eq!(second(&["R", "G", "B", "A"]), [2.0, 12.0, 22.0, 32.0]);
    assert_eq!(second(&["R", "B"]), [2.0, 0.0, 12.0, 1.0]);
    assert_eq!(second(&["G"]), [0.0, 2.0, 0.0, 1.0]);
    assert_eq!(second(&["G", "B"]), [0.0, 2.0, 12.0, 1.0]);
    assert_eq!(second(&["B", "Z"]), [0.0, 0.0, 2.0, 1.0]);
    assert_eq!(second(&["Y", "A"]), [2.0, 2.0, 2.0, 12.0]);
    let error = read(&exr_with(&["Z"])).unwrap_err().to_string();
    assert!(error.contains("no part of this EXR has channels R, G, B or Y"), "{error}");
}

#[test]
fn an_opaque_film_file_shows_no_coverage() {
    let pixels = [[0.5, 0.5, 0.5, 0.25]];
    let alpha = |transparent: bool| {
        let film = film_of(1, &pixels, |s| s.transparent = transparent);
        read(&encode(&film, Format::Gfilm, false)).unwrap().image.pixels[0][3]
    };
    assert_eq!((alpha(false), alpha(true)), (1.0, 0.25));
}

#[test]
fn rgbe_rounds_to_the_nearest_mantissa_and_stays_in_range() {
    use gonio::film::write::rgbe;
    assert_eq!(rgbe([1.0, 0.5, 0.0]), [128, 64, 0, 129]);
    // 255.75 / 256 rounds up to a mantissa of 256, which is 128 with the next exponent.
    assert_eq!(rgbe([0.999_023_44, 0.0, 0.0]), [128, 0, 0, 129]);
    assert_eq!(rgbe([f32::NAN, -1.0, 0.0]), [0; 4]);
    assert_eq!(rgbe([1e-40, 0.0, 0.0]), [0; 4]);
    assert_eq!(rgbe([f32::INFINITY, 0.0, 0.0]), [255, 0, 0, 255]);
    assert_eq!(rgbe([f32::MAX, 0.0, 0.0]), [255, 0, 0, 255]);
}

#[test]
fn a_film_file_reads_as_its_picture() {
    let pixels = ramp(4, 2);
    let film = film_of(4, &pixels, |s: &mut FilmSpec| s.transparent = true);
    let read = read(&encode(&film, Format::Gfilm, false)).unwrap();
    assert_eq!((read.image.pixels, read.film_hash), (pixels, Some(film.hash())));
}

#[test]
fn formats_are_known_by_their_extensions() {
    for (name, format) in [
        ("a.png", Format::Png),
        ("b.EXR", Format::Exr),
        ("c.hdr", Format::Hdr),
        ("x.y.gfilm", Format::Gfilm),
        ("-", Format::Png),
    ] {
        assert_eq!(Format::of(Path::new(name)).unwrap(), format);
    }
    for (name, found) in [("a.gif", "unknown extension .gif"), ("picture", "no extension")] {
        let error = Format::of(Path::new(name)).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert_eq!(error.to_string(), format!("{name}: {found}; allowed: .png, .jpg, .webp, .exr, .hdr, .gfilm"));
    }
    assert!(Format::Exr.has_layers() && Format::Gfilm.has_layers() && !Format::Png.has_layers());
    assert_eq!("depth".parse::<Aov>(), Ok(Aov::Depth));
    assert!("colour".parse::<Aov>().unwrap_err().starts_with("allowed: depth, normal"));
}

#[test]
fn damaged_pictures_are_bad_and_never_a_panic() {
    let film = film_of(40, &ramp(40, 20), |s| s.aovs = true);
    for format in [Format::Png, Format::Exr, Format::Hdr, Format::Gfilm] {
        let good = encode(&film, format, false);
        // The last 16 bytes of a PNG hold no pixels.
        for end in [0, 1, 8, 15, 16, 40, good.len() / 2, good.len() - 30] {
            let Err(error) = read(&good[..end]) else { panic!("{format:?} of {end} bytes was read") };
            assert_eq!(error.exit_code(), 65, "{error}");
            assert!(error.to_string().starts_with("a: "), "{error}");
        }
    }
    assert!(read(b"hello, world, this is text").unwrap_err().to_string().contains("not a PNG, JPEG"));
}

#[test]
fn an_endless_stream_of_something_else_ends() {
    assert_eq!(read_picture_from(Path::new("-"), std::io::repeat(0)).unwrap_err().exit_code(), 65);
}

#[test]
fn an_exr_that_claims_a_huge_picture_is_refused_before_memory_is_taken() {
    let mut bytes = encode(&film_of(4, &ramp(4, 2), |_| {}), Format::Exr, false);
    let name = b"dataWindow\0box2i\0";
    let at = bytes.windows(name.len()).position(|w| w == name).unwrap() + name.len() + 4;
    let mut refuse = |width: i32, height: i32, reason: &str| {
        bytes[at + 8..at + 12].copy_from_slice(&(width + 1).to_le_bytes());
        bytes[at + 12..at + 16].copy_from_slice(&height.to_le_bytes());
        let error = read(&bytes).unwrap_err();
        assert_eq!(error.exit_code(), 65, "{error}");
        assert!(error.to_string().contains(reason), "{error}");
    };
    // The corner is 2,1: these are the last column and row of a picture of that size.
    refuse(1 << 20, 1 << 20, "pixels are allowed");
    refuse(4, 1 << 20, "fewer bytes than its chunks need");
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().to_path_buf(), folder.path().join("missing.png")] {
        let error = read_picture(&path).unwrap_err();
        assert_eq!(error.exit_code(), 74);
        assert!(error.to_string().starts_with(&format!("cannot read {}: ", path.display())), "{error}");
    }
}

#[test]
fn the_png_suite_is_read_and_its_broken_files_are_refused() {
    let Some(assets) = asset("") else { return };
    let (mut read, mut refused) = (0, 0);
    for entry in std::fs::read_dir(assets.join("images/pngsuite")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "png") {
            continue;
        }
        let broken = path.file_name().unwrap().to_string_lossy().starts_with('x');
        match read_picture(&path) {
            Ok(_) if !broken => read += 1,
            Err(error) if broken => {
                assert_eq!(error.exit_code(), 65, "{error}");
                refused += 1;
            }
            other => panic!("{}: {:?}", path.display(), other.map(|p| p.image.width)),
        }
    }
    assert!(read > 80 && refused > 2, "{read} read, {refused} refused");
}

#[test]
fn exr_files_of_other_programs_are_read() {
    let Some(assets) = asset("") else { return };
    let mut read = 0;
    for entry in std::fs::read_dir(assets.join("images/exr-testimages")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "exr") {
            let picture = read_picture(&path).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(picture.image.pixels.len(), (picture.image.width * picture.image.height) as usize);
            read += 1;
        }
    }
    assert!(read >= 8, "{read}");
    let rings = read_picture(&assets.join("images/exr-testimages/BrightRingsNanInf.exr")).unwrap();
    assert!(rings.image.pixels.iter().flatten().any(|v| v.is_nan()));
    read_picture(&assets.join("hdr/OrientationLatLong.exr")).unwrap();
}
