/// The rows of a report, and the file that holds them.
#include "measure/report.h"
#include "error.h"
#include "measure/report_page.h"
#include "output/atomic_file.h"
#include "output/exr.h"
#include "scene/settings.h"
#include "shared_layers.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
namespace {

/// The layers whose sum is beauty, and beauty.
bool isLight(const Layer& layer) {
    const auto end = layerNames.begin() + LAYER_COUNT;
    return layer.isColour && (layer.name == "beauty" || std::find(layerNames.begin(), end, layer.name) != end);
}

/// A number of the table; nothing where there is none.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

std::string estimateCells(const std::optional<ErrorEstimate>& e) {
    return e ? fmt::format("{},{},{},{},{}", cell(e->noise), cell(e->bias), cell(e->error), cell(e->least), e->specks)
             : ",,,,";
}

std::string tableOf(const std::vector<ReportRow>& rows) {
    std::string text =
        "pass,seconds,rays,photons,layer,rmse,relmse,mean_error,flip,true_error,noise,bias,error,least,specks\n";
    for (const ReportRow& row : rows) {
        const std::string begin = fmt::format("{},{:.4f},{},{}", row.passes, row.seconds, row.rays, row.photons);
        if (row.layers.empty()) text += fmt::format("{},beauty,,,,,,{}\n", begin, estimateCells(row.estimate));
        for (const auto& [name, e] : row.layers)
            text +=
                fmt::format("{},{},{},{},{},{},{},{}\n", begin, name, cell(e.rmse), cell(e.relmse), cell(e.meanError),
                            cell(e.flip), cell(e.error), estimateCells(name == "beauty" ? row.estimate : std::nullopt));
    }
    return text;
}

} // namespace

Report::Report(std::filesystem::path where, const std::optional<std::filesystem::path>& against, uvec2 size)
    : folder(std::move(where)), referenceFile(against) {
    if (referenceFile) {
        reference = readExr(*referenceFile);
        requireSize(size);
        if (std::ranges::none_of(imageLayers(*reference), isLight))
            throw InputError(fmt::format("{}: --reference: has no channels R, G and B", referenceFile->string()));
    }
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw std::runtime_error(
            fmt::format("{}: --report: the folder cannot be made: {}", folder.string(), error.message()));
    for (const char* file : files) requireWritable(folder / file);
}

void Report::requireSize(uvec2 size) const {
    if (reference && reference->size != size)
        throw InputError(
            fmt::format("{}: --reference: has {}x{} pixels; allowed: the {}x{} of the render, or another --size",
                        referenceFile->string(), reference->size.x, reference->size.y, size.x, size.y));
}

bool Report::due(uint passes) {
    for (double next = 1; next < double(passes) + 1; next *= std::sqrt(2.0))
        if (std::lround(next) == long(passes)) return true;
    return false;
}

std::map<std::string, double> layerNoise(const Image& image, uint passes, const Image& earlier, uint before) {
    std::map<std::string, double> noise;
    const std::vector<Layer> layers = imageLayers(image), others = imageLayers(earlier);
    const auto beauty = std::ranges::find(layers, std::string("beauty"), &Layer::name);
    if (beauty == layers.end() || before == 0 || before >= passes) return noise;
    // The means of the first passes and of the rest are independent: the square of their difference is expected to be
    // the variance of a pass times 1 / before + 1 / (passes - before).
    const double scale = double(before) / (passes - before);
    for (const Layer& layer : layers) {
        const Layer* other = isLight(layer) ? comparableIn(others, layer) : nullptr;
        if (!other) continue;
        std::vector<float> squares;
        for (std::size_t c = 0; c < 3; c++)
            for (std::size_t i = 0; i < layer.channels[c].size(); i++) {
                const double apart = double{layer.channels[c][i]} - double{other->channels[c][i]},
                             light = double{beauty->channels[c][i]};
                squares.push_back(static_cast<float>(scale * apart * apart / (light * light + 0.01)));
            }
        noise[layer.name] = keptError(squares);
    }
    return noise;
}

void Report::add(ReportRow row, Image image) {
    if (!all.empty() && all.back().passes == row.passes) return;
    if (!all.empty()) row.noise = layerNoise(image, row.passes, last, all.back().passes);
    if (reference) {
        const std::vector<Layer> references = imageLayers(*reference);
        for (const Layer& layer : imageLayers(image))
            if (const Layer* other = isLight(layer) ? comparableIn(references, layer) : nullptr)
                row.layers[layer.name] = measureLayer(layer, *other);
    }
    all.push_back(std::move(row));
    last = std::move(image);
    replaceFile(folder / "error.csv", tableOf(all));
}

void Report::finish(const ReportPicture& picture, const std::vector<std::pair<std::string, std::string>>& facts) const {
    replaceFile(folder / "index.html", reportPage(all, picture, reference ? &*reference : nullptr, facts));
}

double fittedSlope(std::span<const double> xs, std::span<const double> ys) {
    double n = 0, sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;
    for (std::size_t i = 0; i < xs.size(); i++) {
        if (!(xs[i] > 0 && ys[i] > 0)) continue;
        const double x = std::log(xs[i]), y = std::log(ys[i]);
        n++, sumX += x, sumY += y, sumXX += x * x, sumXY += x * y;
    }
    const double spread = n * sumXX - sumX * sumX;
    return n < 2 || !(spread > 0) ? NAN : (n * sumXY - sumX * sumY) / spread;
}

} // namespace vkpm
