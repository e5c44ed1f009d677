/// Models of glTF whose meshes are compressed, by each method, made of one sheet of triangles.
#pragma once
#include "gltf_text.h"
#include <cmath>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

namespace vkpm {

enum class Packing { none, dracoSequential, dracoEdgebreaker, meshopt };

/// A wavy sheet of 2 x 2 squares.
struct Sheet {
    std::vector<float> points;
    std::vector<unsigned> corners;

    Sheet() {
        for (unsigned y = 0; y <= 2; y++)
            for (unsigned x = 0; x <= 2; x++) {
                points.insert(points.end(), {float(x), float(y), std::sin(float(x + 2 * y))});
                if (x == 2 || y == 2) continue;
                const unsigned a = 3 * y + x;
                corners.insert(corners.end(), {a, a + 1, a + 4, a, a + 4, a + 3});
            }
    }
};

/// The bytes of Draco, and the number of points that it makes of the sheet.
inline std::pair<std::vector<char>, std::size_t> packedByDraco(const Sheet& sheet, bool sequential) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(int(sheet.corners.size() / 3));
    const int places = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (unsigned i = 0; i < sheet.corners.size() / 3; i++) {
        const auto point = [&](unsigned k) { return &sheet.points[3 * sheet.corners[3 * i + k]]; };
        builder.SetAttributeValuesForFace(places, draco::FaceIndex(i), point(0), point(1), point(2));
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(sequential ? draco::MESH_SEQUENTIAL_ENCODING : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) return {};
    return {{buffer.data(), buffer.data() + buffer.size()}, mesh->num_points()};
}

inline GltfText packedModel(Packing packing) {
    const Sheet sheet;
    GltfText model;
    std::size_t points = sheet.points.size() / 3;
    nlohmann::json& json = model.json;
    nlohmann::json primitive;
    const auto accessor = [&](const char* type, int component, std::size_t count) {
        json["accessors"].push_back({{"componentType", component}, {"type", type}, {"count", count}});
        return json["accessors"].size() - 1;
    };
    if (packing == Packing::none) {
        primitive = {{"attributes", {{"POSITION", model.add(sheet.points, "VEC3")}}},
                     {"indices", model.add(sheet.corners, "SCALAR")}};
    } else if (packing != Packing::meshopt) {
        const auto [bytes, count] = packedByDraco(sheet, packing == Packing::dracoSequential);
        primitive = {{"attributes", {{"POSITION", accessor("VEC3", 5126, count)}}},
                     {"indices", accessor("SCALAR", 5125, sheet.corners.size())}};
        primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", model.addView(bytes)},
                                                                 {"attributes", {{"POSITION", 0}}}};
        json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    } else {
        std::vector<unsigned char> vertices(meshopt_encodeVertexBufferBound(points, 12)),
            triangles(meshopt_encodeIndexBufferBound(sheet.corners.size(), points));
        vertices.resize(meshopt_encodeVertexBuffer(vertices.data(), vertices.size(), sheet.points.data(), points, 12));
        triangles.resize(
            meshopt_encodeIndexBuffer(triangles.data(), triangles.size(), sheet.corners.data(), sheet.corners.size()));
        const auto view =
            [&](const std::vector<unsigned char>& bytes, std::size_t count, int stride, const char* mode) {
            const std::size_t index = model.addView(bytes);
            nlohmann::json& all = json["bufferViews"][index];
            nlohmann::json packed = all;
            packed.update({{"count", count}, {"byteStride", stride}, {"mode", mode}});
            all.update({{"buffer", 0}, {"byteLength", count * std::size_t(stride)}});
            all["extensions"]["EXT_meshopt_compression"] = packed;
            return index;
        };
        const std::size_t places = accessor("VEC3", 5126, points),
                          indices = accessor("SCALAR", 5125, sheet.corners.size());
        json["accessors"][places]["bufferView"] = view(vertices, points, 12, "ATTRIBUTES");
        json["accessors"][indices]["bufferView"] = view(triangles, sheet.corners.size(), 4, "TRIANGLES");
        primitive = {{"attributes", {{"POSITION", places}}}, {"indices", indices}};
        json["extensionsRequired"] = {"EXT_meshopt_compression"};
    }
    json["meshes"] = {{{"primitives", {primitive}}}};
    json["nodes"] = {{{"mesh", 0}}};
    return model;
}

} // namespace vkpm
