//! A TOML document as a tree whose every key and value knows its place.
//!
//! The `toml` crate parses; this tree adds what it lacks: places that survive overrides, and lookups that say what
//! was found.

use crate::scene::load::text::line_and_column;
use crate::scene::{Location, SceneError};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// Where a key or value was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Byte offset in the file.
    Text(usize),
    /// Index of the override.
    Override(usize),
}

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    pub value: Value,
    pub place: Place,
}

#[derive(Clone, Debug)]
pub enum Value {
    String(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Datetime,
    Array(Vec<Node>),
    Table(Table),
}

/// Entries in the order of their keys.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
pub struct Entry {
    pub key: String,
    pub key_place: Place,
    pub node: Node,
}

impl Table {
    pub fn get(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    pub fn get_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }
}

impl Node {
    /// What was found, for messages: the value itself where it is short.
    pub fn found(&self) -> String {
        match &self.value {
            Value::String(text) if text.chars().count() > 40 => "a long string".to_owned(),
            Value::String(text) => format!("the string {text:?}"),
            Value::Integer(number) => number.to_string(),
            Value::Float(number) => format!("{number:?}"),
            Value::Boolean(flag) => flag.to_string(),
            Value::Datetime => "a date".to_owned(),
            Value::Array(items) => format!("an array of {}", items.len()),
            Value::Table(_) => "a table".to_owned(),
        }
    }

    /// Any number as f64.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            Value::Integer(number) => Some(number as f64),
            Value::Float(number) => Some(number),
            _ => None,
        }
    }
}

/// A parsed file with the overrides that were applied to it.
#[derive(Debug)]
pub struct Document {
    pub file: PathBuf,
    pub text: String,
    /// As typed, for messages.
    pub overrides: Vec<String>,
    pub root: Node,
    /// What is wrong, as far as reading could go on all the same: all of it is told at once.
    faults: RefCell<Vec<SceneError>>,
}

impl Document {
    /// Parses `text`; `file` is its name in messages.
    pub fn parse(file: &Path, text: String) -> Result<Self, SceneError> {
        let parsed = DeTable::parse(&text).map_err(|error| {
            let (line, column) = line_and_column(&text, error.span().map_or(text.len(), |span| span.start));
            SceneError::bad(Location { file: file.to_owned(), line, column }, error.message().replace('\n', ", "))
        })?;
        let root = table_from(parsed.get_ref(), &Place::Text).map_err(|(offset, message)| {
            let (line, column) = line_and_column(&text, offset);
            SceneError::bad(Location { file: file.to_owned(), line, column }, message)
        })?;
        let root = Node { value: Value::Table(root), place: Place::Text(0) };
        Ok(Self { file: file.to_owned(), text, overrides: Vec::new(), root, faults: RefCell::default() })
    }

    /// A document that holds nothing yet: overrides alone will fill it.
    pub fn empty(file: &Path) -> Self {
        let root = Node { value: Value::Table(Table::default()), place: Place::Text(0) };
        Self { file: file.to_owned(), text: String::new(), overrides: Vec::new(), root, faults: RefCell::default() }
    }

    /// The place as `file:line:column`, or as the override that was typed.
    pub fn location(&self, place: Place) -> Location {
        match place {
            Place::Text(offset) => {
                let (line, column) = line_and_column(&self.text, offset);
                Location { file: self.file.clone(), line, column }
            }
            Place::Override(index) => Location::file(format!("--set {}", self.overrides[index])),
        }
    }

    pub fn bad(&self, place: Place, message: impl Into<String>) -> SceneError {
        SceneError::bad(self.location(place), message)
    }

    /// Keeps a fault to be told with the others; the caller goes on as if its key had not been written.
    pub fn note(&self, fault: SceneError) {
        self.faults.borrow_mut().push(fault);
    }

    pub fn is_faulty(&self) -> bool {
        !self.faults.borrow().is_empty()
    }

    /// The fault that was noted last, once more: told twice, it is shown once.
    pub fn last_fault(&self) -> Option<SceneError> {
        match self.faults.borrow().last() {
            Some(SceneError::Bad { location, message }) => Some(SceneError::bad(location.clone(), message)),
            _ => None,
        }
    }

    /// What `read` makes of a part of the document that others do not depend on. Its error is noted, unless faults were
    /// noted on the way: then it may be no more than their consequence.
    pub fn attempt<T>(&self, read: impl FnOnce() -> Result<T, SceneError>) -> Option<T> {
        let before = self.faults.borrow().len();
        read()
            .map_err(|error| {
                if self.faults.borrow().len() == before {
                    self.note(error)
                }
            })
            .ok()
    }

    /// What `read` makes of the document, or all that is wrong with it.
    pub fn judge<T>(&self, read: impl FnOnce() -> Result<T, SceneError>) -> Result<T, SceneError> {
        let read = read();
        let mut faults = self.faults.take();
        match read {
            Ok(value) if faults.is_empty() => return Ok(value),
            Ok(_) => {}
            Err(error) => faults.push(error),
        }
        Err(SceneError::all(faults))
    }
}

/// Parses the value of an override; every place in it is `place`. What is no TOML value is a string, so that
/// words need no quotes.
pub fn parse_value(text: &str, place: Place) -> Result<Node, String> {
    let bare = !text.starts_with(['[', '{', '"', '\'']);
    match DeValue::parse(text) {
        Ok(value) => value_from(value.get_ref(), &|_| place, 0)
            .map(|value| Node { value, place })
            .map_err(|(_, message)| message),
        Err(_) if bare => Ok(Node { value: Value::String(text.to_owned()), place }),
        Err(error) => Err(error.message().replace('\n', ", ")),
    }
}

/// Byte offset and message.
type ConvertError = (usize, String);

fn table_from(table: &DeTable<'_>, place: &dyn Fn(usize) -> Place) -> Result<Table, ConvertError> {
    let mut entries = Vec::new();
    for (key, node) in table.iter() {
        let span = node.span();
        entries.push(Entry {
            key: key.get_ref().to_string(),
            key_place: place(key.span().start),
            node: Node { value: value_from(node.get_ref(), place, span.start)?, place: place(span.start) },
        });
    }
    Ok(Table { entries })
}

fn value_from(value: &DeValue<'_>, place: &dyn Fn(usize) -> Place, offset: usize) -> Result<Value, ConvertError> {
    Ok(match value {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix())
            .map(Value::Integer)
            .map_err(|_| (offset, format!("the integer {number} does not fit in 64 bits")))?,
        DeValue::Float(number) => {
            number.as_str().parse().map(Value::Float).map_err(|_| (offset, format!("{number} is not a number")))?
        }
        DeValue::Boolean(flag) => Value::Boolean(*flag),
        DeValue::Datetime(_) => Value::Datetime,
        DeValue::Array(items) => Value::Array(
            items
                .iter()
                .map(|item| {
                    let start = item.span().start;
                    Ok(Node { value: value_from(item.get_ref(), place, start)?, place: place(start) })
                })
                .collect::<Result<_, ConvertError>>()?,
        ),
        DeValue::Table(table) => Value::Table(table_from(table, place)?),
    })
}
