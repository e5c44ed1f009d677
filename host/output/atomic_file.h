/// Files that are replaced as a whole: written beside the old one, flushed, then renamed over it.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace vkpm {

/// A file that is written piece by piece and takes the place of what was there once it is whole, or not at all. A
/// device or pipe gets all at the end. Throws std::runtime_error with file, call, cause and what helps.
class FileReplacement {
public:
    explicit FileReplacement(const std::filesystem::path& path);
    ~FileReplacement();

    void write(std::span<const char> bytes, std::uint64_t offset);
    void commit();

private:
    struct Parts;
    std::unique_ptr<Parts> parts;
};

/// Makes `bytes` the content of the file, or leaves what was there; a device or pipe is written directly.
/// Throws std::runtime_error with file, call, cause and what helps.
void replaceFile(const std::filesystem::path& path, std::span<const char> bytes);

/// Throws as replaceFile would if a file could not be created there: to be asked before a long render. Removes what
/// killed processes have left beside it.
void requireWritable(const std::filesystem::path& path);

} // namespace vkpm
