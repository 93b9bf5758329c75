//! The `.gfilm` file: what goes in comes out, and nothing else is believed.

use crate::{PIXELS, film_of, spec};
use gonio::film::{Film, FilmSpec, SUM_BITS, gfilm};
use std::io::Read;
use std::path::Path;

fn bytes_of(film: &Film) -> Vec<u8> {
    let mut bytes = Vec::new();
    gfilm::write(film, &mut bytes).unwrap();
    bytes
}

fn read(bytes: &[u8]) -> Result<Film, String> {
    gfilm::read(Path::new("a.gfilm"), &mut &bytes[..]).map_err(|error| {
        let message = error.to_string();
        assert_eq!(error.exit_code(), 65, "{message}");
        message.strip_prefix("a.gfilm: ").expect("the message names the file").to_owned()
    })
}

#[test]
fn a_film_survives_its_file() {
    let mut plain = Film::new(FilmSpec { aovs: false, scene_name: "Kugel \u{00e4}\u{2603}.toml".into(), ..spec() });
    plain.record(3..9, 1, u64::MAX);
    for film in [film_of([0, 1, 7]), film_of([]), plain] {
        let read = read(&bytes_of(&film)).unwrap();
        assert_eq!(read, film);
        assert_eq!(read.hash(), film.hash());
    }
}

#[test]
fn a_film_can_be_read_from_a_slow_pipe() {
    struct Slow<'a>(&'a [u8]);
    impl Read for Slow<'_> {
        fn read(&mut self, out: &mut [u8]) -> std::io::Result<usize> {
            let n = out.len().min(7);
            self.0.read(&mut out[..n])
        }
    }
    let film = film_of(0..3);
    assert_eq!(gfilm::read(Path::new("-"), &mut Slow(&bytes_of(&film))).unwrap(), film);
}

/// A film file with another header; its checksum is right.
fn with_header(change: impl Fn(&mut serde_json::Value)) -> Vec<u8> {
    let bytes = bytes_of(&film_of(0..2));
    let end = 16 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let mut header = serde_json::from_slice(&bytes[16..end]).unwrap();
    change(&mut header);
    with_raw_header(&serde_json::to_vec(&header).unwrap(), &bytes[end..bytes.len() - 32])
}

fn with_raw_header(header: &[u8], planes: &[u8]) -> Vec<u8> {
    let mut bytes = gfilm::MAGIC.to_vec();
    bytes.extend(gfilm::VERSION.to_le_bytes());
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(header);
    bytes.extend(planes);
    bytes.extend(blake3::hash(&bytes).as_bytes());
    bytes
}

#[test]
fn malformed_headers_are_refused_with_the_reason() {
    type Change = fn(&mut serde_json::Value);
    let cases: [(&str, Change); 15] = [
        ("the frame is 0x5", |h| h["width"] = 0.into()),
        ("the frame is 70000x5", |h| h["width"] = 70_000.into()),
        ("the crop 0x2+4+1 is not inside", |h| h["crop"]["width"] = 0.into()),
        ("the crop 3x2+4294967295+1 is not inside", |h| h["crop"]["x"] = u32::MAX.into()),
        ("unit_exponent is 101", |h| h["unit_exponent"] = 101.into()),
        ("sample range 4..4", |h| h["samples"] = serde_json::json!([[4, 4]])),
        ("sample range 9..3", |h| h["samples"] = serde_json::json!([[9, 3]])),
        ("sample range 0..16777217", |h| h["samples"] = serde_json::json!([[0, 16_777_217]])),
        ("sample ranges overlap", |h| h["samples"] = serde_json::json!([[0, 4], [3, 5]])),
        ("scene_digest is \"12\"", |h| h["scene_digest"] = "12".into()),
        ("tonemap is \"filmic\"; allowed: clamp, normalise, reinhard, aces, agx", |h| h["tonemap"] = "filmic".into()),
        ("unknown field `surprise`", |h| h["surprise"] = 1.into()),
        ("missing field `seed`", |h| drop(h.as_object_mut().unwrap().remove("seed"))),
        ("invalid type: null", |h| h["exposure"] = serde_json::Value::Null),
        ("exposure is not a finite number", |h| h["exposure"] = 1e300.into()),
    ];
    for (reason, change) in cases {
        let message = read(&with_header(change)).unwrap_err();
        assert!(message.starts_with("film header: ") && message.contains(reason), "{reason}: {message}");
    }
    let message = read(&with_raw_header(b"{\xff", b"")).unwrap_err();
    assert!(message.starts_with("film header: "), "{message}");
}

