// The surface at a hit: where it is, how it is turned, what it is made of.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#include "common.glsl"
#include "offset.glsl"
#include "shared_paths.h"
#include "shared_scene.h"
#include "sphere.glsl"

struct Surface {
    vec3 position;
    vec3 magnitude; // of the numbers that were rounded to get the position, by component
    vec3 normal;    // geometric
    vec3 shading;   // normal, on the same side as the geometric one
    uint material;
    uint light;
    uint primitive;
    float bulge; // on the side of the geometric normal: 0 if shading is flat; see terminator.glsl
    bool mapped; // `shading` is that of a normal map, see normal_map.glsl
};

Surface triangleSurface(DeviceScene scene, Primitive p, Hit hit) {
    vec2 weights = hit.weights;
    float first = 1.0 - weights.x - weights.y;
    vec3 a = first * p.a;
    vec3 b = weights.x * p.b;
    vec3 c = weights.y * p.c;
    vec3 normal = directionOfCross(p.b - p.a, p.c - p.a);
    vec3 shading = normal;
    float bulge = 0.0;
    if (hasSmoothNormals && p.normals != NONE) {
        Normals n = NormalsPtr(scene.normals).at[p.normals];
        shading = normalize(first * n.a + weights.x * n.b + weights.y * n.c);
        bool turned = dot(shading, normal) < 0.0;
        if (turned) shading = -shading;
        if (hasSmoothDiffuse) {
            bulge = dot(n.b - n.a, p.b - p.a) + dot(n.c - n.b, p.c - p.b) + dot(n.a - n.c, p.a - p.c);
            bulge = bulge < 0.0 == turned ? 1.0 : -1.0;
        }
    }
    return Surface(a + b + c, abs(p.a) + abs(p.b) + abs(p.c), normal, shading, p.material, p.light, hit.primitive,
                   bulge, false);
}

// The hit point is projected onto the sphere, so that its error is that of a few roundings, not of t.
Surface sphereSurface(Primitive p, vec3 along, Hit hit) {
    vec3 f = along - p.a;
    float distance = length(f);
    vec3 normal = f / distance;
    vec3 position = along - spherePower(along, p.a, p.c) / (distance + p.b.x) * normal;
    return Surface(position, abs(position) + length(position - p.c), normal, normal, p.material, p.light, hit.primitive,
                   0.0, false);
}

Surface surfaceAt(DeviceScene scene, Path path, Hit hit) {
    Primitive p = PrimitivePtr(scene.primitives).at[hit.primitive];
    if (hasSpheres && (!hasTriangles || hit.primitive >= scene.triangleCount))
        return sphereSurface(p, path.origin + hit.t * path.direction, hit);
    return triangleSurface(scene, p, hit);
}

// The origin of a ray that leaves the surface in a direction.
vec3 leave(Surface s, vec3 direction) {
    return offsetPoint(s.position, s.magnitude, dot(direction, s.normal) < 0.0 ? -s.normal : s.normal);
}

#endif
