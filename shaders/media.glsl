// The media that paths are in: what of them counts, how light falls in it, and what comes at the next surface of glass
// (the nested dielectrics of Schmidt & Budge 2002).
#ifndef MEDIA_GLSL
#define MEDIA_GLSL
#include "common.glsl"
#include "shared_camera.h"
#include "shared_kinds.h"
#include "shared_paths.h"
#include "shared_scene.h"
#include "surface.glsl"

const uint MEDIUM_MASK = MAX_MEDIA - 1u;

const uvec4 MEDIUM_SHIFTS = uvec4(0u, MEDIUM_BITS, 2u * MEDIUM_BITS, 3u * MEDIUM_BITS);

uvec4 listOfMedia(uint media) { return uvec4(media) >> MEDIUM_SHIFTS & MEDIUM_MASK; }

uint fromList(uvec4 list) {
    list <<= MEDIUM_SHIFTS;
    return list.x | list.y | list.z | list.w;
}

// The one that counts.
uint firstMedium(uint media) { return media & MEDIUM_MASK; }

Medium mediumOf(DeviceScene scene, uint index) { return MediumPtr(scene.media).at[index]; }

uint priorityOf(DeviceScene scene, uint index) { return mediumOf(scene, index).priority; }

// The media after one more was entered: it goes before those of its priority and lower. Of five the last is forgotten.
uint withMedium(DeviceScene scene, uint media, uint entered) {
    if (entered == 0u) return media;
    uvec4 list = listOfMedia(media);
    if (list.w != 0u) atomicAdd(uintPtr(scene.overflows).at[0], 1u);
    uint priority = priorityOf(scene, entered);
    if (list.x == 0u || priorityOf(scene, list.x) <= priority) list = uvec4(entered, list.xyz);
    else if (list.y == 0u || priorityOf(scene, list.y) <= priority) list = uvec4(list.x, entered, list.yz);
    else if (list.z == 0u || priorityOf(scene, list.z) <= priority) list = uvec4(list.xy, entered, list.z);
    else if (list.w == 0u || priorityOf(scene, list.w) <= priority) list.w = entered;
    return fromList(list);
}

bool isIn(uint media, uint medium) { return any(equal(listOfMedia(media), uvec4(medium))); }

// The media after one was left.
uint withoutMedium(uint media, uint left) {
    if (left == 0u) return media;
    uvec4 list = listOfMedia(media);
    if (list.x == left) list = uvec4(list.yzw, 0u);
    else if (list.y == left) list = uvec4(list.x, list.zw, 0u);
    else if (list.z == left) list = uvec4(list.xy, list.w, 0u);
    else if (list.w == left) list.w = 0u;
    return fromList(list);
}

// 2^-x for x >= 0, by its series about a whole number, so that drivers agree; 0 below the range of floats.
float halved(float x) {
    if (!(x < 126.0)) return 0.0;
    float whole = floor(x + 0.5), y = (whole - x) * 0.693147181;
    float series = 1.0 + y * (1.0 + y / 2.0 * (1.0 + y / 3.0 * (1.0 + y / 4.0 * (1.0 + y / 5.0 * (1.0 + y / 6.0)))));
    return series * uintBitsToFloat(127u - uint(whole) << 23);
}

// The part of light that is left after a way (Beer's law).
vec3 transmittance(DeviceScene scene, uint media, float way) {
    uint first = firstMedium(media);
    if (first == 0u) return vec3(1.0);
    vec3 x = mediumOf(scene, first).attenuation * way;
    return vec3(halved(x.x), halved(x.y), halved(x.z));
}

// The same along a shadow ray.
vec3 shadowTransmittance(DeviceScene scene, uint media, ShadowRay ray) {
    bool endless = (ray.flags & SHADOW_ENDLESS) != 0u;
    return transmittance(scene, media, endless ? GREATEST : distance(ray.origin, ray.target));
}

// Indices for red, green and blue.
vec3 indicesOf(Medium medium) { return medium.ior + vec3(medium.spread.x, 0.0, medium.spread.y); }

// The only channel in which a path has light, or NONE.
uint onlyChannel(vec3 throughput) {
    bvec3 has = greaterThan(throughput, vec3(0.0));
    if (!has.y && !has.z) return 0u;
    if (!has.x && !has.z) return 1u;
    return !has.x && !has.y ? 2u : NONE;
}

