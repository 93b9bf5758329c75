//! Writes what `src/layout` declares (`schema`) for the other side, and what follows from it for the host (`host`).
//!
//! * `layout/records.glsl`: constants and structs, for every shader.
//! * `layout/features.glsl`: specialisation constants that say what the scene uses, for shaders that ask.
//! * `layout/variant.glsl`: those that say what a kernel is compiled for, and the size of its workgroups.
//! * `layout/fetch.glsl`: `load_*` and `store_*`, for kernels that have defined `fetch_*` and `put_*`.
//! * `layout/proof.glsl`: every record and constant once, for the parity kernel of the layout.
//! * `layout/closure.glsl`, `layout/blocks.glsl`: the closure, and how it is unpacked from its model's block (`blocks`).
//! * `layout.rs`, `closure.rs`: the Rust side of `load_*`, the heap, the numbers of specialisation constants, and a list of all records.

use crate::schema::{Constant, Member, Record, Schema, Shape, Value};
use crate::{blocks, host};
use std::fmt::Write as _;

/// Bytes of the word in which kernels fetch.
pub const WORD: usize = 16;

/// Records that travel outside the scene's arrays: through `fetch_NAME`, and if they are stored through `put_NAME`.
const STREAMS: [(&str, &str, bool); 5] = [
    ("SceneHeader", "header", false),
    ("Batch", "batch", false),
    ("Hit", "hit", true),
    ("PathState", "path", true),
    ("ShadowRay", "shadow", true),
];

/// The specialisation constant that is the size of a workgroup.
const WORKGROUP: &str = "GROUP_SIZE";

/// What the doc comment of a member says whose word is only kept in scenes with a feature.
const KEPT_IF: &str = "Kept if `";

/// Every file that is written: name and text.
pub fn files(schema: &Schema) -> Result<Vec<(&'static str, String)>, String> {
    Ok(vec![
        ("layout/records.glsl", records(schema)),
        ("layout/features.glsl", guarded("FEATURES", &switches(schema, "Features"))),
        ("layout/variant.glsl", guarded("VARIANT", &switches(schema, "Variant"))),
        ("layout/fetch.glsl", fetch(schema)?),
        ("layout/proof.glsl", proof(schema)),
        ("layout/closure.glsl", blocks::closure(schema)),
        ("layout/blocks.glsl", blocks::unpack(schema)?),
        ("layout.rs", host::layout(schema)),
        ("closure.rs", blocks::rust(schema)?),
    ])
}

/// `PathState` is `path_state` where functions are named after it.
pub fn snake(name: &str) -> String {
    let mut result = String::new();
    for (at, letter) in name.char_indices() {
        if letter.is_uppercase() && at > 0 {
            result.push('_');
        }
        result.extend(letter.to_lowercase());
    }
    result
}

/// The prefix of a type whose lanes are floats, integers or booleans.
pub fn glsl_type(shape: &Shape) -> String {
    match shape {
        Shape::Lanes(1, true) => "float".into(),
        Shape::Lanes(1, false) => "uint".into(),
        Shape::Lanes(count, true) => format!("vec{count}"),
        Shape::Lanes(count, false) => format!("uvec{count}"),
        Shape::Bool => "bool".into(),
        Shape::Record(name) => name.clone(),
        Shape::Array(element, length) => format!("{}[{length}]", glsl_type(element)),
    }
}

/// `vec4 to_world[3]`.
pub fn declaration(member: &Member) -> String {
    match &member.shape {
        Shape::Array(element, length) => format!("{} {}[{length}]", glsl_type(element), member.name),
        shape => format!("{} {}", glsl_type(shape), member.name),
    }
}

pub fn comment(text: &mut String, indent: &str, doc: &[String]) {
    for line in doc {
        let _ = writeln!(text, "{}", format!("{indent}// {line}").trim_end());
    }
}

pub fn guarded(name: &str, body: &str) -> String {
    let guard = format!("LAYOUT_{name}_GLSL");
    format!(
        "// Written by the build from src/layout.\n#ifndef {guard}\n#define {guard}\n#extension GL_EXT_scalar_block_layout : require\n{body}\n#endif\n"
    )
}

fn value(constant: &Constant) -> String {
    match &constant.value {
        Value::Uint(number) => format!("const uint {} = {number}u;", constant.name),
        Value::Float(decimals) => format!("const float {} = {decimals};", constant.name),
    }
}

