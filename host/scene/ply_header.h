/// The header of a PLY file (Turk 1994): which elements it has, and of what properties they are.
#pragma once
#include "shared.h"
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat { ascii, littleEndian, bigEndian };

struct PlyProperty {
    std::string name;
    PlyType type{};
    std::optional<PlyType> countType; // of a list
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
    std::size_t line = 0; // in the header

    /// The place of the first property of one of these names; NONE if there is none.
    uint find(std::initializer_list<std::string_view> names) const;
};

struct PlyHeader {
    PlyFormat format{};
    std::vector<PlyElement> elements;
    std::size_t bytes = 0; // of the header
    std::size_t lines = 0;
};

/// Bytes of a value in a binary file.
std::size_t plyBytes(PlyType type);

/// The header at the start of a file's bytes. Throws InputError with file:line.
PlyHeader readPlyHeader(const std::filesystem::path& file, std::string_view bytes);

} // namespace vkpm
