//! Host and device see the same bytes: every record and every constant of `src/layout` against the SPIR-V.
//!
//! `build.rs` writes the shaders' side from the Rust. `shaders/kernels/parity/layout.comp` declares each record in a scalar
//! block, and every other kernel is held to the same layouts. Names, types, offsets, sizes, strides, bindings and constants are
//! compared without a device; the last tests send the records through the kernel on a device, where there is one.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use gonio::layout::{
    BINDING_AOVS, BINDING_CHUNK, BINDING_CHUNK_READ, BINDING_CONTROL, BINDING_DATA, BINDING_FILM, BINDING_FILM_READ,
    BINDING_HEADER, BINDING_HITS, BINDING_HITS_READ, BINDING_LEVELS, BINDING_LEVELS_READ, BINDING_NODES, BINDING_ORDER,
    BINDING_SHADOWS, BINDING_SHADOWS_READ, BINDING_SLOTS, BINDING_SLOTS_READ, BINDING_TRIANGLES, CONSTANTS, MAX_PAGES,
    RECORDS, SET_SCENE, SET_WORK,
};
use gonio::render::vulkan::{BufferSpec, Context};
use gonio::shaders::{self, Fetch};

#[path = "../shaders/build/compile.rs"]
mod compile;
#[path = "common/device.rs"]
mod device;
#[path = "layout/reflect.rs"]
mod reflect;

use reflect::{Member, Reflection, Resource};

const FETCHES: [Fetch; 2] = [Fetch::Texel, Fetch::Storage];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The members of a record as Rust lays them out.
fn members(record: &gonio::layout::RecordLayout) -> Vec<Member> {
    let member =
        |m: &gonio::layout::MemberLayout| Member { name: m.name.into(), glsl: m.kind.into(), offset: m.offset };
    record.members.iter().map(member).collect()
}

#[test]
fn every_kernel_lays_out_every_record_as_rust_does() {
    let mut proved = BTreeSet::new();
    for (kernel, fetch) in all_kernels() {
        let words = shaders::kernel(kernel, fetch).expect("a listed kernel exists");
        let module = rspirv::dr::load_words(words).expect("valid SPIR-V");
        let reflection = Reflection::of(&module);
        let (structs, strides) = (reflection.records(), reflection.strides());
        for record in RECORDS {
            for found in structs.get(record.name).into_iter().flatten() {
                assert_eq!(found, &members(record), "{} in {kernel}, {fetch:?}", record.name);
            }
            for stride in strides.get(record.name).into_iter().flatten() {
                assert_eq!(*stride, record.size, "size of {} in {kernel}, {fetch:?}", record.name);
                proved.insert(record.name);
            }
        }
    }
    assert_eq!(proved, RECORDS.iter().map(|r| r.name).collect(), "records with an array in some kernel");
}

fn all_kernels() -> impl Iterator<Item = (&'static str, Fetch)> {
    shaders::names().flat_map(|name| FETCHES.map(|fetch| (name, fetch)))
}

#[test]
fn every_constant_has_the_same_bits_on_both_sides() {
    assert!(CONSTANTS.len() > 100, "constants are not found any more");
    for fetch in FETCHES {
        let words = shaders::kernel("parity/layout", fetch).expect("the layout kernel");
        let module = rspirv::dr::load_words(words).expect("valid SPIR-V");
        let values = Reflection::of(&module).constant_stores("store_constants(");
        let named = CONSTANTS.iter().enumerate().map(|(at, (name, _))| (*name, values[&(at as u32)]));
        assert_eq!(named.collect::<Vec<_>>(), CONSTANTS, "GLSL (left) and Rust");
    }
}

