//! OpenEXR and Radiance files: windows, channels, chromaticities, exposures, orders. What is expected of each is derived here
//! from the formats' documents; Mitsuba's values are those of 3.9.1 (scalar_rgb).

use crate::assets::asset;
use gonio::picture::{Picture, Purpose, exr, radiance};
use std::path::PathBuf;

fn any_size(_: u64, _: u64) -> Result<(), String> {
    Ok(())
}

/// An attribute of a header.
fn attribute(name: &str, kind: &str, value: &[u8]) -> Vec<u8> {
    let mut bytes = [name.as_bytes(), b"\0", kind.as_bytes(), b"\0"].concat();
    bytes.extend((value.len() as i32).to_le_bytes());
    bytes.extend(value);
    bytes
}

/// How the samples of a channel are stored: u32, half, f32.
#[derive(Clone, Copy)]
enum Stored {
    Integer = 0,
    Half = 1,
    Float = 2,
}

/// An EXR to be written, uncompressed, one part.
struct Exr<'a> {
    /// Corners, the last inside.
    data: [i32; 4],
    display: [i32; 4],
    /// In the order of their names, each with its values from the top row down.
    channels: &'a [(&'a str, Stored, Vec<f32>)],
    extra: Vec<u8>,
}

impl Exr<'_> {
    fn bytes(&self) -> Vec<u8> {
        let window = |corners: [i32; 4]| corners.map(i32::to_le_bytes).concat();
        let mut list = Vec::new();
        for (name, stored, _) in self.channels {
            list.extend(name.as_bytes());
            list.push(0);
            list.extend([*stored as i32, 0, 1, 1].map(i32::to_le_bytes).concat());
        }
        list.push(0);
        let mut bytes = [exr::MAGIC.to_vec(), vec![2, 0, 0, 0]].concat();
        bytes.extend(attribute("channels", "chlist", &list));
        bytes.extend(attribute("compression", "compression", &[0]));
        bytes.extend(attribute("dataWindow", "box2i", &window(self.data)));
        bytes.extend(attribute("displayWindow", "box2i", &window(self.display)));
        bytes.extend(attribute("lineOrder", "lineOrder", &[0]));
        bytes.extend(attribute("pixelAspectRatio", "float", &1f32.to_le_bytes()));
        bytes.extend(attribute("screenWindowCenter", "v2f", &[0; 8]));
        bytes.extend(attribute("screenWindowWidth", "float", &1f32.to_le_bytes()));
        bytes.extend(&self.extra);
        bytes.push(0);
        let [x0, y0, x1, y1] = self.data;
        let (width, height) = ((x1 - x0 + 1) as usize, (y1 - y0 + 1) as usize);
        let rows: Vec<Vec<u8>> = (0..height).map(|row| self.row(row, width)).collect();
        let mut offset = bytes.len() + 8 * height;
        for row in &rows {
            bytes.extend((offset as u64).to_le_bytes());
            offset += row.len() + 8;
        }
        for (y, row) in rows.iter().enumerate() {
            bytes.extend((y0 + y as i32).to_le_bytes());
            bytes.extend((row.len() as i32).to_le_bytes());
            bytes.extend(row);
        }
        bytes
    }

    fn row(&self, row: usize, width: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (_, stored, values) in self.channels {
            for value in &values[row * width..(row + 1) * width] {
                match stored {
                    Stored::Integer => bytes.extend((*value as u32).to_le_bytes()),
                    Stored::Half => bytes.extend(::exr::prelude::f16::from_f32(*value).to_le_bytes()),
                    Stored::Float => bytes.extend(value.to_le_bytes()),
                }
            }
        }
        bytes
    }
}

/// One pixel with these channels, in the order of their names.
fn pixel(channels: &[(&str, f32)], extra: Vec<u8>, purpose: Purpose) -> Result<[f32; 4], String> {
    let channels: Vec<_> = channels.iter().map(|(name, value)| (*name, Stored::Float, vec![*value])).collect();
    let one = [0, 0, 0, 0];
    let bytes = Exr { data: one, display: one, channels: &channels, extra }.bytes();
    exr::read(&bytes, purpose, &any_size).map(|picture| picture.pixels[0])
}

/// The reds of a picture, row by row.
fn reds(picture: &Picture) -> Vec<f32> {
    picture.pixels.iter().map(|pixel| pixel[0]).collect()
}

