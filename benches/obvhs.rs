//! Traces what `gonio bench --export-rays` wrote with obvhs's own CwBvh traversal and triangle test, on all cores.
//!
//! `cargo bench --bench obvhs -- [--runs N] [--warmup N] FOLDER...` prints one line a run, tab-separated: scene, kind of
//! rays, `obvhs`, millions of rays a second. The share of rays that hit the same triangle as gonio's goes to stderr: obvhs's
//! boxes are not conservative, and its triangle test is not watertight. Triangles only; scenes with spheres are left out.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use rayon::prelude::*;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// Kinds of rays, and whether any hit will do.
const KINDS: [(&str, bool); 5] =
    [("primary", false), ("diffuse", false), ("second", false), ("occlusion", true), ("shadow", true)];
const NONE: u32 = u32::MAX;
/// Rays a thread takes at a time, as gonio's CPU backend does.
const CHUNK: usize = 1024;

/// Triangles in traversal order with (instance, primitive) of each.
struct Tracer {
    bvh: CwBvh,
    triangles: Vec<RtTriangle>,
    ids: Vec<[u32; 2]>,
}

impl Tracer {
    /// `ids`: instance, primitive, whether it casts shadows; those that do not are left out if `casting_only`.
    fn build(corners: &[[f32; 9]], ids: &[[u32; 3]], casting_only: bool) -> Self {
        let kept: Vec<usize> = (0..ids.len()).filter(|&i| !casting_only || ids[i][2] != 0).collect();
        let triangle = |&i: &usize| {
            let corner = |k: usize| Vec3A::from_slice(&corners[i][3 * k..]);
            Triangle { v0: corner(0), v1: corner(1), v2: corner(2) }
        };
        let triangles: Vec<Triangle> = kept.iter().map(triangle).collect();
        let bvh = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
        let order = bvh.primitive_indices.iter().map(|&i| i as usize);
        let ids = order.clone().map(|i| [ids[kept[i]][0], ids[kept[i]][1]]).collect();
        let triangles = order.map(|i| RtTriangle::from(&triangles[i])).collect();
        Self { bvh, triangles, ids }
    }

    /// Instance and primitive of the closest hit, or `NONE` twice; of any-hit rays 1 or 0 first.
    fn trace(&self, words: &[f32; 8], any: bool) -> [u32; 2] {
        let ray = Ray::new(Vec3A::from_slice(words), Vec3A::from_slice(&words[4..]), words[3], words[7]);
        if any {
            let missed = self.bvh.ray_traverse_miss(ray, |ray, id| self.triangles[id].intersect(ray));
            return [u32::from(!missed), 0];
        }
        let mut hit = RayHit::none();
        match self.bvh.ray_traverse(ray, &mut hit, |ray, id| self.triangles[id].intersect(ray)) {
            true => self.ids[hit.primitive_id as usize],
            false => [NONE; 2],
        }
    }
}

fn read<T: bytemuck::Pod>(path: &Path) -> io::Result<Vec<T>> {
    let bytes = std::fs::read(path).map_err(|error| io::Error::other(format!("{}: {error}", path.display())))?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}

fn bench(folder: &Path, runs: usize, warmup: usize) -> io::Result<()> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    if !read::<[u32; 2]>(&folder.join("spheres.u32"))?.is_empty() {
        eprintln!("{name}: obvhs: left out, the scene has spheres");
        return Ok(());
    }
    let corners: Vec<[f32; 9]> = read(&folder.join("triangles.f32"))?;
    let ids: Vec<[u32; 3]> = read(&folder.join("triangles.u32"))?;
    let start = Instant::now();
    let closest = Tracer::build(&corners, &ids, false);
    eprintln!("{name}: obvhs: build {:.4} s", start.elapsed().as_secs_f64());
    let all_cast = ids.iter().all(|id| id[2] != 0);
    let casting = (!all_cast).then(|| Tracer::build(&corners, &ids, true));
    for (kind, any) in KINDS {
        let rays: Vec<[f32; 8]> = match read(&folder.join(format!("{kind}.rays.f32"))) {
            Ok(rays) if !rays.is_empty() => rays,
            _ => continue,
        };
        let tracer = casting.as_ref().filter(|_| any).unwrap_or(&closest);
        let mut found = vec![[0; 2]; rays.len()];
        for turn in 0..warmup + runs {
            let start = Instant::now();
            rays.par_chunks(CHUNK).zip(found.par_chunks_mut(CHUNK)).for_each(|(rays, found)| {
                for (ray, found) in rays.iter().zip(found) {
                    *found = tracer.trace(ray, any);
                }
            });
            if turn >= warmup {
                println!("{name}\t{kind}\tobvhs\t{:.4}", rays.len() as f64 / start.elapsed().as_secs_f64() * 1e-6);
            }
        }
        let words: Vec<u32> = read(&folder.join(format!("{kind}.hits.u32")))?;
        let same = match any {
            true => words.iter().zip(&found).filter(|(hit, found)| **hit == found[0]).count(),
            false => words
                .chunks(2)
                .zip(&found)
                .filter(|(hit, found)| hit[0] == found[0] && (hit[0] == NONE || hit[1] == found[1]))
                .count(),
        };
        eprintln!("{name}: obvhs: {kind}: {:.4} % as gonio's", 100.0 * same as f64 / rays.len() as f64);
    }
    Ok(())
}

fn main() -> io::Result<()> {
    let (mut runs, mut warmup, mut folders) = (5, 1, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut number =
            || arguments.next().and_then(|text| text.parse().ok()).ok_or_else(|| io::Error::other("expected a number"));
        match argument.as_str() {
            "--runs" => runs = number()?,
            "--warmup" => warmup = number()?,
            "--bench" => {} // cargo's own
            _ => folders.push(argument),
        }
    }
    if folders.is_empty() {
        eprintln!("usage: cargo bench --bench obvhs -- [--runs N] [--warmup N] FOLDER...");
    }
    folders.iter().try_for_each(|folder| bench(Path::new(folder), runs, warmup))
}
