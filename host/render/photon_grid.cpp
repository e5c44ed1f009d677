/// Building the grid: keys, sort, arrange, cells.
#include "render/photon_grid.h"
#include <algorithm>
#include <bit>

namespace vkpm {

PhotonGrid::PhotonGrid(Gpu& device, std::string label)
    : gpu(device), name(std::move(label)), sort(gpu), keys(gpu, "keys"), arrange(gpu, "arrange"), cellStarts(gpu, "cells") {}

PhotonMap PhotonGrid::build(const Buffer<Photon>& photons, uint count, float radius, float photonFlux, uint levels) {
    // Some keys for each photon, so that few cells share one; at least a block's and, if its cells are split, some blocks.
    const uint least = levels == 0 ? 3 : 3 * (levels + 1) + 6;
    const uint bits = std::clamp(static_cast<uint>(std::bit_width(count)) + 2, least, 26u);
    const uint mask = (1u << bits) - 1;
    const float cellsPerUnit = 1 / (2.1f * radius);
    sort.reserve(count);
    if (arranged.size() < count) {
        arranged = {};
        arranged = Buffer<Photon>(gpu, name + " in cells", photons.size());
    }
    if (cells.size() != mask + 2ull) {
        cells = {};
        cells = Buffer<uint>(gpu, name + " cells", mask + 2ull);
    }

    Recording recording(gpu);
    recording.run(keys, count, {photons, sort.keys, sort.values, count, cellsPerUnit, levels, mask});
    sort.sort(recording, count, bits);
    recording.run(arrange, count, {photons, sort.values, arranged, count});
    recording.run(cellStarts, count + 1ull, {sort.keys, cells, count, mask});
    recording.submit();
    return {.photons = arranged, .cells = cells, .cellsPerUnit = cellsPerUnit, .cellMask = mask, .levels = levels, .radius = radius, .shrink = 1, .photonFlux = photonFlux};
}

} // namespace vkpm
