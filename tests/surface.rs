//! What was hit, and the rays that leave it.

mod common;

use common::*;
use glam::{DAffine3, DVec3, Vec3};
use gonio::bake::bake;
use gonio::layout::*;
use gonio::scene::{Geometry, MaterialId, Mesh, MeshId, Scene, Transform};
use gonio::trace::spawn::{spawn_ray, spawn_through};
use gonio::trace::surface::{Surface, surface_at};
use gonio::trace::traverse::trace_closest;

/// The surface that a ray hits, if any.
fn hit_surface(scene: &SceneView, ray: &Ray) -> Option<Surface> {
    let hit = trace_closest(scene, ray);
    (hit.instance != INVALID).then(|| surface_at(scene, ray, &hit))
}

/// A globe and a sphere under all kinds of transforms, one of each per scene.
fn placements() -> Vec<Transform> {
    let turn = Transform::rotate(Vec3::new(1.0, 2.0, -0.5), 0.8);
    [(1.0, 0.0), (1e-3, 0.2), (1e3, -300.0), (1.0, 1000.0)]
        .into_iter()
        .flat_map(|(scale, shift)| {
            [DVec3::ONE, DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1.0, 3.0, 0.5)].map(|each| {
                Transform(DAffine3::from_scale(each * scale)).then(turn).then(Transform::translate(Vec3::splat(shift)))
            })
        })
        .collect()
}

fn one(geometry: Geometry, transform: Transform) -> Scene {
    let mut scene = scene_of(vec![globe(16)]);
    scene.objects = vec![object(geometry, transform)];
    scene
}

#[test]
fn surfaces_lie_within_their_error_bound_and_face_outward() {
    let mut random = Random::new(1);
    for transform in placements() {
        for geometry in [Geometry::Sphere, Geometry::Mesh(MeshId(0))] {
            let data = bake(&one(geometry, transform)).expect("bakes");
            let (place, inverse) = (transform.0, transform.0.inverse());
            for _ in 0..300 {
                let origin = place.transform_point3((random.direction() * 3.0).as_dvec3()).as_vec3();
                let target = place.transform_point3(random.point(0.5).as_dvec3()).as_vec3();
                let ray = ray(origin, (target - origin).normalize());
                let surface = hit_surface(&data.view(), &ray).expect("aimed at the inside");
                // In object space: on the sphere, or between it and the sphere inside the facets.
                let p = inverse.transform_point3(surface.position.as_dvec3());
                let size = |v: DVec3| place.transform_vector3(v).length();
                if geometry == Geometry::Sphere {
                    let off = size(p - p.normalize());
                    assert!(off <= f64::from(surface.error), "{off} of {}", surface.error);
                } else {
                    assert!(p.length() > 0.97 && p.length() < 1.00001, "{p}");
                }
                // The outside stays outside under a mirror, and shading normals are on its side.
                let outward = inverse.matrix3.transpose() * p;
                let n = surface.normal_geometric;
                assert!((n.length() - 1.0).abs() < 1e-5 && (surface.normal.length() - 1.0).abs() < 1e-5);
                assert!(outward.normalize().dot(n.as_dvec3()) > 0.9, "{surface:?}");
                assert!(surface.normal.dot(n) > 0.9);
                assert!(n.dot(ray.direction) < 0.05, "seen from outside");
                assert!(f64::from(surface.error) < 1e-4 * (size(DVec3::ONE) + place.translation.length()));
            }
        }
    }
}