/// Bytes of a shape in scalar layout, which is Rust's for lanes of 32 bits.
fn bytes(schema: &Schema, shape: &Shape) -> usize {
    match shape {
        Shape::Lanes(count, _) => 4 * count,
        Shape::Bool => 4,
        Shape::Array(element, length) => length * bytes(schema, element),
        Shape::Record(name) => schema.record(name).map_or(0, |record| record_bytes(schema, record)),
    }
}

pub fn record_bytes(schema: &Schema, record: &Record) -> usize {
    record.members.iter().map(|member| bytes(schema, &member.shape)).sum()
}

/// `NODE_WORDS`: words of 16 bytes.
fn words_name(record: &str) -> String {
    format!("{}_WORDS", snake(record).to_uppercase())
}

/// Names of the records that are loaded by the word.
fn loaded(schema: &Schema) -> Vec<&str> {
    let of_arrays = schema.arrays.iter().filter_map(|array| match &array.element {
        Shape::Record(name) => Some(name.as_str()),
        _ => None,
    });
    of_arrays.chain(STREAMS.iter().map(|(name, ..)| *name)).collect()
}

fn records(schema: &Schema) -> String {
    let mut text = String::new();
    for constant in &schema.constants {
        comment(&mut text, "", &constant.doc);
        let _ = writeln!(text, "{}", value(constant));
    }
    for record in &schema.records {
        let _ = writeln!(text);
        comment(&mut text, "", &record.doc);
        let _ = writeln!(text, "struct {} {{", record.name);
        for member in &record.members {
            comment(&mut text, "    ", &member.doc);
            let _ = writeln!(text, "    {};", declaration(member));
        }
        let _ = writeln!(text, "}};");
    }
    let _ = writeln!(text);
    for name in loaded(schema) {
        let words = schema.record(name).map_or(0, |record| record_bytes(schema, record) / WORD);
        let _ = writeln!(text, "const uint {} = {words}u;", words_name(name));
    }
    guarded("RECORDS", &text)
}

/// The specialisation constants of `Features`, or of `Variant`.
fn switches(schema: &Schema, of: &str) -> String {
    let mut text = String::new();
    for (number, switch) in schema.switches.iter().enumerate().filter(|(_, switch)| switch.of == of) {
        comment(&mut text, "", &switch.member.doc);
        let default = match switch.member.shape {
            Shape::Bool => (switch.default != 0).to_string(),
            _ => format!("{}u", switch.default),
        };
        let (kind, name) = (glsl_type(&switch.member.shape), switch.member.name.to_uppercase());
        let _ = writeln!(text, "layout(constant_id = {number}) const {kind} {name} = {default};");
        // A set of bits is asked for one of them: `HAS_MODEL(n)`.
        if let Some((bit, name)) = mask(&switch.member) {
            let _ = writeln!(text, "#define HAS_{bit}(n) (({name} & (1u << (n))) != 0u)");
        }
        if name == WORKGROUP {
            let _ = writeln!(text, "layout(local_size_x_id = {number}, local_size_y = 1, local_size_z = 1) in;");
        }
    }
    text
}

/// Name of one bit and of the constant, of a member that says "Bit n".
fn mask(member: &Member) -> Option<(String, String)> {
    let is_mask = member.doc.first().is_some_and(|line| line.starts_with("Bit n"));
    is_mask.then(|| (singular(&member.name).to_uppercase(), member.name.to_uppercase()))
}

/// Part of a record that fits into lanes: its path (`ray.origin`, `to_world[1]`), first byte, lanes, whether floats.
pub struct Leaf {
    pub path: String,
    pub at: usize,
    pub lanes: usize,
    pub is_float: bool,
    /// The feature without which its word is not kept.
    kept_if: Option<String>,
}

/// Lists the leaves of a record; an error for what cannot be loaded by the word.
pub fn leaves(
    schema: &Schema,
    record: &Record,
    prefix: &str,
    mut at: usize,
    found: &mut Vec<Leaf>,
) -> Result<(), String> {
    for member in &record.members {
        let path = format!("{prefix}{}", member.name);
        let kept_if =
            member.doc.iter().find_map(|line| Some(line.split_once(KEPT_IF)?.1.split('`').next()?.to_owned()));
        let size = bytes(schema, &member.shape);
        match &member.shape {
            Shape::Lanes(lanes, is_float) => {
                found.push(Leaf { path, at, lanes: *lanes, is_float: *is_float, kept_if });
            }
            Shape::Record(name) => match schema.record(name) {
                Some(inner) => leaves(schema, inner, &format!("{path}."), at, found)?,
                None => return Err(format!("{path}: no record {name}")),
            },
            Shape::Array(element, length) => match **element {
                Shape::Lanes(lanes, is_float) => {
                    for index in 0..*length {
                        let path = format!("{path}[{index}]");
                        found.push(Leaf { path, at: at + 4 * lanes * index, lanes, is_float, kept_if: None });
                    }
                }
                _ => return Err(format!("{path}: arrays of records are not loaded by the word")),
            },
            Shape::Bool => return Err(format!("{path}: a record has no booleans")),
        }
        at += size;
    }
    Ok(())
}

