/// A check of OBJ text line by line, for the loader proper reads garbage leniently.
#pragma once
#include <filesystem>
#include <string>

namespace vkpm {

/// Throws InputError with file:line unless all vertices and normals are finite, all faces refer to existing ones, and
/// there is a face.
void checkObj(const std::filesystem::path& file, const std::string& text);

} // namespace vkpm
