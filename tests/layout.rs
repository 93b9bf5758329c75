//! Host and device see the same bytes: every record and every constant of `src/layout` against the SPIR-V.
//!
//! `shaders/kernels/parity/layout.comp` declares each record in a scalar block, and every other kernel is held to the same
//! layouts. Names, types, offsets, sizes, strides, bindings and constants are compared without a device; the last tests
//! send the records through the kernel on a device, where there is one.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use gonio::render::vulkan::{BufferSpec, Context};
use gonio::shaders::{self, Fetch};

#[path = "../shaders/build/compile.rs"]
mod compile;
#[path = "common/device.rs"]
mod device;
#[path = "layout/records.rs"]
mod records;
#[path = "layout/reflect.rs"]
mod reflect;

use records::{HOST_ONLY, constants, records};
use reflect::{Reflection, Resource};

const FETCHES: [Fetch; 2] = [Fetch::Texel, Fetch::Storage];
const KERNEL: &str = "shaders/kernels/parity/layout.comp";

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Text of all files directly in a folder, one after the other.
fn folder_text(folder: &str) -> String {
    let entries = std::fs::read_dir(root().join(folder)).expect("the folder exists");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("readable").path()).collect();
    paths.sort();
    paths.iter().map(|path| read(path)).collect()
}

/// First words after `prefix` of the lines that start with it, without trailing punctuation.
fn declared(text: &str, prefix: &str) -> BTreeSet<String> {
    let lines = text.lines().filter_map(|line| line.strip_prefix(prefix));
    let word =
        |rest: &str| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default().to_owned();
    lines.map(word).collect()
}

fn set(names: impl IntoIterator<Item = impl Into<String>>) -> BTreeSet<String> {
    names.into_iter().map(Into::into).collect()
}

#[test]
fn every_record_of_both_sides_is_listed_here() {
    let listed = set(records().iter().map(|r| r.name));
    let mut rust = declared(&folder_text("src/layout"), "pub struct ");
    for name in HOST_ONLY {
        assert!(rust.remove(name), "{name} is no longer in src/layout");
    }
    assert_eq!(rust, listed, "structs of src/layout (left) and of this test");
    let glsl = declared(&folder_text("shaders/layout"), "struct ");
    assert_eq!(glsl, listed, "structs of shaders/layout (left) and of this test");
}

#[test]
fn every_kernel_lays_out_every_record_as_rust_does() {
    let records = records();
    let mut proved = BTreeSet::new();
    for (kernel, fetch) in all_kernels() {
        let words = shaders::kernel(kernel, fetch).expect("a listed kernel exists");
        let module = rspirv::dr::load_words(words).expect("valid SPIR-V");
        let reflection = Reflection::of(&module);
        let (structs, strides) = (reflection.records(), reflection.strides());
        for record in &records {
            for members in structs.get(record.name).into_iter().flatten() {
                assert_eq!(members, &record.members, "{} in {kernel}, {fetch:?}", record.name);
            }
            for stride in strides.get(record.name).into_iter().flatten() {
                assert_eq!(*stride, record.size, "size of {} in {kernel}, {fetch:?}", record.name);
                proved.insert(record.name.to_owned());
            }
        }
    }
    assert_eq!(proved, set(records.iter().map(|r| r.name)), "records with an array in some kernel");
}

fn all_kernels() -> impl Iterator<Item = (&'static str, Fetch)> {
    shaders::names().flat_map(|name| FETCHES.map(|fetch| (name, fetch)))
}

#[test]
fn records_are_whole_words_and_those_loaded_by_words_are_whole_16_byte_words() {
    let glsl = folder_text("shaders/layout");
    for record in records() {
        assert_eq!(record.size % 4, 0, "{}", record.name);
        let end = record.members.last().expect("a record has members").offset;
        assert!(end < record.size, "{}", record.name);
        if glsl.contains(&format!(" load_{}(", record.snake_name())) {
            assert_eq!(record.size % 16, 0, "{}", record.name);
        }
    }
}

/// Every constant of both sides with its bits; `NODE_WORDS` is the size of a `Node` in 16-byte words, in GLSL only.
fn all_constants() -> BTreeMap<String, u32> {
    let glsl = folder_text("shaders/layout");
    let mut all = constants();
    for record in records() {
        let name = record.snake_name();
        if glsl.contains(&format!(" load_{name}(")) {
            all.insert(format!("{}_WORDS", name.to_uppercase()), (record.size / 16) as u32);
        }
    }
    all
}

