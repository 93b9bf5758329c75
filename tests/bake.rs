//! What baking promises: conservative boxes, a bounded stack, nothing lost but what cannot be hit.

mod common;

use common::*;
use glam::{DAffine3, DVec3, Vec3};
use gonio::bake::{BakeError, Baker, SceneData, bake, bake_watched};
use gonio::layout::*;
use gonio::scene::*;
// Not the records of the same names.
use gonio::scene::{Light, Material, Texture};
use gonio::trace::traverse::{stack_used, trace_closest};
use gonio::watch::Watch;
use std::sync::Arc;

fn byte(words: [u32; 2], slot: u32) -> u32 {
    (words[(slot / 4) as usize] >> (8 * (slot % 4))) & 255
}

/// The dequantised box of a child, in double precision.
fn child_box(node: &Node, slot: u32) -> (DVec3, DVec3) {
    let step = [0, 1, 2].map(|axis| f64::from(f32::from_bits(((node.exponents_imask >> (8 * axis)) & 255) << 23)));
    let origin = node.origin.as_dvec3();
    let plane = |x: [u32; 2], y: [u32; 2], z: [u32; 2]| {
        let q = [byte(x, slot), byte(y, slot), byte(z, slot)].map(f64::from);
        origin + DVec3::new(q[0] * step[0], q[1] * step[1], q[2] * step[2])
    };
    (plane(node.min_x, node.min_y, node.min_z), plane(node.max_x, node.max_y, node.max_z))
}

/// Puts every primitive below node `index` of the tree below `root` into `seen` once; checks that all child boxes contain what
/// `bounds` says about the primitives below. Returns the bounds of everything.
fn check_tree(
    data: &SceneData,
    root: u32,
    index: u32,
    bounds: &dyn Fn(u32) -> (DVec3, DVec3),
    seen: &mut Vec<u32>,
) -> (DVec3, DVec3) {
    let node = &data.shapes.nodes[index as usize];
    let inner_mask = node.exponents_imask >> 24;
    let mut all = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for slot in 0..8 {
        let meta = byte(node.child_meta, slot);
        if meta == 0 {
            continue;
        }
        let inside = if inner_mask & (1 << slot) != 0 {
            assert_eq!(meta, 0b0010_0000 | (24 + slot));
            check_tree(data, root, root + (node.children >> 8) + slot - 7, bounds, seen)
        } else {
            let count = (meta >> 5).count_ones();
            assert!(count <= 3);
            let first = node.primitive_base + (meta & 31);
            (first..first + count).fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                seen.push(p);
                let (l, h) = bounds(p);
                (low.min(l), high.max(h))
            })
        };
        let (low, high) = child_box(node, slot);
        assert!(low.cmple(inside.0).all() && high.cmpge(inside.1).all(), "{low}..{high} loses {inside:?}");
        all = (all.0.min(inside.0), all.1.max(inside.1));
    }
    all
}

/// Checks the top level and the trees of all instances.
fn check_scene(data: &SceneData) {
    let world = |place: u32| {
        let instance = &data.instances[data.shapes.top_instances[place as usize] as usize];
        let points: Vec<DVec3> = if instance.kind == KIND_SPHERE {
            // Points of the sphere in object space.
            let mut random = Random::new(1);
            (0..50).map(|_| random.direction().as_dvec3()).collect()
        } else {
            let mut seen = Vec::new();
            check_tree(
                data,
                instance.root,
                instance.root,
                &|p| triangle_bounds(&data.shapes.triangles[p as usize]),
                &mut seen,
            );
            let mut once = seen.clone();
            once.sort_unstable();
            once.dedup();
            assert_eq!(once.len(), seen.len(), "a triangle stands in two leaves");
            let corners = |&p: &u32| {
                let t = &data.shapes.triangles[p as usize];
                [t.v0.as_dvec3(), t.v1.as_dvec3(), t.v2.as_dvec3()]
            };
            seen.iter().flat_map(corners).collect()
        };
        let m = instance.to_world.map(|row| row.as_dvec4());
        let to_world = |p: DVec3| {
            let p = p.extend(1.0);
            DVec3::new(m[0].dot(p), m[1].dot(p), m[2].dot(p))
        };
        points
            .into_iter()
            .map(to_world)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    };
    let mut seen = Vec::new();
    check_tree(data, data.header.top_root, data.header.top_root, &world, &mut seen);
    seen.sort_unstable();
    assert_eq!(seen, (0..data.instances.len() as u32).collect::<Vec<_>>());
}

