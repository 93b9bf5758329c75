//! The scene on the device: header, and three sets of pages (nodes, triangles, everything else).

use super::context::Context;
use super::device::{
    DeviceInfo, DeviceKind, Limits, STORAGE_FETCH_STORAGE_BUFFERS, TEXEL_FETCH_STORAGE_BUFFERS,
    TEXEL_FETCH_TEXEL_BUFFERS,
};
use super::memory::{Buffer, Place};
use crate::bake::SceneData;
use crate::layout::{BINDING_DATA, BINDING_HEADER, BINDING_NODES, BINDING_TRIANGLES, HeapStarts, Variant};
use crate::render::RenderError;
use crate::shaders::Fetch;

/// Pages a set may have.
const MAX_PAGES: u64 = crate::layout::MAX_PAGES as u64;
/// Arrays in the data heap.
const HEAP_ARRAYS: usize = size_of::<HeapStarts>() / size_of::<u32>();
/// Bytes of the word in which pages are fetched.
const WORD: u64 = 16;
const SET_NAMES: [&str; 3] = ["BVH nodes", "triangles", "scene data"];

/// How kernels read the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FetchChoice {
    /// Texel buffers where the device is a CPU, storage buffers elsewhere; the other where the first cannot hold the scene.
    #[default]
    Auto,
    Texel,
    Storage,
}

/// How the sets are cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct PagePlan {
    /// log2 of the words of a page.
    shift: u32,
    /// Pages of each set, 1 to `MAX_PAGES`.
    counts: [u64; 3],
}

/// Cuts sets of `words` words into pages of at most `limit` bytes; the error names array, size and limit.
fn plan_pages(words: [u64; 3], limit: u64) -> Result<PagePlan, String> {
    let page = (limit / WORD).max(1);
    let shift = page.ilog2().min(31);
    let mut counts = [1; 3];
    for ((count, words), name) in counts.iter_mut().zip(words).zip(SET_NAMES) {
        // A set that fits as a whole is not cut, though the limit is no power of two.
        if words > page {
            *count = words.div_ceil(1 << shift);
        }
        if *count > MAX_PAGES || words > u64::from(u32::MAX) {
            let most = (MAX_PAGES << shift).min(u64::from(u32::MAX)) * WORD;
            return Err(format!(
                "{name} take {} bytes; {MAX_PAGES} pages of this device hold {most} ({limit} bytes each at most)",
                words * WORD
            ));
        }
    }
    Ok(PagePlan { shift, counts })
}

/// The heap's arrays: place of the first byte's word, and the bytes.
fn heap_parts(data: &SceneData) -> [(u32, &[u8]); HEAP_ARRAYS] {
    let starts: [u32; HEAP_ARRAYS] = bytemuck::cast(data.header.first);
    let arrays = data.view().heap();
    std::array::from_fn(|k| (starts[k], arrays[k]))
}

/// Largest page in bytes under a way of fetching.
fn page_bytes(info: &DeviceInfo, fetch: Fetch, page_limit: Option<u64>) -> u64 {
    let binding = match fetch {
        Fetch::Texel => info.limits.texel_elements.saturating_mul(WORD),
        Fetch::Storage => info.limits.storage_range,
    };
    binding.min(info.limits.allocation).min(page_limit.unwrap_or(u64::MAX))
}

/// An error if a device cannot bind as many `pages`.
fn check_bindings(limits: &Limits, fetch: Fetch, pages: u64) -> Result<(), String> {
    let more = u32::try_from(pages).unwrap_or(u32::MAX).saturating_sub(SET_NAMES.len() as u32);
    let needed = match fetch {
        Fetch::Storage => {
            vec![(STORAGE_FETCH_STORAGE_BUFFERS.saturating_add(more), "storage", limits.stage_storage_buffers)]
        }
        Fetch::Texel => vec![
            (TEXEL_FETCH_STORAGE_BUFFERS, "storage", limits.stage_storage_buffers),
            (TEXEL_FETCH_TEXEL_BUFFERS.saturating_add(more), "texel", limits.stage_texel_buffers),
        ],
    };
    match needed.into_iter().find(|(needed, _, limit)| needed > limit) {
        Some((needed, name, limit)) => Err(format!(
            "kernels bind {needed} {name} buffers for a scene of {pages} pages; this device allows {limit}"
        )),
        None => Ok(()),
    }
}

