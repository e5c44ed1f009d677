/// What the panel draws by itself: the curve of the error, and photons over the picture.
#include "window/panel.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <imgui.h>

namespace vkpm {
namespace {

const ImU32 gridColor = IM_COL32(255, 255, 255, 28), textColor = IM_COL32(170, 174, 182, 255);

/// A curve, with its name in the legend.
struct Curve {
    const char* name;
    double ErrorEstimate::*value;
    ImU32 color;
    float thickness;
    float legend; // place of the name, in letters
};
const Curve curves[]{{"bias", &ErrorEstimate::bias, IM_COL32(240, 160, 90, 255), 1, 7.5f},
                     {"noise", &ErrorEstimate::noise, IM_COL32(150, 150, 150, 255), 1, 3.5f},
                     {"error", &ErrorEstimate::error, IM_COL32(110, 180, 255, 255), 2, 0}};

/// Decades from a value to another along a side of a drawing.
struct Axis {
    double low, high; // logarithms
    float begin, end; // pixels

    float at(double value) const {
        return begin + float((std::log10(std::max(value, 1e-12)) - low) / (high - low)) * (end - begin);
    }
};

Axis axisFor(double least, double most, float begin, float end) {
    const double low = std::log10(std::max(least, 1e-6) / 1.1), high = std::log10(std::max(most, 1e-6) * 1.1);
    return {low, std::max(high, low + 0.3), begin, end};
}

/// 1, 2 and 5 of each decade; the last argument says whether a label has room there.
template <class Draw> void forEachTick(const Axis& axis, float room, Draw draw) {
    float last = -INFINITY;
    for (int decade = int(std::floor(axis.low)); decade <= axis.high; decade++)
        for (const double digit : {1.0, 2.0, 5.0}) {
            const double value = digit * std::pow(10.0, decade);
            const float at = axis.at(value);
            if (at < std::min(axis.begin, axis.end) - 1 || at > std::max(axis.begin, axis.end) + 1) continue;
            const bool fits = std::abs(at - last) >= room;
            if (fits) last = at;
            draw(value, fits);
        }
}

std::string percent(double value) { return fmt::format("{:.3g} %", 100 * value); }

} // namespace

void drawErrorCurve(const std::vector<ErrorPoint>& errors, float height) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float wide = ImGui::GetContentRegionAvail().x, font = ImGui::GetFontSize();
    ImGui::Dummy({wide, height});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float left = corner.x + 3.2f * font, right = corner.x + wide, top = corner.y,
                bottom = corner.y + height - 1.3f * font;
    draw.AddRectFilled({left, top}, {right, bottom}, IM_COL32(0, 0, 0, 60));

    double least = errors[0].error.error, most = least;
    for (const ErrorPoint& point : errors) {
        least = std::min(least, std::max(point.error.noise, 0.2 * point.error.error));
        most = std::max(most, point.error.error);
    }
    const Axis x = axisFor(errors.front().seconds, errors.back().seconds, left, right),
               y = axisFor(least, most, bottom, top);
    forEachTick(x, 3.5f * font, [&](double seconds, bool fits) {
        draw.AddLine({x.at(seconds), top}, {x.at(seconds), bottom}, gridColor);
        if (fits)
            draw.AddText({std::min(x.at(seconds), right - 2.5f * font), bottom}, textColor,
                         fmt::format("{} s", seconds).c_str());
    });
    forEachTick(y, 1.1f * font, [&](double error, bool fits) {
        draw.AddLine({left, y.at(error)}, {right, y.at(error)}, gridColor);
        if (fits)
            draw.AddText({corner.x, std::clamp(y.at(error) - font / 2, top, bottom - font)}, textColor,
                         percent(error).c_str());
    });

    draw.PushClipRect({left, top}, {right, bottom}, true);
    for (const Curve& curve : curves) {
        std::vector<ImVec2> points;
        for (const ErrorPoint& point : errors) points.push_back({x.at(point.seconds), y.at(point.error.*curve.value)});
        draw.AddPolyline(points.data(), int(points.size()), curve.color, 0, curve.thickness);
        for (const ImVec2& point : points) draw.AddCircleFilled(point, 1.2f * curve.thickness, curve.color);
        draw.AddText({right - (11 - curve.legend) * font, top}, curve.color, curve.name);
    }
    draw.PopClipRect();
}

/// Photons that the picture's own depth does not hide. On a slanted surface depth varies within a pixel: hence the
/// tolerance.
void drawPhotons(const Picture& picture, const Rectangle& where, float scale) {
    const double tolerance = 0.02;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    float brightest = 1e-6f;
    for (const PhotonPoint& photon : picture.photons)
        brightest = std::max({brightest, photon.color.x, photon.color.y, photon.color.z});
    for (const PhotonPoint& photon : picture.photons) {
        const auto seen = seenAt(picture.view, picture.size, photon.position);
        const std::optional<double> depth = seen ? depthAt(picture, seen->place) : std::nullopt;
        if (!depth || std::abs(seen->depth - *depth) > tolerance * *depth) continue;
        const dvec2 at = dvec2(where.corner) + seen->place * dvec2(where.size);
        const vec3 c = glm::sqrt(photon.color / brightest) * 255.0f;
        draw.AddRectFilled({float(at.x), float(at.y)}, {float(at.x) + 1.5f * scale, float(at.y) + 1.5f * scale},
                           IM_COL32(int(c.x), int(c.y), int(c.z), 255));
    }
}

} // namespace vkpm