fn windowed(data: [i32; 4], display: [i32; 4], values: Vec<f32>, purpose: Purpose) -> Result<Picture, String> {
    let channels = ["B", "G", "R"].map(|name| (name, Stored::Float, values.clone()));
    exr::read(&Exr { data, display, channels: &channels, extra: Vec::new() }.bytes(), purpose, &any_size)
}

#[test]
fn an_exr_shows_its_display_window() {
    // Data in the right half: the left is black and holds nothing.
    let crop = |purpose| windowed([2, 0, 3, 1], [0, 0, 3, 1], vec![1.0, 2.0, 3.0, 4.0], purpose).unwrap();
    for purpose in [Purpose::Colors, Purpose::Data] {
        let picture = crop(purpose);
        assert_eq!((picture.width, picture.height), (4, 2));
        assert_eq!(reds(&picture), [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 3.0, 4.0]);
        assert_eq!(picture.pixels.iter().map(|p| p[3]).collect::<Vec<_>>(), [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0]);
    }
    // What is compared, and what Mitsuba takes, is the data alone.
    for purpose in [Purpose::Compared, Purpose::Mitsuba] {
        assert_eq!((crop(purpose).width, reds(&crop(purpose))), (2, vec![1.0, 2.0, 3.0, 4.0]));
    }
    // Data beyond all four edges of a window that does not begin at 0.
    let wide: Vec<f32> = (0..16).map(|v| v as f32).collect();
    let over = |purpose| windowed([-6, 4, -3, 7], [-5, 5, -4, 6], wide.clone(), purpose).unwrap();
    for purpose in [Purpose::Colors, Purpose::Compared] {
        assert_eq!((over(purpose).width, reds(&over(purpose))), (2, vec![5.0, 6.0, 9.0, 10.0]));
    }
    assert_eq!(reds(&over(Purpose::Mitsuba)), wide);
    // Windows that cross at a corner.
    let corner = windowed([1, 1, 2, 2], [0, 0, 1, 1], vec![5.0, 6.0, 7.0, 8.0], Purpose::Colors).unwrap();
    assert_eq!(reds(&corner), [0.0, 0.0, 0.0, 5.0]);
    // Windows apart: black, and nothing to compare.
    let apart = |purpose| windowed([8, 8, 8, 8], [0, 0, 0, 0], vec![1.0], purpose);
    assert_eq!(apart(Purpose::Colors).unwrap().pixels, [[0.0; 4]]);
    assert!(apart(Purpose::Compared).unwrap_err().contains("outside its display window"));
}

#[test]
fn both_windows_of_an_exr_are_checked_before_memory_is_taken() {
    let refuse = |most: u64| move |w: u64, h: u64| if w * h > most { Err(format!("{w}x{h}")) } else { Ok(()) };
    let channels = [("Y", Stored::Float, vec![1.0])];
    let huge = |data, display| Exr { data, display, channels: &channels, extra: Vec::new() }.bytes();
    let one = [0, 0, 0, 0];
    let display = exr::read(&huge(one, [0, 0, 999_999, 999_999]), Purpose::Colors, &refuse(100));
    assert_eq!(display.unwrap_err(), "1000000x1000000");
    let mut lies = huge(one, one);
    let at = lies.windows(10).position(|w| w == b"dataWindow").unwrap() + b"dataWindow\0box2i\0".len() + 4 + 8;
    lies[at..at + 8].copy_from_slice(&[999_999i32, 999_999].map(i32::to_le_bytes).concat());
    assert_eq!(exr::read(&lies, Purpose::Colors, &refuse(100)).unwrap_err(), "1000000x1000000");
}

