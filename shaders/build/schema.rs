//! What crosses the bus, read from the Rust that declares it (`src/layout/*.rs`).
//!
//! Records are structs with `#[repr(C)]`, constants are `pub const NAME: u32` or `f32`, the scene's arrays are the slices of
//! `SceneView`, and specialisation constants are the members of `Variant` and `Features`. `emit` writes GLSL from these.

use std::collections::BTreeMap;
use std::path::Path;
use syn::{Expr, Fields, Item, Lit, Meta, Type};

/// A constant: its name, its value as GLSL writes it, and what it says of itself.
pub struct Constant {
    pub name: String,
    pub value: Value,
    pub doc: Vec<String>,
}

/// The value of a constant.
#[derive(Clone)]
pub enum Value {
    Uint(u32),
    /// The decimals as written.
    Float(String),
}

/// A record or another struct.
pub struct Record {
    pub name: String,
    pub members: Vec<Member>,
    pub doc: Vec<String>,
}

/// A member of a record.
pub struct Member {
    /// As GLSL has it: `_pad0` is `pad0` there.
    pub name: String,
    pub shape: Shape,
    pub doc: Vec<String>,
}

/// What a member is made of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Lanes of 32 bits each, 1 to 4, and whether they are floats.
    Lanes(usize, bool),
    Bool,
    Record(String),
    Array(Box<Shape>, usize),
}

/// One array of the scene: its name in `SceneView`, and the record or kind of word that it holds.
pub struct Array {
    pub name: String,
    pub element: Shape,
}

/// Everything that `src/layout` declares.
pub struct Schema {
    pub constants: Vec<Constant>,
    /// Each after those it contains.
    pub records: Vec<Record>,
    pub arrays: Vec<Array>,
    /// Names of the arrays in the data heap, in its order.
    pub heap: Vec<String>,
    /// Models in the order of their numbers, each with the record of its parameters; none if it has no parameters.
    pub models: Vec<(Constant, Option<String>)>,
    /// Members of a closure, which never crosses the bus.
    pub closure: Vec<Member>,
    /// Specialisation constants in the order of their numbers: what a kernel is compiled for, and what the scene uses.
    pub switches: Vec<Switch>,
}

/// A specialisation constant, as a member of `Variant` or `Features`.
pub struct Switch {
    /// The struct.
    pub of: &'static str,
    pub member: Member,
    /// As Rust's `Default` has it: the bits, 0 or 1 of a boolean.
    pub default: u32,
}

/// Structs that say something else than the layout of bytes.
const VIEW: &str = "SceneView";
const VARIANT: &str = "Variant";
const FEATURES: &str = "Features";
const CLOSURE: &str = "Closure";
/// What names of models' constants begin with, and those of their blocks end with.
const MODEL: &str = "MODEL_";
const BLOCK: &str = "Block";
/// The record whose members are where the heap's arrays begin.
const HEAP: &str = "HeapStarts";

