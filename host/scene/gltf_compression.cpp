/// Unpacking by the libraries of the formats, with checks that come before they reserve memory.
#include "scene/gltf_compression.h"
#include <cstring>
#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

namespace vkpm {
namespace {

constexpr std::string_view repair = "the bytes are damaged; write the file again";

// ---- meshoptimizer -----------------------------------------------------------------------------

/// What it packs best, bytes that do not change, becomes 64 times as long.
constexpr std::uint64_t mostOfByte = 64;

void unfilter(const Reader& place, std::size_t filter, void* bytes, std::size_t count, std::size_t stride) {
    if ((filter == 1 && stride != 4 && stride != 8) || (filter == 2 && stride != 8) || (filter == 3 && stride % 4 != 0))
        place.fail(fmt::format("{} beside a \"byteStride\" of {}", place.describe(), stride),
                   "allowed is one of 4 or 8 for OCTAHEDRAL, 8 for QUATERNION, multiples of 4 for EXPONENTIAL");
    if (filter == 1) meshopt_decodeFilterOct(bytes, count, stride);
    if (filter == 2) meshopt_decodeFilterQuat(bytes, count, stride);
    if (filter == 3) meshopt_decodeFilterExp(bytes, count, stride);
}

// ---- Draco -------------------------------------------------------------------------------------

/// Numbers at the begin of a mesh, by which Draco reserves memory (its bitstream specification, version 2.2).
struct DracoHeader {
    std::uint64_t faces = 0, vertices = 0;
    bool sequential = false;
};

std::uint64_t variableLength(std::string_view bytes, std::size_t& at) {
    std::uint64_t value = 0;
    for (int shift = 0; at < bytes.size() && shift < 35; shift += 7) {
        const auto byte = static_cast<unsigned char>(bytes[at++]);
        value |= std::uint64_t{byte & 127u} << shift;
        if (byte < 128) return value;
    }
    return ~0ull;
}

DracoHeader readDracoHeader(const Reader& place, std::string_view bytes) {
    if (bytes.size() < 16 || !bytes.starts_with("DRACO")) place.fail("found no mesh that Draco packed", repair);
    const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(bytes[at]); };
    if (byte(5) != 2 || byte(6) != 2 || byte(7) != 1 || byte(8) > 1 || byte(10) >= 128)
        place.fail(
            fmt::format("found version {}.{} of Draco, geometry {}, method {}", byte(5), byte(6), byte(7), byte(8)),
            "allowed is a mesh of version 2.2 without metadata; write it with a program of today");
    std::size_t at = 11;
    DracoHeader header{.sequential = byte(8) == 0};
    if (!header.sequential) header.vertices = variableLength(bytes, ++at);
    header.faces = variableLength(bytes, at);
    if (header.sequential) header.vertices = variableLength(bytes, at);
    return header;
}

template <class T> bool convert(const draco::PointAttribute& from, uint point, std::size_t components, char* to) {
    T values[4]{};
    const draco::AttributeValueIndex index = from.mapped_index(draco::PointIndex(point));
    if (index.value() >= from.size() || !from.ConvertValue<T>(index, static_cast<std::int8_t>(components), values))
        return false;
    std::memcpy(to, values, components * sizeof(T));
    return true;
}

/// An element in the type of its accessor.
bool convert(const draco::PointAttribute& from, uint point, uint type, std::size_t components, char* to) {
    switch (type) {
    case 5120:
        return convert<std::int8_t>(from, point, components, to);
    case 5121:
        return convert<std::uint8_t>(from, point, components, to);
    case 5122:
        return convert<std::int16_t>(from, point, components, to);
    case 5123:
        return convert<std::uint16_t>(from, point, components, to);
    case 5125:
        return convert<std::uint32_t>(from, point, components, to);
    default:
        return convert<float>(from, point, components, to);
    }
}

/// What an accessor says that it has.
struct Elements {
    Reader place;
    uint type, count;
    std::size_t components, bytes; // of an element
};

Elements elementsOf(const GltfFile& file, const Reader& index) {
    Reader place = file.referenced(index, "accessors");
    const Reader type = place.at("componentType");
    const uint component = type.integer(5120, 5126);
    const std::size_t components = 1 + place.at("type").choice({"SCALAR", "VEC2", "VEC3", "VEC4"});
    if (component == 5124) type.fail(type.describe(), "allowed are 5120 to 5123, 5125 and 5126");
    return {place, component, place.at("count").integer(1, NONE - 1), components,
            components * (component < 5122   ? 1u
                          : component < 5124 ? 2u
                                             : 4u)};
}

std::unique_ptr<draco::Mesh> decode(const Reader& place, std::string_view bytes) {
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    try {
        auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
        if (mesh.ok()) return std::move(mesh).value();
        place.fail(fmt::format("Draco says: {}", mesh.status().error_msg_string()), repair);
    } catch (const std::bad_alloc&) {
    } catch (const std::length_error&) {
    }
    place.fail("found a mesh for which there is not enough memory", repair);
}

void giveFaces(GltfFile& file, const Reader& index, const Elements& elements, const draco::Mesh& mesh) {
    std::string bytes(elements.bytes * elements.count, '\0');
    for (uint i = 0; i < elements.count; ++i) {
        const uint corner = mesh.face(draco::FaceIndex(i / 3))[i % 3].value();
        std::memcpy(bytes.data() + i * elements.bytes, &corner, elements.bytes); // of a machine that is little-endian
    }
    file.give(index, std::move(bytes));
}

void giveAttribute(GltfFile& file, const Reader& index, const Elements& elements, const draco::Mesh& mesh,
                   const Reader& id) {
    const draco::PointAttribute* const from = mesh.GetAttributeByUniqueId(id.integer(0, NONE));
    if (!from || from->num_components() != static_cast<int>(elements.components))
        id.fail(id.describe(), from ? "the accessor has elements of another length" : "the mesh has no such attribute");
    std::string bytes(elements.bytes * elements.count, '\0');
    for (uint i = 0; i < elements.count; ++i)
        if (!convert(*from, i, elements.type, elements.components, bytes.data() + i * elements.bytes))
            elements.place.fail(fmt::format("element {} is no number of its type", i), repair);
    file.give(index, std::move(bytes));
}

} // namespace

