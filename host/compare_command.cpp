/// vkpm compare: error measures between two images, layer by layer.
#include "commands.h"
#include "gpu/error.h"
#include "output/exr.h"
#include "output/layer_error.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

static void requireOneSize(const Options& options, const Image& image, const Image& reference) {
    if (image.size != reference.size)
        throw InputError(fmt::format("{}: found {}x{} pixels; allowed: the {}x{} of {}", options.parts[0].string(), image.size.x, image.size.y,
                                     reference.size.x, reference.size.y, options.parts[1].string()));
}

static Json measure(const Options& options, const Image& image, const Image& reference) {
    const Layers layers = imageLayers(image);
    const Layers references = imageLayers(reference);
    Json errors = Json::object();
    for (const Layer& layer : layers)
        if (const Layer* other = comparableIn(references, layer)) errors[layer.name] = json(measureLayer(layer, *other));
    const auto onlyInImage = onlyIn(layers, references);
    const auto onlyInReference = onlyIn(references, layers);
    if (errors.empty())
        throw InputError(fmt::format("{}: has no layer that {} has; found {} here and {} there", options.parts[0].string(),
                                     options.parts[1].string(), fmt::join(onlyInImage, ", "), fmt::join(onlyInReference, ", ")));
    return {{"image", options.parts[0].string()},
            {"reference", options.parts[1].string()},
            {"size", {image.size.x, image.size.y}},
            {"layers", errors},
            {"only_in_image", onlyInImage},
            {"only_in_reference", onlyInReference}};
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
    fmt::print("\n{}\n", MEASURES);
}

int compare(const Options& options) {
    const Image image = readExr(options.parts[0]);
    const Image reference = readExr(options.parts[1]);
    requireOneSize(options, image, reference);
    const Json comparison = measure(options, image, reference);
    // A file's name may be no UTF-8.
    if (options.json) fmt::print("{}\n", comparison.dump(2, ' ', false, Json::error_handler_t::replace));
    else printComparison(comparison);
    return 0;
}

} // namespace vkpm
