/// The panel with ImGui.
#include "window/panel.h"
#include "output/progress.h"
#include <algorithm>
#include <fmt/format.h>
#include <imgui.h>

namespace vkpm {
namespace {

const float width = 330;
const ImVec4 dim{0.62f, 0.64f, 0.68f, 1}, warning{1.0f, 0.66f, 0.35f, 1};

void line(const std::string& text) { ImGui::TextUnformatted(text.c_str()); }

void note(const std::string& text, const ImVec4& color = dim) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos();
    line(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

/// A name, and a value in a column of its own.
void row(const char* name, const std::string& value) {
    ImGui::TextColored(dim, "%s", name);
    ImGui::SameLine(0.32f * ImGui::GetWindowWidth());
    ImGui::PushTextWrapPos();
    line(value);
    ImGui::PopTextWrapPos();
}

/// 1234567 as 1.23 M.
std::string short_(double value) {
    for (const char* unit : {"", " k", " M", " G"}) {
        if (value < 999.5) return fmt::format("{:.3g}{}", value, unit);
        value /= 1000;
    }
    return fmt::format("{:.3g} T", value);
}

std::string timeText(double seconds) {
    if (seconds < 60) return fmt::format("{:.1f} s", seconds);
    const auto s = static_cast<std::uint64_t>(seconds);
    return s < 3600 ? fmt::format("{}:{:02} min", s / 60, s % 60) : fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

std::string radiusText(const std::optional<GatherRadii>& radii, float factor) {
    if (!radii) return "none";
    if (radii->smallest == radii->greatest) return fmt::format("{:.4g}", radii->typical * factor);
    return fmt::format("{:.3g} to {:.3g}, most {:.3g}", radii->smallest * factor, radii->greatest * factor,
                       radii->typical * factor);
}

void showProgress(const PanelInput& input) {
    const RenderState& s = input.state;
    const std::string of = s.passesWanted == NONE ? "" : fmt::format(" of {}", s.passesWanted);
    row("passes", fmt::format("{}{}, {}", s.passes, of, activityNames[std::size_t(s.activity)]));
    row("time", timeText(s.seconds));
    const double seconds = std::max(s.seconds, 1e-3);
    row("rays", fmt::format("{}/s", short_(double(s.rays) / seconds)));
    row("photons", fmt::format("{}/s", short_(double(s.photons) / seconds)));
    row("radius", radiusText(s.globalRadii, s.radiusFactor));
    row("of caustics", radiusText(s.causticRadii, s.radiusFactor));
    const double frames = input.previewsPerSecond;
    row("film", fmt::format("{} x {}{}", input.film.x, input.film.y,
                            frames > 0 ? fmt::format(", {:.0f} frames/s", frames) : ""));
    if (!input.about.empty()) note(input.about);
    for (const std::string& text : s.warnings) note(text, warning);
    for (const std::string& text : {s.problem, s.refusal})
        if (!text.empty()) note(text, warning);
}

void showError(const RenderState& s) {
    if (!ImGui::CollapsingHeader("Estimated error", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (s.errors.empty()) return note("after some passes");
    const ErrorEstimate& e = s.errors.back().error;
    line(fmt::format("{:.2g} %", 100 * e.error));
    ImGui::SameLine();
    ImGui::TextColored(dim, "noise %.2g %%, bias %.2g %%; 90 %% sure", 100 * e.noise, 100 * e.bias);
    note(fmt::format("without the worst {:.0f} % ({} specks)", 100 * (1 - KEPT), e.specks));
    if (s.targetError && s.activity == Activity::rendering) {
        ErrorForecast forecast;
        for (const ErrorPoint& point : s.errors) forecast.add(point.passes, point.error.error);
        if (const auto passes = forecast.passesTo(*s.targetError))
            note(forecastText(*s.targetError, *passes, s.passes, s.seconds / std::max(s.passes, 1u)));
    }
    drawErrorCurve(s.errors, 6.5f * ImGui::GetFontSize());
}

void chooseLayer(Choices& choices) {
    if (!ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (ImGui::BeginTable("layers", 2)) {
        for (uint i = 0; i < shownLayers.size(); i++) { // down the left column, then the right
            ImGui::TableNextColumn();
            const uint layer = i / 2 + i % 2 * 5;
            if (ImGui::RadioButton(fmt::format("{} {}", (layer + 1) % 10, shownLayers[layer]).c_str(),
                                   choices.tone.layer == layer))
                choices.tone.layer = layer;
        }
        ImGui::EndTable();
    }
    if (choices.tone.layer >= SHOW_NOISE) note(fmt::format("shown {} times as bright", errorGain));
    ImGui::SliderFloat("exposure", &choices.tone.exposure, -8, 8, "%+.2f stops");
    int curve = int(choices.tone.curve);
    if (ImGui::Combo("curve", &curve, toneCurveNames.data(), int(toneCurveNames.size())))
        choices.tone.curve = ToneCurve(curve);
    note("Files keep the scene's exposure, without a curve.");
    ImGui::Checkbox("photons as points", &choices.request.photons);
    ImGui::Checkbox("film follows the window", &choices.follows);
}

void chooseCamera(Choices& choices) {
    if (!ImGui::CollapsingHeader("Camera", ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (ImGui::Button("copy as JSON")) choices.copiesCamera = true;
    ImGui::SameLine();
    if (ImGui::Button("reset")) choices.request.view.reset();
    ImGui::SameLine();
    ImGui::Checkbox("look about", &choices.looksAbout);
}

/// A slider for a value that is as the scene has it unless it is given.
void slider(const char* name, std::optional<uint>& given, uint now, int low, int high) {
    int value = int(given.value_or(now));
    if (ImGui::SliderInt(name, &value, low, high, "%d", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        given = uint(value);
}

void slider(const char* name, std::optional<float>& given, float now, float low, float high, ImGuiSliderFlags flags) {
    float value = given.value_or(now);
    if (ImGui::SliderFloat(name, &value, low, high, "%.4g", flags | ImGuiSliderFlags_AlwaysClamp)) given = value;
}

/// A radius that is measured unless it is given.
void radiusSlider(const char* name, std::optional<float>& given, const std::optional<float>& now,
                  const std::optional<GatherRadii>& radii) {
    if (!radii) return;
    slider(name, given, now.value_or(radii->typical), radii->greatest / 50, radii->greatest * 4,
           ImGuiSliderFlags_Logarithmic);
    if (now) return;
    ImGui::SameLine();
    ImGui::TextColored(dim, "measured");
}

void chooseSettings(const PanelInput& input, Choices& choices) {
    if (!ImGui::CollapsingHeader("Settings")) return;
    const Settings& now = input.state.settings;
    SettingsOptions& given = choices.settings;
    ImGui::PushItemWidth(0.42f * ImGui::GetWindowWidth());
    slider("photons", given.photons, now.photons, 100, 10'000'000);
    slider("caustic photons", given.causticPhotons, now.causticPhotons, 100, 10'000'000);
    slider("pixel samples", given.pixelSamples, now.pixelSamples, 1, 64);
    slider("gather rays", given.gatherRays, now.gatherRays, 1, 64);
    radiusSlider("radius", given.radius, now.radius, input.state.globalRadii);
    radiusSlider("caustic radius", given.causticRadius, now.causticRadius, input.state.causticRadii);
    slider("alpha", given.alpha, now.alpha, 0.05f, 1, 0);
    int kernel = int(given.kernel.value_or(now.kernel));
    if (ImGui::Combo("kernel", &kernel, kernelNames.data(), int(kernelNames.size()))) given.kernel = uint(kernel);
    ImGui::PopItemWidth();
    note("A change begins anew.");
    if (ImGui::Button("as at the start")) given = input.usual;
}

void showLeftOut(const RenderState& state) {
    if (state.leftOut.empty() || !ImGui::CollapsingHeader("Left out")) return;
    for (const std::string& text : state.leftOut) note(text);
}

void showKeys() {
    if (!ImGui::CollapsingHeader("Keys and mouse")) return;
    for (const KeyHelp& help : keyHelp) {
        line(help.keys);
        note(std::string("    ") + help.meaning);
    }
}

} // namespace

int panelWidth(float scale) { return int(width * scale); }

void drawPanel(const PanelInput& input, Choices& choices) {
    const float wide = float(panelWidth(input.scale));
    ImGui::SetNextWindowPos({float(input.window.x) - wide, 0});
    ImGui::SetNextWindowSize({wide, float(input.window.y)});
    ImGui::Begin("vkpm", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoNav);
    ImGui::PushItemWidth(0.6f * ImGui::GetWindowWidth());
    bool& paused = choices.request.paused;
    if (ImGui::Button(paused ? "go on" : "pause", {0.3f * wide, 0})) paused = !paused;
    ImGui::SameLine();
    if (ImGui::Button("save EXR and PNG")) choices.request.saves++;
    if (!input.state.saved.empty()) note(input.state.saved);
    ImGui::Spacing();
    showProgress(input);
    ImGui::Spacing();
    showError(input.state);
    chooseLayer(choices);
    chooseCamera(choices);
    chooseSettings(input, choices);
    showLeftOut(input.state);
    showKeys();
    ImGui::PopItemWidth();
    ImGui::End();
}

} // namespace vkpm