std::optional<Reader> meshoptOf(Reader& view) {
    auto extensions = view.find("extensions");
    if (!extensions) return std::nullopt;
    auto found = extensions->find("EXT_meshopt_compression");
    return found ? found : extensions->find("KHR_meshopt_compression");
}

std::string unpackMeshopt(Reader extension, std::string_view packed) {
    const Reader countReader = extension.at("count"), strideReader = extension.at("byteStride");
    const std::uint64_t count = countReader.integer(1, NONE), stride = strideReader.integer(1, 256);
    const std::size_t mode = extension.at("mode").choice({"ATTRIBUTES", "TRIANGLES", "INDICES"});
    const auto filter = extension.find("filter");
    if (mode == 0 ? stride % 4 != 0 : stride != 2 && stride != 4)
        strideReader.fail(strideReader.describe(),
                          "allowed are multiples of 4 to 256 of attributes, 2 and 4 of indices");
    if (mode == 1 && count % 3 != 0) countReader.fail(countReader.describe(), "allowed are three for each triangle");
    if (count * stride > mostOfByte * packed.size() + 4096)
        countReader.fail(fmt::format("found {} elements of {} bytes in {}", count, stride, packed.size()), repair);
    std::string bytes(count * stride, '\0');
    const auto* const from = reinterpret_cast<const unsigned char*>(packed.data());
    const std::size_t size = packed.size();
    const int failed = mode == 0   ? meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, size)
                       : mode == 1 ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, size)
                                   : meshopt_decodeIndexSequence(bytes.data(), count, stride, from, size);
    if (failed != 0) extension.fail("found bytes that meshoptimizer cannot unpack", repair);
    if (filter)
        unfilter(*filter, filter->choice({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}), bytes.data(), count,
                 stride);
    return bytes;
}

void unpackDraco(GltfFile& file, Reader primitive) {
    auto extensions = primitive.find("extensions");
    auto draco = extensions ? extensions->find("KHR_draco_mesh_compression") : std::nullopt;
    if (!draco) return;
    const GltfView view = file.view(draco->at("bufferView"));
    Reader ids = draco->at("attributes"), attributes = primitive.at("attributes");
    const Reader indices = primitive.at("indices"), positions = attributes.at("POSITION");
    const Elements corners = elementsOf(file, indices), points = elementsOf(file, positions);

    const DracoHeader header = readDracoHeader(view.place, view.bytes);
    const auto refuse = [&](const Elements& elements, std::uint64_t found) {
        elements.place.fail(fmt::format("found {} elements", elements.count), fmt::format("the mesh has {}", found));
    };
    if (corners.components != 1) corners.place.fail("found indices that are no numbers", "allowed is \"SCALAR\"");
    if (3 * header.faces != corners.count) refuse(corners, 3 * header.faces);
    if (header.sequential ? header.vertices != points.count : header.vertices > points.count)
        refuse(points, header.vertices);
    if (header.faces > 1024 * view.bytes.size() || points.count > 1024 * view.bytes.size())
        view.place.fail(fmt::format("found {} faces in {} bytes", header.faces, view.bytes.size()), repair);

    const std::unique_ptr<draco::Mesh> mesh = decode(view.place, view.bytes);
    if (mesh->num_faces() * std::uint64_t{3} != corners.count) refuse(corners, mesh->num_faces() * std::uint64_t{3});
    if (mesh->num_points() != points.count) refuse(points, mesh->num_points());
    giveFaces(file, indices, corners, *mesh);
    for (const std::string& name : ids.keys()) {
        const Reader accessor = attributes.at(name);
        const Elements elements = elementsOf(file, accessor);
        if (elements.count != points.count) refuse(elements, points.count);
        giveAttribute(file, accessor, elements, *mesh, ids.at(name));
    }
}

} // namespace vkpm