/// The runs of lanes that `at..at + 4 * lanes` takes: word, first lane in it, how many.
pub fn runs(at: usize, lanes: usize) -> Vec<(usize, usize, usize)> {
    let mut found = Vec::new();
    let (mut lane, end) = (at / 4, at / 4 + lanes);
    while lane < end {
        let count = (4 - lane % 4).min(end - lane);
        found.push((lane / 4, lane % 4, count));
        lane += count;
    }
    found
}

/// `w2.xyz`, or `w2` for all four.
pub fn swizzle(name: &str, first: usize, count: usize) -> String {
    match count {
        4 => name.to_owned(),
        _ => format!("{name}.{}", &"xyzw"[first..first + count]),
    }
}

/// A leaf as an expression of the words `w0`, `w1` and so on.
pub fn leaf_value(leaf: &Leaf) -> String {
    let pieces: Vec<_> = runs(leaf.at, leaf.lanes)
        .into_iter()
        .map(|(word, first, count)| swizzle(&format!("w{word}"), first, count))
        .collect();
    let lanes = match &pieces[..] {
        [one] => one.clone(),
        several => format!("uvec{}({})", leaf.lanes, several.join(", ")),
    };
    if leaf.is_float { format!("uintBitsToFloat({lanes})") } else { lanes }
}

/// The feature on which a word depends: that of all its leaves, padding apart.
fn kept_if(leaves: &[Leaf], word: usize) -> Result<Option<&str>, String> {
    let inside = leaves.iter().filter(|leaf| runs(leaf.at, leaf.lanes).iter().any(|run| run.0 == word));
    let mut features = inside.filter(|leaf| !leaf.path.starts_with("pad")).map(|leaf| leaf.kept_if.as_deref());
    let first = features.next().flatten();
    match features.all(|other| other == first) {
        true => Ok(first),
        false => Err(format!("word {word} is kept by several rules")),
    }
}

/// `load_*` of a record whose words `fetch` gives from `base` on.
fn load(schema: &Schema, record: &Record, fetch: &str, base: &str) -> Result<String, String> {
    let (name, words) = (&record.name, record_bytes(schema, record) / WORD);
    if !record_bytes(schema, record).is_multiple_of(WORD) {
        return Err(format!("{name} is not a whole number of {WORD}-byte words"));
    }
    let mut parts = Vec::new();
    leaves(schema, record, "", 0, &mut parts)?;
    let mut text = format!("{name} load_{}(uint index) {{\n    uint at = {base};\n    {name} r;\n", snake(name));
    for word in 0..words {
        let at = if word == 0 { "at".to_owned() } else { format!("at + {word}u") };
        match kept_if(&parts, word).map_err(|e| format!("{name}: {e}"))? {
            None => writeln!(text, "    uvec4 w{word} = {fetch}({at});"),
            Some(feature) => writeln!(
                text,
                "    uvec4 w{word} = uvec4(0u);\n    if ({}) w{word} = {fetch}({at});",
                feature.to_uppercase()
            ),
        }
        .map_err(|e| e.to_string())?;
        let ends_here = |leaf: &&Leaf| (leaf.at + 4 * leaf.lanes - 1) / WORD == word;
        for leaf in parts.iter().filter(ends_here) {
            let _ = writeln!(text, "    r.{} = {};", leaf.path, leaf_value(leaf));
        }
    }
    text.push_str("    return r;\n}\n");
    Ok(text)
}

