/// Films to files and back.
#include "render_file.h"
#include "options.h"
#include "gpu/error.h"
#include "output/exr.h"
#include "output/film_image.h"
#include "output/film_runs.h"
#include "output/png.h"
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
    for (uint i = 0; i < layerNames.size(); i++) layers |= uint((" " + list + " ").find(fmt::format(" {} ", layerNames[i])) != std::string::npos) << i;
    return layers ? layers : allLayers;
}

RenderFile openRender(const std::filesystem::path& file) {
    RenderFile render{file, readExrHeader(file)};
    render.runs = named(file, [&] { return runsOf(render.header); });
    render.layers = layersOf(render.attribute("layers"));
    return render;
}

void restore(Film& film, const RenderFile& file) {
    const Image image = readExr(file.path);
    for (std::size_t i = 0; i < file.runs.size(); i++) film.restore(file.runs[i], named(file.path, [&] { return sumsOf(image, i, file.layers); }));
}

void saveRender(const std::filesystem::path& output, const Film& film, std::span<const Pixel> pixels, const Settings& settings, std::map<std::string, std::string> attributes) {
    const PassRange passes = film.passes();
    Image image = filmImage(pixels, settings.size, settings.layers);
    image.attributes = std::move(attributes);
    image.attributes["passes"] = std::to_string(film.passCount());
    image.attributes["passRange"] = fmt::format("{}:{}", passes.begin, passes.end);
    image.attributes["exposure"] = fmt::format("{}", settings.exposure);
    for (uint i = 0; i < layerNames.size(); i++)
        if (settings.layers >> i & 1) image.attributes["layers"] += fmt::format("{}{}", image.attributes["layers"].empty() ? "" : " ", layerNames[i]);
    for (std::size_t i = 0; i < film.runCount(); i++) addRun(image, film.run(i), film.sums(i), settings.layers);
    writeExr(output, image);
    writePng(pngBeside(output), settings.size, develop(pixels, settings.exposure));
}

} // namespace vkpm
