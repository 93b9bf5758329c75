//! Writes how a closure is packed into the block of its model and unpacked: member by member, by name.

use crate::emit::{Leaf, WORD, comment, declaration, glsl_type, guarded, leaf_value, leaves, record_bytes};
use crate::schema::{Member, Record, Schema, Shape, Value};
use std::fmt::Write as _;

/// The closure's struct, and one of zeros.
pub fn closure(schema: &Schema) -> String {
    let mut text = String::from("// A material at one point.\nstruct Closure {\n");
    for member in &schema.closure {
        comment(&mut text, "    ", &member.doc);
        let _ = writeln!(text, "    {};", declaration(member));
    }
    text.push_str("};\n\n// A closure of zeros.\nClosure no_closure() {\n    Closure c;\n");
    for member in &schema.closure {
        let zero = if is_float(&member.shape) { "0.0" } else { "0u" };
        let _ = writeln!(text, "    c.{} = {}({zero});", member.name, glsl_type(&member.shape));
    }
    text.push_str("    return c;\n}\n");
    guarded("CLOSURE", &text)
}

fn is_float(shape: &Shape) -> bool {
    matches!(shape, Shape::Lanes(_, true))
}

/// The leaves of a block that are no padding, each a member of the closure. An error names the one that is not.
fn parameters(schema: &Schema, block: &Record) -> Result<Vec<Leaf>, String> {
    let mut found = Vec::new();
    leaves(schema, block, "", 0, &mut found)?;
    found.retain(|leaf| !name(leaf).starts_with("pad"));
    for leaf in &found {
        let is_same =
            |member: &Member| member.name == name(leaf) && member.shape == Shape::Lanes(leaf.lanes, leaf.is_float);
        if !schema.closure.iter().any(is_same) {
            return Err(format!("{}::{} is no member of the closure", block.name, leaf.path));
        }
    }
    if !record_bytes(schema, block).is_multiple_of(WORD) {
        return Err(format!("{} is not a whole number of {WORD}-byte words", block.name));
    }
    Ok(found)
}

/// The member of the closure that a leaf is: `lit.color` is `color`.
fn name(leaf: &Leaf) -> &str {
    leaf.path.rsplit('.').next().unwrap_or_default()
}

/// Models with parameters: constant, number, block.
fn models(schema: &Schema) -> impl Iterator<Item = (&str, u32, &Record)> {
    schema.models.iter().filter_map(|(constant, block)| match (&constant.value, block) {
        (Value::Uint(number), Some(block)) => Some((constant.name.as_str(), *number, schema.record(block)?)),
        _ => None,
    })
}

/// Words of the longest block.
fn most_words(schema: &Schema) -> usize {
    models(schema).map(|(.., block)| record_bytes(schema, block) / WORD).max().unwrap_or(0)
}

/// `unpack_block` in GLSL. Lanes of all models load the same words, as many as the longest block of a model that the scene has:
/// devices that walk lanes in lockstep load for one model after the other otherwise.
pub fn unpack(schema: &Schema) -> Result<String, String> {
    let mut text = String::from(
        "// Fills in the parameters of the closure's model from its block, in 16-byte words of the parameters.\nvoid unpack_block(uint block, inout Closure c) {\n",
    );
    for word in 0..most_words(schema) {
        let longer = models(schema).filter(|(.., block)| record_bytes(schema, block) / WORD > word);
        let mask = longer.fold(0u32, |mask, (_, number, _)| mask | 1 << number);
        let _ = writeln!(text, "    uvec4 w{word} = uvec4(0u);");
        let _ = writeln!(text, "    if ((MODELS & {mask}u) != 0u) w{word} = load_parameter(block + {word}u);");
    }
    text.push_str("    switch (c.model) {\n");
    for (constant, _, block) in models(schema) {
        let _ = writeln!(text, "    case {constant}:\n        if (HAS_MODEL({constant})) {{");
        for leaf in parameters(schema, block)? {
            let _ = writeln!(text, "            c.{} = {};", name(&leaf), leaf_value(&leaf));
        }
        text.push_str("        }\n        break;\n");
    }
    text.push_str("    default: break;\n    }\n}\n");
    Ok(guarded("BLOCKS", &text))
}

/// The block as a literal of Rust, from a closure.
fn literal(schema: &Schema, record: &Record) -> String {
    let members = record.members.iter().map(|member| match &member.shape {
        _ if member.name.starts_with("pad") => format!("_{}: 0", member.name),
        Shape::Record(inner) => {
            let inner = schema.record(inner).map(|inner| literal(schema, inner)).unwrap_or_default();
            format!("{}: {inner}", member.name)
        }
        _ => format!("{0}: closure.{0}", member.name),
    });
    format!("{} {{ {} }}", record.name, members.collect::<Vec<_>>().join(", "))
}

/// `pack_block` and `unpack_block` in Rust.
pub fn rust(schema: &Schema) -> Result<String, String> {
    let mut text = format!(
        "/// 16-byte words of the longest block.\npub const BLOCK_WORDS_MOST: usize = {};\n\n",
        most_words(schema)
    );
    text.push_str(
        "/// Fills in the parameters of the closure's model from its block, in 16-byte words of the parameters.\n#[inline]\nfn unpack_block(scene: &SceneView, block: u32, closure: &mut Closure) {\n    match closure.model {\n",
    );
    for (constant, _, block) in models(schema) {
        let words = record_bytes(schema, block) / WORD;
        let _ = writeln!(
            text,
            "        {constant} => {{\n            let words: &[[u32; 4]; {words}] = scene.parameters[block as usize..][..{words}].try_into().expect(\"as many\");\n            let b: &{} = bytemuck::cast_ref(words);",
            block.name
        );
        for leaf in parameters(schema, block)? {
            let _ = writeln!(text, "            closure.{} = b.{};", name(&leaf), leaf.path);
        }
        text.push_str("        }\n");
    }
    text.push_str("        _ => {}\n    }\n}\n\n");
    text.push_str(
        "/// Appends the block of the closure's model; the result is where it begins.\npub fn pack_block(closure: &Closure, parameters: &mut Vec<[u32; 4]>) -> u32 {\n    let first = parameters.len() as u32;\n    match closure.model {\n",
    );
    for (constant, _, block) in models(schema) {
        let words = record_bytes(schema, block) / WORD;
        let value = literal(schema, block);
        let _ = writeln!(
            text,
            "        {constant} => {{\n            let block = {value};\n            parameters.extend(bytemuck::cast::<{}, [[u32; 4]; {words}]>(block));\n        }}",
            block.name
        );
    }
    text.push_str("        _ => {}\n    }\n    first\n}\n");
    Ok(text)
}
