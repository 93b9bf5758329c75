//! Specialisation ahead of the driver.
//!
//! Drivers inline a kernel whole before they fold its specialisation constants and cut what those leave out: seconds for
//! a kernel that holds every model. So the constants get their values here, and what they exclude goes before a driver
//! sees it: branches never taken, blocks and functions out of reach. What is left computes the same.
//!
//! Only `OpBranchConditional` is cut. An `OpSwitch` stays, because its cases may leave it from within other constructs,
//! which structured control flow allows to a switch alone.

use rspirv::binary::Assemble;
use rspirv::dr::{Block, Function, Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, Word};
use std::collections::{HashMap, HashSet};

/// The values of scalar constants: bits of integers and floats, 0 or 1 of booleans.
type Known = HashMap<Word, u32>;

/// `words` with the values `constants` (id, bits; booleans 0 or 1) instead of its specialisation constants, and without
/// what they exclude. Constants not listed keep their defaults. Names and lines are dropped.
pub fn specialise(words: &[u32], constants: &[(u32, u32)]) -> Result<Vec<u32>, String> {
    let mut module = rspirv::dr::load_words(words).map_err(|error| format!("not SPIR-V: {error}"))?;
    let known = fix_constants(&mut module, constants);
    for function in &mut module.functions {
        cut_branches(function, &known);
    }
    keep_called(&mut module);
    drop_names(&mut module);
    Ok(module.assemble())
}

fn id(operand: &Operand) -> Option<Word> {
    match operand {
        Operand::IdRef(id) => Some(*id),
        _ => None,
    }
}

/// Makes specialisation constants ordinary ones; the values of all scalar constants.
fn fix_constants(module: &mut Module, constants: &[(u32, u32)]) -> Known {
    let mut given = HashMap::new();
    module.annotations.retain(|decorate| match decorate.operands[..] {
        [Operand::IdRef(target), Operand::Decoration(Decoration::SpecId), Operand::LiteralBit32(number)] => {
            given.extend(constants.iter().find(|(id, _)| *id == number).map(|(_, value)| (target, *value)));
            false
        }
        _ => true,
    });
    let mut known = Known::new();
    for global in &mut module.types_global_values {
        let (op, Some(result)) = (global.class.opcode, global.result_id) else {
            continue;
        };
        let value = given.get(&result).copied();
        match op {
            Op::ConstantTrue | Op::ConstantFalse | Op::SpecConstantTrue | Op::SpecConstantFalse => {
                let default = matches!(op, Op::ConstantTrue | Op::SpecConstantTrue);
                set_bool(global, value.map_or(default, |value| value != 0), &mut known);
            }
            Op::Constant | Op::SpecConstant => {
                let [Operand::LiteralBit32(default)] = global.operands[..] else {
                    continue;
                };
                set_word(global, value.unwrap_or(default), &mut known);
            }
            Op::SpecConstantComposite => *global = with_op(global, Op::ConstantComposite, global.operands.clone()),
            Op::SpecConstantOp => {
                let Operand::LiteralSpecConstantOpInteger(op) = global.operands[0] else {
                    continue;
                };
                match evaluate(op, &global.operands[1..], &known) {
                    Some(Value::Bool(value)) => set_bool(global, value, &mut known),
                    Some(Value::Word(value)) => set_word(global, value, &mut known),
                    None => {}
                }
            }
            _ => {}
        }
    }
    known
}

fn with_op(instruction: &Instruction, op: Op, operands: Vec<Operand>) -> Instruction {
    Instruction::new(op, instruction.result_type, instruction.result_id, operands)
}

fn set_bool(global: &mut Instruction, value: bool, known: &mut Known) {
    *global = with_op(global, if value { Op::ConstantTrue } else { Op::ConstantFalse }, Vec::new());
    known.extend(global.result_id.map(|id| (id, u32::from(value))));
}

