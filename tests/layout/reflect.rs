//! What a SPIR-V module says of its records, bindings and constants.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Decoration, Op, Word};

/// A member of a record: its name, its GLSL type and its offset in bytes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Member {
    pub name: String,
    /// `uint`, `vec3`, `uvec2`, a record's name, or `TYPE[LENGTH]` for elements that lie without gaps.
    pub glsl: String,
    pub offset: usize,
}

/// A resource: where it is bound, as what, and how kernels call it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Resource {
    pub set: u32,
    pub binding: u32,
    /// `storage` or `texel`, and `[N]` for an array of descriptors.
    pub kind: String,
    /// Name of the block, or of the variable where there is no block.
    pub name: String,
}

/// One module, indexed.
pub struct Reflection<'a> {
    module: &'a Module,
    instructions: HashMap<Word, &'a Instruction>,
    names: HashMap<Word, String>,
    member_names: HashMap<(Word, u32), String>,
    offsets: HashMap<(Word, u32), u32>,
    decorations: HashMap<(Word, Decoration), u32>,
}

impl<'a> Reflection<'a> {
    pub fn of(module: &'a Module) -> Self {
        let mut result = Reflection {
            module,
            instructions: HashMap::new(),
            names: HashMap::new(),
            member_names: HashMap::new(),
            offsets: HashMap::new(),
            decorations: HashMap::new(),
        };
        let with_id = module.all_inst_iter().filter_map(|i| Some((i.result_id?, i)));
        result.instructions.extend(with_id);
        for name in &module.debug_names {
            match name.operands.as_slice() {
                [Operand::IdRef(id), Operand::LiteralString(text)] => {
                    result.names.insert(*id, text.clone());
                }
                [Operand::IdRef(id), Operand::LiteralBit32(at), Operand::LiteralString(text)] => {
                    result.member_names.insert((*id, *at), text.clone());
                }
                _ => {}
            }
        }
        for annotation in &module.annotations {
            use Operand::{Decoration as Is, IdRef, LiteralBit32};
            match annotation.operands.as_slice() {
                [IdRef(id), LiteralBit32(at), Is(Decoration::Offset), LiteralBit32(offset)] => {
                    result.offsets.insert((*id, *at), *offset);
                }
                [IdRef(id), Is(decoration), LiteralBit32(value)] => {
                    result.decorations.insert((*id, *decoration), *value);
                }
                _ => {}
            }
        }
        result
    }

    /// Members of every struct that lies in a buffer, by name. One name may occur with more than one layout.
    pub fn records(&self) -> BTreeMap<String, BTreeSet<Vec<Member>>> {
        let mut found: BTreeMap<String, BTreeSet<Vec<Member>>> = BTreeMap::new();
        for (id, name, members) in self.structs() {
            let offsets: Option<Vec<u32>> =
                (0..members.len()).map(|i| self.offsets.get(&(id, i as u32)).copied()).collect();
            // Structs of local variables have no offsets.
            let Some(offsets) = offsets else { continue };
            let members = members.iter().zip(&offsets).enumerate().map(|(i, (of, offset))| Member {
                name: self.member_names[&(id, i as u32)].clone(),
                glsl: self.type_name(*of),
                offset: *offset as usize,
            });
            found.entry(name).or_default().insert(members.collect());
        }
        found
    }

    /// Bytes from one element to the next in every runtime array of a record.
    pub fn strides(&self) -> BTreeMap<String, BTreeSet<usize>> {
        let mut found: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
        for array in &self.module.types_global_values {
            if array.class.opcode == Op::TypeRuntimeArray {
                let element = array.operands[0].unwrap_id_ref();
                let id = array.result_id.expect("a type has an id");
                let stride = self.decorations[&(id, Decoration::ArrayStride)] as usize;
                found.entry(self.type_name(element)).or_default().insert(stride);
            }
        }
        found
    }

