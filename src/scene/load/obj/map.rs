//! `map_Kd` and its like: a picture and how it lies on the surface.

use super::statement::{Statement, unquoted};
use crate::scene::load::image::{ColorSpace, srgb_to_linear};
use crate::scene::load::texture_files::{TextureFiles, beside};
use crate::scene::{Channel, SceneError, Texture, TextureData, Wrap};
use std::path::PathBuf;
use std::sync::Arc;

/// A texture statement, as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    file: PathBuf,
    /// Where it was asked for, for warnings.
    place: String,
    scale: [f32; 2],
    offset: [f32; 2],
    wrap: Wrap,
    /// `-mm`: a texel t counts as base + gain t.
    base: f32,
    gain: f32,
    /// `-bm`, of bump maps.
    pub strength: f32,
    /// `-imfchan`.
    pub channel: Option<Channel>,
}

/// Options, and how many words belong to each at most: numbers, which may be fewer, or else that many words of any kind.
const OPTIONS: &[(&str, usize, bool)] = &[
    ("-s", 3, true),
    ("-o", 3, true),
    ("-t", 3, true),
    ("-mm", 2, true),
    ("-bm", 1, true),
    ("-boost", 1, true),
    ("-texres", 2, true),
    ("-blendu", 1, false),
    ("-blendv", 1, false),
    ("-clamp", 1, false),
    ("-cc", 1, false),
    ("-imfchan", 1, false),
    ("-type", 1, false),
];