/// Chooses the way of fetching and the pages.
fn choose(
    info: &DeviceInfo,
    choice: FetchChoice,
    words: [u64; 3],
    page_limit: Option<u64>,
) -> Result<(Fetch, PagePlan), RenderError> {
    let order: &[Fetch] = match choice {
        FetchChoice::Auto if info.kind == DeviceKind::Cpu => &[Fetch::Texel, Fetch::Storage],
        FetchChoice::Auto => &[Fetch::Storage, Fetch::Texel],
        FetchChoice::Texel => &[Fetch::Texel],
        FetchChoice::Storage => &[Fetch::Storage],
    };
    let mut reasons = Vec::new();
    for &fetch in order {
        let name = match fetch {
            Fetch::Texel => "texel",
            Fetch::Storage => "storage",
        };
        let plan = plan_pages(words, page_bytes(info, fetch, page_limit))
            .and_then(|plan| check_bindings(&info.limits, fetch, plan.counts.iter().sum()).map(|()| plan));
        match plan {
            Ok(plan) => return Ok((fetch, plan)),
            Err(reason) => reasons.push(format!("{name} buffers: {reason}")),
        }
    }
    Err(RenderError::TooLarge(format!("the scene does not fit: {}", reasons.join("; "))))
}

/// Words of each set: nodes, triangles, scene data.
fn set_words(data: &SceneData) -> [u64; 3] {
    let words = |bytes: usize| (bytes as u64).div_ceil(WORD);
    let heap = heap_parts(data).map(|(first, bytes)| u64::from(first) + words(bytes.len()));
    [
        words(size_of_val(&data.shapes.nodes[..])),
        words(size_of_val(&data.shapes.triangles[..])),
        heap.into_iter().max().unwrap_or(0),
    ]
}

/// An error that says why a device cannot hold the scene where kernels fetch it as `choice` says. Nothing is opened.
pub fn check_fit(info: &DeviceInfo, data: &SceneData, choice: FetchChoice) -> Result<(), RenderError> {
    choose(info, choice, set_words(data), None).map(|_| ())
}

/// The scene's buffers.
pub struct SceneBuffers {
    header: Buffer,
    sets: [Vec<Buffer>; 3],
    shift: u32,
    stack_depth: u32,
    fetch: Fetch,
}

impl SceneBuffers {
    /// Uploads the scene. `page_limit` lowers the bytes of a page, for tests.
    pub fn upload(
        context: &mut Context,
        data: &SceneData,
        choice: FetchChoice,
        page_limit: Option<u64>,
    ) -> Result<SceneBuffers, RenderError> {
        let nodes: &[u8] = bytemuck::cast_slice(&data.shapes.nodes);
        let triangles: &[u8] = bytemuck::cast_slice(&data.shapes.triangles);
        let heap = heap_parts(data);
        let sets: [&[(u32, &[u8])]; 3] = [&[(0, nodes)], &[(0, triangles)], &heap];
        let words = set_words(data);
        let (fetch, plan) = choose(context.info(), choice, words, page_limit)?;

        let header = context.buffer("scene header", size_of_val(&data.header) as u64, Place::Device)?;
        context.upload(&header, 0, bytemuck::bytes_of(&data.header))?;
        let mut buffers = [Vec::new(), Vec::new(), Vec::new()];
        for (set, buffers) in buffers.iter_mut().enumerate() {
            let page_words = if plan.counts[set] == 1 { words[set] } else { 1 << plan.shift };
            for page in 0..plan.counts[set] {
                let size = page_words.min(words[set] - page * page_words) * WORD;
                let name = format!("{} (page {} of {})", SET_NAMES[set], page + 1, plan.counts[set]);
                buffers.push(context.buffer(&name, size, Place::Device)?);
            }
            for (first, bytes) in sets[set] {
                upload_part(context, buffers, page_words * WORD, u64::from(*first) * WORD, bytes)?;
            }
        }
        let stack_depth = data.shapes.stack_depth.max(1);
        Ok(SceneBuffers { header, sets: buffers, shift: plan.shift, stack_depth, fetch })
    }

