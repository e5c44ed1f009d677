/// vkpm compare: error measures between two images, layer by layer.
#include "commands/commands.h"
#include "error.h"
#include "measure/layer_error.h"
#include "output/exr.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tbb/parallel_for.h>

namespace vkpm {

using Json = nlohmann::ordered_json;
using Layers = std::vector<Layer>;

/// What the table calls a measure, and JSON.
struct Column {
    const char* title;
    const char* key;
    double LayerError::*value;
};

constexpr Column COLUMNS[] = {{"rmse", "rmse", &LayerError::rmse},
                              {"relmse", "relmse", &LayerError::relmse},
                              {"error", "error", &LayerError::error},
                              {"mean error", "mean_error", &LayerError::meanError},
                              {"mean relative error", "mean_relative_error", &LayerError::meanRelativeError},
                              {"max error", "max_error", &LayerError::maxError},
                              {"flip", "flip", &LayerError::flip}};

/// The names of layers that others lack.
static std::vector<std::string> onlyIn(const Layers& layers, const Layers& others) {
    std::vector<std::string> names;
    for (const Layer& layer : layers)
        if (!comparableIn(others, layer)) names.push_back(layer.name);
    return names;
}

/// JSON has no NaN: null stands for what cannot be said.
static Json json(const LayerError& error) {
    Json members;
    for (const Column& column : COLUMNS) {
        const double value = error.*column.value;
        members[column.key] = std::isnan(value) ? Json() : Json(value);
    }
    members["nonfinite"] = error.nonfinite;
    return members;
}

static void requireOneSize(const CompareOptions& options, const ExrFile& image, const ExrFile& reference) {
    if (image.size() != reference.size())
        throw InputError(fmt::format("{}: found a picture of {}x{} pixels (display window); allowed: the {}x{} of {}",
                                     options.image.string(), image.size().x, image.size().y, reference.size().x,
                                     reference.size().y, options.reference.string()));
}

/// Where both pictures have values of all these channels; refuses pictures that have none in common.
static PixelBox commonRegion(const CompareOptions& options, const ExrFile& image, const ExrFile& reference,
                             const std::vector<std::string>& names) {
    PixelBox region{glm::ivec2(0), glm::ivec2(image.size()) - 1};
    for (const ExrFile* file : {&image, &reference})
        for (const ExrFile::Entry& entry : file->entries())
            if (std::ranges::find(names, entry.name) != names.end())
                region = {glm::max(region.low, entry.window.low), glm::min(region.high, entry.window.high)};
    if (glm::any(glm::greaterThan(region.low, region.high))) {
        const auto windows = [](const ExrFile& file) { return describe(file.entries().front().window); };
        throw InputError(fmt::format("{}: has values at {} of its picture, {} at {} (data windows): nowhere both; "
                                     "allowed: pictures that overlap",
                                     options.image.string(), windows(image), options.reference.string(),
                                     windows(reference)));
    }
    return region;
}

/// The channels of layers, by name.
static std::vector<std::string> channelsOf(const Layers& layers) {
    std::vector<std::string> names;
    for (const Layer& layer : layers) names.insert(names.end(), layer.channelNames.begin(), layer.channelNames.end());
    return names;
}

/// What the files call the channels that are compared by another name.
static Json renamed(const ExrFile& file, const std::vector<std::string>& names) {
    Json object = Json::object();
    for (const ExrFile::Entry& entry : file.entries())
        if (entry.name != entry.inFile && std::ranges::find(names, entry.name) != names.end())
            object[entry.name] = entry.inFile;
    return object;
}

static Json measure(const CompareOptions& options) {
    const ExrFile image(options.image), reference(options.reference);
    requireOneSize(options, image, reference);
    const Image imageHeader = image.header(), referenceHeader = reference.header();
    const Layers layers = imageLayers(imageHeader), references = imageLayers(referenceHeader);
    const auto onlyInImage = onlyIn(layers, references), onlyInReference = onlyIn(references, layers);
    Layers compared;
    for (const Layer& layer : layers)
        if (comparableIn(references, layer)) compared.push_back(layer);
    if (compared.empty()) {
        const auto found = [](const ExrFile& file, const std::vector<std::string>& names) {
            return fmt::format("{}{}{}", fmt::join(names, ", "),
                               file.leftOut().empty() ? "" : ", left out: ", file.leftOut());
        };
        throw InputError(
            fmt::format("{}: has no layer that {} has; found {} here and {} there; allowed: a picture as R, G and B, "
                        "or as a layer that is named beauty, Combined, rgba ..., or the same layers",
                        options.image.string(), options.reference.string(), found(image, onlyInImage),
                        found(reference, onlyInReference)));
    }
    const std::vector<std::string> names = channelsOf(compared);
    const PixelBox region = commonRegion(options, image, reference, names);
    const Image values = image.read(names, region), truths = reference.read(names, region);
    const Layers valueLayers = imageLayers(values), truthLayers = imageLayers(truths);
    std::vector<LayerError> found(valueLayers.size());
    tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t i) {
        found[i] = measureLayer(valueLayers[i], *comparableIn(truthLayers, valueLayers[i]));
    });
    Json errors = Json::object();
    for (std::size_t i = 0; i < found.size(); i++) errors[valueLayers[i].name] = json(found[i]);
    Json result{{"image", options.image.string()},        {"reference", options.reference.string()},
                {"size", {values.size.x, values.size.y}}, {"layers", errors},
                {"only_in_image", onlyInImage},           {"only_in_reference", onlyInReference}};
    if (values.size != image.size())
        result["region"] = {{"picture", {image.size().x, image.size().y}},
                            {"low", {region.low.x, region.low.y}},
                            {"high", {region.high.x, region.high.y}}};
    for (const auto& [key, file] : {std::pair("named_in_image", &image), std::pair("named_in_reference", &reference)})
        if (const Json others = renamed(*file, names); !others.empty()) result[key] = others;
    return result;
}