#[test]
fn the_channels_of_an_exr_are_found_by_their_names() {
    let of = |channels: &[(&str, f32)]| pixel(channels, Vec::new(), Purpose::Colors);
    let grey = Ok([0.5, 0.5, 0.5, 1.0]);
    assert_eq!(of(&[("Y", 0.5)]), grey);
    assert_eq!(of(&[("A", 0.25), ("Y", 0.5)]), Ok([0.5, 0.5, 0.5, 0.25]));
    for lone in ["R", "G", "Z", "height", "depth.V", "diffuse.Y"] {
        assert_eq!(of(&[(lone, 0.5)]), grey, "{lone}");
    }
    assert_eq!(of(&[("B", 1.0), ("G", 0.25), ("R", 0.5), ("Z", 7.0)]), Ok([0.5, 0.25, 1.0, 1.0]));
    assert_eq!(of(&[("b", 1.0), ("g", 0.25), ("r", 0.5)]), Ok([0.5, 0.25, 1.0, 1.0]));
    assert_eq!(of(&[("G", 0.25), ("R", 0.5)]), Ok([0.5, 0.25, 0.0, 1.0]));
    let layer = |name: &str, value: f32| ["A", "B", "G", "R"].map(|c| (format!("{name}.{c}"), value));
    let layers = |names: &[(&str, f32)], more: &[(&str, f32)]| {
        let mut all: Vec<(String, f32)> = names.iter().flat_map(|(name, value)| layer(name, *value)).collect();
        all.extend(more.iter().map(|(name, value)| ((*name).to_owned(), *value)));
        all.sort_by(|a, b| a.0.cmp(&b.0));
        let all: Vec<(&str, f32)> = all.iter().map(|(name, value)| (name.as_str(), *value)).collect();
        of(&all).map(|pixel| pixel[0])
    };
    // The whole picture before its parts, whatever the order; plain channels before layers; colours before luminance.
    assert_eq!(layers(&[("diffuse", 0.5)], &[]), Ok(0.5));
    assert_eq!(layers(&[("View.AO", 1.0), ("View.Combined", 2.0), ("View.Diffuse", 3.0)], &[]), Ok(2.0));
    assert_eq!(layers(&[("a", 1.0), ("b", 2.0)], &[("Z", 9.0)]), Ok(1.0));
    assert_eq!(layers(&[("a", 1.0)], &[("B", 3.0), ("G", 3.0), ("R", 3.0)]), Ok(3.0));
    assert_eq!(layers(&[("a", 1.0)], &[("Y", 3.0)]), Ok(1.0));
    // A vector is no luminance.
    let error = of(&[("n.X", 1.0), ("n.Y", 2.0), ("n.Z", 3.0)]).unwrap_err();
    assert_eq!(error, "no part of this EXR has channels R, G, B or Y; it has n.X, n.Y, n.Z");
    assert!(of(&[("BY", 1.0), ("RY", 2.0), ("Y", 3.0)]).unwrap_err().contains("luminance and chroma"));
    // Two pictures beside each other keep their channels.
    assert_eq!(pixel(&[("R", 0.5)], Vec::new(), Purpose::Compared), Ok([0.5, 0.0, 0.0, 1.0]));
    assert!(pixel(&[("Z", 0.5)], Vec::new(), Purpose::Compared).is_err());
}

#[test]
fn halves_floats_and_integers_are_read() {
    let one = [0, 0, 1, 0];
    let channels = [
        ("B", Stored::Half, vec![0.5, 65_504.0]),
        ("G", Stored::Integer, vec![7.0, 4_000_000.0]),
        ("R", Stored::Float, vec![1e-30, f32::INFINITY]),
    ];
    let bytes = Exr { data: one, display: one, channels: &channels, extra: Vec::new() }.bytes();
    let picture = exr::read(&bytes, Purpose::Colors, &any_size).unwrap();
    assert_eq!(picture.pixels, [[1e-30, 7.0, 0.5, 1.0], [f32::INFINITY, 4_000_000.0, 65_504.0, 1.0]]);
}

fn chromaticities(numbers: [f32; 8]) -> Vec<u8> {
    attribute("chromaticities", "chromaticities", &numbers.map(f32::to_le_bytes).concat())
}

const ACESCG: [f32; 8] = [0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767];

#[track_caller]
fn close(found: [f32; 4], expected: [f32; 3], tolerance: f32) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance, "{found:?} is not {expected:?}");
    }
}

