/// The pilot's photons, counted by cell.
#include "render/radius_field.h"
#include "hash.h"
#include "shared_photons.h"
#include <algorithm>
#include <array>

namespace vkpm {

// Cells of the field are half as wide as the widest radius: wide discs near a bright spot would read all of its
// photons.
const float cellsPerRadius = 2;

// Mean logarithm of radii in a cell of a map of narrow discs up to which that map answers there.
const float maxOfNarrow = -0.5f;

// Cells about such a one that have its radius: out of reach of the discs beyond, which are two wide, so that light
// which a disc there would take from a bright spot is not in the picture twice.
const int cellsAround = 3;

RadiusField::RadiusField(Gpu& device) : gpu(device), pilotKernel(gpu, "measure_radius") {}

void RadiusField::measure(const PhotonMap& pilot, uint count, float perDisc, uint stride) {
    PhotonMap map = pilot;
    map.fieldPerUnit = cellsPerUnit = cellsPerRadius / pilot.radius;
    partial = pilot.partial != 0;
    if (partial) return measureNarrow(map, count, perDisc);
    stride = std::max(stride, (count >> 19) + 1); // or the sums might overflow, were all photons in one cell
    const Buffer<uint> sums(gpu, "pilot sums", 2 * FIELD_CELLS + 1);
    Recording recording(gpu);
    recording.clear(sums);
    recording.run(pilotKernel, (count + stride - 1) / stride, {map, sums, {}, count, stride, perDisc});
    recording.submit();

    // The mean of each cell; cells without photons stay unknown.
    std::vector<float> logarithms(FIELD_CELLS, 1.0f);
    std::vector<std::pair<float, uint>> found;
    const std::vector<uint> totals = sums.download();
    for (uint i = 0; i < FIELD_CELLS; i++) {
        if (totals[2 * i + 1] == 0) continue;
        logarithms[i] = -static_cast<float>(totals[2 * i]) / (PILOT_UNIT * static_cast<float>(totals[2 * i + 1]));
        found.emplace_back(logarithms[i], totals[2 * i + 1]);
    }
    values = Buffer<float>(gpu, "radius field", logarithms);
    if (found.empty()) return;

    overfull = static_cast<float>(totals[2 * FIELD_CELLS]) * static_cast<float>(stride) / static_cast<float>(count);
    known = 1;
    std::ranges::sort(found);
    smallest = found.front().first;
    greatest = found.back().first;
    uint before = 0;
    for (const auto& [logarithm, photons] : found)
        if (before <= count / stride / 2) median = logarithm, before += photons;
}

void RadiusField::measureNarrow(PhotonMap map, uint count, float perDisc) {
    const uint stride = (count >> 19) + 1, looked = (count + stride - 1) / stride;
    const Buffer<WantedRadius> wanted(gpu, "wanted radii", looked);
    Recording recording(gpu);
    recording.run(pilotKernel, looked, {map, {}, wanted, count, stride, perDisc});
    recording.submit();

    // The photons of a cell are neighbours once they are sorted by it.
    using Place = std::array<int, 3>;
    std::vector<std::pair<Place, float>> all;
    uint dense = 0;
    const auto most = static_cast<float>(map.levels);
    for (const WantedRadius& photon : wanted.download()) {
        const glm::ivec3 place(glm::floor(glm::clamp(photon.position * cellsPerUnit, -1e9f, 1e9f)));
        all.push_back({{place.x, place.y, place.z}, glm::clamp(photon.logarithm, 0.0f, most)});
        dense += photon.logarithm >= most + 1;
    }
    overfull = float(dense) / float(looked);
    std::ranges::sort(all);

    std::vector<std::pair<float, uint>> found;
    std::vector<float> logarithms(NARROW_FIELD_CELLS, 1.0f);
    uint photons = 0;
    for (auto first = all.begin(); first != all.end();) {
        const auto end =
            std::find_if(first, all.end(), [&](const auto& photon) { return photon.first != first->first; });
        double sum = 0;
        for (auto photon = first; photon != end; ++photon) sum += double(photon->second);
        const auto inCell = static_cast<uint>(end - first);
        const float logarithm = static_cast<float>(-sum / inCell);
        const Place place = first->first;
        first = end;
        if (logarithm > maxOfNarrow) continue;
        found.emplace_back(logarithm, inCell);
        photons += inCell;
        for (int x = -cellsAround; x <= cellsAround; x++)
            for (int y = -cellsAround; y <= cellsAround; y++)
                for (int z = -cellsAround; z <= cellsAround; z++) {
                    float& value =
                        logarithms[hash(uvec3(place[0] + x, place[1] + y, place[2] + z)) & (NARROW_FIELD_CELLS - 1)];
                    value = std::min(value, logarithm);
                }
    }
    values = Buffer<float>(gpu, "radius field", logarithms);
    known = float(photons) / float(looked);
    if (found.empty()) return;
    std::ranges::sort(found);
    smallest = found.front().first;
    greatest = found.back().first;
    uint before = 0;
    for (const auto& [logarithm, inCell] : found)
        if (before <= photons / 2) median = logarithm, before += inCell;
}

void RadiusField::apply(PhotonMap& map) const {
    map.field = values;
    map.fieldPerUnit = cellsPerUnit;
    map.partial = partial;
}

} // namespace vkpm
