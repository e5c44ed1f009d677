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

    /// Traces the photons of a pass, and sorts what they add to pixels by pixel. Of what it returns rays are those to
    /// the camera as well.
    PhotonLedger trace(uint pass);
    /// Fills the caustic columns of the samples, which are `stride` long, of pixels first .. first + count - 1.
    void collect(const Buffer<float>& samples, uint stride, uint first, uint count);

    PhotonLedger ledger; // of all passes

private:
    Gpu& gpu;
    const UploadedScene& scene;
    uvec2 size;
    float photonFlux; // W
    PhotonTracing tracing;
    Sort sort; // of photons by the pixel that sees them
    Buffer<Splat> splats;
    Buffer<uint> rays;
    uint splatCount = 0;
    Kernel<SplatArgs> splat;
    Kernel<SumSplatsArgs> collectKernel;
};

} // namespace vkpm
