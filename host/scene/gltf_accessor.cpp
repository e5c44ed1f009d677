/// Reading of accessors.
#include "scene/gltf_accessor.h"
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace vkpm {

namespace {

enum : uint { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, INT, UNSIGNED_INT, FLOAT };

std::size_t componentBytes(uint type) { return type <= UNSIGNED_BYTE ? 1 : type <= UNSIGNED_SHORT ? 2 : 4; }

bool isIndexType(uint type) { return type == UNSIGNED_BYTE || type == UNSIGNED_SHORT || type == UNSIGNED_INT; }

uint readComponentType(const Reader& reader) {
    const uint type = reader.integer(0, NONE);
    if (type < BYTE || type > FLOAT || type == INT)
        reader.fail(reader.describe(),
                    "allowed are 5120 (byte), 5121, 5122 (short), 5123, 5125 (unsigned int) and 5126 (float)");
    return type;
}

/// On this processor, little-endian as glTF.
template <class T> double valueAt(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return double(value);
}

double componentAt(const char* bytes, uint type) {
    switch (type) {
    case BYTE:
        return valueAt<std::int8_t>(bytes);
    case UNSIGNED_BYTE:
        return valueAt<std::uint8_t>(bytes);
    case SHORT:
        return valueAt<std::int16_t>(bytes);
    case UNSIGNED_SHORT:
        return valueAt<std::uint16_t>(bytes);
    case UNSIGNED_INT:
        return valueAt<std::uint32_t>(bytes);
    default:
        return valueAt<float>(bytes);
    }
}

/// Whole numbers as fractions (glTF 2.0, section 3.11): 127 is 1, and so are -127 and -128 -1.
double asFraction(double value, uint type) {
    constexpr std::array<double, 6> greatest{127, 255, 32767, 65535, 2147483647, 4294967295};
    return type == FLOAT ? value : std::max(value / greatest[type - BYTE], -1.0);
}

} // namespace

GltfAccessor::GltfAccessor(GltfFile& file, const Reader& index, std::string_view type)
    : where{file.referenced(index, "accessors")} {
    Reader& place = where;
    component = readComponentType(place.at("componentType"));
    if (type == "SCALAR" && !isIndexType(component))
        place.at("componentType")
            .fail(place.at("componentType").describe(), "allowed of indices are 5121, 5123 and 5125");
    const Reader typeReader = place.at("type");
    if (typeReader.text() != type) typeReader.fail(typeReader.describe(), fmt::format("needed here is \"{}\"", type));
    components = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : 4;
    if (const auto fractions = place.find("normalized")) normalized = fractions->boolean();
    const Reader countReader = place.at("count");
    size = countReader.integer(1, NONE - 1);

    const std::size_t bytes = componentBytes(component) * static_cast<std::size_t>(components);
    if (place.find("bufferView")) dense = layoutOf(file, place, bytes, size);
    else if (const std::string* elements = file.given(index)) {
        dense = {*elements, bytes};
        if (elements->size() < bytes * size)
            countReader.fail(fmt::format("found {} elements", size), "another primitive has fewer of them packed");
    } else if (size > file.size())
        countReader.fail(fmt::format("found {} elements in no buffer", size),
                         "allowed are as many as the file has bytes");
    if (const auto sparse = place.find("sparse")) readSparse(file, *sparse, bytes);
}

GltfAccessor::Layout GltfAccessor::layoutOf(GltfFile& file, Reader& place, std::size_t bytes, uint count) const {
    const GltfView view = file.view(place.at("bufferView"));
    const auto offset = place.find("byteOffset");
    const std::uint64_t begin = offset ? offset->integer(0, NONE) : 0;
    const std::size_t stride = view.stride.value_or(static_cast<uint>(bytes));
    if (stride < bytes)
        view.place.fail(fmt::format("found a \"byteStride\" of {}", stride),
                        fmt::format("an element has {} bytes", bytes));
    const std::uint64_t end = begin + stride * std::uint64_t{count - 1} + bytes;
    if (end > view.bytes.size())
        place.fail(fmt::format("found {} elements, which end at byte {}", count, end),
                   fmt::format("the buffer view has {}", view.bytes.size()));
    return {view.bytes.substr(begin), stride};
}

void GltfAccessor::readSparse(GltfFile& file, Reader sparse, std::size_t bytes) {
    const uint count = sparse.at("count").integer(1, size);
    Reader indices = sparse.at("indices"), values = sparse.at("values");
    const Reader typeReader = indices.at("componentType");
    const uint type = readComponentType(typeReader);
    if (!isIndexType(type)) typeReader.fail(typeReader.describe(), "allowed are 5121, 5123 and 5125");
    const Layout places = layoutOf(file, indices, componentBytes(type), count);
    changes = layoutOf(file, values, bytes, count);
    changed.reserve(count);
    for (uint i = 0; i < count; ++i) {
        const auto element = static_cast<uint>(componentAt(places.bytes.data() + i * places.stride, type));
        if (element >= size || (i > 0 && element <= changed.back()))
            indices.fail(fmt::format("found element {} at place {}", element, i),
                         fmt::format("allowed are ascending ones below {}", size));
        changed.push_back(element);
    }
}

const char* GltfAccessor::bytesOf(uint element) const {
    if (!changed.empty()) {
        const auto found = std::ranges::lower_bound(changed, element);
        if (found != changed.end() && *found == element)
            return changes.bytes.data() + static_cast<std::size_t>(found - changed.begin()) * changes.stride;
    }
    return dense.bytes.empty() ? nullptr : dense.bytes.data() + element * dense.stride;
}

glm::dvec4 GltfAccessor::at(uint element) const {
    glm::dvec4 values{0};
    const char* const bytes = bytesOf(element);
    for (int i = 0; bytes && i < components; ++i) {
        const double value = componentAt(bytes + static_cast<std::size_t>(i) * componentBytes(component), component);
        values[i] = normalized ? asFraction(value, component) : value;
    }
    return values;
}

uint GltfAccessor::index(uint element) const {
    const char* const bytes = bytesOf(element);
    return bytes ? static_cast<uint>(componentAt(bytes, component)) : 0;
}

} // namespace vkpm