#[test]
fn malformed_files_are_refused_with_the_reason() {
    let good = bytes_of(&film_of(0..2));
    let changed = |at: usize, to: &[u8]| {
        let mut bytes = good.clone();
        bytes[at..at + to.len()].copy_from_slice(to);
        bytes
    };
    let longer = |tail: &[u8]| [&good[..], tail].concat();
    let last_plane_byte = good.len() - 33;
    let cases = [
        ("truncated film: it ends after 0 bytes, inside the magic", vec![]),
        ("truncated film: it ends after 20 bytes, inside the header", good[..20].to_vec()),
        ("inside the checksum", good[..good.len() - 1].to_vec()),
        ("inside the auxiliary values", good[..good.len() - 40].to_vec()),
        ("inside the sums", good[..good.len() - 32 - 60 * PIXELS - 1].to_vec()),
        ("not a gonio film (wrong magic)", changed(0, b"g")),
        ("not a gonio film (wrong magic)", changed(5, b"\n\n\x1a")),
        ("film format 2 is newer than this program's, 1", changed(8, &[2])),
        ("film format 0 does not exist", changed(8, &[0])),
        ("the header claims 4294967295 bytes", changed(12, &[255; 4])),
        ("damaged film: the checksum does not match", changed(last_plane_byte, &[!good[last_plane_byte]])),
        ("damaged film: the checksum does not match", changed(good.len() - 1, &[!good[good.len() - 1]])),
        ("bytes follow the end of the film", longer(b"x")),
        // A frame of 65,535 squared claims 137 GB of sums; what is read ends with the file.
        (
            "inside the sums",
            with_header(|h| {
                (h["width"], h["height"]) = (65_535.into(), 65_535.into());
                h["crop"] = serde_json::json!({ "x": 0, "y": 0, "width": 65_535, "height": 65_535 });
            }),
        ),
        // One sample cannot have such a sum, and adding it up could overflow.
        (
            "sums of pixel (0, 0) of the crop exceed what 1 samples",
            with_header(|h| h["samples"] = serde_json::json!([[0, 1]])),
        ),
    ];
    for (reason, bytes) in cases {
        // The header alone would do for most sums: the first is made too large for certain.
        let bytes = if reason.starts_with("sums of") { with_large_sum(bytes) } else { bytes };
        let message = read(&bytes).unwrap_err();
        assert!(message.contains(reason), "{reason}: {message}");
    }
}

/// The file with one more than one sample can have as its first sum.
fn with_large_sum(mut bytes: Vec<u8>) -> Vec<u8> {
    let first = 16 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    bytes[first..first + 8].copy_from_slice(&((1i64 << SUM_BITS) + 1).to_le_bytes());
    let end = bytes.len() - 32;
    let checksum = blake3::hash(&bytes[..end]);
    bytes[end..].copy_from_slice(checksum.as_bytes());
    bytes
}

#[test]
fn every_truncation_and_every_changed_byte_is_noticed() {
    let good = bytes_of(&film_of(0..1));
    assert!(read(&good).is_ok());
    for i in 0..good.len() {
        assert!(read(&good[..i]).is_err(), "the first {i} bytes");
        let mut bytes = good.clone();
        bytes[i] ^= 0x10;
        assert!(read(&bytes).is_err(), "byte {i}");
    }
}
