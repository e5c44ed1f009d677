/// Pictures as data URIs, curves as SVG, numbers as a table.
#include "measure/report_page.h"
#include "measure/flip.h"
#include "output/png.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace vkpm {
namespace {

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '<') out += "&lt;";
        else if (c == '&') out += "&amp;";
        else if (c == '"') out += "&quot;";
        else out += c;
    }
    return out;
}

/// Base64 (RFC 4648, section 4).
std::string base64(std::span<const char> bytes) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        uint word = 0;
        for (std::size_t k = 0; k < 3; k++)
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; k++) text += i + k > bytes.size() ? '=' : digits[word >> (18 - 6 * k) & 63];
    }
    return text;
}

/// A colour from dark blue by green to yellow, of equal steps to the eye and to colour-blind ones, for a value from 0
/// to 1: the ninths of the map viridis (Smith & van der Walt 2015).
uint mapColor(double value) {
    const std::array<std::array<double, 3>, 9> stops{{{68, 1, 84},
                                                      {71, 44, 122},
                                                      {59, 81, 139},
                                                      {44, 113, 142},
                                                      {33, 144, 141},
                                                      {39, 173, 129},
                                                      {92, 200, 99},
                                                      {170, 220, 50},
                                                      {253, 231, 37}}};
    const double place = std::clamp(std::isfinite(value) ? value : 1.0, 0.0, 1.0) * (stops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    uint color = 0xff000000u;
    for (uint c = 0; c < 3; c++) {
        const double level = stops[low][c] + (place - double(low)) * (stops[low + 1][c] - stops[low][c]);
        color |= static_cast<uint>(std::lround(level)) << (8 * c);
    }
    return color;
}

std::string figure(uvec2 size, std::span<const uint> colors, const std::string& caption) {
    return fmt::format("<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" "
                       "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                       size.x, size.y, escaped(caption), base64(encodePng(size, colors)), escaped(caption));
}

/// A colour for a relative error from 0.1 % to 100 %, by its square.
uint errorColor(double square) { return mapColor(1 + std::log10(std::sqrt(square)) / 3); }
const char* const errorColors = "from 0.1 % (dark) to 100 % (yellow), logarithmic";

/// Half of each pixel's interval over its value.
std::string intervalMap(const ReportPicture& picture) {
    if (picture.noiseFreedom == 0) return "";
    std::vector<uint> colors;
    for (const Pixel& pixel : picture.pixels) {
        const vec3 half = halfInterval(pixel, picture.noiseFreedom);
        double square = 0;
        for (int c = 0; c < 3; c++) {
            double value = 0;
            for (const vec3& layer : pixel.mean.layers) value += double{layer[c]};
            square += double{half[c]} * double{half[c]} / (value * value + 0.01) / 3;
        }
        colors.push_back(errorColor(square));
    }
    return figure(picture.image.size, colors,
                  fmt::format("Intervals: the truth is within so much of nine pixels of ten, {}", errorColors));
}

const Layer* beautyOf(const std::vector<Layer>& layers) {
    const auto found = std::ranges::find(layers, std::string("beauty"), &Layer::name);
    return found == layers.end() ? nullptr : &*found;
}

/// Maps of the relative error and of FLIP.
std::string errorMaps(const Image& image, const Image& reference) {
    const std::vector<Layer> layers = imageLayers(image), references = imageLayers(reference);
    const Layer *ours = beautyOf(layers), *theirs = beautyOf(references);
    if (!ours || !theirs || !areComparable(*ours, *theirs)) return "";
    std::vector<uint> relative, flip;
    for (std::size_t i = 0; i < ours->channels[0].size(); i++) {
        double square = 0;
        for (std::size_t c = 0; c < 3; c++) {
            const double x = ours->channels[c][i], r = theirs->channels[c][i];
            square += (x - r) * (x - r) / (r * r + 0.01) / 3;
        }
        relative.push_back(errorColor(square));
    }
    for (const float value : flipMap(*ours, *theirs)) flip.push_back(mapColor(double(value)));
    return figure(image.size, relative, fmt::format("Relative error, {}", errorColors)) +
           figure(image.size, flip, "FLIP, from 0 (dark) to 1 (yellow)");
}

struct Curve {
    std::string name;
    std::vector<double> xs, ys;
    std::vector<double> lows{}; // the lower end of a band below ys; empty for a line
};

/// Colours that colour-blind people tell apart (Okabe & Ito 2008).
const std::array<const char*, 8> inks{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                      "#e69f00", "#56b4e9", "#999999", "#b8a800"};

/// A diagram with logarithmic axes.
class Diagram {
public:
    Diagram(std::string labelX, std::string labelY, const std::vector<Curve>& all)
        : xLabel(std::move(labelX)), yLabel(std::move(labelY)) {
        for (const Curve& curve : all) {
            Curve positive{curve.name, {}, {}};
            for (std::size_t i = 0; i < curve.xs.size(); i++) {
                if (!(curve.xs[i] > 0 && curve.ys[i] > 0)) continue;
                positive.xs.push_back(curve.xs[i]);
                positive.ys.push_back(curve.ys[i]);
                if (!curve.lows.empty()) positive.lows.push_back(std::max(curve.lows[i], 0.3 * curve.ys[i]));
                if (!curve.lows.empty()) include(y, positive.lows.back());
                include(x, curve.xs[i]);
                include(y, curve.ys[i]);
            }
            if (!positive.xs.empty()) curves.push_back(std::move(positive));
        }
        for (Span* span : {&x, &y}) {
            span->low = std::floor(span->low * 4 - 1e-9) / 4;
            span->high = std::max(std::ceil(span->high * 4 + 1e-9) / 4, span->low + 0.5);
        }
    }

    std::string svg() const {
        if (curves.empty()) return "";
        std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{} against {}\">\n", width,
                                      height, escaped(yLabel), escaped(xLabel));
        out += grid();
        for (std::size_t i = 0; i < curves.size(); i++) out += line(curves[i], inks[i % inks.size()], i);
        out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + right) / 2, height - 6,
                           escaped(xLabel));
        out +=
            fmt::format("<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n</svg>\n",
                        (top + bottom) / 2, escaped(yLabel));
        return out;
    }

