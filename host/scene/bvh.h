/// Bounding volume hierarchies of triangles and spheres, built by Embree and laid out for the kernels.
#pragma once
#include "scene/scene.h"
#include "shared_scene.h"
#include <span>
#include <vector>

namespace vkpm {

struct Bvh {
    std::vector<Node> nodes; // depth first, node 0 is the root
    std::vector<Leaf> leaves;
    /// Entries of the stack at most, at least 1, if a traversal pushes the farther child and descends into the nearer.
    uint stackSize = 1;
};

/// The hierarchy of `primitives`, of which the first `triangleCount` are triangles and the others spheres (centre a,
/// radius b.x), at least one and at most LEAF_FIRST: binned surface area heuristic (Wald 2007), each primitive in one
/// leaf. The same input gives the same hierarchy. Throws InputError if boxes overflow, std::runtime_error if Embree
/// fails.
Bvh buildBvh(std::span<const Primitive> primitives, uint triangleCount);

/// Puts the hierarchy of a scene's primitives into the scene.
void addBvh(Scene& scene);

} // namespace vkpm
