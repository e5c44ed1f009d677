/// Films to files and back.
#include "render_file.h"
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

RenderFile openRender(const std::filesystem::path& file) {
    RenderFile render{file, readExrHeader(file)};
    render.runs = named(file, [&] { return runsOf(render.header); });
    return render;
}

void restore(Film& film, const RenderFile& file) {
    const Image image = readExr(file.path);
    for (std::size_t i = 0; i < file.runs.size(); i++) film.restore(file.runs[i], named(file.path, [&] { return sumsOf(image, i); }));
}

std::filesystem::path pngBeside(std::filesystem::path exr) { return exr.replace_extension(".png"); }

void saveRender(const std::filesystem::path& output, Film& film, uvec2 size, float exposure, std::map<std::string, std::string> attributes) {
    const PassRange passes = film.passes();
    Image image = filmImage(film.download(), size, film.passCount());
    image.attributes = std::move(attributes);
    image.attributes["passes"] = std::to_string(film.passCount());
    image.attributes["passRange"] = fmt::format("{}:{}", passes.begin, passes.end);
    image.attributes["exposure"] = fmt::format("{}", exposure);
    for (std::size_t i = 0; i < film.runCount(); i++) addRun(image, film.run(i), film.sums(i));
    writeExr(output, image);
    writePng(pngBeside(output), size, film.develop(exposure));
}

} // namespace vkpm
