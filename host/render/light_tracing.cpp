/// The order of light tracing: photons, splats, sort; then sums by pixel.
#include "render/light_tracing.h"
#include "shared_splat.h"
#include <bit>

namespace vkpm {

LightTracing::LightTracing(Gpu& device, const UploadedScene& uploaded, const Features& features,
                           const Settings& settings, float flux, uint batch)
    : gpu(device), scene(uploaded), size(settings.size), photonFlux(flux / float(settings.causticPhotons)),
      tracing(gpu, scene, features, MapKind::caustic, settings.causticPhotons, settings.seed, batch), sort(gpu),
      rays(gpu, "camera connections", 1), splat(gpu, "splat", features), collectKernel(gpu, "sum_splats", features) {}

PhotonLedger LightTracing::trace(uint pass) {
    PhotonLedger traced = tracing.trace(pass);
    splatCount = static_cast<uint>(traced.stored);
    sort.reserve(splatCount);
    if (splats.size() < splatCount) {
        splats = {};
        splats = Buffer<Splat>(gpu, "splats", tracing.photons.size());
    }

    // Photons that no pixel sees come behind the last pixel.
    Recording recording(gpu);
    recording.clear(rays);
    recording.run(splat, splatCount,
                  {scene.address, tracing.photons, splats, sort.keys, sort.values, rays, size, splatCount, photonFlux});
    sort.sort(recording, splatCount, static_cast<uint>(std::bit_width(size.x * size.y)));
    recording.submit();
    traced.rays += rays.readElement();
    return traced;
}

void LightTracing::collect(const Buffer<float>& samples, uint stride, uint first, uint count) {
    Recording recording(gpu);
    recording.run(collectKernel, count, {splats, sort.keys, sort.values, samples, splatCount, stride, first, count});
    recording.submit();
}

} // namespace vkpm
