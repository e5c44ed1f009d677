/// The pilot's photons, counted by cell.
#include "render/radius_field.h"
#include <algorithm>

namespace vkpm {

const uint fieldSize = 1u << 16;

// Cells of the field are half as wide as the widest radius: wide discs near a bright spot would read all of its photons.
const float cellsPerRadius = 2;

RadiusField::RadiusField(Gpu& device) : gpu(device), pilotKernel(gpu, "pilot") {}

void RadiusField::measure(const PhotonMap& pilot, uint count, float perDisc, uint stride) {
    PhotonMap map = pilot;
    map.fieldPerUnit = cellsPerUnit = cellsPerRadius / pilot.radius;
    map.fieldMask = fieldSize - 1;
    stride = std::max(stride, (count >> 19) + 1); // or the sums might overflow, were all photons in one cell
    const Buffer<uint> sums(gpu, "pilot sums", 2 * fieldSize);
    Recording recording(gpu);
    recording.clear(sums);
    recording.run(pilotKernel, (count + stride - 1) / stride, {map, sums, count, stride, perDisc});
    recording.submit();

    // The mean of each cell; cells without photons stay unknown.
    std::vector<float> logarithms(fieldSize, 1.0f);
    std::vector<std::pair<float, uint>> known;
    const std::vector<uint> totals = sums.download();
    for (uint i = 0; i < fieldSize; i++) {
        if (totals[2 * i + 1] == 0) continue;
        logarithms[i] = -static_cast<float>(totals[2 * i]) / (PILOT_UNIT * static_cast<float>(totals[2 * i + 1]));
        known.emplace_back(logarithms[i], totals[2 * i + 1]);
    }
    values = Buffer<float>(gpu, "radius field", logarithms);
    if (known.empty()) return;

    std::ranges::sort(known);
    smallest = known.front().first;
    greatest = known.back().first;
    uint before = 0;
    for (const auto& [logarithm, photons] : known)
        if (before <= count / stride / 2) median = logarithm, before += photons;
}

void RadiusField::apply(PhotonMap& map) const {
    map.field = values;
    map.fieldPerUnit = cellsPerUnit;
    map.fieldMask = fieldSize - 1;
}

} // namespace vkpm
