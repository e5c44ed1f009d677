/// Names to files.
#include "output/used_files.h"
#include "error.h"
#include <fmt/format.h>

namespace vkpm {

namespace fs = std::filesystem;

/// Where a file is or will be: links followed, also one that points to nothing yet.
static fs::path placeOf(fs::path path) {
    std::error_code error;
    for (int links = 0; links < 40 && fs::is_symlink(fs::symlink_status(path, error)); links++) {
        const fs::path target = fs::read_symlink(path, error);
        path = target.is_absolute() ? target : path.parent_path() / target;
    }
    const fs::path place = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? path.lexically_normal() : place;
}

bool areOneFile(const fs::path& a, const fs::path& b) {
    std::error_code error;
    const fs::file_status one = fs::status(a, error), other = fs::status(b, error);
    if (fs::exists(one) && fs::exists(other))
        return fs::is_regular_file(one) && fs::is_regular_file(other) && fs::equivalent(a, b, error);
    return !fs::exists(one) && !fs::exists(other) && placeOf(a) == placeOf(b);
}

void requireApart(std::span<const UsedFile> written, std::span<const UsedFile> read) {
    const auto refuse = [](const UsedFile& output, const UsedFile& other) {
        throw InputError(fmt::format("{}: found \"{}\", the same file as {} (\"{}\"); allowed: a file of its own",
                                     output.what, output.path.string(), other.what, other.path.string()));
    };
    for (std::size_t i = 0; i < written.size(); i++) {
        for (const UsedFile& other : written.first(i))
            if (areOneFile(written[i].path, other.path)) refuse(written[i], other);
        for (const UsedFile& input : read)
            if (areOneFile(written[i].path, input.path)) refuse(written[i], input);
    }
}

} // namespace vkpm
