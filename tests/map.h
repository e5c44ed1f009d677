/// ys = map(f, xs): a kernel of tests/kernels applied to an array, on the one device of the test program.
#pragma once
#include "gpu/recording.h"
#include "map_args.h"
#include "shared_photons.h"
#include "shared_scene.h"

namespace vkpm {

inline Gpu& testGpu() {
    static Gpu gpu;
    return gpu;
}

/// What a kernel reads besides its array.
struct MapContext {
    Ptr<DeviceScene> scene{};
    PhotonMap photons{};
};

template <class Out, class In>
std::vector<Out> map(const char* kernel, const std::vector<In>& xs, const Features& features = {},
                     const MapContext& context = {}) {
    Gpu& gpu = testGpu();
    const Buffer<In> input(gpu, "xs", xs);
    const Buffer<Out> output(gpu, "ys", xs.size());
    const Kernel<MapArgs> function(gpu, kernel, features);
    Recording recording(gpu);
    recording.run(function, xs.size(),
                  {{input.address}, {output.address}, context.scene, context.photons, static_cast<uint>(xs.size())});
    recording.submit();
    return output.download();
}

} // namespace vkpm
