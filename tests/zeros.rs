//! No result asks for the sign of a zero. Some translators of kernels make negative zeros positive (MoltenVK's does). What strict
//! arithmetic allows gives the same numbers for either zero, but for the sign of a zero itself: `+ - *`, compares, choices,
//! `abs floor trunc`, conversions. Only a bit cast from a float shows it, so a kernel in which each of them takes zeros for
//! positive has to give the same bits.

#[path = "../shaders/build/compile.rs"]
mod compile;
#[path = "common/device.rs"]
mod device;
#[path = "common/scenes.rs"]
mod scenes;

use gonio::bake::bake;
use gonio::render::vulkan::{BufferSpec, FetchChoice, VulkanOptions, VulkanRenderer};
use gonio::scene::load::Panels;
use gonio::shaders::REWRITE;
use gonio::verify::twins::{FAMILIES, compare};
use rspirv::binary::Assemble;
use rspirv::dr::{Builder, Instruction, Module, Operand, load_words};
use rspirv::spirv::Op;
use scenes::{Take, assert_same, render, render_cpu, taken};
use std::collections::HashMap;
use std::path::Path;

/// The module in which every bit cast from a float takes a zero for positive. Integers see to it: drivers leave out the addition
/// of 0.
fn with_positive_zeros(words: &[u32]) -> Vec<u32> {
    let mut builder = Builder::new_from_module(load_words(words).expect("a valid module"));
    let types: HashMap<u32, u32> =
        builder.module_ref().all_inst_iter().filter_map(|i| Some((i.result_id?, i.result_type?))).collect();
    let (floats, integers) =
        (lanes_of(builder.module_ref(), Op::TypeFloat), lanes_of(builder.module_ref(), Op::TypeInt));
    let mut functions = std::mem::take(&mut builder.module_mut().functions);
    for block in functions.iter_mut().flat_map(|function| &mut function.blocks) {
        let mut instructions = Vec::new();
        for mut instruction in std::mem::take(&mut block.instructions) {
            let cast = match (instruction.class.opcode, &instruction.operands[..], instruction.result_type) {
                (Op::Bitcast, [Operand::IdRef(from)], Some(to)) if floats.contains_key(&types[from]) => {
                    Some(to).zip(integers.get(&to)).zip(instruction.result_id)
                }
                _ => None,
            };
            let Some(((kind, lanes), id)) = cast else {
                instructions.push(instruction);
                continue;
            };
            let [zero, one] = [0, 1].map(|value| constant(&mut builder, kind, *lanes, value));
            let bool = builder.type_bool();
            let bool = if *lanes == 1 { bool } else { builder.type_vector(bool, *lanes) };
            let [bits, doubled, is_zero] = std::array::from_fn(|_| builder.id());
            instruction.result_id = Some(bits);
            let step = |op, kind, result, from: &[u32]| {
                Instruction::new(op, Some(kind), Some(result), from.iter().copied().map(Operand::IdRef).collect())
            };
            instructions.extend([
                instruction,
                step(Op::ShiftLeftLogical, kind, doubled, &[bits, one]),
                step(Op::IEqual, bool, is_zero, &[doubled, zero]),
                step(Op::Select, kind, id, &[is_zero, zero, bits]),
            ]);
        }
        block.instructions = instructions;
    }
    let mut module = builder.module();
    module.functions = functions;
    module.assemble()
}

/// The types of 32-bit numbers of a sort, and of their vectors, with their lanes.
fn lanes_of(module: &Module, sort: Op) -> HashMap<u32, u32> {
    let mut lanes = HashMap::new();
    for i in &module.types_global_values {
        match (i.class.opcode, &i.operands[..], i.result_id) {
            (op, [Operand::LiteralBit32(32), ..], Some(id)) if op == sort => lanes.insert(id, 1),
            (Op::TypeVector, [Operand::IdRef(of), Operand::LiteralBit32(count)], Some(id))
                if lanes.contains_key(of) =>
            {
                lanes.insert(id, *count)
            }
            _ => None,
        };
    }
    lanes
}

/// A constant of an integer type, or of a vector of it.
fn constant(builder: &mut Builder, kind: u32, lanes: u32, value: u32) -> u32 {
    if lanes == 1 {
        return builder.constant_bit32(kind, value);
    }
    let vector = builder.module_ref().types_global_values.iter().find(|i| i.result_id == Some(kind));
    let Some(Operand::IdRef(scalar)) = vector.and_then(|i| i.operands.first().cloned()) else {
        panic!("a vector's type")
    };
    let lane = builder.constant_bit32(scalar, value);
    builder.constant_composite(kind, vec![lane; lanes as usize])
}

/// A kernel that tells the sign of zeros, to see that it can be told and that the rewriting takes it away.
fn signs_are_gone(context: &mut device::Validated<gonio::render::vulkan::Context>) {
    let text = "#version 460\nlayout(local_size_x = 1) in;\n\
        layout(set = 0, binding = 0) buffer In { float given[]; };\n\
        layout(set = 0, binding = 1) buffer Out { uint told[]; };\n\
        void main() {\n  vec2 v = vec2(given[0], given[1]);\n  told[0] = floatBitsToUint(given[0]);\n  \
        told[1] = floatBitsToUint(-v.y);\n  told[2] = floatBitsToUint((v * v.y).x);\n  told[3] = floatBitsToUint(-0.0 * v.y);\n}\n";
    let words = compile::glsl_to_spirv(text, "shaders/kernels/zeros.comp", &[Path::new(".")], &[]).expect("GLSL");
    let given: Vec<u8> = [-0.0f32, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    let mut run = |words: &[u32]| {
        let buffers = [BufferSpec::Input(&given), BufferSpec::Output(16)];
        let out = context.run_kernel("zeros", words, &buffers, &[], 1).expect("it runs");
        bytemuck::pod_collect_to_vec::<u8, u32>(&out[0])
    };
    assert_eq!(run(&words), [0x8000_0000; 4]);
    assert_eq!(run(&with_positive_zeros(&words)), [0; 4]);
}

#[test]
fn functions_and_pictures_are_the_same_bits_where_every_zero_is_positive() {
    let Some(mut context) = device::context() else { return };
    signs_are_gone(&mut context);
    drop(context);
    REWRITE.set(with_positive_zeros).expect("set once");

    let mut failures = Vec::new();
    let Some(mut context) = device::context() else { return };
    for family in FAMILIES {
        for (number, twin) in family.twins.iter().enumerate() {
            let (differ, first) = compare(&mut context, family, number, 1 << 14, 5).expect("it runs");
            failures.extend(first.map(|first| format!("{}: {differ} differ, first {first}", twin.name)));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    drop(context);

    let take = Take { width: 24, height: 24, samples: 2, seed: 1 };
    for path in scenes::all() {
        let panels = Panels::open(&path, &[], &[]).unwrap_or_else(|error| panic!("{error}"));
        // Panels of a scene differ in numbers; the last one stands for them.
        let scene = panels.scene(panels.labels().len().checked_sub(1)).unwrap_or_else(|error| panic!("{error}"));
        let scene = taken(scene, take);
        let data = bake(&scene).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        let options = VulkanOptions { fetch: FetchChoice::Auto, validate: true, ..VulkanOptions::default() };
        let renderer = VulkanRenderer::new(&data, options).expect("there is a device");
        let messages = renderer.messages();
        let mut renderer = device::Validated::new(renderer, messages);
        let film = render(&mut *renderer, &scene, &data, 0..take.samples);
        assert_same(&render_cpu(&scene, &data), &film, &scene.name);
    }
}
