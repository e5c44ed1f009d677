/// The order of light tracing: photons, splats, sort; then sums by pixel.
#include "render/light_tracing.h"
#include "shared_splat.h"
#include <bit>

namespace vkpm {

LightTracing::LightTracing(Gpu& device, const UploadedScene& uploaded, const Features& features,
                           const Settings& settings, float flux, uint batch)
    : tracing(device, uploaded, features, MapKind::caustic, settings.causticPhotons, settings.seed, batch), gpu(device),
      scene(uploaded), size(settings.size), seed(settings.seed), photonFlux(flux / float(settings.causticPhotons)),
      sort(gpu), rays(gpu, "camera connections", 1), splat(gpu, "splat", features),
      sumSplats(gpu, "sum_splats", features) {
    tracing.connects = true;
}

void LightTracing::recordSplats(Recording& recording, uint pass) {
    splatCount = static_cast<uint>(tracing.arrived());
    sort.reserve(splatCount);
    if (splats.size() < splatCount) {
        splats = {};
        splats = Buffer<Splat>(gpu, "splats", tracing.photons.size());
    }

    // Photons that no pixel sees come behind the last pixel.
    recording.clear(rays);
    recording.run(splat, splatCount,
                  {scene.address, tracing.photons, splats, sort.keys, sort.values, rays, size, splatCount, pass, seed,
                   photonFlux});
    sort.sort(recording, splatCount, static_cast<uint>(std::bit_width(size.x * size.y)));
    recording.read(rays, 0, rayCount);
}

void LightTracing::recordSums(Recording& recording, const Buffer<float>& samples, uint stride, uint first, uint count) {
    recording.run(sumSplats, count, {splats, sort.keys, sort.values, samples, splatCount, stride, first, count});
}

PhotonLedger LightTracing::passLedger() const {
    PhotonLedger ledger = tracing.ledger();
    ledger.rays += rayCount;
    return ledger;
}

} // namespace vkpm