#[test]
fn every_constant_of_both_sides_is_listed_here_and_in_the_kernel() {
    let rust = declared(&folder_text("src/layout"), "pub const ");
    assert_eq!(rust, constants().into_keys().collect(), "src/layout (left) and this test");
    let text = folder_text("shaders/layout");
    let mut glsl = declared(&text, "const uint ");
    glsl.append(&mut declared(&text, "const float "));
    let others = text.lines().filter(|line| line.starts_with("const "));
    assert_eq!(others.count(), glsl.len(), "a constant of another type: teach it to this test");
    let expected: BTreeSet<String> = all_constants().into_keys().collect();
    assert_eq!(glsl, expected, "shaders/layout (left) and this test");
    let stored = stored_constants().into_values().collect();
    assert_eq!(expected, stored, "this test (left) and store_constants of {KERNEL}");
}

/// Name of the constant at each index, as the text of the layout kernel has it.
fn stored_constants() -> BTreeMap<u32, String> {
    let mut found = BTreeMap::new();
    for line in read(&root().join(KERNEL)).lines() {
        let Some(rest) = line.trim().strip_prefix("constants[") else {
            continue;
        };
        let (index, value) = rest.split_once("] = ").expect("an assignment");
        let value = value.trim_end_matches(';');
        let bare = value.strip_prefix("floatBitsToUint(").and_then(|v| v.strip_suffix(')'));
        let index = index.parse().expect("a number");
        found.insert(index, bare.unwrap_or(value).to_owned());
    }
    found
}

#[test]
fn every_constant_has_the_same_bits_on_both_sides() {
    let expected = all_constants();
    for fetch in FETCHES {
        let words = shaders::kernel("parity/layout", fetch).expect("the layout kernel");
        let module = rspirv::dr::load_words(words).expect("valid SPIR-V");
        let values = Reflection::of(&module).constant_stores("store_constants(");
        let named = stored_constants().into_iter().map(|(index, name)| (name, values[&index]));
        assert_eq!(named.collect::<BTreeMap<_, _>>(), expected, "GLSL (left) and Rust");
    }
}

#[test]
fn the_layout_kernel_reads_every_record_the_way_kernels_do() {
    let text = read(&root().join(KERNEL));
    let glsl = folder_text("shaders/layout");
    let records = records();
    for (number, record) in records.iter().enumerate() {
        let name = record.snake_name();
        let load = format!("{} load_{name}(uint index)", record.name);
        let source = if glsl.contains(&load) { format!("load_{name}(i)") } else { format!("{name}_in[i]") };
        let stored = glsl.contains(&format!("void store_{name}(uint index, "));
        let case = if stored { format!("store_{name}(i, {source})") } else { format!("{name}_out[i] = {source}") };
        let case = format!("case {number}u: {case}; break;");
        assert!(text.contains(&case), "{KERNEL} lacks `{case}`");
    }
    let count = format!("const uint RECORD_COUNT = {}u;", records.len());
    assert!(text.contains(&count), "{KERNEL} lacks `{count}`");
}

/// Where a GLSL `load_*` takes a member from: its path (`ray.origin`, `to_world[1]`), byte offset and type.
type Source = (String, usize, String);

/// What a record's `load_*` must read: members flattened to what fits into a word.
fn expected_sources(record: &str, at: usize, prefix: &str) -> Vec<Source> {
    let records = records();
    let record = records.iter().find(|r| r.name == record).expect("a listed record");
    let mut found = Vec::new();
    for member in &record.members {
        let (path, offset) = (format!("{prefix}{}", member.name), at + member.offset);
        if let Some((element, length)) = member.glsl.split_once('[') {
            assert_eq!(element, "vec4", "only arrays of whole words are loaded");
            let length: usize = length.trim_end_matches(']').parse().expect("a length");
            let element = |i| (format!("{path}[{i}]"), offset + 16 * i, element.to_owned());
            found.extend((0..length).map(element));
        } else if records.iter().any(|r| r.name == member.glsl) {
            found.extend(expected_sources(&member.glsl, offset, &format!("{path}.")));
        } else {
            found.push((path, offset, member.glsl.clone()));
        }
    }
    found
}

