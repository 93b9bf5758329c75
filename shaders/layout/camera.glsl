// The camera.
#ifndef LAYOUT_CAMERA_GLSL
#define LAYOUT_CAMERA_GLSL

const uint CAMERA_PERSPECTIVE = 0u;
const uint CAMERA_ORTHOGRAPHIC = 1u;

// The camera. 80 bytes. A film point (x, y) in pixels of the full frame has
// s = x * scale_x - 1 (left to right) and t = 1 - y * scale_y (bottom to top), both in -1..1.
struct Camera {
    vec3 eye;
    // `CAMERA_*`.
    uint kind;
    // From the centre of the image plane to its right edge (perspective: plane at distance 1 along `forward`).
    vec3 right;
    // 2 / width of the full frame.
    float scale_x;
    // From the centre of the image plane to its upper edge.
    vec3 up;
    // 2 / height of the full frame.
    float scale_y;
    // Unit viewing direction.
    vec3 forward;
    // Height of a pixel, world units: on the plane at distance 1 (perspective), anywhere (orthographic).
    float pixel_size;
    // The thin lens, world units: its radius, 0 for a pinhole, and how far along `forward` it shows things sharp.
    float lens_radius;
    float focus_distance;
    // Added to s and t: what is seen lies off the middle of a larger picture.
    float shift_x;
    float shift_y;
};

#endif
