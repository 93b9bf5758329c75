//! Tables of reflection for directions of light: a text head, then numbers as text or as 32-bit floats (scenes/README.md,
//! "Measured tables").

use super::text::line_and_column;
use super::toml::nearest;
use crate::scene::{DirectionalTable, Location, SceneError};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// How such a file begins.
pub const MAGIC: &[u8] = b"gonio-brdf";
const KEYS: [&str; 9] =
    ["light_theta", "light_phi", "symmetry", "view_theta", "view_phi", "view_phi_from", "channels", "scale", "data"];
/// Angles or azimuths, at most.
const MOST: usize = 4096;
/// Values, at most: a GiB of them.
const VALUES_MOST: u64 = 1 << 28;
/// No surface is brighter.
const BRIGHTEST: f32 = 1.0e6;

type Result<T> = std::result::Result<T, SceneError>;

/// One line of the head: its words after the key, each with its byte offset in the file.
struct Entry<'a> {
    key: &'a str,
    offset: usize,
    words: Vec<(usize, &'a str)>,
}

struct Source<'a> {
    file: &'a Path,
    bytes: &'a [u8],
}

impl<'a> Source<'a> {
    /// An error at a byte of the head or of numbers as text.
    fn bad(&self, offset: usize, message: impl Into<String>) -> SceneError {
        let text = String::from_utf8_lossy(&self.bytes[..offset]);
        let (line, column) = line_and_column(&text, text.len());
        SceneError::bad(Location { file: self.file.to_owned(), line, column }, message)
    }

    /// The head's lines up to `data`, and where what follows begins.
    fn head(&self) -> Result<(Vec<Entry<'a>>, usize)> {
        let mut entries: Vec<Entry> = Vec::new();
        let mut at = 0;
        while at < self.bytes.len() {
            let rest = &self.bytes[at..];
            let length = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            let line = std::str::from_utf8(&rest[..length])
                .map_err(|error| self.bad(at + error.valid_up_to(), "the head is not text"))?;
            let mut words = words(line.split('#').next().unwrap_or_default(), at);
            at += (length + 1).min(rest.len());
            if let Some((offset, key)) = words.next() {
                if let Some(first) = entries.iter().find(|entry| entry.key == key) {
                    let (line, _) = line_and_column(&String::from_utf8_lossy(self.bytes), first.offset);
                    return Err(self.bad(offset, format!("{key:?} was given on line {line} already")));
                }
                entries.push(Entry { key, offset, words: words.collect() });
                if key == "data" {
                    return Ok((entries, at));
                }
            }
        }
        Err(self.bad(self.bytes.len(), "the file ends before \"data text\" or \"data float32\""))
    }
}

/// The words of `text`, which begins at byte `start` of its file.
fn words(text: &str, start: usize) -> impl Iterator<Item = (usize, &str)> {
    let base = text.as_ptr() as usize;
    text.split_ascii_whitespace().map(move |word| (start + word.as_ptr() as usize - base, word))
}

/// The head's entries, asked by key.
struct Head<'a> {
    source: &'a Source<'a>,
    entries: Vec<Entry<'a>>,
    end: usize,
}