fn triangle_bounds(t: &Triangle) -> (DVec3, DVec3) {
    let [a, b, c] = [t.v0.as_dvec3(), t.v1.as_dvec3(), t.v2.as_dvec3()];
    (a.min(b).min(c), a.max(b).max(c))
}

#[test]
fn every_child_box_contains_what_lies_below() {
    let mut random = Random::new(1);
    let mut scene = scene_of(vec![globe(20), soup(&mut random, 900, 0.01), soup(&mut random, 900, 2.0)]);
    for _ in 0..40 {
        let scale = DVec3::new(0.001, 1.0, 1000.0) * f64::from(random.range(0.5, 2.0));
        let placed = Transform(DAffine3::from_scale(scale))
            .then(Transform::rotate(random.direction(), 1.0))
            .then(Transform::translate(random.point(500.0)));
        scene.objects.push(object(Geometry::Sphere, placed));
        scene.objects.push(object(Geometry::Mesh(MeshId(0)), placed));
    }
    // One flat mesh far from the origin, where floats are coarse.
    let mut flat = soup(&mut random, 200, 0.1);
    flat.positions.iter_mut().for_each(|p| *p = Vec3::new(p.x + 1000.0, p.y, 77.7));
    scene.meshes.push(flat);
    scene.objects.push(object(Geometry::Mesh(MeshId(3)), Transform::default()));
    check_scene(&bake(&scene).expect("bakes"));
}

/// More triangles than one part of a hierarchy holds, small, large and in clusters.
fn crowd() -> Mesh {
    let mut random = Random::new(7);
    let mut crowd = soup(&mut random, 70_000, 0.01);
    for other in [soup(&mut random, 300, 3.0), globe(80)] {
        let base = crowd.positions.len() as u32;
        crowd.positions.extend(&other.positions);
        crowd.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| base + corner)));
    }
    crowd.normals.clear();
    crowd
}

#[test]
fn a_mesh_of_several_parts_loses_nothing() {
    let data = bake(&scene_of(vec![crowd()])).expect("bakes");
    assert!(data.shapes.triangles.len() > 1 << 16, "{}", data.shapes.triangles.len());
    let mut found: Vec<u32> = data.shapes.triangles.iter().map(|triangle| triangle.primitive).collect();
    found.sort_unstable();
    found.dedup();
    assert_eq!(found.len(), data.shapes.triangles.len());
    check_scene(&data);
}

#[test]
fn any_number_of_threads_bakes_the_same_arrays() {
    let scene = scene_of(vec![crowd(), globe(20)]);
    let baked = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| bake(&scene).expect("bakes"))
    };
    let one = baked(1);
    for threads in [2, 5] {
        let other = baked(threads);
        assert_eq!(one.digest(), other.digest());
        let (one, other) = (&one.shapes, &other.shapes);
        assert!(one.nodes == other.nodes && one.triangles == other.triangles, "{threads} threads");
        assert!(one.faces == other.faces && one.vertices == other.vertices, "{threads} threads");
        assert_eq!(one.stack_depth, other.stack_depth);
    }
}

#[test]
fn a_bake_that_is_to_stop_stops_and_one_that_is_watched_tells_of_every_triangle_twice() {
    use std::sync::atomic::{AtomicI64, Ordering};
    let scene = scene_of(vec![crowd()]);
    let watch = Watch::default();
    let data = bake_watched(&scene, &watch).expect("bakes");
    // And of its one instance.
    assert_eq!(watch.done(), 2 * (data.shapes.triangles.len() as u64 + 1));
    let told = AtomicI64::new(0);
    let tell = |steps| {
        told.fetch_add(steps, Ordering::Relaxed);
    };
    let asked = || told.load(Ordering::Relaxed) > 20_000;
    let watch = Watch::default().asking(&asked).telling(&tell);
    let stopped = bake_watched(&scene, &watch);
    assert!(matches!(stopped, Err(BakeError::Aborted)), "{stopped:?}");
    // Asked between pieces of work, so it may take a few more, but not all.
    assert!(watch.done() < 2 * data.shapes.triangles.len() as u64);
}

