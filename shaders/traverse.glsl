// The closest hit, or any hit, of a ray with the scene; needs intersect.glsl.

vec3 loadVec3(floatPtr numbers, uvec3 at) {
    return vec3(numbers.at[at.x], numbers.at[at.y], numbers.at[at.z]);
}

// One leaf primitive; a nearer hit replaces `hit`, and of two at the same distance the lower primitive wins,
// so that the result does not depend on the tree. A ray cannot hit the triangle `from` that it leaves.
void intersectLeaf(DeviceScene scene, Ray ray, uint from, uint slot, inout Hit hit) {
    uint id = LeafPtr(scene.leaves).at[slot].id;
    vec2 weights = vec2(0.0);
    float t;
    if (hasSpheres != 0u && (hasTriangles == 0u || id >= scene.triangleCount)) {
        t = intersectSphere(ray, LeafPtr(scene.leaves).at[slot].a, LeafPtr(scene.leaves).at[slot].b.x,
            LeafPtr(scene.leaves).at[slot].c);
    } else {
        // Loads in the order of the ray's axes save the exchange.
        floatPtr numbers = floatPtr(scene.leaves);
        uvec3 at = LEAF_WORDS * slot + ray.axes;
        vec3 a = loadVec3(numbers, at);
        vec3 b = loadVec3(numbers, at + 3u);
        vec3 c = loadVec3(numbers, at + 6u);
        t = id == from ? -1.0 : intersectPermuted(ray, a, b, c, weights);
    }
    if (t > 0.0 && (t < hit.t || (t == hit.t && hit.primitive != NONE && id < hit.primitive))) hit = Hit(t, id, weights);
}

// Depth-first traversal, nearer child first; `any` stops at the first hit with t < tMax.
Hit traverse(DeviceScene scene, Ray ray, uint from, float tMax, const bool any) {
    uint stack[stackSize];
    uint depth = 0u;
    uint node = 0u;
    Hit hit = Hit(tMax, NONE, vec2(0.0));
    NodePtr nodes = NodePtr(scene.nodes);
    floatPtr planes = floatPtr(scene.nodes);
    while (true) {
        bool finished = false; // with this subtree
        if ((node & LEAF) == 0u) {
            uvec3 near = NODE_WORDS * node + ray.near;
            uvec3 far = NODE_WORDS * node + ray.far;
            float left = intersectSlabs(ray, loadVec3(planes, near), loadVec3(planes, far), hit.t);
            float right = intersectSlabs(ray, loadVec3(planes, near + 6u), loadVec3(planes, far + 6u), hit.t);
            uint leftChild = nodes.at[node].left;
            uint rightChild = nodes.at[node].right;
            bool swap = right < left;
            if (max(left, right) < INFINITY) stack[depth++] = swap ? leftChild : rightChild;
            if (min(left, right) < INFINITY) node = swap ? rightChild : leftChild;
            else finished = true;
        }
        // One primitive of a leaf at a time: for lanes that diverge a loop of its own costs more than it saves.
        if (!finished && (node & LEAF) != 0u) {
            intersectLeaf(scene, ray, from, node & LEAF_FIRST, hit);
            if (any && hit.primitive != NONE) break;
            if ((node & ~LEAF) >> LEAF_SHIFT != 0u) node += 1u - (1u << LEAF_SHIFT);
            else finished = true;
        }
        if (finished) {
            if (depth == 0u) break;
            node = stack[--depth];
        }
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
