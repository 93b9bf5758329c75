//! Measured tables that materials name.

use super::reader::{Reader, Result};
use super::texture::{beside, refer};
use crate::scene::load::measured::read_table;
use crate::scene::{Table, TableId};
use std::path::PathBuf;

/// The scene's tables; a file is read once however many materials show it.
#[derive(Debug, Default)]
pub struct Tables {
    pub list: Vec<Table>,
    files: Vec<PathBuf>,
}

impl Tables {
    /// The table that `file` of a material names.
    pub fn read(&mut self, table: &Reader) -> Result<TableId> {
        let file = beside(table.document, table.required("file", table.text("file")?)?);
        if let Some(index) = self.files.iter().position(|known| *known == file) {
            return Ok(TableId(index as u32));
        }
        self.list.push(read_table(&file).map_err(|error| refer(table, "file", error))?);
        self.files.push(file);
        Ok(TableId(self.list.len() as u32 - 1))
    }
}