    /// Everything bound to a descriptor set.
    pub fn resources(&self) -> BTreeSet<Resource> {
        let mut found = BTreeSet::new();
        for variable in &self.module.types_global_values {
            let (Op::Variable, Some(id)) = (variable.class.opcode, variable.result_id) else {
                continue;
            };
            let Some(set) = self.decorations.get(&(id, Decoration::DescriptorSet)) else {
                continue;
            };
            let pointer = variable.result_type.expect("a variable has a type");
            let mut of = self.instructions[&pointer].operands[1].unwrap_id_ref();
            let mut count = String::new();
            if self.instructions[&of].class.opcode == Op::TypeArray {
                count = format!("[{}]", self.array_length(of));
                of = self.instructions[&of].operands[0].unwrap_id_ref();
            }
            let (kind, name) = match self.instructions[&of].class.opcode {
                Op::TypeStruct => ("storage", &self.names[&of]),
                Op::TypeSampledImage => ("texel", &self.names[&id]),
                other => panic!("{other:?} bound"),
            };
            found.insert(Resource {
                set: *set,
                binding: self.decorations[&(id, Decoration::Binding)],
                kind: format!("{kind}{count}"),
                name: name.clone(),
            });
        }
        found
    }

    /// What a function stores at constant indices of the runtime array of a block: index to bits.
    pub fn constant_stores(&self, function: &str) -> BTreeMap<u32, u32> {
        let named = |id| self.names.get(&id).is_some_and(|n| n.starts_with(function));
        let function = self.module.functions.iter().find(|f| f.def_id().is_some_and(named));
        let mut found = BTreeMap::new();
        for store in function.expect("the function exists").all_inst_iter() {
            if store.class.opcode != Op::Store {
                continue;
            }
            let chain = self.instructions[&store.operands[0].unwrap_id_ref()];
            let index = chain.operands.last().expect("an index").unwrap_id_ref();
            let value = store.operands[1].unwrap_id_ref();
            let (index, value) = (self.constant(index), self.constant(value));
            assert_eq!(found.insert(index, value), None, "index {index} is stored twice");
        }
        found
    }

    /// Bits of a constant, through a bit cast if need be.
    fn constant(&self, id: Word) -> u32 {
        let instruction = self.instructions[&id];
        match (instruction.class.opcode, &instruction.operands[0]) {
            // Of a specialisation constant the default.
            (Op::Constant | Op::SpecConstant, Operand::LiteralBit32(bits)) => *bits,
            (Op::Bitcast, Operand::IdRef(of)) => self.constant(*of),
            other => panic!("{other:?} is no constant"),
        }
    }

    fn structs(&self) -> impl Iterator<Item = (Word, String, Vec<Word>)> {
        let globals = self.module.types_global_values.iter();
        globals.filter(|i| i.class.opcode == Op::TypeStruct).map(|i| {
            let id = i.result_id.expect("a type has an id");
            let members = i.operands.iter().map(Operand::unwrap_id_ref).collect();
            (id, self.names.get(&id).cloned().unwrap_or_default(), members)
        })
    }

    fn array_length(&self, array: Word) -> u32 {
        self.constant(self.instructions[&array].operands[1].unwrap_id_ref())
    }

    /// The type as GLSL writes it; arrays must lie without gaps.
    fn type_name(&self, id: Word) -> String {
        let instruction = self.instructions[&id];
        let operand = |i: usize| instruction.operands[i].unwrap_id_ref();
        match instruction.class.opcode {
            Op::TypeFloat => "float".to_owned(),
            Op::TypeInt => {
                let signed = instruction.operands[1] == Operand::LiteralBit32(1);
                if signed { "int" } else { "uint" }.to_owned()
            }
            Op::TypeVector => {
                let prefix = match self.type_name(operand(0)).as_str() {
                    "float" => "",
                    "uint" => "u",
                    "int" => "i",
                    other => panic!("vector of {other}"),
                };
                format!("{prefix}vec{}", instruction.operands[1].unwrap_literal_bit32())
            }
            Op::TypeArray => {
                let (element, length) = (self.type_name(operand(0)), self.array_length(id));
                let stride = self.decorations.get(&(id, Decoration::ArrayStride));
                let size = match element.as_str() {
                    "float" | "uint" | "int" => 4,
                    "vec2" | "uvec2" => 8,
                    "vec3" | "uvec3" | "DispatchArguments" => 12,
                    "vec4" | "uvec4" => 16,
                    other => panic!("array of {other}: teach its size to this test"),
                };
                assert_eq!(stride, Some(&size), "elements of {element}[{length}] have gaps");
                format!("{element}[{length}]")
            }
            Op::TypeRuntimeArray => format!("{}[]", self.type_name(operand(0))),
            Op::TypeStruct => self.names.get(&id).cloned().unwrap_or_default(),
            other => panic!("{other:?} in a record"),
        }
    }
}
