//! Strict arithmetic, proved on the SPIR-V of every kernel (ARCHITECTURE.md, "Strict arithmetic").
//!
//! Vulkan promises correctly rounded `+ - *` and conversions and little else, and only where nothing is fused or
//! reassociated. So [`decorate`] marks every float result `NoContraction`, and [`check`] refuses every operation
//! whose bits may differ between devices. Functions whose name starts with `approx_` are exempt from both: what they
//! return may steer the work, never the result.
//!
//! Knows nothing of the build script, so that tests include it by `#[path]`.

use std::collections::{HashMap, HashSet};
use std::fmt;

use rspirv::binary::Assemble;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, GlslStd450Op as GLOp, Op, Word};

/// Functions with this prefix may use any operation.
pub const APPROXIMATE_PREFIX: &str = "approx_";

/// An operation whose result is not the same on every device.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Violation {
    /// Source file as the compiler was told its name; empty if the module has no line information.
    pub file: String,
    /// Line in it, from 1; 0 if unknown.
    pub line: u32,
    /// Function without its signature; `(module)` outside any function.
    pub function: String,
    /// SPIR-V operation, such as `FDiv` or `GLSL.std.450 Sqrt`.
    pub operation: String,
    /// What to write instead.
    pub advice: &'static str,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Violation { file, line, function, operation, advice } = self;
        write!(f, "{file}:{line}: {operation} in `{function}` is not strict: {advice}")
    }
}

/// Parses a module.
pub fn load(words: &[u32]) -> Result<Module, String> {
    rspirv::dr::load_words(words).map_err(|e| format!("cannot parse the SPIR-V: {e}"))
}

/// Words of a module, in the order the specification asks for.
pub fn assemble(module: &Module) -> Vec<u32> {
    module.assemble()
}

/// Float operations that round at most once and whose result is decorated by [`decorate`].
pub const ARITHMETIC: [Op; 5] = [Op::FAdd, Op::FSub, Op::FMul, Op::FNegate, Op::VectorTimesScalar];

/// Other operations that may read or make floats: exact, or correctly rounded by the Vulkan specification.
const EXACT: [Op; 33] = [
    Op::ConvertFToU,
    Op::ConvertFToS,
    Op::ConvertSToF,
    Op::ConvertUToF,
    Op::Bitcast,
    Op::FOrdEqual,
    Op::FUnordEqual,
    Op::FOrdNotEqual,
    Op::FUnordNotEqual,
    Op::FOrdLessThan,
    Op::FUnordLessThan,
    Op::FOrdGreaterThan,
    Op::FUnordGreaterThan,
    Op::FOrdLessThanEqual,
    Op::FUnordLessThanEqual,
    Op::FOrdGreaterThanEqual,
    Op::FUnordGreaterThanEqual,
    Op::Select,
    Op::Phi,
    Op::Variable,
    Op::Load,
    Op::Store,
    Op::CopyObject,
    Op::CopyLogical,
    Op::CopyMemory,
    Op::CompositeConstruct,
    Op::CompositeExtract,
    Op::CompositeInsert,
    Op::VectorShuffle,
    Op::VectorExtractDynamic,
    Op::VectorInsertDynamic,
    Op::FunctionCall,
    Op::ReturnValue,
];

/// The part of `GLSL.std.450` that is exact.
const EXACT_EXTENDED: [GLOp; 15] = [
    GLOp::FAbs,
    GLOp::Floor,
    GLOp::Trunc,
    GLOp::RoundEven,
    GLOp::SAbs,
    GLOp::SSign,
    GLOp::UMin,
    GLOp::SMin,
    GLOp::UMax,
    GLOp::SMax,
    GLOp::UClamp,
    GLOp::SClamp,
    GLOp::FindILsb,
    GLOp::FindSMsb,
    GLOp::FindUMsb,
];

/// Decorates every arithmetic float result outside `approx_` functions `NoContraction`, once. Returns how many it added.
pub fn decorate(module: &mut Module) -> usize {
    let done = no_contraction(module);
    let names = Names::of(module);
    let mut added = Vec::new();
    for function in &module.functions {
        if names.is_approximate(function.def_id()) {
            continue;
        }
        let results = function
            .all_inst_iter()
            .filter(|i| ARITHMETIC.contains(&i.class.opcode))
            .filter_map(|i| i.result_id)
            .filter(|id| !done.contains(id));
        added.extend(results.map(|id| {
            let operands = vec![Operand::IdRef(id), Operand::Decoration(Decoration::NoContraction)];
            Instruction::new(Op::Decorate, None, None, operands)
        }));
    }
    let count = added.len();
    module.annotations.extend(added);
    count
}

