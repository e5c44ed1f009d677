/// Light tracing: photons behind specular surfaces, connected to the camera.
#pragma once
#include "render/photon_tracing.h"
#include "render/sort.h"
#include "shared_splat.h"

namespace vkpm {

/// Finds the caustic layer without a radius: traces the photons that a caustic map would hold, and adds each to the
/// pixel that sees it (Arvo 1986; Dutré, Lafortune & Willems 1993). The same bits whatever the size of batches.
class LightTracing {
public:
    /// `flux` is that of all lights, W.
    LightTracing(Gpu& gpu, const UploadedScene& scene, const Features& features, const Settings& settings, float flux,
                 uint batch);

    /// Records what the photons of a pass, which are there, add to pixels, sorted by pixel.
    void recordSplats(Recording& recording, uint pass);
    /// Records what fills the caustic columns of the samples, which are `stride` long, of pixels first .. first + count
    /// - 1.
    void recordSums(Recording& recording, const Buffer<float>& samples, uint stride, uint first, uint count);
    /// What became of the photons, once the splats were submitted; rays are those to the camera as well.
    PhotonLedger passLedger() const;

    PhotonTracing tracing;
    PhotonLedger ledger; // of all passes

private:
    Gpu& gpu;
    const UploadedScene& scene;
    uvec2 size;
    uint seed;
    float photonFlux; // W
    Sort sort;        // of photons by the pixel that sees them
    Buffer<Splat> splats;
    Buffer<uint> rays;
    uint splatCount = 0, rayCount = 0;
    Kernel<SplatArgs> splat;
    Kernel<SumSplatsArgs> sumSplats;
};

} // namespace vkpm
