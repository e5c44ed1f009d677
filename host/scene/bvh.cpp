/// Building of hierarchies: boxes to Embree's builder, its tree to arrays of nodes and leaves.
#include "scene/bvh.h"
#include "scene/box.h"
#include "scene/embree.h"
#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <new>

namespace vkpm {

namespace {

constexpr std::size_t largestLeaf = 4;
static_assert(largestLeaf <= (LEAF >> LEAF_SHIFT));

/// A node of Embree's tree; a leaf has a count and no children.
struct BuildNode {
    BuildNode* children[2] = {nullptr, nullptr};
    Bounds boxes[2];
    uint count = 0;
    uint ids[largestLeaf] = {};
};

struct BuildInput {
    std::span<const Primitive> primitives;
    uint triangleCount;
    int exponent; // Embree sees the scene in units of 2^exponent, so that areas stay within the range of float
};

Bounds toBounds(const RTCBounds& box) {
    return {{box.lower_x, box.lower_y, box.lower_z}, {box.upper_x, box.upper_y, box.upper_z}};
}

// ---- What Embree calls back ----

void* createNode(RTCThreadLocalAllocator allocator, unsigned int, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
}

void setChildren(void* node, void** children, unsigned int count, void*) {
    for (unsigned int i = 0; i < count; ++i)
        static_cast<BuildNode*>(node)->children[i] = static_cast<BuildNode*>(children[i]);
}

void setBoxes(void* node, const RTCBounds** boxes, unsigned int count, void* user) {
    const int exponent = static_cast<const BuildInput*>(user)->exponent;
    for (unsigned int i = 0; i < count; ++i)
        static_cast<BuildNode*>(node)->boxes[i] = scaled(toBounds(*boxes[i]), exponent);
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, std::size_t count, void*) {
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
    assert(count <= largestLeaf);
    for (std::size_t i = 0; i < count; ++i) leaf->ids[leaf->count++] = primitives[i].primID;

    return leaf;
}

// ---- From Embree's tree to arrays ----

class Flattening {
public:
    Flattening(std::span<const Primitive> all, Bvh& result) : primitives{all}, bvh{result} {}

    /// Appends a tree and returns its root as a child: the index of a node, or a leaf.
    uint append(const BuildNode& node) {
        if (node.count > 0) return appendLeaf(node);
        const auto index = static_cast<uint>(bvh.nodes.size());
        bvh.nodes.push_back({node.boxes[0].low, node.boxes[0].high, node.boxes[1].low, node.boxes[1].high, 0, 0});
        bvh.nodes[index].left = append(*node.children[0]);
        bvh.nodes[index].right = append(*node.children[1]);
        return index;
    }

    /// A root for a tree of one leaf. The missing child has an inverted box, and refers to the same leaf in case a box
    /// test that sorts its planes takes that for a box without end.
    void appendOnly(const BuildNode& leaf, const Bounds& box) {
        const uint child = appendLeaf(leaf);
        const Bounds missing;
        bvh.nodes.push_back({box.low, box.high, missing.low, missing.high, child, child});
    }

private:
    uint appendLeaf(const BuildNode& leaf) {
        const auto first = static_cast<uint>(bvh.leaves.size());
        for (uint i = 0; i < leaf.count; ++i) {
            const Primitive& primitive = primitives[leaf.ids[i]];
            bvh.leaves.push_back({primitive.a, primitive.b, primitive.c, leaf.ids[i]});
        }
        return LEAF | (leaf.count - 1) << LEAF_SHIFT | first;
    }

    std::span<const Primitive> primitives;
    Bvh& bvh;
};

/// Nodes on the longest way down: each pushes one child, whichever the order.
uint depthBelow(const Bvh& bvh, uint child) {
    if ((child & LEAF) != 0) return 0;
    return 1 + std::max(depthBelow(bvh, bvh.nodes[child].left), depthBelow(bvh, bvh.nodes[child].right));
}

// ---- The build ----

struct ReleaseEmbree {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using DeviceHandle = std::unique_ptr<RTCDeviceTy, ReleaseEmbree>;
using BvhHandle = std::unique_ptr<RTCBVHTy, ReleaseEmbree>;

void keepMessage(void* message, RTCError, const char* text) { *static_cast<std::string*>(message) = text; }

Bounds boundsOf(std::span<const Primitive> primitives, uint triangleCount) {
    Bounds bounds;
    for (std::size_t i = 0; i < primitives.size(); ++i)
        bounds = united(bounds, boxOf(primitives[i], i >= triangleCount));
    const vec3 sides = bounds.high - bounds.low;
    if (!std::isfinite(sides.x + sides.y + sides.z))
        throw InputError("the scene's bounding box overflows 32-bit floats; make the scene smaller");
    return bounds;
}

std::vector<RTCBuildPrimitive> buildPrimitives(const BuildInput& input) {
    std::vector<RTCBuildPrimitive> boxes;
    boxes.reserve(input.primitives.size());
    for (std::size_t i = 0; i < input.primitives.size(); ++i) {
        const auto id = static_cast<uint>(i);
        const Bounds box = scaled(boxOf(input.primitives[i], id >= input.triangleCount), -input.exponent);
        boxes.push_back({box.low.x, box.low.y, box.low.z, 0, box.high.x, box.high.y, box.high.z, id});
    }
    return boxes;
}

RTCBuildArguments buildArguments(RTCBVH bvh, std::vector<RTCBuildPrimitive>& boxes, BuildInput& input) {
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM; // spatial splits take ten times as long, and rays gain nothing
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 64;
    arguments.maxLeafSize = largestLeaf;
    arguments.bvh = bvh;
    arguments.primitives = boxes.data();
    arguments.primitiveCount = boxes.size();
    arguments.primitiveArrayCapacity = boxes.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBoxes;
    arguments.createLeaf = createLeaf;
    arguments.userPtr = &input;
    return arguments;
}

} // namespace

Bvh buildBvh(std::span<const Primitive> primitives, uint triangleCount) {
    // One thread, so that the tree is the same each time.
    std::string message;
    const DeviceHandle device{rtcNewDevice("threads=1")};
    if (!device) throw std::runtime_error(fmt::format("rtcNewDevice: error {}", int{rtcGetDeviceError(nullptr)}));
    rtcSetDeviceErrorFunction(device.get(), keepMessage, &message);
    const BvhHandle handle{rtcNewBVH(device.get())};

    const Bounds bounds = boundsOf(primitives, triangleCount);
    BuildInput input{primitives, triangleCount, std::ilogb(std::max(reachOf(bounds), double{1e-37f}))};
    std::vector<RTCBuildPrimitive> boxes = buildPrimitives(input);
    const RTCBuildArguments arguments = buildArguments(handle.get(), boxes, input);
    const auto* root = static_cast<const BuildNode*>(rtcBuildBVH(&arguments));
    if (root == nullptr) throw std::runtime_error(fmt::format("rtcBuildBVH: {}", message));

    Bvh bvh;
    Flattening flattening{primitives, bvh};
    if (root->count > 0) flattening.appendOnly(*root, bounds);
    else flattening.append(*root);
    bvh.stackSize = depthBelow(bvh, 0);
    return bvh;
}

void addBvh(Scene& scene) {
    Bvh bvh = buildBvh(scene.primitives, scene.triangleCount);
    scene.nodes = std::move(bvh.nodes);
    scene.leaves = std::move(bvh.leaves);
    scene.stackSize = bvh.stackSize;
}

} // namespace vkpm
