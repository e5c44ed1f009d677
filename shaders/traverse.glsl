// The closest hit, or any hit, of a ray with the scene; needs intersect.glsl.

// One leaf primitive; a nearer hit replaces `hit`, and of two at the same distance the lower primitive wins,
// so that the result does not depend on the tree. A ray cannot hit the triangle `from` that it leaves.
void intersectLeaf(DeviceScene scene, Ray ray, uint from, uint slot, inout Hit hit) {
    vec3 a = scene.leaves.at[slot].a;
    vec3 b = scene.leaves.at[slot].b;
    uint id = scene.leaves.at[slot].id;
    vec2 weights = vec2(0.0);
    float t;
    if (hasSpheres != 0u && (hasTriangles == 0u || id >= scene.triangleCount)) t = intersectSphere(ray, a, b.x);
    else t = id == from ? -1.0 : intersectTriangle(ray, a, b, scene.leaves.at[slot].c, weights);
    if (t > 0.0 && (t < hit.t || (t == hit.t && id < hit.primitive))) hit = Hit(t, id, weights);
}

// Depth-first traversal, nearer child first; `any` stops at the first hit with t < tMax.
Hit traverse(DeviceScene scene, Ray ray, uint from, float tMax, const bool any) {
    uint stack[stackSize];
    uint depth = 0u;
    uint node = 0u;
    Hit hit = Hit(tMax, NONE, vec2(0.0));
    while (true) {
        if ((node & LEAF) != 0u) {
            uint first = node & LEAF_FIRST;
            uint last = first + ((node & ~LEAF) >> LEAF_SHIFT);
            for (uint slot = first; slot <= last; slot++) intersectLeaf(scene, ray, from, slot, hit);
            if (any && hit.primitive != NONE) break;
        } else {
            Node n = scene.nodes.at[node];
            float left = intersectBox(ray, n.leftLow, n.leftHigh, hit.t);
            float right = intersectBox(ray, n.rightLow, n.rightHigh, hit.t);
            bool swap = right < left;
            if (max(left, right) < INFINITY) stack[depth++] = swap ? n.left : n.right;
            if (min(left, right) < INFINITY) {
                node = swap ? n.right : n.left;
                continue;
            }
        }
        if (depth == 0u) break;
        node = stack[--depth];
    }
    return hit;
}

// The closest hit with t > 0 of a ray that leaves the primitive `from`, or NONE.
Hit closest(DeviceScene scene, vec3 origin, vec3 direction, uint from) {
    return traverse(scene, makeRay(origin, direction), from, INFINITY, false);
}

// Whether anything stands between two points.
bool occluded(DeviceScene scene, vec3 origin, vec3 target, uint from) {
    return traverse(scene, makeRay(origin, target - origin), from, 1.0, true).primitive != NONE;
}