#[test]
fn rays_that_leave_a_convex_shape_outward_meet_it_no_more_and_inward_always() {
    let mut random = Random::new(2);
    for transform in placements() {
        for geometry in [Geometry::Sphere, Geometry::Mesh(MeshId(0))] {
            let data = bake(&one(geometry, transform)).expect("bakes");
            let view = data.view();
            let place = transform.0;
            for _ in 0..300 {
                let origin = place.transform_point3((random.direction() * 3.0).as_dvec3()).as_vec3();
                let target = place.transform_point3(random.point(0.5).as_dvec3()).as_vec3();
                let surface = hit_surface(&view, &ray(origin, (target - origin).normalize())).expect("aimed");
                let d = random.direction();
                let side = d.dot(surface.normal_geometric);
                let spawned = spawn_ray(&surface, d, T_INFINITE);
                let hit = trace_closest(&view, &spawned);
                if side > 0.0 {
                    assert_eq!(hit.instance, INVALID, "{surface:?} {d}");
                } else if side < -0.02 {
                    assert_eq!(hit.instance, 0, "{surface:?} {d}");
                    // Through the far side and out.
                    let far = surface_at(&view, &spawned, &hit);
                    let out = spawn_through(&far, d, T_INFINITE);
                    if d.dot(far.normal_geometric) > 0.02 {
                        assert_eq!(trace_closest(&view, &out).instance, INVALID, "{far:?} {d}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_flat_floor_does_not_shadow_itself_across_its_edges() {
    // An oblique floor of two triangles a quad, far from the origin: points on and next to edges look up.
    let turn = Transform::rotate(Vec3::new(0.2, 1.0, 0.4), 1.1);
    let mut mesh = Mesh::default();
    for y in 0..9 {
        for x in 0..9 {
            let p = turn.0.transform_point3(DVec3::new(f64::from(x) - 4.0, 0.0, f64::from(y) - 4.0));
            mesh.positions.push(p.as_vec3() + Vec3::new(100.0, 50.0, -20.0));
        }
    }
    for y in 0..8 {
        for x in 0..8 {
            let i = 9 * y + x;
            mesh.triangles.extend([[i, i + 10, i + 1], [i, i + 9, i + 10]]);
        }
    }
    let data = bake(&scene_of(vec![mesh.clone()])).expect("bakes");
    let view = data.view();
    let up = turn.0.transform_vector3(DVec3::Y).as_vec3();
    let mut random = Random::new(3);
    let mut count = 0;
    for _ in 0..4000 {
        let triangle = mesh.triangles[random.bits() as usize % mesh.triangles.len()];
        let [a, b] = [triangle[0], triangle[1]].map(|i| mesh.positions[i as usize]);
        let target = a + (b - a) * random.unit();
        let origin = target + up * 5.0 + random.point(3.0);
        let Some(surface) = hit_surface(&view, &ray(origin, (target - origin).normalize())) else { continue };
        count += 1;
        let d = (random.direction() + up * 1.01).normalize();
        assert_eq!(trace_closest(&view, &spawn_ray(&surface, d, T_INFINITE)).instance, INVALID, "{surface:?} {d}");
    }
    assert!(count > 3000, "{count}");
}

#[test]
fn attributes_are_interpolated_and_materials_resolved() {
    let mut mesh = Mesh { name: "one".into(), ..Mesh::default() };
    mesh.positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    mesh.uvs = vec![glam::Vec2::new(0.0, 0.0), glam::Vec2::new(1.0, 0.0), glam::Vec2::new(0.0, 2.0)];
    mesh.colors = vec![Vec3::X, Vec3::Y, Vec3::Z];
    // The last normal is unusable and is replaced by the face's.
    mesh.normals = vec![Vec3::Z, Vec3::new(0.5, 0.0, 1.0).normalize(), Vec3::ZERO];
    mesh.triangles = vec![[0, 1, 2]];
    mesh.face_materials = vec![MaterialId(1)];
    let mut scene = scene_of(vec![mesh]);
    scene.materials.push(gonio::scene::Material::grey("second"));
    scene.objects[0].material = None;
    let down = ray(Vec3::new(0.25, 0.5, 1.0), Vec3::NEG_Z);
    let data = bake(&scene).expect("bakes");
    let surface = hit_surface(&data.view(), &down).expect("aimed");
    assert!((surface.uv - glam::Vec2::new(0.25, 1.0)).length() < 1e-6, "{surface:?}");
    assert!((surface.color - Vec3::new(0.25, 0.25, 0.5)).length() < 1e-6);
    assert!((surface.position - Vec3::new(0.25, 0.5, 0.0)).length() < 1e-6);
    assert_eq!((surface.normal_geometric, surface.material), (Vec3::Z, 1));
    let bent = (Vec3::Z * 0.75 + Vec3::new(0.5, 0.0, 1.0).normalize() * 0.25).normalize();
    assert!((surface.normal - bent).length() < 1e-6);
    scene.objects[0].material = Some(MaterialId(0));
    let data = bake(&scene).expect("bakes");
    assert_eq!(hit_surface(&data.view(), &down).expect("aimed").material, 0);
}

#[test]
fn sphere_coordinates_run_right_and_up_from_the_back() {
    let data = bake(&one(Geometry::Sphere, Transform::default())).expect("bakes");
    let uv = |p: Vec3| hit_surface(&data.view(), &ray(p * 3.0, -p)).expect("aimed").uv;
    let near = |a: glam::Vec2, u: f32, v: f32| (a - glam::Vec2::new(u, v)).length() < 1e-5;
    assert!(near(uv(Vec3::Z), 0.5, 0.5) && near(uv(Vec3::X), 0.75, 0.5) && near(uv(Vec3::NEG_X), 0.25, 0.5));
    assert!((uv(Vec3::Y).y - 1.0).abs() < 1e-5 && uv(Vec3::NEG_Y).y.abs() < 1e-5);
    assert!(near(uv(Vec3::new(0.0, 0.5f32.sqrt(), 0.5f32.sqrt())), 0.5, 0.75));
}
