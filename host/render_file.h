/// The EXR file of a render: its picture, the sums it can go on from, and what it is a render of.
#pragma once
#include "output/image.h"
#include "render/film.h"
#include "settings.h"
#include <filesystem>

namespace vkpm {

/// A render's file of which the header has been read.
struct RenderFile {
    std::filesystem::path path{};
    Image header{};
    std::vector<PassRange> runs{};
    uint layers = allLayers; // that were asked for

    PassRange passes() const { return {runs.front().begin, runs.back().end}; }
    const std::string& attribute(const std::string& name) const; // empty if it has none
};

/// Throws InputError with file and cause if it is no render of vkpm.
RenderFile openRender(const std::filesystem::path& file);

/// Gives the film all passes of a file. Throws InputError with file and cause.
void restore(Film& film, const RenderFile& file);

/// Writes the picture of a film (its pixels as downloaded) with its sums and further attributes, and a PNG beside it; size, layers
/// and exposure are the settings'.
void saveRender(const std::filesystem::path& output, const Film& film, std::span<const Pixel> pixels, const Settings& settings, std::map<std::string, std::string> attributes);

} // namespace vkpm
