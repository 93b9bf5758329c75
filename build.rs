//! Writes the layout of what crosses the bus for shaders, compiles every kernel, proves it strict and embeds it.
//!
//! `src/layout/*.rs` declare the layout; `OUT_DIR/layout/*.glsl` and `OUT_DIR/layout.rs` follow from them.
//! `shaders/kernels/*.comp` and `shaders/kernels/parity/*.comp` are each compiled twice: for storage buffers, and with
//! `FETCH_TEXEL` for uniform texel buffers. The table goes to `OUT_DIR/kernels.rs`, which `src/shaders.rs` includes.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

#[path = "shaders/build/blocks.rs"]
mod blocks;
#[path = "shaders/build/compile.rs"]
mod compile;
#[path = "shaders/build/emit.rs"]
mod emit;
#[path = "shaders/build/host.rs"]
mod host;
#[path = "shaders/build/schema.rs"]
mod schema;
#[path = "shaders/build/strict.rs"]
mod strict;

/// Folders with entry points, below `shaders/`, and the prefix of their kernels' names.
const FOLDERS: [(&str, &str); 2] = [("kernels", ""), ("kernels/parity", "parity/")];

fn main() {
    println!("cargo::rerun-if-changed=shaders");
    println!("cargo::rerun-if-changed=src/layout");
    println!("cargo::rerun-if-changed=src/shading/closure.rs");
    if let Err(errors) = write_layout().and_then(|()| embed_kernels()) {
        for line in errors {
            println!("cargo::error={line}");
        }
    }
}

/// Writes the layout's other side.
fn write_layout() -> Result<(), BTreeSet<String>> {
    let one = |message: String| BTreeSet::from([message]);
    let (root, out) = folders();
    let schema = schema::Schema::read(&root.join("src/layout"), &root.join("src/shading/closure.rs")).map_err(one)?;
    fs::create_dir_all(out.join("layout")).map_err(|e| one(e.to_string()))?;
    for (name, text) in emit::files(&schema).map_err(one)? {
        fs::write(out.join(name), text).map_err(|e| one(format!("{name}: {e}")))?;
    }
    Ok(())
}

/// The repository's, and that of what the build writes.
fn folders() -> (PathBuf, PathBuf) {
    let folder = |name| PathBuf::from(env::var_os(name).expect("cargo sets it"));
    (folder("CARGO_MANIFEST_DIR"), folder("OUT_DIR"))
}

/// Writes the table; the error is one message a line, without repetition.
fn embed_kernels() -> Result<(), BTreeSet<String>> {
    let one = |e: io::Error| BTreeSet::from([e.to_string()]);
    let (root, out) = folders();
    let shaders = root.join("shaders");
    let sources = find_kernels(&shaders).map_err(one)?;

    let mut errors = BTreeSet::new();
    let mut table = String::from("static KERNELS: &[Kernel] = &[\n");
    for (name, file) in &sources {
        match (build(file, &shaders, &out, &[]), build(file, &shaders, &out, &["FETCH_TEXEL"])) {
            (Ok(storage), Ok(texel)) => {
                let stem = name.replace('/', "_");
                let storage_file = out.join(format!("{stem}.storage.spv"));
                let texel_file = out.join(format!("{stem}.texel.spv"));
                write_words(&storage_file, &storage).map_err(one)?;
                // A kernel that fetches nothing is the same twice: embed it once.
                let same = storage == texel;
                write_words(&texel_file, &texel).map_err(one)?;
                let texel_file = if same { &storage_file } else { &texel_file };
                writeln!(
                    table,
                    "Kernel {{ name: {name:?}, storage: words!({storage_file:?}), texel: words!({texel_file:?}) }},"
                )
                .expect("a String takes everything");
            }
            (storage, texel) => {
                errors.extend([storage, texel].into_iter().filter_map(Result::err).flatten());
            }
        }
    }
    table.push_str("];\n");
    if !errors.is_empty() {
        return Err(errors);
    }
    fs::write(out.join("kernels.rs"), table).map_err(one)
}

/// Name and path of every entry point, sorted by name.
fn find_kernels(shaders: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    let mut found = Vec::new();
    for (folder, prefix) in FOLDERS {
        let Ok(entries) = fs::read_dir(shaders.join(folder)) else {
            continue;
        };
        for entry in entries {
            let path = entry?.path();
            if let (Some("comp"), Some(stem)) =
                (path.extension().and_then(|e| e.to_str()), path.file_stem().and_then(|s| s.to_str()))
            {
                found.push((format!("{prefix}{stem}"), path));
            }
        }
    }
    found.sort();
    Ok(found)
}

/// One variant of one kernel: compiled, proved strict, decorated, stripped.
fn build(file: &Path, shaders: &Path, out: &Path, defines: &[&str]) -> Result<Vec<u32>, Vec<String>> {
    let one = |message: String| message.lines().map(str::to_owned).collect::<Vec<_>>();
    let below = file.strip_prefix(shaders).unwrap_or(file);
    let name = format!("shaders/{}", below.display());
    let text = fs::read_to_string(file).map_err(|e| one(format!("{name}: {e}")))?;
    let words = compile::glsl_to_spirv(&text, &name, &[shaders, out], defines).map_err(one)?;
    let mut module = strict::load(&words).map_err(|e| one(format!("{name}: {e}")))?;
    let violations = strict::check(&module);
    if !violations.is_empty() {
        return Err(violations.iter().map(|v| format!("{v} ({name})")).collect());
    }
    strict::decorate(&mut module);
    strict::strip_lines(&mut module);
    Ok(strict::assemble(&module))
}

fn write_words(path: &Path, words: &[u32]) -> io::Result<()> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    fs::write(path, bytes)
}
