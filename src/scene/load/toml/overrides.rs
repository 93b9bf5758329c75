//! `--set key.path=value`: changes to a document before it is interpreted.

use super::document::{Document, Entry, Node, Place, Table, Value, parse_value};
use super::reader::{Result, nearest};
use std::str::FromStr;

/// One change, as typed on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    /// The keys from the document's root to the value; an index or a name where the document has a list.
    pub path: Vec<String>,
    pub value: String,
}

impl FromStr for Override {
    type Err = String;

    /// `key.path=value`. A name with a dot in it is written in quotes: `material."a.b".color=red`.
    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let (mut path, mut segment, mut quote) = (Vec::new(), String::new(), None);
        for (offset, character) in text.char_indices() {
            match (quote, character) {
                (Some(open), _) if character == open => quote = None,
                (Some(_), _) => segment.push(character),
                (None, '"' | '\'') => quote = Some(character),
                (None, '.') => path.push(std::mem::take(&mut segment)),
                (None, '=') => {
                    path.push(segment);
                    let path: Vec<String> = path.iter().map(|segment| segment.trim().to_owned()).collect();
                    if path.iter().any(String::is_empty) {
                        return Err(format!("{text:?} has an empty key; expected key.path=value"));
                    }
                    return Ok(Self { path, value: text[offset + 1..].trim().to_owned() });
                }
                (None, _) => segment.push(character),
            }
        }
        Err(format!("{text:?} has no \"=\"; expected key.path=value, such as render.samples=64"))
    }
}

impl std::fmt::Display for Override {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.path.join("."), self.value)
    }
}

impl Document {
    /// Applies the changes in order.
    pub fn apply(&mut self, overrides: &[Override]) -> Result<()> {
        for change in overrides {
            let place = Place::Override(self.overrides.len());
            self.overrides.push(change.to_string());
            self.change(change, place)?;
        }
        Ok(())
    }

    /// Applies one change that was written at `place`.
    pub fn change(&mut self, change: &Override, place: Place) -> Result<()> {
        let value = parse_value(&change.value, place);
        let outcome = value.and_then(|value| set(&mut self.root, &change.path, value, place));
        outcome.map_err(|message| self.bad(place, message))
    }
}

/// Puts `value` at `path` below `node`; tables on the way are made where there are none.
fn set(node: &mut Node, path: &[String], value: Node, place: Place) -> std::result::Result<(), String> {
    let Some((first, rest)) = path.split_first() else {
        *node = value;
        return Ok(());
    };
    match &mut node.value {
        Value::Table(table) => {
            if table.get(first).is_none() {
                if LISTS.contains(&first.as_str()) && !rest.is_empty() {
                    return Err(format!("the scene has no [[{first}]]"));
                }
                let empty = Node { value: Value::Table(Table::default()), place };
                table.entries.push(Entry { key: first.clone(), key_place: place, node: empty });
            }
            match table.get_mut(first) {
                Some(entry) => set(&mut entry.node, rest, value, place),
                None => Err(format!("there is no {first:?}")),
            }
        }
        Value::Array(items) => set(find(items, first)?, rest, value, place),
        _ => Err(format!("{first:?} is no part of {}, which is neither a table nor a list", node.found())),
    }
}

/// The keys of the root that are lists of tables: a change does not add to them.
const LISTS: &[&str] = &["material", "object", "light", "panel"];

/// The item with this index, or the table with this name.
fn find<'n>(items: &'n mut [Node], segment: &str) -> std::result::Result<&'n mut Node, String> {
    let count = items.len();
    let name = |item: &Node| match &item.value {
        Value::Table(table) => match table.get("name").map(|entry| &entry.node.value) {
            Some(Value::String(name)) => Some(name.clone()),
            _ => None,
        },
        _ => None,
    };
    let names: Vec<Option<String>> = items.iter().map(name).collect();
    let named = names.iter().position(|name| name.as_deref() == Some(segment));
    match named.or_else(|| segment.parse::<usize>().ok()) {
        Some(index) if index < count => Ok(&mut items[index]),
        Some(index) => Err(format!("there is no item {index}: the list has {count}, counted from 0")),
        None => {
            let hint = nearest(segment, names.iter().flatten().map(String::as_str));
            let hint = hint.map_or(String::new(), |name| format!("; did you mean {name:?}?"));
            Err(format!("there is no item named {segment:?} in a list of {count}{hint}"))
        }
    }
}
