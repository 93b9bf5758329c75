//! Files of measured reflection, told apart by how they begin.

use super::directional::{MAGIC, read_directional};
use super::merl::read_merl;
use super::text::read_bytes;
use crate::scene::{SceneError, Table};
use std::path::Path;
use std::sync::Arc;

/// The table in `file`: of gonio's own format, or of the MERL database.
pub fn read_table(file: &Path) -> Result<Table, SceneError> {
    let bytes = read_bytes(file)?;
    if bytes.starts_with(MAGIC) {
        return Ok(Table::Directional(Arc::new(read_directional(file, &bytes)?)));
    }
    Ok(Table::Merl { values: Arc::new(read_merl(file, &bytes)?) })
}
