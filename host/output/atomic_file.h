/// Files that are replaced as a whole: written beside the old one, flushed, then renamed over it.
#pragma once
#include <filesystem>
#include <span>

namespace vkpm {

/// Makes `bytes` the content of the file, or leaves what was there; a device or pipe is written directly.
/// Throws std::runtime_error with file, call, cause and what helps.
void replaceFile(const std::filesystem::path& path, std::span<const char> bytes);

/// Throws as replaceFile would if a file could not be created there: to be asked before a long render. Removes what killed
/// processes have left beside it.
void requireWritable(const std::filesystem::path& path);

} // namespace vkpm