private:
    struct Span {
        double low = INFINITY, high = -INFINITY; // powers of ten
    };
    static constexpr double width = 720, height = 400, left = 76, right = 470, top = 12, bottom = 352;

    static void include(Span& span, double value) {
        span.low = std::min(span.low, std::log10(value));
        span.high = std::max(span.high, std::log10(value));
    }
    double placeX(double power) const { return left + (right - left) * (power - x.low) / (x.high - x.low); }
    double placeY(double power) const { return bottom - (bottom - top) * (power - y.low) / (y.high - y.low); }

    std::string grid() const {
        std::string out = fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" class=\"frame\"/>\n", left,
                                      top, right - left, bottom - top);
        const auto ticks = [](const Span& span, auto tick) {
            for (double power = std::floor(span.low); power <= span.high; power++)
                for (const double digit : {1.0, 2.0, 5.0}) {
                    const double at = power + std::log10(digit);
                    if (at >= span.low - 1e-9 && at <= span.high + 1e-9)
                        tick(at, fmt::format("{:.3g}", digit * std::pow(10, power)));
                }
        };
        ticks(x, [&](double at, const std::string& text) {
            out += fmt::format("<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/><text x=\"{0:.1f}\" "
                               "y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
                               placeX(at), top, bottom, bottom + 17, text);
        });
        ticks(y, [&](double at, const std::string& text) {
            out += fmt::format("<line x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/><text x=\"{3}\" "
                               "y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                               placeY(at), left, right, left - 6, placeY(at) + 4, text);
        });
        return out;
    }

    std::string line(const Curve& curve, const char* ink, std::size_t index) const {
        const double row = top + 16 + 22 * double(index);
        const auto place = [&](double px, double py) {
            return fmt::format("{:.1f},{:.1f} ", placeX(std::log10(px)), placeY(std::log10(py)));
        };
        std::string points;
        for (std::size_t i = 0; i < curve.xs.size(); i++) points += place(curve.xs[i], curve.ys[i]);
        if (!curve.lows.empty()) {
            for (std::size_t i = curve.xs.size(); i-- > 0;) points += place(curve.xs[i], curve.lows[i]);
            return fmt::format("<polygon points=\"{0}\" fill=\"{1}\" fill-opacity=\".25\"/>\n<rect x=\"{2}\" "
                               "y=\"{3}\" width=\"16\" height=\"12\" fill=\"{1}\" fill-opacity=\".25\"/><text "
                               "x=\"{4}\" y=\"{5}\">{6}</text>\n",
                               points, ink, right + 12, row - 10, right + 34, row, escaped(curve.name));
        }
        const double slope = fittedSlope(curve.xs, curve.ys);
        const std::string label = curve.name + (std::isfinite(slope) ? fmt::format(", slope {:.2f}", slope) : "");
        std::string out =
            fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", points, ink);
        for (std::size_t i = 0; i < curve.xs.size(); i++)
            out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\" fill=\"{}\"/>",
                               placeX(std::log10(curve.xs[i])), placeY(std::log10(curve.ys[i])), ink);
        out += fmt::format(
            "\n<rect x=\"{}\" y=\"{}\" width=\"16\" height=\"4\" fill=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
            right + 12, row - 6, ink, right + 34, row, escaped(label));
        return out;
    }

    std::string xLabel, yLabel;
    std::vector<Curve> curves;
    Span x, y;
};