/// What kernels bind, as `shaders/kernels/bindings.glsl` promises: (set, binding, storage name, texel name).
/// A texel name is given where the texel variant reads through a texel buffer.
const BINDINGS: [(u32, u32, &str, Option<&str>); 19] = [
    (SET_SCENE, BINDING_HEADER, "HeaderBlock", None),
    (SET_SCENE, BINDING_NODES, "NodePage", Some("node_pages")),
    (SET_SCENE, BINDING_TRIANGLES, "TrianglePage", Some("triangle_pages")),
    (SET_SCENE, BINDING_DATA, "DataPage", Some("data_pages")),
    (SET_WORK, BINDING_CONTROL, "ControlBlock", None),
    (SET_WORK, BINDING_LEVELS, "LevelBlock", None),
    (SET_WORK, BINDING_CHUNK, "ChunkBlock", None),
    (SET_WORK, BINDING_HITS, "HitBlock", None),
    (SET_WORK, BINDING_SHADOWS, "ShadowBlock", None),
    (SET_WORK, BINDING_SLOTS, "SlotBlock", None),
    (SET_WORK, BINDING_FILM, "FilmBlock", None),
    (SET_WORK, BINDING_AOVS, "AovBlock", None),
    (SET_WORK, BINDING_ORDER, "OrderBlock", None),
    (SET_WORK, BINDING_LEVELS_READ, "LevelWords", Some("level_words")),
    (SET_WORK, BINDING_CHUNK_READ, "ChunkWords", Some("chunk_words")),
    (SET_WORK, BINDING_HITS_READ, "HitWords", Some("hit_words")),
    (SET_WORK, BINDING_SHADOWS_READ, "ShadowWords", Some("shadow_words")),
    (SET_WORK, BINDING_SLOTS_READ, "SlotWords", Some("slot_words")),
    (SET_WORK, BINDING_FILM_READ, "FilmWords", Some("film_words")),
];

fn bindings(fetch: Fetch) -> BTreeSet<Resource> {
    let resource = |&(set, binding, block, texel): &(u32, u32, &str, Option<&str>)| {
        let (kind, name) = match (fetch, texel) {
            (Fetch::Texel, Some(name)) => ("texel", name),
            _ => ("storage", block),
        };
        let paged = set == SET_SCENE && texel.is_some();
        let count = if paged { format!("[{MAX_PAGES}]") } else { String::new() };
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
        let words =
            compile::glsl_to_spirv(text, "all.comp", &[&root().join("shaders"), Path::new(env!("OUT_DIR"))], defines);
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

/// Members of the record of a name.
fn members_of(name: &str) -> &'static [gonio::layout::MemberLayout] {
    RECORDS.iter().find(|record| record.name == name).expect("a record").members
}

#[test]
fn a_device_reads_and_writes_every_record_as_rust_does() {
    let Some(mut context) = device::context() else { return };
    let heap = members_of("SceneHeader").iter().find(|member| member.name == "first").expect("the heap's places");
    for (number, record) in RECORDS.iter().enumerate() {
        let count = 5;
        let words = count * record.size / 4;
        // All words differ and none is a subnormal or a NaN, which a device may change.
        let mut input: Vec<u32> = (0..(HEADER_BYTES / 4 + words) as u32).map(|i| 0x3f80_0000 + i).collect();
        for member in members_of("HeapStarts") {
            // Past the end of the buffer for all arrays but the one that is read.
            let is_own = record.array == Some(member.name);
            input[(heap.offset + member.offset) / 4] = if is_own { (HEADER_BYTES / 16) as u32 } else { 0xff_ffff };
        }
        let returned = run_layout_kernel(&mut context, number, count, bytemuck::cast_slice(&input), 4 * words);
        let expected: &[u8] = bytemuck::cast_slice(&input[HEADER_BYTES / 4..]);
        assert!(returned == expected, "{}: {returned:x?}, not {expected:x?}", record.name);
    }
}

#[test]
fn a_device_knows_every_constant_as_rust_does() {
    let Some(mut context) = device::context() else { return };
    let input = [0; HEADER_BYTES];
    let returned = run_layout_kernel(&mut context, RECORDS.len(), 1, &input, 4 * CONSTANTS.len());
    let values: Vec<u32> = bytemuck::pod_collect_to_vec(&returned);
    let named = CONSTANTS.iter().zip(values).map(|((name, _), value)| (*name, value));
    assert_eq!(named.collect::<Vec<_>>(), CONSTANTS, "the device (left) and Rust");
}