#[test]
fn no_ray_needs_more_stack_than_baking_says() {
    let mut random = Random::new(2);
    for mesh in [globe(30), soup(&mut random, 3000, 0.3), cascade(380, 0.9)] {
        let mut scene = scene_of(vec![mesh]);
        for i in 0..30 {
            let shift = Transform::translate(random.point(0.3));
            scene.objects.push(object(if i % 5 == 0 { Geometry::Sphere } else { Geometry::Mesh(MeshId(0)) }, shift));
        }
        let data = bake(&scene).expect("bakes");
        assert!(data.shapes.stack_depth <= STACK_SIZE);
        let mut worst = 0;
        for i in 0..3000 {
            // Every other ray runs up the cascade, from its narrow end, inside the cone of its clusters.
            let aimed = random.ray(2.0);
            let cone = Vec3::new(1.0, random.range(0.0, 0.024), random.range(0.0, 0.004)).normalize();
            let up = ray(cone * -1e-3, cone);
            worst = worst.max(stack_used(&data.view(), if i % 2 == 0 { &aimed } else { &up }));
        }
        assert!(worst <= data.shapes.stack_depth, "{worst} of {}", data.shapes.stack_depth);
        // The bound is no empty promise: rays come close to it.
        assert!(worst * 2 >= data.shapes.stack_depth, "{worst} of {}", data.shapes.stack_depth);
    }
}

#[test]
fn an_empty_scene_bakes_and_is_missed() {
    let mut scene = empty_scene();
    scene.meshes.push(Mesh { name: "nothing".into(), ..Mesh::default() });
    scene.objects.push(object(Geometry::Mesh(MeshId(0)), Transform::default()));
    let data = bake(&scene).expect("bakes");
    assert_eq!((data.header.top_root, data.header.instance_count, data.shapes.stack_depth), (INVALID, 0, 0));
    assert_eq!(trace_closest(&data.view(), &ray(Vec3::ZERO, Vec3::X)).instance, INVALID);
}

#[test]
fn what_cannot_be_hit_is_dropped_with_one_warning_and_keeps_its_number() {
    let mut mesh = Mesh { name: "bad".into(), ..Mesh::default() };
    mesh.positions = vec![
        Vec3::ZERO,
        Vec3::X,
        Vec3::Y,
        Vec3::new(f32::NAN, 0.0, 0.0),
        Vec3::new(0.0, f32::INFINITY, 0.0),
        Vec3::new(2.0, 0.0, 0.0),
    ];
    mesh.triangles = vec![[0, 1, 3], [0, 1, 5], [4, 1, 2], [1, 1, 2], [0, 1, 2]];
    let data = bake(&scene_of(vec![mesh])).expect("bakes");
    let warning = "mesh \"bad\": dropped triangles: 2 with coordinates that are not finite and 2 without area";
    assert_eq!(data.warnings, [warning]);
    assert_eq!((data.shapes.triangles.len(), data.shapes.faces.len()), (1, 5));
    let hit = trace_closest(&data.view(), &ray(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z));
    assert!((hit.t - 1.0).abs() < 1e-6 && hit.primitive == 4, "{hit:?}");
    assert!(data.shapes.vertices.iter().all(|v| v.position.is_finite() && v.normal.is_finite()));
}

#[test]
fn triangles_that_many_meshes_drop_are_told_in_one_line() {
    let flat = |name: &str, count: usize| Mesh {
        name: name.into(),
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y],
        triangles: [vec![[0, 1, 2]], vec![[0, 1, 1]; count]].concat(),
        ..Mesh::default()
    };
    let data = bake(&scene_of(vec![flat("a", 2), flat("good", 0), flat("b", 3)])).expect("bakes");
    assert_eq!(data.warnings, ["2 meshes: dropped triangles: 5 without area"]);
}

#[test]
fn instances_share_what_they_show() {
    let mut scene = scene_of(vec![globe(6)]);
    let alone = bake(&scene).expect("bakes");
    for i in 1..5 {
        let shift = Transform::translate(Vec3::splat(i as f32));
        scene.objects.push(object(Geometry::Mesh(MeshId(0)), shift));
    }
    let data = bake(&scene).expect("bakes");
    let sizes = |d: &SceneData| (d.shapes.triangles.len(), d.shapes.faces.len(), d.shapes.vertices.len());
    assert_eq!(sizes(&data), sizes(&alone));
    assert!(data.instances.iter().all(|i| i.root == data.instances[0].root));
}