fn set_word(global: &mut Instruction, value: u32, known: &mut Known) {
    *global = with_op(global, Op::Constant, vec![Operand::LiteralBit32(value)]);
    known.extend(global.result_id.map(|id| (id, value)));
}

enum Value {
    Bool(bool),
    Word(u32),
}

/// The result of a scalar operation on 32-bit integers and booleans, if all that it needs is known.
fn evaluate(op: Op, operands: &[Operand], known: &Known) -> Option<Value> {
    let get = |at: usize| known.get(&id(operands.get(at)?)?).copied();
    // One side may decide alone.
    match op {
        Op::LogicalAnd if get(0) == Some(0) || get(1) == Some(0) => return Some(Value::Bool(false)),
        Op::LogicalOr if get(0) == Some(1) || get(1) == Some(1) => return Some(Value::Bool(true)),
        _ => {}
    }
    let a = get(0)?;
    match op {
        Op::LogicalNot => return Some(Value::Bool(a == 0)),
        Op::Not => return Some(Value::Word(!a)),
        _ => {}
    }
    let b = get(1)?;
    Some(match op {
        Op::LogicalAnd => Value::Bool(a & b != 0),
        Op::LogicalOr => Value::Bool(a | b != 0),
        Op::LogicalEqual | Op::IEqual => Value::Bool(a == b),
        Op::LogicalNotEqual | Op::INotEqual => Value::Bool(a != b),
        Op::UGreaterThan => Value::Bool(a > b),
        Op::UGreaterThanEqual => Value::Bool(a >= b),
        Op::ULessThan => Value::Bool(a < b),
        Op::ULessThanEqual => Value::Bool(a <= b),
        Op::IAdd => Value::Word(a.wrapping_add(b)),
        Op::ISub => Value::Word(a.wrapping_sub(b)),
        Op::IMul => Value::Word(a.wrapping_mul(b)),
        Op::BitwiseAnd => Value::Word(a & b),
        Op::BitwiseOr => Value::Word(a | b),
        Op::ShiftLeftLogical if b < 32 => Value::Word(a << b),
        Op::ShiftRightLogical if b < 32 => Value::Word(a >> b),
        _ => return None,
    })
}

/// The block ids a terminator names.
fn targets(terminator: &Instruction) -> Vec<Word> {
    match terminator.class.opcode {
        Op::Branch => terminator.operands.iter().filter_map(id).collect(),
        Op::BranchConditional => terminator.operands[1..3].iter().filter_map(id).collect(),
        Op::Switch => terminator.operands[1..].iter().filter_map(id).collect(),
        _ => Vec::new(),
    }
}

/// The blocks that a construct's header names: where it ends and, for a loop, where it goes on.
fn construct(block: &Block) -> Option<(Op, Vec<Word>)> {
    let merge = block.instructions.iter().rev().nth(1)?;
    let op = merge.class.opcode;
    matches!(op, Op::SelectionMerge | Op::LoopMerge).then(|| (op, merge.operands.iter().filter_map(id).collect()))
}

fn label(block: &Block) -> Word {
    block.label.as_ref().and_then(|label| label.result_id).expect("a parsed block has a label")
}

/// Takes known branches, and drops the blocks that no path reaches any more.
fn cut_branches(function: &mut Function, known: &Known) {
    let mut known = known.clone();
    // What a loop carries back is known a round later; conditions on constants never need that.
    loop {
        let mut changed = false;
        let mut before = HashSet::new();
        for block in &mut function.blocks {
            before.insert(label(block));
            for instruction in &block.instructions {
                if let Some(result) = instruction.result_id
                    && !known.contains_key(&result)
                    && let Some(value) = learn(instruction, &known)
                {
                    known.insert(result, value);
                }
            }
            changed |= take_branch(block, &known, &before);
        }
        if !changed {
            return;
        }
        drop_unreachable(function);
    }
}

