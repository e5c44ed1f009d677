/// Which files a command reads and writes: none is both, and no two results go to one file.
#pragma once
#include <filesystem>
#include <span>
#include <string>

namespace vkpm {

/// A file and what it is for the user, such as "--stats" or "a file of the scene".
struct UsedFile {
    std::string what;
    std::filesystem::path path;
};

/// Whether two names stand for one file that has a content of its own: links and other spellings count, devices and
/// pipes do not.
bool areOneFile(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws InputError if a file that is to be written is one that is read, or another that is written.
void requireApart(std::span<const UsedFile> written, std::span<const UsedFile> read);

} // namespace vkpm
