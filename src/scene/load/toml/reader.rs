//! One way to read a key: by name, with the type and range that `keys` gives it.

use super::document::{Document, Entry, Node, Place, Value};
use super::keys::{Kind, LARGEST, Range, SYNONYMS, Section, list};
use crate::scene::{Rgb, SceneError};
use glam::Vec3;

pub type Result<T> = std::result::Result<T, SceneError>;

/// One table of the document, all of whose keys are known.
#[derive(Clone, Copy, Debug)]
pub struct Reader<'a> {
    pub document: &'a Document,
    pub place: Place,
    section: &'static Section,
    entries: &'a [Entry],
    /// Whether keys were written that the section does not have.
    has_unknown: bool,
}

impl<'a> Reader<'a> {
    /// Opens a table; a key that `section` does not list is a fault.
    pub fn open(document: &'a Document, node: &'a Node, section: &'static Section) -> Result<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("{} must be a table, found {}", section.noun, node.found());
            return Err(document.bad(node.place, message));
        };
        let unknown = table.entries.iter().filter(|entry| section.key(&entry.key).is_none());
        let faults =
            unknown.map(|entry| document.note(document.bad(entry.key_place, unknown_key(&entry.key, section))));
        let has_unknown = faults.count() > 0;
        Ok(Self { document, place: node.place, section, entries: &table.entries, has_unknown })
    }

    /// `Document::attempt` for this table: where it has unknown keys, what is missing may be what they were meant to be.
    pub fn attempt<T>(&self, read: impl FnOnce() -> Result<T>) -> Option<T> {
        if self.has_unknown { read().ok() } else { self.document.attempt(read) }
    }

    /// The value of `key`, if it was written.
    pub fn node(&self, key: &str) -> Option<&'a Node> {
        debug_assert!(self.section.key(key).is_some(), "{key} is not in the table of {}", self.section.name);
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    pub fn has(&self, key: &str) -> bool {
        self.node(key).is_some()
    }

    /// An error at the value of `key`, or at the table where it was not written.
    pub fn bad(&self, key: &str, message: impl Into<String>) -> SceneError {
        self.document.bad(self.node(key).map_or(self.place, |node| node.place), message)
    }

    /// The error for a value of the wrong type or out of range.
    pub fn mismatch(&self, key: &str, node: &Node) -> SceneError {
        let allowed = self.section.key(key).map(|key| key.kind.describe()).unwrap_or_default();
        let found = no_number(node).unwrap_or_else(|| node.found());
        self.document.bad(node.place, format!("{key:?} must be {allowed}, found {found}"))
    }

    /// `value`, or the error that `key` is missing or, if it was written, what is wrong with it.
    pub fn required<T>(&self, key: &str, value: Option<T>) -> Result<T> {
        let missing = || self.document.bad(self.place, format!("{} needs the key {key:?}", self.section.noun));
        let wrong = || self.has(key).then(|| self.document.last_fault()).flatten();
        value.ok_or_else(|| wrong().unwrap_or_else(missing))
    }

    /// Refuses two keys that say the same.
    pub fn exclusive(&self, key: &str, other: &str) -> Result<()> {
        if self.has(key) && self.has(other) {
            return Err(self.bad(other, format!("{key:?} and {other:?} exclude each other")));
        }
        Ok(())
    }

    /// A warning for each key that has no meaning while the section's switch, such as `model`, has this value.
    pub fn warn_unused(&self, switch: &str, value: &str, warnings: &mut Vec<String>) {
        for entry in self.entries {
            let only = self.section.key(&entry.key).map_or(&[][..], |key| key.only);
            if !only.is_empty() && !only.contains(&value) {
                let location = self.document.location(entry.key_place);
                let (key, allowed) = (&entry.key, list(only));
                warnings
                    .push(format!("{location}: {key:?} has no effect with {switch} = {value:?}, only with {allowed}"));
            }
        }
    }

    pub fn boolean(&self, key: &str) -> Result<Option<bool>> {
        self.read(key, |kind, node| match (kind, &node.value) {
            (Kind::Boolean, Value::Boolean(flag)) => Some(*flag),
            _ => None,
        })
    }

    pub fn integer(&self, key: &str) -> Result<Option<u32>> {
        self.read(key, |kind, node| match (kind, &node.value) {
            (Kind::Integer { min, max }, Value::Integer(number)) if (min..=max).contains(number) => {
                u32::try_from(*number).ok()
            }
            _ => None,
        })
    }

    /// A number in double precision.
    pub fn number(&self, key: &str) -> Result<Option<f64>> {
        self.read(key, |kind, node| match kind {
            Kind::Number(range) => in_range(node, range),
            _ => None,
        })
    }

    /// A number rounded to single precision.
    pub fn float(&self, key: &str) -> Result<Option<f32>> {
        Ok(self.number(key)?.map(|number| number as f32))
    }

    pub fn text(&self, key: &str) -> Result<Option<&'a str>> {
        self.read(key, |kind, node| match (kind, &node.value) {
            (Kind::Text, Value::String(text)) if !text.is_empty() => Some(text.as_str()),
            _ => None,
        })
    }

    /// One of the words of the key, with its meaning; `meanings` follows the order of the table.
    pub fn choice<T: Copy>(&self, key: &str, meanings: &[(&str, T)]) -> Result<Option<T>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let names: Vec<&str> = meanings.iter().map(|(name, _)| *name).collect();
        debug_assert!(
            matches!(self.section.key(key).map(|key| key.kind), Some(Kind::Choice(words)) if words == names),
            "{key}: the words differ from the table's: {names:?}"
        );
        let fault = match &node.value {
            Value::String(text) => match meanings.iter().find(|(name, _)| name == text) {
                Some((_, meaning)) => return Ok(Some(*meaning)),
                None => self.document.bad(node.place, unknown_word(key, text, &names)),
            },
            _ => self.mismatch(key, node),
        };
        self.document.note(fault);
        Ok(None)
    }

    /// The word of a key that `choice` has accepted.
    pub fn text_of_choice(&self, key: &str) -> &'a str {
        match self.node(key).map(|node| &node.value) {
            Some(Value::String(text)) => text,
            _ => "",
        }
    }

    pub fn color(&self, key: &str) -> Result<Option<Rgb>> {
        self.read(key, |kind, node| match kind {
            Kind::Color(range) => super::color::color(node, range),
            _ => None,
        })
    }

    pub fn vector(&self, key: &str) -> Result<Option<Vec3>> {
        self.read(key, |kind, node| match kind {
            Kind::Vector => numbers::<3>(node, Range::ANY).map(|v| Vec3::from_array(v.map(|x| x as f32))),
            _ => None,
        })
    }

    /// A vector whose length is neither 0 nor lost in rounding, made unit.
    pub fn direction(&self, key: &str) -> Result<Option<Vec3>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let vector = numbers::<3>(node, Range::ANY).ok_or_else(|| self.mismatch(key, node))?;
        match unit(vector) {
            Some(unit) => Ok(Some(unit)),
            None => Err(self.bad(key, format!("{key:?} is a direction and must not have length 0"))),
        }
    }

    /// Exactly N numbers, each in `range`.
    pub fn numbers<const N: usize>(&self, key: &str, range: Range) -> Result<Option<[f64; N]>> {
        self.read(key, |_, node| numbers(node, range))
    }

    /// One number for all or one for each of N.
    pub fn number_or_numbers<const N: usize>(&self, key: &str, range: Range) -> Result<Option<[f64; N]>> {
        self.read(key, |_, node| in_range(node, range).map(|number| [number; N]).or_else(|| numbers(node, range)))
    }

    pub fn array(&self, key: &str) -> Result<Option<&'a [Node]>> {
        self.read(key, |_, node| match &node.value {
            Value::Array(items) => Some(items.as_slice()),
            _ => None,
        })
    }

    /// The tables of `[[key]]`, opened.
    pub fn tables(&self, key: &str, section: &'static Section) -> Result<Vec<Reader<'a>>> {
        let Some(node) = self.node(key) else { return Ok(Vec::new()) };
        match &node.value {
            Value::Array(items) => items.iter().map(|item| Reader::open(self.document, item, section)).collect(),
            _ => Err(self.document.bad(
                node.place,
                format!("{key:?} is a list of tables, found {}: write [[{key}]] or {key} = [{{ … }}]", node.found()),
            )),
        }
    }

    /// The table of `key`, opened.
    pub fn table(&self, key: &str, section: &'static Section) -> Result<Option<Reader<'a>>> {
        self.node(key).map(|node| Reader::open(self.document, node, section)).transpose()
    }

    fn read<T>(&self, key: &str, convert: impl FnOnce(Kind, &'a Node) -> Option<T>) -> Result<Option<T>> {
        let Some(node) = self.node(key) else { return Ok(None) };
        let kind = self.section.key(key).map_or(Kind::Special(""), |key| key.kind);
        let value = convert(kind, node);
        if value.is_none() {
            self.document.note(self.mismatch(key, node));
        }
        Ok(value)
    }
}

/// The first number in `node` that no key takes, whatever its range.
fn no_number(node: &Node) -> Option<String> {
    match (&node.value, node.number()) {
        (Value::Array(items), _) => items.iter().find_map(no_number),
        (_, Some(number)) if number.is_nan() => Some("NaN, which is no number".to_owned()),
        (_, Some(number)) if number > LARGEST => Some(format!("{}; numbers are at most 1e12", node.found())),
        (_, Some(number)) if number < -LARGEST => Some(format!("{}; numbers are at least -1e12", node.found())),
        _ => None,
    }
}

/// A number in `range`.
pub fn in_range(node: &Node, range: Range) -> Option<f64> {
    node.number().filter(|number| range.contains(*number))
}

/// An array of exactly N numbers in `range`.
pub fn numbers<const N: usize>(node: &Node, range: Range) -> Option<[f64; N]> {
    let Value::Array(items) = &node.value else { return None };
    if items.len() != N {
        return None;
    }
    let mut numbers = [0.0; N];
    for (number, item) in numbers.iter_mut().zip(items) {
        *number = in_range(item, range)?;
    }
    Some(numbers)
}

/// `vector` at length 1; None where it has no direction. In double precision, correctly rounded square root.
pub fn unit(vector: [f64; 3]) -> Option<Vec3> {
    let [x, y, z] = vector;
    let length = libm::sqrt(x * x + y * y + z * z);
    (length > 1.0e-12).then(|| Vec3::new((x / length) as f32, (y / length) as f32, (z / length) as f32))
}

fn unknown_key(key: &str, section: &Section) -> String {
    let names = section.keys.iter().map(|key| key.name);
    let synonyms = SYNONYMS.iter().filter(|(_, ours)| section.key(ours).is_some());
    // A word of another program counts if it is exactly that, or if nothing of ours looks alike.
    let exact = synonyms.clone().find(|(word, _)| word.eq_ignore_ascii_case(key)).map(|(_, ours)| *ours);
    let translated = |word| synonyms.clone().find(|(theirs, _)| *theirs == word).map(|(_, ours)| *ours);
    let suggestion = exact
        .or_else(|| nearest(key, names.clone()))
        .or_else(|| nearest(key, synonyms.clone().map(|(word, _)| *word)).and_then(translated));
    match suggestion {
        Some(nearest) => format!("unknown key {key:?}; did you mean {nearest:?}?"),
        None => format!("unknown key {key:?}; {} has {}", section.noun, list(&names.collect::<Vec<_>>())),
    }
}

/// The message for a word that is none of `names`.
pub fn unknown_word(key: &str, word: &str, names: &[&str]) -> String {
    let hint = nearest(word, names.iter().copied()).map_or(String::new(), |name| format!("; did you mean {name:?}?"));
    format!("{key:?} must be {}, found {word:?}{hint}", list(names))
}

/// The name that looks most like `word`, if one does.
pub fn nearest<'n>(word: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let lower = word.to_lowercase();
    names
        .map(|name| (strsim::jaro_winkler(&lower, &name.to_lowercase()), name))
        // Below 0.8 Jaro-Winkler finds likeness in words that share no more than a letter.
        .filter(|(likeness, _)| *likeness >= 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}
