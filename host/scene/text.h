/// Text files, read within limits, and what is said of them: one printable line with file and place.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vkpm {

const std::uint64_t maxSceneBytes = 64ull << 20; // of a scene file; a mesh has files of its own
const std::uint64_t maxMeshBytes = 1ull << 30;

/// Why a file cannot be read as text; empty if it can. Only a regular file is sure to have an end.
std::string fileProblem(const std::filesystem::path& file, bool regular = false);

/// Whether a name has an ending, such as ".ply", in letters of any size.
bool hasEnding(const std::filesystem::path& file, std::string_view ending);

/// A file that was read, with the hash of the bytes that came, see hashText.
struct FileRead {
    std::filesystem::path path;
    std::string hash;
};

/// The contents of a file as they are; `read`, if it is not null, notes the file. Throws InputError if there is more of
/// it than `most` bytes, and std::runtime_error if reading fails.
std::string readBytes(const std::filesystem::path& file, std::uint64_t most, std::string_view advice,
                      FileRead* read = nullptr);

/// The contents of a file without byte order mark, likewise; a byte 0 is refused.
std::string readText(const std::filesystem::path& file, std::uint64_t most, std::string_view advice,
                     FileRead* read = nullptr);

/// Text as a terminal may show it: control characters and what is not UTF-8 as \xNN, the middle left out beyond `most`
/// bytes.
std::string printable(std::string_view text, std::size_t most = 300);

/// The candidate that is nearest to a misspelt word by edit distance; empty if none is near.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// `"a", "b" or "c"`, for messages; of many words the first 20.
std::string quotedList(const std::vector<std::string>& words);

/// Throws InputError, "file<place>: found; allowed"; the place is ":line", ":line:column" or ": /json/pointer".
[[noreturn]] void refuseFile(const std::filesystem::path& file, std::string_view place, std::string_view found,
                             std::string_view allowed);

} // namespace vkpm