/// What a record's `load_*` reads, from its text: `uvec4 w1 = fetch_data(at + 1u);`, `r.u = uintBitsToFloat(w1.w);`.
fn written_sources(body: &str) -> Vec<Source> {
    let mut found = Vec::new();
    let mut word = 0;
    for line in body.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix("uvec4 w") {
            let (name, call) = rest.split_once(" = ").expect("an assignment");
            let address = call.split_once('(').expect("a call").1.trim_end_matches(");");
            word = name.parse().expect("words are numbered");
            let expected = if word == 0 { "at".to_owned() } else { format!("at + {word}u") };
            assert_eq!(address, expected, "{line}");
        } else if let Some(rest) = line.strip_prefix("r.") {
            let (path, value) = rest.trim_end_matches(';').split_once(" = ").expect("an assignment");
            let float = value.strip_prefix("uintBitsToFloat(").and_then(|value| value.strip_suffix(')'));
            let lanes = float.unwrap_or(value);
            let (variable, swizzle) = lanes.split_once('.').unwrap_or((lanes, "xyzw"));
            assert_eq!(variable, format!("w{word}"), "{line}");
            let first = "xyzw".find(swizzle).unwrap_or_else(|| panic!("{line}: lanes in order"));
            let glsl = match (float.is_some(), swizzle.len()) {
                (true, 1) => "float".to_owned(),
                (false, 1) => "uint".to_owned(),
                (true, lanes) => format!("vec{lanes}"),
                (false, lanes) => format!("uvec{lanes}"),
            };
            found.push((path.to_owned(), 16 * word + 4 * first, glsl));
        }
    }
    found
}

#[test]
fn load_functions_take_every_member_from_its_own_bytes() {
    let glsl = folder_text("shaders/layout");
    let mut proved = 0;
    for record in records() {
        let (name, upper) = (record.snake_name(), record.snake_name().to_uppercase());
        let head = format!("{} load_{name}(uint index) {{\n", record.name);
        let Some((_, rest)) = glsl.split_once(&head) else {
            continue;
        };
        let (body, _) = rest.split_once("\n}\n").expect("a function ends");
        let base = if body.contains("fetch_data(") {
            format!("header.first_{name} + index * {upper}_WORDS")
        } else {
            format!("index * {upper}_WORDS")
        };
        assert!(body.contains(&format!("uint at = {base};\n")), "load_{name}: at is not {base}");
        assert_eq!(written_sources(body), expected_sources(record.name, 0, ""), "load_{name}");
        proved += 1;
    }
    assert_eq!(proved, glsl.matches("(uint index) {").count(), "load functions proved");
}

/// What kernels bind, as `shaders/kernels/bindings.glsl` promises: (set, binding, storage name, texel name).
/// A texel name is given where the texel variant reads through a texel buffer.
const BINDINGS: [(u32, u32, &str, Option<&str>); 19] = [
    (0, 0, "HeaderBlock", None),
    (0, 1, "NodePage", Some("node_pages")),
    (0, 2, "TrianglePage", Some("triangle_pages")),
    (0, 3, "DataPage", Some("data_pages")),
    (1, 0, "ControlBlock", None),
    (1, 1, "LevelBlock", None),
    (1, 2, "ChunkBlock", None),
    (1, 3, "HitBlock", None),
    (1, 4, "ShadowBlock", None),
    (1, 5, "SlotBlock", None),
    (1, 6, "FilmBlock", None),
    (1, 7, "AovBlock", None),
    (1, 8, "LevelWords", Some("level_words")),
    (1, 9, "ChunkWords", Some("chunk_words")),
    (1, 10, "HitWords", Some("hit_words")),
    (1, 11, "ShadowWords", Some("shadow_words")),
    (1, 12, "OrderBlock", None),
    (1, 13, "SlotWords", Some("slot_words")),
    (1, 14, "FilmWords", Some("film_words")),
];

/// Scene arrays come in pages: arrays of this many descriptors.
const PAGES: u32 = 8;