impl Schema {
    /// Reads all files of `folder` (`src/layout`), and the file that declares the closure. The error says what is not understood,
    /// and in which file.
    pub fn read(folder: &Path, closure: &Path) -> Result<Schema, String> {
        let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "rs"));
        paths.sort();
        paths.push(closure.to_owned());
        let mut schema = Schema {
            constants: Vec::new(),
            records: Vec::new(),
            arrays: Vec::new(),
            heap: Vec::new(),
            models: Vec::new(),
            closure: Vec::new(),
            switches: Vec::new(),
        };
        let mut files = Vec::new();
        for path in &paths {
            let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
            files.push((path, syn::parse_file(&text).map_err(|e| format!("{}: {e}", path.display()))?));
        }
        // Lengths of arrays are constants of any file.
        for (path, file) in &files {
            for item in &file.items {
                schema.take_constant(item).map_err(|e| format!("{}: {e}", path.display()))?;
            }
        }
        let lengths = schema.lengths();
        for (path, file) in &files {
            for item in &file.items {
                schema.take_struct(item, &lengths).map_err(|e| format!("{}: {e}", path.display()))?;
            }
        }
        for (path, file) in &files {
            for item in &file.items {
                schema.take_defaults(item, &lengths).map_err(|e| format!("{}: {e}", path.display()))?;
            }
        }
        schema.switches.sort_by_key(|switch| switch.of != VARIANT);
        schema.order_records()?;
        schema.find_blocks(&files.iter().map(|(_, file)| file).collect::<Vec<_>>())?;
        schema.check()?;
        Ok(schema)
    }

    pub fn record(&self, name: &str) -> Option<&Record> {
        self.records.iter().find(|record| record.name == name)
    }

    fn lengths(&self) -> BTreeMap<String, usize> {
        let number = |constant: &Constant| match constant.value {
            Value::Uint(value) => Some((constant.name.clone(), value as usize)),
            Value::Float(_) => None,
        };
        self.constants.iter().filter_map(number).collect()
    }

    fn take_constant(&mut self, item: &Item) -> Result<(), String> {
        let Item::Const(item) = item else { return Ok(()) };
        let Type::Path(kind) = &*item.ty else { return Ok(()) };
        let name = item.ident.to_string();
        let unknown = || format!("{name}: a constant of the layout is a number");
        let value = match (&*item.expr, kind.path.get_ident().map(ToString::to_string).as_deref()) {
            (Expr::Lit(literal), Some("u32")) => match &literal.lit {
                Lit::Int(number) => Value::Uint(number.base10_parse().map_err(|e| format!("{name}: {e}"))?),
                _ => return Err(unknown()),
            },
            (Expr::Lit(literal), Some("f32")) => match &literal.lit {
                Lit::Float(number) => Value::Float(number.base10_digits().to_owned()),
                _ => return Err(unknown()),
            },
            (_, Some("u32" | "f32")) => return Err(unknown()),
            _ => return Ok(()),
        };
        self.constants.push(Constant { name, value, doc: doc(&item.attrs) });
        Ok(())
    }

    fn take_struct(&mut self, item: &Item, lengths: &BTreeMap<String, usize>) -> Result<(), String> {
        let Item::Struct(item) = item else { return Ok(()) };
        let Fields::Named(fields) = &item.fields else { return Ok(()) };
        let name = item.ident.to_string();
        if name == VIEW {
            return self.take_arrays(fields);
        }
        let known = [VARIANT, FEATURES].into_iter().find(|known| *known == name);
        let is_record = item.attrs.iter().any(|attribute| attribute.path().is_ident("repr"));
        if !is_record && known.is_none() && name != CLOSURE {
            return Ok(());
        }
        let mut members = Vec::new();
        for field in &fields.named {
            let name = field.ident.as_ref().map(ToString::to_string).unwrap_or_default();
            let shape =
                shape(&field.ty, lengths).ok_or(format!("{}::{name} has a type without a layout", item.ident))?;
            members.push(Member { name: name.trim_start_matches('_').to_owned(), shape, doc: doc(&field.attrs) });
        }
        match known {
            _ if name == CLOSURE => self.closure = members,
            Some(of) => self.switches.extend(members.into_iter().map(|member| Switch { of, member, default: 0 })),
            None => {
                if name == HEAP {
                    self.heap = members.iter().map(|member| member.name.clone()).collect();
                }
                self.records.push(Record { name, members, doc: doc(&item.attrs) });
            }
        }
        Ok(())
    }

    /// The values in `impl Default for Variant` and `for Features`.
    fn take_defaults(&mut self, item: &Item, constants: &BTreeMap<String, usize>) -> Result<(), String> {
        let Item::Impl(block) = item else { return Ok(()) };
        let Type::Path(own) = &*block.self_ty else { return Ok(()) };
        if !block.trait_.as_ref().is_some_and(|(path, ..)| path.is_ident("Default")) {
            return Ok(());
        }
        let body = block.items.iter().find_map(|item| match item {
            syn::ImplItem::Fn(function) => function.block.stmts.last(),
            _ => None,
        });
        let Some(syn::Stmt::Expr(Expr::Struct(values), None)) = body else { return Ok(()) };
        for switch in self.switches.iter_mut().filter(|switch| own.path.is_ident(switch.of)) {
            let name = &switch.member.name;
            let value = values.fields.iter().find_map(|field| match &field.member {
                syn::Member::Named(member) if member == name => constant_value(&field.expr, constants),
                _ => None,
            });
            switch.default = value.ok_or(format!("{}::{name} has no plain default", switch.of))?;
        }
        Ok(())
    }

    /// The slices of `SceneView`.
    fn take_arrays(&mut self, fields: &syn::FieldsNamed) -> Result<(), String> {
        for field in &fields.named {
            let (Some(name), Type::Reference(to)) = (&field.ident, &field.ty) else { continue };
            let Type::Slice(slice) = &*to.elem else { continue };
            let element = shape(&slice.elem, &BTreeMap::new()).ok_or(format!("{VIEW}::{name}: not a record"))?;
            self.arrays.push(Array { name: name.to_string(), element });
        }
        Ok(())
    }

    /// Records after what they contain.
    fn order_records(&mut self) -> Result<(), String> {
        let mut ordered: Vec<Record> = Vec::new();
        let mut waiting = std::mem::take(&mut self.records);
        while !waiting.is_empty() {
            let known = |shape: &Shape| match innermost(shape) {
                Shape::Record(name) => ordered.iter().any(|record| record.name == *name),
                _ => true,
            };
            let ready = waiting.iter().position(|record| record.members.iter().all(|member| known(&member.shape)));
            let Some(at) = ready else {
                let names: Vec<_> = waiting.iter().map(|record| record.name.as_str()).collect();
                return Err(format!("{}: they contain what is no record", names.join(", ")));
            };
            ordered.push(waiting.remove(at));
        }
        self.records = ordered;
        Ok(())
    }

    /// The block of each model.
    fn find_blocks(&mut self, files: &[&syn::File]) -> Result<(), String> {
        let empty: Vec<String> = files
            .iter()
            .flat_map(|file| &file.items)
            .filter_map(|item| match item {
                Item::Struct(item) if matches!(item.fields, Fields::Unit) => Some(item.ident.to_string()),
                _ => None,
            })
            .collect();
        for constant in self.constants.iter().filter(|constant| constant.name.starts_with(MODEL)) {
            let words = constant.name[MODEL.len()..].split('_');
            let camel = words.map(|word| format!("{}{}", &word[..1], word[1..].to_lowercase())).collect::<String>();
            let block = format!("{camel}{BLOCK}");
            let found = match self.record(&block) {
                Some(_) => Some(block),
                None if empty.contains(&block) => None,
                None => return Err(format!("{} has no {block}", constant.name)),
            };
            let constant = Constant { name: constant.name.clone(), value: constant.value.clone(), doc: Vec::new() };
            self.models.push((constant, found));
        }
        Ok(())
    }

    /// Every array of the heap is one of the scene's.
    fn check(&self) -> Result<(), String> {
        match self.heap.iter().find(|name| self.arrays.iter().all(|array| array.name != **name)) {
            Some(name) => Err(format!("{HEAP}::{name} is no array of {VIEW}")),
            None => Ok(()),
        }
    }
}

