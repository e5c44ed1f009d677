/// Films to files and back.
#include "job/render_file.h"
#include "error.h"
#include "job/options.h"
#include "output/exr.h"
#include "output/film_image.h"
#include "output/film_runs.h"
#include "output/messages.h"
#include "output/png.h"
#include <algorithm>
#include <fmt/format.h>

namespace vkpm {

const std::string& RenderFile::attribute(const std::string& name) const {
    static const std::string none;
    const auto found = header.attributes.find(name);
    return found == header.attributes.end() ? none : found->second;
}

/// Calls `read`, and gives what it throws the name of the file.
template <class Read> static auto named(const std::filesystem::path& file, Read read) {
    try {
        return read();
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", file.string(), error.what()));
    }
}

/// Bits of the layers that an attribute lists; all if there is none.
static uint layersOf(const std::string& list) {
    uint layers = 0;
    for (uint i = 0; i < layerNames.size(); i++)
        layers |= uint((" " + list + " ").find(fmt::format(" {} ", layerNames[i])) != std::string::npos) << i;
    return layers ? layers : allLayers;
}

RenderFile openRender(const std::filesystem::path& file) {
    RenderFile render{file, readExrHeader(file)};
    render.runs = named(file, [&] { return runsOf(render.header); });
    render.layers = layersOf(render.attribute("layers"));
    return render;
}

void restore(Film& film, const RenderFile& file) {
    const ExrFile exr(file.path);
    exr.requireWhole();
    const std::vector<std::string> names =
        named(file.path, [&] { return channelsOfSums(file.header, file.runs.size(), file.layers); });
    const int right = int(exr.size().x) - 1;
    film.restore(file.runs, [&](uint row, uint rows) {
        return sumsOf(exr.read(names, {{0, int(row)}, {right, int(row + rows) - 1}}), file.runs.size(),
                      length(file.passes()), file.layers);
    });
}

float exposureOf(const Film& film, const Settings& settings) {
    if (!settings.autoExposure) return settings.exposure;
    const uint rows = 64;
    AutoExposure exposure;
    for (uint row = 0; row < settings.size.y; row += rows)
        exposure.add(film.rows(row, std::min(rows, settings.size.y - row)).pixels);
    return exposure.stops();
}

void saveRender(const std::filesystem::path& output, const Film& film, const Settings& settings,
                std::map<std::string, std::string> attributes, const Keeping& keeping) {
    const PassRange passes = film.passes();
    attributes["passes"] = std::to_string(film.passCount());
    attributes["passRange"] = fmt::format("{}:{}", passes.begin, passes.end);
    const float exposure = exposureOf(film, settings);
    attributes["exposure"] = fmt::format("{}", exposure);
    for (uint i = 0; i < layerNames.size(); i++)
        if (settings.layers >> i & 1)
            attributes["layers"] += fmt::format("{}{}", attributes["layers"].empty() ? "" : " ", layerNames[i]);
    if (keeping.sums) attributes["runs"] = runsText(film.ranges());

    std::vector<uint> picture(std::size_t(settings.size.x) * settings.size.y);
    const std::uint64_t clamped = writeExr(output, settings.size, attributes, [&](uint row, uint rows) {
        const FilmRows block = film.rows(row, rows);
        const std::vector<Pixel>& pixels = block.pixels;
        std::ranges::copy(develop(pixels, exposure, settings.coverage),
                          picture.begin() + std::ptrdiff_t(row) * settings.size.x);
        Image image = filmImage(pixels, {settings.size.x, rows}, settings.layers, settings.coverage);
        if (keeping.half)
            for (Channel& channel : image.channels)
                channel.storage = channel.name == "depth.Z" ? Storage::float32 : Storage::half;
        if (!keeping.sums) return image;
        std::vector<std::span<const PixelSum>> sums;
        for (const std::vector<PixelSum>& run : block.sums)
            sums.push_back(std::span(run).subspan(block.skipped, pixels.size()));
        addRuns(image, pixels, sums, film.passCount(), settings.layers, !keeping.half);
        return image;
    });
    if (clamped > 0)
        warn(fmt::format("{}: {} values are larger than 65504, the largest 16-bit float, and were saved as that; "
                         "without --half they are saved as they are",
                         output.string(), clamped));
    writePng(pngBeside(output), settings.size, picture, settings.coverage);
}

} // namespace vkpm