fn bindings(fetch: Fetch) -> BTreeSet<Resource> {
    let resource = |&(set, binding, block, texel): &(u32, u32, &str, Option<&str>)| {
        let (kind, name) = match (fetch, texel) {
            (Fetch::Texel, Some(name)) => ("texel", name),
            _ => ("storage", block),
        };
        let paged = set == 0 && texel.is_some();
        let count = if paged { format!("[{PAGES}]") } else { String::new() };
        Resource { set, binding, kind: format!("{kind}{count}"), name: name.to_owned() }
    };
    BINDINGS.iter().map(resource).collect()
}

#[test]
fn every_kernel_binds_only_what_the_bindings_promise() {
    for (kernel, fetch) in all_kernels().filter(|(name, _)| !name.starts_with("parity/")) {
        let words = shaders::kernel(kernel, fetch).expect("a listed kernel exists");
        let module = rspirv::dr::load_words(words).expect("valid SPIR-V");
        let found = Reflection::of(&module).resources();
        let unknown: Vec<_> = found.difference(&bindings(fetch)).cloned().collect();
        assert_eq!(unknown, [], "{kernel}, {fetch:?}");
    }
}

#[test]
fn the_bindings_file_binds_all_that_is_promised() {
    let text = "#version 460\n#extension GL_EXT_scalar_block_layout : require\n\
                #extension GL_GOOGLE_include_directive : require\n\
                #include \"kernels/bindings.glsl\"\nvoid main() {}\n";
    for (fetch, defines) in [(Fetch::Storage, &[][..]), (Fetch::Texel, &["FETCH_TEXEL"][..])] {
        let words = compile::glsl_to_spirv(text, "all.comp", &root().join("shaders"), defines);
        let words = words.unwrap_or_else(|e| panic!("{e}"));
        let module = rspirv::dr::load_words(&words).expect("valid SPIR-V");
        assert_eq!(Reflection::of(&module).resources(), bindings(fetch), "{fetch:?}");
    }
}

/// The bytes before the records in the layout kernel's input: a header.
const HEADER_BYTES: usize = size_of::<gonio::layout::SceneHeader>();

/// Runs the layout kernel on `count` records, or for its constants if `record` is the number of records.
fn run_layout_kernel(context: &mut Context, record: usize, count: usize, input: &[u8], output: usize) -> Vec<u8> {
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("the layout kernel");
    let buffers = [BufferSpec::Input(input), BufferSpec::Output(output as u64)];
    let choice = [record as u32, count as u32];
    let outputs = context.run_kernel("parity/layout", words, &buffers, bytemuck::cast_slice(&choice), 1);
    outputs.unwrap_or_else(|e| panic!("{e}")).swap_remove(0)
}

#[test]
fn a_device_reads_and_writes_every_record_as_rust_does() {
    let Some(mut context) = device::context() else { return };
    let records = records();
    let header = &records.iter().find(|r| r.name == "SceneHeader").expect("a listed record").members;
    for (number, record) in records.iter().enumerate() {
        let count = 5;
        let words = count * record.size / 4;
        // All words differ and none is a subnormal or a NaN, which a device may change.
        let mut input: Vec<u32> = (0..(HEADER_BYTES / 4 + words) as u32).map(|i| 0x3f80_0000 + i).collect();
        let own = format!("first_{}", record.snake_name());
        for member in header.iter().filter(|member| member.name.starts_with("first_")) {
            // Past the end of the buffer for all arrays but the one that is read.
            input[member.offset / 4] = if member.name == own { (HEADER_BYTES / 16) as u32 } else { 0xff_ffff };
        }
        let returned = run_layout_kernel(&mut context, number, count, bytemuck::cast_slice(&input), 4 * words);
        let expected: &[u8] = bytemuck::cast_slice(&input[HEADER_BYTES / 4..]);
        assert!(returned == expected, "{}: {returned:x?}, not {expected:x?}", record.name);
    }
}

#[test]
fn a_device_knows_every_constant_as_rust_does() {
    let Some(mut context) = device::context() else { return };
    let names = stored_constants();
    let input = [0; HEADER_BYTES];
    let returned = run_layout_kernel(&mut context, records().len(), 1, &input, 4 * names.len());
    let values: Vec<u32> = bytemuck::pod_collect_to_vec(&returned);
    let named = names.into_iter().map(|(index, name)| (name, values[index as usize]));
    assert_eq!(named.collect::<BTreeMap<_, _>>(), all_constants(), "the device (left) and Rust");
}
