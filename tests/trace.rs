//! The traversal against brute force: the same bits and ids, whatever the shape of the hierarchy.

mod common;

use common::*;
use glam::{DAffine3, DVec3, Vec3};
use gonio::bake::bake;
use gonio::layout::*;
use gonio::scene::{Geometry, Mesh, Scene, Transform};
#[cfg(target_arch = "x86_64")]
use gonio::trace::box_::{NODE_SLACKS, Portable, SLACK, approx_intersect_node, axis_slack, root_reach};
use gonio::trace::ray::{object_origin, prepare_ray, transform_vector, within_reach};
use gonio::trace::sphere::intersect_sphere;
use gonio::trace::traverse::{stack_used, trace_any, trace_closest};
use gonio::trace::triangle::intersect_triangle;

/// Every primitive of every instance, without a hierarchy.
fn brute_force(scene: &SceneView, ray: &Ray, shadow: bool) -> Hit {
    let mut hit = Hit { t: ray.t_max, instance: INVALID, ..Hit::default() };
    let mut consider = |t: f32, b1: f32, b2: f32, instance: u32, primitive: u32| {
        let tie = t == hit.t && (instance, primitive) < (hit.instance, hit.primitive);
        if t > 0.0 && (t < hit.t || tie) {
            hit = Hit { t, b1, b2, instance, primitive, ..Hit::default() };
        }
    };
    for id in 0..scene.header.instance_count {
        let instance = load_instance(scene, id);
        if shadow && instance.flags & INSTANCE_NO_SHADOW != 0 {
            continue;
        }
        let origin = object_origin(&instance, ray.origin);
        if !within_reach(origin) {
            continue;
        }
        let level = prepare_ray(origin, transform_vector(instance.to_object, ray.direction));
        if instance.kind == KIND_SPHERE {
            let leaves = id == ray.skip_instance;
            consider(intersect_sphere(&level, !leaves, !leaves || ray.skip_inward != 0), 0.0, 0.0, id, 0);
            continue;
        }
        let slack = axis_slack(&level, root_reach(&scene.nodes[instance.root as usize], &level) * SLACK);
        for primitive in 0..faces_of(scene, &instance) {
            if id == ray.skip_instance && primitive == ray.skip_primitive {
                continue;
            }
            let face = load_face(scene, instance.first_face + primitive);
            let [v0, v1, v2] = [face.i0, face.i1, face.i2].map(|i| load_vertex(scene, i).position);
            let found = intersect_triangle(&level, slack, &v0, &v1, &v2);
            consider(found.x, found.y, found.z, id, primitive);
        }
    }
    hit
}

/// Faces of the instance's mesh: up to the next mesh's first one.
fn faces_of(scene: &SceneView, instance: &Instance) -> u32 {
    let others = scene.instances.iter().filter(|i| i.kind == KIND_MESH).map(|i| i.first_face);
    others.filter(|&first| first > instance.first_face).min().unwrap_or(scene.faces.len() as u32) - instance.first_face
}

/// Compares `count` rays and returns how many hit something.
fn compare(scene: &Scene, rays: impl Iterator<Item = Ray>) -> u32 {
    let data = bake(scene).expect("bakes");
    let view = data.view();
    let mut hits = 0;
    for ray in rays {
        let expected = brute_force(&view, &ray, false);
        let found = trace_closest(&view, &ray);
        assert_eq!(found, expected, "{ray:?}");
        assert_eq!(found.t.to_bits(), expected.t.to_bits());
        assert_eq!(trace_any(&view, &ray), brute_force(&view, &ray, true).instance != INVALID, "{ray:?}");
        assert!(stack_used(&view, &ray) <= data.shapes.stack_depth, "{ray:?}");
        hits += u32::from(found.instance != INVALID);
    }
    hits
}

#[test]
fn a_random_soup_is_hit_as_by_brute_force() {
    let mut random = Random::new(1);
    for size in [0.02, 0.2, 1.5] {
        let scene = scene_of(vec![soup(&mut random, 400, size)]);
        let hits = compare(&scene, (0..4000).map(|_| random.ray(3.0)));
        assert!(hits > 30, "{hits} hits");
    }
}

#[cfg(target_arch = "x86_64")]
#[test]
fn wide_registers_visit_what_narrow_ones_do() {
    let Some(wide) = pulp::x86::V3::try_new() else { return };
    let mut random = Random::new(9);
    let data = bake(&scene_of(vec![soup(&mut random, 400, 0.2)])).expect("bakes");
    let mut met = 0;
    for _ in 0..2000 {
        let ray = random.ray(2.0);
        let level = prepare_ray(ray.origin, ray.direction);
        for node in &data.shapes.nodes {
            let widening = axis_slack(&level, root_reach(node, &level) * SLACK) * NODE_SLACKS;
            let [wide, narrow] = [
                approx_intersect_node(wide, node, &level, widening, ray.t_max),
                approx_intersect_node(Portable, node, &level, widening, ray.t_max),
            ];
            assert_eq!(wide, narrow, "{ray:?} {node:?}");
            met += u32::from(wide != 0);
        }
    }
    assert!(met > 1000, "only {met} nodes are met");
}