/// What an instruction in a function is known to result in.
fn learn(instruction: &Instruction, known: &Known) -> Option<u32> {
    match instruction.class.opcode {
        Op::CopyObject => known.get(&id(&instruction.operands[0])?).copied(),
        op => match evaluate(op, &instruction.operands, known)? {
            Value::Bool(value) => Some(u32::from(value)),
            Value::Word(value) => Some(value),
        },
    }
}

/// Makes a conditional branch whose condition is known an ordinary one. `before`: the block itself and those before it; a
/// loop keeps its way back to its header, which structured control flow asks for.
fn take_branch(block: &mut Block, known: &Known, before: &HashSet<Word>) -> bool {
    let Some(last) = block.instructions.last() else {
        return false;
    };
    if last.class.opcode != Op::BranchConditional || targets(last).iter().any(|target| before.contains(target)) {
        return false;
    }
    let Some(condition) = id(&last.operands[0]).and_then(|id| known.get(&id)) else {
        return false;
    };
    let taken = last.operands[if *condition != 0 { 1 } else { 2 }].clone();
    block.instructions.pop();
    if block.instructions.last().is_some_and(|merge| merge.class.opcode == Op::SelectionMerge) {
        block.instructions.pop();
    }
    block.instructions.push(Instruction::new(Op::Branch, None, None, vec![taken]));
    true
}

/// Keeps what the first block reaches, and of the rest only the labels that headers must name.
fn drop_unreachable(function: &mut Function) {
    let places: HashMap<Word, usize> =
        function.blocks.iter().enumerate().map(|(at, block)| (label(block), at)).collect();
    let mut reached = HashSet::from([0]);
    let mut waiting = vec![0];
    while let Some(at) = waiting.pop() {
        let next = function.blocks[at].instructions.last().map(targets).unwrap_or_default();
        waiting.extend(next.iter().map(|id| places[id]).filter(|&at| reached.insert(at)));
    }
    // A merge block out of reach stays as a label alone, a continue block as the way back to its header.
    let mut hulls = HashMap::new();
    for &at in &reached {
        if let Some((op, named)) = construct(&function.blocks[at]) {
            let header = label(&function.blocks[at]);
            for (which, name) in named.iter().enumerate().filter(|(_, name)| !reached.contains(&places[*name])) {
                let end = match (op, which) {
                    (Op::LoopMerge, 1) => Instruction::new(Op::Branch, None, None, vec![Operand::IdRef(header)]),
                    _ => Instruction::new(Op::Unreachable, None, None, Vec::new()),
                };
                hulls.insert(places[name], end);
            }
        }
    }
    let mut at = 0;
    function.blocks.retain_mut(|block| {
        let this = at;
        at += 1;
        if let Some(end) = hulls.remove(&this) {
            block.instructions = vec![end];
            return true;
        }
        reached.contains(&this)
    });
    prune_phis(function);
}

/// Removes from every phi the values of blocks that no longer lead to it; one value left is a copy.
fn prune_phis(function: &mut Function) {
    let mut sources: HashMap<Word, HashSet<Word>> = HashMap::new();
    for block in &function.blocks {
        for target in block.instructions.last().map(targets).unwrap_or_default() {
            sources.entry(target).or_default().insert(label(block));
        }
    }
    for block in &mut function.blocks {
        let from = sources.remove(&label(block)).unwrap_or_default();
        for phi in block.instructions.iter_mut().filter(|instruction| instruction.class.opcode == Op::Phi) {
            let pairs: Vec<_> =
                phi.operands.chunks(2).filter(|pair| id(&pair[1]).is_some_and(|b| from.contains(&b))).collect();
            *phi = match pairs[..] {
                [pair] => with_op(phi, Op::CopyObject, vec![pair[0].clone()]),
                _ => with_op(phi, Op::Phi, pairs.concat()),
            };
        }
    }
}