/// The widest name of a layer, for the table's first column.
static size_t nameWidth(const Json& layers) {
    size_t width = 5;
    for (const auto& [name, error] : layers.items()) width = std::max(width, name.size());
    return width;
}

static void printTable(const Json& layers) {
    const size_t width = nameWidth(layers);
    fmt::print("{:<{}}", "layer", width);
    for (const Column& column : COLUMNS) fmt::print("  {:>10}", column.title);
    fmt::print("  nonfinite\n");
    for (const auto& [name, error] : layers.items()) {
        fmt::print("{:<{}}", name, width);
        for (const Column& column : COLUMNS) {
            const Json& value = error[column.key];
            const auto columnWidth = std::max<size_t>(10, std::string_view(column.title).size());
            fmt::print("  {:>{}}", value.is_null() ? "-" : fmt::format("{:.4g}", value.get<double>()), columnWidth);
        }
        fmt::print("  {:>9}\n", error["nonfinite"].get<std::uint64_t>());
    }
}

static void printComparison(const Json& comparison) {
    printTable(comparison["layers"]);
    for (const auto& [key, where] : {std::pair("only_in_image", "image"), std::pair("only_in_reference", "reference")})
        if (!comparison[key].empty())
            fmt::print("Only in the {}: {}\n", where, fmt::join(comparison[key].get<std::vector<std::string>>(), ", "));
    for (const auto& [key, where] :
         {std::pair("named_in_image", "image"), std::pair("named_in_reference", "reference")})
        if (comparison.contains(key))
            for (const auto& [name, other] : comparison[key].items())
                fmt::print("{} is {} in the {}\n", name, other.get<std::string>(), where);
    if (comparison.contains("region"))
        fmt::print("Compared where both have values: {}x{} pixels from {},{} on, of {}x{}\n",
                   comparison["size"][0].get<int>(), comparison["size"][1].get<int>(),
                   comparison["region"]["low"][0].get<int>(), comparison["region"]["low"][1].get<int>(),
                   comparison["region"]["picture"][0].get<int>(), comparison["region"]["picture"][1].get<int>());
    fmt::print("\n{}\n", MEASURES);
}

int execute(const CompareOptions& options) {
    const Json comparison = measure(options);
    // A file's name may be no UTF-8.
    if (options.json) fmt::print("{}\n", comparison.dump(2, ' ', false, Json::error_handler_t::replace));
    else printComparison(comparison);
    return 0;
}

} // namespace vkpm