/// What a render states of its error, as a band, what that is made of, and what the error is.
std::vector<Curve> statedCurves(const std::vector<ReportRow>& rows) {
    Curve band{"stated", {}, {}}, noise{"noise", {}, {}}, bias{"bias", {}, {}}, found{"true error", {}, {}};
    for (const ReportRow& row : rows) {
        if (const auto beauty = row.layers.find("beauty"); beauty != row.layers.end()) {
            found.xs.push_back(row.seconds);
            found.ys.push_back(beauty->second.error);
        }
        if (!row.estimate) continue;
        for (Curve* curve : {&band, &noise, &bias}) curve->xs.push_back(row.seconds);
        band.ys.push_back(row.estimate->error);
        band.lows.push_back(row.estimate->least);
        noise.ys.push_back(row.estimate->noise);
        bias.ys.push_back(row.estimate->bias);
    }
    return {band, noise, bias, found};
}

/// A curve of each layer, beauty first.
std::vector<Curve> curvesOf(const std::vector<ReportRow>& rows, double LayerError::*measure, bool overPasses) {
    std::map<std::string, Curve> layers;
    for (const ReportRow& row : rows) {
        const auto add = [&](const std::string& name, double value) {
            Curve& curve = layers[name];
            curve.name = name;
            curve.xs.push_back(overPasses ? row.passes : row.seconds);
            curve.ys.push_back(value);
        };
        if (measure)
            for (const auto& [name, error] : row.layers) add(name, error.*measure);
        else
            for (const auto& [name, noise] : row.noise) add(name, noise);
    }
    std::vector<Curve> curves;
    if (layers.contains("beauty")) curves.push_back(layers["beauty"]);
    for (auto& [name, curve] : layers)
        if (name != "beauty") curves.push_back(curve);
    return curves;
}

std::string diagrams(const std::vector<ReportRow>& rows) {
    std::string out;
    const auto add = [&](const char* title, const std::string& svg) {
        if (!svg.empty()) out += fmt::format("<h2>{}</h2>\n{}", title, svg);
    };
    const bool known = !rows.empty() && !rows.back().layers.empty();
    add("Error of the picture against time", Diagram("seconds of rendering", "error", statedCurves(rows)).svg());
    if (!known) add("Noise of layers against passes", Diagram("passes", "noise", curvesOf(rows, nullptr, true)).svg());
    add("Error of layers against passes", Diagram("passes", "error", curvesOf(rows, &LayerError::error, true)).svg());
    add("RMSE against time", Diagram("seconds of rendering", "RMSE", curvesOf(rows, &LayerError::rmse, false)).svg());
    add("FLIP against time",
        Diagram("seconds of rendering", "mean FLIP", curvesOf(rows, &LayerError::flip, false)).svg());
    return out;
}