impl Head<'_> {
    fn entry(&self, key: &str) -> Option<&Entry<'_>> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    fn required(&self, key: &str) -> Result<&Entry<'_>> {
        self.entry(key).ok_or_else(|| self.source.bad(self.end, format!("the head lacks {key:?}")))
    }

    /// The one word after `key`.
    fn word(&self, entry: &Entry, expected: &str) -> Result<String> {
        match entry.words[..] {
            [(_, word)] => Ok(word.to_owned()),
            _ => Err(self.mismatch(entry, expected)),
        }
    }

    fn mismatch(&self, entry: &Entry, expected: &str) -> SceneError {
        let offset = entry.words.first().map_or(entry.offset, |(offset, _)| *offset);
        let found: Vec<&str> = entry.words.iter().map(|(_, word)| *word).collect();
        let found = if found.len() > 3 { format!("{} words", found.len()) } else { format!("{:?}", found.join(" ")) };
        self.source.bad(offset, format!("{:?} must be {expected}, found {found}", entry.key))
    }

    /// Radians from ascending degrees.
    fn angles(&self, key: &str) -> Result<Vec<f64>> {
        let entry = self.required(key)?;
        let expected = "degrees from 0 to 90, ascending";
        if entry.words.is_empty() || entry.words.len() > MOST {
            return Err(self.mismatch(entry, &format!("1 to {MOST} {expected}")));
        }
        let mut angles: Vec<f64> = Vec::new();
        for (offset, word) in &entry.words {
            let degrees = word.parse::<f64>().ok().filter(|degrees| (0.0..=90.0).contains(degrees));
            let radians = degrees.map(|degrees| degrees / 90.0 * FRAC_PI_2);
            match radians.filter(|angle| angles.last().is_none_or(|last| last < angle)) {
                Some(angle) => angles.push(angle),
                None => return Err(self.source.bad(*offset, format!("{key:?} must be {expected}, found {word:?}"))),
            }
        }
        Ok(angles)
    }

    fn count(&self, entry: &Entry, most: usize) -> Result<u32> {
        let expected = format!("a whole number from 1 to {most}");
        let number = self.word(entry, &expected)?.parse::<u32>().ok();
        let allowed = number.filter(|number| (1..=most as u32).contains(number));
        allowed.ok_or_else(|| self.mismatch(entry, &expected))
    }

    fn count_or_1(&self, key: &str, most: usize) -> Result<u32> {
        self.entry(key).map_or(Ok(1), |entry| self.count(entry, most))
    }

    fn choice(&self, key: &str, words: [&str; 2]) -> Result<bool> {
        let Some(entry) = self.entry(key) else { return Ok(false) };
        let expected = format!("{:?} or {:?}", words[0], words[1]);
        let word = self.word(entry, &expected)?;
        match words.iter().position(|known| *known == word) {
            Some(index) => Ok(index == 1),
            None => Err(self.mismatch(entry, &expected)),
        }
    }
}

/// Reads a table from the `bytes` of `file`.
pub fn read_directional(file: &Path, bytes: &[u8]) -> Result<DirectionalTable> {
    let source = Source { file, bytes };
    let (entries, end) = source.head()?;
    let head = Head { source: &source, entries, end };
    match head.entries[0].words[..] {
        [(_, "1")] if head.entries[0].key.as_bytes() == MAGIC => {}
        _ => return Err(source.bad(0, "a table begins with \"gonio-brdf 1\"")),
    }
    if let Some(entry) = head.entries[1..].iter().find(|entry| !KEYS.contains(&entry.key)) {
        let hint = nearest(entry.key, KEYS.into_iter())
            .map_or_else(|| format!("there are {}", KEYS.join(", ")), |near| format!("did you mean {near:?}?"));
        return Err(source.bad(entry.offset, format!("unknown key {:?}; {hint}", entry.key)));
    }
    let mut table = DirectionalTable {
        light_angles: head.angles("light_theta")?,
        light_azimuths: head.count_or_1("light_phi", MOST)?,
        fold: head.count_or_1("symmetry", 360)?,
        view_angles: head.angles("view_theta")?,
        view_azimuths: head.count(head.required("view_phi")?, MOST)?,
        values: Vec::new(),
    };
    let channels = match head.entry("channels") {
        None => 3,
        Some(entry) => match head.count(entry, 3)? {
            2 => return Err(head.mismatch(entry, "1 or 3")),
            channels => channels as usize,
        },
    };
    if table.count() > VALUES_MOST {
        let message = format!("a table has at most {VALUES_MOST} values, this one {}", table.count());
        return Err(source.bad(end, message));
    }
    let scale = read_scale(&head)?;
    let count = table.count() as usize / 3 * channels;
    let numbers = if head.choice("data", ["text", "float32"])? {
        read_floats(&source, end, count)?
    } else {
        read_text(&source, end, count)?
    };
    table.values = numbers.chunks_exact(channels).flat_map(|v| [v[0], v[channels / 2], v[channels - 1]]).collect();
    let from_surface = head.choice("view_phi_from", ["light", "surface"])?;
    if from_surface {
        count_from_the_light(&head, &mut table)?;
    }
    fill(&mut table);
    for (index, value) in table.values.iter_mut().enumerate() {
        *value = ((f64::from(*value) * scale[index % 3]) as f32).min(BRIGHTEST);
    }
    Ok(table)
}

