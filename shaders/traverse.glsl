// The closest hit, or any hit, of a ray with the scene.
#ifndef TRAVERSE_GLSL
#define TRAVERSE_GLSL
#include "common.glsl"
#include "intersect.glsl"
#include "light_kinds.glsl"
#include "offset.glsl"
#include "opacity.glsl"
#include "shared_camera.h"
#include "shared_paths.h"
#include "shared_scene.h"

// Where glass touches something opaque both faces are at the same place but for rounding, and a ray that went through
// the glass first would start behind the other. So an opaque triangle hides the glass triangles before it that are
// within the roundings by which rays are offset, and those of the ray, and a ray that leaves something opaque does not
// hit them: whatever the order of shapes, what stands on the floor is in contact with it. Nearest hits are found for
// either kind.
struct Contact {
    Hit glass;
    float slack; // how much farther along the ray an opaque triangle still hides `glass`
};

bool isGlass(DeviceScene scene, uint id) {
    uint kind = MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[id].material].kind;
    return kind == MATERIAL_GLASS ||
           ((materialKinds & 1u << MATERIAL_ROUGH_GLASS) != 0u && kind == MATERIAL_ROUGH_GLASS);
}

float slackOf(DeviceScene scene, Ray ray, uint id) {
    Primitive p = PrimitivePtr(scene.primitives).at[id];
    vec3 normal = directionOfCross(p.b - p.a, p.c - p.a);
    vec3 magnitude = abs(p.a) + abs(p.b) + abs(p.c) + abs(ray.origin);
    const float roundings = 4.7683716e-7; // 2^-21 of the greatest coordinate, where that along the normal is 0
    return (2.0 * roundingAlong(magnitude, normal) + roundings * maxComponent(magnitude)) /
           max(abs(dot(ray.direction, normal)), 1e-30);
}

// What a ray goes through.
struct Passage {
    bool allowed;    // triangles of smooth diffuse meshes, on the way to a light; see terminator.glsl
    uint triangles;  // of these, so far
    bool stopsAtAny; // no surface that lets a part of the light through
};
const Passage NO_PASSAGE = Passage(false, 0u, false);

bool isSmoothDiffuse(DeviceScene scene, uint id) {
    if (id >= scene.triangleCount || PrimitivePtr(scene.primitives).at[id].normals == NONE) return false;
    return MaterialPtr(scene.materials).at[PrimitivePtr(scene.primitives).at[id].material].kind == MATERIAL_DIFFUSE;
}

// Where a sphere that may let a part of the light through stops a ray: at either root, or -1.
float sphereStop(DeviceScene scene, Ray ray, uint id, vec3 center, float radius, vec3 pole, bool stopsAtAny) {
    vec2 roots = sphereRoots(ray, center, radius, pole);
    if (roots.x > 0.0 && !letsThrough(scene, ray, id, roots.x, vec2(0.0), false, stopsAtAny)) return roots.x;
    if (roots.y > 0.0 && !letsThrough(scene, ray, id, roots.y, vec2(0.0), true, stopsAtAny)) return roots.y;
    return -1.0;
}

// One leaf primitive; a nearer hit replaces `hit`, and of two at the same distance the lower primitive wins,
// so that the result does not depend on the tree. A ray cannot hit the triangle `from` that it leaves.
void intersectLeaf(DeviceScene scene, Ray ray, uint from, uint slot, const bool any, inout Hit hit,
                   inout Contact contact, inout Passage passage) {
    uint id = LeafPtr(scene.leaves).at[slot].id;
    vec2 weights = vec2(0.0);
    float t;
    if (hasSpheres && (!hasTriangles || id >= scene.triangleCount)) {
        vec3 center = LeafPtr(scene.leaves).at[slot].a, pole = LeafPtr(scene.leaves).at[slot].c;
        float radius = LeafPtr(scene.leaves).at[slot].b.x;
        t = hasOpacity ? sphereStop(scene, ray, id, center, radius, pole, passage.stopsAtAny)
                       : intersectSphere(ray, center, radius, pole);
    } else {
        // Loads in the order of the ray's axes save the exchange.
        LeafNumbersPtr leaves = LeafNumbersPtr(scene.leaves);
        uvec3 i = ray.axes;
        vec3 a = vec3(leaves.at[slot].a[i.x], leaves.at[slot].a[i.y], leaves.at[slot].a[i.z]);
        vec3 b = vec3(leaves.at[slot].b[i.x], leaves.at[slot].b[i.y], leaves.at[slot].b[i.z]);
        vec3 c = vec3(leaves.at[slot].c[i.x], leaves.at[slot].c[i.y], leaves.at[slot].c[i.z]);
        t = id == from ? -1.0 : intersectPermuted(ray, a, b, c, weights);
    }
    if (!(t > 0.0 && (t < hit.t || (t == hit.t && hit.primitive != NONE && id < hit.primitive)))) return;
    if (hasOpacity && hasTriangles && id < scene.triangleCount &&
        letsThrough(scene, ray, id, t, weights, false, passage.stopsAtAny))
        return;
    if (any && hasSmoothDiffuse && passage.allowed && isSmoothDiffuse(scene, id)) {
        passage.triangles++;
        return;
    }
    if (any || !hasContact || id >= scene.triangleCount || !isGlass(scene, id)) {
        hit = Hit(t, id, weights);
    } else if (t < contact.glass.t || (t == contact.glass.t && id < contact.glass.primitive)) {
        float slack = slackOf(scene, ray, id);
        if (t > slack || from == NONE || isGlass(scene, from)) contact = Contact(Hit(t, id, weights), slack);
    }
}