#[test]
fn the_heap_has_every_array_where_the_header_says() {
    let mut scene = scene_of(vec![globe(4)]);
    scene.film.filter = Filter::Mitchell { radius: 2.0, b: 1.0 / 3.0, c: 1.0 / 3.0 };
    scene.textures.push(Texture {
        wrap_v: Wrap::Clamp,
        ..Texture::new(
            "t",
            3,
            1,
            TextureData::Srgb8(std::sync::Arc::new(vec![[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]])),
        )
    });
    let data = bake(&scene).expect("bakes");
    let h = &data.header;
    let first: [u32; 12] = bytemuck::cast(h.first);
    let arrays = data.view().heap();
    let end = |at: usize| first[at] + arrays[at].len().div_ceil(16) as u32;
    assert_eq!(first[0], 0);
    assert!((1..12).all(|at| first[at] == end(at - 1)), "{first:?}");
    assert_eq!(data.heap_words(), u64::from(end(11)));
    assert_eq!((h.first.texels, arrays[8]), (first[8], &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12][..]));
    // The sRGB table comes first, then the filter's.
    assert_eq!((data.tables[255], h.filter_table, data.features.filter), (1.0, 256, FILTER_TABLE));
    assert_eq!(data.tables.len() as u32, 256 + 2 * FILTER_KNOTS + 1);
}

#[test]
fn the_camera_spans_the_field_of_view() {
    let mut scene = scene_of(vec![globe(4)]);
    scene.camera.projection = Projection::Perspective { fov_y: std::f32::consts::FRAC_PI_2 };
    let camera = bake(&scene).expect("bakes").header.camera;
    // 64 x 32 pixels, 90 degrees high, looking along -z.
    assert!((camera.up - Vec3::Y).length() < 1e-6 && (camera.right - Vec3::X * 2.0).length() < 1e-6);
    assert_eq!((camera.forward, camera.scale_x, camera.scale_y), (Vec3::NEG_Z, 2.0 / 64.0, 2.0 / 32.0));
    scene.camera.projection = Projection::Orthographic { height: 3.0 };
    let camera = bake(&scene).expect("bakes").header.camera;
    assert_eq!((camera.kind, camera.up, camera.right), (CAMERA_ORTHOGRAPHIC, Vec3::Y * 1.5, Vec3::X * 3.0));
    scene.camera.target = scene.camera.eye;
    assert!(matches!(bake(&scene), Err(BakeError::Camera(_))));
    scene.camera.target = scene.camera.eye + Vec3::Y;
    assert!(matches!(bake(&scene), Err(BakeError::Camera(_))));
}

#[test]
fn lecture_intensities_are_multiplied_by_pi() {
    let mut scene = scene_of(vec![globe(4)]);
    let light = |unit| Light {
        name: "lamp".into(),
        kind: LightKind::Spot {
            position: Vec3::Y,
            direction: Vec3::NEG_Y * 2.0,
            inner: 0.2,
            outer: 0.4,
            exponent: 3.0,
        },
        intensity: Vec3::new(1.0, 2.0, 4.0),
        unit,
        attenuation: Attenuation::Polynomial { c1: 1.0, c2: 0.5, c3: 0.25 },
        flaps: Flaps::NONE,
        casts_shadow: true,
        slide: None,
    };
    scene.lights = vec![light(IntensityUnit::Lecture), light(IntensityUnit::Radiometric)];
    let lights = bake(&scene).expect("bakes").lights.clone();
    assert_eq!(lights[0].intensity, Vec3::new(1.0, 2.0, 4.0) * std::f32::consts::PI);
    assert_eq!(lights[1].intensity, Vec3::new(1.0, 2.0, 4.0));
    assert_eq!((lights[1].direction, lights[1].kind, lights[1].casts_shadow), (Vec3::NEG_Y, LIGHT_SPOT, 1));
    assert!((lights[1].cos_inner - 0.2f32.cos()).abs() < 1e-6 && (lights[1].cos_outer - 0.4f32.cos()).abs() < 1e-6);
    assert_eq!((lights[1].attenuation, lights[1].c), (ATTENUATION_POLYNOMIAL, Vec3::new(1.0, 0.5, 0.25)));
}

#[test]
fn panes_cast_no_shadow_unless_told_to() {
    let mut scene = scene_of(vec![globe(4)]);
    let no_shadow = |scene: &Scene| bake(scene).expect("bakes").instances[0].flags & INSTANCE_NO_SHADOW != 0;
    assert!(!no_shadow(&scene));
    scene.materials[0].transparency = Some(Transparency::Interpolated { k_t: 0.5 });
    assert!(no_shadow(&scene));
    scene.materials[0].casts_shadow = Some(true);
    assert!(!no_shadow(&scene));
    scene.objects[0].casts_shadow = Some(false);
    assert!(no_shadow(&scene));
    // By faces: all of them must be panes; a mixture casts, and says so.
    scene.objects[0].casts_shadow = None;
    scene.objects[0].material = None;
    scene.materials[0].casts_shadow = None;
    let faces = scene.meshes[0].triangles.len();
    scene.meshes[0].face_materials = vec![MaterialId(0); faces];
    assert!(no_shadow(&scene));
    scene.materials.push(Material::grey("wall"));
    scene.meshes[0].face_materials[0] = MaterialId(1);
    assert!(!no_shadow(&scene));
    assert_eq!(bake(&scene).expect("bakes").warnings.len(), 1);
}

