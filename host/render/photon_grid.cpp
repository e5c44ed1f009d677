/// Building the grid: keys, sort, arrange, cells.
#include "render/photon_grid.h"
#include "shared_paths.h"
#include "shared_photons.h"
#include <algorithm>
#include <bit>

namespace vkpm {

PhotonGrid::PhotonGrid(Gpu& device, std::string label, uint bits)
    : gpu(device), name(std::move(label)), blockBits(bits), sort(gpu), keys(gpu, "keys"),
      arrange(gpu, "reorder_photons"), cellStarts(gpu, "cells"), overfull(gpu, name + " overfull", 1) {}

// Arranges the photons that stay, and writes the cells anew.
void PhotonGrid::thin(const Buffer<Photon>& photons, uint count, uint pass) {
    if (!isOverfull) return;
    if (!thinning)
        thinning.emplace(Thinning{{gpu, "mark_kept"}, {gpu, "scan"}, {gpu, "thin_cells"}, {gpu, name + " whole", 1}});
    const Queue all{.count = count};
    uint left = 0;
    Recording recording(gpu);
    recording.write(thinning->whole, std::span(&all, 1));
    recording.run(thinning->crowd, count, {sort.keys, cells, sort.spareValues, count, pass});
    recording.run(thinning->scan, GROUP, {sort.spareValues, thinning->whole, {}, 1, 1});
    recording.run(thinning->thin, count,
                  {photons, sort.values, sort.keys, cells, sort.spareValues, arranged, sort.spareKeys, count, pass});
    recording.read(sort.spareValues, count, left);
    recording.submit();
    recording.run(cellStarts, left + 1ull,
                  {sort.spareKeys, cells, overfull, left, static_cast<uint>(cells.size()) - 2});
    recording.submit();
}

PhotonMap PhotonGrid::build(const Buffer<Photon>& photons, uint count, float radius, float photonFlux, uint levels,
                            std::optional<uint> pass) {
    Recording recording(gpu);
    const PhotonMap map = record(recording, photons, count, radius, photonFlux, levels);
    recording.submit();
    if (pass) thin(photons, count, *pass);
    return map;
}

PhotonMap PhotonGrid::record(Recording& recording, const Buffer<Photon>& photons, uint count, float radius,
                             float photonFlux, uint levels) {
    // Some keys for each photon, so that few cells share one; at least a block's and, if its cells are split, some
    // blocks.
    const uint least = levels == 0 ? 3 : 3 * (levels + 1) + blockBits;
    const uint bits = std::clamp(static_cast<uint>(std::bit_width(count)) + 2, least, 26u);
    const uint mask = (1u << bits) - 1;
    const float cellsPerUnit = 1 / (2.1f * radius);
    sort.reserve(count + 1ull); // thinning counts them
    if (arranged.size() < count) {
        arranged = {};
        arranged = Buffer<Photon>(gpu, name + " in cells", photons.size());
    }
    if (cells.size() != mask + 2ull) {
        cells = {};
        cells = Buffer<uint>(gpu, name + " cells", mask + 2ull);
    }

    recording.clear(overfull);
    recording.run(keys, count, {photons, sort.keys, sort.values, count, cellsPerUnit, levels, mask});
    sort.sort(recording, count, bits);
    recording.run(cellStarts, count + 1ull, {sort.keys, cells, overfull, count, mask});
    recording.run(arrange, count, {photons, sort.values, arranged, count});
    recording.read(overfull, 0, isOverfull);
    return {.photons = arranged,
            .cells = cells,
            .cellsPerUnit = cellsPerUnit,
            .cellMask = mask,
            .levels = levels,
            .radius = radius,
            .shrink = 1,
            .photonFlux = photonFlux};
}

} // namespace vkpm
