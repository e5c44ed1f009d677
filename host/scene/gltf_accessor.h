/// Accessors of glTF (2.0, section 3.6.2): arrays of numbers and vectors of all types, dense and sparse.
#pragma once
#include "scene/gltf_file.h"
#include <array>

namespace vkpm {

class GltfAccessor {
public:
    /// `type` is "SCALAR", "VEC2", "VEC3" or "VEC4". Throws InputError unless all elements lie in their buffers.
    GltfAccessor(GltfFile& file, const Reader& index, std::string_view type);

    uint count() const { return size; }
    const Reader& place() const { return where; }
    /// An element, of which numbers that are normalized are fractions, and what the type lacks is 0.
    glm::dvec4 at(uint element) const;
    uint index(uint element) const; // of an array of whole numbers without sign

private:
    struct Layout {
        std::string_view bytes;
        std::size_t stride = 0;
    };

    Layout layoutOf(GltfFile& file, Reader& place, std::size_t bytes, uint count) const;
    void readSparse(GltfFile& file, Reader sparse, std::size_t bytes);
    const char* bytesOf(uint element) const;

    Reader where;
    uint size = 0;
    uint component = 0; // 5120 to 5126, as in the file
    int components = 0;
    bool normalized = false;
    Layout dense;              // without bytes: all elements are 0
    std::vector<uint> changed; // elements that "sparse" replaces, ascending
    Layout changes;
};

} // namespace vkpm