#[test]
fn colours_of_other_chromaticities_become_rec_709() {
    let read = |rgb: [f32; 3], numbers: [f32; 8], purpose| {
        let [r, g, b] = rgb;
        pixel(&[("B", b), ("G", g), ("R", r)], chromaticities(numbers), purpose)
    };
    for purpose in [Purpose::Colors, Purpose::Compared] {
        close(read([0.5; 3], ACESCG, purpose).unwrap(), [0.5; 3], 1e-6);
        // The columns of AP1 to Rec. 709 with white adapted (ACES, `ACEScg_to_sRGB`), to three decimals.
        close(read([1.0, 0.0, 0.0], ACESCG, purpose).unwrap(), [1.705, -0.130, -0.024], 2e-3);
        close(read([0.0, 1.0, 0.0], ACESCG, purpose).unwrap(), [-0.622, 1.141, -0.129], 2e-3);
    }
    // Mitsuba leaves white where it is.
    close(read([1.0; 3], ACESCG, Purpose::Mitsuba).unwrap(), [1.0471031665802002, 0.99454265832901, 0.9153185], 1e-5);
    close(read([1.0, 0.0, 0.0], ACESCG, Purpose::Mitsuba).unwrap(), [1.7312536, -0.13161896, -0.02456828], 1e-5);
    let odd = [0.1f32, 0.7, 3.3];
    let same = |numbers, purpose| assert_eq!(read(odd, numbers, purpose).unwrap()[..3], odd);
    same(ACESCG, Purpose::Data);
    same([0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329], Purpose::Colors);
    same([0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.31271, 0.32902], Purpose::Mitsuba);
    // Grey has no hue to be turned.
    assert_eq!(pixel(&[("Y", 0.5)], chromaticities(ACESCG), Purpose::Colors), Ok([0.5, 0.5, 0.5, 1.0]));
    // What are no primaries say nothing; some programs write zeros.
    for bad in [[0.0; 8], [0.3, 0.3, 0.3, 0.3, 0.15, 0.06, 0.31, 0.33], [f32::NAN; 8]] {
        same(bad, Purpose::Colors);
    }
    // An infinite light has no colour, but stays where it is.
    let infinite = read([f32::INFINITY, 1.0, 1.0], ACESCG, Purpose::Colors).unwrap();
    assert_eq!(infinite, [f32::INFINITY, 1.0, 1.0, 1.0]);
    // X, Y, Z of D65 are white.
    let white = pixel(&[("X", 0.950_456), ("Y", 1.0), ("Z", 1.089_058)], Vec::new(), Purpose::Colors).unwrap();
    close(white, [1.0; 3], 1e-4);
}

#[test]
fn a_compression_that_is_not_known_is_named() {
    let one = [0, 0, 0, 0];
    let bytes =
        Exr { data: one, display: one, channels: &[("Y", Stored::Float, vec![1.0])], extra: Vec::new() }.bytes();
    let at = bytes.windows(24).position(|w| w == b"compression\0compression\0").unwrap() + 28;
    // Number 10, HTJ2K, is known, but decoded only where nothing was gained by it.
    for (code, name) in [(12, "LJ2K"), (13, "ZSTD"), (77, "unknown here")] {
        let mut bytes = bytes.clone();
        bytes[at] = code;
        let error = exr::read(&bytes, Purpose::Colors, &any_size).unwrap_err();
        assert!(error.contains(&format!("compression ({name}, number {code}) is not supported")), "{error}");
    }
}

/// A Radiance picture of grey pixels, stored as they come.
fn hdr(head: &str, order: &str, values: &[f32]) -> Vec<u8> {
    let mut bytes = format!("{head}\n{order}\n").into_bytes();
    bytes.extend(values.iter().flat_map(|v| gonio::film::write::rgbe([*v; 3])));
    bytes
}

const HEAD: &str = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

fn light(head: &str, purpose: Purpose) -> Result<[f32; 4], String> {
    radiance::read(&hdr(head, "-Y 1 +X 1", &[1.0]), purpose, &any_size).map(|picture| picture.pixels[0])
}

#[test]
fn all_eight_orders_of_a_radiance_picture_show_the_same() {
    // Three columns, two rows: 1 2 3 above 4 5 6.
    let expected: Vec<f32> = (1..7).map(|v| v as f32).collect();
    for (order, stored) in [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
        ("-X   3   +Y     2", [6, 3, 5, 2, 4, 1]),
    ] {
        let picture = radiance::read(&hdr(HEAD, order, &stored.map(|v| v as f32)), Purpose::Colors, &any_size).unwrap();
        assert_eq!((picture.width, picture.height), (3, 2), "{order}");
        assert_eq!(reds(&picture), expected, "{order}");
    }
    for order in ["2 3", "-Y 2", "-Y 2 +Y 3", "Y 2 X 3", "-Y two +X 3", "-Y 2 +X 3 +Z 4", "éY 2 +X 3", "- 2 + 3"] {
        let error = radiance::read(&hdr(HEAD, order, &[1.0]), Purpose::Colors, &any_size).unwrap_err();
        assert!(error.contains(&format!("says its size as {order:?}")), "{error}");
    }
}