    pub fn fetch(&self) -> Fetch {
        self.fetch
    }

    /// Pages of nodes, triangles and data.
    pub fn page_counts(&self) -> [usize; 3] {
        self.sets.each_ref().map(Vec::len)
    }

    /// Pages of one set: 0 nodes, 1 triangles, 2 data.
    pub fn pages(&self, set: usize) -> &[Buffer] {
        &self.sets[set]
    }

    /// What a kernel that reads the scene is compiled for.
    pub fn variant(&self) -> Variant {
        let [node_pages, triangle_pages, data_pages] = self.page_counts().map(|count| count as u32);
        let (page_shift, stack_depth) = (self.shift, self.stack_depth);
        Variant { node_pages, triangle_pages, data_pages, page_shift, stack_depth, ..Variant::default() }
    }

    /// The buffers of a binding of the scene's set.
    pub fn find(&self, binding: u32) -> Vec<Buffer> {
        match binding {
            BINDING_HEADER => vec![self.header.clone()],
            BINDING_NODES => self.sets[0].clone(),
            BINDING_TRIANGLES => self.sets[1].clone(),
            BINDING_DATA => self.sets[2].clone(),
            _ => Vec::new(),
        }
    }
}

/// Writes `bytes` from byte `at` of a set on, across its pages of `page` bytes.
fn upload_part(
    context: &mut Context,
    pages: &[Buffer],
    page: u64,
    mut at: u64,
    mut bytes: &[u8],
) -> Result<(), RenderError> {
    while !bytes.is_empty() {
        let within = at % page;
        let (now, later) = bytes.split_at((page - within).min(bytes.len() as u64) as usize);
        context.upload(&pages[(at / page) as usize], within, now)?;
        at += now.len() as u64;
        bytes = later;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_that_fits_is_not_cut_though_the_limit_is_no_power_of_two() {
        let plan = plan_pages([100, 3, 0], 100 * 16).unwrap();
        assert_eq!(plan, PagePlan { shift: 6, counts: [1, 1, 1] });
    }

    #[test]
    fn pages_are_powers_of_two_within_the_limit() {
        let plan = plan_pages([101, 64, 512], 100 * 16 + 5).unwrap();
        assert_eq!(plan, PagePlan { shift: 6, counts: [2, 1, 8] });
    }

    #[test]
    fn a_device_of_the_roadmap_profile_binds_every_page_and_a_smaller_one_says_how_many_are_too_many() {
        let limits =
            |storage, texel| Limits { stage_storage_buffers: storage, stage_texel_buffers: texel, ..Limits::default() };
        for fetch in [Fetch::Storage, Fetch::Texel] {
            assert_eq!(check_bindings(&limits(30, 30), fetch, 24), Ok(()), "{fetch:?}");
        }
        assert_eq!(check_bindings(&limits(16, 0), Fetch::Storage, 11), Ok(()));
        let error = check_bindings(&limits(16, 0), Fetch::Storage, 12).unwrap_err();
        assert_eq!(error, "kernels bind 17 storage buffers for a scene of 12 pages; this device allows 16");
        let error = check_bindings(&limits(4, 100), Fetch::Texel, 3).unwrap_err();
        assert_eq!(error, "kernels bind 5 storage buffers for a scene of 3 pages; this device allows 4");
        let error = check_bindings(&limits(16, 16), Fetch::Texel, 16).unwrap_err();
        assert_eq!(error, "kernels bind 17 texel buffers for a scene of 16 pages; this device allows 16");
    }

    #[test]
    fn a_set_of_nine_pages_is_refused_with_its_name_and_size() {
        let error = plan_pages([1, 513, 1], 64 * 16).unwrap_err();
        assert_eq!(error, "triangles take 8208 bytes; 8 pages of this device hold 8192 (1024 bytes each at most)");
    }
}