// The triangle of other glass that lies on that of a surface, where the surface is, or NONE.
uint faceOn(DeviceScene scene, Surface surface) {
    if (!hasTouching || scene.touching == uvec2(0u) || surface.primitive >= scene.triangleCount) return NONE;
    uintPtr touching = uintPtr(scene.touching);
    for (uint i = touching.at[surface.primitive]; i < touching.at[surface.primitive + 1u]; i++) {
        Primitive p = PrimitivePtr(scene.primitives).at[touching.at[i]];
        vec3 a = p.a - surface.position, b = p.b - surface.position, c = p.c - surface.position;
        vec3 within =
            vec3(dot(cross(a, b), surface.normal), dot(cross(b, c), surface.normal), dot(cross(c, a), surface.normal));
        if (min(within.x, min(within.y, within.z)) >= 0.0 || maxComponent(within) <= 0.0) return touching.at[i];
    }
    return NONE;
}

// What comes at a surface of glass.
struct Interface {
    uint media; // of light that goes through
    uint face;  // of other glass that it goes through at once, or NONE
};

// Goes through a face of glass: `beyond` becomes what is behind it. Who leaves it was within it, `here` already.
void crossFace(DeviceScene scene, uint within, bool leaving, inout uint here, inout uint beyond) {
    if (leaving && !isIn(here, within)) {
        here = withMedium(scene, here, within);
        beyond = withMedium(scene, beyond, within);
    }
    beyond = leaving ? withoutMedium(beyond, within) : withMedium(scene, beyond, within);
}

// The indices of `material` become those on both sides of the surface. Where nothing changes there is none, and facets
// that hardly turn light are left out: `material` gets the medium NONE. Faces that lie on each other are one, made of
// what is nearer to the medium that counts more.
Interface atInterface(DeviceScene scene, Path path, Surface surface, inout Material material) {
    if (scene.media == uvec2(0u) || (GLASS_KINDS >> material.kind & 1u) == 0u) return Interface(path.media, NONE);
    bool leaving = dot(path.direction, surface.normal) > 0.0;
    uint within = material.medium, before, after;
    Interface result = Interface(0u, NONE);
    if (material.exterior != NONE) {
        before = leaving ? within : material.exterior;
        after = leaving ? material.exterior : within;
        result.media = withMedium(scene, withoutMedium(path.media, before), after);
    } else {
        uint here = path.media;
        result.media = here;
        crossFace(scene, within, leaving, here, result.media);
        result.face = faceOn(scene, surface);
        if (result.face != NONE) {
            Primitive p = PrimitivePtr(scene.primitives).at[result.face];
            Material other = MaterialPtr(scene.materials).at[p.material];
            bool leavingOther = dot(path.direction, directionOfCross(p.b - p.a, p.c - p.a)) > 0.0;
            crossFace(scene, other.medium, leavingOther, here, result.media);
            if (priorityOf(scene, other.medium) > priorityOf(scene, within)) material = other;
        }
        before = firstMedium(here);
        after = firstMedium(result.media);
        if (before == after) {
            material.medium = NONE;
            material.color = vec3(1.0);
            return result;
        }
    }
    vec3 inner = indicesOf(mediumOf(scene, leaving ? before : after));
    vec3 outer = indicesOf(mediumOf(scene, leaving ? after : before));
    vec3 ratios = inner / outer;
    uint channel = hasDispersion ? onlyChannel(path.throughput) : NONE;
    material.ior = channel == NONE ? ratios.y : ratios[channel];
    material.spread = channel == NONE ? vec2(ratios.x, ratios.z) - ratios.y : vec2(0.0);
    if (material.kind == MATERIAL_ROUGH_GLASS && maxComponent(abs(ratios - 1.0)) < 1e-4) material.medium = NONE;
    return result;
}

// Whether light that came from a direction goes on on the other side of a surface.
bool goesBeyond(Surface surface, vec3 from, vec3 to) {
    return hasMedia && dot(from, surface.normal) > 0.0 == dot(to, surface.normal) > 0.0;
}

// The origin of a ray that leaves a surface and the face that lies on it: rounding may put either before the other.
vec3 leaveInterface(DeviceScene scene, Surface surface, Interface at, vec3 to) {
    if (hasTouching && at.face != NONE) {
        vec3 side = dot(to, surface.normal) < 0.0 ? -surface.normal : surface.normal;
        Primitive p = PrimitivePtr(scene.primitives).at[at.face];
        surface.position += max(0.0, dot(p.a - surface.position, side)) * side;
        surface.magnitude += abs(p.a) + abs(p.b) + abs(p.c);
    }
    return leave(surface, to);
}

#endif
