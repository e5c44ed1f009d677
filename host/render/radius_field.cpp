/// The pilot's photons, counted by cell.
#include "render/radius_field.h"
#include <algorithm>

namespace vkpm {

// Cells of the field are half as wide as the widest radius: wide discs near a bright spot would read all of its photons.
const float cellsPerRadius = 2;

// Mean logarithm of radii in a cell of a map of narrow discs up to which that map answers there.
const float mostOfNarrow = -0.5f;

RadiusField::RadiusField(Gpu& device) : gpu(device), pilotKernel(gpu, "pilot") {}

void RadiusField::measure(const PhotonMap& pilot, uint count, float perDisc, uint stride) {
    PhotonMap map = pilot;
    map.fieldPerUnit = cellsPerUnit = cellsPerRadius / pilot.radius;
    partial = pilot.partial != 0;
    const uint cells = partial ? NARROW_FIELD_CELLS : FIELD_CELLS;
    stride = std::max(stride, (count >> 19) + 1); // or the sums might overflow, were all photons in one cell
    const Buffer<uint> sums(gpu, "pilot sums", 2 * cells + 1);
    Recording recording(gpu);
    recording.clear(sums);
    recording.run(pilotKernel, (count + stride - 1) / stride, {map, sums, count, stride, perDisc});
    recording.submit();

    // The mean of each cell; cells without photons stay unknown.
    std::vector<float> logarithms(cells, 1.0f);
    std::vector<std::pair<float, uint>> found;
    const std::vector<uint> totals = sums.download();
    for (uint i = 0; i < cells; i++) {
        if (totals[2 * i + 1] == 0) continue;
        const float mean = -static_cast<float>(totals[2 * i]) / (PILOT_UNIT * static_cast<float>(totals[2 * i + 1]));
        if (partial && mean > mostOfNarrow) continue;
        logarithms[i] = mean;
        found.emplace_back(mean, totals[2 * i + 1]);
    }
    values = Buffer<float>(gpu, "radius field", logarithms);
    const float looked = static_cast<float>(count / stride + 1);
    crowded = static_cast<float>(totals[2 * cells]) / looked;
    if (found.empty()) return;

    std::ranges::sort(found);
    smallest = found.front().first;
    greatest = found.back().first;
    uint photons = 0, before = 0;
    for (const auto& [logarithm, inCell] : found) photons += inCell;
    known = static_cast<float>(photons) / looked;
    for (const auto& [logarithm, inCell] : found)
        if (before <= std::min(photons, count / stride) / 2) median = logarithm, before += inCell;
}

void RadiusField::apply(PhotonMap& map) const {
    map.field = values;
    map.fieldPerUnit = cellsPerUnit;
    map.partial = partial;
}

} // namespace vkpm