#[test]
fn what_single_precision_cannot_carry_is_refused() {
    let bad = |transform: Transform| {
        let mut scene = scene_of(vec![globe(4)]);
        scene.objects[0].transform = transform;
        matches!(bake(&scene), Err(BakeError::Placement { .. }))
    };
    assert!(!bad(Transform::scale(Vec3::splat(1e8))) && !bad(Transform::scale(Vec3::splat(1e-8))));
    assert!(bad(Transform::scale(Vec3::splat(1e12))) && bad(Transform::scale(Vec3::splat(1e-12))));
    assert!(bad(Transform::translate(Vec3::splat(1e12))) && bad(Transform::translate(Vec3::splat(f32::NAN))));
    let mut scene = scene_of(vec![globe(4)]);
    scene.film.unit_exponent = 200;
    assert!(matches!(bake(&scene), Err(BakeError::FilmUnit(200))));
}

#[test]
fn rays_have_a_level_for_each_depth_only_where_they_branch() {
    let mut scene = scene_of(vec![globe(4)]);
    scene.settings.max_depth = 7;
    let levels = |scene: &Scene| bake(scene).expect("bakes").header.level_count;
    scene.materials[0].transparency = Some(Transparency::Interpolated { k_t: 0.5 });
    scene.settings.integrator = Integrator::Path;
    assert_eq!(levels(&scene), 1, "path");
    scene.settings.integrator = Integrator::Whitted;
    assert_eq!(levels(&scene), 8, "a pane");
    scene.materials[0].transparency = None;
    scene.materials[0].k_r = 0.5;
    assert_eq!(levels(&scene), 1, "a mirror");
    scene.materials[0].model = Model::Dielectric { eta: 1.5, absorption: Vec3::ZERO };
    assert_eq!(levels(&scene), 8, "glass");
}

#[test]
fn scenes_that_differ_in_camera_film_integrator_or_materials_share_their_shapes() {
    let mut scene = scene_of(vec![globe(8)]);
    scene.objects.push(object(Geometry::Sphere, Transform::translate(Vec3::X)));
    let mut baker = Baker::default();
    let first = baker.bake(&scene, &Watch::default()).expect("bakes");
    let mut other = scene.clone();
    (other.film.width, other.camera.eye) = (99, Vec3::new(1.0, 2.0, 3.0));
    other.settings.integrator = Integrator::Path;
    other.objects[0].casts_shadow = Some(false);
    other.materials.iter_mut().for_each(|material| material.color = Rgb::splat(0.25));
    let second = baker.bake(&other, &Watch::default()).expect("bakes");
    assert!(Arc::ptr_eq(&first.shapes, &second.shapes), "baked again");
    assert_eq!(second.times.binary_s, 0.0, "the time was spent once");
    // As if it had been baked alone.
    assert_eq!(second.digest(), bake(&other).expect("bakes").digest());
    assert_ne!(second.digest(), first.digest());
    // Each of these is another shape.
    let changes: [fn(&mut Scene); 6] = [
        |scene| scene.objects[0].transform = Transform::translate(Vec3::Z),
        |scene| scene.objects.truncate(1),
        |scene| scene.meshes[0].positions[0] *= 2.0,
        |scene| scene.meshes[0].uvs = vec![glam::Vec2::ONE; scene.meshes[0].positions.len()],
        |scene| scene.meshes[0].triangles.truncate(5),
        |scene| scene.meshes[0].face_materials = vec![MaterialId(0); scene.meshes[0].triangles.len()],
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let mut changed = scene.clone();
        change(&mut changed);
        let mut baker = Baker::after(&scene, &first);
        let baked = baker.bake(&changed, &Watch::default()).expect("bakes");
        assert!(!Arc::ptr_eq(&first.shapes, &baked.shapes), "change {number}");
        assert_eq!(baked.digest(), bake(&changed).expect("bakes").digest(), "change {number}");
    }
}

#[test]
fn keeping_auxiliary_values_changes_no_digest_and_leaving_the_background_out_does() {
    let scene = scene_of(vec![globe(4)]);
    let digest = |change: fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        bake(&scene).expect("bakes").digest()
    };
    let plain = digest(|_| ());
    assert_eq!(digest(|scene| scene.settings.aovs = true), plain);
    assert_ne!(digest(|scene| scene.settings.transparent = true), plain);
}
