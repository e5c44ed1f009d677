/// The EXR file of a render: its picture, the sums it can go on from, and what it is a render of.
#pragma once
#include "output/image.h"
#include "render/film.h"
#include "scene/settings.h"
#include "shared_film.h"
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

/// What a file has of a render.
struct Keeping {
    bool sums = true;  // over passes, from which it can go on or be merged
    bool half = false; // layers as 16-bit floats
};

/// The exposure of a film's picture in stops, as the settings say it or as its brightness asks for.
float exposureOf(const Film& film, const Settings& settings);

/// Writes the picture of a film with its sums and further attributes, and a PNG beside it, some rows at a time; size,
/// layers and exposure are the settings'.
void saveRender(const std::filesystem::path& output, const Film& film, const Settings& settings,
                std::map<std::string, std::string> attributes, const Keeping& keeping = {});

} // namespace vkpm