/// Results decorated `NoContraction`.
pub fn no_contraction(module: &Module) -> HashSet<Word> {
    let target = |i: &Instruction| match i.operands.as_slice() {
        [Operand::IdRef(id), Operand::Decoration(Decoration::NoContraction)] => Some(*id),
        _ => None,
    };
    module.annotations.iter().filter_map(target).collect()
}

/// Every operation of the module that is not strict, sorted by file and line, without repetition.
pub fn check(module: &Module) -> Vec<Violation> {
    let names = Names::of(module);
    let types = Types::of(module);
    let mut found = check_module(module, &types);
    for function in &module.functions {
        if names.is_approximate(function.def_id()) {
            continue;
        }
        let name = names.function(function.def_id());
        for block in &function.blocks {
            // OpLine holds until the next one, or until the block ends.
            let (mut file, mut line) = (String::new(), 0);
            for instruction in &block.instructions {
                match (instruction.class.opcode, instruction.operands.as_slice()) {
                    (Op::Line, [Operand::IdRef(id), Operand::LiteralBit32(at), ..]) => {
                        (file, line) = (names.string(*id), *at);
                    }
                    (Op::NoLine, _) => (file, line) = (String::new(), 0),
                    _ => {}
                }
                if let Some((operation, advice)) = types.refuse(instruction) {
                    let (file, function) = (file.clone(), name.clone());
                    found.push(Violation { file, line, function, operation, advice });
                }
            }
        }
    }
    found.sort();
    found.dedup();
    found
}

/// What is wrong at module scope: widths, precision qualifiers, arithmetic on specialisation constants.
fn check_module(module: &Module, types: &Types) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut refuse = |operation: String, advice| {
        let (file, function) = (String::new(), String::from("(module)"));
        found.push(Violation { file, line: 0, function, operation, advice });
    };
    for instruction in &module.types_global_values {
        match (instruction.class.opcode, instruction.operands.as_slice()) {
            (Op::TypeFloat, [Operand::LiteralBit32(width), ..]) if *width != 32 => {
                refuse(format!("TypeFloat {width}"), "only 32-bit floats exist on every device");
            }
            (Op::SpecConstantOp, [Operand::LiteralSpecConstantOpInteger(op), ..])
                if types.touches_float(instruction) && !EXACT.contains(op) =>
            {
                let advice = "compute it on the host and pass the result";
                refuse(format!("SpecConstantOp {op:?}"), advice);
            }
            _ => {}
        }
    }
    for annotation in &module.annotations {
        for operand in &annotation.operands {
            if let Operand::Decoration(decoration @ (Decoration::RelaxedPrecision | Decoration::FPFastMathMode)) =
                operand
            {
                refuse(format!("{decoration:?}"), "remove mediump, lowp and fast-math qualifiers");
            }
        }
    }
    found
}

/// Removes what only a debugger reads (source text, lines); names stay, for reflection.
pub fn strip_lines(module: &mut Module) {
    let is_line = |i: &Instruction| matches!(i.class.opcode, Op::Line | Op::NoLine);
    module.types_global_values.retain(|i| !is_line(i));
    for function in &mut module.functions {
        for block in &mut function.blocks {
            block.instructions.retain(|i| !is_line(i));
        }
    }
    module.debug_module_processed.clear();
    module.debug_string_source.retain(|i| i.class.opcode == Op::String);
    let used: HashSet<Word> = module
        .all_inst_iter()
        .flat_map(|i| &i.operands)
        .filter_map(|o| match o {
            Operand::IdRef(id) => Some(*id),
            _ => None,
        })
        .collect();
    module.debug_string_source.retain(|i| i.result_id.is_some_and(|id| used.contains(&id)));
}

/// Names and strings by id.
struct Names(HashMap<Word, String>);

impl Names {
    fn of(module: &Module) -> Self {
        let mut names = HashMap::new();
        for instruction in module.debug_names.iter().chain(&module.debug_string_source) {
            let (id, text) = match (instruction.class.opcode, instruction.operands.as_slice()) {
                (Op::Name, [Operand::IdRef(id), Operand::LiteralString(text)]) => (*id, text),
                (Op::String, [Operand::LiteralString(text)]) => (instruction.result_id.unwrap_or(0), text),
                _ => continue,
            };
            names.insert(id, text.clone());
        }
        Names(names)
    }

    fn string(&self, id: Word) -> String {
        self.0.get(&id).cloned().unwrap_or_default()
    }

    /// glslang names functions with their signature, `div(f1;f1;`.
    fn function(&self, id: Option<Word>) -> String {
        let full = id.map(|id| self.string(id)).unwrap_or_default();
        full.split('(').next().unwrap_or_default().to_owned()
    }