/// Layers after the last pass: their part of the light, their noise, and, with a reference, their errors.
std::string layerTable(const ReportRow& row, const Image& image) {
    std::map<std::string, double> light;
    for (const Layer& layer : imageLayers(image))
        for (const std::span<const float> channel : layer.channels)
            for (const float value : channel) light[layer.name] += double{value};
    if (row.noise.empty() && row.layers.empty()) return "";
    const bool known = !row.layers.empty();
    std::string out =
        fmt::format("<h2>Layers after the last pass</h2>\n<div class=\"wide\"><table><tr><th>layer</th>"
                    "<th>part of the light</th><th>noise</th>{}</tr>\n",
                    known ? "<th>error</th><th>relMSE</th><th>RMSE</th><th>mean error</th><th>FLIP</th>" : "");
    std::vector<std::string> names;
    for (const auto& [name, noise] : row.noise) names.push_back(name);
    for (const auto& [name, error] : row.layers)
        if (!row.noise.contains(name)) names.push_back(name);
    for (const std::string& name : names) {
        const auto noise = row.noise.find(name);
        out += fmt::format("<tr><td>{}</td><td>{:.3g} %</td><td>{}</td>", name, 100 * light[name] / light["beauty"],
                           noise == row.noise.end() ? "" : fmt::format("{:.2g} %", 100 * noise->second));
        if (const auto found = row.layers.find(name); found != row.layers.end()) {
            const LayerError& e = found->second;
            out += fmt::format("<td>{:.2g} %</td><td>{:.4g}</td><td>{:.4g}</td><td>{:+.4g}</td><td>{:.4g}</td>",
                               100 * e.error, e.relmse, e.rmse, e.meanError, e.flip);
        }
        out += "</tr>\n";
    }
    return out + "</table></div>\n<p>Noise of a layer is relative to beauty, by how the last passes differ from those "
                 "before; errors are relative to the layer itself. Noise and error are those of the 98 % of the values "
                 "that are off least, relMSE and RMSE those of all.</p>\n";
}

const char* const STYLE = R"(:root { color-scheme: light dark; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1100px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; } h2 { font-size: 1.15em; margin-top: 2em; }
figure { display: inline-block; margin: 0 1em 1em 0; vertical-align: top; max-width: 100%; } figcaption { font-size: .85em; max-width: 34em; }
img { max-width: 100%; height: auto; image-rendering: pixelated; }
svg { width: 100%; max-width: 720px; height: auto; } svg text { font: 12px system-ui, sans-serif; fill: currentColor; }
svg line { stroke: currentColor; stroke-opacity: .15; } svg .frame { fill: none; stroke: currentColor; stroke-opacity: .5; }
.wide { overflow-x: auto; } table { border-collapse: collapse; } td, th { padding: .2em .9em .2em 0; text-align: right; } td:first-child, th:first-child { text-align: left; }
dt { font-weight: 600; } dd { margin: 0 0 .4em 0; overflow-wrap: anywhere; })";

} // namespace

std::string reportPage(const std::vector<ReportRow>& rows, const ReportPicture& picture, const Image* reference,
                       const std::vector<std::pair<std::string, std::string>>& facts) {
    const Image& image = picture.image;
    std::string page = fmt::format("<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><meta "
                                   "name=\"viewport\" content=\"width=device-width\">"
                                   "<title>vkpm: error against run "
                                   "time</title>\n<style>{}</style></head>\n<body>\n<h1>Error against run time</h1>\n",
                                   STYLE);
    if (!rows.empty() && rows.back().estimate)
        page += fmt::format("<p>The render's own estimate after {} passes: {}. Of all values, luck included, it is "
                            "{:.2g} %.</p>\n",
                            rows.back().passes, describe(*rows.back().estimate), 100 * rows.back().estimate->whole);
    page += figure(image.size, picture.developed,
                   fmt::format("After {} passes, {:.2f} s of rendering", rows.empty() ? 0 : rows.back().passes,
                               rows.empty() ? 0.0 : rows.back().seconds));
    page += intervalMap(picture);
    if (reference) page += errorMaps(image, *reference);
    page += diagrams(rows);
    page += "<p>Slopes are those of straight lines through all points of a curve. The true error lies within the band "
            "with a probability of 80 %, below its upper end with one of 90 %.</p>\n";
    if (!rows.empty()) page += layerTable(rows.back(), image);
    page += "<h2>The render</h2>\n<dl>\n";
    for (const auto& [name, value] : facts)
        page += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(value));
    return page + "</dl>\n</body>\n</html>\n";
}

} // namespace vkpm