// How far a ray has to be looked along.
float reach(Hit hit, Contact contact) { return hasContact ? min(hit.t, contact.glass.t + contact.slack) : hit.t; }

// Depth-first traversal, nearer child first; `any` stops at the first hit with t < tMax. The last eight nodes that wait
// are in registers, newest first; when a ninth comes the older four move to memory, together, as each move there costs
// what a node does.
Hit traverse(DeviceScene scene, Ray ray, uint from, float tMax, const bool any, inout Passage passage) {
    uint memory[stackSize];
    uint moved = 0u; // how many are in memory
    uvec4 newer = uvec4(0u);
    uvec4 older = uvec4(0u);
    uint held = 0u; // how many are in registers
    uint node = 0u;
    Hit hit = Hit(tMax, NONE, vec2(0.0));
    Contact contact = Contact(Hit(GREATEST, NONE, vec2(0.0)), 0.0);
    NodePtr nodes = NodePtr(scene.nodes);
    while (true) {
        bool finished = false; // with this subtree
        if ((node & LEAF) == 0u) {
            float left = intersectBox(ray, nodes.at[node].leftLow, nodes.at[node].leftHigh, reach(hit, contact));
            float right = intersectBox(ray, nodes.at[node].rightLow, nodes.at[node].rightHigh, reach(hit, contact));
            uint leftChild = nodes.at[node].left;
            uint rightChild = nodes.at[node].right;
            bool swap = right < left;
            if (left < GREATEST && right < GREATEST) {
                if (stackSize > 8u && held == 8u) {
                    memory[moved] = older.w;
                    memory[moved + 1u] = older.z;
                    memory[moved + 2u] = older.y;
                    memory[moved + 3u] = older.x;
                    moved += 4u;
                    held = 4u;
                }
                if (stackSize > 4u) older = uvec4(newer.w, older.xyz);
                newer = uvec4(swap ? leftChild : rightChild, newer.xyz);
                held++;
            }
            if (left < GREATEST || right < GREATEST) node = swap ? rightChild : leftChild;
            else finished = true;
        }
        // One primitive of a leaf at a time: for lanes that diverge a loop of its own costs more than it saves.
        if (!finished && (node & LEAF) != 0u) {
            intersectLeaf(scene, ray, from, node & LEAF_FIRST, any, hit, contact, passage);
            if (any && hit.primitive != NONE) break;
            if ((node & ~LEAF) >> LEAF_SHIFT != 0u) node += 1u - (1u << LEAF_SHIFT);
            else finished = true;
        }
        if (finished) {
            if (held == 0u) {
                if (stackSize <= 8u || moved == 0u) break;
                moved -= 4u;
                newer = uvec4(memory[moved + 3u], memory[moved + 2u], memory[moved + 1u], memory[moved]);
                held = 4u;
            }
            node = newer.x;
            newer = uvec4(newer.yzw, older.x);
            if (stackSize > 4u) older = uvec4(older.yzw, 0u);
            held--;
        }
    }
    if (!any && hasContact && contact.glass.primitive != NONE && !(hit.t <= contact.glass.t + contact.slack))
        return contact.glass;
    return hit;
}

// The closest hit with t > 0 of a ray that leaves the primitive `from`, or NONE.
Hit closest(DeviceScene scene, vec3 origin, vec3 direction, uint from) {
    Passage none = NO_PASSAGE;
    return traverse(scene, makeRay(origin, direction), from, GREATEST, false, none);
}

// Whether anything stands between two points.
bool occluded(DeviceScene scene, vec3 origin, vec3 target, uint from) {
    Passage none = NO_PASSAGE;
    return traverse(scene, makeRay(origin, target - origin), from, 1.0, true, none).primitive != NONE;
}

// The origin of a ray that goes through the triangle that it leaves, on the other side of it.
vec3 beneath(DeviceScene scene, vec3 origin, vec3 direction, uint from) {
    Primitive p = PrimitivePtr(scene.primitives).at[from];
    vec3 normal = directionOfCross(p.b - p.a, p.c - p.a);
    vec3 side = dot(direction, normal) < 0.0 ? -normal : normal;
    vec3 magnitude = abs(p.a) + abs(p.b) + abs(p.c);
    return offsetPoint(offsetPoint(origin, magnitude, side), magnitude, side);
}

// Whether a light sample is hidden.
bool hidden(DeviceScene scene, ShadowRay ray) {
    Passage passage = Passage(hasSmoothDiffuse && (ray.flags & SHADOW_THROUGH) != 0u, 0u, false);
    bool endless = hasEndless && (ray.flags & SHADOW_ENDLESS) != 0u;
    vec3 way = endless ? ray.target : ray.target - ray.origin;
    if (passage.allowed) {
        ray.origin = beneath(scene, ray.origin, way, ray.from);
        if (!endless) way = ray.target - ray.origin;
    }
    float end = endless ? GREATEST : 1.0;
    bool hit = traverse(scene, makeRay(ray.origin, way), ray.from, end, true, passage).primitive != NONE;
    return hit || (passage.allowed && passage.triangles != 1u);
}

#endif