/// The element of an array of arrays, or the shape itself.
fn innermost(shape: &Shape) -> &Shape {
    match shape {
        Shape::Array(element, _) => innermost(element),
        other => other,
    }
}

/// The shape of a type; `None` if it has none in GLSL.
fn shape(kind: &Type, lengths: &BTreeMap<String, usize>) -> Option<Shape> {
    match kind {
        Type::Path(path) => Some(match path.path.get_ident()?.to_string().as_str() {
            "u32" => Shape::Lanes(1, false),
            "f32" => Shape::Lanes(1, true),
            "bool" => Shape::Bool,
            "Vec2" => Shape::Lanes(2, true),
            "Vec3" => Shape::Lanes(3, true),
            "Vec4" => Shape::Lanes(4, true),
            name => Shape::Record(name.to_owned()),
        }),
        Type::Array(array) => {
            let length = length(&array.len, lengths)?;
            match shape(&array.elem, lengths)? {
                Shape::Lanes(1, is_float) if (2..=4).contains(&length) => Some(Shape::Lanes(length, is_float)),
                element => Some(Shape::Array(Box::new(element), length)),
            }
        }
        _ => None,
    }
}

/// `3`, `MAX_LEVELS as usize`.
fn length(expression: &Expr, lengths: &BTreeMap<String, usize>) -> Option<usize> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(number) => number.base10_parse().ok(),
            _ => None,
        },
        Expr::Cast(cast) => length(&cast.expr, lengths),
        Expr::Path(path) => lengths.get(&path.path.get_ident()?.to_string()).copied(),
        _ => None,
    }
}

/// `true`, `8`, `STACK_SIZE`, `u32::MAX`.
fn constant_value(expression: &Expr, constants: &BTreeMap<String, usize>) -> Option<u32> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Bool(value) => Some(u32::from(value.value)),
            Lit::Int(number) => number.base10_parse().ok(),
            _ => None,
        },
        Expr::Path(path) => match path.path.get_ident() {
            Some(name) => constants.get(&name.to_string()).map(|value| *value as u32),
            None => path.path.segments.last().filter(|last| last.ident == "MAX").map(|_| u32::MAX),
        },
        _ => None,
    }
}

/// Lines of a doc comment.
fn doc(attributes: &[syn::Attribute]) -> Vec<String> {
    let line = |attribute: &syn::Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value().trim().to_owned()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(line).collect()
}
