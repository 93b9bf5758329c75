// From a point of the film to a ray.
#ifndef SHADING_CAMERA_GLSL
#define SHADING_CAMERA_GLSL

#include "layout/records.glsl"
#include "shading/math.glsl"

// A ray into the scene.
struct CameraRay {
    vec3 origin;
    // Unit.
    vec3 direction;
    // Width of a pixel's cone at the origin, and what it grows by per unit of distance (in the middle of the picture).
    float cone_width;
    float cone_spread;
};

// The ray through a film point, in pixels of the full frame from its upper left corner (pixel centres at .5); points
// outside the frame are fine. Perspective: all rays start at the eye. Orthographic: rays are parallel and start on
// the image plane through the eye.
CameraRay camera_ray(Camera camera, float film_x, float film_y) {
    float s = (film_x * camera.scale_x - 1.0) + camera.shift_x;
    float t = (1.0 - film_y * camera.scale_y) + camera.shift_y;
    vec3 offset = camera.right * s + camera.up * t;
    if (camera.kind == CAMERA_PERSPECTIVE) {
        return CameraRay(camera.eye, normalize3(camera.forward + offset), 0.0, camera.pixel_size);
    }
    return CameraRay(camera.eye + offset, normalize3(camera.forward), camera.pixel_size, 0.0);
}

// The pinhole's ray `through` a film point, sent through point `p` (in the unit disk) of the thin lens instead: it meets
// the other in the plane of focus. Source: Cook, Porter and Carpenter 1984, "Distributed Ray Tracing"; Pharr, Jakob and
// Humphreys 2023, "Physically Based Rendering", section 5.2.3. The cone stays the pinhole's.
CameraRay through_lens(Camera camera, CameraRay through, vec2 p) {
    vec3 to_focus = through.direction * div(camera.focus_distance, dot3(through.direction, camera.forward));
    vec3 right = normalize3(camera.right) * (camera.lens_radius * p.x);
    vec3 up = normalize3(camera.up) * (camera.lens_radius * p.y);
    vec3 on_lens = right + up;
    return CameraRay(
        through.origin + on_lens, normalize3(to_focus - on_lens), through.cone_width, through.cone_spread);
}

#endif