/// Drops the functions that the entry point does not call, directly or not.
fn keep_called(module: &mut Module) {
    let calls: HashMap<Word, Vec<Word>> = module
        .functions
        .iter()
        .filter_map(|function| {
            let called = function.all_inst_iter().filter(|i| i.class.opcode == Op::FunctionCall);
            Some((function.def_id()?, called.filter_map(|call| id(&call.operands[0])).collect()))
        })
        .collect();
    let mut waiting: Vec<Word> = module.entry_points.iter().filter_map(|entry| id(&entry.operands[1])).collect();
    let mut called: HashSet<Word> = waiting.iter().copied().collect();
    while let Some(function) = waiting.pop() {
        waiting.extend(calls.get(&function).into_iter().flatten().filter(|&&id| called.insert(id)));
    }
    module.functions.retain(|function| function.def_id().is_some_and(|id| called.contains(&id)));
}

/// Drops names, lines and the decorations of what is gone.
fn drop_names(module: &mut Module) {
    module.debug_string_source.clear();
    module.debug_names.clear();
    module.debug_module_processed.clear();
    for function in &mut module.functions {
        for block in &mut function.blocks {
            block.instructions.retain(|i| !matches!(i.class.opcode, Op::Line | Op::NoLine));
        }
    }
    module.types_global_values.retain(|i| !matches!(i.class.opcode, Op::Line | Op::NoLine));
    let defined: HashSet<Word> = module.all_inst_iter().filter_map(|instruction| instruction.result_id).collect();
    module.annotations.retain(|decorate| decorate.operands.first().and_then(id).is_none_or(|id| defined.contains(&id)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::{Features, Variant};
    use crate::shaders::{Fetch, kernel, names};
    use bytemuck::Zeroable;

    /// One model, one texture format, no rare feature: the least a scene asks for.
    fn least() -> Vec<(u32, u32)> {
        let features = Features { models: 1, emitters: 1, formats: 1, is_one_instance: true, ..Features::zeroed() };
        [&Variant::default().constants()[..], &features.constants()].concat()
    }

    fn specialised(name: &str, fetch: Fetch, constants: &[(u32, u32)]) -> Module {
        let words = specialise(kernel(name, fetch).expect("named by the table"), constants).expect("valid");
        rspirv::dr::load_words(words).expect("still valid")
    }

    #[test]
    fn every_id_that_a_specialised_kernel_uses_is_there() {
        for name in names() {
            for fetch in [Fetch::Texel, Fetch::Storage] {
                let module = specialised(name, fetch, &least());
                let defined: HashSet<Word> = module.all_inst_iter().filter_map(|i| i.result_id).collect();
                for instruction in module.all_inst_iter() {
                    for used in instruction.operands.iter().filter_map(id).chain(instruction.result_type) {
                        assert!(defined.contains(&used), "{name}: %{used} is gone from {instruction:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn no_specialisation_constant_is_left() {
        for name in names() {
            let module = specialised(name, Fetch::Texel, &least());
            for global in &module.types_global_values {
                let left = matches!(
                    global.class.opcode,
                    Op::SpecConstant | Op::SpecConstantTrue | Op::SpecConstantFalse | Op::SpecConstantOp
                );
                assert!(!left, "{name}: {global:?}");
            }
        }
    }

    #[test]
    fn a_model_that_no_material_has_is_cut_from_the_kernel() {
        let lambert = specialised("shade", Fetch::Texel, &least()).functions.len();
        let all = specialised("shade", Fetch::Texel, &Features::default().constants()).functions.len();
        assert!(lambert * 2 < all, "{lambert} of {all} functions are left");
    }

    #[test]
    fn defaults_alone_cut_nothing_that_runs() {
        let words = kernel("resolve", Fetch::Storage).expect("named by the table");
        let before = rspirv::dr::load_words(words).expect("valid");
        let after = specialised("resolve", Fetch::Storage, &[]);
        assert_eq!(after.functions.len(), before.functions.len());
    }
}