#[test]
fn meshes_with_shared_edges_are_hit_as_by_brute_force() {
    let mut random = Random::new(2);
    let mut scene = scene_of(vec![globe(12), globe(5), soup(&mut random, 50, 0.5)]);
    scene.objects[1].transform = Transform::scale(Vec3::splat(0.5));
    assert!(compare(&scene, (0..6000).map(|_| random.ray(2.0))) > 3000);
}

/// A rotation, scales of 1e-3 to 1e3 a axis (or one for all), a mirror every other time, and a shift.
fn placed(random: &mut Random, even: bool) -> Transform {
    let scale = |random: &mut Random| (10.0f64).powf(f64::from(random.range(-3.0, 3.0)));
    let one = scale(random);
    let each = if even { DVec3::splat(one) } else { DVec3::new(scale(random), scale(random), scale(random)) };
    let mirror = if random.unit() < 0.5 { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
    let turn = |random: &mut Random| Transform::rotate(random.direction(), f64::from(random.range(0.0, 6.0)));
    let shift = random.point(1.0) * each.max_element() as f32 * 2.0;
    turn(random)
        .then(Transform(DAffine3::from_scale(each * mirror)))
        .then(turn(random))
        .then(Transform::translate(shift))
}

#[test]
fn many_mirrored_and_scaled_instances_are_hit_as_by_brute_force() {
    for (seed, even) in [(3, true), (4, false), (5, false)] {
        let mut random = Random::new(seed);
        let mut scene = scene_of(vec![globe(4), soup(&mut random, 30, 0.4)]);
        scene.objects.clear();
        for i in 0..60 {
            let geometry = match i % 3 {
                0 => Geometry::Sphere,
                n => Geometry::Mesh(gonio::scene::MeshId(n - 1)),
            };
            let mut object = object(geometry, placed(&mut random, even));
            object.casts_shadow = Some(i % 4 != 0);
            scene.objects.push(object);
        }
        // Aim at the objects, from near and far, on all scales.
        let targets: Vec<DVec3> = scene.objects.iter().map(|o| o.transform.0.translation).collect();
        let rays: Vec<Ray> = (0..2000)
            .map(|i| {
                let object = &scene.objects[i % 60];
                let inside = object.transform.0.transform_point3(random.point(0.7).as_dvec3()).as_vec3();
                let reach = (10.0f32).powf(random.range(-3.0, 4.0));
                let origin = targets[(i / 60) % 60].as_vec3() + random.direction() * reach;
                let mut ray = ray(origin, (inside - origin).normalize());
                if i % 7 == 0 {
                    ray.t_max = reach;
                }
                ray
            })
            .collect();
        let hits = compare(&scene, rays.into_iter());
        assert!(hits > 1000, "{hits} hits");
    }
}

#[test]
fn a_closed_mesh_has_no_gaps_at_vertices_and_edges() {
    let mesh = globe(24);
    let data = bake(&scene_of(vec![mesh.clone()])).expect("bakes");
    let view = data.view();
    let mut random = Random::new(6);
    let (mut misses, mut count) = (0, 0);
    for _ in 0..20_000 {
        let triangle = mesh.triangles[random.bits() as usize % mesh.triangles.len()];
        let [a, b] = [triangle[0], triangle[1]].map(|i| mesh.positions[i as usize]);
        let along = random.unit();
        for target in [a, a + (b - a) * along] {
            // From inside the closed mesh every ray must hit.
            let origin = random.point(0.5);
            let found = trace_closest(&view, &ray(origin, (target - origin).normalize()));
            misses += u32::from(found.instance == INVALID);
            count += 1;
            // And through the very centre, where many vertices lie exactly on the ray.
            let found = trace_closest(&view, &ray(Vec3::ZERO, target));
            misses += u32::from(found.instance == INVALID);
        }
    }
    assert_eq!(misses, 0, "of {count}");
}

#[test]
fn rays_along_axes_hit_what_they_should() {
    // A grid of unit squares in z = 0; rays through corners, edges and insides, with zeros of both signs.
    let mut mesh = Mesh::default();
    for y in 0..5 {
        for x in 0..5 {
            mesh.positions.push(Vec3::new(x as f32, y as f32, 0.0));
        }
    }
    for y in 0..4 {
        for x in 0..4 {
            let i = 5 * y + x;
            mesh.triangles.push([i, i + 1, i + 6]);
            mesh.triangles.push([i, i + 6, i + 5]);
        }
    }
    let scene = scene_of(vec![mesh]);
    let mut rays = Vec::new();
    for i in 0..=16 {
        for j in 0..=16 {
            let (x, y) = (i as f32 * 0.25, j as f32 * 0.25);
            rays.push(ray(Vec3::new(x, y, 3.0), Vec3::new(0.0, -0.0, -1.0)));
            rays.push(ray(Vec3::new(x, y, -2.0), Vec3::new(-0.0, 0.0, 1.0)));
        }
    }
    let expected = rays.len() as u32;
    assert_eq!(compare(&scene, rays.iter().copied()), expected);
    let data = bake(&scene).expect("bakes");
    for ray in &rays {
        let t = trace_closest(&data.view(), ray).t;
        assert_eq!(t, ray.origin.z.abs());
    }
    // In the plane itself, along rows and diagonals: the grid is seen edge-on and nothing is hit.
    let edge_on = [Vec3::X, Vec3::Y, Vec3::new(0.8, 0.6, 0.0)].map(|d| ray(Vec3::new(-1.0, 1.0, 0.0), d));
    assert_eq!(compare(&scene, edge_on.into_iter()), 0);
}

#[test]
fn triangles_seen_edge_on_do_not_depend_on_the_hierarchy() {
    // A bumpless but oblique plane of many thin triangles, and rays within rounding of that plane.
    let mut random = Random::new(7);
    let turn = Transform::rotate(Vec3::new(0.3, 1.0, -0.2), 0.7).0;
    let at = |x: f32, y: f32| turn.transform_point3(DVec3::new(f64::from(x), f64::from(y), 0.0)).as_vec3();
    let mut mesh = Mesh::default();
    for i in 0..300u32 {
        let (x, y) = (random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        let (dx, dy) = (random.range(-0.5, 0.5), random.range(-0.5, 0.5));
        mesh.positions.extend([at(x, y), at(x + dx, y + dy), at(x + dx * 0.5, y + dy * 0.5001)]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    let rays: Vec<Ray> = (0..20_000)
        .map(|_| {
            let origin = at(random.range(-2.0, 2.0), random.range(-2.0, 2.0));
            let target = at(random.range(-1.0, 1.0), random.range(-1.0, 1.0));
            ray(origin, (target - origin).normalize())
        })
        .collect();
    let hits = compare(&scene_of(vec![mesh]), rays.into_iter());
    assert!(hits > 100, "{hits} hits");
}

#[test]
fn equal_distances_go_to_the_lower_instance_and_primitive() {
    let mut mesh = soup(&mut Random::new(8), 40, 0.5);
    // The same triangles again, in reverse order.
    for i in (0..40).rev() {
        mesh.triangles.push(mesh.triangles[i]);
    }
    let mut scene = scene_of(vec![mesh]);
    scene.objects.push(scene.objects[0].clone());
    scene.objects.insert(0, object(Geometry::Sphere, Transform::translate(Vec3::splat(9.0))));
    let mut random = Random::new(9);
    let rays: Vec<Ray> = (0..3000).map(|_| random.ray(3.0)).collect();
    assert!(compare(&scene, rays.iter().copied()) > 300);
    let data = bake(&scene).expect("bakes");
    for ray in &rays {
        let hit = trace_closest(&data.view(), ray);
        if hit.instance != INVALID && hit.instance != 0 {
            assert!(hit.instance == 1 && hit.primitive < 40, "{hit:?}");
        }
    }
}

#[test]
fn what_a_ray_leaves_and_what_lies_beyond_its_end_is_not_hit() {
    let mesh = Mesh {
        positions: vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)],
        triangles: vec![[0, 1, 2]],
        ..Mesh::default()
    };
    let mut scene = scene_of(vec![mesh]);
    scene.objects.push(object(Geometry::Sphere, Transform::translate(Vec3::new(0.0, 0.0, -4.0))));
    let data = bake(&scene).expect("bakes");
    let view = data.view();
    let down = ray(Vec3::new(0.0, 0.0, 2.0), Vec3::NEG_Z);
    let hit = |ray: &Ray| (trace_closest(&view, ray).instance, trace_closest(&view, ray).t, trace_any(&view, ray));
    assert_eq!(hit(&down), (0, 2.0, true));
    assert_eq!(hit(&Ray { t_max: 2.0, ..down }), (0, 2.0, true));
    assert_eq!(hit(&Ray { t_max: 1.999, ..down }), (INVALID, 1.999, false));
    assert_eq!(hit(&Ray { skip_instance: 0, skip_primitive: 0, ..down }), (1, 5.0, true));
    assert_eq!(hit(&Ray { skip_instance: 0, skip_primitive: 1, ..down }), (0, 2.0, true));
    // A sphere that is left inward is hit from inside, outward not at all.
    let inward = Ray { origin: Vec3::new(0.0, 0.0, -3.0), skip_instance: 1, skip_primitive: 0, ..down };
    assert_eq!(hit(&Ray { skip_inward: 1, ..inward }), (1, 2.0, true));
    assert_eq!(hit(&Ray { skip_inward: 0, ..inward }), (INVALID, T_INFINITE, false));
    // Also where rounding has put the start on the wrong side: the near root ahead is the start itself, not a hit.
    let outside = Ray { origin: Vec3::new(0.0, 0.0, -2.75), ..inward };
    assert_eq!(hit(&Ray { skip_inward: 1, ..outside }), (1, 2.25, true));
    let inside = Ray { origin: Vec3::new(0.0, 0.0, -3.25), direction: Vec3::Z, ..inward };
    assert_eq!(hit(&Ray { skip_inward: 0, ..inside }), (0, 3.25, true));
}