#[test]
fn exposures_of_a_radiance_picture_are_taken_out() {
    let with = |lines: &str| light(&format!("{HEAD}{lines}"), Purpose::Colors);
    assert_eq!(with(""), Ok([1.0; 4]));
    assert_eq!(with("EXPOSURE=2.0\n"), Ok([0.5, 0.5, 0.5, 1.0]));
    assert_eq!(with("EXPOSURE=2.0\nVIEW= -vp 0 0 0\nEXPOSURE= 4\n"), Ok([0.125, 0.125, 0.125, 1.0]));
    assert_eq!(with("EXPOSURE=2\nCOLORCORR= 1 2 0.5\n"), Ok([0.5, 0.25, 1.0, 1.0]));
    assert_eq!(light(&format!("{HEAD}EXPOSURE=2\n"), Purpose::Compared), Ok([0.5, 0.5, 0.5, 1.0]));
    assert_eq!(light(&format!("{HEAD}EXPOSURE=2\n"), Purpose::Data), Ok([0.5, 0.5, 0.5, 1.0]));
    // Mitsuba knows of none.
    assert_eq!(light(&format!("{HEAD}EXPOSURE=2\nCOLORCORR=1 2 3\n"), Purpose::Mitsuba), Ok([1.0; 4]));
    for (line, expected) in [
        ("EXPOSURE=0\n", "\"EXPOSURE=0\"; it is a number above 0"),
        ("EXPOSURE=-1\n", "it is a number above 0"),
        ("EXPOSURE=nan\n", "it is a number above 0"),
        ("EXPOSURE=\n", "it is a number above 0"),
        ("COLORCORR=1 2\n", "it is three numbers above 0"),
        ("PRIMARIES=1 2\n", "they are eight numbers"),
        ("EXPOSURE=1e-300\nEXPOSURE=1e-300\n", "the exposures of the Radiance picture"),
        ("FORMAT=rgb\n", "known are 32-bit_rle_rgbe and 32-bit_rle_xyze"),
    ] {
        let error = with(line).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn radiance_pictures_of_other_heads_and_colours_are_read() {
    // A name of a program, line ends of Windows, a comment, no FORMAT.
    for head in ["#?RGBE\nFORMAT=32-bit_rle_rgbe\n", "#?RADIANCE\r\n# 3=4\r\nEXPOSURE=1\r\n\r", "#?AUTOPANO\n"] {
        assert_eq!(light(head, Purpose::Colors), Ok([1.0; 4]), "{head:?}");
    }
    let xyze = |lines: &str, purpose| light(&format!("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n{lines}"), purpose).unwrap();
    // 1, 1, 1 in lumens is white of 1/179.
    close(xyze("", Purpose::Colors), [1.0 / 179.0; 3], 1e-8);
    close(xyze("EXPOSURE=5.5866e-03\n", Purpose::Colors), [1.0; 3], 1e-5);
    // Mitsuba: the plain matrix to Rec. 709.
    close(xyze("EXPOSURE=5.5866e-03\n", Purpose::Mitsuba), [1.204_8, 0.948_3, 0.908_9], 1e-3);
    let primaries = |numbers: &str, purpose| light(&format!("{HEAD}PRIMARIES={numbers}\n"), purpose).unwrap();
    let ap1 = "0.713 0.293 0.165 0.830 0.128 0.044 0.32168 0.33767";
    close(primaries(ap1, Purpose::Colors), [1.0; 3], 1e-6);
    assert_eq!(primaries("0.64 0.33 0.29 0.60 0.15 0.06 0.333 0.333", Purpose::Colors), [1.0; 4]);
    // As in files of Poly Haven.
    assert_eq!(primaries("0 0 0 0 0 0 0 0", Purpose::Colors), [1.0; 4]);
    let mut red = format!("{HEAD}PRIMARIES={ap1}\n\n-Y 1 +X 1\n").into_bytes();
    red.extend(gonio::film::write::rgbe([1.0, 0.0, 0.0]));
    let of = |purpose| radiance::read(&red, purpose, &any_size).unwrap().pixels[0];
    close(of(Purpose::Colors), [1.705, -0.130, -0.024], 2e-3);
    assert_eq!(of(Purpose::Data), [1.0, 0.0, 0.0, 1.0]);
}

#[test]
fn heads_and_scanlines_that_end_early_are_refused() {
    let whole = hdr(HEAD, "-Y 2 +X 9", &[0.5; 18]);
    for length in 0..whole.len() {
        let error = radiance::read(&whole[..length], Purpose::Colors, &any_size);
        assert!(error.is_err(), "{length} of {} bytes", whole.len());
    }
    assert!(radiance::read(&whole, Purpose::Colors, &any_size).is_ok());
    let endless = [b"#?RADIANCE\n".to_vec(), vec![b'a'; 3 << 20]].concat();
    assert!(radiance::read(&endless, Purpose::Colors, &any_size).unwrap_err().contains("has no end"));
}

/// The folder of files that other programs wrote, if it is there.
fn written_by_others() -> Option<PathBuf> {
    let folder = asset("")?.join("../cases/files");
    if !folder.is_dir() {
        println!("SKIPPED: no {}", folder.display());
        return None;
    }
    Some(folder)
}

#[test]
fn radiances_own_tools_write_one_picture_in_five_ways() {
    let Some(folder) = written_by_others() else { return };
    let read =
        |name: &str| radiance::read(&std::fs::read(folder.join(name)).unwrap(), Purpose::Colors, &any_size).unwrap();
    let plain = read("g.hdr");
    assert_eq!((plain.width, plain.height), (6, 4));
    // pflip -h, pflip -v: bit for bit.
    assert_eq!(read("gh.hdr"), plain);
    assert_eq!(read("gv.hdr"), plain);
    // pfilt -e 4 multiplies by a power of two; ra_xyze rounds to other mantissas: half a step of 1/128 of the largest channel,
    // times the largest sum of a row of the matrix back (4.6).
    for (name, steps) in [("ge.hdr", 0.0), ("gx.hdr", 4.6 / 128.0)] {
        let other = read(name);
        for (a, b) in other.pixels.iter().zip(&plain.pixels) {
            let largest = b[..3].iter().fold(0.0f32, |m, v| m.max(*v));
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() <= steps * largest + 1e-6, "{name}: {a} is not {b}");
            }
        }
    }
}

