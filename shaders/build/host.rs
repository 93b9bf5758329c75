//! Writes what follows for the host from what `src/layout` declares.

use crate::emit::{glsl_type, singular, snake};
use crate::schema::{Array, Schema, Shape, Value};
use std::fmt::Write as _;

/// The type of an array's element in Rust.
fn rust_type(shape: &Shape) -> &str {
    match shape {
        Shape::Record(name) => name,
        Shape::Lanes(1, true) => "f32",
        Shape::Lanes(4, false) => "[u32; 4]",
        _ => "u32",
    }
}

/// `layout.rs`: the Rust side of `load_*`, the heap, numbers of specialisation constants, and a list of all records.
pub fn layout(schema: &Schema) -> String {
    let mut text = String::new();
    for array in &schema.arrays {
        let (kind, name) = (rust_type(&array.element), &array.name);
        let load = match &array.element {
            Shape::Record(record) => snake(record),
            _ => singular(name).to_owned(),
        };
        let _ = writeln!(
            text,
            "/// Entry `index` of `{name}`.\n#[inline(always)]\npub fn load_{load}(scene: &SceneView, index: u32) -> {kind} {{\n    scene.{name}[index as usize]\n}}\n"
        );
    }
    let _ = writeln!(
        text,
        "impl<'a> SceneView<'a> {{\n    /// The arrays of the data heap, in its order.\n    pub fn heap(&self) -> [&'a [u8]; {}] {{\n        [",
        schema.heap.len()
    );
    for name in &schema.heap {
        let _ = writeln!(text, "            bytemuck::cast_slice(self.{name}),");
    }
    text.push_str("        ]\n    }\n}\n\n");
    let starts = schema.heap.iter().enumerate().map(|(at, name)| format!("{name}: first[{at}]"));
    let _ = writeln!(
        text,
        "impl From<[u32; {}]> for HeapStarts {{\n    fn from(first: [u32; {0}]) -> Self {{\n        Self {{ {} }}\n    }}\n}}\n",
        schema.heap.len(),
        starts.collect::<Vec<_>>().join(", ")
    );
    for of in ["Variant", "Features"] {
        let own = || schema.switches.iter().enumerate().filter(|(_, switch)| switch.of == of);
        let _ = writeln!(
            text,
            "impl {of} {{\n    /// Number and value of each specialisation constant.\n    pub fn constants(&self) -> [(u32, u32); {}] {{\n        [",
            own().count()
        );
        for (number, switch) in own() {
            let value = match switch.member.shape {
                Shape::Bool => format!("u32::from(self.{})", switch.member.name),
                _ => format!("self.{}", switch.member.name),
            };
            let _ = writeln!(text, "            ({number}, {value}),");
        }
        text.push_str("        ]\n    }\n}\n\n");
    }
    text.push_str("/// Every record, in the order of the parity kernel of the layout.\npub static RECORDS: &[RecordLayout] = &[\n");
    for record in &schema.records {
        let name = &record.name;
        let holds = |array: &&Array| array.element == Shape::Record(name.clone());
        let array = schema.arrays.iter().find(holds).map(|array| &array.name);
        let _ = writeln!(
            text,
            "    RecordLayout {{ name: {name:?}, size: size_of::<{name}>(), array: {array:?}, members: &["
        );
        for member in &record.members {
            let own = if member.name.starts_with("pad") { format!("_{}", member.name) } else { member.name.clone() };
            let _ = writeln!(
                text,
                "        MemberLayout {{ name: {:?}, offset: std::mem::offset_of!({name}, {own}), kind: {:?} }},",
                member.name,
                glsl_type(&member.shape)
            );
        }
        text.push_str("    ] },\n");
    }
    text.push_str("];\n\n/// Every constant, with its bits.\npub static CONSTANTS: &[(&str, u32)] = &[\n");
    for constant in &schema.constants {
        let name = &constant.name;
        let bits = match constant.value {
            Value::Uint(_) => name.clone(),
            Value::Float(_) => format!("{name}.to_bits()"),
        };
        let _ = writeln!(text, "    ({name:?}, {bits}),");
    }
    text.push_str("];\n");
    text
}
