/// vkpm merge: the parts of one render become one file.
#include "commands/commands.h"
#include "gpu/audit.h"
#include "job/render_file.h"
#include "output/atomic_file.h"
#include "output/film_runs.h"
#include "output/used_files.h"
#include "render/features.h"
#include "scene/identity.h"
#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace vkpm {

/// Refuses parts of different renders.
static void requireOneRender(const std::vector<RenderFile>& parts) {
    for (const RenderFile& part : parts) {
        const std::vector<std::string> lines = differences(part.header.attributes, parts[0].header.attributes);
        if (!lines.empty())
            throw InputError(fmt::format("{}: is a part of another render than {}; what differs (here in the former, "
                                         "there in the latter):\n  {}",
                                         part.path.string(), parts[0].path.string(), fmt::join(lines, "\n  ")));
        if (part.header.size != parts[0].header.size)
            throw InputError(fmt::format("{}: its size is not that of {}", part.path.string(), parts[0].path.string()));
    }
}

/// Refuses parts that overlap, and holes between them; `parts` are in the order of their passes.
static void requireAdjacent(const std::vector<RenderFile>& parts, bool part) {
    const auto missing = [](PassRange hole, const std::string& between) {
        return InputError(fmt::format("{} {} missing, {}; give the part that has them", describe(hole),
                                      hole.end - hole.begin == 1 ? "is" : "are", between));
    };
    if (const PassRange first = parts[0].passes(); first.begin > 0 && !part)
        throw InputError(fmt::format("{}, or merge with --part into what is a part itself",
                                     missing({0, first.begin}, "before " + parts[0].path.string()).what()));
    for (std::size_t i = 1; i < parts.size(); i++) {
        const PassRange before = parts[i - 1].passes();
        const PassRange now = parts[i].passes();
        const std::string names = fmt::format("{} and {}", parts[i - 1].path.string(), parts[i].path.string());
        if (now.begin < before.end)
            throw InputError(fmt::format("{} both have {}; give one of them", names,
                                         describe(PassRange{now.begin, std::min(now.end, before.end)})));
        if (now.begin > before.end) throw missing({before.end, now.begin}, "between " + names);
    }
}

/// Refuses to replace a file that has more than the parts have, as when OUT was forgotten and the first part took its
/// place.
static void requireNothingLost(const MergeOptions& options, const std::vector<RenderFile>& parts) {
    std::vector<UsedFile> read;
    for (const RenderFile& part : parts) read.push_back({"a part", part.path});
    requireApart(std::array{UsedFile{"the PNG beside the result", pngBeside(options.output)}}, read);
    if (!std::filesystem::is_regular_file(options.output)) return;
    const auto refuse = [&](const std::string& found) {
        throw InputError(fmt::format("{}: is to be replaced by the result, and is {}; allowed: a file that is not "
                                     "there yet, or that holds some of these parts; "
                                     "the result comes first, as in vkpm merge OUT.exr PART.exr...",
                                     options.output.string(), found));
    };
    RenderFile there;
    try {
        there = openRender(options.output);
    } catch (const InputError&) {
        refuse("no render");
    }
    const PassRange held = there.passes();
    const bool same = differences(there.header.attributes, parts[0].header.attributes).empty() &&
                      there.header.size == parts[0].header.size;
    if (!same) refuse("another render than the parts are of");
    if (held.begin < parts.front().passes().begin || held.end > parts.back().passes().end)
        refuse(fmt::format("a render that is not among the parts: it has {}", describe(held)));
}

/// The attributes of the whole: those of the first part, with sums of what adds up and all devices.
static std::map<std::string, std::string> mergedAttributes(const std::vector<RenderFile>& parts) {
    std::map<std::string, std::string> merged = parts[0].header.attributes;
    merged.erase("runs");
    merged.erase("layers");
    std::vector<std::string> devices;
    std::uint64_t nonfinite = 0;
    double seconds = 0;
    for (const RenderFile& part : parts) {
        const std::string& device = part.attribute("device");
        if (std::ranges::find(devices, device) == devices.end()) devices.push_back(device);
        nonfinite += std::strtoull(part.attribute("nonfinite").c_str(), nullptr, 10);
        seconds += std::strtod(part.attribute("seconds").c_str(), nullptr);
    }
    merged["device"] = fmt::format("{}", fmt::join(devices, "; "));
    merged["nonfinite"] = std::to_string(nonfinite);
    if (merged.contains("seconds")) merged["seconds"] = fmt::format("{:.3f}", seconds);
    return merged;
}

int execute(const MergeOptions& options) {
    std::vector<RenderFile> parts;
    for (const auto& file : options.parts) parts.push_back(openRender(file));
    std::ranges::stable_sort(parts, {}, [](const RenderFile& part) { return part.passes().begin; });
    requireOneRender(parts);
    requireAdjacent(parts, options.isPart);
    requireNothingLost(options, parts);
    requireWritable(options.output);
    requireWritable(pngBeside(options.output));

    Gpu gpu(options.device);
    requireSoundDriver(gpu);
    Settings settings;
    settings.size = parts[0].header.size;
    settings.layers = parts[0].layers;
    settings.exposure = std::strtof(parts[0].attribute("exposure").c_str(), nullptr);
    settings.coverage =
        std::ranges::find(parts[0].header.channels, "A", &Channel::name) != parts[0].header.channels.end();
    Features features;
    askFor(settings.layers, features);
    Film film(gpu, settings.size, features);
    for (const RenderFile& part : parts) restore(film, part);
    saveRender(options.output, film, settings, mergedAttributes(parts));
    return 0;
}

} // namespace vkpm