#[test]
fn openexrs_own_library_writes_luminance_layers_and_chromaticities() {
    let Some(folder) = written_by_others() else { return };
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let read = |name: &str, purpose| exr::read(&bytes(name), purpose, &any_size).unwrap();
    for purpose in [Purpose::Colors, Purpose::Compared, Purpose::Mitsuba] {
        // As Mitsuba 3.9.1 reads them.
        assert_eq!(read("y.exr", purpose).pixels[1..3], [[0.0625, 0.0625, 0.0625, 1.0], [0.125, 0.125, 0.125, 1.0]]);
        assert_eq!(read("multilayer.exr", purpose).pixels[2], [0.125, 0.0, 0.25, 1.0]);
    }
    let ap1 = read("acescg.exr", Purpose::Data).pixels;
    let mitsuba = read("acescg.exr", Purpose::Mitsuba).pixels;
    close(mitsuba[0], [-0.02001953125, -0.002170562744140625, 0.266357421875], 3e-4);
    close(mitsuba[2], [0.1964111328125, -0.01861572265625, 0.263427734375], 3e-4);
    let matrix = [[1.705, -0.622, -0.083], [-0.130, 1.141, -0.011], [-0.024, -0.129, 1.153]];
    for (from, to) in ap1.iter().zip(read("acescg.exr", Purpose::Colors).pixels) {
        close(to, matrix.map(|row: [f32; 3]| row.iter().zip(from).map(|(m, v)| m * v).sum()), 4e-3);
    }
    for (name, method) in [("o_LJ2K.exr", "LJ2K"), ("o_ZSTD.exr", "ZSTD")] {
        let error = exr::read(&bytes(name), Purpose::Colors, &any_size).unwrap_err();
        assert!(error.contains(&format!("compression ({method},")), "{error}");
    }
}
