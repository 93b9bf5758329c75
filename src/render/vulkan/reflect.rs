//! What a kernel binds, read from its SPIR-V: descriptor layouts never repeat what the shader says.

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Dim, Op, StorageClass, Word};
use std::collections::{HashMap, HashSet};

/// What is bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    StorageBuffer,
    UniformBuffer,
    TexelBuffer,
}

/// One binding that the entry point can reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Binding {
    pub set: u32,
    pub binding: u32,
    pub kind: BindingKind,
    /// Elements of the descriptor array; 1 for a plain binding.
    pub count: u32,
}

/// The bindings that `main` uses, ordered by set and binding. Bindings declared but out of its reach are left out:
/// the limits count what a pipeline's layout holds.
pub fn bindings(words: &[u32]) -> Result<Vec<Binding>, String> {
    let module = rspirv::dr::load_words(words).map_err(|error| format!("not SPIR-V: {error}"))?;
    let types: HashMap<Word, &Instruction> =
        module.types_global_values.iter().filter_map(|global| Some((global.result_id?, global))).collect();
    let used = reachable(&module)?;
    let mut found = Vec::new();
    for variable in &module.types_global_values {
        let (Op::Variable, Some(id)) = (variable.class.opcode, variable.result_id) else {
            continue;
        };
        let Some(&Operand::StorageClass(class)) = variable.operands.first() else {
            continue;
        };
        let bound = [StorageClass::StorageBuffer, StorageClass::Uniform, StorageClass::UniformConstant];
        if !used.contains(&id) || !bound.contains(&class) {
            continue;
        }
        let unknown = || format!("variable %{id} is neither a storage, a uniform nor a texel buffer");
        let pointee = variable.result_type.and_then(|id| types.get(&id)).and_then(|pointer| id_operand(pointer, 1));
        let mut record = *pointee.and_then(|id| types.get(&id)).ok_or_else(unknown)?;
        let mut count = 1;
        if record.class.opcode == Op::TypeArray {
            let length = id_operand(record, 1).and_then(|id| types.get(&id)).ok_or_else(unknown)?;
            let Some(&Operand::LiteralBit32(value)) = length.operands.first() else {
                return Err(unknown());
            };
            count = value;
            record = id_operand(record, 0).and_then(|id| types.get(&id)).ok_or_else(unknown)?;
        }
        if record.class.opcode == Op::TypeSampledImage {
            record = id_operand(record, 0).and_then(|id| types.get(&id)).ok_or_else(unknown)?;
        }
        let kind = match record.class.opcode {
            Op::TypeStruct if class == StorageClass::Uniform => BindingKind::UniformBuffer,
            Op::TypeStruct => BindingKind::StorageBuffer,
            Op::TypeImage if record.operands.get(1) == Some(&Operand::Dim(Dim::DimBuffer)) => BindingKind::TexelBuffer,
            _ => return Err(unknown()),
        };
        let set = decoration(&module, id, Decoration::DescriptorSet).ok_or_else(unknown)?;
        let binding = decoration(&module, id, Decoration::Binding).ok_or_else(unknown)?;
        found.push(Binding { set, binding, kind, count });
    }
    // One binding may be declared as several blocks; the largest array counts.
    found.sort_by_key(|binding| (binding.set, binding.binding, u32::MAX - binding.count));
    if let Some(pair) = found.windows(2).find(|pair| same_place(&pair[0], &pair[1]) && pair[0].kind != pair[1].kind) {
        return Err(format!("set {} binding {} is declared in two kinds", pair[0].set, pair[0].binding));
    }
    found.dedup_by(|later, earlier| same_place(later, earlier));
    Ok(found)
}

fn same_place(a: &Binding, b: &Binding) -> bool {
    (a.set, a.binding) == (b.set, b.binding)
}

/// Ids named by the functions that the entry point calls, directly or not.
fn reachable(module: &Module) -> Result<HashSet<Word>, String> {
    let entry = module.entry_points.first().and_then(|entry| id_operand(entry, 1)).ok_or("no entry point")?;
    let mut waiting = vec![entry];
    let mut seen = HashSet::new();
    while let Some(id) = waiting.pop() {
        let function = module.functions.iter().find(|function| function.def_id() == Some(id));
        for instruction in function.into_iter().flat_map(|function| function.all_inst_iter()) {
            for operand in &instruction.operands {
                if let Operand::IdRef(id) = *operand
                    && seen.insert(id)
                    && instruction.class.opcode == Op::FunctionCall
                {
                    waiting.push(id);
                }
            }
        }
    }
    Ok(seen)
}

fn id_operand(instruction: &Instruction, at: usize) -> Option<Word> {
    instruction.operands.get(at)?.id_ref_any()
}

fn decoration(module: &Module, target: Word, wanted: Decoration) -> Option<u32> {
    module.annotations.iter().find_map(|annotation| match annotation.operands[..] {
        [Operand::IdRef(id), Operand::Decoration(kind), Operand::LiteralBit32(value)]
            if id == target && kind == wanted =>
        {
            Some(value)
        }
        _ => None,
    })
}
