//! The Vulkan layer below the wavefront: memory, kernels, submissions, errors. Needs a device (lavapipe will do).

#[path = "common/device.rs"]
mod device;

use gonio::bake::shapes::Shapes;
use gonio::bake::{SceneArrays, SceneData};
use gonio::layout::{Node, PathState, RECORDS, SceneHeader, Triangle, Variant};
use gonio::render::RenderError;
use gonio::render::vulkan::{
    Binding, BindingKind, Bound, BufferSpec, FetchChoice, Instance, Place, STORAGE_FETCH_STORAGE_BUFFERS, SceneBuffers,
    TEXEL_FETCH_STORAGE_BUFFERS, TEXEL_FETCH_TEXEL_BUFFERS, bindings,
};
use gonio::shaders::{self, Fetch};
use std::path::Path;
use std::sync::Arc;

/// Bytes that differ from their neighbours and from page to page.
fn pattern(length: usize) -> Vec<u8> {
    (0..length as u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect()
}

#[test]
fn bytes_survive_the_way_to_the_device_and_back() {
    let Some(mut context) = device::context() else {
        return;
    };
    let bytes = pattern((17 << 20) + 52); // more than travels at a time
    let buffer = context.buffer("round trip", bytes.len() as u64 + 16, Place::Device).unwrap();
    context.upload(&buffer, 16, &bytes).unwrap();
    assert!(context.download::<u8>(&buffer, 16, bytes.len()).unwrap() == bytes);
    let part: Vec<u8> = context.download(&buffer, 116, 40).unwrap();
    assert_eq!(part, bytes[100..140]);
}

/// Sends `records` through the kernel that reads and writes every record of the layout (its number there: `record`).
fn through_the_layout_kernel<T: bytemuck::Pod>(record: &str, records: &[T]) -> Option<Vec<T>> {
    let mut context = device::context()?;
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("embedded by build.rs");
    let mut input = vec![0; size_of::<SceneHeader>()];
    input.extend_from_slice(bytemuck::cast_slice(records));
    let buffers = [BufferSpec::Input(&input), BufferSpec::Output(size_of_val(records) as u64)];
    let number = RECORDS.iter().position(|of| of.name == record).expect("a record");
    let push = [number as u32, records.len() as u32];
    let output = context
        .run_kernel("parity/layout", words, &buffers, bytemuck::cast_slice(&push), records.len() as u32)
        .unwrap();
    assert_eq!(output.len(), 1);
    Some(bytemuck::pod_collect_to_vec(&output[0]))
}

fn counted<T: bytemuck::Pod>(count: usize) -> Vec<T> {
    let words: Vec<u32> = (0..(count * size_of::<T>() / 4) as u32).collect();
    bytemuck::pod_collect_to_vec(bytemuck::cast_slice::<u32, u8>(&words))
}

#[test]
fn a_kernel_reads_and_writes_records_as_rust_lays_them_out() {
    let nodes: Vec<Node> = counted(5);
    let Some(returned) = through_the_layout_kernel("Node", &nodes) else {
        return;
    };
    assert_eq!(returned, nodes);
    let paths: Vec<PathState> = counted(70);
    assert_eq!(through_the_layout_kernel("PathState", &paths), Some(paths));
}

#[test]
fn a_buffer_that_is_not_written_comes_back_as_it_was() {
    let Some(mut context) = device::context() else {
        return;
    };
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("embedded by build.rs");
    let given = pattern(96);
    let buffers = [BufferSpec::Input(&[0; 256]), BufferSpec::InOut(&given), BufferSpec::Output(64)];
    let push = [1u32, 0];
    let outputs = context.run_kernel("parity/layout", words, &buffers, bytemuck::cast_slice(&push), 1).unwrap();
    assert_eq!(outputs, [given, vec![0; 64]]);
}

#[test]
fn a_kernel_without_its_buffer_is_an_error_that_names_the_binding() {
    let Some(mut context) = device::context() else {
        return;
    };
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("embedded by build.rs");
    let error = context.run_kernel("parity/layout", words, &[BufferSpec::Output(512)], &[0; 8], 1).unwrap_err();
    assert_eq!(error.to_string(), "0 buffers for set 0 binding 1 of kernel parity/layout");
}

#[test]
fn an_array_larger_than_the_device_allows_is_an_error_with_name_and_size() {
    let Some(context) = device::context() else {
        return;
    };
    let size = context.info().limits.allocation + 16;
    let Err(error) = context.buffer("vertices of the moon", size, Place::Device) else { panic!("allocated {size}") };
    let RenderError::TooLarge(text) = error else { panic!("{error:?}") };
    assert!(text.starts_with(&format!("cannot allocate vertices of the moon ({size} bytes): ")), "{text}");
}

#[test]
fn a_storage_buffer_beyond_the_limit_is_an_error_that_names_it() {
    let Some(context) = device::context() else {
        return;
    };
    let limits = context.info().limits;
    if limits.storage_range + 16 > limits.allocation.min(limits.heap) {
        return println!("SKIPPED: no allocation is larger than a storage buffer may be");
    }
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("embedded by build.rs");
    let kernel = context.kernel("parity/layout", words, &Variant::default().constants(), 8).unwrap();
    let buffer = context.buffer("long array", limits.storage_range + 16, Place::Device).unwrap();
    let Err(error) = Bound::new(&kernel, |_, _| vec![buffer.clone()]) else { panic!("bound") };
    assert!(error.to_string().starts_with("long array has "), "{error}");
}

fn scene(nodes: usize, triangles: usize, texels: usize) -> SceneData {
    let shapes =
        Shapes { nodes: counted(nodes), triangles: counted(triangles), top_instances: counted(3), ..Shapes::default() };
    let mut data = SceneArrays { shapes: Arc::new(shapes), texels: counted(texels), ..SceneArrays::default() };
    data.header.first.top_instances = 2;
    data.header.first.texels = 3;
    data.header.first.tables = 3 + texels.div_ceil(4) as u32;
    data.into()
}

#[test]
fn a_scene_is_cut_into_pages_whose_bytes_in_a_row_are_its_arrays() {
    let Some(mut context) = device::context() else {
        return;
    };
    let data = scene(100, 41, 1000);
    for fetch in [FetchChoice::Texel, FetchChoice::Storage] {
        let buffers = SceneBuffers::upload(&mut context, &data, fetch, Some(2000)).unwrap();
        // Pages of 1024 bytes: 8000, 1968 (within one page's limit, so not cut) and 48 + 4000 bytes.
        assert_eq!(buffers.page_counts(), [8, 1, 4]);
        let pages = Variant {
            node_pages: 8,
            triangle_pages: 1,
            data_pages: 4,
            page_shift: 6,
            stack_depth: 1,
            ..Variant::default()
        };
        assert_eq!(buffers.variant(), pages);
        let mut read = |set: usize| -> Vec<u8> {
            let pages = buffers.pages(set).to_vec();
            pages.iter().flat_map(|page| context.download::<u8>(page, 0, page.size() as usize).unwrap()).collect()
        };
        assert!(read(0) == bytemuck::cast_slice::<Node, u8>(&data.shapes.nodes), "nodes");
        assert!(read(1) == bytemuck::cast_slice::<Triangle, u8>(&data.shapes.triangles), "triangles");
        let heap = read(2);
        assert!(
            heap[32..44] == *bytemuck::cast_slice::<u32, u8>(&data.shapes.top_instances),
            "instances of the top level"
        );
        assert!(heap[48..4048] == *bytemuck::cast_slice::<u32, u8>(&data.texels), "texels");
    }
}

#[test]
fn an_empty_scene_has_a_page_of_each_set_to_bind() {
    let Some(mut context) = device::context() else {
        return;
    };
    let buffers = SceneBuffers::upload(&mut context, &SceneData::default(), FetchChoice::Auto, None).unwrap();
    assert_eq!(buffers.page_counts(), [1, 1, 1]);
    assert!((0..3).all(|set| buffers.pages(set)[0].size() >= 16));
}

#[test]
fn a_scene_beyond_eight_pages_is_refused_with_array_size_and_limit() {
    let Some(mut context) = device::context() else {
        return;
    };
    let data = scene(103, 1, 1);
    let Err(error) = SceneBuffers::upload(&mut context, &data, FetchChoice::Auto, Some(1024)) else {
        panic!("8240 bytes in 8 pages of 1024");
    };
    let text = error.to_string();
    let reason = "BVH nodes take 8240 bytes; 8 pages of this device hold 8192 (1024 bytes each at most)";
    assert!(matches!(error, RenderError::TooLarge(_)) && text.contains(reason), "{text}");
}

#[test]
fn the_device_clock_does_not_run_backwards() {
    let Some(mut context) = device::context() else {
        return;
    };
    let buffer = context.buffer("cleared", 1 << 20, Place::Device).unwrap();
    let submission = context
        .submit("clearing", |r| {
            r.timestamp();
            r.clear(&buffer, buffer.size());
            r.timestamp();
        })
        .unwrap();
    match submission.times[..] {
        [] => assert_eq!(context.info().limits.timestamp_bits, 0),
        [first, second] => assert!(first == 0.0 && (0.0..10.0).contains(&second), "{:?}", submission.times),
        _ => panic!("{:?}", submission.times),
    }
}

#[test]
fn only_bindings_that_a_kernel_reaches_are_bound() {
    let words = shaders::kernel("parity/layout", Fetch::Storage).expect("embedded by build.rs");
    let found = bindings(words).unwrap();
    assert_eq!(found.iter().map(|b| (b.set, b.binding, b.count)).collect::<Vec<_>>(), [(0, 0, 1), (0, 1, 1)]);
}

#[test]
fn kernels_bind_no_more_than_devices_are_asked_for() {
    let mut largest = [0; 4];
    for name in shaders::names() {
        for (fetch, at) in [(Fetch::Storage, 0), (Fetch::Texel, 2)] {
            let words = shaders::kernel(name, fetch).expect("listed");
            // A scene of one page of each set, as most are; paths in groups or not, camera rays or others.
            for (shade_grouped, extend_camera) in [(false, false), (false, true), (true, false), (true, true)] {
                let one = Variant { node_pages: 1, triangle_pages: 1, data_pages: 1, ..Variant::default() };
                let variant = Variant { shade_grouped, extend_camera, ..one };
                let found = bindings(&shaders::specialise(words, &variant.constants()).unwrap()).unwrap();
                let count = |kind| found.iter().filter(|b| b.kind == kind).map(|b| b.count).sum::<u32>();
                largest[at] = count(BindingKind::StorageBuffer).max(largest[at]);
                largest[at + 1] = count(BindingKind::TexelBuffer).max(largest[at + 1]);
                // The specification's minimum is 12.
                assert!(count(BindingKind::UniformBuffer) <= 1, "{name} binds {found:?}");
            }
        }
    }
    let needed = [STORAGE_FETCH_STORAGE_BUFFERS, 0, TEXEL_FETCH_STORAGE_BUFFERS, TEXEL_FETCH_TEXEL_BUFFERS];
    assert_eq!(largest, needed, "storage and texel buffers under storage and under texel fetch");
    let shade = bindings(shaders::kernel("shade", Fetch::Texel).expect("embedded")).unwrap();
    assert_eq!(shade[0], Binding { set: 0, binding: 0, kind: BindingKind::UniformBuffer, count: 1 });
    let pages = |(nodes, triangles, data)| {
        let words = shaders::kernel("extend", Fetch::Storage).expect("embedded");
        let words = shaders::specialise(words, &[(1, nodes), (2, triangles), (3, data)]).unwrap();
        bindings(&words).unwrap().iter().filter(|b| b.set == 0).skip(1).map(|b| b.count).collect::<Vec<_>>()
    };
    assert_eq!(pages((1, 1, 1)), [1, 1, 1]);
    assert_eq!(pages((8, 2, 3)), [8, 2, 3]);
}

#[test]
fn the_validation_layer_is_heard() {
    let Some(context) = device::context() else {
        return;
    };
    if !context.is_validated() {
        assert!(!device::is_validation_required(), "GONIO_VALIDATION=1, but the validation layer is not installed");
        return println!("SKIPPED: the validation layer is not installed");
    }
    let messages = context.messages();
    assert_eq!(messages.take(), [""; 0]);
    context.provoke_validation_message();
    let said = messages.take();
    // Its number differs from one version of the layer to the next.
    assert!(said.iter().any(|text| text.contains("VUID-VkBufferCreateInfo-")), "{said:?}");
}

#[test]
#[should_panic(expected = "the validation layers said")]
fn a_validation_message_fails_a_test() {
    let Some(context) = device::context() else { panic!("the validation layers said nothing: no device") };
    if !context.is_validated() {
        panic!("the validation layers said nothing: not installed");
    }
    context.provoke_validation_message();
}

#[test]
#[should_panic(expected = "GONIO_REQUIRE_DEVICE=1, but: none")]
fn a_missing_device_fails_where_one_is_required() {
    device::skip("none", true);
}

#[test]
fn a_machine_without_a_loader_is_told_apart() {
    let Err(error) = Instance::with_loader(Some(Path::new("no-such-folder/libvulkan.so")), false) else {
        panic!("opened a library that is not there");
    };
    assert!(matches!(&error, RenderError::NoDevice(text) if text.contains("no Vulkan loader")), "{error:?}");
}