    fn is_approximate(&self, id: Option<Word>) -> bool {
        self.function(id).starts_with(APPROXIMATE_PREFIX)
    }
}

/// Which ids are floats (scalars, vectors, matrices), and which are matrices.
struct Types {
    floats: HashSet<Word>,
    matrices: HashSet<Word>,
    value_types: HashMap<Word, Word>,
    glsl: Option<Word>,
}

impl Types {
    fn of(module: &Module) -> Self {
        let mut floats = HashSet::new();
        let mut matrices = HashSet::new();
        for instruction in &module.types_global_values {
            let Some(id) = instruction.result_id else {
                continue;
            };
            match (instruction.class.opcode, instruction.operands.first()) {
                (Op::TypeFloat, _) => {
                    floats.insert(id);
                }
                (Op::TypeVector, Some(Operand::IdRef(of))) if floats.contains(of) => {
                    floats.insert(id);
                }
                (Op::TypeMatrix, _) => {
                    floats.insert(id);
                    matrices.insert(id);
                }
                _ => {}
            }
        }
        let value_types = module.all_inst_iter().filter_map(|i| Some((i.result_id?, i.result_type?))).collect();
        let glsl = module
            .ext_inst_imports
            .iter()
            .find(|i| i.operands.first() == Some(&Operand::from("GLSL.std.450")))
            .and_then(|i| i.result_id);
        Types { floats, matrices, value_types, glsl }
    }

    /// Types of the result and of every operand.
    fn types_in<'a>(&'a self, instruction: &'a Instruction) -> impl Iterator<Item = Word> + 'a {
        let operands = instruction.operands.iter().filter_map(|o| match o {
            Operand::IdRef(id) => self.value_types.get(id).copied(),
            _ => None,
        });
        instruction.result_type.into_iter().chain(operands)
    }

    fn touches_float(&self, instruction: &Instruction) -> bool {
        self.types_in(instruction).any(|t| self.floats.contains(&t))
    }

    /// Name and advice if the operation is not strict.
    fn refuse(&self, instruction: &Instruction) -> Option<(String, &'static str)> {
        let op = instruction.class.opcode;
        if op == Op::ExtInst {
            return self.refuse_extended(instruction);
        }
        if self.types_in(instruction).any(|t| self.matrices.contains(&t)) {
            return Some((format!("{op:?} on a matrix"), "write the rows as vectors"));
        }
        // GLSL leaves `%` undefined where an operand is negative.
        if matches!(op, Op::SMod | Op::SRem) {
            return Some((format!("{op:?}"), "undefined below zero; use unsigned operands"));
        }
        if !self.touches_float(instruction) || ARITHMETIC.contains(&op) || EXACT.contains(&op) {
            return None;
        }
        let advice = match op {
            Op::FDiv => "use div or rcp of shading/math",
            Op::FMod | Op::FRem => "subtract a multiple of floor()",
            Op::Dot => "use dot2, dot3 or dot4 of shading/math",
            Op::IsNan | Op::IsInf => "look at the bits",
            Op::QuantizeToF16 => "16-bit rounding differs between devices",
            Op::ImageFetch | Op::ImageRead => "fetch unsigned integers and use uintBitsToFloat",
            _ => "only + - *, compares, selection, conversion and copies of floats are allowed",
        };
        Some((format!("{op:?}"), advice))
    }

    fn refuse_extended(&self, instruction: &Instruction) -> Option<(String, &'static str)> {
        let [Operand::IdRef(set), Operand::LiteralExtInstInteger(number), ..] = instruction.operands.as_slice() else {
            return Some(("ExtInst".to_owned(), "malformed"));
        };
        if Some(*set) != self.glsl {
            let advice = "only GLSL.std.450 is known";
            return self.touches_float(instruction).then(|| (format!("ExtInst {number}"), advice));
        }
        let op = GLOp::from_u32(*number);
        if op.is_some_and(|op| EXACT_EXTENDED.contains(&op)) {
            return None;
        }
        let advice = match op {
            Some(GLOp::FMin | GLOp::NMin) => "use min_ of shading/math",
            Some(GLOp::FMax | GLOp::NMax) => "use max_ of shading/math",
            Some(GLOp::FClamp | GLOp::NClamp) => "use clamp_ of shading/math",
            Some(GLOp::Fma) => "a * b + c is two roundings, always",
            Some(GLOp::Round) => "ties differ between devices; use roundEven",
            _ => "write it with the functions of shading/math",
        };
        let name = op.map_or(number.to_string(), |op| format!("{op:?}"));
        Some((format!("GLSL.std.450 {name}"), advice))
    }
}
