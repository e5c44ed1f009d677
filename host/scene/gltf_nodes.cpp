/// The walk along the nodes of a glTF scene.
#include "scene/gltf_nodes.h"
#include "scene/gltf_accessor.h"
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

namespace vkpm {
using glm::dmat4, glm::dquat, glm::dvec3, glm::dvec4;

namespace {

dvec4 readFour(const Reader& reader) {
    const std::vector<Reader> parts = reader.elements(4, 4, "an array of 4 numbers, [x, y, z, w]");
    return {parts[0].precise(), parts[1].precise(), parts[2].precise(), parts[3].precise()};
}

dmat4 rotationOf(dvec4 q, const Reader& where) {
    const double length = glm::length(q);
    if (!(length > 0) || !std::isfinite(length))
        where.fail("found a rotation of length 0", "allowed is a unit quaternion");
    q /= length;
    return glm::mat4_cast(dquat{q.w, q.x, q.y, q.z});
}

/// The map of a node's coordinates to its parent's: "matrix", column by column, or scale, rotation and translation.
dmat4 localMatrix(Reader node) {
    dmat4 matrix{1};
    if (const auto columns = node.find("matrix")) {
        const std::vector<Reader> entries = columns->elements(16, 16, "an array of 16 numbers, column by column");
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = entries[static_cast<std::size_t>(i)].precise();
        if (matrix[0].w != 0 || matrix[1].w != 0 || matrix[2].w != 0 || matrix[3].w != 1)
            columns->fail("the last row is not 0 0 0 1", "only affine matrices are allowed");
        return matrix;
    }
    if (const auto translation = node.find("translation")) matrix = glm::translate(matrix, translation->place());
    if (const auto rotation = node.find("rotation")) matrix *= rotationOf(readFour(*rotation), *rotation);
    if (const auto scale = node.find("scale")) matrix = glm::scale(matrix, scale->place());
    return matrix;
}

class NodeWalk {
public:
    NodeWalk(GltfFile& from, Losses& lost) : file{from}, losses{lost} {}

    GltfNodes walk() {
        const auto nodes = file.root().find("nodes");
        visited.resize(nodes ? nodes->count(0, NONE, "an array of nodes") : 0);
        pushRoots();
        if (const auto moves = file.root().find("animations"))
            losses.add(*moves, "animations are left out: all is where its node is");
        while (!stack.empty()) {
            const auto [index, parent] = std::move(stack.back());
            stack.pop_back();
            visit(index, parent);
        }
        return std::move(found);
    }

private:
    void pushRoots() {
        const auto scenes = file.root().find("scenes");
        if (scenes && scenes->count(0, NONE, "an array of scenes") > 0) {
            const auto chosen = file.root().find("scene");
            Reader scene = chosen ? file.referenced(*chosen, "scenes") : scenes->element(0);
            if (const auto roots = scene.find("nodes")) push(*roots, dmat4{1});
            if (scenes->count(0, NONE, "") > 1)
                losses.add(*scenes, "all scenes but the file's default one are left out");
            return;
        }
        // Without a scene: all nodes that are no children.
        const auto nodes = file.root().find("nodes");
        std::vector<bool> isChild(visited.size());
        for (std::size_t i = 0; i < visited.size(); ++i)
            if (const auto children = nodes->element(i).find("children"))
                for (std::size_t k = 0; k < children->count(0, NONE, "an array of nodes"); ++k)
                    isChild[children->element(k).integer(0, static_cast<uint>(visited.size() - 1))] = true;
        for (std::size_t i = visited.size(); i-- > 0;)
            if (!isChild[i]) visited[i] = true, stack.push_back({nodes->element(i), dmat4{1}});
    }

    /// The first of them is visited first.
    void push(const Reader& children, const dmat4& parent) {
        for (std::size_t i = children.count(0, NONE, "an array of nodes"); i-- > 0;) {
            const Reader index = children.element(i);
            const Reader node = file.referenced(index, "nodes");
            const uint number = index.integer(0, NONE);
            if (visited[number])
                index.fail(fmt::format("found node {} a second time", number),
                           "a node has one parent, and none of its own children");
            visited[number] = true;
            stack.push_back({node, parent});
        }
    }

    void visit(Reader node, const dmat4& parent) {
        const dmat4 matrix = parent * localMatrix(node);
        if (const auto mesh = node.find("mesh")) placeMesh(node, *mesh, matrix);
        if (const auto camera = node.find("camera")) found.cameras.push_back({matrix, node, *camera});
        if (auto extensions = node.find("extensions"))
            if (auto punctual = extensions->find("KHR_lights_punctual"))
                found.lights.push_back({matrix, node, punctual->at("light")});
        if (node.find("skin")) losses.add(node, "a skin is left out: the mesh is as it was modelled, at its own node");
        if (const auto children = node.find("children")) push(*children, matrix);
    }

    void placeMesh(Reader& node, const Reader& mesh, const dmat4& matrix) {
        auto extensions = node.find("extensions");
        auto instancing = extensions ? extensions->find("EXT_mesh_gpu_instancing") : std::nullopt;
        if (!instancing) return found.meshes.push_back({matrix, node, mesh});
        Reader attributes = instancing->at("attributes");
        std::optional<GltfAccessor> parts[3];
        constexpr const char* names[] = {"TRANSLATION", "ROTATION", "SCALE"};
        uint count = 0;
        for (int i = 0; i < 3; ++i) {
            const auto reader = attributes.find(names[i]);
            if (!reader) continue;
            parts[i].emplace(file, *reader, i == 1 ? "VEC4" : "VEC3");
            if (count != 0 && parts[i]->count() != count)
                reader->fail(fmt::format("found {} elements", parts[i]->count()),
                             fmt::format("the attribute before has {}", count));
            count = parts[i]->count();
        }
        for (uint i = 0; i < count; ++i) {
            dmat4 instance = matrix;
            if (parts[0]) instance = glm::translate(instance, dvec3{parts[0]->at(i)});
            if (parts[1]) instance *= rotationOf(parts[1]->at(i), parts[1]->place());
            if (parts[2]) instance = glm::scale(instance, dvec3{parts[2]->at(i)});
            found.meshes.push_back({instance, node, mesh});
        }
    }

    GltfFile& file;
    Losses& losses;
    GltfNodes found;
    std::vector<bool> visited;
    std::vector<std::pair<Reader, dmat4>> stack;
};

} // namespace

GltfNodes readGltfNodes(GltfFile& file, Losses& losses) { return NodeWalk{file, losses}.walk(); }

} // namespace vkpm
