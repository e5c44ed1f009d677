/// A glTF 2.0 file (Khronos 2021), .gltf or .glb: its JSON, and the buffers that it names.
#pragma once
#include "scene/reader.h"
#include "scene/text.h"
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

/// Bytes of a buffer that an accessor reads.
struct GltfView {
    Reader place;
    std::string_view bytes;
    std::optional<uint> stride;
};

class GltfFile {
public:
    /// Throws InputError for what is no glTF 2.0, and for extensions that it requires and vkpm has not.
    explicit GltfFile(std::filesystem::path path);
    GltfFile(const GltfFile&) = delete; // readers point into it
    GltfFile& operator=(const GltfFile&) = delete;

    Reader root() const { return Reader{file, json}; }
    /// The element of a list at the top, such as "accessors", that an index refers to.
    Reader referenced(const Reader& index, std::string_view list) const;
    GltfView view(const Reader& index);
    /// Elements of an accessor, one behind the other, that its file has packed; and what was given of it, or null.
    void give(const Reader& accessor, std::string elements) {
        unpacked[accessor.integer(0, NONE)] = std::move(elements);
    }
    const std::string* given(const Reader& accessor) const;
    /// The bytes of an element of "images".
    std::string image(Reader& place);
    const std::filesystem::path& name() const { return file; }

    const std::vector<FileRead>& files() const { return read; }
    std::uint64_t size() const { return bytesRead; } // of all that was read so far

private:
    void openBinary();
    void requireExtensions() const;
    const std::string& buffer(const Reader& index);
    std::string_view bytesOf(Reader place);
    std::string loadBuffer(Reader place, std::size_t number);
    std::string loadUri(const Reader& uri);
    std::string loadFile(const Reader& uri, const std::string& text);

    std::filesystem::path file;
    std::string whole;
    std::optional<std::string> binary; // the second chunk of a .glb
    nlohmann::json json;
    std::vector<std::optional<std::string>> buffers;
    std::map<uint, std::string> unpackedViews, unpacked; // of views and accessors by their indices
    std::vector<FileRead> read;
    std::uint64_t bytesRead = 0;
};

/// Whether vkpm reads an extension, or says what it leaves out of it.
bool isKnownExtension(std::string_view name);

/// Whether a file is to be read as glTF, by the end of its name.
bool isGltfName(const std::filesystem::path& file);

} // namespace vkpm
