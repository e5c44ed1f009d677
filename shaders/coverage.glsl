// How much of a disc lies on surfaces: where it reaches beyond an edge or into a corner no photons can be, and what is
// found there is the flux of the rest alone (as Lastra et al. 2002 and Havran et al. 2005 observe, who clip discs or
// count rays in place of photons). The part is found by probes, short rays through the disc.
#ifndef COVERAGE_GLSL
#define COVERAGE_GLSL
#include "common.glsl"
#include "density.glsl"
#include "directions.glsl"
#include "hash.h"
#include "random.glsl"
#include "sampling.glsl"
#include "shared_camera.h"
#include "shared_kinds.h"
#include "shared_scene.h"
#include "traverse.glsl"

// The geometric normal at a hit of a ray, of any length, on either side.
vec3 normalDirection(DeviceScene scene, uint id, vec3 position) {
    Primitive p = PrimitivePtr(scene.primitives).at[id];
    if (hasSpheres && (!hasTriangles || id >= scene.triangleCount)) return position - p.a;
    return directionOfCross(p.b - p.a, p.c - p.a);
}

// Whether photons may lie at a hit, at offset d from the query.
bool keepsPhotons(DeviceScene scene, Query query, float radius, uint id, vec3 d) {
    Material m = MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[id].material];
    uint kind = hasMixed && m.base != 0u ? MaterialPtr(scene.materials).at[m.base - 1u].kind : m.kind;
    vec3 side = normalDirection(scene, id, query.position + d);
    float cosine = dot(side, query.normal);
    bool keeps = (DIFFUSE_KINDS >> kind & 1u) != 0u;
    if (hasWideGlass && (query.lobes & BY_GLASS) != 0u)
        keeps = m.kind == MATERIAL_ROUGH_GLASS && m.wide == WIDE_BY_PHOTONS;
    return keeps && dot(d, d) < radius * radius && cosine * cosine > 0.25 * dot(side, side);
}

const uint MOST_LAYERS = 4u;

// Whether a photon that counts for the query could lie at a place of its disc, given in radii: whether a surface that
// keeps photons is there, as near the plane and turned as theirs.
bool isCovered(DeviceScene scene, Query query, float radius, vec2 place) {
    vec3 d = toWorld(radius * vec3(place, 0.1), query.normal);
    float depth = 0.2 * radius;
    Passage none = Passage(false, 0u, true); // photons on what lets a part through make up for that
    for (uint layer = 0u; layer < MOST_LAYERS; layer++) {
        Hit hit = traverse(scene, makeRay(query.position + d, -query.normal), NONE, depth, false, none);
        if (hit.primitive == NONE) return false;
        if (keepsPhotons(scene, query, radius, hit.primitive, d - hit.t * query.normal)) return true;
        float below = hit.t + 1e-3 * radius;
        d -= below * query.normal;
        depth -= below;
    }
    return false;
}

// Whether a surface may have holes.
bool mayHaveHoles(DeviceScene scene, uint id) {
    return hasOpacity &&
           MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[id].material].seeThrough == 1.0;
}

// Whether the triangle that the query is on holds all of the disc.
bool isWithin(DeviceScene scene, Query query, float radius) {
    if (!hasTriangles || query.primitive >= scene.triangleCount || mayHaveHoles(scene, query.primitive)) return false;
    Primitive p = PrimitivePtr(scene.primitives).at[query.primitive];
    vec3 ab = p.b - p.a, bc = p.c - p.b, ca = p.a - p.c;
    vec3 inward =
        vec3(dot(cross(query.normal, ab), query.position - p.a), dot(cross(query.normal, bc), query.position - p.b),
             dot(cross(query.normal, ca), query.position - p.c)); // times the side; all of one sign
    vec3 least = radius * radius * vec3(dot(ab, ab), dot(bc, bc), dot(ca, ca));
    return all(greaterThan(abs(inward) * inward, least)) || all(greaterThan(-abs(inward) * inward, least));
}

const uint MOST_TRIES = 32u;

// One over the part of the disc that surfaces cover (x), and one over that of the disc of half its area (y): how many
// points, uniform over the disc, it takes to find a covered one, up to MOST_TRIES, whose expectation that is (of a
// geometric distribution). For y, a point's counterpart in the inner disc is taken to be covered where the point is, as
// it is if the covered part is convex. The points are drawn by the place in units of the radius, which scaling leaves
// alone, without the last bits, in which drivers differ.
vec2 inverseCoverage(DeviceScene scene, Query query, float radius) {
    if (isWithin(scene, query, radius)) return vec2(1.0);
    uint draw = hash(floatBitsToUint(abs(roundEven(query.position * (4096.0 / radius)))));
    float inner = 0.0;
    for (uint i = 1u; i < MOST_TRIES; i++) {
        vec2 place = uniformDisc(vec2(unitFloat(draw), unitFloat(hash(draw ^ 0x68bc21ebu))));
        if (isCovered(scene, query, radius, place)) return vec2(i, inner == 0.0 ? i : inner);
        if (hasBias && inner == 0.0 && isCovered(scene, query, radius, sqrt(0.5) * place)) inner = i;
        draw = hash(draw + 0x9e3779b9u);
    }
    return vec2(MOST_TRIES, inner == 0.0 ? MOST_TRIES : inner);
}

#endif