impl Map {
    pub fn read(statement: &Statement) -> Result<Self, SceneError> {
        let mut map = Self {
            file: PathBuf::new(),
            place: statement.location().to_string(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            wrap: Wrap::Repeat,
            base: 0.0,
            gain: 1.0,
            strength: 1.0,
            channel: None,
        };
        let text = statement.rest();
        let mut rest = text.as_ref();
        let mut name = String::new();
        while !rest.is_empty() {
            let (word, after) = split_word(rest);
            let option = OPTIONS.iter().find(|(option, ..)| word.eq_ignore_ascii_case(option));
            let Some((option, count, are_numbers)) = option else {
                // A name may have spaces; what lies between its words is part of it.
                let length = rest.len() - after.len();
                name.push_str(&rest[..length]);
                rest = after;
                continue;
            };
            rest = after;
            let mut values = Vec::new();
            while values.len() < *count {
                let (word, after) = split_word(rest);
                let is_name = name.is_empty() && after.is_empty();
                if word.is_empty() || is_name || (*are_numbers && word.parse::<f32>().is_err()) {
                    break;
                }
                values.push(word);
                rest = after;
            }
            map.apply(statement, option, &values)?;
        }
        let name = unquoted(name.trim());
        if name.is_empty() {
            let keyword = String::from_utf8_lossy(statement.keyword()).into_owned();
            return Err(statement.bad(format!("{keyword:?} needs a file name")));
        }
        map.file = beside(statement.folder(), name);
        Ok(map)
    }

    fn apply(&mut self, statement: &Statement, option: &str, values: &[&str]) -> Result<(), SceneError> {
        let mut numbers = [0.0f32; 3];
        let are_numbers = OPTIONS.iter().any(|(name, _, are_numbers)| *name == option && *are_numbers);
        for (number, word) in numbers.iter_mut().zip(values).filter(|_| are_numbers) {
            *number = statement.number(word.as_bytes())?;
        }
        let [first, second, _] = numbers;
        match (option, values.len()) {
            ("-s", count) => self.scale[..count.min(2)].copy_from_slice(&numbers[..count.min(2)]),
            ("-o", count) => self.offset[..count.min(2)].copy_from_slice(&numbers[..count.min(2)]),
            ("-mm", 1) => self.base = first,
            ("-mm", 2) => (self.base, self.gain) = (first, second),
            ("-bm", 1) => self.strength = first,
            ("-clamp", 1) if values[0].eq_ignore_ascii_case("on") => self.wrap = Wrap::Clamp,
            ("-imfchan", 1) => {
                self.channel = match values[0].to_ascii_lowercase().as_str() {
                    // Luminance and depth of a grey picture are any of its channels.
                    "r" | "l" | "z" => Some(Channel::R),
                    "g" => Some(Channel::G),
                    "b" => Some(Channel::B),
                    "m" => Some(Channel::A),
                    _ => None,
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The picture as this map lays it; None, with a warning, where it cannot be read.
    pub fn load(&self, space: ColorSpace, files: &mut TextureFiles, warnings: &mut Vec<String>) -> Option<Texture> {
        let texture = match files.load(&self.file, space) {
            Ok(texture) => texture,
            Err(error) => {
                warnings.push(format!("{}: no texture: {error}", self.place));
                return None;
            }
        };
        let data = match (self.base, self.gain) {
            (0.0, 1.0) => texture.data,
            (base, gain) => change(&texture.data, |[r, g, b, a]| {
                let value = |v: f32| (base + gain * v).max(0.0);
                [value(r), value(g), value(b), a]
            }),
        };
        Some(Texture { data, wrap_u: self.wrap, wrap_v: self.wrap, scale: self.scale, offset: self.offset, ..texture })
    }
}

/// All texels changed by `by`, which gets and gives linear RGBA.
pub fn change(data: &TextureData, by: impl Fn([f32; 4]) -> [f32; 4]) -> TextureData {
    let texels: Vec<[f32; 4]> = match data {
        TextureData::Srgb8(texels) => {
            let table: Vec<f32> = (0..256).map(|code| srgb_to_linear(f64::from(code) / 255.0) as f32).collect();
            let linear = |code: u8| table[usize::from(code)];
            texels.iter().map(|[r, g, b, a]| by([linear(*r), linear(*g), linear(*b), f32::from(*a) / 255.0])).collect()
        }
        TextureData::Linear8(texels) => texels.iter().map(|t| by(t.map(|code| f32::from(code) / 255.0))).collect(),
        TextureData::Float(texels) => texels.iter().map(|t| by(*t)).collect(),
        TextureData::Pattern(pattern) => return TextureData::Pattern(*pattern),
    };
    TextureData::Float(Arc::new(texels))
}

/// The first word, in quotation marks or not, and what follows it.
fn split_word(text: &str) -> (&str, &str) {
    let quoted = text.strip_prefix('"').and_then(|inner| inner.find('"')).map(|end| end + 2);
    let end = quoted.or_else(|| text.find(char::is_whitespace)).unwrap_or(text.len());
    let (word, rest) = text.split_at(end);
    (word, rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::obj::statement::Statements;
    use crate::scene::load::stream::Stream;
    use std::path::Path;

    fn map(text: &str) -> Map {
        let mut statements = Statements::of(Path::new("f/a.mtl"), Stream::of(text.as_bytes())).unwrap();
        Map { place: String::new(), ..Map::read(&statements.next().unwrap().unwrap()).unwrap() }
    }

    #[test]
    fn options_stand_before_or_after_a_name_of_any_form() {
        let plain = map("map_Kd t.png");
        assert_eq!(plain.file, Path::new("f/t.png"));
        for text in ["map_Kd \"t.png\"", "MAP_KD -texres 256 t.png", "map_Kd -t 0 t.png", "map_Kd t.png -type sphere"] {
            assert_eq!(map(text), plain, "{text}");
        }
        let laid = Map { scale: [2.0, 3.0], offset: [0.5, 0.0], wrap: Wrap::Clamp, ..plain.clone() };
        for text in [
            "map_Kd -s 2 3 1 -o 0.5 -clamp on t.png",
            "map_Kd t.png -s 2 3 -o .5 -clamp on",
            "map_Kd -S 2 3 1 t.png -o 0.5 0 0 -CLAMP ON",
        ] {
            assert_eq!(map(text), laid, "{text}");
        }
        assert_eq!(map("map_Kd a b/my  tex.png").file, Path::new("f/a b/my  tex.png"));
        assert_eq!(map("map_Kd -s 1 1 1 \"a b.png\" -bm 2").file, Path::new("f/a b.png"));
        assert_eq!(map("map_Kd -o 1 2 3").file, Path::new("f/3"), "a name may be a number");
        assert_eq!(map("map_Kd -bm t.png").file, Path::new("f/t.png"), "a number that is missing takes no name");
        assert_eq!(map("map_Kd -x.png").file, Path::new("f/-x.png"), "a name may begin with a dash");
        assert_eq!(map("map_Kd a\\b.png").file, Path::new("f/a/b.png"));
        let toned = map("map_Kd -mm 0.25 0.5 -imfchan m t.png -bm 0.7");
        assert_eq!((toned.base, toned.gain, toned.strength), (0.25, 0.5, 0.7));
        assert_eq!(toned.channel, Some(Channel::A));
    }

    #[test]
    fn a_map_without_a_name_or_with_a_bad_number_is_refused() {
        for text in ["map_Kd", "map_Kd -s 1 2 1e30 t.png", "map_Kd \"\""] {
            let mut statements = Statements::of(Path::new("a.mtl"), Stream::of(text.as_bytes())).unwrap();
            let statement = statements.next().unwrap().unwrap();
            assert!(Map::read(&statement).unwrap_err().to_string().starts_with("a.mtl:1:"), "{text}");
        }
    }
}
