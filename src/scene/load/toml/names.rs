//! Names of materials, objects and lights: unique, and found again.

use super::reader::{Reader, Result, nearest};
use crate::scene::Location;
use std::collections::HashMap;

/// The names of one kind of thing and where each was given.
#[derive(Debug)]
pub struct Names {
    kind: &'static str,
    indices: HashMap<String, (usize, Location)>,
}

impl Names {
    pub fn new(kind: &'static str) -> Self {
        Self { kind, indices: HashMap::new() }
    }

    /// Takes the next index for `name`, which the key `name` of `table` gives; a name already taken is an error.
    pub fn declare(&mut self, table: &Reader, name: &str) -> Result<String> {
        if let Some((_, first)) = self.indices.get(name) {
            let line = if first.line > 0 { format!(" in line {}", first.line) } else { String::new() };
            return Err(table.bad("name", format!("the {} name {name:?} is already given{line}", self.kind)));
        }
        let place = table.node("name").map_or(table.place, |node| node.place);
        self.indices.insert(name.to_owned(), (self.indices.len(), table.document.location(place)));
        Ok(name.to_owned())
    }

    /// The index of a name, if there is such a one.
    pub fn get(&self, name: &str) -> Option<usize> {
        self.indices.get(name).map(|(index, _)| *index)
    }

    /// The index of the name that `key` of `table` refers to.
    pub fn find(&self, table: &Reader, key: &str, name: &str) -> Result<usize> {
        if let Some(index) = self.get(name) {
            return Ok(index);
        }
        let mut known: Vec<&str> = self.indices.keys().map(String::as_str).collect();
        // Hash order is not the same in each run; messages are.
        known.sort_unstable();
        let hint = nearest(name, known.into_iter()).map_or(String::new(), |name| format!("; did you mean {name:?}?"));
        Err(table.bad(key, format!("there is no {} named {name:?}{hint}", self.kind)))
    }
}