/// What values are multiplied by, per channel.
fn read_scale(head: &Head) -> Result<[f64; 3]> {
    let Some(entry) = head.entry("scale") else { return Ok([1.0; 3]) };
    let numbers = entry.words.iter().map(|(_, word)| word.parse::<f64>().ok());
    let numbers: Option<Vec<f64>> = numbers.map(|number| number.filter(|n| *n > 0.0 && n.is_finite())).collect();
    match numbers.as_deref() {
        Some([all]) => Ok([*all; 3]),
        Some([r, g, b]) => Ok([*r, *g, *b]),
        _ => Err(head.mismatch(entry, "one or three numbers above 0")),
    }
}

fn read_floats(source: &Source, start: usize, count: usize) -> Result<Vec<f32>> {
    let body = &source.bytes[start..];
    if body.len() != 4 * count {
        let message = format!("{count} values of 4 bytes must follow the head, found {} bytes", body.len());
        return Err(SceneError::bad(Location::file(source.file), message));
    }
    let numbers: Vec<f32> = body.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect();
    match numbers.iter().position(|number| !number.is_finite()) {
        Some(index) => {
            let message = format!("value {index} of the table is no finite number");
            Err(SceneError::bad(Location::file(source.file), message))
        }
        None => Ok(numbers),
    }
}

fn read_text(source: &Source, start: usize, count: usize) -> Result<Vec<f32>> {
    let text = std::str::from_utf8(&source.bytes[start..])
        .map_err(|error| source.bad(start + error.valid_up_to(), "the numbers are not text"))?;
    let mut numbers = Vec::with_capacity(count);
    for (offset, word) in words(text, start) {
        if numbers.len() == count {
            return Err(source.bad(offset, format!("the table has {count} values, and here is one more")));
        }
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => return Err(source.bad(offset, format!("expected a number, found {word:?}"))),
        }
    }
    if numbers.len() < count {
        let message = format!("the table has {count} values, the file ends after {}", numbers.len());
        return Err(source.bad(source.bytes.len(), message));
    }
    Ok(numbers)
}

/// Turns pictures whose azimuths count from the surface's tangent so that they count from the light's.
fn count_from_the_light(head: &Head, table: &mut DirectionalTable) -> Result<()> {
    let lights = table.light_azimuths * table.fold;
    if !table.view_azimuths.is_multiple_of(lights) {
        let message = format!(
            "with view_phi_from surface, \"view_phi\" must be a multiple of light_phi times symmetry, {lights}; found {}",
            table.view_azimuths
        );
        return Err(head.source.bad(head.required("view_phi")?.offset, message));
    }
    let step = (table.view_azimuths / lights) as usize;
    let row = 3 * table.view_azimuths as usize;
    let slice = row * table.view_angles.len();
    for (light, values) in table.values.chunks_exact_mut(slice).enumerate() {
        let azimuth = light % table.light_azimuths as usize;
        values.chunks_exact_mut(row).for_each(|row| row.rotate_left(3 * step * azimuth));
    }
    Ok(())
}

/// Gives directions that were not measured (below 0) the value of the nearest azimuth that was, or 0.
fn fill(table: &mut DirectionalTable) {
    let azimuths = table.view_azimuths as usize;
    for row in table.values.chunks_exact_mut(3 * azimuths) {
        if row.iter().all(|value| *value >= 0.0) {
            continue;
        }
        let measured = row.to_vec();
        for (index, value) in row.iter_mut().enumerate().filter(|(_, value)| **value < 0.0) {
            let (azimuth, channel) = (index / 3, index % 3);
            let at = |shift: usize| measured[3 * ((azimuth + shift) % azimuths) + channel];
            let found = (1..=azimuths / 2).flat_map(|shift| [at(shift), at(azimuths - shift)]).find(|v| *v >= 0.0);
            *value = found.unwrap_or(0.0);
        }
    }
}