/// `store_*` of a record whose words `put` takes.
fn store(schema: &Schema, record: &Record, put: &str) -> Result<String, String> {
    let (name, words) = (&record.name, record_bytes(schema, record) / WORD);
    let mut parts = Vec::new();
    leaves(schema, record, "", 0, &mut parts)?;
    let mut text =
        format!("void store_{}(uint index, {name} r) {{\n    uint at = index * {};\n", snake(name), words_name(name));
    for word in 0..words {
        let mut pieces = Vec::new();
        for leaf in &parts {
            let mut lane = 0;
            for (at, _, count) in runs(leaf.at, leaf.lanes) {
                if at == word {
                    let path = format!("r.{}", leaf.path);
                    let part = if count == leaf.lanes { path } else { swizzle(&path, lane, count) };
                    pieces.push(if leaf.is_float { format!("floatBitsToUint({part})") } else { part });
                }
                lane += count;
            }
        }
        let all = match &pieces[..] {
            [one] => one.clone(),
            several => format!("uvec4({})", several.join(", ")),
        };
        let at = if word == 0 { "at".to_owned() } else { format!("at + {word}u") };
        let guard = kept_if(&parts, word).map_err(|e| format!("{name}: {e}"))?;
        let guard = guard.map_or(String::new(), |feature| format!("if ({}) ", feature.to_uppercase()));
        let _ = writeln!(text, "    {guard}{put}({at}, {all});");
    }
    text.push_str("}\n");
    Ok(text)
}

/// `top_instances` are loaded one by one as `top_instance`.
pub fn singular(array: &str) -> &str {
    array.strip_suffix('s').unwrap_or(array)
}

fn fetch(schema: &Schema) -> Result<String, String> {
    let mut text = String::new();
    for (name, stream, stored) in STREAMS {
        let record = schema.record(name).ok_or(format!("no record {name}"))?;
        let base = format!("index * {}", words_name(name));
        let _ = writeln!(text);
        text.push_str(&load(schema, record, &format!("fetch_{stream}"), &base)?);
        if stored {
            let _ = writeln!(text);
            text.push_str(&store(schema, record, &format!("put_{stream}"))?);
        }
    }
    for array in &schema.arrays {
        let _ = writeln!(text);
        let in_heap = schema.heap.contains(&array.name);
        let first = format!("header.first.{}", array.name);
        match &array.element {
            Shape::Record(name) => {
                let record = schema.record(name).ok_or(format!("no record {name}"))?;
                let (fetch, base) = match in_heap {
                    true => ("fetch_data".to_owned(), format!("{first} + index * {}", words_name(name))),
                    false => (format!("fetch_{}", snake(name)), format!("index * {}", words_name(name))),
                };
                text.push_str(&load(schema, record, &fetch, &base)?);
            }
            Shape::Lanes(1, is_float) => {
                let name = singular(&array.name);
                let lane = format!("fetch_data({first} + (index >> 2u))[index & 3u]");
                let _ = match is_float {
                    true => writeln!(text, "float load_{name}(uint index) {{ return uintBitsToFloat({lane}); }}"),
                    false => writeln!(text, "uint load_{name}(uint index) {{ return {lane}; }}"),
                };
            }
            Shape::Lanes(4, false) => {
                let name = singular(&array.name);
                let _ = writeln!(text, "uvec4 load_{name}(uint index) {{ return fetch_data({first} + index); }}");
            }
            _ => return Err(format!("{} holds neither records nor words", array.name)),
        }
    }
    Ok(format!("// Written by the build from src/layout.\n{text}"))
}

fn proof(schema: &Schema) -> String {
    let mut text = String::new();
    let is_loaded = loaded(schema);
    let is_stored = |name: &str| STREAMS.iter().any(|(stream, _, stored)| *stream == name && *stored);
    for record in &schema.records {
        let (name, snake) = (&record.name, snake(&record.name));
        if !is_loaded.contains(&name.as_str()) {
            let _ = writeln!(text, "IN({name}, {snake});");
        }
        let _ = writeln!(text, "OUT({name}, {snake});");
    }
    let _ = writeln!(text, "\nconst uint RECORD_COUNT = {}u;\n\nvoid store_constants() {{", schema.records.len());
    for (number, constant) in schema.constants.iter().enumerate() {
        let bits = match constant.value {
            Value::Uint(_) => constant.name.clone(),
            Value::Float(_) => format!("floatBitsToUint({})", constant.name),
        };
        let _ = writeln!(text, "    constants[{number}] = {bits};");
    }
    let _ = writeln!(text, "}}\n\nvoid copy_record(uint record, uint i) {{\n    switch (record) {{");
    for (number, record) in schema.records.iter().enumerate() {
        let (name, snake) = (record.name.as_str(), snake(&record.name));
        let source = if is_loaded.contains(&name) { format!("load_{snake}(i)") } else { format!("{snake}_in[i]") };
        let copy = match is_stored(name) {
            true => format!("store_{snake}(i, {source})"),
            false => format!("{snake}_out[i] = {source}"),
        };
        let _ = writeln!(text, "    case {number}u: {copy}; break;");
    }
    text.push_str("    }\n}\n");
    format!("// Written by the build from src/layout.\n{text}")
}
